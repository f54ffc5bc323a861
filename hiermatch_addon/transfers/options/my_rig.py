# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of fitting an armature that stands in the source: Blender's properties, and the plain settings of them."""

from dataclasses import dataclass

import bpy

from ...common.access import view_layer_of
from .plain_settings import settings_of


@dataclass(frozen=True)
class MyRigSettings:
    """Which armature is fitted, and how.

    Attributes
    ----------
    name : str
        Name of the armature object.
    bind : bool
        Whether the target is bound to it, with the weights of the source.
    limit : int
        How many bones may move a vertex; 0 for any number.
    """

    name: str
    bind: bool = False
    limit: int = 4


def _armatures(_owner: object, context: bpy.types.Context, _text: str) -> list[str]:
    """List the armatures that may be meant."""
    return [obj.name for obj in view_layer_of(context).objects if obj.type == "ARMATURE"]


class MyRigOptions:
    """The options of fitting such an armature, for whatever class of Blender's inherits from it."""

    rig: bpy.props.StringProperty(
        name="Rig",
        description="Name of an armature that stands in the source without moving it, such as a metarig of Rigify. "
        "It may be bound to nothing",
        search=_armatures,
        search_options={"SORT"},
    )
    my_rig_bind: bpy.props.BoolProperty(
        name="Bind with Weights",
        description="Bind the target to the fitted rig, with the weights of the source's own rig, handed to the "
        "bones that move the same surface. Leave it off for a metarig",
    )
    my_rig_limit: bpy.props.IntProperty(
        name="Limit Bones",
        description="How many bones may move a vertex at most; 0 for any number",
        min=0,
        default=4,
    )


def my_rig_settings(options: MyRigOptions) -> MyRigSettings:
    """Make the settings of the options."""
    return settings_of(MyRigSettings, options, "my_rig_", name=options.rig)
