# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole matches of posed, remeshed bodies whose true correspondence is known."""

from dataclasses import replace

import numpy as np
import pytest

from engine import (
    MatchError,
    MatchSettings,
    MeshError,
    SettingsError,
    Shape,
    TriangleMesh,
    find_symmetry,
    match,
    match_steps,
    retrieve,
)
from engine.matching.shape_matching import MatchTask, matched_steps
from engine.runtime.progress import run
from tests.shapes import creature, icosphere, permuted, rotation
from tests.steps import followed

QUICK = MatchSettings(points=40, samples=200, dense=False)


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
    between = []
    for points, mesh, distances in (
        (result.source_points, source, result.source_distances),
        (result.target_points, target, result.target_distances),
    ):
        np.testing.assert_allclose(points.positions, points.interpolate(mesh.vertices), atol=1e-12)
        assert points.barycentric.min() >= 0
        np.testing.assert_allclose(points.barycentric.sum(axis=1), 1)
        assert distances.shape == (k, mesh.vertex_count)
        rows = points.interpolate(distances.T)  # from every point to every point
        assert np.diag(rows).max() < mesh.edge_lengths.max()
        between.append((rows + rows.T) / 2 / np.sqrt(mesh.area))
    np.testing.assert_array_equal(result.source_points.barycentric.max(axis=1), 1)
    assert (result.target_points.barycentric.max(axis=1) < 1).any()
    assert result.distortion == pytest.approx(result.linear + QUICK.quadratic_weight * result.quadratic)
    np.testing.assert_allclose(result.point_distortion**2 * (k - 1), _squares(*between), rtol=0.5, atol=5e-3)
    assert (result.point_distortion**2 * (k - 1)).sum() == pytest.approx(result.quadratic)
    assert [level.points for level in result.levels] == [10, 20, 40]
    assert result.levels[-1].distortion == pytest.approx(result.distortion)
    assert set(result.seconds) == {"preparation", "geodesics", "descriptors", "coarse", "hierarchy", "settling"}


def _squares(first, second):
    return np.square(first - second).sum(axis=1)


def test_without_settling_the_points_stay_at_samples_and_the_distortion_is_larger(result, bodies):
    target = Shape(bodies[1])
    plain = match(bodies[0], target, replace(QUICK, settle=False))
    assert set(plain.target_points.nearest_vertices) <= set(target.samples.vertices)
    np.testing.assert_array_equal(plain.target_points.barycentric.max(axis=1), 1)
    assert len(set(plain.target_points.nearest_vertices)) == QUICK.points
    assert result.distortion < plain.distortion
    assert rest_errors(result, bodies).mean() < rest_errors(plain, bodies).mean() + 0.005
    between = [
        d[:, p.nearest_vertices] / np.sqrt(m.area)
        for d, p, m in (
            (plain.source_distances, plain.source_points, bodies[0]),
            (plain.target_distances, plain.target_points, bodies[1]),
        )
    ]
    symmetric = [(d + d.T) / 2 for d in between]
    assert plain.quadratic == pytest.approx(_squares(*symmetric).sum(), rel=1e-4)


@pytest.mark.parametrize("solver", ["flat", "gmds"])
def test_the_solvers_to_compare_with_find_the_match_too(solver, bodies):
    result = match(*bodies[:2], replace(QUICK, points=14 if solver == "flat" else 40, solver=solver))
    assert rest_errors(result, bodies).mean() < 0.08
    assert result.orientation > 0.3
    assert result.levels[-1].points == len(result.target_points)
    if solver == "flat":
        assert result.coarse.proven
        assert len(result.coarse.source_vertices) == 14


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
    rows = source.samples.rows
    second = match(source, target, QUICK)
    assert source.samples.rows is rows
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


def test_progress_rises(bodies):
    reports, result = followed(match_steps(bodies[0], bodies[1], replace(QUICK, points=12, samples=60)))
    fractions = [report.fraction for report in reports]
    assert len(result.source_points) == 12
    assert fractions == sorted(fractions)
    assert fractions[0] >= 0
    assert fractions[-1] == 1


def test_only_the_largest_part_is_matched_and_the_result_says_so(bodies, result):
    source, target = bodies[:2]
    ball, faces = icosphere(3, radius=0.1)
    apart = TriangleMesh(
        np.concatenate([ball + 5, source.vertices]), np.concatenate([faces, source.triangles + len(ball)])
    )
    other = match(apart, target, QUICK)
    assert any("source has 1 smaller part" in note for note in other.notes)
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


def test_arrays_in_the_place_of_meshes_and_a_dictionary_of_settings_are_refused_in_words(bodies):
    arrays = bodies[1].vertices, bodies[1].triangles
    with pytest.raises(MeshError, match=r"target is of the type tuple.*TriangleMesh\(vertices, triangles\)"):
        match(bodies[0], arrays)
    with pytest.raises(MeshError, match="source is of the type NoneType"):
        match(None, bodies[1])
    with pytest.raises(MeshError, match="shape 2 of the list is of the type tuple"):
        retrieve(bodies[0], [bodies[1], arrays])
    with pytest.raises(MeshError, match="surface is of the type ndarray"):
        find_symmetry(bodies[0].vertices)
    with pytest.raises(SettingsError, match=r"MatchSettings\(\*\*settings\)"):
        match(*bodies[:2], {"points": 40})


def test_few_points_on_tiny_meshes_work():
    ball, faces = icosphere(2)
    mesh = TriangleMesh(ball * [1, 1.4, 2], faces)
    result = match(mesh, mesh, MatchSettings(points=5, coarse_points=4, coarse_candidates=8, dense=False))
    assert len(result.target_points) == 5
    assert result.distortion == pytest.approx(0, abs=1e-9)


def test_seconds_that_are_taken_later_change_no_result(bodies):
    task = MatchTask(replace(QUICK, points=10, samples=60, settle=False), None)
    result = run(matched_steps(Shape(bodies[0]), Shape(bodies[1]), task))
    before = dict(result.seconds)
    task.clock.lap("coarse")
    task.clock.lap("later")
    assert result.seconds == before
    noted = task.clock.noted(result)
    assert noted.seconds == task.clock.laps
    assert noted.seconds is not task.clock.laps
    assert noted.mirrored is None or noted.mirrored.seconds == noted.seconds
