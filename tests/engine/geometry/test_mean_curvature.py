# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine import TriangleMesh
from engine.geometry.geodesics import GeodesicSolver
from engine.geometry.mean_curvature import smoothed_mean_curvature
from tests.shapes import cylinder, icosphere, plane


def curvature(vertices, triangles, places, radius):
    mesh = TriangleMesh(vertices, triangles)
    return smoothed_mean_curvature(mesh, GeodesicSolver(mesh).distances(places), radius)


def test_a_sphere_bulges_alike_everywhere_and_its_inside_is_hollow():
    vertices, triangles = icosphere(12)
    places = np.arange(0, len(vertices), 97)
    outside = curvature(vertices, triangles, places, 0.2)
    assert outside.min() > 0
    np.testing.assert_allclose(outside, outside.mean(), rtol=0.02)
    np.testing.assert_allclose(curvature(vertices, triangles[:, ::-1], places, 0.2), -outside, rtol=1e-9)


def test_on_a_sphere_it_is_the_drop_of_the_patch():
    # A small Gaussian patch of deviation r on the unit sphere lies r^2 below its middle on average (both squared
    # tangential coordinates have mean r^2, half of each is the drop), so the two patches differ by 4 r^2 - r^2.
    radius = 0.1
    value = curvature(*icosphere(30), [0], radius)[0]
    assert value == pytest.approx(3 * radius, rel=0.05)


def test_a_cylinder_bends_half_as_much_as_a_sphere():
    vertices, triangles = cylinder(90, 90, radius=1.0, height=4.0)
    middle = np.linalg.norm(vertices - [1, 0, vertices[:, 2].mean()], axis=1).argmin()
    assert curvature(vertices, triangles, [middle], 0.1)[0] == pytest.approx(0.5 * 3 * 0.1, rel=0.1)


def test_a_plane_does_not_bend():
    vertices, triangles = plane(20)
    np.testing.assert_allclose(curvature(vertices, triangles, [0, 100, 210], 0.1), 0, atol=1e-12)


def test_units_do_not_matter():
    vertices, triangles = icosphere(8)
    vertices = vertices * [1, 1.5, 2]
    small = curvature(vertices, triangles, [3, 70], 0.2)
    np.testing.assert_allclose(curvature(1000 * vertices, triangles, [3, 70], 200.0), small, rtol=1e-6)
