# SPDX-License-Identifier: GPL-3.0-or-later
"""The Laplace-Beltrami operator: what is exact in the plane, what always holds, and meshes in a mess."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import TriangleMesh
from engine.geometry.intrinsic_delaunay import triangle_lengths
from engine.geometry.laplacian import LaplaceBeltrami, laplace_beltrami
from tests.shapes import creature, cylinder, icosphere, irregular, permuted, plane, plane_with_hole, rotation, torus

SHAPES = {
    "plane": plane(12, jitter=0.4),
    "needles": irregular(*plane(10)),
    "hole": plane_with_hole(10),
    "sphere": icosphere(6),
    "torus": irregular(*torus(20, 10)),
    "creature": creature(1.0, 10)[:2],
    "two parts": (
        np.concatenate([icosphere(3)[0], icosphere(3)[0] + 5]),
        np.concatenate([icosphere(3)[1], icosphere(3)[1] + len(icosphere(3)[0])]),
    ),
}


def messy():
    """Three sheets at an edge, a double face, triangles without area, loose vertices, a second part."""
    vertices, triangles = plane(8)
    n = len(vertices)
    vertices = np.concatenate([vertices, [[0.5, 0.5, 1], [3, 3, 3], [0.5, 0.5, 0.0], [9, 9, 9], [9, 9, 8], [9, 8, 9]]])
    inner = triangles[40]
    extra = [[inner[0], inner[1], n], inner, [inner[0], inner[1], n + 2], [n + 3, n + 4, n + 5]]
    line = [[0, 8, 16]]
    return TriangleMesh(vertices, np.concatenate([triangles, extra, line]))


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_what_always_holds(shape):
    mesh = TriangleMesh(*shape)
    operator = laplace_beltrami(mesh)
    stiffness = operator.stiffness.toarray()
    np.testing.assert_allclose(stiffness, stiffness.T, atol=0)
    np.testing.assert_allclose(stiffness.sum(axis=1), 0, atol=1e-10 * stiffness.max())
    values = np.linalg.eigvalsh(stiffness)
    assert values[0] > -1e-12 * values[-1]
    assert (operator.mass > 0).all()
    assert operator.area == pytest.approx(mesh.area, rel=1e-5)
    assert (values < 1e-10 * values[-1]).sum() == mesh.component_count


@pytest.mark.parametrize("shape", [plane(15, jitter=0.4), irregular(*plane(12), rounds=3)], ids=["jittered", "needles"])
def test_linear_functions_are_harmonic_inside_a_plane(shape):
    mesh = TriangleMesh(*shape)
    stiffness = laplace_beltrami(mesh).stiffness
    inside = np.ones(mesh.vertex_count, bool)
    inside[mesh.boundary_edges] = False
    functions = mesh.vertices[:, :2] @ [[1.0, 2.0], [3.0, -1.0]]
    image = stiffness @ functions
    assert abs(image[inside]).max() < 1e-3 * abs(image[~inside]).max()  # needles are mollified
    # Their energy is the integral of the squared gradient: exact.
    assert np.einsum("ni,ni->i", functions, image) == pytest.approx([10.0, 5.0], rel=1e-4)


def test_without_needles_linear_functions_are_harmonic_to_the_last_digit():
    mesh = TriangleMesh(*plane(15, jitter=0.2))
    image = laplace_beltrami(mesh).stiffness @ mesh.vertices[:, :2]
    inside = np.ones(mesh.vertex_count, bool)
    inside[mesh.boundary_edges] = False
    assert abs(image[inside]).max() < 1e-13


def test_on_a_sphere_coordinates_are_eigenfunctions():
    mesh = TriangleMesh(*icosphere(20))
    operator = laplace_beltrami(mesh)
    laplacian = (operator.stiffness @ mesh.vertices) / operator.mass[:, None]
    difference = laplacian - 2 * mesh.vertices
    assert np.sqrt((operator.mass @ difference**2).sum() / operator.area) < 0.02


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_inner_edges_have_no_negative_weights(shape):
    mesh = TriangleMesh(*shape)
    entries = laplace_beltrami(mesh).stiffness.tocoo()
    rows, columns = entries.coords
    on_boundary = np.zeros(mesh.vertex_count, bool)
    on_boundary[mesh.boundary_edges] = True
    inner = (rows != columns) & ~(on_boundary[rows] & on_boundary[columns])
    assert entries.data[inner].max() < 1e-6


def test_permutations_motions_and_scale():
    vertices, triangles = irregular(*creature(0.5, 8)[:2], rounds=1)
    operator = laplace_beltrami(TriangleMesh(vertices, triangles))
    moved, shuffled, new = permuted(vertices @ rotation([1, 2, 3], 1.0).T + 4, triangles)
    other = laplace_beltrami(TriangleMesh(1000 * moved, shuffled))
    np.testing.assert_allclose(other.mass[new], 1e6 * operator.mass, rtol=1e-6)
    difference = other.stiffness[new][:, new] - operator.stiffness
    assert abs(difference).max() < 1e-6 * abs(operator.stiffness).max()


def test_bending_a_sheet_changes_nothing():
    vertices, triangles = plane(20)
    flat = laplace_beltrami(TriangleMesh(vertices, triangles))
    folded = vertices.copy()
    upper = vertices[:, 0] > 9.5 / 19  # a fold along grid lines keeps all lengths
    folded[upper, 0], folded[upper, 2] = 10 / 19, vertices[upper, 0] - 10 / 19
    folded[upper & (vertices[:, 0] < 10.5 / 19), 2] = 0
    bent = laplace_beltrami(TriangleMesh(folded, triangles))
    np.testing.assert_allclose(bent.stiffness.toarray(), flat.stiffness.toarray(), atol=1e-12)
    np.testing.assert_allclose(bent.mass, flat.mass)


def test_a_mess_gives_a_sound_operator():
    mesh = messy()
    operator = laplace_beltrami(mesh)
    used = np.zeros(mesh.vertex_count, bool)
    used[mesh.triangles] = True
    assert not used.all()
    np.testing.assert_array_equal(operator.mass > 0, used)
    stiffness = operator.stiffness.toarray()
    assert np.isfinite(stiffness).all()
    np.testing.assert_array_equal(stiffness[~used], 0)
    values = np.linalg.eigvalsh(stiffness)
    assert values[0] > -1e-9 * values[-1]


def test_vertices_of_triangles_without_area_have_some_mass():
    vertices, triangles = plane(5)
    point = np.tile(vertices[0], (3, 1))
    triangles = np.concatenate([triangles, [[25, 26, 27], [0, 25, 26]]])
    operator = laplace_beltrami(TriangleMesh(np.concatenate([vertices, point]), triangles))
    assert (operator.mass > 0).all()
    assert operator.mass[25:].max() < 1e-6 * operator.mass.mean()
    assert operator.area == pytest.approx(1, rel=1e-3)


def test_only_lengths_matter():
    mesh = TriangleMesh(*icosphere(3))
    operator = LaplaceBeltrami.from_lengths(mesh.triangles, triangle_lengths(mesh), mesh.vertex_count)
    assert isinstance(operator.stiffness, csr_array)
    assert operator.vertex_count == mesh.vertex_count
    a, b, c = mesh.vertices[mesh.triangles[0]]
    energy = TriangleMesh(np.array([a, b, c]), np.array([[0, 1, 2]]))
    one = LaplaceBeltrami.from_lengths(energy.triangles, triangle_lengths(energy), 3)
    u, v = a - c, b - c
    assert one.stiffness[0, 1] == pytest.approx(-0.5 * (u @ v) / np.linalg.norm(np.cross(u, v)))


def test_an_edge_from_a_vertex_to_itself_cancels():
    # A cone of two triangles around one vertex: one side of each is a loop.
    triangles, lengths = np.array([[0, 1, 1]]), np.array([[1.0, 0.8, 1.0]])
    stiffness = LaplaceBeltrami.from_lengths(triangles, lengths, 2).stiffness.toarray()
    np.testing.assert_allclose(stiffness.sum(axis=1), 0, atol=1e-14)
    assert stiffness[0, 0] > 0


def test_a_long_thin_cylinder_has_the_energy_of_its_length():
    mesh = TriangleMesh(*cylinder(3, 500, radius=0.01, height=10.0))
    operator = laplace_beltrami(mesh)
    z = mesh.vertices[:, 2]
    assert z @ (operator.stiffness @ z) == pytest.approx(operator.area, rel=1e-6)
