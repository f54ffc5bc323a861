# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of making a mesh symmetric: Blender's properties, and the plain settings that they make."""

from dataclasses import dataclass

import bpy

from .plain_settings import settings_of


@dataclass(frozen=True)
class SymmetriseSettings:
    """What of a mesh is made symmetric.

    Attributes
    ----------
    side : str
        The side that is taken to the other: "LEFT" or "RIGHT".
    weights, keys, colors : bool
        Whether the weights of vertex groups, shape keys, and color attributes are made symmetric.
    create : bool
        Whether groups and shape keys are added of which only one side is there.
    """

    side: str = "LEFT"
    weights: bool = True
    keys: bool = True
    colors: bool = True
    create: bool = True


class SymmetriseOptions:
    """The options of symmetrising, for whatever class of Blender's inherits from it."""

    symmetrise_side: bpy.props.EnumProperty(
        name="Direction",
        description="Which side is taken to the other. The sides are told apart by vertex groups with names such "
        "as Arm.L and Arm.R, or else by the object's X axis, which points to the left",
        items=[
            ("LEFT", "Left to Right", "The left side is good"),
            ("RIGHT", "Right to Left", "The right side is good"),
        ],
        default="LEFT",
    )
    symmetrise_weights: bpy.props.BoolProperty(
        name="Weights",
        description="Make the weights of vertex groups symmetric; locked groups are left alone",
        default=True,
    )
    symmetrise_keys: bpy.props.BoolProperty(name="Shape Keys", description="Make shape keys symmetric", default=True)
    symmetrise_colors: bpy.props.BoolProperty(
        name="Colors", description="Make color attributes symmetric", default=True
    )
    symmetrise_create: bpy.props.BoolProperty(
        name="Create Missing Sides",
        description="Add vertex groups and shape keys of the other side where only one side is there",
        default=True,
    )


def symmetrise_settings(options: SymmetriseOptions) -> SymmetriseSettings:
    """Make the settings of the options."""
    return settings_of(SymmetriseSettings, options, "symmetrise_")
