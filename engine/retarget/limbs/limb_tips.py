# SPDX-License-Identifier: GPL-3.0-or-later
"""The ends of limbs of two rigged bodies that stand alike, whichever way they look: hands, feet, ears, tails."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array

from ...geometry.best_distinct import best_distinct
from ...geometry.procrustes import alike_points, in_unit_spread
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Ints
from ..rig.skeleton import Skeleton
from .mirrored_bones import mirrored_bones

_BESIDE = 0.12
"""How near ends are, in units of the largest extent of the body, that belong to one limb: fingers of eight people are
at most 0.07 apart, and so are feet, but these are mirror images of each other (tried once)."""

_MOST = 16
"""Ends that are looked at, by hand."""

_TURNS = np.array([[[c, -s, 0], [s, c, 0], [0, 0, 1]] for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))], np.float64)
"""Ways in which a body may look, against another one: turns about the vertical axis."""


class RiggedBody(NamedTuple):
    """A body at rest that stands upright, along z: its mesh, n vertices, its bones, b, and their weights (n, b)."""

    mesh: TriangleMesh
    skeleton: Skeleton
    weights: csr_array


def paired_limb_tips(source: RiggedBody, target: RiggedBody) -> Ints:
    """Pair the ends of limbs of two bodies by what their rigs say: where both bodies stand alike, limbs do so as well.

    Distances along the surface may agree as little as those of a figure with a large head and a realistic person do,
    and limbs that rest on the body be one with it.  The bones of a rig know better what a limb is, and feet and toes
    tell which way a body looks.

    Parameters
    ----------
    source, target : RiggedBody
        The bodies.

    Returns
    -------
    (k, 2) array of int
        Vertices of the source and of the target; none if the bodies do not stand alike.
    """
    bodies = source, target
    tips = [_limb_tips(body) for body in bodies]
    here, there = (
        in_unit_spread(body.mesh.vertices[vertices], np.ones(len(vertices)))
        for body, vertices in zip(bodies, tips, strict=True)
    )
    first, second = alike_points((here @ turn.T for turn in _TURNS), there).T
    return np.column_stack([tips[0][first], tips[1][second]])


def _limb_tips(body: RiggedBody) -> Ints:
    """Find the vertices at the ends of limbs, (k,), the outermost first.

    They are what the last bones of a limb move that is farthest from where these begin.
    """
    mesh, tree = body.mesh, body.skeleton
    strongest = _strongest(body.weights)
    moving = np.bincount(strongest[strongest >= 0], minlength=len(tree)) > 0
    if not moving.any():
        return np.empty(0, np.int64)
    last = np.flatnonzero(moving & ((tree.hanging & moving).sum(axis=1) == 1))
    vertices = np.empty(len(last), np.int64)
    for number, bone in enumerate(last):
        own = np.flatnonzero(strongest == bone)
        vertices[number] = own[np.linalg.norm(mesh.vertices[own] - tree.heads[bone], axis=1).argmax()]
    places, mirrors = mesh.vertices[vertices], mirrored_bones(tree)
    reach = _BESIDE * float(np.ptp(mesh.vertices[strongest >= 0], axis=0).max(initial=0.0))
    order = np.argsort(-np.linalg.norm(places - tree.heads[moving].mean(axis=0), axis=1), kind="stable").tolist()

    def differ(one: int, other: int) -> bool:
        """Tell whether two ends are of different limbs."""
        return mirrors[last[one]] == last[other] or float(np.linalg.norm(places[one] - places[other])) > reach

    return vertices[best_distinct(order, differ, _MOST)]


def _strongest(weights: csr_array) -> Ints:
    """Find the bone that moves each vertex most, (n,); -1 for none."""
    rows = np.repeat(np.arange(weights.shape[0]), np.diff(weights.indptr))
    order = np.lexsort((weights.data, rows))
    found = np.full(weights.shape[0], -1)
    found[rows[order]] = weights.indices[order]  # the last one of each row stays
    return found
