# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangulations dual to regions."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.shapes.remeshing.dual_triangulation import dual_triangulation, manifold_part
from engine.shapes.remeshing.surface_cells import SurfaceCells
from tests.shapes import cylinder, icosphere, plane, plane_with_hole, torus


def vertex_cells(mesh):
    return SurfaceCells.build(mesh, np.arange(mesh.vertex_count))


def as_set(triangles):
    """Triangles as rotations that begin with the least vertex."""
    first = triangles.argmin(axis=1)[:, None]
    return {tuple(row) for row in np.take_along_axis(triangles, (first + np.arange(3)) % 3, axis=1)}


@pytest.mark.parametrize("shape", [icosphere(5), torus(16, 10), plane(6), plane_with_hole(10), cylinder(12, 6)])
def test_single_vertices_give_the_mesh_itself(shape):
    mesh = TriangleMesh(*shape)
    dual = dual_triangulation(vertex_cells(mesh), np.arange(mesh.vertex_count), mesh.vertex_count)
    assert not dual.faulty.any()
    assert as_set(dual.triangles) == as_set(mesh.triangles)


def test_eight_octants_of_a_sphere_with_a_band_between():
    # Octants alone meet four at a time; caps at the poles and three sectors between make a proper triangulation.
    mesh = TriangleMesh(*icosphere(20))
    x, y, z = mesh.vertices.T
    sector = (np.floor((np.arctan2(y, x) + 0.3) / (2 * np.pi / 3)) % 3).astype(int)
    regions = np.where(z > 0.7, 3, np.where(z < -0.7, 4, sector))
    dual = dual_triangulation(vertex_cells(mesh), regions, 5)
    assert not dual.faulty.any()
    assert len(dual.triangles) == 6
    # Seen from outside, counter-clockwise.
    centres = np.stack([mesh.vertices[regions == region].mean(axis=0) for region in range(5)])
    a, b, c = centres[dual.triangles].transpose(1, 0, 2)
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) > 0).all()


@pytest.mark.parametrize(
    ("shape", "divide", "faulty"),
    [
        # A ring around the sphere is no disc, and the caps meet nobody else.
        (icosphere(12), lambda v: np.digitize(v[:, 2], [-0.5, 0.5]), {0, 1, 2}),
        # The handle is inside one region.
        (torus(30, 12), lambda v: (v[:, 0] > 0.9).astype(int) + (v[:, 0] > 1.1), {0, 1, 2}),
        # Strips have neighbours, but no triangles.
        (plane(12), lambda v: (v[:, 0] * 3.99).astype(int), {0, 1, 2, 3}),
        # The hole is in one region.
        (plane_with_hole(20), lambda v: (abs(v[:, :2] - 0.45) < 0.4).all(axis=1).astype(int), {0, 1}),
    ],
)
def test_faults_are_found(shape, divide, faulty):
    mesh = TriangleMesh(*shape)
    regions = divide(mesh.vertices)
    dual = dual_triangulation(vertex_cells(mesh), regions, regions.max() + 1)
    assert faulty <= set(np.flatnonzero(dual.faulty))


def test_a_hole_between_two_regions_is_a_fault():
    mesh = TriangleMesh(*plane_with_hole(20, 0.45, 0.55))
    cells = vertex_cells(mesh)
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    inner = (abs(x - 0.5) < 0.2) & (abs(y - 0.5) < 0.2)
    outside = np.floor((np.arctan2(y - 0.5, x - 0.5) + 0.1) / (2 * np.pi / 6)).astype(int) % 6
    two = np.where(inner, 6 + (x > 0.5), outside)
    assert dual_triangulation(cells, two, 8).faulty[6:].all()


def test_a_manifold_stays_whole():
    for shape in (icosphere(4), torus(12, 8), plane(6)):
        mesh = TriangleMesh(*shape)
        np.testing.assert_array_equal(manifold_part(mesh.triangles, mesh.vertex_count), np.arange(mesh.triangle_count))


def test_faults_are_cut_out_and_the_larger_part_stays():
    vertices, triangles = plane(10)
    small, other = icosphere(1)
    count = len(vertices)
    # A flap on an inner edge, two sheets that touch in a vertex, and a small part of its own.
    flap = [[*triangles[40][:2], count]]
    spike = [[count + 1, count + 2, triangles[100][0]]]
    broken = np.concatenate([triangles, flap, spike, other + count + 3])
    kept = manifold_part(broken, count + 3 + len(small))
    assert len(kept) > len(triangles) - 30
    assert kept.max() < len(triangles)
    rest = broken[kept]
    tail, head = rest.ravel(), np.roll(rest, -1, axis=1).ravel()
    assert len(np.unique(tail * 1000 + head)) == len(tail)


def test_nothing_may_be_left():
    book = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    assert len(manifold_part(book, 5)) == 0
    assert len(manifold_part(np.empty((0, 3), np.int64), 3)) == 0
