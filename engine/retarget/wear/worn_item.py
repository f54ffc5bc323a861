# SPDX-License-Identifier: GPL-3.0-or-later
"""Items that bodies wear: as they are on the first body, and as they were fitted to the second."""

from __future__ import annotations

from dataclasses import dataclass

from scipy.sparse import csr_array

from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints


@dataclass(frozen=True, eq=False)
class WornItem:
    """Something that the first body wears.

    Attributes
    ----------
    mesh : TriangleMesh
        Its surface, around the body, n vertices.
    bones : (n, b) csr_array of float, optional
        How much each of the body's bones moves each vertex.
    fit : str
        "AUTO"; "TIGHT", which follows each form of the skin; "LOOSE", which keeps its own shape; "RIGID", which keeps
        it wholly and only grows; or "LEAVE", which is moved along but not pushed out.
    rigid : (n,) array of bool, optional
        Vertices of rigid pieces.
    find_rigid : bool
        Whether others are looked for.
    pieces : (n,) array of int, optional
        The rigid piece that each vertex belongs to, -1 where the item bends, if that is known: see `FittedItem`.
    tightness : (n,) array of float, optional
        From -1, loose, to 1, tight, at each vertex.
    left : (n,) array of bool, optional
        Vertices that are not pushed out.
    margin : float
        Least distance from the skin where the item was outside, in the second body's units.
    """

    mesh: TriangleMesh
    bones: csr_array | None = None
    fit: str = "AUTO"
    rigid: Bools | None = None
    find_rigid: bool = True
    pieces: Ints | None = None
    tightness: Floats | None = None
    left: Bools | None = None
    margin: float = 0.0

    def __repr__(self) -> str:
        return f"<WornItem: {self.mesh.vertex_count} vertices, fit {self.fit}>"


@dataclass(frozen=True, eq=False)
class FittedItem:
    """An item on the second body.

    Attributes
    ----------
    positions : (n, 3) array of float
        Its vertices.
    rotations : (n, 3, 3) array of float
        How it turned around each.
    scales : (n,) array of float
        How many times as large it became.
    places : (n, m) csr_array of float
        What part of each vertex each of the m vertices of the first body carried; rows sum to one.
    pieces : (n,) array of int
        The rigid piece that each vertex belongs to, -1 where it bends.
    clearance : (n,) array of float
        Distance from the skin of the second body, negative inside.
    pushed : (n,) array of float
        How far each was pushed, so that nothing pokes through.
    confidence : (n,) array of float
        How far the map may be trusted that it was carried by, 0 to 1.
    bare : (n,) array of bool
        Which lay near the skin of the first body, and have none of the second below them, as boots on stumps.
    through : float
        What part of the item is still below what it should lie on, 0 to 1.
    """

    positions: Floats
    rotations: Floats
    scales: Floats
    places: csr_array
    pieces: Ints
    clearance: Floats
    pushed: Floats
    confidence: Floats
    bare: Bools
    through: float = 0.0

    def __repr__(self) -> str:
        return f"<FittedItem: {len(self.positions)} vertices, {self.pieces.max(initial=-1) + 1} rigid pieces>"
