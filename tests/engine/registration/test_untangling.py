# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of maps."""

import numpy as np

from engine import SurfaceMap, SurfacePoints, TriangleMesh
from engine.mesh.closest_points import ClosestPoints
from engine.registration.untangling import flipped_triangles, follow_neighbours, untangle_steps
from engine.runtime.progress import run
from tests.shapes import icosphere, permuted, plane


def test_values_come_from_the_nearest_neighbour_in_order():
    # A row of squares: values are handed on from one end to the other.
    mesh = TriangleMesh(*plane(12))
    values = np.arange(mesh.vertex_count)
    astray = mesh.vertices[:, 0] > 0
    new = follow_neighbours(mesh, values, astray)
    assert (mesh.vertices[new, 0] == 0).all()
    assert (abs(mesh.vertices[new, 1] - mesh.vertices[:, 1]) <= mesh.vertices[:, 0] + 1e-9).all()
    np.testing.assert_array_equal(values, np.arange(mesh.vertex_count))
    one = np.arange(mesh.vertex_count) == 50
    step = mesh.vertices[follow_neighbours(mesh, values, one)[50]] - mesh.vertices[50]
    assert np.linalg.norm(step) < 1.01 / 11  # along a side of a square, not its diagonal


def test_without_a_neighbour_in_order_values_stay():
    mesh = TriangleMesh(*icosphere(2))
    values = np.arange(mesh.vertex_count)
    everywhere = np.ones(mesh.vertex_count, bool)
    np.testing.assert_array_equal(follow_neighbours(mesh, values, everywhere), values)
    np.testing.assert_array_equal(follow_neighbours(mesh, values, ~everywhere), values)


def test_flipped_triangles_are_those_turned_over():
    mesh = TriangleMesh(*plane(10))
    points = SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count))
    assert len(flipped_triangles(mesh, mesh, points.triangles, points.barycentric)) == 0
    mirrored = TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1])
    everything = flipped_triangles(mirrored, mesh, points.triangles, points.barycentric)
    np.testing.assert_array_equal(everything, np.arange(mesh.triangle_count))
    some = np.array([3, 8, 100])
    np.testing.assert_array_equal(flipped_triangles(mirrored, mesh, points.triangles, points.barycentric, some), some)


def mapped_sphere():
    """A sphere in two meshes, the search on the second, and where it has the vertices of the first."""
    source = TriangleMesh(*icosphere(16))
    target = TriangleMesh(*permuted(*icosphere(13))[:2])
    search = ClosestPoints(target)
    return source, target, search, search.nearest(source.vertices)


def test_a_knot_is_untied_and_the_rest_left_alone():
    source, target, search, found = mapped_sphere()
    random = np.random.default_rng(0)
    # A few vertices exchanged with others near by.
    near = np.flatnonzero(np.linalg.norm(source.vertices - source.vertices[700], axis=1) < 0.3)
    moved = random.permutation(near)
    triangles, barycentric = found.triangles.copy(), found.barycentric.copy()
    triangles[near], barycentric[near] = triangles[moved], barycentric[moved]
    before = flipped_triangles(source, target, triangles, barycentric)
    assert len(before) > 20
    run(untangle_steps(source, target, triangles, barycentric, search=search))
    assert len(flipped_triangles(source, target, triangles, barycentric)) == 0
    far = np.linalg.norm(source.vertices - source.vertices[700], axis=1) > 0.8
    np.testing.assert_array_equal(triangles[far], found.triangles[far])
    np.testing.assert_array_equal(barycentric[far], found.barycentric[far])
    reached = SurfacePoints.from_barycentric(target, triangles, barycentric).positions
    assert np.linalg.norm(reached - source.vertices, axis=1).max() < 0.3


