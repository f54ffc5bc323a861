# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of wrapping one mesh onto another: Blender's properties, and the plain settings that they make."""

from dataclasses import dataclass

import bpy

from .plain_settings import settings_of


@dataclass(frozen=True)
class WrapSettings:
    """How one mesh is laid onto another.

    Attributes
    ----------
    moved : str
        Whose surface is laid onto the other: "SOURCE" or "TARGET".
    result : str
        Where it is written: "KEY" on the mesh itself, or "OBJECT", a new one.
    place : str
        Where the result stands: at the "OTHER" mesh, or in its "OWN" place.
    in_betweens : int
        How many shapes between the two are added.
    """

    moved: str = "SOURCE"
    result: str = "KEY"
    place: str = "OTHER"
    in_betweens: int = 0


class WrapOptions:
    """The options of wrapping, for whatever class of Blender's inherits from it."""

    wrap_moved: bpy.props.EnumProperty(
        name="Wrap",
        description="Whose surface is laid onto the other",
        items=[
            ("SOURCE", "Source to Target", "Lay the source onto the target"),
            ("TARGET", "Target to Source", "Lay the target onto the source"),
        ],
        default="SOURCE",
    )
    wrap_result: bpy.props.EnumProperty(
        name="Result",
        description="What is made",
        items=[
            ("KEY", "Shape Key", "Add a shape key to the mesh: its slider leads from one shape to the other"),
            ("OBJECT", "New Object", "Make a new object that has both shapes, and leave the mesh as it is"),
        ],
        default="KEY",
    )
    wrap_place: bpy.props.EnumProperty(
        name="Place",
        description="Where the wrapped shape stands",
        items=[
            ("OTHER", "At the Other", "Where the mesh stands that it is laid onto"),
            ("OWN", "Own Place", "Where the mesh stood, turned and moved back as one"),
        ],
        default="OTHER",
    )
    wrap_in_betweens: bpy.props.IntProperty(
        name="In-Betweens",
        description="How many shape keys are added that keep limbs from shrinking on the way. They follow the "
        "slider of the first by drivers",
        default=0,
        min=0,
        max=15,
    )


def wrap_settings(options: WrapOptions) -> WrapSettings:
    """Make the settings of the options."""
    return settings_of(WrapSettings, options, "wrap_")
