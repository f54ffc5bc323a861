# SPDX-License-Identifier: GPL-3.0-or-later
"""Points that move over a surface until their distances are the wanted ones."""

import numpy as np
import pytest

from engine import Progress, Shape, SurfacePoints, TriangleMesh, run
from engine.hierarchical.compared.stress_descent import Stress, joined, settle_steps
from engine.shapes.surface_distances import EmbeddedDistances, SurfaceDistances, symmetric_roots
from tests.shapes import creature, plane, plane_with_hole
from tests.steps import followed


def pairwise(positions):
    return np.linalg.norm(positions[:, None] - positions, axis=2)


def nearest_vertices(mesh, positions):
    distances = np.square(mesh.vertices - positions[:, None]).sum(axis=2)
    return SurfacePoints.at_vertices(mesh, distances.argmin(axis=1))


@pytest.fixture(scope="module")
def patch():
    """A unit square, meshed irregularly; its square root of the area is 1."""
    return Shape(TriangleMesh(*plane(18, jitter=0.35, seed=1)))


def test_a_moved_figure_is_found_in_the_plane(patch):
    random = np.random.default_rng(0)
    figure = random.uniform(0.25, 0.75, (12, 3)) * [1, 1, 0]
    start = nearest_vertices(patch.mesh, figure + random.uniform(-0.15, 0.15, (12, 3)) * [1, 1, 0])
    wanted = pairwise(figure)
    settled = run(settle_steps(SurfaceDistances(patch), start, Stress(wanted), tolerance=1e-5, max_sweeps=100))
    found = settled.points.positions
    # Fast marching is exact in the plane but for some needles.
    assert np.abs(pairwise(found) - wanted).max() < 5e-3
    assert np.abs(pairwise(start.positions) - wanted).max() > 0.1
    # The figure is moved rigidly: a rotation and a translation carry it over.
    a, b = figure[:, :2] - figure[:, :2].mean(axis=0), found[:, :2] - found[:, :2].mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    assert np.linalg.norm(a @ u @ v - b, axis=1).max() < 5e-3


def test_points_at_their_places_stay_there(patch):
    random = np.random.default_rng(3)
    places = SurfacePoints.from_barycentric(
        patch.mesh, random.integers(0, patch.mesh.triangle_count, 10), random.dirichlet([1, 1, 1], 10)
    )
    distances = SurfaceDistances(patch)
    run(distances.prepare_steps(places))
    settled = run(settle_steps(distances, places, Stress(symmetric_roots(distances.squares_between(places)))))
    assert settled.stress == settled.start == 0
    np.testing.assert_array_equal(settled.points.barycentric, places.barycentric)


def test_the_stress_is_that_of_the_points_and_never_rises(patch):
    random = np.random.default_rng(4)
    wanted = pairwise(random.uniform(0, 1, (15, 2)))
    start = SurfacePoints.at_vertices(patch.mesh, random.choice(patch.mesh.vertex_count, 15, replace=False))
    distances = SurfaceDistances(patch)
    linear = random.random((15, patch.mesh.vertex_count))
    stress = Stress(wanted, linear)
    last = np.inf
    for sweeps in range(6):
        settled = run(settle_steps(distances, start, stress, max_sweeps=sweeps, tolerance=0))
        between = symmetric_roots(distances.squares_between(settled.points))
        own = (linear[np.arange(15)[:, None], settled.points.corners] * settled.points.barycentric).sum()
        expected = own + np.square(between - wanted).sum()
        assert settled.stress == pytest.approx(expected)
        np.testing.assert_allclose(settled.distances, between)
        assert settled.stress <= settled.start
        assert settled.stress < last or sweeps > 3
        assert settled.stress <= last
        last = settled.stress


def test_one_free_point_finds_the_brute_force_minimum(patch):
    """All other points are held by a linear term, which they cannot leave."""
    mesh, random = patch.mesh, np.random.default_rng(5)
    corners = nearest_vertices(mesh, np.array([[0.1, 0.1, 0], [0.9, 0.15, 0], [0.5, 0.9, 0]]))
    free = nearest_vertices(mesh, np.array([[0.8, 0.8, 0]]))
    target = np.array([0.37, 0.41, 0.0])
    positions = np.concatenate([corners.positions, [target]])
    wanted = pairwise(positions) + 0.02 * (1 - np.eye(4)) * random.random((4, 4))
    wanted = (wanted + wanted.T) / 2
    held = np.zeros((4, mesh.vertex_count))
    held[:3] = 1e3 * pairwise(np.concatenate([corners.positions, mesh.vertices]))[:3, 3:]
    settled = run(
        settle_steps(SurfaceDistances(patch), joined(mesh, corners, free), Stress(wanted, held), tolerance=1e-7)
    )
    x, y = np.meshgrid(np.linspace(0.2, 0.6, 201), np.linspace(0.2, 0.6, 201))
    tried = np.stack([x.ravel(), y.ravel()], axis=1)
    cost = np.square(np.linalg.norm(tried[:, None] - positions[:3, :2], axis=2) - wanted[3, :3]).sum(axis=1)
    np.testing.assert_allclose(settled.points.positions[:3], corners.positions, atol=1e-9)
    np.testing.assert_allclose(settled.points.positions[3, :2], tried[cost.argmin()], atol=6e-3)


