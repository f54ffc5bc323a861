# SPDX-License-Identifier: GPL-3.0-or-later
"""Fitted copies of clothes: of which item and for which body, also after renaming, and whether they were edited since.

A copy names its item and its body.  These are marked in turn with what they were called then.  Such a mark tells
more than a pointer from the copy would: a copy that is brought to another file takes no body along.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any, Final, cast

import bpy
import numpy as np

from ...common.long_names import LONGEST_ID, shortened
from ..character import FITTED_TO, armatures_above, parts_of, positions_of, topology_of
from ..deform_layer import read_weights
from ..plain_settings import written_settings
from ..shape_key_io import key_positions, keys_of
from .modifier_pointers import node_inputs, used_beside

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..character import Side

ITEM, BODY = "hiermatch_item", FITTED_TO
"""Custom properties of a fitted copy: the names of the original, and of the body that it was fitted to."""

COVERED: Final = "Below Clothes"
"""Name of the group, the key and the modifier by which a body is drawn in or hidden below clothes."""

_ITEM_MARK: Final = "hiermatch_item_name"
"""Custom property of an item: what it was called when it was fitted last."""

_BODY_MARK: Final = "hiermatch_body_name"
"""Custom property of the parts of a body: what this was called when something was fitted to it last."""

_AS_FITTED: Final = "hiermatch_as_fitted"
"""Custom property of a fitted copy: a text that is another one once the copy was edited."""

_PLACE: Final = "hiermatch_fitted_place"
"""Custom property of a fitted copy: where it stood when it was fitted, as the numbers of a matrix; see `_place`."""


def fitted_name(item: str, body: str) -> str:
    """Return the name of a fitted copy."""
    return f"{item} on {body}"


def fitted_to(body: Side) -> list[bpy.types.Object]:
    """Return all that was fitted to a body, also under a name that it had before."""
    names = {body.name, *former_names(body)}
    return [obj for obj in bpy.data.objects if obj.type == "MESH" and cast("Any", obj).get(BODY) in names]


def former_names(body: Side) -> list[str]:
    """Return by what other names a body may be known to what was fitted to it; none that now is another one's.

    A body of several objects has another name when it is picked in another way, too.
    """
    marks = dict.fromkeys(cast("Any", part).get(_BODY_MARK, "") for part in parts_of(body))
    return [name for name in marks if name and name != body.name and not _is_anothers(name, body)]


def made_copy(item: bpy.types.Object, body: Side) -> bpy.types.Object | None:
    """Find the copy of an item that was fitted to a body before, also if one of them has been renamed since."""
    names = [item.name]
    former = cast("Any", item).get(_ITEM_MARK, "")
    if former and former not in bpy.data.objects:
        names.append(former)
    found = [obj for name in names for obj in fitted_to(body) if cast("Any", obj).get(ITEM) == name]
    return found[0] if found else None


def original_of(copy: bpy.types.Object) -> bpy.types.Object | None:
    """Find the item that a copy was made from, also if that has been renamed since; None of what is no copy.

    The item may be a copy itself that was fitted to another body.
    """
    mine: Any = copy
    if BODY not in mine or ITEM not in mine:
        return None
    objects: Any = bpy.data.objects
    same = objects.get(mine[ITEM])
    if same is not None:
        return None if same.get(BODY) == mine[BODY] else cast("bpy.types.Object", same)
    marked = (obj for obj in objects if obj.get(_ITEM_MARK) == mine[ITEM] and obj.get(BODY) != mine[BODY])
    return next(marked, None)


def adopt(body: Side) -> None:
    """Let all that was fitted to a body know it by the name that it has now.

    What is called after a name that nothing has any more is called after the new one, but what the user has named.
    """
    for former in former_names(body):
        gone = not _called(former)
        for obj in bpy.data.objects:
            mine: Any = obj
            if mine.get(BODY) == former:
                mine[BODY] = body.name
                if gone and obj.name == fitted_name(mine.get(ITEM, ""), former):
                    obj.name = fitted_name(mine[ITEM], body.name)
        for collection in bpy.data.collections:
            kept: Any = collection
            if kept.get(BODY) == former:
                kept[BODY] = body.name
                collection.name = collection.name.replace(former, body.name) if gone else collection.name


def mark_names(item: bpy.types.Object, body: Side) -> None:
    """Mark an item and a body with what they are called, as far as they are this file's own."""
    for marked, mark, name in ((item, _ITEM_MARK, item.name), *((p, _BODY_MARK, body.name) for p in parts_of(body))):
        if marked.library is None and marked.override_library is None:
            cast("Any", marked)[mark] = name


