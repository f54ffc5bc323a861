# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of carrying shape keys: Blender's properties, and the plain settings that they make."""

from dataclasses import dataclass

import bpy

from ....engine import Scaling
from .plain_settings import names_in, settings_of


@dataclass(frozen=True)
class ShapeKeySettings:
    """How shape keys are carried over.

    Attributes
    ----------
    choice : str
        Which keys: "ALL", "ACTIVE" or "NAMED".
    names : tuple of str
        Their names if they are chosen by name.
    existing : str
        What becomes of keys of the same name on the target: "REPLACE" or "SKIP".
    scaling : {"auto", "none", "overall", "local"}
        What becomes of the length of their offsets.
    threshold : float
        Part of a key's largest offset below which offsets are dropped.
    drivers : bool
        Whether their drivers are copied.
    action : bool
        Whether the target's keys play the source's action.
    """

    choice: str = "ALL"
    names: tuple[str, ...] = ()
    existing: str = "REPLACE"
    scaling: Scaling = "auto"
    threshold: float = 0.001
    drivers: bool = True
    action: bool = True


_SCALINGS: dict[str, Scaling] = {"AUTO": "auto", "NONE": "none", "OVERALL": "overall", "LOCAL": "local"}


class ShapeKeyOptions:
    """The options of shape keys, for whatever class of Blender's inherits from it."""

    key_choice: bpy.props.EnumProperty(
        name="Shape Keys",
        description="Which shape keys of the source are carried over",
        items=[
            ("ALL", "All", "All shape keys"),
            ("ACTIVE", "Active", "The active shape key"),
            ("NAMED", "By Name", "The shape keys that are named"),
        ],
        default="ALL",
    )
    key_names: bpy.props.StringProperty(
        name="Names",
        description="Names of the shape keys to carry over, separated by commas",
    )
    key_existing: bpy.props.EnumProperty(
        name="Existing Keys",
        description="What becomes of shape keys of the same name that the target has already",
        items=[
            ("REPLACE", "Replace", "Give them the new shape and settings"),
            ("SKIP", "Skip", "Leave them as they are"),
        ],
        default="REPLACE",
    )
    key_scaling: bpy.props.EnumProperty(
        name="Scale",
        description="What becomes of the size of the movements",
        items=[
            (
                "AUTO",
                "Automatic",
                "With Size if the target is clearly larger or smaller than the source, else only to its units",
            ),
            ("NONE", "None", "As long as on the source"),
            ("OVERALL", "With Size", "Longer or shorter as the whole target is larger or smaller"),
            ("LOCAL", "Locally", "Longer or shorter as the target is larger or smaller around each place"),
        ],
        default="AUTO",
    )
    key_threshold: bpy.props.FloatProperty(
        name="Threshold",
        description="Movements shorter than this part of the longest of a shape key are dropped, so that vertices "
        "far from what it moves stay exactly in place",
        default=0.001,
        min=0.0,
        max=1.0,
        precision=4,
        subtype="FACTOR",
    )
    key_drivers: bpy.props.BoolProperty(
        name="Drivers",
        description="Copy the drivers of the shape keys. Where they point to the source or its armature, the "
        "copies point to the target and its armature",
        default=True,
    )
    key_action: bpy.props.BoolProperty(
        name="Action",
        description="Let the target's shape keys play the action of the source's, unless they have one of their "
        "own. Both share it",
        default=True,
    )


def shape_key_settings(options: ShapeKeyOptions) -> ShapeKeySettings:
    """Make the settings of the options."""
    names, scaling = names_in(options.key_names), _SCALINGS[options.key_scaling]
    return settings_of(ShapeKeySettings, options, "key_", names=names, scaling=scaling)
