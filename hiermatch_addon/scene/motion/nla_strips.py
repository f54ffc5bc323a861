# SPDX-License-Identifier: GPL-3.0-or-later
"""Strips of actions in the NLA editor, copied from one object to another that has actions of its own in their place."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, Any

import bpy

from .action_curves import TRANSFORMS, choose_slot, clips, slot_curves, slot_for

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_TRACK = ("mute", "lock")
_STRIP = (
    "action_frame_start",
    "action_frame_end",
    "scale",
    "repeat",
    "use_auto_blend",
    "blend_in",
    "blend_out",
    "blend_type",
    "extrapolation",
    "use_reverse",
    "use_sync_length",
    "influence",
)
"""What copies take over, in this order: lengths follow from the first ones."""
_ANIMATED = {"use_animated_influence": "influence", "use_animated_time": "strip_time"}
"""What of a strip may be animated, and the curve of that."""


def strip_actions(source: bpy.types.Object) -> list[str]:
    """Return the names of all actions that strips of an object play."""
    animation = source.animation_data
    tracks = animation.nla_tracks if animation is not None else ()
    return list(
        dict.fromkeys(strip.action.name for track in tracks for strip, _ in clips(track.strips) if strip.action)
    )


def add_tracks(rig: bpy.types.Object, actions: Iterable[bpy.types.Action]) -> None:
    """Put actions, and the one that is played, on tracks of their own, which are called as they are.

    Those on a track already stay where they are; none is silenced by another track.  If some have keys of where the
    object is, the others get them, too: without, the editor would put it to the origin, and to the size of one.
    """
    animation: Any = rig.animation_data or rig.animation_data_create()
    played, there = animation.action, strip_actions(rig)
    wanted = list(dict.fromkeys([*([played] if played is not None else []), *actions]))
    _key_object(rig, wanted, [*wanted, *(bpy.data.actions[name] for name in there)])
    animation.action, animation.use_nla = None, True
    for track in animation.nla_tracks:
        track.is_solo = False
    for action in wanted:
        if action.name in there:
            continue
        track = animation.nla_tracks.new()
        track.name = action.name
        strip = track.strips.new(action.name, int(action.frame_range[0]), action)
        choose_slot(strip, action, rig)


def _key_object(rig: bpy.types.Object, actions: list[bpy.types.Action], every: list[bpy.types.Action]) -> None:
    """Give actions keys of where the object is now that they lack and some of `every` have."""
    animation: Any = rig.animation_data
    paths = {
        action: {*TRANSFORMS} & {curve.data_path for curve in slot_curves(action, slot_for(action, rig))}
        for action in every
    }
    for action in actions:
        animation.action = action
        choose_slot(animation, action, rig)
        for path in sorted(set().union(*paths.values()) - paths[action]):
            rig.keyframe_insert(path, frame=action.frame_range[0])


def copy_strips(source: bpy.types.Object, target: bpy.types.Object, made: Mapping[str, bpy.types.Action]) -> list[str]:
    """Copy the tracks of an object with those strips whose actions have a counterpart.

    A track with the same actions at the same frames is there already, from a former time, and stays as it is.

    Parameters
    ----------
    source, target : bpy.types.Object
        From where, and where to.
    made : mapping
        The target's action for the name of each of the source's.

    Returns
    -------
    list of str
        Meta strips, which scripts cannot make: the strips within them were copied.
    """
    animation = source.animation_data
    if animation is None:
        return []
    metas = list[str]()
    theirs: Any = target.animation_data or target.animation_data_create()
    there = [[(strip.frame_start, strip.action) for strip, _ in clips(track.strips)] for track in theirs.nla_tracks]
    for track in animation.nla_tracks:
        strips = [(strip, mute) for strip, mute in clips(track.strips) if strip.action and strip.action.name in made]
        if not strips:
            continue
        wanted = [(strip.frame_start, made[strip.action.name]) for strip, _ in strips]
        if wanted in there:
            there.remove(wanted)
            continue
        copy = theirs.nla_tracks.new()
        copy.name = track.name
        for strip, mute in strips:
            _copy_strip(strip, copy, made[strip.action.name], target).mute = mute
        for name in _TRACK:
            setattr(copy, name, getattr(track, name))
        if track.is_solo:  # else none would be
            copy.is_solo = True
        metas += [strip.name for strip in track.strips if strip.type == "META"]
    return metas


def _copy_strip(strip: Any, track: Any, action: bpy.types.Action, target: bpy.types.Object) -> Any:  # noqa: ANN401
    """Put a strip that plays an action of the target as another one plays its own at the end of a track."""
    free = max([strip.frame_start, *(one.frame_end for one in track.strips)])
    new = track.strips.new(strip.name, ceil(free), action)  # which can be done at whole frames only
    choose_slot(new, action, target)
    for name in _STRIP:
        setattr(new, name, getattr(strip, name))
    new.frame_start, new.frame_end = strip.frame_start, strip.frame_end
    for option, channel in _ANIMATED.items():
        curve = strip.fcurves.find(channel) if getattr(strip, option) else None
        if curve is not None:
            setattr(new, option, True)
            _copy_keys(curve, new.fcurves.find(channel))
    new.use_animated_time_cyclic = strip.use_animated_time_cyclic
    return new


def _copy_keys(curve: Any, copy: Any) -> None:  # noqa: ANN401 - curves of strips, which the stubs do not know
    """Give a curve the keys of another one."""
    for key in curve.keyframe_points:
        copy.keyframe_points.insert(*key.co)
    for made, key in zip(copy.keyframe_points, curve.keyframe_points, strict=True):
        for name in ("interpolation", "easing", "handle_left_type", "handle_right_type", "handle_left", "handle_right"):
            setattr(made, name, getattr(key, name))
    copy.extrapolation = curve.extrapolation
