# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones and weights for the creature of `tests.shapes`, in any meshing."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

CREATURE_BONES = {
    "root": (None, (0.0, 0.0, -1.15), (0.4, 0.0, -1.15)),
    "spine": ("root", (-0.6, 0.0, 0.02), (0.0, 0.0, 0.03)),
    "chest": ("spine", (0.0, 0.0, 0.03), (0.55, 0.0, 0.12)),
    "neck": ("chest", (0.55, 0.0, 0.12), (0.95, 0.0, 0.45)),
    "head": ("neck", (0.95, 0.0, 0.45), (1.35, 0.0, 0.38)),
    "tail": ("spine", (-0.7, 0.0, 0.1), (-1.0, 0.0, 0.13)),
    "tail tip": ("tail", (-1.0, 0.0, 0.13), (-1.3, 0.0, 0.16)),
    "upper front.L": ("chest", (0.45, 0.2, -0.1), (0.46, 0.2, -0.5)),
    "lower front.L": ("upper front.L", (0.46, 0.2, -0.5), (0.45, 0.2, -1.0)),
    "upper front.R": ("chest", (0.45, -0.2, -0.1), (0.46, -0.2, -0.47)),
    "lower front.R": ("upper front.R", (0.46, -0.2, -0.47), (0.45, -0.2, -0.9)),
    "upper hind.L": ("spine", (-0.5, 0.2, -0.1), (-0.51, 0.2, -0.55)),
    "lower hind.L": ("upper hind.L", (-0.51, 0.2, -0.55), (-0.5, 0.2, -1.15)),
    "upper hind.R": ("spine", (-0.5, -0.2, -0.1), (-0.51, -0.2, -0.52)),
    "lower hind.R": ("upper hind.R", (-0.51, -0.2, -0.52), (-0.5, -0.2, -1.05)),
    "target front.L": ("root", (0.45, 0.2, -1.0), (0.6, 0.2, -1.0)),
    "pole front.L": ("root", (1.1, 0.2, -0.5), (1.2, 0.2, -0.5)),
}
"""Of each bone its parent, head and tail; parents come first.  A head at its parent's tail means connected."""

CONTROLS = ("root", "target front.L", "pole front.L")
"""Those that move no vertices themselves."""


def creature_bones():
    """Names, parents (b,), heads (b, 3) and tails (b, 3) of the creature's bones."""
    names = tuple(CREATURE_BONES)
    parents, heads, tails = zip(*CREATURE_BONES.values(), strict=True)
    numbers = [-1 if parent is None else names.index(parent) for parent in parents]
    return names, np.array(numbers), np.array(heads), np.array(tails)


def creature_weights(rest):
    """Smooth weights (n, b) of these bones for points (n, 3) of the creature at rest, four at most for each."""
    names, _, heads, tails = creature_bones()
    axes = tails - heads
    along = np.einsum("nbd,bd->nb", rest[:, None] - heads, axes) / np.square(axes).sum(axis=1)
    nearest = heads + along.clip(0, 1)[:, :, None] * axes
    squares = np.square(rest[:, None] - nearest).sum(axis=2)
    squares[:, [names.index(name) for name in CONTROLS]] = np.inf
    weights = np.exp((squares.min(axis=1, keepdims=True) - squares) / (2 * 0.08**2))
    weights[weights < np.maximum(0.02, np.sort(weights, axis=1)[:, [-4]])] = 0
    return csr_array(weights / weights.sum(axis=1, keepdims=True))
