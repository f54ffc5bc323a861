# SPDX-License-Identifier: GPL-3.0-or-later
"""The way from the clean parts of a mesh back to it."""

import numpy as np
import pytest

from engine import SurfacePoints, TriangleMesh
from engine.mesh.closest_points import ClosestPoints
from engine.mesh.reflection import reflected_mesh
from engine.repair.clean_surface import StandIn
from engine.repair.cleaning import clean
from tests.messes import cut_along_seam, partly_turned, together, without_disc
from tests.shapes import icosphere


def some_points(mesh, count=300, seed=0):
    """Triangles and barycentric coordinates of random points."""
    rng = np.random.default_rng(seed)
    return rng.integers(0, mesh.triangle_count, count), rng.dirichlet([1.0, 1.0, 1.0], count)


def places(mesh, triangles, barycentric):
    return SurfacePoints.from_barycentric(mesh, triangles, barycentric).positions


@pytest.fixture(scope="module")
def turned():
    return clean(TriangleMesh(*partly_turned(*icosphere(6))))


@pytest.fixture(scope="module")
def holed():
    vertices, triangles = icosphere(12)
    return clean(TriangleMesh(*without_disc(vertices, triangles, vertices[100], 0.15)))


def test_points_lie_where_they_lay_though_triangles_were_turned(turned):
    part, points = turned.main, some_points(turned.mesh)
    assert 0 < part.turned.sum() < len(part.turned)
    np.testing.assert_allclose(
        places(turned.original, *part.to_original(*points)), places(part.mesh, *points), atol=1e-12
    )


def test_points_in_a_filled_hole_go_to_the_nearest_point_beside_it(holed):
    part = holed.main
    filled = np.flatnonzero(part.original_triangles < 0)
    assert len(filled) > 3
    triangles = np.repeat(filled, 10)
    barycentric = some_points(part.mesh, len(triangles))[1]
    inside = places(part.mesh, triangles, barycentric)
    found = places(holed.original, *part.to_original(triangles, barycentric))
    nearest = ClosestPoints(holed.original).nearest(inside)
    truth = places(holed.original, nearest.triangles, nearest.barycentric)
    np.testing.assert_allclose(
        np.linalg.norm(found - inside, axis=1), np.linalg.norm(truth - inside, axis=1), atol=1e-9
    )


def test_points_beside_a_filled_hole_stay(holed):
    part = holed.main
    triangles, barycentric = some_points(part.mesh)
    kept = part.original_triangles[triangles] >= 0
    found = places(holed.original, *part.to_original(triangles, barycentric))
    np.testing.assert_allclose(found[kept], places(part.mesh, triangles, barycentric)[kept], atol=1e-12)


def test_what_is_asked_is_not_changed(holed):
    triangles, barycentric = some_points(holed.mesh)
    before = triangles.copy(), barycentric.copy()
    holed.main.to_original(triangles, barycentric)
    np.testing.assert_array_equal(triangles, before[0])
    np.testing.assert_array_equal(barycentric, before[1])


def test_a_reflected_part_leads_to_the_reflected_mesh(turned):
    triangles, barycentric = some_points(turned.mesh)
    mirrored = turned.main.reflected()
    found = mirrored.to_original(triangles, barycentric)
    np.testing.assert_allclose(
        places(reflected_mesh(turned.original), *found), places(mirrored.mesh, triangles, barycentric), atol=1e-12
    )
    here = places(turned.mesh, triangles, barycentric[:, [0, 2, 1]])
    np.testing.assert_allclose(places(mirrored.mesh, triangles, barycentric), here * [-1, 1, 1], atol=1e-12)


def test_the_copies_along_a_seam_have_one_image():
    vertices, triangles = icosphere(6)
    mesh = TriangleMesh(*cut_along_seam(vertices, triangles))
    surface = clean(mesh)
    found = SurfacePoints.from_barycentric(mesh, *some_points(mesh, surface.mesh.vertex_count))
    there, weights = surface.images_of(np.arange(mesh.vertex_count), found, mesh)
    images = places(mesh, there, weights)
    copies = np.arange(len(vertices), mesh.vertex_count)
    partners = np.linalg.norm(vertices - mesh.vertices[copies][:, None], axis=2).argmin(axis=1)
    assert len(copies) > 10
    np.testing.assert_array_equal(images[copies], images[partners])
    own = surface.main.original_vertices
    np.testing.assert_allclose(images[own], found.positions, atol=1e-12)


