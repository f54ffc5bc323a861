# SPDX-License-Identifier: GPL-3.0-or-later
"""The creature of the tests, put together from pieces as modular characters are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine import TriangleMesh
from tests.messes import in_limbs
from tests.shapes import creature

DEPTH = 0.02


@dataclass(frozen=True, eq=False)
class ModularCreature:
    """The creature in pieces: places at rest of its vertices, (n, 3), and the piece of each, by size, (n,)."""

    mesh: TriangleMesh
    rest: np.ndarray
    pieces: np.ndarray


def modular_creature(pose=0.0, turn=0.0, cuts=(0.45, 0.5, 0.8), resolution=10):
    """Cut the creature into a trunk, legs, tail, and head, so far from the middle."""
    down, back, front = cuts
    vertices, triangles, rest = creature(pose, resolution, turn)
    parts = np.zeros(len(rest), np.int64)
    legs = rest[:, 2] < -down
    parts[legs] = 1 + 2 * (rest[legs, 0] > 0) + (rest[legs, 1] > 0)
    parts[(rest[:, 0] < -back - 0.25) & ~legs] = 5
    parts[(rest[:, 0] > front) & ~legs] = 6
    vertices, triangles, whole = in_limbs(vertices, triangles, parts, DEPTH)
    mesh = TriangleMesh(vertices, triangles)
    return ModularCreature(mesh, rest[whole], mesh.component_labels)
