# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine import TriangleMesh
from engine.mesh.closest_points import ClosestPoints, FoundPoints
from engine.retarget.rig.match_gate import Homes
from tests.shapes import plane


def two_plates(shift, resolution=20):
    """Two plates that look up, the second moved: a mesh, and which of them each vertex belongs to."""
    vertices, triangles = plane(resolution)
    count = len(vertices)
    mesh = TriangleMesh(np.concatenate([vertices, vertices + shift]), np.concatenate([triangles, triangles + count]))
    return mesh, np.repeat([0, 1], count)


@pytest.fixture
def pair():
    """Plates that are apart at rest and all but touch in the target, the search there, and the true matches."""
    body, plate = two_plates([3.0, 0, 0])
    target, _ = two_plates([0.03, 0.02, 1e-3])
    search = ClosestPoints(body).moved(target.vertices)
    truth = search.at_vertices(target.vertices, np.arange(body.vertex_count))
    return body, target, search, truth, plate


def plates_of(found, search, plate):
    return plate[search.triangles[found.triangles][:, 0]]


@pytest.mark.parametrize("way", ["on_body", "on_target"])
def test_of_surfaces_that_touch_each_point_keeps_to_its_own(pair, way):
    body, target, search, truth, plate = pair
    homes = Homes.of(body, target, truth)
    points = target.vertices - [0, 0, 5e-4 + 1e-6]  # the upper plate's are nearer to the lower one
    found = search.nearest(points)
    assert (plates_of(found, search, plate) != plate).sum() > len(plate) / 3
    kept = getattr(homes, way)(search, found, points)
    np.testing.assert_array_equal(plates_of(kept, search, plate), plate)
    assert np.sqrt(kept.squared_distances.max()) < 2e-3


def test_what_is_near_home_stays_as_it_was_found(pair):
    body, target, search, truth, plate = pair
    points = target.vertices + np.array([0.02, 0.01, 0])
    found = search.nearest(points)
    homes = Homes.of(body, target, truth)
    mine = plates_of(found, search, plate) == plate
    kept = homes.on_body(search, found, points)
    np.testing.assert_array_equal(kept.triangles[mine], found.triangles[mine])
    np.testing.assert_array_equal(kept.barycentric[mine], found.barycentric[mine])


def test_a_single_point_that_went_astray_finds_back(pair):
    body, target, search, truth, plate = pair
    lost = len(plate) // 4
    triangles, barycentric = truth.triangles.copy(), truth.barycentric.copy()
    other = lost + len(plate) // 2
    triangles[lost], barycentric[lost] = triangles[other], barycentric[other]
    homes = Homes.of(body, target, FoundPoints(triangles, barycentric, truth.squared_distances))
    kept = homes.on_body(search, truth, target.vertices)
    np.testing.assert_array_equal(plates_of(kept, search, plate), plate)
