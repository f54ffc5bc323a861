# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces brought to unit area, and the smoothed mean curvature of those where it is known."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.geometry.laplacian import laplace_beltrami
from engine.registration.deformable import DeformableSurface
from tests.shapes import creature, icosphere, permuted, plane, rotation

TIMES = np.array([1e-3, 3e-3])


def deformable(vertices, triangles):
    mesh = TriangleMesh(vertices, triangles)
    return DeformableSurface(mesh, laplace_beltrami(mesh))


@pytest.fixture(scope="module")
def body():
    vertices, triangles, _ = creature(0.6, 9)
    return vertices, triangles, deformable(vertices, triangles)


def test_a_surface_has_unit_area_around_the_origin(body):
    unit = body[2]
    mesh = TriangleMesh(unit.vertices, unit.triangles)
    assert mesh.area == pytest.approx(1)
    np.testing.assert_allclose(mesh.vertex_areas @ unit.vertices, 0, atol=1e-12)
    assert unit.mass.sum() == pytest.approx(1)
    np.testing.assert_allclose(unit.normals, mesh.vertex_normals, atol=1e-9)


def test_coordinates_go_there_and_back(body):
    vertices, _, unit = body
    np.testing.assert_allclose(unit.in_unit_size(vertices), unit.vertices, atol=1e-12)
    np.testing.assert_allclose(unit.in_its_units(unit.vertices), vertices, atol=1e-12)
    anywhere = np.random.default_rng(0).normal(size=(50, 3))
    np.testing.assert_allclose(unit.in_unit_size(unit.in_its_units(anywhere)), anywhere, atol=1e-12)


def test_the_unit_surface_does_not_depend_on_place_or_size(body):
    vertices, triangles, unit = body
    moved = deformable(1e-3 * vertices + [0.4, -7, 2], triangles)
    np.testing.assert_allclose(moved.vertices, unit.vertices, atol=1e-9)
    np.testing.assert_allclose(moved.mass, unit.mass, atol=1e-12)


def test_the_search_is_on_the_surface_at_rest(body):
    vertices, triangles, unit = body
    found = unit.search.nearest(vertices)
    np.testing.assert_allclose(
        np.einsum("kc,kcd->kd", found.barycentric, vertices[triangles[found.triangles]]), vertices, atol=1e-9
    )


@pytest.mark.parametrize("radius", [1e-4, 1.0, 300.0])
def test_the_curvature_of_a_sphere_is_that_of_its_radius(radius):
    """A sphere of unit area has the mean curvature sqrt(4 pi), and heat leaves a constant alone."""
    ball = deformable(*icosphere(12, radius))
    np.testing.assert_allclose(
        ball.curvatures, np.broadcast_to(np.sqrt(4 * np.pi * TIMES), ball.curvatures.shape), rtol=0.02
    )


def test_a_sphere_seen_from_inside_has_the_opposite_curvature():
    vertices, triangles = icosphere(6)
    np.testing.assert_allclose(
        deformable(vertices, triangles[:, ::-1]).curvatures, -deformable(vertices, triangles).curvatures, atol=1e-9
    )


def test_a_plane_is_not_curved():
    np.testing.assert_allclose(deformable(*plane(12, jitter=0.2)).curvatures, 0, atol=1e-12)


def test_heat_keeps_the_total_curvature(body):
    _, _, unit = body
    totals = unit.mass @ (unit.curvatures / np.sqrt(TIMES))
    assert totals[0] == pytest.approx(totals[1], rel=1e-9)
    assert totals[0] > 0


def test_where_limbs_end_the_surface_is_curved_most(body):
    _, _, unit = body
    rest = creature(0.0, 9)[2]
    tips, belly = rest[:, 2] < -0.95, (np.abs(rest[:, 0]) < 0.2) & (np.abs(rest[:, 2]) < 0.3)
    assert (unit.curvatures[tips].mean(axis=0) > 2 * unit.curvatures[belly].mean(axis=0)).all()


def test_curvatures_do_not_depend_on_motion_scale_or_order(body):
    vertices, triangles, unit = body
    moved = deformable(254 * vertices @ rotation([1, -2, 0.5], 2.2).T + [9, 8, -30], triangles)
    np.testing.assert_allclose(moved.curvatures, unit.curvatures, atol=1e-8)
    shuffled, faces, new = permuted(vertices, triangles, seed=1)
    np.testing.assert_allclose(deformable(shuffled, faces).curvatures[new], unit.curvatures, atol=1e-7)


def test_curvatures_hardly_depend_on_the_meshing_or_the_pose():
    """At points that are nearest at rest."""
    first, second = creature(0.0, 11), creature(0.5, 13, turn=0.7)
    near = np.linalg.norm(first[2][:, None] - second[2], axis=2).argmin(axis=1)
    a, b = deformable(*first[:2]).curvatures, deformable(*second[:2]).curvatures[near]
    for scale in range(2):
        assert np.corrcoef(a[:, scale], b[:, scale])[0, 1] > 0.9
