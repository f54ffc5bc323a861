# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of carrying motion over: Blender's properties, and the plan that they make."""

from dataclasses import dataclass
from fnmatch import fnmatchcase

import bpy

from ....engine import MotionSettings
from ...common.errors import ObjectError
from ...common.phrases import listed
from ...scene.motion.action_curves import actions_of, moves_bones, moves_object_only, played_action, playing
from ...scene.motion.nla_strips import strip_actions
from ...scene.posing.rest_mesh_io import plays_actions


@dataclass(frozen=True)
class MotionPlan:
    """What is carried over, and how.

    Attributes
    ----------
    actions : tuple of str
        Names of the actions; none for the pose of the moment.
    settings : MotionSettings
        How the target is posed.
    keys : str
        "AUTO", "SOURCE", "REDUCED" or "ALL".
    tolerance : float
        How much reduced keys may change a rotation, in radians.
    assign : bool
        Whether a target plays its new action, if there is one only.
    strips : bool
        Whether NLA strips of these actions are copied.
    left_out : tuple of str
        Names of actions that are meant as well, and move no bones but the object alone.
    """

    actions: tuple[str, ...]
    settings: MotionSettings
    keys: str = "AUTO"
    tolerance: float = 0.0035
    assign: bool = True
    strips: bool = False
    left_out: tuple[str, ...] = ()


class MotionOptions:
    """How motion is carried over, for whatever class of Blender's inherits from it."""

    action: bpy.props.StringProperty(
        name="Action",
        description="Name of the action to carry over, or a pattern such as Walk*; several with a semicolon "
        "between them. If empty, those that Actions says",
        options={"SKIP_SAVE"},
    )
    actions: bpy.props.EnumProperty(
        name="Actions",
        description="Which actions of the source are carried over",
        items=[
            ("ACTIVE", "Active", "The one that the source plays, or the only one that it has"),
            ("ALL", "All", "All actions of the file that move bones of the source"),
        ],
        default="ACTIVE",
    )
    keying: bpy.props.EnumProperty(
        name="Keys",
        description="At which frames the new action gets keys",
        items=[
            ("AUTO", "Automatic", "At the source's keys if these are few, else reduced ones"),
            ("SOURCE", "As the Source", "At the keys of the source's bones, with their interpolation"),
            ("REDUCED", "Reduced", "As few as keep the motion within the Tolerance"),
            ("ALL", "Every Frame", "At every frame"),
        ],
        default="AUTO",
    )
    tolerance: bpy.props.FloatProperty(
        name="Tolerance",
        description="By how much reduced keys may change a rotation",
        subtype="ANGLE",
        min=0,
        max=0.5,
        default=0.0035,
    )
    keep_feet: bpy.props.BoolProperty(
        name="Feet on Ground",
        description="Where a foot stands in the source, let it stand in the target: the leg is bent for it. All "
        "frames are computed then",
    )
    keep_hands: bpy.props.BoolProperty(
        name="Hands on Body",
        description="Where a hand touches the body or the other hand in the source, bend the target's arm so that "
        "it does so too. All frames are computed then",
    )
    stride: bpy.props.FloatProperty(
        name="Stride",
        description="How long the way along the ground is; 1 fits the length of the target's legs",
        min=0,
        soft_max=3,
        default=1,
    )
    in_place: bpy.props.BoolProperty(
        name="In Place", description="Take out the way from the first to the last frame, for walk cycles"
    )
    strips: bpy.props.BoolProperty(
        name="NLA Strips",
        description="Carry the actions of the source's NLA strips over as well, and copy the strips",
    )
    assign: bpy.props.BoolProperty(
        name="Play", description="Let the target play the new action, if it is one only", default=True
    )


