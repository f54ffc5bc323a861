# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole matches of posed, remeshed bodies whose true correspondence is known."""

from dataclasses import replace

import numpy as np
import pytest

from engine import MatchError, MatchSettings, Shape, TriangleMesh, match, match_steps
from engine.progress import run
from tests.shapes import creature, icosphere, permuted, rotation

QUICK = MatchSettings(points=40, samples=200)


@pytest.fixture(scope="module")
def bodies():
    """A body at rest and, in another meshing, bent; and the rest positions of both."""
    vertices_x, triangles_x, rest_x = creature(0.0, resolution=13)
    vertices_y, triangles_y, rest_y = creature(0.8, resolution=11, turn=0.7)
    return TriangleMesh(vertices_x, triangles_x), TriangleMesh(vertices_y, triangles_y), rest_x, rest_y


@pytest.fixture(scope="module")
def result(bodies):
    return match(bodies[0], bodies[1], QUICK)


def rest_errors(result, bodies):
    """Distance at rest between each point and its image, over the square root of the area."""
    source, _, rest_x, rest_y = bodies
    gap = result.source_points.interpolate(rest_x) - result.target_points.interpolate(rest_y)
    return np.linalg.norm(gap, axis=1) / np.sqrt(source.area)


def test_another_pose_and_meshing_is_matched(result, bodies):
    errors = rest_errors(result, bodies)
    assert errors.mean() < 0.05
    assert errors.max() < 0.25
    assert result.orientation > 0.3
    assert result.coarse.proven
    assert result.coarse.lower_bound == pytest.approx(result.coarse.cost)


def test_the_mirrored_answer_is_another_one_with_the_opposite_orientation(result, bodies):
    mirrored = result.mirrored
    assert mirrored is not None
    assert mirrored.mirrored is None
    assert mirrored.orientation < 0
    assert rest_errors(mirrored, bodies).mean() > 2 * rest_errors(result, bodies).mean()
    np.testing.assert_array_equal(mirrored.source_points.nearest_vertices, result.source_points.nearest_vertices)


def test_the_result_is_consistent_in_itself(result, bodies):
    source, target = bodies[:2]
    k = QUICK.points
    assert len(result.source_points) == len(result.target_points) == k
    for points, mesh, distances in (
        (result.source_points, source, result.source_distances),
        (result.target_points, target, result.target_distances),
    ):
        assert len(set(points.nearest_vertices.tolist())) == k
        np.testing.assert_allclose(points.positions, mesh.vertices[points.nearest_vertices], atol=1e-12)
        assert distances.shape == (k, mesh.vertex_count)
        np.testing.assert_allclose(distances[np.arange(k), points.nearest_vertices], 0, atol=1e-6)
    assert result.distortion == pytest.approx(result.linear + QUICK.quadratic_weight * result.quadratic)
    between = [
        d[:, p.nearest_vertices] / np.sqrt(m.area)
        for d, p, m in (
            (result.source_distances, result.source_points, source),
            (result.target_distances, result.target_points, target),
        )
    ]
    difference = (between[0] + between[0].T - between[1] - between[1].T) / 2
    assert result.quadratic == pytest.approx(np.square(difference).sum(), rel=1e-4)
    np.testing.assert_allclose(result.point_distortion**2 * (k - 1), np.square(difference).sum(axis=1), rtol=1e-3)
    assert [level.points for level in result.levels] == [10, 20, 40]
    assert result.levels[-1].distortion == pytest.approx(result.distortion)
    assert set(result.seconds) == {"geodesics", "descriptors", "coarse", "hierarchy"}


def test_the_same_input_gives_the_same_output(result, bodies):
    again = match(bodies[0], bodies[1], QUICK)
    np.testing.assert_array_equal(again.target_points.triangles, result.target_points.triangles)
    np.testing.assert_array_equal(again.target_points.barycentric, result.target_points.barycentric)
    assert again.distortion == result.distortion


def test_position_size_units_and_vertex_order_do_not_matter(result, bodies):
    source, target = bodies[:2]
    moved = TriangleMesh(254 * source.vertices @ rotation([1, 2, 0.5], 2.0).T + [10, -300, 7], source.triangles)
    vertices, triangles, order = _reordered(target)
    other = match(moved, TriangleMesh(vertices, triangles), QUICK)
    np.testing.assert_array_equal(other.source_points.nearest_vertices, result.source_points.nearest_vertices)
    np.testing.assert_array_equal(order[other.target_points.nearest_vertices], result.target_points.nearest_vertices)
    assert other.distortion == pytest.approx(result.distortion, rel=1e-6)


