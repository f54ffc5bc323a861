# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of fitting a rig: Blender's properties, and the plain settings that they make."""

from dataclasses import dataclass

import bpy

from .plain_settings import settings_of


@dataclass(frozen=True)
class RigSettings:
    """How a target gets its rig.

    Attributes
    ----------
    existing : str
        What becomes of an armature that was made for the target before: "UPDATE" or "KEEP".
    replace : bool
        Whether the target's own rig moves it no more.
    bind : bool
        Whether the target gets an Armature modifier and a parent.
    rest : bool
        Whether a rest pose like the source's is made as well.
    rest_shown : bool
        Whether the new armature takes it.
    pose : str
        Whether the target is in another pose than the source: "AUTO", "POSED" or "REST".
    like_source : str
        Whether the target is brought to a rest pose like the source's: "AUTO" if the source has actions, "ON" or "OFF".
    """

    existing: str = "UPDATE"
    replace: bool = True
    bind: bool = True
    rest: bool = False
    rest_shown: bool = False
    pose: str = "AUTO"
    like_source: str = "AUTO"


class RigOptions:
    """The options of fitting a rig, for whatever class of Blender's inherits from it."""

    rig_existing: bpy.props.EnumProperty(
        name="Existing Rig",
        description="What becomes of an armature that was made for the target before",
        items=[
            ("UPDATE", "Update", "Move its joints; all else that was changed on it since stays"),
            ("KEEP", "Keep", "Leave it as it is, and make another one"),
        ],
        default="UPDATE",
    )
    rig_replace: bpy.props.BoolProperty(
        name="Replace Own Rig",
        description="If the target has a rig of its own already, switch its Armature modifiers off, and hide it if "
        "it moves nothing else; it is not deleted. Otherwise both move the target",
        default=True,
    )
    rig_bind: bpy.props.BoolProperty(
        name="Bind",
        description="Give the target an Armature modifier, set as the source's, and the armature as its parent if "
        "the source has its own as parent",
        default=True,
    )
    rest_pose_like_source: bpy.props.EnumProperty(
        name="Same Rest Pose",
        description="Whether to bring the target to the rest pose of the source, so that the source's actions play "
        "on it. How it stood is kept as an action",
        items=[
            ("AUTO", "If It Has Actions", "If the rig of the source has an action or strips of actions"),
            ("ON", "Always", "Also for actions that are to come later"),
            ("OFF", "Never", "The pose that the target stands in becomes its rest pose"),
        ],
        default="AUTO",
    )
    rig_rest: bpy.props.BoolProperty(
        name="Also Rest Pose",
        description="If the target is in another pose than the source, make an action that takes it to a rest pose "
        "like the source's",
    )
    rig_rest_shown: bpy.props.BoolProperty(
        name="Show Rest Pose",
        description="Let the new armature take that rest pose at once",
    )
    rig_pose: bpy.props.EnumProperty(
        name="Pose",
        description="Whether the target is in another pose than the source, for the rest pose",
        items=[
            ("AUTO", "Automatic", "It is, if a large limb is bent much against the source"),
            ("POSED", "Posed", "It is: undo all rotations of its bones"),
            ("REST", "At Rest", "It is in its rest pose already, and only its build is different"),
        ],
        default="AUTO",
    )


def rig_settings(options: RigOptions) -> RigSettings:
    """Make the settings of the options."""
    return settings_of(RigSettings, options, "rig_", like_source=options.rest_pose_like_source)
