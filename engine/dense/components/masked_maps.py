# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps that were made with only a piece of a surface: what they say of the rest, and which piece that was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Ints
from ..quality import DenseMatch, of_covered_parts

_LEAST_LEFT = 0.1
"""Part of a surface without a partner from which on it is left out: less does little harm, and may be a mistake."""


def piece_of(mesh: TriangleMesh, found: SurfaceMap | None, needed: Ints) -> Bools | None:
    """Tell which vertices of a mesh (n,) have a partner by an earlier map.

    Parameters
    ----------
    mesh : TriangleMesh
        The original mesh.
    found : SurfaceMap or None
        The map from it, with confidence zero also where it has no partner.
    needed : (k,) array of int
        Vertices that have to be among them, as far as there are such.

    Returns
    -------
    (n,) array of bool or None
        None if nearly all have one, if nothing is known, or if needed ones have none or would be cut off from most.

    Raises
    ------
    MatchError
        If it is not the map of this mesh.
    """
    if found is None:
        return None
    found.check_domain(mesh)
    covered = found.has_partner & (found.confidence > 0)
    existing = needed[(needed >= 0) & (needed < len(covered))]
    if share_of(mesh, covered) > 1 - _LEAST_LEFT or not _hold_on(mesh, covered, existing):
        return None
    return covered


def _hold_on(mesh: TriangleMesh, covered: Bools, needed: Ints) -> bool:
    """Say whether needed vertices (k,) are on the largest part of what is covered, (n,), of their piece of a mesh."""
    own, whole = mesh.parts_of(covered), mesh.component_labels
    areas = np.bincount(own, mesh.vertex_areas * covered)
    return all(covered[one] and areas[own[one]] >= areas[own[whole == whole[one]]].max() for one in needed)


def left_out_beyond(piece: Bools | None, left_out: Bools | None) -> Bools | None:
    """Tell which vertices (n,) are left out if a piece alone, (n,), takes part, beside others; None stands for none."""
    if piece is None:
        return left_out
    return ~piece if left_out is None else left_out | ~piece


def with_pieces_only(
    maps: DenseMatch, meshes: tuple[TriangleMesh, TriangleMesh], pieces: tuple[Bools | None, Bools | None]
) -> DenseMatch:
    """Say of maps what was left out when they were made.

    Parameters
    ----------
    maps : DenseMatch
        Maps between all vertices.
    meshes : pair of TriangleMesh
        The original source and target.
    pieces : pair of (n,) array of bool or None
        Which vertices of either took part; of None all did.

    Returns
    -------
    DenseMatch
        The maps without confidence at all other vertices, which count as not covered.
    """
    if pieces[0] is None and pieces[1] is None:
        return maps
    ways = zip((maps.source_to_target, maps.target_to_source), pieces, strict=True)
    there, back = (way if some is None else replace(way, has_partner=way.has_partner & some) for way, some in ways)
    ends = zip(meshes, pieces, strict=True)
    source, target = (1.0 if some is None else share_of(mesh, some) for mesh, some in ends)
    return DenseMatch(there, back, of_covered_parts(maps.quality, (source, target)))


def share_of(mesh: TriangleMesh, covered: Bools) -> float:
    """Say what part of the area of a mesh some of its vertices, (n,), have."""
    return float(mesh.vertex_areas @ covered / mesh.vertex_areas.sum())
