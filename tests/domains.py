# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces as hypotheses about maps see them, for tests of how these are found and scored."""

from __future__ import annotations

from engine import Shape, TriangleMesh
from engine.dense.spectral_domain import MapDomain
from engine.runtime.progress import run


def domain(vertices, triangles, samples=200, eigenpairs=60):
    """Make a surface with so many samples and eigenpairs, or as many as it has."""
    shape = Shape(TriangleMesh(vertices, triangles))
    run(shape.sample_steps(samples))
    run(shape.spectrum_steps(eigenpairs))
    return MapDomain(shape, min(eigenpairs, len(shape.spectrum)))