def test_other_parts_come_by_size():
    balls = [icosphere(4, radius) for radius in (0.2, 1.0, 0.4)]
    shifted = [
        (vertices + np.array([3 * number, 0, 0]), triangles) for number, (vertices, triangles) in enumerate(balls)
    ]
    surface = clean(TriangleMesh(*together(*shifted)))
    assert surface.mesh is surface.main.mesh is surface.pieces[0].mesh
    assert surface.mesh.area == pytest.approx(TriangleMesh(*balls[1]).area)
    assert [piece.mesh.area for piece in surface.pieces[1:]] == pytest.approx(
        [TriangleMesh(*balls[i]).area for i in (2, 0)]
    )
    count = len(balls[0][0])
    assert surface.vertex_parts.tolist() == [2] * count + [0] * count + [1] * count
    for vertex in range(3 * count):
        piece = surface.pieces[surface.vertex_parts[vertex]]
        np.testing.assert_array_equal(
            piece.mesh.vertices[surface.vertex_images[vertex]], surface.original.vertices[vertex]
        )


@pytest.fixture(scope="module")
def stand_in():
    """A ball around one whose triangles are turned here and there, shown the right way round."""
    around, shown = TriangleMesh(*icosphere(8, 1.1)), TriangleMesh(*icosphere(6))
    turned = np.random.default_rng(0).random(shown.triangle_count) < 0.3
    original = TriangleMesh(shown.vertices, np.where(turned[:, None], shown.triangles[:, [0, 2, 1]], shown.triangles))
    place = ClosestPoints(around).nearest(original.vertices)
    nothing = np.zeros(around.triangle_count, bool)
    standing = StandIn(
        around,
        np.zeros(around.vertex_count, np.int64),
        np.zeros(around.triangle_count, np.int64),
        nothing,
        place_triangles=place.triangles,
        place_barycentric=place.barycentric,
        shown=shown,
        shown_triangles=np.arange(shown.triangle_count),
        shown_turned=turned,
    )
    return standing, original


def test_points_of_a_stand_in_are_those_closest_on_the_mesh(stand_in):
    standing, original = stand_in
    points = some_points(standing.mesh)
    found, outside = places(original, *standing.to_original(*points)), places(standing.mesh, *points)
    nearest = ClosestPoints(original).nearest(outside)
    truth = places(original, nearest.triangles, nearest.barycentric)
    apart, least = (np.linalg.norm(place - outside, axis=1) for place in (found, truth))
    assert (apart >= least - 1e-12).all()
    # Normals of the facets differ a little, and count.
    assert (apart <= least + 0.01).all()


def test_places_on_a_stand_in_are_interpolated_by_a_map(stand_in):
    standing, original = stand_in
    vertices = np.array([3, 50, 200])
    on_it = standing.places(vertices).positions
    np.testing.assert_allclose(np.linalg.norm(on_it - original.vertices[vertices], axis=1), 0.1, atol=0.03)
    # Under the map of the stand-in to itself, each place is its own image.
    same = SurfacePoints.at_vertices(standing.mesh, np.arange(standing.mesh.vertex_count))
    triangles, barycentric = standing.images_of(
        vertices, standing.places(vertices).nearest_vertices, same, standing.mesh
    )
    np.testing.assert_allclose(places(standing.mesh, triangles, barycentric), on_it, atol=1e-9)


def test_a_reflected_stand_in_has_reflected_places(stand_in):
    standing, original = stand_in
    vertices = np.arange(original.vertex_count)
    mirrored = standing.reflected()
    expected = standing.places(vertices).positions * [-1, 1, 1]
    np.testing.assert_allclose(mirrored.places(vertices).positions, expected, atol=1e-12)
    triangles, barycentric = some_points(standing.mesh)
    here = places(original, *standing.to_original(triangles, barycentric))
    there = places(reflected_mesh(original), *mirrored.to_original(triangles, barycentric[:, [0, 2, 1]]))
    np.testing.assert_allclose(there, here * [-1, 1, 1], atol=1e-9)
