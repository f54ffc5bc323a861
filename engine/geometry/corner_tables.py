# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of a triangle mesh that fast marching reads: its unfolded corners and the graph of its edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array

from ..mesh.connectivity.halfedges import group_half_edges
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Floats, Ints

# Lengths below this part of the largest length of a triangle count as this part: keeps triangles without area finite.
_FLAT = 1e-8

# A line across an edge joins the graph if it is shorter than this times the edge: those bring most of the accuracy.
# Above one, so that both diagonals of the squares of a grid count.
_SHORT = 1.1


@dataclass(frozen=True, eq=False)
class CornerTables:
    """What an update of a vertex c from two others, a and b, needs; lengths in units of `unit`.

    A corner is a triangle c, a, b laid out in the plane with a at the origin, b at (l, 0) and c at (x, y), y > 0.

    Attributes
    ----------
    unit : float
        Mean length of the edges, in units of the mesh.
    c, a, b : (k,) array of int
        The vertices of each corner, sorted by `c`.
    slope : (k,) array of float
        y / l.
    height : (k,) array of float
        y l.
    along : (k,) array of float
        x / l.
    bend : (k,) array of float
        |c - a|^2 - x l.
    length_a, length_b : (k,) array of float
        |c - a| and |c - b|.
    graph : (n, n) csr_array
        Lengths of the edges, and of the straight lines that cross one edge from one triangle to its neighbour.
    """

    unit: float
    c: Ints
    a: Ints
    b: Ints
    slope: Floats
    height: Floats
    along: Floats
    bend: Floats
    length_a: Floats
    length_b: Floats
    graph: csr_array


class _Corners(NamedTuple):
    """Corners in the plane: a at the origin, b at (l, 0), c at (x, y)."""

    c: Ints
    a: Ints
    b: Ints
    l: Floats  # noqa: E741 -- the letter of the formulas
    x: Floats
    y: Floats

    def at(self, index: Ints) -> _Corners:
        """Take some of them."""
        return _Corners._make(array[index] for array in self)

    def is_obtuse(self) -> Bools:
        """Say of each corner whether its angle exceeds a right one."""
        # The slack puts right angles, the rule on regular grids, on one side whatever the rounding.
        return self.x * (self.x - self.l) + self.y**2 < 1e-9 * self.l**2


def corner_tables(mesh: TriangleMesh) -> CornerTables:
    """Build the tables of a mesh.

    Notes
    -----
    An obtuse corner cannot be updated in the order of the distances, as the front may reach c before a or b.  Where
    the triangle behind a b can be unfolded into the plane so that c sees its third vertex d through a b, the corner is
    split into c, a, d and c, d, b [1]_.

    References
    ----------
    .. [1] R. Kimmel, J. A. Sethian, "Computing geodesic paths on manifolds", PNAS 95 (1998).
    """
    unit = float(mesh.edge_lengths.mean())
    corners = _corners(mesh, unit)
    d, dx, dy = _behind(mesh, corners)
    sees = _crossing_inside(corners, dx, dy) & (d >= 0)
    flip_lengths = np.hypot(corners.x - dx, corners.y - dy)
    flips = np.flatnonzero(sees & (flip_lengths < _SHORT * corners.l))
    graph = _graph(mesh, unit, corners.c[flips], d[flips], flip_lengths[flips])

    obtuse = corners.is_obtuse()
    split = np.flatnonzero(obtuse & sees)
    near, d, dx, dy = corners.at(split), d[split], dx[split], dy[split]
    zero = np.zeros_like(dx)
    at_c, at_a, at_b, at_d = (np.stack(at, axis=1) for at in ((near.x, near.y), (zero, zero), (near.l, zero), (dx, dy)))
    left = _laid_out((near.c, near.a, d), at_c, at_a, at_d)
    right = _laid_out((near.c, d, near.b), at_c, at_d, at_b)
    kept = corners.at(np.flatnonzero(~(obtuse & sees)))
    parts = _Corners._make(np.concatenate(arrays) for arrays in zip(kept, left, right, strict=True))
    c, a, b, length, x, y = parts.at(np.argsort(parts.c, kind="stable"))
    slope, height, along, bend = y / length, y * length, x / length, x**2 + y**2 - x * length
    return CornerTables(unit, c, a, b, slope, height, along, bend, np.hypot(x, y), np.hypot(x - length, y), graph)


def _corners(mesh: TriangleMesh, unit: float) -> _Corners:
    """Return the three corners of every triangle, (3m,), those at the first vertices of the triangles first."""
    c, a, b = (np.roll(mesh.triangles, -shift, axis=1).T.ravel() for shift in range(3))
    positions = mesh.vertices / unit
    return _laid_out((c, a, b), positions[c], positions[a], positions[b])


def _laid_out(vertices: tuple[Ints, Ints, Ints], at_c: Floats, at_a: Floats, at_b: Floats) -> _Corners:
    """Lay triangles of the vertices c, a and b, (k,) each, at positions (k, d) out in the plane."""
    ab, ac = at_b - at_a, at_c - at_a
    ab_square, ac_square = (np.einsum("kd,kd->k", side, side) for side in (ab, ac))
    smallest = np.maximum(_FLAT * np.sqrt(np.maximum(ab_square, ac_square)), _FLAT**2)
    length = np.maximum(np.sqrt(ab_square), smallest)
    # The projection on a b itself, not the law of cosines, which loses all digits in needles.
    x = np.einsum("kd,kd->k", ab, ac) / length
    y = np.sqrt(np.maximum(ac_square - x * x, 0))
    return _Corners(*vertices, length, x, np.maximum(y, smallest))


def _behind(mesh: TriangleMesh, corners: _Corners) -> tuple[Ints, Floats, Floats]:
    """For each corner, the vertex d across a b and its position (x, y) in the plane of the corner; d = -1 if none.

    There is none at the boundary and at edges of more than two triangles.
    """
    m = mesh.triangle_count
    slot, triangle = np.divmod(np.arange(3 * m), m)
    across = group_half_edges(mesh.triangles, mesh.vertex_count).twins[3 * triangle + (slot + 1) % 3]
    there = corners.at((across + 2) % 3 * m + across // 3)
    x = np.where(there.a == corners.a, there.x, corners.l - there.x)
    return np.where(across >= 0, there.c, -1), x, -there.y


def _crossing_inside(corners: _Corners, dx: Floats, dy: Floats) -> Bools:
    """Whether the straight line from c to d crosses the inside of a b."""
    depth = corners.y - dy
    crossing = corners.x * -dy + dx * corners.y
    return (crossing > 0) & (crossing < corners.l * depth)


def _graph(mesh: TriangleMesh, unit: float, c: Ints, d: Ints, flip_lengths: Floats) -> csr_array:
    """Join the edges of the mesh and the lines c d into one symmetric graph; the shorter counts where both exist."""
    n = mesh.vertex_count
    tail = np.concatenate([mesh.edges[:, 0], mesh.edges[:, 1], c])
    head = np.concatenate([mesh.edges[:, 1], mesh.edges[:, 0], d])
    # An edge of length zero is no edge for a sparse graph.
    edge_lengths = np.maximum(mesh.edge_lengths / unit, _FLAT**2)
    lengths = np.concatenate([edge_lengths, edge_lengths, np.maximum(flip_lengths, _FLAT**2)])
    order = np.lexsort((lengths, tail * n + head))
    key = (tail * n + head)[order]
    shortest = order[np.append(True, key[1:] != key[:-1])]
    return csr_array(coo_array((lengths[shortest], (tail[shortest], head[shortest])), shape=(n, n)))
