# SPDX-License-Identifier: GPL-3.0-or-later
"""Loose parts that move as one: eyes, teeth, buttons, buckles, and the plates of a robot."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_map import SurfaceMap
from ...runtime.arrays import Bools, Floats, Ints, marked
from .skin_weights import with_rows

_ALIKE = 1e-3
"""Rows of weights that differ by less than this in each entry are the same."""

_MOST = 0.8
"""So much of a part that is not small must lie on parts of the source that move as one, and together, if it is to."""


def with_rigid_parts(
    weights: csr_array,
    parts: WeldedParts,
    source_weights: csr_array,
    source_parts: WeldedParts,
    surface_map: SurfaceMap,
    *,
    free: Bools | None = None,
) -> csr_array:
    """Let parts move as one whose counterparts do.

    Parameters
    ----------
    weights : (n, g) csr_array of float
        Weights that were carried from the source.
    parts : WeldedParts
        The surface that they are on.
    source_weights : (m, g) csr_array of float
        The weights at the source.
    source_parts : WeldedParts
        The source.
    surface_map : SurfaceMap
        Where each of the n vertices lies on the source.
    free : (p,) array of bool, optional
        Parts that are left as they are.

    Returns
    -------
    (n, g) csr_array of float
        The weights.  A part gets those of its counterpart, a part of the source whose vertices all have the same
        weights: a small one (an eye, a button, a tooth) if most of its vertices lie there; a larger one (a helmet, a
        plate) if nearly all lie on such parts with the same weights.
    """
    labels = parts.vertex_labels
    if parts.part_count == 1:
        return weights
    hit = source_parts.vertex_labels[surface_map.nearest_vertices]
    votes = csr_array(
        (np.ones(len(labels), np.int64), (labels, hit)), shape=(parts.part_count, source_parts.part_count)
    )
    counterpart = np.asarray(votes.argmax(axis=1)).ravel()
    first, rigid = _rigid_rows(source_weights, source_parts)
    chosen = parts.small & rigid[counterpart]
    if source_parts.part_count > 1 and rigid.any():
        share, most = _shared_rows(votes, source_weights[first], rigid)
        larger = ~parts.small & (share >= _MOST)
        counterpart = np.where(larger, most, counterpart)
        chosen |= larger
    if free is not None:
        chosen &= ~free
    vertices = np.flatnonzero(chosen[labels])
    return with_rows(weights, vertices, source_weights[first[counterpart[labels[vertices]]]])


def with_single_bones(weights: csr_array, parts: WeldedParts, chosen: Bools, bones: Bools | None = None) -> csr_array:
    """Let parts move by one bone each: the one that has the most weight there.

    Parameters
    ----------
    weights : (n, g) csr_array of float
        Weights on the surface.
    parts : WeldedParts
        The surface.
    chosen : (p,) array of bool
        Which parts.  One without any weights stays as it is.
    bones : (g,) array of bool, optional
        Which columns are bones; all if not given.  The others stay.

    Returns
    -------
    (n, g) csr_array of float
        The weights.
    """
    columns = np.ones(weights.shape[1], bool) if bones is None else bones
    labels = parts.vertex_labels
    held = csr_array((np.ones(len(labels)), (labels, np.arange(len(labels)))), shape=(parts.part_count, len(labels)))
    sums = (held @ weights).toarray() * columns
    changed = np.flatnonzero((chosen & (sums.sum(axis=1) > 0))[labels])
    if not len(changed):
        return weights
    kept = csr_array(weights[changed]).tocoo()
    rows, places = kept.coords
    stay = ~columns[places]
    single = sums.argmax(axis=1)[labels[changed]]
    data = np.concatenate([kept.data[stay], np.ones(len(changed))])
    where = np.concatenate([rows[stay], np.arange(len(changed))]), np.concatenate([places[stay], single])
    return with_rows(weights, changed, csr_array((data, where), shape=(len(changed), weights.shape[1])))


def _rigid_rows(weights: csr_array, parts: WeldedParts) -> tuple[Ints, Bools]:
    """Return the first vertex of each part (p,), and whether all its vertices have the same weights (p,)."""
    labels = parts.vertex_labels
    first = np.unique(labels, return_index=True)[1]
    difference = abs(weights - weights[first[labels]]).tocoo()
    loose = marked(labels[difference.coords[0][difference.data > _ALIKE]], len(first))
    return first, ~loose


def _shared_rows(votes: csr_array, rows: csr_array, rigid: Bools) -> tuple[Floats, Ints]:
    """Find what most of each part lies on: of the votes (p, q), those for rigid parts with the same weights (q, g).

    Returns
    -------
    share : (p,) array of float
        Which part of the votes that is.
    part : (p,) array of int
        One of these rigid parts.
    """
    numbers = np.flatnonzero(rigid)
    _, examples, kinds = np.unique(
        np.round(rows[numbers].toarray() / _ALIKE), axis=0, return_index=True, return_inverse=True
    )
    gathered = csr_array((np.ones(len(numbers), np.int64), (numbers, kinds.ravel())), shape=(len(rigid), len(examples)))
    counts = (votes @ gathered).toarray()
    return counts.max(axis=1) / np.maximum(votes.sum(axis=1), 1), numbers[examples[counts.argmax(axis=1)]]
