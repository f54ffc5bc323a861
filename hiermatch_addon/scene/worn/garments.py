# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes, hair and accessories as objects of their own: which there are, and fitted copies of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np
from mathutils import Matrix
from scipy.sparse import csr_array, vstack

from ....engine import TriangleMesh, continues_body, ends_at_joint, hanging_triangles
from ...common.access import mesh_of, view_layer_of
from ...common.errors import ObjectError
from ...common.phrases import listed
from ..armatures import find_armature, held_by, moving_armatures, read_rig
from ..character import Character, joined, parts_of, vertex_ranges
from ..key_drivers import counterparts, point_drivers
from ..mesh_io import read_mesh
from ..pair import check_object
from ..shape_key_io import keys_of
from .fitted_copies import (
    BODY,
    ITEM,
    adopt,
    fitted_name,
    fitted_to,
    made_copy,
    mark_names,
    original_of,
    put_aside,
    unmark,
    was_edited,
)
from .garment_shape_io import mirror_axes
from .modifier_pointers import point_to, used_beside

if TYPE_CHECKING:
    from collections.abc import Collection, Container, Sequence

    from numpy.typing import NDArray

    from ..character import Side

_SHAPES = frozenset({"MESH", "CURVE", "CURVES", "SURFACE", "FONT", "META"})
"""Types of objects that have a shape."""


def bound_items(context: bpy.types.Context, body: Side) -> list[bpy.types.Object]:
    """Return all visible meshes that the armature of a body moves, but the body, by name; none if it has none."""
    armature = find_armature(body)
    if armature is None:
        return []
    layer, parts = view_layer_of(context), parts_of(body)
    return [
        obj
        for obj in sorted(layer.objects, key=lambda one: one.name)
        if obj.type == "MESH"
        and obj not in parts
        and BODY not in cast("Any", obj)
        and obj.visible_get(view_layer=layer)
        and len(mesh_of(obj).polygons)
        and (armature in moving_armatures(obj) or obj.parent in (armature, *parts))
    ]


def selected_items(context: bpy.types.Context, source: Side, targets: Sequence[Side], *, named: bool) -> list[str]:
    """Return the names of the selected objects that are items, in order: not a body or an armature.

    What was fitted to one of the targets stands for the item that it was made from; what was fitted to the source is
    worn by it.

    Parameters
    ----------
    context : bpy.types.Context
        Where they are selected.
    source, targets : bpy.types.Object or Character
        The bodies.
    named : bool
        Whether the source is named or picked.  Then parts of it that are selected are its clothes, unless all are.
    """
    selected = set(view_layer_of(context).objects.selected)
    own, theirs = set(parts_of(source)), {part for target in targets for part in parts_of(target)}
    bodies = theirs if named and len(own) > 1 and not own <= selected else own | theirs
    copies = {copy for target in targets for copy in fitted_to(target)} & selected
    meant = {obj for obj in selected - bodies if BODY not in cast("Any", obj)}
    meant |= {item for copy in copies if (item := original_of(copy)) is not None}
    meant |= {copy for copy in fitted_to(source) if ITEM in cast("Any", copy)} & selected
    return sorted(obj.name for obj in meant if obj.type in _SHAPES)


def meshes_of(name: str, *bodies: bpy.types.Object) -> tuple[str, ...]:
    """Return the names of the meshes in a collection but some bodies and what was fitted to bodies, in order.

    If there is nothing else in it, as in the outfit of a body, what was fitted is meant.

    Raises
    ------
    ObjectError
        If there is no such collection, or nothing in it.
    """
    collection = bpy.data.collections.get(name)
    if collection is None:
        raise ObjectError(f'There is no collection called "{name}".')
    meshes = [obj for obj in collection.all_objects if obj.type == "MESH" and obj not in bodies]
    found = sorted(obj.name for obj in meshes if BODY not in cast("Any", obj))
    found = found or sorted(obj.name for obj in meshes if ITEM in cast("Any", obj))
    if not found:
        raise ObjectError(f'The collection "{name}" has no meshes that could be fitted.')
    return tuple(found)


