# SPDX-License-Identifier: GPL-3.0-or-later
"""Fitted items as objects: copies with weights and an armature, keys, and colors."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np
from scipy.sparse import csr_array

from ...common.access import mesh_of
from ...common.errors import ObjectError
from ...common.long_names import LONGEST_KEY, shortened
from ...common.phrases import listed
from ...scene.armatures import find_armature
from ...scene.binding import bind
from ...scene.deform_layer import read_group, write_weights
from ...scene.modifier_bindings import bind_again
from ...scene.pair import check_writable
from ...scene.shape_key_io import (
    KeySettings,
    add_keys,
    check_keys_writable,
    key_positions,
    keys_of,
    locked_keys,
    shape_key_names,
)
from ...scene.worn.fitted_copies import former_names, mark_names
from ...scene.worn.garment_shape_io import write_shape
from ...scene.worn.garments import fitted_copy
from ...storage.writing import clear, prefixes
from .fit_colors import drop_colors
from .item_reading import painted_groups

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ....engine import FittedItem
    from ...scene.character import Side
    from .item_weights import ItemWeights

_KEY = "Fit to "
"""What the name of a shape key begins with that fits the item itself to a body."""

_FITS = "hiermatch_fits"
"""Custom property of an item: the names of its shape keys that fit it to bodies, as a JSON text."""


def check_key(obj: bpy.types.Object, target: Side) -> None:
    """Make sure that a shape key can be written on an item that moves it to another body.

    Raises
    ------
    ObjectError
        If it cannot.
    """
    name = _key_name(target.name)
    check_keys_writable(obj, [name])
    check_writable(obj)
    if name in locked_keys(obj):
        raise ObjectError(f'The shape key "{name}" of "{obj.name}" is locked. Unlock it, or take the item out.')


def _key_name(body: str) -> str:
    """Name the key that fits an item to a body."""
    return shortened(f"{_KEY}{body}", LONGEST_KEY)


def write_key(obj: bpy.types.Object, target: Side, fitted: FittedItem) -> None:
    """Write a shape key that moves the item itself to the other body; one of before stays as far on as it was."""
    matrix = np.linalg.inv(np.array(obj.matrix_world, np.float64))
    local = fitted.positions @ matrix[:3, :3].T + matrix[:3, 3]
    keys = keys_of(obj)
    rest = (
        np.array([vertex.co for vertex in mesh_of(obj).vertices]) if keys is None else key_positions(keys.reference_key)
    )
    name = _key_name(target.name)
    for former in former_names(target):
        renamed = None if keys is None else keys.key_blocks.get(_key_name(former))
        if renamed is not None and name not in shape_key_names(obj):
            renamed.name = name
    mark_names(obj, target)
    before = None if keys is None else keys.key_blocks.get(name)
    others = _fit_keys(obj)
    settings = KeySettings(name, value=float(not others)) if before is None else KeySettings.of(before, ())
    add_keys(obj, [settings], (local - rest)[None])
    cast("Any", obj)[_FITS] = json.dumps(list(dict.fromkeys([*others, name])))


def _fit_keys(obj: bpy.types.Object) -> list[str]:
    """Return the names of the shape keys that fit an item itself to bodies.

    Those of an older version are told by the names of bodies.
    """
    bodies = (*bpy.data.objects, *bpy.data.collections)
    known = {*json.loads(cast("Any", obj).get(_FITS, "[]")), *(_key_name(body.name) for body in bodies)}
    return [name for name in shape_key_names(obj) if name in known]


def write_copy(
    context: bpy.types.Context,
    item: bpy.types.Object,
    bodies: tuple[Side, Side],
    fitted: FittedItem,
    *,
    weights: ItemWeights | None,
    motion: NDArray[np.float64],
) -> tuple[bpy.types.Object, list[str]]:
    """Write a fitted copy of what moved on the whole by a motion (4, 4); return it, and what is to be known."""
    source, target = bodies
    growth = float(np.median(fitted.scales))
    copy, kept, aside = fitted_copy(context, item, source, target, motion=motion, growth=growth)
    notes = _notes_on(copy, item, target, kept, aside)
    _drop_fit_keys(copy)
    drop_colors(copy)
    write_shape(copy, item, fitted.positions, fitted.rotations * fitted.scales[:, None, None])
    armature = find_armature(target)
    if armature is None:
        notes.append(
            f'"{target.name}" has no armature, so what was fitted to it is not bound. Give it one by Retarget, '
            "and fit it again."
        )
    elif weights is not None:
        _write_weights(copy, weights)
        if weights.lost and not weights.from_skin:
            notes.append(
                f'The armature "{armature.name}" has no bones {listed(weights.lost)} of "{item.name}". What they '
                "moved is moved by the bones of the skin below."
            )
    mover = find_armature(source)
    for modifier in [modifier for modifier in copy.modifiers if modifier.type == "ARMATURE"]:
        changed: Any = modifier
        if armature is None and changed.object in (mover, None):
            copy.modifiers.remove(modifier)
        elif changed.object == mover:
            changed.object = armature
    if armature is not None:
        bind(copy, armature, item)
    for prefix in reversed(prefixes(copy)):  # a match of the item is none of its copy
        clear(copy, prefix)
    loose = bind_again(context, copy, target)
    if loose:
        notes.append(f'{listed(loose)} of "{copy.name}" could not be bound to "{target.name}". Bind it by hand.')
    return copy, notes


def _drop_fit_keys(copy: bpy.types.Object) -> None:
    """Take from a copy the shape keys that fit the item itself to bodies: it would be fitted twice."""
    keys = keys_of(copy)
    fits = [] if keys is None else [keys.key_blocks[name] for name in _fit_keys(copy)]
    for key in fits:
        copy.shape_key_remove(key)
    if fits and not shape_key_names(copy):
        copy.shape_key_clear()


def _notes_on(
    copy: bpy.types.Object, item: bpy.types.Object, target: Side, kept: list[str], aside: list[str]
) -> list[str]:
    """Say what drivers of a copy still read, and what is kept of the one that it replaces."""
    notes = []
    for name in aside:
        notes.append(
            f'"{copy.name}" was edited after it had been fitted. As it was then it is kept, hidden, as {listed(aside)}.'
        )
        painted = [group for group in painted_groups if _painted_anew(bpy.data.objects[name], item, group)]
        if painted:
            notes.append(
                f'What was painted on "{copy.name}" in {listed(painted)} changes nothing: paint it on "{item.name}".'
            )
    if kept:
        notes.append(
            f'Drivers of "{copy.name}" still read from {listed(kept)}: "{target.name}" has not '
            "what they need. Carry its shape keys or bones over by Retarget, and fit it again."
        )
    return notes


def _painted_anew(copy: bpy.types.Object, item: bpy.types.Object, group: str) -> bool:
    """Tell whether something is painted in a group of a copy that is not so on its item."""
    there, here = np.nan_to_num(read_group(copy, group)), np.nan_to_num(read_group(item, group))
    return bool(there.any()) and not np.array_equal(there, here)


def _write_weights(copy: bpy.types.Object, weights: ItemWeights) -> None:
    """Write weights where they are not locked, and drop the groups of bones that are not there."""
    for name in weights.lost:
        if name in copy.vertex_groups:  # a bone that the item hung on has none
            copy.vertex_groups.remove(copy.vertex_groups[name])
    free = [number for number, name in enumerate(weights.names) if name not in weights.locked]
    write_weights(copy, [weights.names[number] for number in free], csr_array(weights.weights[:, free]))
