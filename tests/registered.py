# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces and starts for tests of what is registered."""

import numpy as np

from engine import Shape, TriangleMesh, run
from engine.dense.dense_hypotheses import SparseStart

SAMPLES = 150


def shape(vertices, triangles):
    """A surface with samples."""
    made = Shape(TriangleMesh(vertices, triangles))
    run(made.sample_steps(SAMPLES))
    return made


def start_from(x, y, vertices_x, vertices_y, origin="given"):
    """Vertices that correspond, as a start."""
    rows = x.solver.distances(np.asarray(vertices_x)) / x.scale
    return SparseStart(rows, y.solver.distances(np.asarray(vertices_y)) / y.scale, origin)
