# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine import TriangleMesh
from engine.geometry.laplacian import laplace_beltrami
from engine.mesh.closest_points import ClosestPoints, facing
from engine.retarget.rig.posed_registration import PosedRegistration
from tests.shapes import creature, icosphere, plane


def test_of_two_sheets_the_one_that_looks_the_same_way_is_taken():
    vertices, triangles = plane(8)
    count = len(vertices)
    below = vertices - [0, 0, 0.004]
    sheets = TriangleMesh(np.concatenate([vertices, below]), np.concatenate([triangles, triangles[:, ::-1] + count]))
    search = ClosestPoints(sheets)
    points = np.array([[0.4, 0.4, 0.001], [0.6, 0.3, 0.001]])
    up, down = np.tile([0.0, 0.0, 1.0], (2, 1)), np.tile([0.0, 0.0, -1.0], (2, 1))
    for normals, height in ((up, 0.0), (down, -0.004)):
        found = facing(search, points, normals, 1.0)
        places = np.einsum("kc,kcd->kd", found.barycentric, sheets.vertices[sheets.triangles[found.triangles]])
        np.testing.assert_allclose(places[:, 2], height, atol=1e-12)


def test_a_body_that_lies_there_stays():
    vertices, triangles, _ = creature(0.5, 7)
    mesh = TriangleMesh(vertices, triangles)
    registration = PosedRegistration(mesh, laplace_beltrami(mesh), mesh)
    found = registration.matched(vertices)
    slid = registration.slid(vertices, vertices, found, 4e-4)
    np.testing.assert_allclose(slid, vertices, atol=1e-6 * np.sqrt(mesh.area))


@pytest.mark.parametrize("scale", [1.0, 300.0])
def test_it_comes_to_lie_on_the_surface_without_sliding_along_it(scale):
    source, target = TriangleMesh(*icosphere(8, 1.0)), TriangleMesh(*icosphere(9, 1.1 * scale))
    registration = PosedRegistration(source, laplace_beltrami(source), target)
    posed = scale * source.vertices
    positions, matches = posed, registration.matched(posed)
    for _ in range(4):
        positions = registration.slid(positions, posed, matches, 4e-4)
        matches = registration.matched(positions)
    radii = np.linalg.norm(positions, axis=1) / scale
    np.testing.assert_allclose(radii, 1.1, atol=0.01)
    along = np.einsum("nd,nd->n", positions, source.vertices) / np.linalg.norm(positions, axis=1)
    assert along.min() > np.cos(0.02)


def test_what_the_target_lacks_is_not_drawn_to_it():
    vertices, triangles = icosphere(8)
    whole = TriangleMesh(vertices, triangles)
    kept = triangles[vertices[triangles].mean(axis=1)[:, 2] < 0.6]
    used, numbers = np.unique(kept, return_inverse=True)
    part = TriangleMesh(vertices[used], numbers.reshape(-1, 3))
    registration = PosedRegistration(whole, laplace_beltrami(whole), part)
    positions = registration.slid(vertices, vertices, registration.matched(vertices), 4e-4)
    np.testing.assert_allclose(positions, vertices, atol=0.05)


def test_a_knob_that_does_not_look_for_the_target_keeps_its_shape():
    vertices, triangles = icosphere(12)
    knob = np.exp(-np.square(vertices - [0, 0, 1]).sum(axis=1) / 0.05)
    source, target = TriangleMesh(vertices * (1 + 0.3 * knob)[:, None], triangles), TriangleMesh(vertices, triangles)
    registration = PosedRegistration(source, laplace_beltrami(source), target)
    matches = registration.matched(source.vertices)
    usual, all_of_it, without_knob = (
        registration.slid(source.vertices, source.vertices, matches, 8e-5, seeking=seeking)[knob > 0.9]
        for seeking in (None, np.ones(len(knob)), 1 - knob)
    )
    np.testing.assert_array_equal(usual, all_of_it)
    heights = [np.linalg.norm(knobs, axis=1).mean() for knobs in (usual, without_knob)]
    assert heights[1] > heights[0] + 0.02
