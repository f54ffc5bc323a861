# SPDX-License-Identifier: GPL-3.0-or-later
"""Handles of a surface: how many there are, and the shortest loop around one."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra, minimum_spanning_tree

from ..mesh.connectivity.adjacency import neighbour_means
from ..mesh.connectivity.boundary_loops import BoundaryLoops, boundary_loops
from ..mesh.connectivity.edge_chains import way_to_root
from ..mesh.connectivity.halfedges import twins_of
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Ints
from ..runtime.progress import Progress, Steps

_ROOTS = 256
"""Most vertices of the first loops that shorter ones are looked for at."""

_LAST_ROOTS = 12
"""The same of the shortest of those."""

_CREASE = 0.05
"""What a unit of length counts for in a crease: around where two parts touch the surface is hollow, around a wrist it
bulges.  With 0.2 forearms that lie on the back are cut off, as half of what goes around them is a crease (``python -m
tests.benchmarks.fused_bodies``)."""

_SADDLE = 0.1
"""By how much the angles around a vertex exceed a full turn, in radians, for a narrow place to count as a crease."""


def genus(mesh: TriangleMesh) -> int:
    """Count the handles of a connected, oriented manifold: 0 for a sphere or a disc, 1 for a torus."""
    characteristic = mesh.vertex_count - len(mesh.edges) + mesh.triangle_count
    return (2 - _ends(mesh)[1].count - characteristic) // 2


def shortest_handle_loop_steps(mesh: TriangleMesh, lids: Bools | None = None) -> Steps[Ints]:
    """Find a short loop of edges that goes around a handle, or through it, in a crease if there is one.

    Parameters
    ----------
    mesh : TriangleMesh
        A connected, oriented manifold of genus 1 or more.
    lids : (n,) array of bool, optional
        Vertices in the middle of what closes an opening: there is no surface, and their edges count as creases.  Two
        hands and the face that they cover are parted in two cuts, the second of which goes through the lid of the
        first.

    Returns
    -------
    (k,) array of int
        The vertices of the loop in turn, each once.  The surface hangs together when it is cut along it.

    Notes
    -----
    A tree of shortest paths from a vertex, and a spanning tree of the triangles across the other edges, leave two edges
    for each handle, each of which closes a loop; with the tree across the longest loops, the others are the shortest
    of a basis at this vertex [1]_.  The shortest of all crosses some loop of any basis: so it is looked for at vertices
    of those.

    References
    ----------
    .. [1] J. Erickson, K. Whittlesey, "Greedy optimal homotopy and homology generators", SODA 2005.
    """
    loops = _Loops(mesh, lids)
    centre = np.average(mesh.vertices, axis=0, weights=mesh.vertex_areas)
    first = loops.at(int(np.square(mesh.vertices - centre).sum(axis=1).argmax()))
    best = first[0]
    for others, most, begin, end in ((first, _ROOTS, 0.0, 0.9), (None, _LAST_ROOTS, 0.9, 1.0)):
        roots = np.unique(np.concatenate([loop for _, loop in others or [best]]))
        roots = roots[:: -(-len(roots) // most)]
        for number, root in enumerate(roots.tolist()):
            best = min(best, loops.at(root)[0], key=lambda found: found[0])
            yield Progress(begin + (end - begin) * (number + 1) / len(roots), "Cutting parts open that touch")
    return best[1]


def _ends(mesh: TriangleMesh) -> tuple[Ints, BoundaryLoops]:
    """Pair the half-edges of a surface, and find the loops in which it ends."""
    twins = twins_of(mesh.vertices, mesh.triangles)
    return twins, boundary_loops(mesh.vertices, mesh.triangles, np.flatnonzero(twins < 0))


class _Loops:
    """Finds the shortest loops through a vertex that no disc is spanned by."""

    def __init__(self, mesh: TriangleMesh, lids: Bools | None = None) -> None:
        twins, ends = _ends(mesh)
        tails = mesh.triangles.ravel()
        heads = np.roll(mesh.triangles, -1, axis=1).ravel()
        once = np.flatnonzero((twins < 0) | (twins > np.arange(len(tails))))
        self._tails, self._heads = tails[once], heads[once]
        lengths = np.linalg.norm(mesh.vertices[self._tails] - mesh.vertices[self._heads], axis=1)
        creased = _creased(mesh)
        in_crease = creased[self._tails] & creased[self._heads]
        if lids is not None:
            in_crease |= lids[self._tails] | lids[self._heads]
        # An edge without length would be none to the search.
        lengths = np.maximum(lengths, float(np.finfo(float).eps * lengths.max()))
        self._lengths = np.where(in_crease, _CREASE * lengths, lengths)
        # On either side of an edge is a triangle, or what would close the loop that the surface ends in.
        other = twins // 3
        other[ends.half_edges] = mesh.triangle_count + ends.labels
        self._sides = np.sort(np.stack([once // 3, other[once]], axis=1), axis=1)
        self._side_count = mesh.triangle_count + ends.count
        n = mesh.vertex_count
        self._graph = csr_array(coo_array((self._lengths, (self._tails, self._heads)), shape=(n, n)))
        self._places, self._normals = mesh.vertices, mesh.vertex_normals

    def at(self, root: int) -> list[tuple[float, Ints]]:
        """Find the shortest loops of a basis through a vertex: their lengths, and their vertices, shortest first."""
        distances, before = dijkstra(self._graph, directed=False, indices=root, return_predecessors=True)
        in_tree = (before[self._heads] == self._tails) | (before[self._tails] == self._heads)
        rest = np.flatnonzero(~in_tree)
        around = distances[self._tails[rest]] + distances[self._heads[rest]] + self._lengths[rest]
        # Of several edges between the same two sides the one with the longest loop can be in the spanning tree.
        order = np.lexsort((-around, self._sides[rest, 1], self._sides[rest, 0]))
        sides = self._sides[rest[order]]
        candidates = order[np.append(True, (sides[1:] != sides[:-1]).any(axis=1))]
        candidates = candidates[np.argsort(-around[candidates], kind="stable")]
        low, high = self._sides[rest[candidates]].T.astype(np.int32)
        # The rank as weight: the tree that weighs least has the longest loops, and tells which they are.
        ranks = coo_array((np.arange(1.0, len(candidates) + 1), (low, high)), shape=(self._side_count,) * 2)
        chosen = minimum_spanning_tree(ranks.tocsr()).data.astype(np.int64) - 1
        left = np.delete(np.arange(len(rest)), candidates[chosen])
        found = []
        for edge in rest[left]:
            loop = _closed(way_to_root(before, self._tails[edge]), way_to_root(before, self._heads[edge]))
            found.append((self._length(loop), loop))
        return sorted(found, key=lambda each: each[0])

    def _length(self, loop: Ints) -> float:
        """Measure a loop: creases count less around what is solid, not around a hole, which closed would join more."""
        places, ahead = self._places[loop], np.roll(loop, -1)
        outwards = np.einsum("kd,kd->k", places - places.mean(axis=0), self._normals[loop])
        if outwards.mean() < 0:
            return float(np.linalg.norm(places - self._places[ahead], axis=1).sum())
        return float(np.asarray(self._graph[loop, ahead] + self._graph[ahead, loop]).sum())


def _creased(mesh: TriangleMesh) -> Bools:
    """Tell at which vertices the surface is hollow, or bends like a saddle as around a narrow neck, (n,)."""
    corners = mesh.vertices[mesh.triangles]
    mean, excess = np.zeros(mesh.vertex_count), np.full(mesh.vertex_count, -2 * np.pi)
    for corner in range(3):
        vertices = mesh.triangles[:, corner]
        first, second = (corners[:, (corner + i) % 3] - corners[:, corner] for i in (1, 2))
        # The area of a triangle grows the fastest if this corner moves so: the mean curvature, integrated.
        pull = np.cross(mesh.triangle_normals, second - first)
        outwards = np.einsum("md,md->m", pull, mesh.vertex_normals[vertices])
        mean += np.bincount(vertices, outwards, mesh.vertex_count)
        sines = np.linalg.norm(np.cross(first, second), axis=1)
        angles = np.arctan2(sines, np.einsum("md,md->m", first, second))
        excess += np.bincount(vertices, angles, mesh.vertex_count)
    return (neighbour_means(mesh, mean) < 0) | (neighbour_means(mesh, excess) > _SADDLE)


def _closed(one: list[int], other: list[int]) -> Ints:
    """Join two ways to the same root to a loop, without what they share."""
    while len(one) > 1 and len(other) > 1 and one[-2] == other[-2]:
        one, other = one[:-1], other[:-1]
    return np.array(one + other[-2::-1], np.int64)
