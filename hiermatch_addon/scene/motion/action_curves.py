# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of actions in any version of Blender: with slots and layers from 4.4 on, without before."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, cast

import bpy

from ..armatures import armature_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

_BONE_PATH = re.compile(r'pose\.bones\["(?P<name>(?:[^"\\]|\\.)*)"\]')

_BONE = re.compile(r'pose\.bones\["(?P<name>(?:[^"\\]|\\.)*)"\]\.(?P<channel>\w+)$')

TRANSFORMS = ("location", "rotation_quaternion", "rotation_euler", "rotation_axis_angle", "scale")
"""Channels in which a bone or an object keeps how it stands, the rotation in the one of its mode."""

_ROTATIONS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}

_STILL = 1e-6
"""Difference of values up to which a curve moves nothing: rounding of what is written by single precision."""

_AS_LARGE = 0.01
"""By what part a bone may be larger or smaller and still count as large as it is: importers round more."""

MADE_FOR = "hiermatch_made_for"
"""Custom property of the actions that are made here: the name of the armature object that they are for.

On that object it is what this was called when one was made for it last.
"""


def played_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """Return the action that an armature plays; None for none."""
    animation = armature.animation_data
    return None if animation is None else animation.action


def actions_of(armature: bpy.types.Object) -> list[bpy.types.Action]:
    """Return all actions of the file that move bones of an armature.

    Where rigs have bones of the same names, what others play, what was made for them, or what moves more of their bones
    is theirs unless it plays it.
    """
    others = [obj for obj in bpy.data.objects if obj.type == "ARMATURE" and obj != armature]
    names = {obj.name for obj in others}
    theirs = {name for obj in others for name in playing(obj)}
    theirs |= {action.name for action in bpy.data.actions if cast("Any", action).get(MADE_FOR) in names}
    own = set(playing(armature))
    return [
        action
        for action in bpy.data.actions
        if moves_bones(action, armature)
        and (action.name in own or not (action.name in theirs or _is_foreign(action, armature, others)))
    ]


def playing(armature: bpy.types.Object) -> list[str]:
    """Return the names of the actions that an armature plays, or has on a track of the NLA editor."""
    animation = armature.animation_data
    if animation is None:
        return []
    strips = [strip.action for track in animation.nla_tracks for strip, _ in clips(track.strips)]
    return [action.name for action in (animation.action, *strips) if action is not None]


def clips(strips: Iterable[Any], *, mute: bool = False) -> Iterator[tuple[Any, bool]]:
    """Go through strips, in the place of meta strips through those within; and say whether each is muted."""
    for strip in strips:
        muted = mute or strip.mute
        if strip.type == "META":
            yield from clips(strip.strips, mute=muted)
        else:
            yield strip, muted


def slot_for(action: bpy.types.Action, armature: bpy.types.Object) -> Any:  # noqa: ANN401 - new in Blender 4.4
    """Return the slot of an action that is meant for an armature; None before 4.4, or if it has none."""
    slots = getattr(action, "slots", None)
    if not slots:
        return None
    animation: Any = armature.animation_data
    if animation is not None and animation.action == action and animation.action_slot is not None:
        return animation.action_slot
    fitting = [slot for slot in slots if slot.target_id_type in {"OBJECT", "UNSPECIFIED"}]
    named = [slot for slot in fitting if slot.identifier == f"OB{armature.name}"]
    # Of several the one that moves most of the bones.
    return max(named or fitting, key=lambda slot: _matching(action, slot, armature), default=None)


def bone_curves(action: bpy.types.Action, armature: bpy.types.Object) -> Iterator[tuple[str, str, Any]]:
    """Go through the curves of an action that move bones of an armature, unless muted: bone, channel, and the curve.

    Curves without keys that no modifier gives values move nothing, nor do those of how a bone bends in itself.
    """
    bones = armature_of(armature).bones
    for curve in slot_curves(action, slot_for(action, armature)):
        found = _BONE.match(curve.data_path)
        if found is not None and found["channel"] in TRANSFORMS and _is_heard(curve) and not curve.is_empty:
            name = bpy.utils.unescape_identifier(found["name"])
            if name in bones:
                yield name, found["channel"], curve


