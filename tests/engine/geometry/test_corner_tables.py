# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of triangles laid out in the plane, and the graph of edges and lines across them."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.geometry.corner_tables import corner_tables
from tests.shapes import cylinder, icosphere, irregular, permuted, plane, rotation


def bases(tables):
    """Length of a b in each corner."""
    return np.sqrt(tables.height / tables.slope)


def angles(tables):
    """Angle of each corner at c."""
    x, y, base = tables.along * bases(tables), tables.slope * bases(tables), bases(tables)
    return np.arccos(((x * (x - base) + y**2) / (tables.length_a * tables.length_b)).clip(-1, 1))


def angle_sums(mesh):
    """Sum of the angles of the triangles around each vertex."""
    a, b, c = mesh.vertices[mesh.triangles].transpose(1, 0, 2)
    sums = np.zeros(mesh.vertex_count)
    for number, (p, q, r) in enumerate(((a, b, c), (b, c, a), (c, a, b))):
        u, v = q - p, r - p
        np.add.at(
            sums,
            mesh.triangles[:, number],
            np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), np.einsum("ij,ij->i", u, v)),
        )
    return sums


@pytest.fixture(params=["sheet", "ball", "needles", "tube"])
def mesh(request):
    make = {
        "sheet": lambda: plane(9, jitter=0.4),
        "ball": lambda: icosphere(4),
        "needles": lambda: irregular(*icosphere(3)),
        "tube": lambda: cylinder(12, 3),
    }
    return TriangleMesh(*make[request.param]())


def test_lengths_are_in_units_of_the_mean_edge(mesh):
    assert corner_tables(mesh).unit == pytest.approx(mesh.edge_lengths.mean())


def test_corners_of_triangles_have_the_lengths_of_their_edges(mesh):
    tables = corner_tables(mesh)
    known = {tuple(np.roll(t, shift)) for t in mesh.triangles.tolist() for shift in range(3)}
    own = [corner in known for corner in zip(tables.c.tolist(), tables.a.tolist(), tables.b.tolist(), strict=True)]
    assert sum(own) >= mesh.triangle_count
    c, a, b = (mesh.vertices[at[own]] for at in (tables.c, tables.a, tables.b))
    for found, (p, q) in ((tables.length_a, (c, a)), (tables.length_b, (c, b)), (bases(tables), (a, b))):
        np.testing.assert_allclose(tables.unit * found[own], np.linalg.norm(p - q, axis=1), rtol=1e-7)


def test_the_columns_describe_one_triangle(mesh):
    tables = corner_tables(mesh)
    base = bases(tables)
    x, y = tables.along * base, tables.slope * base
    np.testing.assert_allclose(np.hypot(x, y), tables.length_a, rtol=1e-9)
    np.testing.assert_allclose(np.hypot(x - base, y), tables.length_b, rtol=1e-9)
    np.testing.assert_allclose(tables.length_a**2 - x * base, tables.bend, atol=1e-9)


def test_corners_are_sorted(mesh):
    assert (np.diff(corner_tables(mesh).c) >= 0).all()


def test_splitting_corners_keeps_the_angle_around_each_vertex(mesh):
    tables = corner_tables(mesh)
    sums = np.bincount(tables.c, angles(tables), mesh.vertex_count)
    np.testing.assert_allclose(sums, angle_sums(mesh), atol=1e-6)


def test_obtuse_corners_are_split():
    # Two flat triangles, base to base: each apex sees the other.
    mesh = TriangleMesh([[0, 0, 0], [4, 0, 0], [2, 1, 0], [2, -1, 0]], [[0, 1, 2], [1, 0, 3]])
    tables = corner_tables(mesh)
    for apex, other in ((2, 3), (3, 2)):
        at = tables.c == apex
        assert at.sum() == 2
        assert {*tables.a[at], *tables.b[at]} == {0, 1, other}
        assert (angles(tables)[at] < np.pi / 2).all()
        lengths = np.where(tables.a == other, tables.length_a, tables.length_b)[at]
        np.testing.assert_allclose(lengths * tables.unit, 2, rtol=1e-12)


