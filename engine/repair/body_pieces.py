# SPDX-License-Identifier: GPL-3.0-or-later
"""The pieces of a mesh that are its body: the main one and limbs, but no eyes and no clothes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ..mesh.area_samples import even_samples
from ..mesh.connectivity.mesh_orientation import enclosed_volumes
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Floats

BESIDE = 0.02
"""How far from what is known already, in sqrt(area), a piece goes on beyond it: eyes, teeth and clothes do not."""

_BEYOND, _WITHIN = 0.25, -0.5
"""The same for a piece that is small, such as a part of a finger, in the square root of its own area; and the sine of
the angle below the surface from which on a point lies within.  These tell the parts of two mannequins' fingers from the
balls of their joints, and from the eyes of six other characters."""

_MOSTLY = 0.3
"""Part of a piece that must do so: the rest may lie in others."""

LEAST_MORE = 0.04
"""Part of the surface in such pieces from which on they matter: a head or two hands."""

SAMPLES, _LEAST_SAMPLES = 20_000, 30
"""Points that all pieces are compared at, together, and each of them at least."""


def body_pieces(pieces: Sequence[TriangleMesh]) -> Bools:
    """Tell which pieces go on beyond those before them: the main one, and limbs if these matter.

    Parameters
    ----------
    pieces : sequence of TriangleMesh
        The pieces, p of them, the main one first.

    Returns
    -------
    (p,) array of bool
        True for the main one and for limbs.
    """
    areas = np.array([piece.area for piece in pieces])
    least = LEAST_MORE * areas.sum()
    of_body = np.arange(len(pieces)) == 0
    if areas[1:].sum() <= least:
        return of_body
    far = BESIDE * np.sqrt(areas.sum())
    places, normals = _seen(pieces[0], areas.sum() / SAMPLES)
    tree = cKDTree(places)
    for number in range(1, len(pieces)):
        own, its = _seen(pieces[number], min(areas.sum() / SAMPLES, areas[number] / _LEAST_SAMPLES))
        distances, nearest = tree.query(own)
        size = _BEYOND * np.sqrt(areas[number])
        beside = distances > min(far, size)
        if size < far:  # an eye is as far from the skin as a part of a finger from the next one, but within
            heights = ((own - places[nearest]) * normals[nearest]).sum(axis=1)
            beside &= heights > _WITHIN * distances
        if beside.mean() > _MOSTLY:
            of_body[number] = True
            places, normals = np.concatenate([places, own]), np.concatenate([normals, its])
            tree = cKDTree(places)
    of_body[1:] &= areas[1:][of_body[1:]].sum() > least
    return of_body


def _seen(mesh: TriangleMesh, area: float) -> tuple[Floats, Floats]:
    """Spread points over a piece, each of which stands for an area: places and outward normals, (s, 3) each."""
    samples = even_samples(mesh, area)
    components, volumes = enclosed_volumes(mesh)
    inward = (volumes < 0)[components]
    outward = np.where(inward[:, None], -mesh.triangle_normals, mesh.triangle_normals)
    return samples.positions, outward[samples.triangles]
