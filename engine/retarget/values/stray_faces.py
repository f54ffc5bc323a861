# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that lie on the wrong side of a seam: cut off from their sheet, or reaching into another."""

from __future__ import annotations

import numpy as np

from ...mesh.connectivity.components import joined_components
from ...mesh.polygons import Polygons
from ...runtime.arrays import TINY, Bools, Floats, Ints, group_largest, numbered

_SPLINTER = 0.005
"""Faces that hang together are a splinter if they have less than this part of the area of others of their sheet."""

_TOOTH = 0.52
"""A face reaches into another part if more of its outline than this is against it; a little more than one half."""

_LARGE = 20.0
"""How many times the area of a face the parts on both sides have, so that no small part is eaten up."""


def splinters(polygons: Polygons, seams: Bools, labels: Ints, areas: Floats) -> tuple[Ints, Ints]:
    """Find faces that were cut off from the rest of their sheet, and for each a neighbour to go with instead.

    Parameters
    ----------
    polygons : Polygons
        The faces.
    seams : (e,) array of bool
        Edges across which faces do not hang together.
    labels : (f,) array of int
        The sheet that each face is on.
    areas : (f,) array of float
        Area of each face.

    Returns
    -------
    faces, neighbours : (k,) array of int
        Small faces apart from the main part of their sheet, and of each a face of a larger part beside it.
    """
    pairs = polygons.neighbours
    sides = polygons.corner_faces[pairs]  # (p, 2)
    cut = seams[polygons.corner_edges[pairs[:, 0]]]
    part = joined_components(polygons.face_count, *sides[~cut].T)
    area = np.bincount(part, areas)
    largest = group_largest(labels, area[part], int(labels.max(initial=0)) + 1)
    small = area[part] < _SPLINTER * largest[labels]
    across = np.concatenate([sides[cut], sides[cut][:, ::-1]])
    across = across[small[across[:, 0]] & (area[part[across[:, 1]]] > area[part[across[:, 0]]])]
    # Of several neighbours that in the largest part.
    across = across[np.lexsort((across[:, 1], -area[part[across[:, 1]]], across[:, 0]))]
    faces, first = np.unique(across[:, 0], return_index=True)
    return faces, across[first, 1]


def teeth(polygons: Polygons, seams: Bools, movable: Bools, areas: Floats, lengths: Floats) -> tuple[Ints, Ints]:
    """Find faces that reach from one part into another, so that the seam would be shorter without them.

    Parameters
    ----------
    polygons : Polygons
        The faces.
    seams : (e,) array of bool
        Edges across which faces do not hang together.
    movable : (f,) array of bool
        Which faces may be found: those that lie on both sides of a border.
    areas : (f,) array of float
        Area of each face.
    lengths : (e,) array of float
        Length of each edge.

    Returns
    -------
    faces, neighbours : (k,) array of int
        Such faces of large parts, no two of them side by side, and of each the face across its longest seam.
    """
    pairs = polygons.neighbours
    sides = polygons.corner_faces[pairs]  # (p, 2)
    edge = polygons.corner_edges[pairs[:, 0]]
    cut = seams[edge]
    part = joined_components(polygons.face_count, *sides[~cut].T)
    area = np.bincount(part, areas)
    across = np.concatenate([sides[cut], sides[cut][:, ::-1]])
    face, other = across.T
    length = np.tile(lengths[edge[cut]], 2)
    # What counts is the length against one other part.
    keys, group = np.unique(face * polygons.face_count + part[other], return_inverse=True)
    against = np.bincount(group.ravel(), length, len(keys))[group.ravel()]
    outline = np.bincount(polygons.corner_faces, lengths[polygons.corner_edges], polygons.face_count)
    large = (area[part[face]] > _LARGE * areas[face]) & (area[part[other]] > _LARGE * areas[face])
    reaching = np.flatnonzero(movable[face] & large & (against > _TOOTH * outline[face]))
    reaching = reaching[np.lexsort((other[reaching], -length[reaching], face[reaching]))]
    faces, first = np.unique(face[reaching], return_index=True)
    beside = other[reaching][first]
    # Of two side by side only the better one goes.
    gain = (against / np.maximum(outline[face], TINY))[reaching][first]
    rank = numbered(faces[np.lexsort((-faces, gain))], polygons.face_count)
    best = group_largest(sides.ravel(), rank[sides[:, ::-1]].ravel(), polygons.face_count, -1)
    goes = rank[faces] > best[faces]
    return faces[goes], beside[goes]