def test_points_stop_at_boundaries():
    shape = Shape(TriangleMesh(*plane_with_hole(14)))
    start = nearest_vertices(shape.mesh, np.array([[0.1, 0.1, 0], [0.9, 0.9, 0], [0.9, 0.1, 0], [0.1, 0.9, 0]]))
    wanted = 3.0 * (1 - np.eye(4))  # more than there is room for
    settled = run(settle_steps(SurfaceDistances(shape), start, Stress(wanted), tolerance=1e-6))
    corners = np.array([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]])
    np.testing.assert_allclose(settled.points.positions, corners, atol=1e-6)


def test_points_that_lie_on_each_other_are_parted(patch):
    start = nearest_vertices(patch.mesh, np.full((2, 3), 0.5) * [1, 1, 0])
    settled = run(settle_steps(SurfaceDistances(patch), start, Stress(0.3 * (1 - np.eye(2))), tolerance=1e-6))
    assert settled.distances[0, 1] == pytest.approx(0.3, abs=2e-3)


def test_the_linear_term_alone_leads_to_its_minimum(patch):
    mesh = patch.mesh
    linear = np.linalg.norm(mesh.vertices - [0.3, 0.6, 0], axis=1)[None]
    start = nearest_vertices(mesh, np.array([[0.9, 0.9, 0]]))
    settled = run(settle_steps(SurfaceDistances(patch), start, Stress(np.zeros((1, 1)), linear), max_sweeps=60))
    np.testing.assert_array_equal(settled.points.nearest_vertices, linear.argmin(axis=1))
    assert settled.stress == pytest.approx(linear.min(axis=1).sum())


def test_other_metrics_are_settled_too(patch):
    """A square that is stretched in another space: the figure is found by the distances there."""
    mesh = patch.mesh
    coordinates = mesh.vertices * [3.0, 1.0, 0.0]
    random = np.random.default_rng(6)
    figure = random.uniform(0.2, 0.8, (10, 3)) * [1, 1, 0]
    start = nearest_vertices(mesh, figure + random.uniform(-0.1, 0.1, (10, 3)) * [1, 1, 0])
    wanted = pairwise(figure * [3.0, 1.0, 0.0])
    metric = EmbeddedDistances(mesh, coordinates)
    settled = run(settle_steps(metric, start, Stress(wanted), tolerance=1e-6, max_sweeps=100))
    np.testing.assert_allclose(pairwise(settled.points.positions * [3.0, 1.0, 0.0]), wanted, atol=2e-3)


def test_between_vertices_it_comes_closer_than_at_them():
    """Points of a body, wanted at their places in another meshing of it, from the nearest vertices."""
    vertices_x, triangles_x, _ = creature(0.0, 12)
    mesh_x = TriangleMesh(vertices_x, triangles_x)
    source, target = Shape(mesh_x), Shape(TriangleMesh(*creature(0.0, 9, turn=0.8)[:2]))
    run(source.sample_steps(24))
    samples = source.samples.vertices
    start = nearest_vertices(target.mesh, source.mesh.vertices[samples])
    steps = settle_steps(SurfaceDistances(target), start, Stress(source.samples.distances))
    settled = run(steps)
    before, after = (
        np.linalg.norm(points.positions - source.mesh.vertices[samples], axis=1) for points in (start, settled.points)
    )
    assert settled.stress < 0.3 * settled.start
    assert after.mean() < 0.7 * before.mean()


def test_triangles_without_area_are_crossed():
    """A square with a seam of zero-area triangles, some of them shrunk to a point."""
    vertices, triangles = plane(12, jitter=0.3, seed=4)
    left = vertices[triangles].mean(axis=1)[:, 0] < 0.5
    shared = np.intersect1d(triangles[left], triangles[~left])
    copies = np.arange(len(vertices))
    copies[shared] = len(vertices) + np.arange(len(shared))
    cut = np.where(left[:, None], triangles, copies[triangles])
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    of_left = sides[np.repeat(left, 3)]
    seam = of_left[(of_left[:, None] == sides[np.repeat(~left, 3)]).all(axis=2).any(axis=1)]
    a, b = seam.T
    strip = np.concatenate([np.stack([a, b, copies[a]], axis=1), np.stack([b, copies[b], copies[a]], axis=1)])
    spike = len(vertices) + len(shared) + np.arange(2)
    mesh = TriangleMesh(
        np.concatenate([vertices, vertices[shared], vertices[[shared[0]] * 2]]),
        np.concatenate([cut, strip, [[shared[0], *spike]]]),
    )
    shape = Shape(mesh)
    figure = np.array([[0.2, 0.2, 0], [0.8, 0.3, 0], [0.7, 0.8, 0], [0.3, 0.7, 0]])
    start = nearest_vertices(shape.mesh, figure - [0.15, 0, 0])
    held = 10 * np.linalg.norm(shape.mesh.vertices - figure[:, None], axis=2)
    settled = run(settle_steps(SurfaceDistances(shape), start, Stress(pairwise(figure), held), max_sweeps=60))
    assert np.linalg.norm(settled.points.positions - figure, axis=1).max() < 0.06
    assert np.isfinite(settled.points.barycentric).all()


def test_it_reports_progress_and_repeats_itself(patch):
    random = np.random.default_rng(7)
    wanted = pairwise(random.uniform(0, 1, (8, 2)))
    start = SurfacePoints.at_vertices(patch.mesh, np.arange(0, 320, 40))
    reports, result = followed(settle_steps(SurfaceDistances(patch), start, Stress(wanted)))
    again = run(settle_steps(SurfaceDistances(patch), start, Stress(wanted)))
    assert all(isinstance(report, Progress) and 0 <= report.fraction <= 1 for report in reports)
    np.testing.assert_array_equal(result.points.barycentric, again.points.barycentric)
    assert result.stress == again.stress