def slot_curves(action: bpy.types.Action, slot: Any) -> Iterator[Any]:  # noqa: ANN401 - new in Blender 4.4
    """Go through the curves of a slot of an action: all until Blender 4.3, later none without a slot."""
    if not hasattr(action, "slots"):
        yield from cast("Any", action).fcurves
        return
    if slot is None:
        return
    for layer in cast("Any", action).layers:
        for strip in layer.strips:
            bag = cast("Any", strip).channelbag(slot)
            if bag is not None:
                yield from bag.fcurves


def every_curve(action: bpy.types.Action) -> Iterator[Any]:
    """Go through all curves of an action, of whatever slot."""
    if not hasattr(action, "slots"):
        yield from cast("Any", action).fcurves
        return
    for slot in cast("Any", action).slots:
        yield from slot_curves(action, slot)


def rotation_channel(mode: str) -> str:
    """Return the channel in which a bone of such a rotation mode keeps its rotation."""
    return _ROTATIONS.get(mode, "rotation_euler")


def moves_bones(action: bpy.types.Action, armature: bpy.types.Object) -> bool:
    """Tell whether an action moves or turns bones of an armature."""
    return any(channel != "scale" for _, channel, _ in bone_curves(action, armature))


def moves_object_only(action: bpy.types.Action, armature: bpy.types.Object) -> bool:
    """Tell whether an action moves an armature as a whole, and none of its bones."""
    return next(object_curves(action, armature), None) is not None and not moves_bones(action, armature)


def scaled_bones(action: bpy.types.Action, armature: bpy.types.Object) -> list[str]:
    """Return the names of the bones of an armature whose size an action changes."""
    found = [
        bone
        for bone, channel, curve in bone_curves(action, armature)
        if channel == "scale"
        and (len(curve.modifiers) or any(abs(point.co[1] - 1) > _AS_LARGE for point in curve.keyframe_points))
    ]
    return list(dict.fromkeys(found))


def frame_range(action: bpy.types.Action, armature: bpy.types.Object) -> tuple[float, float]:
    """Return the first and the last frame of an action, of an armature's own slot if others have keys elsewhere."""
    curves = list(slot_curves(action, slot_for(action, armature)))
    ends = [curve.range() for curve in curves if len(curve.keyframe_points)]
    if action.use_frame_range or not ends:
        return float(action.frame_range[0]), float(action.frame_range[1])
    return min(float(start) for start, _ in ends), max(float(end) for _, end in ends)


def renamed_paths(
    action: bpy.types.Action, armature: bpy.types.Object, names: Mapping[str, str]
) -> list[tuple[Any, str, Any, str]]:
    """Say what curves of bones, and their groups, are to be called if bones get other names.

    Returns
    -------
    list of (curve, str, group, str)
        Each curve of such a bone with its path then, and its group, or None, with its name.
    """
    found = []
    for curve in slot_curves(action, slot_for(action, armature)):
        start = _BONE_PATH.match(curve.data_path)
        name = "" if start is None else bpy.utils.unescape_identifier(start["name"])
        if name in names:
            path = (
                f'pose.bones["{bpy.utils.escape_identifier(names[name])}"]{curve.data_path[cast("Any", start).end() :]}'
            )
            group = curve.group
            found.append((curve, path, group, names.get(group.name, group.name) if group is not None else ""))
    return found


def object_curves(action: bpy.types.Action, armature: bpy.types.Object) -> Iterator[tuple[str, Any]]:
    """Go through the curves of an action that move the object itself, unless muted: channel, and the curve.

    Curves that stay at one value move nothing.
    """
    for curve in slot_curves(action, slot_for(action, armature)):
        if curve.data_path in TRANSFORMS and moves(curve):
            yield curve.data_path, curve


