# SPDX-License-Identifier: GPL-3.0-or-later
"""An armature for another body: a copy with everything that is set on it, and its bones moved to other joints."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np

from ..common.access import open_collections, view_layer_of
from ..common.phrases import listed
from .armatures import armature_of, pose_of
from .posing.pose_state import bring_back

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from ...engine import PlacedJoints


@dataclass(frozen=True, eq=False)
class NewBone:
    """A bone for an armature, in world space.

    Attributes
    ----------
    name, parent : str
        What it and its parent are called; the latter is empty if it has none.
    head, tail, normal : (3,) array of float
        Its ends, and the direction of its local z axis.
    connected : bool
        Whether it hangs on its parent's tail.
    marks : dict
        Its custom properties.
    """

    name: str
    parent: str
    head: NDArray[np.float64]
    tail: NDArray[np.float64]
    normal: NDArray[np.float64]
    connected: bool
    marks: dict[str, str]


def copy_to(
    context: bpy.types.Context, source: bpy.types.Object, name: str, target: bpy.types.Object
) -> bpy.types.Object:
    """Copy an armature to the place and the collections of an object, turned and scaled as it is; see `_copied`."""
    armature = _copied(context, source, name)
    matrix = source.matrix_world.copy()
    matrix.translation = target.matrix_world.translation
    armature.matrix_world = matrix
    scene = cast("bpy.types.Scene", context.scene).collection
    wanted = open_collections(context, target.users_collection)
    for collection in wanted:
        if armature.name not in collection.objects:
            collection.objects.link(armature)
    if scene not in wanted:
        scene.objects.unlink(armature)
    view_layer_of(context).update()
    return armature


def _copied(context: bpy.types.Context, source: bpy.types.Object, name: str) -> bpy.types.Object:
    """Copy an armature object and its data, at rest and without animation, into the scene's own collection.

    Bone collections, colours, custom properties and shapes, constraints and drivers stay; they point to where they
    did (see `repoint`).  What moves the object as a whole is left out.
    """
    matrix = source.matrix_world.copy()
    copy, data = source.copy(), armature_of(source).copy()
    copy.data = data
    for made in (copy, data):  # the copy of a library override is one as well, and its bones could not be edited
        if made.override_library is not None:
            made.make_local(clear_liboverride=True)
    copy.name = data.name = name
    copy.parent = None
    copy.constraints.clear()
    bring_back(copy)
    _forget(copy)
    _stop_animation(copy)
    _stop_animation(data)
    cast("bpy.types.Scene", context.scene).collection.objects.link(copy)
    copy.matrix_world = matrix
    for bone in pose_of(copy).bones:
        bone.matrix_basis.identity()
    copy.hide_viewport = False
    copy.hide_set(state=False)
    copy.select_set(state=False)
    return copy


def _forget(copy: bpy.types.Object) -> None:
    """Let a copy have nothing to do with what is kept for the other one: poses, a successor, test poses."""
    owner: Any = copy
    for name in [name for name in owner.keys() if name.startswith("hiermatch_")]:  # noqa: SIM118 - not a dict
        del owner[name]


def repoint(armature: bpy.types.Object, places: Mapping[bpy.types.ID, bpy.types.ID]) -> list[str]:
    """Let constraints and drivers of an armature that point to one thing point to another.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object; its data is its own.
    places : mapping
        What takes the place of what.

    Returns
    -------
    list of str
        What is to be said of other things that they still point to.
    """
    kept: set[str] = set()
    for holder, member in (*_constraint_pointers(armature), *_driver_pointers(armature)):
        value = getattr(holder, member)
        if value in places:
            setattr(holder, member, places[value])
        elif value is not None and value != armature and value.id_type != "SCENE":
            kept.add(value.name)
    others = sorted(kept - {thing.name for thing in places.values()})
    return [f'Constraints or drivers of "{armature.name}" still point to {listed(others)}.'] if others else []


def move_joints(
    context: bpy.types.Context,
    armature: bpy.types.Object,
    names: tuple[str, ...],
    placed: PlacedJoints,
) -> list[str]:
    """Move the bones of an armature in its rest pose.

    Parameters
    ----------
    context : bpy.types.Context
        In Object Mode; what is active and selected there is the same afterwards.
    armature : bpy.types.Object
        The armature object, in the view layer and visible.
    names : (b,) tuple of str
        Names of bones; those that the armature lacks are passed over.
    placed : PlacedJoints
        Their new ends and the new directions of their local z axes, in world space.

    Returns
    -------
    list of str
        The bones that were passed over.
    """
    inverse = np.linalg.inv(np.array(armature.matrix_world, np.float64))
    starts, ends = (points @ inverse[:3, :3].T + inverse[:3, 3] for points in (placed.heads, placed.tails))
    across = placed.normals @ inverse[:3, :3].T
    with _edited(context, armature) as bones:
        missing = [name for name in names if name not in bones]
        # A connected bone moves its parent's tail with it; both are set to the same place here.
        connected = {bone.name: bone.use_connect for bone in bones}
        for bone in bones:
            bone.use_connect = False
        for name, start, end, normal in zip(names, starts, ends, across, strict=True):
            if name not in bones:
                continue
            bone = bones[name]
            before = bone.length
            bone.head, bone.tail = start.tolist(), end.tolist()
            bone.align_roll(normal.tolist())
            _thicken(bone, bone.length / before if before > 0 else 1.0)
        for bone in bones:
            bone.use_connect = connected[bone.name]
    return missing


def add_bones(context: bpy.types.Context, armature: bpy.types.Object, bones: Sequence[NewBone]) -> None:
    """Add bones that deform to an armature in its rest pose, parents first; those of the same names are replaced.

    Parameters
    ----------
    context : bpy.types.Context
        In Object Mode; what is active and selected there is the same afterwards.
    armature : bpy.types.Object
        The armature object.
    bones : sequence of NewBone
        The bones.
    """
    inverse = np.linalg.inv(np.array(armature.matrix_world, np.float64))
    with _edited(context, armature) as edited:
        for one in bones:
            bone = edited.get(one.name) or edited.new(one.name)
            bone.use_connect = False
            bone.parent = edited.get(one.parent) if one.parent else None
            bone.head, bone.tail = ((inverse[:3, :3] @ end + inverse[:3, 3]).tolist() for end in (one.head, one.tail))
            bone.align_roll((inverse[:3, :3] @ one.normal).tolist())
            bone.use_connect = one.connected and bone.parent is not None
            bone.use_deform = True
            for name, value in one.marks.items():
                bone[name] = value


def _thicken(bone: bpy.types.EditBone, factor: float) -> None:
    """Scale what has a size beside the length: how B-Bones are drawn, and envelopes."""
    for size in ("bbone_x", "bbone_z", "head_radius", "tail_radius", "envelope_distance"):
        setattr(bone, size, factor * getattr(bone, size))


def _stop_animation(data: bpy.types.Object | bpy.types.Armature) -> None:
    """Take away actions and strips, and the drivers of the object's own place, which would move the new armature."""
    animation = data.animation_data
    if animation is None:
        return
    animation.use_tweak_mode = False  # in which the action could not be taken away
    animation.action = None
    for track in list(animation.nla_tracks):
        animation.nla_tracks.remove(track)
    places = ("location", "rotation_", "scale", "delta_", "constraints[", "hide_")
    for curve in [curve for curve in animation.drivers if curve.data_path.startswith(places)]:
        animation.drivers.remove(curve)


