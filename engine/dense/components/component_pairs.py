# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of components of two meshes: by size, shape and place, and by where they touch what is mapped already."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from ...geometry.procrustes import least_turns
from ...mesh.connectivity.adjacency import edge_graph
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, Ints, unit_vectors
from .similarity_field import Surroundings

_LARGEST_OFFSET = 1.5
"""How far from where it is expected a partner may be, in sums of the two radii."""

_BLUR = 0.01
"""How exactly the place of a part can be known from its surroundings, in units of the root of the main part's area."""

_LARGEST_RATIO = 2.0
"""By what factor the radii of partners may differ, once the scale of the surroundings is allowed for."""

_LARGEST_DEFORMATION = 0.3
"""How much the widths of partners along their main axes may differ, in radii."""

_TOUCHING = 0.2
"""How much farther than its nearest vertex, in radii, those of a part may be that touch its surroundings."""

_SWUNG = 0.25
"""What a part that has swung about where it touches counts as out of place, against one that was moved so far."""

_BENT, _LARGEST_LENGTHENING = 2.0, 1.25
"""How many times as much a large part may be deformed that is as long for its area, up to this factor: a leg with its
knee."""

_JOINT, _LARGEST_ELSEWHERE = 0.3, 3.0
"""Part of the sum of the radii by which a large part may touch its surroundings elsewhere to count as much as the
largest offset, and what that counts at most."""

_LYING, _STANDING = 0.9, 0.5
"""Part of the vertices that touch the surroundings from which on a large part lies on them as clothes do, and below
which one does not; by hand: garments of ``python -m tests.benchmarks.clothed`` touch with all of theirs (looked at
once)."""

_NOT_POSSIBLE = 20.0
"""No pair costs more than that of leaving a part alone, so that as many as possible are made."""


@dataclass(frozen=True, eq=False)
class Contact:
    """Where a part is next to its surroundings: the vertices that touch (v,), their middle (3,), and the distance."""

    vertices: Ints
    place: Floats
    gap: float


@dataclass(frozen=True, eq=False)
class PartPair:
    """Parts that belong together.

    Attributes
    ----------
    part, partner : int
        Their positions in the sequences that were given.
    rotations : list of (3, 3) array of float
        How the part may be turned: as its surroundings are, and as it may have swung about where it touches them.
    ratio : float
        By how much the partner is larger.
    radius : float
        Root mean square distance of the partner from its centre.
    centres : pair of (3,) arrays of float
        Centres of both.
    touching : (v,) array of int
        Vertices of the part that touch its surroundings.
    joint : (3,) array of float
        Where these are expected on Y.
    """

    part: int
    partner: int
    rotations: list[Floats]
    ratio: float
    radius: float
    centres: tuple[Floats, Floats]
    touching: Ints
    joint: Floats


@dataclass(frozen=True, eq=False)
class _Extents:
    """Centres (p, 3), areas (p,), root mean square radii (p,) and widths along the main axes in radii (p, 3)."""

    centres: Floats
    areas: Floats
    radii: Floats
    widths: Floats

    @classmethod
    def of(cls, parts: Sequence[TriangleMesh]) -> _Extents:
        """Integrate over the surfaces of parts."""
        centres, moments = np.empty((len(parts), 3)), np.empty((len(parts), 3, 3))
        areas = np.array([part.area for part in parts])
        for index, part in enumerate(parts):
            shares = part.triangle_areas / part.area
            corners = part.vertices[part.triangles]
            middles = corners.mean(axis=1)
            centres[index] = shares @ middles
            away, middles = corners - centres[index], middles - centres[index]
            moments[index] = np.einsum("m,mci,mcj->ij", shares, away, away) / 12
            moments[index] += np.einsum("m,mi,mj->ij", shares, middles, middles) * 9 / 12
        spreads = np.sqrt(np.linalg.eigvalsh(moments).clip(min=0))
        radii = np.linalg.norm(spreads, axis=1)
        return cls(centres, areas, radii, spreads / radii[:, None])


def _length(part: TriangleMesh) -> float:
    """Length along edges from one end of a part to the other, in the root of its area: it stays where a part bends."""
    graph = edge_graph(part)
    end, length = 0, 0.0
    for _ in range(2):
        distances = dijkstra(graph, directed=False, indices=end)
        distances[~np.isfinite(distances)] = 0
        end = int(distances.argmax())
        length = float(distances[end])
    return max(length / np.sqrt(part.area), TINY)


def contact_with(distances: Floats, part: TriangleMesh) -> Contact:
    """Find where a part is next to its surroundings by the distances (n,) of its vertices from there."""
    touching = np.flatnonzero(distances <= distances.min() + _TOUCHING * radius_of(part))
    return Contact(touching, part.vertices[touching].mean(axis=0), float(distances.min()))


