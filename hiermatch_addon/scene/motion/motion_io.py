# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion of armatures as arrays: read from actions and poses, and written as keys."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from mathutils import Matrix

from ....engine import Motion, motion_of_matrices, posed_motion, rotation_matrices
from ...common.long_names import LONGEST_ID, shortened
from ..armatures import armature_of, pose_of
from .action_curves import (
    CurveMaker,
    assign_action,
    bone_curves,
    choose_slot,
    object_curves,
    played_action,
    rotation_channel,
)
from .carried_action_io import mark_carried, to_be_replaced, was_carried
from .holders import acts, is_carried
from .own_scene import own_scene
from .rigs import own_skeleton, rest_matrices
from .source_keys_io import Way

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    import bpy
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class BoneKeys:
    """Keys of one channel of a bone, such as its rotation, c numbers in k frames.

    Attributes
    ----------
    bone, channel : str
        Which.
    frames : (k,) array of float
        When.
    values : (k, c) array of float
        The values.
    slopes : (2, k, c) array of float
        Their change per frame before and after each key.
    ways : list of Way
        How it goes on after each key; Bézier if empty.
    cycle : dict
        Settings of a modifier that repeats the curves; none if empty.
    extrapolation : str
        How they go on beyond the keys.
    stops : bool
        Whether they should go on there otherwise than such curves can.
    """

    bone: str
    channel: str
    frames: NDArray[np.float64]
    values: NDArray[np.float64]
    slopes: NDArray[np.float64]
    ways: list[Way] = field(default_factory=list)
    cycle: dict[str, Any] = field(default_factory=dict)
    extrapolation: str = "CONSTANT"
    stops: bool = False


_STAYS = 1e-6
"""By how much matrices of objects differ by rounding to single precision."""

_TURNED = 0.02
"""By what angle a bone is no longer at rest: about one degree."""


def needs_evaluation(armature: bpy.types.Object, action: bpy.types.Action) -> bool:
    """Tell whether more than an action's curves decides how an armature stands: constraints, drivers and such."""
    pose = pose_of(armature)
    if is_carried(armature, action):
        return True
    if any(acts(constraint, action) for bone in pose.bones for constraint in bone.constraints):
        return True
    if any(
        not bone.use_inherit_rotation or not bone.use_local_location or bone.inherit_scale != "FULL"
        for bone in armature_of(armature).bones
    ):
        return True
    animations = (armature.animation_data, armature_of(armature).animation_data)
    return any(animation is not None and len(animation.drivers) > 0 for animation in animations)


def posed_at(action: bpy.types.Action, armature: bpy.types.Object, frames: NDArray[np.float64]) -> Motion:
    """Pose an armature as the curves of an action say, at frames (f,), in its own space.

    Channels without curves are as the bones stand, as if the action were played now.
    """
    curves: dict[str, list[tuple[str, Any]]] = {}
    for bone, channel, curve in bone_curves(action, armature):
        curves.setdefault(bone, []).append((channel, curve))
    bones = pose_of(armature).bones
    basis = np.stack([_basis(bone, curves.get(bone.name, ()), frames) for bone in bones], axis=1)
    return posed_motion(own_skeleton(armature), rest_matrices(armature), basis)


