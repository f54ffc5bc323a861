# SPDX-License-Identifier: GPL-3.0-or-later
"""Prolongation of the match of two coarse meshes to every vertex of the dense ones."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from ..geometry.procrustes import nearest_rotations
from ..mesh.closest_points import ClosestPoints
from ..mesh.connectivity.adjacency import averaging, vertex_adjacency
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Bools, Floats, Ints, group_sums, slices, unit_vectors
from ..runtime.progress import Progress, Steps, within
from ..shapes.proxy import Proxy
from .torn_patches import NearVertices, with_patches_mended
from .untangling import follow_neighbours, untangle_steps

_ROTATION_ROUNDS = 2  # of averaging rotation and scale over the proxy
_FIELD_ROUNDS = 2  # of averaging the whole motion over the proxy
_CORRECTIONS = 2
_CORRECTION_ROUNDS = 2  # of averaging a correction over the proxy
_SAMPLES = 5  # vertices for each of the proxy that say how to correct the motion
_NORMAL_REACH = 0.01  # of sqrt(area): how much farther a point may be for not being on a side that faces away
_NORMAL_GATE = 0.0  # product of normals below which they face away from one another
_RINGS = 3  # of the target's proxy around the match of a proxy vertex in which a vertex is looked for
_FAR = 4.0  # times the median: longer corrections are not trusted
_LEAST_TRUST = 1e-3
_CHUNK = 100_000  # vertices between two reports of progress, which also bounds the memory of a step
_LABEL = "Mapping every vertex"


def lift_steps(
    source: TriangleMesh,
    source_proxy: Proxy,
    registered: Floats,
    target: TriangleMesh,
    *,
    target_proxy: Proxy,
    proxy_map: Ints,
    search: ClosestPoints,
    untangled: bool = True,
    shown: Bools | None = None,
) -> Steps[SurfacePoints]:
    """Map every vertex of a dense mesh to another, given how its proxy lies on it.

    Parameters
    ----------
    source : TriangleMesh
        The dense mesh to be mapped, n vertices.
    source_proxy : Proxy
        The coarse mesh that stands for it, k vertices; the identity for a mesh that is not dense.
    registered : (k, 3) array of float
        Positions of the proxy's vertices after it was laid onto the target.
    target : TriangleMesh
        The mesh to map to, as dense or coarse as it is.
    target_proxy : Proxy
        The coarse mesh that stands for the target.
    proxy_map : (k,) array of int
        For each vertex of the source's proxy, the vertex of the target's that it is matched to.  A vertex is looked for
        only around the match of its proxy vertex, so that surfaces that come close in space, such as the hands of
        folded arms, are not taken for one another.
    search : ClosestPoints
        The search on the target.
    untangled : bool
        Whether triangles that are turned over are put right at last.
    shown : (n,) array of bool, optional
        Vertices whose images count: other triangles than theirs stay as they are turned.

    Yields
    ------
    Progress
        How far it is.

    Returns
    -------
    SurfacePoints
        For each vertex of the source, (n,), its point on the target.

    Notes
    -----
    Every proxy vertex moves its surroundings by the rotation and scale that fit the motion of its neighbours best.
    These motions are averaged over the proxy and blended between its vertices, as in embedded deformation [1]_, which
    lays the dense mesh near to the target with all its details.  From some vertices it is seen how far the surface
    still is; the proxy is corrected by the smooth part of that, twice.  Then each vertex goes to the closest point,
    found by walking from the nearest vertex.  A vertex that came to a side that faces away, or too far from the match
    of its proxy vertex, starts from where its neighbours are instead; triangles that the map turned over are averaged.

    The cost is linear in the numbers of vertices.

    References
    ----------
    .. [1] R. Sumner, J. Schmid, M. Pauly, "Embedded deformation for shape manipulation", ACM Transactions on Graphics
       26, 2007.
    """
    yield Progress(0, _LABEL)
    lift = _Lift((source, source_proxy), (target, target_proxy), proxy_map, search)
    average = averaging(vertex_adjacency(source_proxy.mesh))
    motion = _motion(source_proxy, registered, average)
    n, k = source.vertex_count, source_proxy.mesh.vertex_count
    samples = np.arange(0, n, max(1, n // (_SAMPLES * k)))
    for correction in range(_CORRECTIONS):
        yield Progress(0.05 + 0.1 * correction, _LABEL)
        motion[:, :, 3] += lift.correction(motion, samples, average)

    positions, starts = np.empty((n, 3)), np.empty(n, np.int64)
    astray = np.empty(n, bool)
    for part in slices(n, _CHUNK):
        yield Progress(0.25 + 0.2 * part.start / n, _LABEL)
        positions[part], normals = lift.moved(motion, part)
        starts[part], astray[part] = lift.starts(part, positions[part], normals)
    starts = follow_neighbours(source, starts, astray)
    triangles, barycentric = np.empty(n, np.int64), np.empty((n, 3))
    for part in slices(n, _CHUNK):
        yield Progress(0.45 + 0.4 * part.start / n, _LABEL)
        triangles[part], barycentric[part], agreement = lift.search_from(
            starts[part], positions[part], lift.turned(motion, part)
        )
        astray[part] = agreement <= _NORMAL_GATE
    yield Progress(0.85, _LABEL)
    starts = follow_neighbours(source, target.triangles[triangles, barycentric.argmax(axis=1)], astray)
    again = np.flatnonzero(astray)
    for rows in slices(len(again), _CHUNK):
        some = again[rows]
        triangles[some], barycentric[some], _ = lift.search_from(
            starts[some], positions[some], lift.turned(motion, some)
        )
    yield Progress(0.9, _LABEL)
    if untangled:
        untangling = untangle_steps(source, target, triangles, barycentric, search=lift.search, shown=shown)
        yield from within(untangling, 0.9, 1.0)
    return SurfacePoints.from_barycentric(target, triangles, barycentric)


class _Lift:
    """What the steps of a lift share."""

    def __init__(
        self,
        source: tuple[TriangleMesh, Proxy],
        target: tuple[TriangleMesh, Proxy],
        proxy_map: Ints,
        search: ClosestPoints,
    ) -> None:
        (self.source, self.proxy), (self.target, self.target_proxy), self.search = source, target, search
        self.near = NearVertices(self.target_proxy.mesh, _RINGS)
        self.proxy_map = with_patches_mended(self.proxy.mesh, proxy_map, self.target_proxy.mesh, self.near)

    def _blended(self, motion: Floats, vertices: Ints | slice) -> Floats:
        """Motion at vertices (q,) of the dense mesh, (q, 3, 4)."""
        places = self.proxy.points
        corners, weights = places.corners[vertices], places.barycentric[vertices]
        flat = motion.reshape(-1, 12)
        blended = weights[:, :1] * flat.take(corners[:, 0], axis=0)
        for corner in (1, 2):
            blended += weights[:, corner, None] * flat.take(corners[:, corner], axis=0)
        return blended.reshape(-1, 3, 4)

    def moved(self, motion: Floats, vertices: Ints | slice) -> tuple[Floats, Floats]:
        """Positions and normals of vertices (q,) after the motion, (q, 3) each."""
        blended = self._blended(motion, vertices)
        positions = np.einsum("qab,qb->qa", blended[:, :, :3], self.source.vertices[vertices]) + blended[:, :, 3]
        return positions, self._turned(blended, vertices)

    def turned(self, motion: Floats, vertices: Ints | slice) -> Floats:
        """Turn the normals of vertices (q,) by the motion, (q, 3): cheaper to do again than to keep them."""
        return self._turned(self._blended(motion, vertices), vertices)

    def _turned(self, blended: Floats, vertices: Ints | slice) -> Floats:
        return unit_vectors(np.einsum("qab,qb->qa", blended[:, :, :3], self.source.vertex_normals[vertices]))

    def starts(self, vertices: Ints | slice, positions: Floats, normals: Floats) -> tuple[Ints, Bools]:
        """Vertices of the target from which to search for those of the source, (q,), and which are astray, (q,)."""
        starts = self.search.nearest_vertices(positions)
        astray = np.einsum("qd,qd->q", normals, self.search.vertex_normals[starts]) < _NORMAL_GATE
        matched = self.proxy_map[self.proxy.points.nearest_vertices[vertices]]
        far = ~self.near.pairs(matched, self.target_proxy.points.nearest_vertices[starts])
        starts[far] = self.target_proxy.vertices[matched[far]]
        return starts, astray | far

    def search_from(self, starts: Ints, positions: Floats, normals: Floats) -> tuple[Ints, Floats, Floats]:
        """Triangles (q,) and coordinates (q, 3) of the closest points, and how far the normals agree there, (q,)."""
        found = self.search.walk(
            positions, starts, normals, normal_weight=_NORMAL_REACH**2 * self.target.area, normal_gate=_NORMAL_GATE
        )
        # Not the normal of the triangle: which of two a point is in, on their edge, is for rounding to decide.
        there = found.interpolate(self.target.triangles, self.target.vertex_normals)
        return found.triangles, found.barycentric, np.einsum("qd,qd->q", normals, there)

    def correction(self, motion: Floats, samples: Ints, average: csr_array) -> Floats:
        """Shift of the proxy's vertices, (k, 3), that brings samples (q,) of the dense mesh nearer to the target."""
        k = average.shape[0]
        steps, trust = np.empty((len(samples), 3)), np.empty(len(samples))
        for part in slices(len(samples), _CHUNK):
            positions, normals = self.moved(motion, samples[part])
            starts, _ = self.starts(samples[part], positions, normals)
            triangles, barycentric, agreement = self.search_from(starts, positions, normals)
            reached = SurfacePoints.from_barycentric(self.target, triangles, barycentric)
            steps[part] = reached.positions - positions
            trust[part] = np.maximum(agreement, 0) ** 2
        lengths = np.linalg.norm(steps, axis=1)
        trust *= lengths <= _FAR * np.median(lengths)
        places = self.proxy.points
        shares = ((trust + _LEAST_TRUST) * self.source.vertex_areas[samples])[:, None] * places.barycentric[samples]
        corners = places.corners[samples].ravel()
        counted = np.append(steps, np.ones((len(steps), 1)), axis=1)
        sums = group_sums(corners, (shares[:, :, None] * counted[:, None]).reshape(-1, 4), k)
        for _ in range(_CORRECTION_ROUNDS):
            sums = average @ sums
        return sums[:, :3] / np.maximum(sums[:, 3:], TINY)