def test_thousands_of_knots_are_untied_as_few_are():
    mesh = TriangleMesh(*icosphere(48))
    random = np.random.default_rng(0)
    edges = mesh.edges[random.choice(len(mesh.edges), 3000, replace=False)]
    images = np.arange(mesh.vertex_count)
    images[edges] = images[edges[:, ::-1]]  # neighbours exchanged
    points = SurfacePoints.at_vertices(mesh, images)
    triangles, barycentric = points.triangles.copy(), points.barycentric.copy()
    assert len(flipped_triangles(mesh, mesh, triangles, barycentric)) > 5000
    run(untangle_steps(mesh, mesh, triangles, barycentric, search=ClosestPoints(mesh)))
    assert len(flipped_triangles(mesh, mesh, triangles, barycentric)) == 0
    reached = SurfacePoints.from_barycentric(mesh, triangles, barycentric).positions
    assert np.abs(reached - mesh.vertices).max() < 2 * mesh.edge_lengths.max()


def test_only_triangles_that_count_are_untied():
    source, target, search, found = mapped_sphere()
    random = np.random.default_rng(0)
    triangles, barycentric = found.triangles.copy(), found.barycentric.copy()
    for end in (1, -1):  # two knots, of which one counts
        near = np.flatnonzero(np.linalg.norm(source.vertices - end * source.vertices[700], axis=1) < 0.3)
        moved = random.permutation(near)
        triangles[near], barycentric[near] = triangles[moved], barycentric[moved]
    before = flipped_triangles(source, target, triangles, barycentric)
    shown = source.vertices @ source.vertices[700] > 0
    run(untangle_steps(source, target, triangles, barycentric, search=search, shown=shown))
    after = flipped_triangles(source, target, triangles, barycentric)
    counted = shown[source.triangles].any(axis=1)
    assert min(counted[before].sum(), (~counted[before]).sum()) > 20
    np.testing.assert_array_equal(after, before[~counted[before]])


def test_a_map_in_order_is_not_touched():
    source, target = TriangleMesh(*icosphere(9)), TriangleMesh(*icosphere(12))
    search = ClosestPoints(target)
    found = search.nearest(source.vertices)
    triangles, barycentric = found.triangles.copy(), found.barycentric.copy()
    run(untangle_steps(source, target, triangles, barycentric, search=search))
    np.testing.assert_array_equal(triangles, found.triangles)
    np.testing.assert_array_equal(barycentric, found.barycentric)


def test_what_is_untied_is_what_the_map_calls_flipped():
    """The very faces, whose areas the map adds up, and none smaller than it was meant to be is left flat."""
    source, target = TriangleMesh(*icosphere(12)), TriangleMesh(*icosphere(9))
    found = ClosestPoints(target).nearest(source.vertices)
    triangles, barycentric = found.triangles.copy(), found.barycentric.copy()
    ring = source.triangles[(source.triangles == 400).any(axis=1)]
    other = ring[ring != 400][0]
    triangles[[400, other]], barycentric[[400, other]] = triangles[[other, 400]], barycentric[[other, 400]]
    folded = SurfaceMap.from_barycentric(target, triangles, barycentric)
    flipped = np.flatnonzero(folded.face_orientations(source, target) < 0)
    assert len(flipped)
    np.testing.assert_array_equal(flipped_triangles(source, target, triangles, barycentric), flipped)
    run(untangle_steps(source, target, triangles, barycentric, search=ClosestPoints(target)))
    mended = SurfaceMap.from_barycentric(target, triangles, barycentric)
    assert mended.flipped_faces(source, target) == 0
    a, b, c = mended.positions[source.triangles[flipped]].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    assert (areas > 0.1 * source.triangle_areas[flipped]).all()


def test_vertices_move_along_the_surface_only():
    mesh = TriangleMesh(*plane(12))
    points = SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count))
    triangles, barycentric = points.triangles.copy(), points.barycentric.copy()
    triangles[65], barycentric[65] = triangles[67], barycentric[67]
    assert len(flipped_triangles(mesh, mesh, triangles, barycentric))
    run(untangle_steps(mesh, mesh, triangles, barycentric, search=ClosestPoints(mesh)))
    assert len(flipped_triangles(mesh, mesh, triangles, barycentric)) == 0
    offsets = SurfacePoints.from_barycentric(mesh, triangles, barycentric).positions - mesh.vertices
    np.testing.assert_allclose(offsets[:, 2], 0, atol=1e-12)
    far = np.linalg.norm(mesh.vertices - mesh.vertices[66], axis=1) > 5 / 11
    np.testing.assert_allclose(offsets[far], 0, atol=1e-12)