def _basis(
    owner: Any,  # noqa: ANN401 - a bone or an object
    curves: Iterable[tuple[str, Any]],
    frames: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Transform of a bone or an object by curves of its channels at frames (f,), (f, 4, 4), else as it stands."""
    rotation = rotation_channel(owner.rotation_mode)
    names = rotation, "location", "scale"
    values = {name: np.tile(np.array(getattr(owner, name), np.float64), (len(frames), 1)) for name in names}
    for channel, curve in curves:
        if channel in values:
            values[channel][:, curve.array_index] = [curve.evaluate(frame) for frame in frames]
    basis = np.tile(np.eye(4), (len(frames), 1, 1))
    basis[:, :3, :3] = rotation_matrices(values[rotation], owner.rotation_mode) * values["scale"][:, None]
    basis[:, :3, 3] = values["location"]
    return basis


def object_places(
    action: bpy.types.Action, armature: bpy.types.Object, frames: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return where an action has an object in the world at frames (f,), by curves of its own alone, (f, 4, 4)."""
    held = armature.matrix_world @ armature.matrix_basis.inverted_safe()
    return np.array(held, np.float64) @ _basis(armature, _moving_curves(action, armature), frames)


def with_object(motion: Motion, places: NDArray[np.float64], first: NDArray[np.float64]) -> Motion:
    """Let the bones do what is done to the object as a whole, against where it is in one of the poses.

    Parameters
    ----------
    motion : Motion
        The poses, in the object's space.
    places : (f, 4, 4) array of float
        Where that is in the world in each.
    first : (4, 4) array of float
        Where it counts as being where it is.
    """
    ways = np.linalg.inv(first) @ places
    unit = max(1.0, float(np.abs(np.linalg.inv(first)).max()))
    return motion if np.abs(ways - np.eye(4)).max() < _STAYS * unit else motion.moved(ways)


def _moving_curves(action: bpy.types.Action, armature: bpy.types.Object) -> list[tuple[str, Any]]:
    """Curves that move or turn the object as a whole, with their channels."""
    return [found for found in object_curves(action, armature) if found[0] != "scale"]


def grows(action: bpy.types.Action, armature: bpy.types.Object) -> bool:
    """Tell whether an action changes the size of the object."""
    return any(channel == "scale" for channel, _ in object_curves(action, armature))


def current_motion(armature: bpy.types.Object) -> Motion:
    """Read the pose in which an armature stands now, after constraints, in its own space: a motion of one pose.

    No action is played again: it would know nothing of what has no keys yet.
    """
    with own_scene(armature) as alone:
        alone.update()
        return _motion_of(armature, alone.matrices()[None])


def evaluated_frames(
    action: bpy.types.Action, armature: bpy.types.Object, frames: NDArray[np.float64]
) -> tuple[Motion, NDArray[np.float64]]:
    """Let Blender play an action at frames (f,), with all constraints and drivers, by a copy of the armature.

    Returns
    -------
    motion : Motion
        The poses.
    places : (f, 4, 4) array of float
        Where the object is in the world, as large as it is now.
    """
    posed, places = np.empty((len(frames), len(armature_of(armature).bones), 4, 4)), np.empty((len(frames), 4, 4))
    size = armature.matrix_world.to_scale()
    with own_scene(armature) as alone:
        animation = cast("Any", alone.armature.animation_data)
        animation.action = action
        choose_slot(animation, action, armature)
        for number, frame in enumerate(frames):
            alone.go_to(frame)
            posed[number] = alone.matrices()
            location, rotation, _ = alone.place().decompose()
            places[number] = Matrix.LocRotScale(location, rotation, size)
    return _motion_of(armature, posed), places


def _motion_of(armature: bpy.types.Object, posed: NDArray[np.float64]) -> Motion:
    """Make a motion of the matrices of the bones (f, b, 4, 4) in the armature's space."""
    return motion_of_matrices(own_skeleton(armature), rest_matrices(armature), posed)


def write_action(
    armature: bpy.types.Object, model: bpy.types.Action, keys: Sequence[BoneKeys], *, assign: bool
) -> tuple[bpy.types.Action, list[str]]:
    """Make an action of keys, named after an armature and ranged like another one.

    What was made from that one before is made anew in its place: strips, too, play the new one. If it was edited since
    it is kept beside it with all that plays it.

    If it takes the place of an action that was carried over before, what only that one moved goes back to rest: it
    would stand for good where that one left it. Where an action was made by hand, nobody knows whether that is wanted.

    Parameters
    ----------
    armature : bpy.types.Object
        Whom it is for.
    model : bpy.types.Action
        From which it is carried over, and whose frame range it takes over.
    keys : sequence of BoneKeys
        The keys.
    assign : bool
        Whether the armature plays it.

    Returns
    -------
    action : bpy.types.Action
        The action.
    notes : list of str
        What is to be said of the one that was made before.
    """
    played, (before, notes) = _left_by(armature), to_be_replaced(armature, model)
    maker = CurveMaker(before or shortened(model.name, LONGEST_ID, f" {armature.name}"), armature, model)
    for channel in keys:
        for index in range(channel.values.shape[1]):
            _write_curve(maker.curve(channel.bone, channel.channel, index), channel, index)
    mark_carried(maker.action, model)
    if assign or played_action(armature) == maker.action:
        _put_to_rest(armature, played - {(each.bone, each.channel) for each in keys})
    if assign:
        assign_action(armature, maker.action)
    return maker.action, notes


def _left_by(armature: bpy.types.Object) -> set[tuple[str, str]]:
    """Return the channels of bones that the action played now moves, if it was carried over."""
    before = played_action(armature)
    if before is None or not was_carried(before):
        return set()
    return {(bone, channel) for bone, channel, _ in bone_curves(before, armature)}


def _put_to_rest(armature: bpy.types.Object, left: set[tuple[str, str]]) -> None:
    """Put channels of bones to rest."""
    bones: Any = pose_of(armature).bones
    for bone, channel in left:
        setattr(bones[bone], channel, bones[bone].bl_rna.properties[channel].default_array)


def _write_curve(curve: Any, keys: BoneKeys, index: int) -> None:  # noqa: ANN401 - Blender's types differ
    """Write the keys of one number."""
    count, points = len(keys.frames), curve.keyframe_points
    points.add(count)
    values = keys.values[:, index]
    points.foreach_set("co", np.stack([keys.frames, values], axis=1).astype(np.float32).ravel())
    steps = np.diff(keys.frames, prepend=keys.frames[:1] - 1, append=keys.frames[-1:] + 1) / 3
    for side, sign, lengths in (("left", -1, steps[:-1]), ("right", 1, steps[1:])):
        slopes = keys.slopes[0 if side == "left" else 1, :, index]
        ends = np.stack([keys.frames + sign * lengths, values + sign * lengths * slopes], axis=1)
        points.foreach_set(f"handle_{side}", ends.astype(np.float32).ravel())
    for point, way in zip(points, keys.ways or [Way()] * count, strict=True):
        point.handle_left_type = point.handle_right_type = "FREE"
        point.interpolation, point.easing, point.back = way
    curve.extrapolation = keys.extrapolation
    if keys.cycle:
        modifier = curve.modifiers.new("CYCLES")
        for name, value in keys.cycle.items():
            setattr(modifier, name, value)


def set_pose(armature: bpy.types.Object, bases: dict[str, NDArray[np.float64]]) -> None:
    """Pose bones by their transforms (4, 4) against their parents; scales stay."""
    bones = pose_of(armature).bones
    for name, basis in bases.items():
        scale = bones[name].scale.copy()
        bones[name].matrix_basis = Matrix(basis.tolist())
        bones[name].scale = scale


def turned_above(armature: bpy.types.Object, moved: Collection[str]) -> list[str]:
    """Return the names of bones that are turned in the pose, on which some that are moved hang, and which are not."""
    bones = pose_of(armature).bones
    above = {parent.name for name in moved if name in bones for parent in bones[name].parent_recursive}
    chosen = [bone for bone in bones if bone.name in above.difference(moved)]
    return [bone.name for bone in chosen if bone.matrix_basis.to_quaternion().angle > _TURNED]
