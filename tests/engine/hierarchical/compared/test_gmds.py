# SPDX-License-Identifier: GPL-3.0-or-later
"""Generalised multidimensional scaling between surfaces."""

import numpy as np
import pytest

from engine import MatchError, Shape, SurfacePoints, TriangleMesh, run
from engine.hierarchical.compared.gmds import gmds_steps
from engine.shapes.surface_distances import EmbeddedDistances, SurfaceDistances, symmetric_roots
from tests.shapes import creature, icosphere, plane


@pytest.fixture(scope="module")
def bodies():
    """A body at rest and, in another meshing, bent; and the rest positions of both."""
    vertices_x, triangles_x, rest_x = creature(0.0, resolution=13)
    vertices_y, triangles_y, rest_y = creature(0.8, resolution=11, turn=0.7)
    return Shape(TriangleMesh(vertices_x, triangles_x)), Shape(TriangleMesh(vertices_y, triangles_y)), rest_x, rest_y


@pytest.fixture(scope="module")
def result(bodies):
    return run(gmds_steps(*bodies[:2], 40))


def true_start(bodies, count):
    source, target, rest_x, rest_y = bodies
    run(source.sample_steps(count))
    wanted = rest_x[source.samples.vertices[:count]]
    return SurfacePoints.at_vertices(target.mesh, np.square(rest_y - wanted[:, None]).sum(axis=2).argmin(axis=1))


def rest_errors(result, bodies):
    source, _, rest_x, rest_y = bodies
    gap = result.source_points.interpolate(rest_x) - result.target_points.interpolate(rest_y)
    return np.linalg.norm(gap, axis=1) / source.scale


def differences(result, bodies):
    source, target = bodies[:2]
    distances = SurfaceDistances(target)
    run(distances.prepare_steps(result.target_points))
    count = len(result.target_points)
    return symmetric_roots(distances.squares_between(result.target_points)) - source.samples.distances[:count, :count]


def test_the_result_is_consistent_in_itself(result, bodies):
    source = bodies[0]
    assert len(result.source_points) == len(result.target_points) == 40
    np.testing.assert_array_equal(result.source_points.nearest_vertices, source.samples.vertices[:40])
    difference = differences(result, bodies)
    assert result.quadratic == pytest.approx(np.square(difference).sum())
    np.testing.assert_allclose(result.distances - source.samples.distances[:40, :40], difference)
    assert [level.points for level in result.levels] == [10, 20, 40]
    assert result.levels[-1].stress == pytest.approx(result.quadratic)
    assert all(level.stress <= level.start for level in result.levels)


def test_its_own_start_keeps_the_distances(result, bodies):
    """Whether it finds the true or a mirrored answer is left open: distances cannot tell them apart."""
    from_truth = run(gmds_steps(*bodies[:2], 40, start=true_start(bodies, 10)))
    assert result.quadratic < 1.3 * from_truth.quadratic


def test_from_a_true_start_the_points_come_close_to_the_truth(bodies):
    found = run(gmds_steps(*bodies[:2], 40, start=true_start(bodies, 10)))
    errors = rest_errors(found, bodies)
    assert errors.mean() < 0.03
    assert errors.max() < 0.2
    # Rounded to vertices, the same points keep the distances less well.
    rounded = SurfacePoints.at_vertices(bodies[1].mesh, found.target_points.nearest_vertices)
    distances = SurfaceDistances(bodies[1])
    run(distances.prepare_steps(rounded))
    at_vertices = np.square(
        symmetric_roots(distances.squares_between(rounded)) - bodies[0].samples.distances[:40, :40]
    ).sum()
    assert found.quadratic < 0.7 * at_vertices


def test_a_shape_matches_itself_without_stress(bodies):
    target = bodies[1]
    run(target.sample_steps(30))
    start = SurfacePoints.at_vertices(target.mesh, target.samples.vertices[:10])
    found = run(gmds_steps(target, target, 30, start=start))
    assert found.quadratic < 1e-3
    np.testing.assert_allclose(found.target_points.positions, found.source_points.positions, atol=0.02 * target.scale)