def _motion(proxy: Proxy, registered: Floats, average: csr_array) -> Floats:
    """Motion of the surroundings of each proxy vertex, (k, 3, 4): x goes to motion[:, :3] x + motion[:, 3]."""
    rest, (a, b) = proxy.mesh.vertices, proxy.mesh.edges.T
    k = len(rest)
    before, after = rest[a] - rest[b], registered[a] - registered[b]
    products = np.concatenate(
        [
            (after[:, :, None] * before[:, None, :]).reshape(-1, 9),
            np.einsum("ed,ed->e", after, after)[:, None],
            np.einsum("ed,ed->e", before, before)[:, None],
        ],
        axis=1,
    )
    sums = group_sums(np.concatenate([a, b]), np.tile(products, (2, 1)), k)
    for _ in range(_ROTATION_ROUNDS):
        sums = average @ sums
    scales = np.sqrt(sums[:, 9] / np.maximum(sums[:, 10], TINY))
    turns = scales[:, None, None] * nearest_rotations(sums[:, :9].reshape(k, 3, 3))
    shifts = registered - np.einsum("kab,kb->ka", turns, rest)
    motion = np.concatenate([turns, shifts[:, :, None]], axis=2).reshape(k, 12)
    if proxy.is_coarser:  # between its vertices there is something to smooth
        for _ in range(_FIELD_ROUNDS):
            motion = average @ motion
    return motion.reshape(k, 3, 4)