def _constraint_pointers(armature: bpy.types.Object) -> Iterator[tuple[Any, str]]:
    """Go through all constraints, and the members of them and of their targets that point to objects."""
    for constraint in (constraint for bone in pose_of(armature).bones for constraint in bone.constraints):
        for holder in (constraint, *getattr(constraint, "targets", ())):
            for prop in holder.bl_rna.properties:
                pointer = prop.type == "POINTER" and cast("Any", prop).fixed_type.identifier == "Object"
                if pointer and not prop.is_readonly:
                    yield holder, prop.identifier


def _driver_pointers(armature: bpy.types.Object) -> Iterator[tuple[Any, str]]:
    """Go through all drivers of an armature object and its data, and what their variables read from."""
    for data in (armature, armature_of(armature)):
        if data.animation_data is not None:
            for curve in data.animation_data.drivers:
                for variable in cast("bpy.types.Driver", curve.driver).variables:
                    yield from ((place, "id") for place in cast("Any", variable).targets)


@contextmanager
def _edited(context: bpy.types.Context, armature: bpy.types.Object) -> Iterator[Any]:
    """Lend the bones of an armature in Edit Mode, and put back its mode, and what was active and selected."""
    layer = view_layer_of(context)
    active, selected, mode = layer.objects.active, list(layer.objects.selected), armature.mode
    for obj in selected:  # or other armatures among them would be edited too
        obj.select_set(state=False)
    data = armature_of(armature)
    mirrored, data.use_mirror_x = data.use_mirror_x, False
    with _visible(context, armature):
        layer.objects.active = armature
        try:
            bpy.ops.object.mode_set(mode="EDIT")
            yield data.edit_bones
        finally:
            if armature.mode == "EDIT":
                bpy.ops.object.mode_set(mode="OBJECT")
            if armature.mode != mode:
                bpy.ops.object.mode_set(mode=mode)
            data.use_mirror_x = mirrored
            armature.select_set(state=False)
            for obj in selected:
                obj.select_set(state=True)
            layer.objects.active = active


@contextmanager
def _visible(context: bpy.types.Context, obj: bpy.types.Object) -> Iterator[None]:
    """Show an object for a while, since no hidden one can be edited."""
    scene = cast("bpy.types.Scene", context.scene).collection
    linked = obj.name in scene.objects
    if not linked:
        scene.objects.link(obj)
    hidden, off = obj.hide_get(), obj.hide_viewport
    obj.hide_viewport = False
    obj.hide_set(state=False)
    try:
        yield
    finally:
        obj.hide_set(state=hidden)
        obj.hide_viewport = off
        if not linked:
            scene.objects.unlink(obj)