def test_folding_an_edge_changes_nothing_inside_of_the_surface():
    flat = np.array([[0.0, 0, 0], [4, 0, 0], [2, 1, 0], [2, -1, 0]])
    folded = flat.copy()
    folded[3] = [2, 0, -1]
    triangles = [[0, 1, 2], [1, 0, 3]]
    before, after = (corner_tables(TriangleMesh(vertices, triangles)) for vertices in (flat, folded))
    for name in ("unit", "c", "a", "b", "slope", "height", "along", "bend", "length_a", "length_b"):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(after.graph.toarray(), before.graph.toarray(), rtol=1e-12)


def test_obtuse_corners_at_the_boundary_stay():
    mesh = TriangleMesh([[0, 0, 0], [4, 0, 0], [2, 1, 0]], [[0, 1, 2]])
    tables = corner_tables(mesh)
    assert tables.c.tolist() == [0, 1, 2]
    assert angles(tables)[2] == pytest.approx(2 * np.arctan(2))


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.0])
def test_right_angles_of_a_grid_are_all_split_whatever_the_rounding(angle):
    vertices, triangles = plane(6)
    tables = corner_tables(TriangleMesh(vertices @ rotation([1, 2, 3], angle), triangles))
    # All look at the other half of their square.
    assert len(tables.c) == (2 + 2) * len(triangles)
    np.testing.assert_allclose(angles(tables), np.pi / 4, atol=1e-9)


def test_both_diagonals_of_a_grid_are_in_the_graph():
    mesh = TriangleMesh(*plane(6, size=5.0))
    tables = corner_tables(mesh)
    lengths = tables.unit * tables.graph.toarray()
    apart = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices, axis=2)
    np.testing.assert_allclose(lengths, np.where(apart < 1.5, apart, 0), atol=1e-12)


def test_lines_of_the_graph_are_straight_in_a_sheet():
    mesh = TriangleMesh(*plane(9, jitter=0.4))
    tables = corner_tables(mesh)
    graph = tables.graph.tocoo()
    assert graph.nnz > 2 * len(mesh.edges)
    straight = np.linalg.norm(mesh.vertices[graph.coords[0]] - mesh.vertices[graph.coords[1]], axis=1)
    np.testing.assert_allclose(tables.unit * graph.data, straight, rtol=1e-9)


def test_the_graph_is_symmetric_and_has_every_edge(mesh):
    tables = corner_tables(mesh)
    graph = tables.graph.toarray()
    np.testing.assert_allclose(graph, graph.T, rtol=1e-7)
    edges = tables.unit * graph[tuple(mesh.edges.T)]
    assert (edges > 0).all()
    assert (edges <= mesh.edge_lengths * (1 + 1e-9)).all()
    apart = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices, axis=2)
    assert (tables.unit * graph >= np.where(graph > 0, apart, 0) * (1 - 1e-9)).all()


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_only_the_unit_depends_on_the_scale(scale):
    vertices, triangles = irregular(*icosphere(3))
    one, other = (
        corner_tables(TriangleMesh(vertices, triangles)),
        corner_tables(TriangleMesh(scale * vertices, triangles)),
    )
    assert other.unit == pytest.approx(scale * one.unit)
    np.testing.assert_array_equal(other.c, one.c)
    for name in ("slope", "height", "along", "bend", "length_a", "length_b"):
        np.testing.assert_allclose(getattr(other, name), getattr(one, name), rtol=1e-6, atol=1e-9)


def test_the_numbering_does_not_matter():
    vertices, triangles = plane(8, jitter=0.4)
    other_vertices, other_triangles, new = permuted(vertices, triangles)
    one, other = (
        corner_tables(TriangleMesh(vertices, triangles)),
        corner_tables(TriangleMesh(other_vertices, other_triangles)),
    )
    np.testing.assert_allclose(other.graph.toarray()[np.ix_(new, new)], one.graph.toarray(), rtol=1e-9)
    keys = [sorted(zip(n[t.c], n[t.a], n[t.b], strict=True)) for t, n in ((one, new), (other, np.arange(len(new))))]
    assert keys[0] == keys[1]


def test_triangles_without_area_stay_finite():
    vertices = [[0, 0, 0], [2, 0, 0], [1, 0, 0], [1, 1, 0], [1, 0, 0]]
    tables = corner_tables(TriangleMesh(vertices, [[0, 2, 1], [0, 1, 3], [0, 4, 2]]))
    for name in ("slope", "height", "along", "bend", "length_a", "length_b"):
        assert np.isfinite(getattr(tables, name)).all()
    assert (tables.slope > 0).all()
    assert (tables.graph.data > 0).all()