def unmark(copy: bpy.types.Object) -> None:
    """Take from the copy of an item what marks the item."""
    marks: Any = copy
    for mark in (_ITEM_MARK, _BODY_MARK):
        if mark in marks:
            del marks[mark]


def as_fitted(copy: bpy.types.Object, body: Side) -> None:
    """Say that a copy is now as it was fitted to a body."""
    mine: Any = copy
    mine[_AS_FITTED], mine[_PLACE] = _state(copy, body), " ".join(map(str, _place(copy, body).ravel()))


def was_edited(copy: bpy.types.Object, body: Side) -> bool:
    """Tell whether a copy was edited since it was fitted to a body, or moved on it, as far as that is known."""
    mine: Any = copy
    known, place = mine.get(_AS_FITTED, ""), np.array(mine.get(_PLACE, "").split(), np.float64)
    if known and known != _state(copy, body):
        return True
    return bool(len(place)) and not np.allclose(_place(copy, body).ravel(), place, rtol=1e-4, atol=1e-5)


def put_aside(copy: bpy.types.Object) -> str:
    """Keep a copy that another one has replaced, hidden and under another name; return that."""
    marks: Any = copy
    for mark in (ITEM, _AS_FITTED, _PLACE):  # it stays marked as worn: it is no part of the body
        if mark in marks:
            del marks[mark]
    copy.name = shortened(copy.name, LONGEST_ID, " (edited)")
    copy.hide_render = True
    layer = cast("bpy.types.ViewLayer", bpy.context.view_layer)
    layer.update()  # or it would not know of what was put into a collection just now
    if copy.name in cast("Any", layer).objects:
        copy.hide_set(state=True)
    return copy.name


def _called(name: str) -> list[bpy.types.ID]:
    """Return what has a name that a body may have."""
    every: tuple[Any, ...] = (bpy.data.objects, bpy.data.collections)
    return [kind[name] for kind in every if name in kind]


def _is_anothers(name: str, body: Side) -> bool:
    """Tell whether a name is that of something else than a body, its armatures and collections."""
    parts = parts_of(body)
    own: set[bpy.types.ID] = {*parts, *(armature for part in parts for armature in armatures_above(part))}
    own |= {one for one in bpy.data.collections if not own.isdisjoint(one.all_objects)}
    return any(one not in own for one in _called(name))


def _place(copy: bpy.types.Object, body: Side) -> NDArray[np.float64]:
    """Return where a copy stands on its parent, or else on the body, (4, 4): it may go anywhere along with them."""
    basis = np.array(copy.matrix_basis, np.float64)
    if copy.parent is not None:
        return np.array(copy.matrix_parent_inverse, np.float64) @ basis
    return np.linalg.pinv(np.array(parts_of(body)[0].matrix_world, np.float64)) @ basis


def _settings(copy: bpy.types.Object, modifier: bpy.types.Modifier) -> str:
    """Write what is set on a modifier, but for what drivers set."""
    animation, start = copy.animation_data, f'modifiers["{bpy.utils.escape_identifier(modifier.name)}"].'
    driven = {curve.data_path for curve in animation.drivers} if animation else set()
    given = {
        name: getattr(value, "name", list(value) if hasattr(value, "__len__") else value)
        for name, (_, value) in node_inputs(modifier).items()
        if not isinstance(value, bpy.types.Object) and not any(name in path for path in driven)
    }
    without = {path.removeprefix(start) for path in driven if path.startswith(start)}
    return f"{written_settings(modifier, without)}{given or ''}"


def _state(copy: bpy.types.Object, body: Side) -> str:
    """Describe the form of a copy on a body, its weights, modifiers and materials."""
    digest = hashlib.blake2b(digest_size=16)
    for text in (topology_of(copy), positions_of(copy), *(group.name for group in copy.vertex_groups)):
        digest.update(f"{text}\0".encode())
    keys = keys_of(copy)
    for key in () if keys is None else keys.key_blocks:
        digest.update(f"{key.name}\0".encode() + key_positions(key).astype(np.float32).tobytes())
    weights = read_weights(copy).sorted_indices() if len(copy.vertex_groups) else None
    if weights is not None:
        digest.update(weights.data.astype(np.float32).tobytes() + weights.indices.astype(np.int64).tobytes())
    for modifier in copy.modifiers:
        digest.update(f"{modifier.type} {modifier.name} {_settings(copy, modifier)}\0".encode())
    used = {one.name for _, one in used_beside(copy, body) if BODY not in cast("Any", one)}
    digest.update("\0".join(sorted(used)).encode())
    for slot in copy.material_slots:
        digest.update(f"{slot.material.name if slot.material else ''}\0".encode())
    return digest.hexdigest()