def undressed(body: Side, items: Collection[str], depsgraph: bpy.types.Depsgraph) -> Side:
    """Leave items out of a character that they are parts of, as all that its armature moves is; not all of it.

    Those stay in that it has no skin below, such as boots without feet: they are the surface of its body there.  What
    of them hangs over limbs, as a skirt over legs, is left out of that.
    """
    parts = parts_of(body)
    worn = {part.name in items for part in parts}
    if len(worn) == 1:
        return body
    meshes = {part: read_mesh(part, depsgraph, use_modifiers=False) for part in parts}
    rig, ranges = read_rig(body), dict(zip(parts, vertex_ranges(body), strict=True))

    def is_body(item: bpy.types.Object, rest: Sequence[bpy.types.Object]) -> bool:
        """Tell whether an item is a part of the body that the rest lacks."""
        below = TriangleMesh.concatenated([meshes[part] for part in rest])
        if continues_body(below, meshes[item]):
            return True
        if rig is None:
            return False
        weights = csr_array(vstack([rig.weights[ranges[part]] for part in rest]))
        return ends_at_joint(below, meshes[item], (weights, rig.weights[ranges[item]]), rig.skeleton)

    # The largest first: of a jacket over a shirt it is the shirt that stands for the chest.
    for item in sorted(parts, key=lambda part: -meshes[part].area):
        rest = [part for part in parts if part is not item]
        if item.name in items and not is_body(item, rest):
            parts = tuple(rest)
    left = joined(body.name, parts)
    cloth = [np.full(meshes[part].triangle_count, part.name in items) for part in parts_of(left)]
    surface = TriangleMesh.concatenated([meshes[part] for part in parts_of(left)])
    hanging = hanging_triangles(surface, np.concatenate(cloth))
    return replace(left, left_out=frozenset(np.flatnonzero(hanging).tolist())) if isinstance(left, Character) else left


def check_item(
    context: bpy.types.Context,
    item: bpy.types.Object,
    source: Side,
    target: Side,
    items: Collection[bpy.types.Object],
    *,
    writable: bool = True,
) -> None:
    """Make sure that an object, one of some items, can be fitted from one body to another.

    What is copied only need not be `writable`: it may be linked from another file.

    Raises
    ------
    ObjectError
        If it cannot.
    """
    is_source = item in parts_of(source) and set(parts_of(source)) <= set(items)
    if is_source or item in parts_of(target):
        role = "Source" if is_source else "Target"
        raise ObjectError(
            f'"{item.name}" is the body itself, picked as the {role}. Take it out of the items, or pick another body.'
        )
    if item.type == "ARMATURE":
        raise ObjectError(_no_armature(item, {*parts_of(source), *parts_of(target)}))
    if item.type in ("CURVE", "CURVES", "SURFACE", "FONT", "META"):
        raise ObjectError(
            f'"{item.name}" is not a mesh but of type {item.type.title()}. Convert a copy of it '
            "(Object > Convert > Mesh), and fit that."
        )
    check_object(view_layer_of(context), item, writable=writable)


def _no_armature(item: bpy.types.Object, bodies: Container[bpy.types.Object]) -> str:
    """Say that an armature is no item, and which meshes are meant, unless they are a body's."""
    meshes = (obj for obj in bpy.data.objects if obj.type == "MESH" and obj not in bodies)
    moved = [obj.name for obj in meshes if item in (obj.parent, *moving_armatures(obj))]
    if moved:
        return f'"{item.name}" is an armature, and items are meshes. Name those that it moves: {listed(moved)}.'
    return f'"{item.name}" is an armature, and items are meshes. It moves none but a body: name others, or take it out.'


def dressed_at_rest(item: bpy.types.Object, source: Side) -> bool:
    """Tell whether the item's own vertices belong to the body's own: both are moved by the same armature, or none is.

    Else it lies on the body as this is posed.
    """
    armature = find_armature(source)
    return armature is None or armature in moving_armatures(item) or bool(held_by(item, armature))


def fitted_copy(
    context: bpy.types.Context,
    item: bpy.types.Object,
    source: Side,
    target: Side,
    *,
    motion: NDArray[np.float64],
    growth: float,
) -> tuple[bpy.types.Object, list[str], list[str]]:
    """Copy an item with all that is on it, for another body; one that was fitted before is replaced.

    If that one was edited since, it is kept aside.

    Its modifiers stay live: sizes of Solidify, Bevel and Displace grow with it, a Mirror turns with it, and what they
    point to of the one body becomes that of the other.

    Parameters
    ----------
    context : bpy.types.Context
        Where it is added, to a collection that is named after the body.
    item : bpy.types.Object
        The item.
    source, target : bpy.types.Object or Character
        The two bodies.
    motion : (4, 4) array of float
        How the source turns and moves on the whole to become the target, in world space.
    growth : float
        How many times as large the item becomes.

    Returns
    -------
    copy : bpy.types.Object
        The copy.
    kept : list of str
        Names of what belongs to the source that drivers of its shape keys and modifiers still read from.
    aside : list of str
        Name of the one that was fitted before, if it was edited since; else empty.
    """
    copy = _copy_of(item)
    copy.matrix_world = _placed(item, motion)
    name, aside = _put_in_place(cast("bpy.types.Scene", context.scene), copy, item, target)
    marks: Any = copy
    marks[ITEM], marks[BODY] = item.name, target.name
    mark_names(item, target)
    copy.name = mesh_of(copy).name = name
    copy.hide_set(state=False)
    copy.select_set(state=False)
    # Of a body of several objects the largest stands for all that something may point to.
    largest = max(parts_of(target), key=lambda part: len(mesh_of(part).vertices))
    places = counterparts(source, largest, find_armature(source), find_armature(target))
    places[item] = copy  # also of one that is part of the body
    point_to(copy, item, places, growth)
    keys = keys_of(copy)
    theirs: list[bpy.types.ID] = []
    every: dict[bpy.types.ID, list[bpy.types.ID]] = {mine: [other] for mine, other in places.items()}
    for part in (largest, *parts_of(target)):
        found = keys_of(part)
        theirs += [] if found is None else [found]
    for part in (*parts_of(source), item):
        own = keys_of(part)
        if own is not None:
            every[own] = [cast("bpy.types.Key", keys)] if part is item else theirs
    driven: list[bpy.types.Key | bpy.types.Object] = [copy] if keys is None else [copy, keys]
    return copy, sorted({name for one in driven for name in point_drivers(one, every)}), aside