def _reordered(mesh):
    """Shuffle vertices and triangles; order[new] = old."""
    vertices, triangles = permuted(mesh.vertices, mesh.triangles, seed=5)[:2]
    order = np.array([np.flatnonzero((mesh.vertices == v).all(axis=1))[0] for v in vertices])
    return vertices, triangles, order


def test_a_shape_is_measured_once_for_many_matches(bodies, result):
    source, target = Shape(bodies[0]), Shape(bodies[1])
    first = match(source, target, QUICK)
    rows = source.sample_rows
    second = match(source, target, QUICK)
    assert source.sample_rows is rows
    np.testing.assert_array_equal(first.target_points.triangles, second.target_points.triangles)
    np.testing.assert_array_equal(first.target_points.triangles, result.target_points.triangles)


def test_a_match_does_not_depend_on_those_before_it(bodies, result):
    source, target = Shape(bodies[0]), Shape(bodies[1])
    match(source, target, replace(QUICK, samples=333, points=12))
    again = match(source, target, QUICK)
    np.testing.assert_array_equal(again.target_points.triangles, result.target_points.triangles)
    assert again.distortion == pytest.approx(result.distortion, rel=1e-12)


def test_a_body_matches_itself_exactly(bodies):
    result = match(bodies[0], bodies[0], QUICK)
    np.testing.assert_array_equal(result.target_points.nearest_vertices, result.source_points.nearest_vertices)
    assert result.distortion == pytest.approx(0, abs=1e-9)
    assert result.orientation == pytest.approx(1)


def test_wrong_coarse_matches_are_repaired_on_the_way(bodies):
    """As in figure 3 of the paper: errors of the first points get smaller towards the finest level."""
    result = match(bodies[0], bodies[1], replace(QUICK, coarse_candidates=14))
    first, last = (
        np.linalg.norm(
            bodies[2][result.source_points.nearest_vertices[:10]] - level.target_points.interpolate(bodies[3])[:10],
            axis=1,
        )
        for level in (result.levels[0], result.levels[-1])
    )
    assert last.mean() <= first.mean()


def test_progress_rises_and_the_work_can_be_dropped(bodies):
    fractions = []
    steps = match_steps(bodies[0], bodies[1], replace(QUICK, points=12, samples=60))
    result = run(_watched(steps, fractions))
    assert len(result.source_points) == 12
    assert fractions == sorted(fractions)
    assert fractions[0] >= 0
    assert fractions[-1] == 1
    dropped = match_steps(bodies[0], bodies[1], QUICK)
    next(dropped)
    dropped.close()
    with pytest.raises(StopIteration):
        next(dropped)


def _watched(steps, fractions):
    while True:
        try:
            progress = next(steps)
        except StopIteration as stop:
            return stop.value
        fractions.append(progress.fraction)
        yield progress


def test_only_the_largest_part_is_matched_and_the_result_says_so(bodies, result):
    source, target = bodies[:2]
    ball, faces = icosphere(3, radius=0.1)
    apart = TriangleMesh(
        np.concatenate([ball + 5, source.vertices]), np.concatenate([faces, source.triangles + len(ball)])
    )
    other = match(apart, target, QUICK)
    assert any("source has 2 separate parts" in note for note in other.notes)
    np.testing.assert_array_equal(
        other.source_points.nearest_vertices - len(ball), result.source_points.nearest_vertices
    )
    np.testing.assert_array_equal(other.target_points.triangles, result.target_points.triangles)
    assert np.isinf(other.source_distances[:, : len(ball)]).all()
    assert not result.notes


def test_more_points_than_vertices_are_refused_in_words(bodies):
    ball = TriangleMesh(*icosphere(2))
    with pytest.raises(MatchError, match="target has only 42 vertices"):
        match(bodies[0], ball, replace(QUICK, points=43))


def test_few_points_on_tiny_meshes_work():
    ball, faces = icosphere(2)
    mesh = TriangleMesh(ball * [1, 1.4, 2], faces)
    result = match(mesh, mesh, MatchSettings(points=5, coarse_points=4, coarse_candidates=8))
    assert len(result.target_points) == 5
    assert result.distortion == pytest.approx(0, abs=1e-9)
