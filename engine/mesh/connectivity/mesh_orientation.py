# SPDX-License-Identifier: GPL-3.0-or-later
"""One side for every surface: triangles that agree with their neighbours, and look outward."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra

from ...runtime.arrays import Bools, Floats, Ints, marked, numbered
from ..triangle_mesh import TriangleMesh
from .boundary_loops import BoundaryLoops, boundary_loops
from .components import neighbour_graph, symmetric_components, triangle_components, triangle_neighbours
from .halfedges import twins_of


@dataclass(frozen=True, eq=False)
class Orientation:
    """How to make the triangles of each component agree.

    Attributes
    ----------
    components : (m,) array of int
        Number of the component of each triangle; triangles hang together across paired half-edges.
    turned : (m,) array of bool
        The triangles to turn over: by area the smaller half of their component.
    twins : (3m,) array of int
        The pairs of half-edges, without those at which a one-sided surface has to be cut open.
    """

    components: Ints
    turned: Bools
    twins: Ints


def orient_consistently(triangles: Ints, areas: Floats, twins: Ints) -> Orientation:
    """Find the triangles to turn over, so that neighbours agree.

    Parameters
    ----------
    triangles : (m, 3) array of int
        Corners of each triangle.
    areas : (m,) array of float
        Area of each triangle.
    twins : (3m,) array of int
        Twin of each half-edge, -1 at the boundary.

    Returns
    -------
    Orientation
        The components, and what to turn.

    Notes
    -----
    The orientations are found on the double cover of the surface: each triangle is there twice, once each way round,
    and neighbours are joined where they agree.  The cover of a surface with two sides falls into two copies, either of
    which orients it.  That of a one-sided surface hangs together: it is cut open where paths from one
    triangle meet that disagree.
    """
    m = len(triangles)
    components = triangle_components(twins)
    inside = twins >= 0
    turned = np.zeros(m, bool)
    tail = triangles.ravel()
    disagree = inside & (tail == tail[np.where(inside, twins, 0)])
    if not disagree.any():
        return Orientation(components, turned, twins)

    affected = marked(components[np.flatnonzero(disagree) // 3], int(components.max()) + 1)
    some = np.flatnonzero(affected[components])
    k = len(some)
    neighbours = numbered(some, m)[triangle_neighbours(twins)[some]]
    crossing = disagree.reshape(-1, 3)[some]
    across = np.concatenate([neighbours + k * crossing, neighbours + k * ~crossing])
    cover = neighbour_graph(across)
    sheets = symmetric_components(cover)
    one_sided = sheets[:k] == sheets[k:]
    # The sheet in which the first triangle of the component is as it was.
    _, first, inverse = np.unique(components[some], return_index=True, return_inverse=True)
    turn = sheets[:k] != sheets[first][inverse]
    if one_sided.any():
        roots = first[one_sided[first]]
        distances = dijkstra(cover, directed=True, indices=roots, unweighted=True, min_only=True)
        turn[one_sided] = (distances[k:] < distances[:k])[one_sided]
    # Most of the surface stays as it is.
    against = np.bincount(inverse, np.where(turn, areas[some], -areas[some])) > 0
    turned[some] = turn ^ against[inverse]

    if one_sided.any():
        still = turned[:, None] ^ turned[triangle_neighbours(twins)] ^ disagree.reshape(-1, 3)
        twins = np.where(still.ravel(), -1, twins)
        components = triangle_components(twins)  # what was cut open may fall apart
    return Orientation(components, turned, twins)


def turn_triangles(triangles: Ints, twins: Ints, turned: Bools) -> tuple[Ints, Ints]:
    """Turn triangles over by exchanging their last two corners.

    Parameters
    ----------
    triangles : (m, 3) array of int
        Corners of each triangle.
    twins : (3m,) array of int
        Twin of each half-edge, -1 at the boundary.
    turned : (m,) array of bool
        Which to turn.

    Returns
    -------
    triangles : (m, 3) array of int
        Corners of each triangle.
    twins : (3m,) array of int
        Twin of each half-edge, as numbered by the corners now.
    """
    if not turned.any():
        return triangles, twins
    triangles = np.where(turned[:, None], triangles[:, [0, 2, 1]], triangles)
    half_edges = np.arange(len(twins))
    # The first half-edge, from corner 0 to 1, becomes the last, from corner 2 to 0, and the last the first.
    place = half_edges + np.where(np.repeat(turned, 3), 2 - 2 * (half_edges % 3), 0)
    moved = np.empty_like(twins)
    moved[place] = np.where(twins >= 0, place[twins], -1)
    return triangles, moved


def inward_components(vertices: Floats, triangles: Ints, twins: Ints, components: Ints) -> Bools:
    r"""Find the components whose triangles look inward.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions.
    triangles : (m, 3) array of int
        Corners of each triangle; neighbours agree in orientation.
    twins : (3m,) array of int
        Twin of each half-edge, -1 at the boundary.
    components : (m,) array of int
        Component of each triangle.

    Returns
    -------
    (c,) array of bool
        Whether to turn each component over.

    Notes
    -----
    Decided by the sign of the volume.  The true lid of an opening may bulge: it is trusted to stay within a half-ball
    over an opening of its area a, of volume :math:`\tfrac{2}{3} a^{3/2} / \sqrt{\pi}`.  Where that exceeds the volume,
    as on a sheet, inside and outside have no meaning, and the surface stays as it is.
    """
    loops = boundary_loops(vertices, triangles, np.flatnonzero(twins < 0))
    volumes = _enclosed_volumes(vertices, triangles, components, loops)
    doubt = np.zeros(len(volumes))
    if loops.count:
        component_of_loop = np.empty(loops.count, np.int64)
        component_of_loop[loops.labels] = components[loops.half_edges // 3]
        doubt += np.bincount(component_of_loop, 2 / 3 * loops.areas**1.5 / np.sqrt(np.pi), len(volumes))
    return volumes < -doubt


def enclosed_volumes(mesh: TriangleMesh) -> tuple[Ints, Floats]:
    """Component of each triangle, (m,), and volumes of the components with lids on their openings, (c,).

    A volume is below zero if the triangles look inward.
    """
    twins = twins_of(mesh.vertices, mesh.triangles)
    components = triangle_components(twins)
    loops = boundary_loops(mesh.vertices, mesh.triangles, np.flatnonzero(twins < 0))
    return components, _enclosed_volumes(mesh.vertices, mesh.triangles, components, loops)


def _enclosed_volumes(vertices: Floats, triangles: Ints, components: Ints, loops: BoundaryLoops) -> Floats:
    """Volumes of components; openings are closed by fans to their centres, so that no volume depends on the origin."""
    count = int(components.max()) + 1
    # Volumes about a point of the component itself, without which few digits would be left far from the origin.
    origins = np.empty((count, 3))
    origins[components[::-1]] = vertices[triangles[::-1, 0]]
    a, b, c = (vertices[corner] - origins[components] for corner in triangles.T)
    volumes = np.bincount(components, _triple_product(a, b, c), count) / 6
    if loops.count:
        component = components[loops.half_edges // 3]
        origin = origins[component]
        start, end = vertices[loops.tails] - origin, vertices[loops.heads] - origin
        middle = loops.centres[loops.labels] - origin
        volumes -= np.bincount(component, _triple_product(start, end, middle), count) / 6
    return volumes


def _triple_product(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return the determinant of each three vectors, (k,)."""
    (a_x, a_y, a_z), (b_x, b_y, b_z), (c_x, c_y, c_z) = a.T, b.T, c.T
    return a_x * (b_y * c_z - b_z * c_y) + a_y * (b_z * c_x - b_x * c_z) + a_z * (b_x * c_y - b_y * c_x)