def motion_plan(scene: bpy.types.Scene, options: MotionOptions, rig: bpy.types.Object) -> MotionPlan:
    """Make the plan of the options for the actions of a rig.

    Raises
    ------
    ObjectError
        If there are none, or one that is named does not move the rig.
    """
    names = _wanted(options, rig)
    if options.strips:
        known = {action.name for action in actions_of(rig)}
        names = list(dict.fromkeys([*names, *(name for name in strip_actions(rig) if name in known)]))
    if not names:
        found = [action.name for action in actions_of(rig)]
        played = played_action(rig)
        if found and played is not None:
            raise ObjectError(
                f'"{rig.name}" plays "{played.name}", which moves none of its bones. Name one of these, or choose all: '
                f"{listed(found)}."
            )
        if found:
            raise ObjectError(f'"{rig.name}" plays no action. Name one of these, or choose all: {listed(found)}.')
        raise ObjectError(_without_actions(rig))
    settings = MotionSettings(
        feet=options.keep_feet,
        hands=options.keep_hands,
        stride=options.stride,
        in_place=options.in_place,
        rate=scene.render.fps / scene.render.fps_base,
    )
    return MotionPlan(
        tuple(names),
        settings,
        options.keying,
        options.tolerance,
        assign=options.assign,
        strips=options.strips,
        left_out=_left_out(options, rig),
    )


def _left_out(options: MotionOptions, rig: bpy.types.Object) -> tuple[str, ...]:
    """Names of the actions of a rig that the options mean, and that move the object alone."""
    every = not options.action and options.actions == "ALL"
    meant = [*(playing(rig) if every else ()), *(strip_actions(rig) if options.strips else ())]
    return tuple(name for name in dict.fromkeys(meant) if moves_object_only(bpy.data.actions[name], rig))


def _wanted(options: MotionOptions, rig: bpy.types.Object) -> list[str]:
    """Names of the actions that the options name, or else mean."""
    if options.action:
        return _named(options.action, rig)
    if options.actions == "ALL":
        return [action.name for action in actions_of(rig)]
    played = played_action(rig)
    if played is not None and moves_bones(played, rig):
        return [played.name]
    found = [action.name for action in actions_of(rig)]
    return found if len(found) == 1 else []


def _named(text: str, rig: bpy.types.Object) -> list[str]:
    """Names of the actions that a text names: one, or several and patterns with semicolons between them."""
    parts = [text] if text in bpy.data.actions else [part.strip() for part in text.split(";") if part.strip()]
    found: list[str] = []
    for part in parts:
        if part not in bpy.data.actions:
            found += _fitting(part, rig)
        elif not moves_bones(bpy.data.actions[part], rig):
            raise ObjectError(f'The action "{part}" moves no bone of "{rig.name}". Choose one that does.')
        else:
            found.append(part)
    return list(dict.fromkeys(found))


def _fitting(pattern: str, rig: bpy.types.Object) -> list[str]:
    """Names of the actions of a rig that fit a pattern."""
    meant = pattern.strip("*?").lower()
    own = sorted((action.name for action in actions_of(rig)), key=lambda name: meant not in name.lower())
    if not own:
        raise ObjectError(_without_actions(rig))
    if not set("*?[") & set(pattern):
        raise ObjectError(f'There is no action called "{pattern}". Those of "{rig.name}" are {listed(own)}.')
    fitting = [name for name in own if fnmatchcase(name, pattern)]
    if not fitting:
        raise ObjectError(
            f'No action that moves bones of "{rig.name}" fits the pattern "{pattern}". Its actions are {listed(own)}.'
        )
    return fitting


def _without_actions(rig: bpy.types.Object) -> str:
    """Say that a rig has none, and which others have: Source and Target are easily exchanged."""
    others = [obj for obj in bpy.data.objects if obj.type == "ARMATURE" and obj != rig]
    moving = [obj.name for obj in others if plays_actions(obj)]
    if moving:
        return (
            f'"{rig.name}" has no action that moves its bones, but there are some of {listed(moving)}. Exchange Source '
            "and Target, or name an action."
        )
    return f'"{rig.name}" has no action that moves its bones. Give it one, or name an action.'