def left_behind(copy: bpy.types.Object, body: Side) -> list[str]:
    """Let modifiers of a copy use the copies of other items; return the names of what else they use beside the body."""
    kept = []
    for put, used in used_beside(copy, body):
        other = used if BODY in cast("Any", used) else made_copy(used, body)
        if other is None:
            kept.append(used.name)
        else:
            put(other)
    return list(dict.fromkeys(kept))


def _copy_of(item: bpy.types.Object) -> bpy.types.Object:
    """Copy an item with its mesh, as this file's own, which hangs on nothing."""
    copy, mesh = item.copy(), mesh_of(item).copy()
    for made in (copy, mesh):
        if made.override_library is not None:  # as a copy of an override is one, too
            made.make_local()
    copy.data = mesh
    unmark(copy)
    _leave_animation(copy)
    copy.constraints.clear()
    copy.parent = None
    return copy


def _leave_animation(copy: bpy.types.Object) -> None:
    """Take from a copy what moves it, but not what drives its modifiers."""
    animation = copy.animation_data
    if animation is None:
        return
    drivers = [curve for curve in animation.drivers if not curve.data_path.startswith("modifiers[")]
    if len(drivers) == len(animation.drivers):
        copy.animation_data_clear()
        return
    animation.use_tweak_mode = False  # in which the action could not be taken away
    animation.action = None
    for track in list(animation.nla_tracks):
        animation.nla_tracks.remove(track)
    for curve in drivers:
        animation.drivers.remove(curve)


def _put_in_place(
    scene: bpy.types.Scene, copy: bpy.types.Object, item: bpy.types.Object, body: Side
) -> tuple[str, list[str]]:
    """Put a copy into the scene, in the place of one that was fitted before.

    Return what it is to be called, and what the one before is called now if it was edited and is kept.
    """
    adopt(body)
    before = made_copy(item, body)
    name, shown, aside = fitted_name(item.name, body.name), False, []
    if before is not None:
        former = fitted_name(cast("Any", before)[ITEM], body.name)
        name, shown = name if before.name == former else before.name, scene.objects.get(before.name) == before
        collections = list(before.users_collection)
        for collection in collections:
            collection.objects.link(copy)
            collection.objects.unlink(before)  # first, or what follows would put the copy there a second time
        before.user_remap(copy)
        if was_edited(before, body):
            for collection in collections:
                collection.objects.link(before)
            aside.append(put_aside(before))
        else:
            bpy.data.objects.remove(before)
    outfit = None if shown else _collection_of(scene, body)
    if outfit is not None and copy not in set(outfit.objects):
        outfit.objects.link(copy)
    return name, aside


def _placed(item: bpy.types.Object, motion: NDArray[np.float64]) -> Matrix:
    """Return where a copy stands: moved with the body, and turned with it if that matters to a modifier.

    An object that hangs on nothing cannot be sheared, as one below a parent can that is scaled unevenly.
    """
    matrix = item.matrix_world.copy()
    moved = Matrix(motion.tolist())
    if mirror_axes(item):
        matrix = moved @ matrix
    else:
        matrix.translation = moved @ matrix.to_translation()
    return Matrix.LocRotScale(*matrix.decompose())


def _collection_of(scene: bpy.types.Scene, body: Side) -> bpy.types.Collection:
    """Find the collection of what was fitted to a body, or make it; it is added to the scene if it is not there."""
    found = [one for one in bpy.data.collections if cast("Any", one).get(BODY) == body.name]
    made = found[0] if found else bpy.data.collections.new(f"Outfit of {body.name}")
    cast("Any", made)[BODY] = body.name
    if made not in scene.collection.children_recursive:
        scene.collection.children.link(made)
    return made