def test_its_own_start_finds_a_shape_in_itself(bodies):
    target = bodies[1]
    found = run(gmds_steps(target, target, 20))
    assert found.quadratic < 1e-3
    np.testing.assert_allclose(found.target_points.positions, found.source_points.positions, atol=0.02 * target.scale)


def test_a_square_is_found_in_another_meshing_of_it():
    """Distances are straight in the plane, so the answer is one of the eight symmetries of the square."""
    source = Shape(TriangleMesh(*plane(16, jitter=0.3, seed=1)))
    vertices, triangles = plane(19, jitter=0.35, seed=2)
    target = Shape(TriangleMesh(5 * vertices, triangles))
    found = run(gmds_steps(source, target, 24))
    a = found.source_points.positions[:, :2] - 0.5
    b = found.target_points.positions[:, :2] / 5 - 0.5
    u, _, v = np.linalg.svd(a.T @ b)
    assert np.linalg.norm(a @ u @ v - b, axis=1).max() < 0.01


def test_size_and_what_was_computed_before_do_not_matter(result, bodies):
    source, target = bodies[:2]
    larger = Shape(TriangleMesh(300 * target.mesh.vertices, target.mesh.triangles))
    fresh = run(gmds_steps(source, larger, 40))
    assert fresh.quadratic == pytest.approx(result.quadratic, rel=1e-3)
    run(larger.sample_steps(700))
    again = run(gmds_steps(source, larger, 40, distances=SurfaceDistances(larger)))
    assert again.quadratic == fresh.quadratic
    np.testing.assert_array_equal(again.target_points.barycentric, fresh.target_points.barycentric)


def test_another_metric_can_be_given():
    """Straight distances through space between two meshings of a sphere: a rotation is found."""
    source, target = (Shape(TriangleMesh(*icosphere(parts))) for parts in (7, 6))
    run(source.sample_steps(16))
    places = source.mesh.vertices[source.samples.vertices[:16]]
    wanted = np.linalg.norm(places[:, None] - places, axis=2)
    metric = EmbeddedDistances(target.mesh, target.mesh.vertices)
    found = run(gmds_steps(source, target, 16, wanted=wanted, distances=metric))
    assert found.quadratic < 16**2 * 0.01**2
    u, _, v = np.linalg.svd(places.T @ found.target_points.positions)
    assert np.linalg.norm(places @ u @ v - found.target_points.positions, axis=1).max() < 0.03


def test_only_the_largest_part_is_used_and_results_lie_on_the_whole():
    vertices, triangles, _ = creature(0.4, 9)
    extra, extra_triangles = icosphere(2, radius=0.1)
    both = TriangleMesh(
        np.concatenate([extra + 5, vertices]), np.concatenate([extra_triangles, triangles + len(extra)])
    )
    target = Shape(both)
    found = run(gmds_steps(Shape(TriangleMesh(vertices, triangles)), target, 16))
    assert (found.target_points.corners >= len(extra)).all()
    np.testing.assert_array_equal(both.triangles[found.target_points.triangles], found.target_points.corners)
    start = SurfacePoints.at_vertices(target.mesh, target.samples.vertices[:8])
    assert target.surface.on_original(start).positions == pytest.approx(start.positions)
    with pytest.raises(MatchError, match="main part"):
        run(gmds_steps(target, target, 16, start=SurfacePoints.at_vertices(both, np.arange(8))))


def test_it_reports_growing_progress(bodies):
    steps = gmds_steps(*bodies[:2], 20)
    fractions = [progress.fraction for progress in steps]
    assert len(fractions) > 10
    assert fractions == sorted(fractions)
    assert fractions[0] >= 0
    assert fractions[-1] <= 1
