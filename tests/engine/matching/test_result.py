# SPDX-License-Identifier: GPL-3.0-or-later
"""What results look like when they are printed."""

from dataclasses import is_dataclass

import numpy as np
import pytest

import engine
from engine import MatchSettings, Polygons, Shape, SurfaceMap, TriangleMesh, find_symmetry, match, retrieve
from tests.shapes import creature

PLAIN = {"MatchQuality", "MatchSettings", "MotionSettings", "Progress", "RetrievalSettings"}
"""What has no arrays."""


@pytest.fixture(scope="module")
def shape():
    return Shape(TriangleMesh(*creature(0.0, 9)[:2]))


@pytest.fixture(scope="module")
def settings():
    return MatchSettings(points=10, samples=60, dense=False)


@pytest.mark.parametrize("name", [name for name in engine.__all__ if is_dataclass(getattr(engine, name))])
def test_what_holds_arrays_has_a_short_form_of_its_own(name):
    """The one that dataclasses get by themselves prints all arrays."""
    assert hasattr(getattr(engine, name).__repr__, "__wrapped__") == (name in PLAIN)


def test_results_print_as_one_short_line(shape, settings):
    result, found = match(shape, shape, settings), retrieve(shape, [shape])
    identity = SurfaceMap.identity(shape.mesh)
    quad = Polygons([0, 4], [0, 1, 2, 3], [[0, 1], [1, 2], [2, 3], [3, 0]], [0, 1, 2, 3], [[0, 1, 2], [0, 2, 3]])
    values = [
        shape,
        shape.mesh,
        quad,
        identity,
        identity.points,
        result,
        result.coarse,
        *result.levels,
        found,
        *found.matches,
        find_symmetry(shape, settings),
        engine.DenseMatch(identity, identity, engine.MatchQuality(1, 0, 1, 0, None, 0.9, "")),
        engine.Skeleton([-1, 0], np.zeros((2, 3)), np.ones((2, 3))),
        engine.LocalFrames(np.zeros((4, 3, 3)), np.ones(4), 1.0),
        engine.WrappedSurface(np.zeros((4, 3)), np.ones(4, bool), 0.0),
        engine.PlacedJoints(*np.zeros((3, 2, 3)), np.zeros((2, 3, 3))),
        engine.RestPose(*np.zeros((2, 2, 3)), np.zeros((2, 3, 3))),
    ]
    for value in values:
        text = repr(value)
        assert text.startswith(f"<{type(value).__name__}: ")
        assert len(text) < 90
        assert "\n" not in text
    count = shape.mesh.vertex_count
    assert repr(shape.mesh) == f"<TriangleMesh: {count} vertices, {shape.mesh.triangle_count} triangles>"
    assert "10 points" in repr(result)
    assert "confidence 0.90" in repr(values[-6])