def paired_parts(
    here: tuple[Sequence[TriangleMesh], Sequence[Contact]],
    there: tuple[Sequence[TriangleMesh], Sequence[Contact]],
    around: Surroundings,
    unit: float,
    large: Bools,
) -> list[PartPair]:
    """Find which parts of X and Y belong together.

    A part is expected where its surroundings have moved it, or somewhere around where it touches them: a forearm that
    is a part of its own swings about the elbow.  What lies on its surroundings, as trousers do, goes with nothing that
    hardly touches them.

    Parameters
    ----------
    here, there : pair of sequences of TriangleMesh and of Contact
        The parts of X and of Y, and where each is next to the surroundings.
    around : Surroundings
        What is mapped already, and how space moves around it.
    unit : float
        Root of the area of the main part of Y.
    large : (p,) array of bool
        For each part of X, whether it matters where it touches its surroundings: left legs are like right ones in all
        else, and cross them, but hang on other hips.  Of small parts it is not known so well.

    Returns
    -------
    list of PartPair
        Each part is in one pair at most; the sum of the differences is the least for as many pairs as there can be.
    """
    (x_parts, contacts), (y_parts, its_contacts) = here, there
    if not x_parts or not y_parts:
        return []
    x, y = _Extents.of(x_parts), _Extents.of(y_parts)
    distances, _ = around.nearest(x.centres)
    similarities = around.similarities(x.centres, np.maximum(x.radii, distances))
    expected, radii = similarities(x.centres), similarities.scales * x.radii
    sums = radii[:, None] + y.radii + _BLUR * unit
    moved = np.linalg.norm(expected[:, None] - y.centres, axis=2) / sums

    places = np.array([contact.place for contact in contacts])
    near = around.similarities(places, np.maximum([contact.gap for contact in contacts], x.radii / 2))
    joints, arms = near(places), near.scales * np.linalg.norm(x.centres - places, axis=1)
    away = np.stack([cKDTree(part.vertices).query(joints)[0] for part in y_parts], axis=1) / sums
    reaching = np.abs(np.linalg.norm(joints[:, None] - y.centres, axis=2) - arms[:, None]) / sums
    offset = np.minimum(moved, away + reaching + _SWUNG * moved)

    size = np.abs(np.log(radii[:, None] / y.radii)) / np.log(_LARGEST_RATIO)
    areas = similarities.scales**2 * x.areas
    size = np.maximum(size, np.abs(np.log(areas[:, None] / y.areas)) / np.log(_LARGEST_RATIO**2))
    shape = np.abs(x.widths[:, None] - y.widths).max(axis=2) / _LARGEST_DEFORMATION
    difference = offset / _LARGEST_OFFSET + size + shape
    possible = (offset <= _LARGEST_OFFSET) & (size <= 1) & (shape <= np.where(large, _BENT, 1.0)[:, None])
    for i, j in np.argwhere(possible & (shape > 1)):
        longer = np.log(_length(x_parts[i]) / _length(y_parts[j]))
        possible[i, j] = np.abs(longer) < np.log(_LARGEST_LENGTHENING)
    here_lying, there_lying = (
        np.array([len(contact.vertices) / part.vertex_count for part, contact in zip(*side, strict=True)])
        for side in (here, there)
    )
    possible &= ~(large & (here_lying > _LYING))[:, None] | (there_lying >= _STANDING)
    apart = np.linalg.norm(joints[:, None] - [contact.place for contact in its_contacts], axis=2)
    elsewhere = apart / (_JOINT * (radii[:, None] + y.radii) + _BLUR * unit)
    costs = difference + np.where(large[:, None], np.minimum(elsewhere, _LARGEST_ELSEWHERE), 0)
    rows, columns = linear_sum_assignment(np.where(possible, costs, _NOT_POSSIBLE))
    return [
        PartPair(
            int(i),
            int(j),
            [similarities.rotations[i], _swung(near.rotations[i], x.centres[i] - places[i], y.centres[j] - joints[i])],
            float(y.radii[j] / x.radii[i]),
            float(y.radii[j]),
            (x.centres[i], y.centres[j]),
            contacts[i].vertices,
            joints[i],
        )
        for i, j in zip(rows, columns, strict=True)
        if possible[i, j]
    ]


def radius_of(part: TriangleMesh) -> float:
    """Root mean square distance of the vertices from their centre."""
    return float(np.sqrt(np.square(part.vertices - part.vertices.mean(axis=0)).sum(axis=1).mean()))


def _swung(rotation: Floats, arm: Floats, there: Floats) -> Floats:
    """Turn an arm (3,) as a rotation does, and then the shortest way to the direction where it is there (3,)."""
    start, end = unit_vectors(np.stack([rotation @ arm, there]))
    return least_turns(start, end) @ rotation
