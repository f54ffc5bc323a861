# SPDX-License-Identifier: GPL-3.0-or-later
"""Small loose parts that move as one: eyes, teeth, buttons."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array

from .skin_weights import with_rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...mesh.connectivity.welded_parts import WeldedParts
    from ...mesh.surface_map import SurfaceMap

__all__ = ["with_rigid_parts"]

_ALIKE = 1e-3
"""Rows of weights that differ by less than this in each entry are the same."""


def with_rigid_parts(
    weights: csr_array,
    parts: WeldedParts,
    source_weights: csr_array,
    source_parts: WeldedParts,
    surface_map: SurfaceMap,
) -> csr_array:
    """Let small parts move as one whose counterparts do.

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

    Returns
    -------
    (n, g) csr_array of float
        The weights; those of each small part (an eye, a button, a tooth) of which most vertices lie on a part of the
        source whose vertices all have the same weights are these.
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
    vertices = np.flatnonzero(chosen[labels])
    return with_rows(weights, vertices, source_weights[first[counterpart[labels[vertices]]]])


def _rigid_rows(weights: csr_array, parts: WeldedParts) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Return the first vertex of each part (p,), and whether all its vertices have the same weights (p,)."""
    labels = parts.vertex_labels
    first = np.unique(labels, return_index=True)[1]
    difference = abs(weights - weights[first[labels]]).tocoo()
    loose = np.zeros(len(first), bool)
    loose[labels[difference.coords[0][difference.data > _ALIKE]]] = True
    return first, ~loose
