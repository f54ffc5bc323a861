# SPDX-License-Identifier: GPL-3.0-or-later
"""Closest points on surfaces: against all triangles, and along the surface."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from engine import MeshError, SurfacePoints, TriangleMesh
from engine.mesh import closest_points
from engine.mesh.closest_points import ClosestPoints, closest_in_triangles
from tests.shapes import cylinder, icosphere, plane, rotation, subdivided, torus


def assert_closest(points, corners, barycentric, squared_distances, tolerance):
    """Closest in a convex set: the way to no other of its points leads back towards the point."""
    size = np.abs(corners - points[:, None]).max(initial=1e-300)
    assert (barycentric >= 0).all()
    np.testing.assert_allclose(barycentric.sum(axis=1), 1)
    closest = np.einsum("kc,kcd->kd", barycentric, corners)
    np.testing.assert_allclose(
        ((points - closest) ** 2).sum(axis=1), squared_distances, rtol=1e-9, atol=(1e-12 * size) ** 2
    )
    back = np.einsum("kd,kcd->kc", points - closest, corners - closest[:, None])
    assert back.max(initial=0) <= tolerance * size**2


def all_squared_distances(points, mesh):
    """Squared distance from each point to each triangle, (k, m)."""
    k, m = len(points), mesh.triangle_count
    corners = np.tile(mesh.vertices[mesh.triangles], (k, 1, 1))
    squared = closest_in_triangles(np.repeat(points, m, axis=0), *corners.transpose(1, 0, 2))[1]
    return squared.reshape(k, m)


def positions(found, mesh):
    return found.on(mesh).positions


def around(mesh, count, distance, seed=0):
    """Points at a random distance from a mesh, and the triangles from which they set out."""
    random = np.random.default_rng(seed)
    triangles = random.integers(0, mesh.triangle_count, count)
    points = SurfacePoints.from_barycentric(mesh, triangles, random.dirichlet([1, 1, 1], count)).positions
    return points + distance * random.normal(size=points.shape), triangles


@pytest.fixture(scope="module")
def star():
    """A creased, closed surface of triangles of many sizes: a sphere with random radii."""
    vertices, triangles = icosphere(5)
    return TriangleMesh(vertices * np.random.default_rng(1).uniform(0.6, 1.4, (len(vertices), 1)), triangles)


# --- one triangle each


@given(arrays(float, (4, 3), elements=st.integers(-3, 3)))
def test_closest_in_triangles_of_small_integers(points):
    # Many of these have fallen together into a line or a point.
    point, corners = points[:1], points[None, 1:]
    assert_closest(point, corners, *closest_in_triangles(point, *points[1:, None]), tolerance=1e-13)


@pytest.mark.parametrize("scale", [1e-30, 1.0, 1e30])
def test_closest_in_random_triangles(scale):
    points, *corners = scale * np.random.default_rng(0).normal(size=(4, 5000, 3))
    result = closest_in_triangles(points, *corners)
    assert_closest(points, np.stack(corners, axis=1), *result, tolerance=1e-13)


@pytest.mark.parametrize("width", [1e-3, 1e-6, 1e-9, 1e-12, 1e-16, 0.0])
def test_closest_in_needles(width):
    random = np.random.default_rng(0)
    points, a, b, side = random.normal(size=(4, 2000, 3))
    c = a + random.uniform(-0.5, 1.5, (2000, 1)) * (b - a) + width * side
    corners = np.stack([a, b, c], axis=1)
    for order in ([0, 1, 2], [1, 2, 0], [2, 1, 0]):
        turned = corners[:, order]
        assert_closest(points, turned, *closest_in_triangles(points, *turned.transpose(1, 0, 2)), tolerance=1e-13)


@pytest.mark.parametrize("scale", [1.0, 1e12])
def test_triangles_whose_corners_nearly_coincide_are_edges(scale):
    points, a, b = scale * np.random.default_rng(0).normal(size=(3, 500, 3))
    with np.errstate(all="raise", under="ignore"):
        result = closest_in_triangles(points, a, b, np.nextafter(b, a))
    assert_closest(points, np.stack([a, b, b], axis=1), *result, tolerance=1e-13)


def test_points_of_the_triangles_are_their_own_closest_points():
    random = np.random.default_rng(0)
    corners = random.normal(size=(500, 3, 3))
    weights = random.dirichlet([0.3, 0.3, 0.3], 500)
    points = np.einsum("kc,kcd->kd", weights, corners)
    barycentric, squared_distances = closest_in_triangles(points, *corners.transpose(1, 0, 2))
    np.testing.assert_allclose(np.einsum("kc,kcd->kd", barycentric, corners), points, atol=1e-7)
    assert squared_distances.max() < 1e-14


# --- the whole surface


def test_nearest_on_a_plane_is_the_projection():
    mesh = TriangleMesh(*plane(12, jitter=0.4))
    points = np.random.default_rng(0).uniform([-0.5, -0.5, -0.3], [1.5, 1.5, 0.3], (500, 3))
    found = ClosestPoints(mesh).nearest(points)
    expected = np.column_stack([points[:, :2].clip(0, 1), np.zeros(500)])
    np.testing.assert_allclose(positions(found, mesh), expected, atol=1e-12)
    np.testing.assert_allclose(found.squared_distances, ((points - expected) ** 2).sum(axis=1), atol=1e-14)


@pytest.mark.parametrize("shape", [icosphere(6), torus(24, 12), cylinder(20, 8)])
def test_nearest_on_smooth_surfaces_is_the_closest_of_all(shape):
    mesh = TriangleMesh(*shape)
    points, _ = around(mesh, 300, 0.1)
    found = ClosestPoints(mesh).nearest(points)
    np.testing.assert_allclose(found.squared_distances, all_squared_distances(points, mesh).min(axis=1), atol=1e-14)


def test_nearest_on_a_creased_surface_is_almost_always_the_closest_of_all(star):
    points, _ = around(star, 500, 0.1)
    found = ClosestPoints(star).nearest(points)
    least = all_squared_distances(points, star).min(axis=1)
    assert (found.squared_distances >= least - 1e-14).all()
    missed = found.squared_distances > least + 1e-12
    assert missed.mean() < 0.05
    assert (np.sqrt(found.squared_distances[missed]) - np.sqrt(least[missed]) < star.edge_lengths.max() / 2).all()


@pytest.mark.parametrize("weight", [0.0, 0.3])
def test_nearest_of_few_points_is_the_closest_of_all_triangles(star, weight):
    points, triangles = around(star, 20, 0.1)
    normals = star.triangle_normals[triangles]
    assert len(points) * star.triangle_count <= 15_000  # all are tried
    found = ClosestPoints(star).nearest(points, normals, normal_weight=weight, normal_gate=0.5)
    costs = all_squared_distances(points, star)
    costs += weight * np.maximum(0.5 - normals @ star.triangle_normals.T, 0)
    taken = costs[np.arange(len(points)), found.triangles]
    np.testing.assert_allclose(taken, costs.min(axis=1), atol=1e-12)
    squared = np.square(points - positions(found, star)).sum(axis=1)
    np.testing.assert_allclose(found.squared_distances, squared, atol=1e-12)


def test_nearest_of_few_points_far_from_the_origin(star):
    away = TriangleMesh(star.vertices + 1e5, star.triangles)
    points, _ = around(star, 20, 0.1)
    here, there = ClosestPoints(star).nearest(points), ClosestPoints(away).nearest(points + 1e5)
    np.testing.assert_allclose(there.squared_distances, here.squared_distances, atol=1e-9)


def test_nearest_vertices(star):
    points, _ = around(star, 300, 0.2)
    expected = np.linalg.norm(points[:, None] - star.vertices, axis=2).argmin(axis=1)
    np.testing.assert_array_equal(ClosestPoints(star).nearest_vertices(points), expected)


def test_vertices_can_be_named_as_what_was_found(star):
    points, search = around(star, 200, 0.1)[0], ClosestPoints(star)
    vertices = search.nearest_vertices(points)
    found = search.at_vertices(points, vertices)
    np.testing.assert_allclose(positions(found, star), star.vertices[vertices])
    np.testing.assert_allclose(found.squared_distances, ((points - star.vertices[vertices]) ** 2).sum(axis=1))


def test_what_was_found_can_be_named_as_points_of_the_mesh(star):
    points, _ = around(star, 200, 0.1)
    found = ClosestPoints(star).nearest(points)
    on_mesh = found.on(star)
    np.testing.assert_allclose(np.square(on_mesh.positions - points).sum(axis=1), found.squared_distances, atol=1e-12)
    np.testing.assert_array_equal(on_mesh.nearest_vertices, found.nearest_vertices(star.triangles))


def test_nearest_vertices_with_normals(star):
    random = np.random.default_rng(0)
    points, triangles = around(star, 300, 0.2)
    normals = star.triangle_normals[triangles]
    length = random.uniform(0.1, 1)
    squared = ((points[:, None] - star.vertices) ** 2).sum(axis=2)
    squared += length**2 * ((normals[:, None] - star.vertex_normals) ** 2).sum(axis=2)
    found = ClosestPoints(star).nearest_vertices(points, normals, length)
    np.testing.assert_array_equal(found, squared.argmin(axis=1))
    np.testing.assert_array_equal(
        ClosestPoints(star).nearest_vertices(points, normals, 0.0), ClosestPoints(star).nearest_vertices(points)
    )


def test_normals_tell_the_sides_of_a_thin_body_apart():
    vertices, triangles = icosphere(8)
    mesh = TriangleMesh(vertices * [1, 1, 0.02], triangles)
    random = np.random.default_rng(0)
    # Below the middle, nearer to the lower side, but looking up.
    points = np.column_stack([random.uniform(-0.5, 0.5, (200, 2)), np.full(200, -0.005)])
    up = np.tile([0.0, 0.0, 1.0], (200, 1))
    search = ClosestPoints(mesh)
    assert (positions(search.nearest(points), mesh)[:, 2] < 0).all()
    found = search.nearest(points, up, normal_length=0.1, normal_weight=0.01)
    assert (positions(found, mesh)[:, 2] > 0).all()


# --- along the surface


def test_a_walk_ends_in_a_minimum(star):
    points, _ = around(star, 300, 0.1)
    starts = np.random.default_rng(0).integers(0, star.vertex_count, 300)
    found = ClosestPoints(star).walk(points, starts)
    squared = all_squared_distances(points, star)
    rows = np.arange(300)
    np.testing.assert_allclose(found.squared_distances, squared[rows, found.triangles], atol=1e-14)
    touching = (star.triangles[:, None, :, None] == star.triangles[None, :, None, :]).any(axis=(2, 3))
    least = np.where(touching[found.triangles], squared, np.inf).min(axis=1)
    np.testing.assert_allclose(found.squared_distances, least, atol=1e-14)


def test_a_walk_with_normals_ends_in_a_minimum_of_the_cost(star):
    points, triangles = around(star, 300, 0.1)
    normals = -star.triangle_normals[np.random.default_rng(0).permutation(triangles)]
    found = ClosestPoints(star).walk(points, star.triangles[triangles, 0], normals, normal_weight=0.3, normal_gate=0.2)
    squared = all_squared_distances(points, star)
    cost = squared + 0.3 * np.maximum(0.2 - normals @ star.triangle_normals.T, 0)
    rows = np.arange(300)
    np.testing.assert_allclose(found.squared_distances, squared[rows, found.triangles], atol=1e-14)
    touching = (star.triangles[:, None, :, None] == star.triangles[None, :, None, :]).any(axis=(2, 3))
    least = np.where(touching[found.triangles], cost, np.inf).min(axis=1)
    np.testing.assert_allclose(cost[rows, found.triangles], least, atol=1e-13)


def test_normals_that_agree_change_nothing():
    mesh = TriangleMesh(*icosphere(6))
    points, triangles = around(mesh, 200, 0.02)
    search, starts = ClosestPoints(mesh), mesh.triangles[triangles, 0]
    plain = search.walk(points, starts)
    weighed = search.walk(points, starts, mesh.triangle_normals[triangles], normal_weight=100.0)
    np.testing.assert_array_equal(plain.triangles, weighed.triangles)
    np.testing.assert_array_equal(plain.barycentric, weighed.barycentric)


def test_a_walk_crosses_a_convex_surface():
    mesh = TriangleMesh(*icosphere(8))
    points, _ = around(mesh, 200, 0.02)
    starts = np.random.default_rng(1).integers(0, mesh.vertex_count, 200)
    least = all_squared_distances(points, mesh).min(axis=1)
    np.testing.assert_allclose(ClosestPoints(mesh).walk(points, starts).squared_distances, least, atol=1e-14)


def test_a_walk_never_jumps_to_another_sheet():
    vertices, triangles = plane(10)
    above = vertices + np.array([0, 0, 0.01])
    mesh = TriangleMesh(np.concatenate([vertices, above]), np.concatenate([triangles, triangles + len(vertices)]))
    random = np.random.default_rng(0)
    points = np.column_stack([random.uniform(0, 1, (100, 2)), np.full(100, 0.009)])
    search = ClosestPoints(mesh)
    np.testing.assert_allclose(positions(search.nearest(points), mesh)[:, 2], 0.01)
    found = search.walk(points, random.integers(0, len(vertices), 100))
    np.testing.assert_allclose(positions(found, mesh), points * [1, 1, 0], atol=1e-12)


def test_a_further_start_is_followed_where_it_is_better(star):
    points, _ = around(star, 200, 0.05)
    search = ClosestPoints(star)
    anywhere = np.random.default_rng(0).integers(0, star.vertex_count, 200)
    near = search.nearest_vertices(points)
    first, second = (search.walk(points, starts).squared_distances for starts in (anywhere, near))
    for starts in ((anywhere, near), (near, anywhere)):
        both = search.walk(points, np.stack(starts, axis=1)).squared_distances
        assert (both <= search.walk(points, starts[0]).squared_distances).all()
    both = search.walk(points, np.stack([anywhere, near], axis=1)).squared_distances
    np.testing.assert_allclose(both.mean(), np.minimum(first, second).mean(), rtol=0.02)


def test_a_walk_far_from_the_origin_is_the_same(star):
    points = star.vertices[::3] + 0.05
    starts = np.arange(star.vertex_count)[::3]
    near = ClosestPoints(star).walk(points, starts)
    far = ClosestPoints(star).moved(star.vertices + 1e6).walk(points + 1e6, starts)
    np.testing.assert_array_equal(far.triangles, near.triangles)
    np.testing.assert_allclose(far.barycentric, near.barycentric, atol=1e-7)


def test_a_walk_over_needles_finds_the_closest_of_all():
    """A strip of triangles that are a hundred thousand times as long as they are wide."""
    count = 12
    along = np.linspace(0, 1, count)
    vertices = np.concatenate([np.stack([along, np.full(count, y), np.zeros(count)], axis=1) for y in (0, 1e-6)])
    first = np.arange(count - 1)
    triangles = np.concatenate(
        [
            np.stack([first, first + 1, first + count], axis=1),
            np.stack([first + 1, first + count + 1, first + count], axis=1),
        ]
    )
    rng = np.random.default_rng(0)
    points = np.stack([rng.uniform(0, 1, 200), rng.uniform(-1e-6, 2e-6, 200), rng.uniform(-0.1, 0.1, 200)], axis=1)
    search = ClosestPoints(TriangleMesh(vertices, triangles))
    found = search.walk(points, search.nearest_vertices(points))
    exact = points * [1, 1, 0]
    exact[:, 1] = np.clip(exact[:, 1], 0, 1e-6)
    np.testing.assert_allclose(found.interpolate(search.triangles, vertices), exact, atol=1e-12)


def test_steps_limit_a_walk():
    mesh = TriangleMesh(*plane(20))
    found = ClosestPoints(mesh).walk(np.array([[1.0, 1.0, 0.0]]), np.array([0]), steps=1)
    assert 0 in mesh.triangles[found.triangles[0]]


# --- invariance, sharing, blocks


def test_order_of_vertices_and_triangles_does_not_matter(star):
    random = np.random.default_rng(3)
    new = random.permutation(star.vertex_count)
    vertices = np.empty_like(star.vertices)
    vertices[new] = star.vertices
    turned = np.take_along_axis(
        new[star.triangles], (np.arange(3) + random.integers(0, 3, (star.triangle_count, 1))) % 3, axis=1
    )
    other = TriangleMesh(vertices, turned[random.permutation(len(turned))])
    points, _ = around(star, 300, 0.1)
    first, second = ClosestPoints(star).nearest(points), ClosestPoints(other).nearest(points)
    np.testing.assert_allclose(first.squared_distances, second.squared_distances, atol=1e-14)
    np.testing.assert_allclose(positions(first, star), positions(second, other), atol=1e-10)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_motion_and_scale_do_not_matter(star, scale):
    turn, shift = rotation([1.0, 2.0, -1.0], 0.8), np.array([0.5, -2.0, 1.0])
    points, triangles = around(star, 300, 0.1)
    normals = star.triangle_normals[triangles]
    other = TriangleMesh(scale * (star.vertices @ turn.T + shift), star.triangles)
    first = ClosestPoints(star).nearest(points, normals, normal_length=0.1, normal_weight=0.02)
    second = ClosestPoints(other).nearest(
        scale * (points @ turn.T + shift),
        normals @ turn.T,
        normal_length=0.1 * scale,
        normal_weight=0.02 * scale**2,
    )
    expected = scale * (positions(first, star) @ turn.T + shift)
    np.testing.assert_allclose(positions(second, other), expected, atol=1e-10 * scale)


def test_a_moved_search_equals_a_new_one(star):
    vertices = star.vertices * [1.0, 2.0, 0.5]
    points, triangles = around(star, 100, 0.2)
    normals = star.triangle_normals[triangles]
    search = ClosestPoints(star)
    search.nearest(points)
    moved, new = search.moved(vertices), ClosestPoints(TriangleMesh(vertices, star.triangles))
    np.testing.assert_allclose(moved.vertex_normals, TriangleMesh(vertices, star.triangles).vertex_normals, atol=1e-12)
    for arguments in ((points,), (points, normals)):
        first = moved.nearest(*arguments, normal_length=0.2, normal_weight=0.1)
        second = new.nearest(*arguments, normal_length=0.2, normal_weight=0.1)
        np.testing.assert_array_equal(first.triangles, second.triangles)
        np.testing.assert_array_equal(first.barycentric, second.barycentric)
    assert np.array_equal(search.vertices, star.vertices)


def test_blocks_and_chunks_change_nothing(star, monkeypatch):
    points, triangles = around(star, 100, 0.2)
    normals = star.triangle_normals[triangles]
    options = {"normal_length": 0.1, "normal_weight": 0.1}
    whole = ClosestPoints(star).nearest(points, normals, **options)
    for name, size in (("_BLOCK", 31), ("_CHUNK", 7), ("_TREE_CHUNK", 13), ("_MANY", 1)):
        monkeypatch.setattr(closest_points, name, size)
    parts = ClosestPoints(star).nearest(points, normals, **options)
    np.testing.assert_array_equal(whole.triangles, parts.triangles)
    np.testing.assert_array_equal(whole.barycentric, parts.barycentric)
    np.testing.assert_array_equal(whole.squared_distances, parts.squared_distances)


# --- odd meshes and wrong arguments


def test_a_single_triangle_and_no_points():
    mesh = TriangleMesh(np.eye(3), [[0, 1, 2]])
    found = ClosestPoints(mesh).nearest(np.array([[1.0, 1.0, 1.0], [5.0, 0.0, 0.0]]))
    np.testing.assert_allclose(found.barycentric, [[1 / 3, 1 / 3, 1 / 3], [1, 0, 0]], atol=1e-14)
    assert len(ClosestPoints(mesh).nearest(np.empty((0, 3)))) == 0


def test_triangles_without_area_and_edges_of_many_triangles():
    vertices, triangles = subdivided(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]), 3)
    flat = np.stack([np.zeros(5, int), np.arange(1, 6), np.arange(2, 7)], axis=1)
    mesh = TriangleMesh(
        np.concatenate([vertices, np.zeros((2, 3))]), np.concatenate([triangles, flat, [[0, len(vertices), 1]]])
    )
    points = np.random.default_rng(0).normal(size=(200, 3))
    found = ClosestPoints(mesh).nearest(points, points, normal_length=0.1)
    assert np.isfinite(found.barycentric).all()
    plain = ClosestPoints(mesh).nearest(points)
    np.testing.assert_allclose(plain.squared_distances, all_squared_distances(points, mesh).min(axis=1), atol=1e-14)


def test_loose_vertices_are_never_found():
    vertices, triangles = plane(4)
    mesh = TriangleMesh(np.concatenate([[[0.5, 0.5, 1.0]], vertices]), triangles + 1)
    search = ClosestPoints(mesh)
    point = np.array([[0.5, 0.5, 0.9]])
    assert search.nearest_vertices(point) > 0
    np.testing.assert_allclose(search.nearest(point).squared_distances, 0.81)
    with pytest.raises(MeshError, match="without a triangle"):
        search.walk(point, np.array([0]))


def test_moved_needs_as_many_positions(star):
    with pytest.raises(MeshError, match="positions of the shape"):
        ClosestPoints(star).moved(star.vertices[1:])


@pytest.mark.parametrize("points", [np.zeros(3), np.zeros((4, 2)), np.full((1, 3), np.nan), np.full((1, 3), np.inf)])
def test_points_and_normals_are_checked(star, points):
    search, good = ClosestPoints(star), np.zeros((len(points), 3))
    for arguments in ((points,), (good, points)):
        with pytest.raises(MeshError, match="to search with"):
            search.nearest(*arguments)
        with pytest.raises(MeshError, match="to search with"):
            search.walk(arguments[0], np.zeros(len(points), int), *arguments[1:])


def test_there_is_a_normal_for_each_point_and_a_search_starts_at_a_vertex(star):
    search, points = ClosestPoints(star), star.vertices[:2] * 1.1
    starts = np.zeros(2, int)
    for searched in (
        search.nearest,
        search.nearest_vertices,
        lambda points, normals: search.walk(points, starts, normals),
    ):
        with pytest.raises(MeshError, match="1 normals to search with for 2 points"):
            searched(points, star.vertex_normals[:1])
    for vertex in (-5, star.vertex_count):
        with pytest.raises(MeshError, match="at a vertex without a triangle"):
            search.walk(points, starts + vertex)


def test_what_is_forgotten_is_found_again(star):
    search = ClosestPoints(star)
    points, normals = star.vertices + 0.01, star.vertex_normals
    before = search.nearest(points, normals, normal_length=0.1, normal_weight=0.01, normal_gate=0.5)
    search.forget()
    after = search.nearest(points, normals, normal_length=0.1, normal_weight=0.01, normal_gate=0.5)
    np.testing.assert_array_equal(after.triangles, before.triangles)
    np.testing.assert_array_equal(after.barycentric, before.barycentric)
