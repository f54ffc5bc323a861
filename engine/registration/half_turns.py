# SPDX-License-Identifier: GPL-3.0-or-later
"""Half turns of a surface that lies on another: the start for bodies that look the other way."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.procrustes import nearest_similarity
from ..runtime.arrays import Floats
from .deformable import DeformableSurface

_POSE = 15
"""Eigenfunctions that say how the source is posed.  More of them lay feet backward, too: with 40 the avatar of
``python -m tests.benchmarks.maker_rigs`` came to stand so on a man; with 8 it stood as with these."""


def half_turned(source: DeformableSurface, target: DeformableSurface, positions: Floats, functions: Floats) -> Floats:
    """Turn a surface half around from where it lies on another one, in its own shape and in the pose that it has there.

    What lies on the other surface has its shape already.  If a body looks the other way, its feet have been bent back
    to that by now, and would be backward again after a half turn.

    Parameters
    ----------
    source, target : DeformableSurface
        The surfaces X and Y.
    positions : (n_x, 3) array of float
        Where the source lies.
    functions : (n_x, k) array of float
        The first Laplace-Beltrami eigenfunctions of the source, orthonormal under its unit mass.

    Returns
    -------
    (n_x, 3) array of float
        Positions after the half turn, around a main axis of the target, that leaves the surfaces nearest to each other.
    """
    lying = _nearest_half_turn(source, target, positions)
    linear, translation = nearest_similarity(source.vertices, lying, source.mass)
    own = source.vertices @ linear.T + translation
    return own + source.smoothed(lying - own, functions[:, :_POSE])


def _nearest_half_turn(source: DeformableSurface, target: DeformableSurface, positions: Floats) -> Floats:
    """Turn positions half around each main axis of the target, and take what is nearest to it, as seen from both."""
    centre = np.average(target.vertices, axis=0, weights=target.mass)
    spread, lying = target.vertices - centre, positions - centre
    axes = np.linalg.eigh(spread.T @ (target.mass[:, None] * spread))[1].T
    ways: list[Floats] = [centre + 2 * np.outer(lying @ axis, axis) - lying for axis in axes]
    tree = cKDTree(target.vertices)

    def apart(way: Floats) -> float:
        """Mean distance between vertices and the nearest ones of the other surface."""
        there, back = tree.query(way)[0], cKDTree(way).query(target.vertices)[0]
        return float(np.average(there, weights=source.mass) + np.average(back, weights=target.mass))

    return min(ways, key=apart)
