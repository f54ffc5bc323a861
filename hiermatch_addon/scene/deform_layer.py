# SPDX-License-Identifier: GPL-3.0-or-later
"""All weights of an object's vertex groups as one sparse matrix: read, and written.

Blender keeps for each vertex a list of groups and weights, and has no bulk access to them.  So they are read in one
pass over the vertices, and written in two: each group takes all its vertices at once, then each vertex all its weights
at once.  The mesh itself is never rebuilt, so nothing else on it can change.
"""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import csc_array, csr_array

from ..common.access import mesh_of
from ..common.errors import ObjectError
from .pair import check_own_mesh, check_writable

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import bpy
    from numpy.typing import NDArray

_read_once: ContextVar[dict[int, csr_array] | None] = ContextVar("_read_once", default=None)
"""What was read of each object, by its address, while `reading_once` is in force."""


@contextmanager
def reading_once() -> Iterator[None]:
    """Read the weights of each object once, however often they are asked for: nothing may be written meanwhile."""
    token = _read_once.set({})
    try:
        yield
    finally:
        _read_once.reset(token)


def check_weights_writable(obj: bpy.types.Object) -> None:
    """Make sure that the weights of a mesh object can be written.

    Raises
    ------
    ObjectError
        If its mesh is another file's, belongs to other objects too, or is being edited.
    """
    check_writable(obj)
    check_own_mesh(obj)
    if obj.mode == "EDIT":
        raise ObjectError(f'"{obj.name}" is in Edit Mode. Switch to Object Mode first.')


def read_weights(obj: bpy.types.Object) -> csr_array:
    """Read the weights of all vertex groups.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object, not in Edit Mode.

    Returns
    -------
    (n, g) csr_array of float
        For each vertex and each of `obj.vertex_groups`, in their order, the weight, 0 to 1, whatever some file or
        script has left there; without entries that are zero, or no number.
    """
    weights = _stored(obj)[:, : len(obj.vertex_groups)]
    weights.data[np.isnan(weights.data)] = 0
    weights.eliminate_zeros()
    return weights


def read_group(obj: bpy.types.Object, name: str) -> NDArray[np.float64]:
    """Read the weights of one vertex group, (n,), nan at vertices that are not in it; nowhere if there is none."""
    found = np.full(len(mesh_of(obj).vertices), np.nan)
    group = obj.vertex_groups.get(name)
    if group is not None:
        stored = _stored(obj).tocsc()
        own = slice(stored.indptr[group.index], stored.indptr[group.index + 1])
        found[stored.indices[own]] = stored.data[own]
    return found


def write_weights(obj: bpy.types.Object, names: Sequence[str], weights: csr_array) -> None:
    """Write the weights of some vertex groups in full.

    Groups that do not exist are added at the end of the list.  All other groups, the order of the list, which group is
    active and which are locked stay as they are; whether a group is locked is not asked here.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object whose weights can be written (`check_weights_writable`).
    names : sequence of str
        Names of g different groups.
    weights : (n, g) csr_array of float
        Their weights, 0 to 1.  A vertex is in a group if its weight there is more than zero.

    Raises
    ------
    ObjectError
        If the weights cannot be written; nothing is changed then.
    ValueError
        If the weights are not those of so many vertices and groups.
    """
    check_weights_writable(obj)
    mesh = mesh_of(obj)
    columns = _as_columns(weights, (len(mesh.vertices), len(names)))
    if len(set(names)) < len(names):
        raise ValueError("Each vertex group can be written once, but a name is there twice.")
    active = obj.vertex_groups.active_index
    kept = _take_out(obj, names)
    for column, name in enumerate(names):
        group = obj.vertex_groups.get(name) or obj.vertex_groups.new(name=name)
        rows = columns.indices[columns.indptr[column] : columns.indptr[column + 1]]
        if len(rows):
            group.add(rows.tolist(), 1.0, "REPLACE")
    _set_last_weights(mesh, kept, columns.tocsr())
    obj.vertex_groups.active_index = max(active or 0, 0)
    mesh.update()


def _stored(obj: bpy.types.Object) -> csr_array:
    """Read what is stored, (n, g or more), from 0 to 1: entries may be zero, no number, or of groups that are gone."""
    kept = _read_once.get()
    if kept is None:
        return _freshly_stored(obj)
    address = obj.as_pointer()
    if address not in kept:
        kept[address] = _freshly_stored(obj)
    return kept[address].copy()


def _freshly_stored(obj: bpy.types.Object) -> csr_array:
    """Read what is stored, whatever was read before."""
    mesh = mesh_of(obj)
    groups: list[Any] = []
    weights: list[float] = []
    starts = [0]
    if not len(obj.vertex_groups):
        return csr_array((len(mesh.vertices), 0))
    for vertex in mesh.vertices:
        for element in vertex.groups:
            groups.append(element.group)
            weights.append(element.weight)
        starts.append(len(groups))
    width = max(len(obj.vertex_groups), max(groups, default=-1) + 1)
    held = np.clip(np.array(weights, np.float64), 0, 1)
    stored = csr_array((held, np.array(groups, np.int64), starts), (len(starts) - 1, width))
    stored.sort_indices()
    return stored


def _take_out(obj: bpy.types.Object, names: Sequence[str]) -> NDArray[np.int64]:
    """Take all vertices out of these groups; return in how many others each vertex (n,) still is.

    All go before any is added: Blender fills the gap in a vertex's list with the last one, which mixes the order.
    """
    members = _stored(obj).tocsc()
    others = np.ones(members.shape[1], bool)
    for name in names:
        index = obj.vertex_groups.find(name)
        if index >= 0:
            before = members.indices[members.indptr[index] : members.indptr[index + 1]]
            obj.vertex_groups[index].remove(before.tolist())
            others[index] = False
    return np.bincount(members[:, others].indices, minlength=members.shape[0])


def _as_columns(weights: csr_array, shape: tuple[int, int]) -> csc_array:
    """Return the weights above zero by columns.

    Raises
    ------
    ValueError
        If they do not have that shape, or are not from 0 to 1.
    """
    if weights.shape != shape:
        raise ValueError(f"The weights should have the shape {shape}, but have {weights.shape}.")
    columns = weights.tocsc(copy=True)
    columns.sum_duplicates()
    # The tolerance is for rounding in sums.
    if not ((columns.data >= 0) & (columns.data <= 1 + 1e-6)).all():
        raise ValueError("Weights of vertex groups should be between 0 and 1.")
    columns.data = np.minimum(columns.data, 1)
    columns.eliminate_zeros()
    columns.sort_indices()
    return columns


def _set_last_weights(mesh: bpy.types.Mesh, kept: NDArray[np.int64], rows: csr_array) -> None:
    """Give each vertex its weights (n, g) in the order of the columns, after the `kept` (n,) ones that it has first."""
    rows.sort_indices()
    values, starts = rows.data.astype(np.float32), rows.indptr.tolist()
    for vertex, before, start, end in zip(mesh.vertices, kept.tolist(), starts[:-1], starts[1:], strict=True):
        if start == end:
            continue
        if not before:
            vertex.groups.foreach_set("weight", values[start:end])
            continue
        whole = np.empty(before + end - start, np.float32)
        vertex.groups.foreach_get("weight", whole)
        whole[before:] = values[start:end]
        vertex.groups.foreach_set("weight", whole)