def moves(curve: Any) -> bool:  # noqa: ANN401 - Blender's types differ
    """Tell whether a curve is heard, and does not stay at one value."""
    values = [point.co[1] for point in curve.keyframe_points]
    changes = len(curve.modifiers) > 0 or (bool(values) and max(values) - min(values) > _STILL)
    return changes and _is_heard(curve)


def _is_heard(curve: Any) -> bool:  # noqa: ANN401 - Blender's types differ
    """Tell whether a curve is muted neither by itself nor with its group."""
    return not curve.mute and not (curve.group is not None and curve.group.mute)


def assign_action(armature: bpy.types.Object, action: bpy.types.Action) -> None:
    """Let an armature play an action; the one that it played before is kept in the file."""
    animation: Any = armature.animation_data or armature.animation_data_create()
    if animation.action is not None and animation.action != action:
        animation.action.use_fake_user = True
    animation.action = action
    choose_slot(animation, action, armature)


def choose_slot(player: Any, action: bpy.types.Action, armature: bpy.types.Object) -> None:  # noqa: ANN401 - of two kinds
    """Let an object's animation, or a strip, that plays an action play the slot that is meant for an armature."""
    slot = slot_for(action, armature)
    if slot is not None:
        player.action_slot = slot


class CurveMaker:
    """Makes an action for an armature, curve by curve.

    Parameters
    ----------
    before : bpy.types.Action or str
        One that is made anew in its place, so that whatever plays it plays the new one; or the name of another one.
    armature : bpy.types.Object
        Whom it is for.
    model : bpy.types.Action, optional
        Whose frame range and cycle it takes over.
    """

    def __init__(
        self, before: bpy.types.Action | str, armature: bpy.types.Object, model: bpy.types.Action | None = None
    ) -> None:
        made: Any = bpy.data.actions.new(before) if isinstance(before, str) else before
        made.use_fake_user = True
        made[MADE_FOR] = cast("Any", armature)[MADE_FOR] = armature.name
        self.action = made
        self._bag = None
        if hasattr(made, "slots"):
            slot = slot_for(made, armature) or made.slots.new("OBJECT", armature.name)
            for layer in list(made.layers):
                made.layers.remove(layer)
            strip = made.layers.new("Layer").strips.new(type="KEYFRAME")
            self._bag = strip.channelbag(slot, ensure=True)
        else:
            _clear(made)
        for option in ("use_frame_range", "frame_start", "frame_end", "use_cyclic") if model is not None else ():
            setattr(made, option, getattr(model, option))

    def curve(self, bone: str, channel: str, index: int) -> Any:  # noqa: ANN401 - Blender's types differ
        """Make a curve of a bone's channel, in the bone's group."""
        path = f'pose.bones["{bpy.utils.escape_identifier(bone)}"].{channel}'
        if self._bag is None:
            return self.action.fcurves.new(path, index=index, action_group=bone)
        curve = self._bag.fcurves.new(path, index=index)
        curve.group = self._bag.groups.get(bone) or self._bag.groups.new(bone)
        return curve


def _clear(action: Any) -> None:  # noqa: ANN401 - before Blender 4.4
    """Remove the curves of an action and their groups."""
    for parts in (action.fcurves, action.groups):
        for part in list(parts):
            parts.remove(part)


def _is_foreign(action: bpy.types.Action, armature: bpy.types.Object, others: list[bpy.types.Object]) -> bool:
    """Tell whether an action moves more bones of one of some other armatures than of an armature."""
    slot = slot_for(action, armature)
    own = _matching(action, slot, armature)
    return any(_matching(action, slot, other) > own for other in others)


def _matching(action: bpy.types.Action, slot: Any, armature: bpy.types.Object) -> int:  # noqa: ANN401 - see above
    """Count the curves of a slot that move bones of an armature."""
    bones = armature_of(armature).bones
    found = (_BONE.match(curve.data_path) for curve in slot_curves(action, slot))
    return sum(match is not None and bpy.utils.unescape_identifier(match["name"]) in bones for match in found)
