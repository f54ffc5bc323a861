# SPDX-License-Identifier: GPL-3.0-or-later
"""Two shapes matched as they are, without a dense map, and the time of each stage."""

from dataclasses import replace

import numpy as np
import pytest

from engine import MatchError, MatchSettings, Shape, TriangleMesh
from engine.matching import shape_matching
from engine.matching.shape_matching import Clock, MatchTask, _distinct_samples, matched_steps
from engine.runtime.progress import run
from tests.shapes import creature, icosphere

SPARSE = MatchSettings(
    points=12, samples=50, coarse_points=6, coarse_candidates=12, hypotheses=2, dense=False, settle=False
)


@pytest.fixture(scope="module")
def meshes():
    return [TriangleMesh(*creature(pose, 8)[:2]) for pose in (0.0, 0.5)]


@pytest.fixture(scope="module")
def result(meshes):
    return run(matched_steps(*(Shape(mesh) for mesh in meshes), MatchTask(SPARSE, None)))


def test_laps_are_the_times_between(monkeypatch):
    now = iter([10.0, 11.0, 13.0, 17.0])
    monkeypatch.setattr(shape_matching.time, "perf_counter", lambda: next(now))
    clock = Clock()
    for name in ("first", "second", "first"):
        clock.lap(name)
    assert clock.laps == {"first": 1.0 + 4.0, "second": 2.0}


@pytest.mark.parametrize("first", [True, False])
def test_the_mesh_with_too_few_vertices_is_named(first, meshes):
    shapes = [Shape(TriangleMesh(*icosphere(1))), Shape(meshes[0])]
    task = MatchTask(replace(SPARSE, points=13), None)
    with pytest.raises(MatchError, match=f"the {'source' if first else 'target'} has only 12 vertices"):
        run(matched_steps(*(shapes if first else shapes[::-1]), task))


def test_the_distortion_is_made_of_its_parts(result):
    assert len(result.source_points) == len(result.target_points) == SPARSE.points
    weight = SPARSE.quadratic_weight
    for one in (result, result.mirrored):
        assert one.distortion == pytest.approx(one.linear + weight * one.quadratic)
        # Each point's share is a root mean square over the others.
        shares = np.square(one.point_distortion).sum() * (SPARSE.points - 1)
        assert shares == pytest.approx(one.quadratic)


def test_the_second_answer_is_of_the_other_orientation(result):
    assert result.orientation > 0 > result.mirrored.orientation
    assert result.mirrored.mirrored is None


def test_distances_are_zero_at_the_points_themselves(result):
    for points, rows in (
        (result.source_points, result.source_distances),
        (result.target_points, result.target_distances),
    ):
        assert (rows >= 0).all()
        np.testing.assert_array_equal(rows.argmin(axis=1), points.nearest_vertices)
        np.testing.assert_allclose(rows[np.arange(len(points)), points.nearest_vertices], 0, atol=1e-6)


def test_landmarks_come_first_and_exactly(meshes):
    known = np.array([[7, 7], [300, 300]])
    found = run(matched_steps(*(Shape(mesh) for mesh in meshes), MatchTask(SPARSE, known)))
    np.testing.assert_array_equal(found.source_points.nearest_vertices[:2], known[:, 0])
    np.testing.assert_array_equal(found.target_points.positions[:2], meshes[1].vertices[known[:, 1]])


def test_every_stage_is_timed(result):
    assert list(result.seconds) == ["preparation", "geodesics", "descriptors", "coarse", "hierarchy"]


def test_points_get_samples_of_their_own_near_to_them_and_landmarks_theirs():
    """On a line: the last two points are nearest to one sample, and the landmark is far from its own."""
    samples, points = np.array([9.0, 0, 1, 2, 3, 4]), np.array([0.0, 0.1, 2.1, 2.2])
    rows = np.abs(samples[:, None] - points).astype(np.float32)
    assert _distinct_samples(rows, 0).tolist() == [1, 2, 3, 4]
    assert _distinct_samples(rows, 1).tolist() == [0, 1, 3, 4]
