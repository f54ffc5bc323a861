# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle meshes: what they refuse, and geometry known in closed form."""

import copy
import pickle

import numpy as np
import pytest

from engine import MeshError, TriangleMesh
from tests.shapes import creature, cylinder, icosphere, permuted, plane, plane_with_hole, rotation, torus

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("vertices", "triangles", "message"),
    [
        ([["a", 0, 0]], [[0, 1, 2]], r"not an \(n, 3\) array of numbers"),
        ([[0, 0, 0], [0, 1]], [[0, 1, 2]], r"not an \(n, 3\) array of numbers"),
        ([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], r"shape \(n, 3\), but have \(3, 2\)"),
        (np.empty((0, 3)), [[0, 1, 2]], "no vertices"),
        ([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]], "1 of 3 vertices .* vertex 2 first"),
        ([[0, 0, np.inf], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]], "2 of 3 vertices .* vertex 0 first"),
        ([[0, 0, 0], [1, 0, 0], [0, -1e300, 0]], [[0, 1, 2]], r"1 of 3 .* far away .* vertex 2 first, at 1e\+300"),
        (TRIANGLE, [], "no faces"),
        (TRIANGLE, np.empty((0, 3), int), "no faces"),
        (TRIANGLE, [[0, 1, 2], [0, 1]], r"not an \(m, 3\) array of vertex indices"),
        (TRIANGLE, [0, 1, 2], r"shape \(m, 3\), but have \(3,\)"),
        (TRIANGLE, [[0, 1, 2, 0]], r"shape \(m, 3\), but have \(1, 4\)"),
        (TRIANGLE, [[0.0, 1.0, 2.0]], "integers.*float64"),
        (TRIANGLE, [[0, 1, 2], [0, 1, 3]], r"Triangle 1 has the corners \[0, 1, 3\].* 0 to 2"),
        (TRIANGLE, [[0, 1, -1]], "Triangle 0 has the corners"),
        (TRIANGLE, [[0, 1, 2], [1, 2, 1]], "Triangle 1 is degenerate"),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]], "zero area"),
    ],
)
def test_bad_input_is_named(vertices, triangles, message):
    with pytest.raises(MeshError, match=message):
        TriangleMesh(vertices, triangles)


def test_arrays_are_copied_and_read_only():
    vertices, triangles = plane(3)
    mesh = TriangleMesh(vertices, triangles)
    vertices[0] = 7
    triangles[0] = 0
    assert mesh.vertices[0].tolist() == [0, 0, 0]
    assert mesh.triangles[0].tolist() != [0, 0, 0]
    for array in (mesh.vertices, mesh.triangles):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def sent(mesh):
    """The mesh as another process gets it."""
    return pickle.loads(pickle.dumps(mesh))  # noqa: S301


def test_complex_positions_are_refused_in_words():
    vertices, triangles = plane(3)
    with pytest.raises(MeshError, match="should be real numbers"):
        TriangleMesh(vertices + 1j, triangles)


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, sent])
def test_copies_and_all_that_is_computed_are_read_only(copied):
    mesh = copied(TriangleMesh(*plane(3)))
    assert mesh.area == pytest.approx(1)
    computed = mesh.triangle_areas, mesh.triangle_normals, mesh.vertex_areas, mesh.vertex_normals
    for array in (mesh.vertices, mesh.triangles, *computed, mesh.edges, mesh.edge_lengths):
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 0


@pytest.mark.parametrize("dtype", [np.int32, np.uint8, np.int64])
def test_index_types(dtype):
    mesh = TriangleMesh(TRIANGLE, np.array([[0, 1, 2]], dtype))
    assert mesh.triangles.dtype == np.int64
    assert mesh.vertices.dtype == np.float64


def test_square():
    mesh = TriangleMesh(*plane(5, size=2.0))
    assert mesh.vertex_count == 25
    assert mesh.triangle_count == 32
    assert mesh.area == pytest.approx(4)
    assert np.allclose(mesh.triangle_areas, 4 / 32)
    assert mesh.vertex_areas.sum() == pytest.approx(4)
    inner = ((mesh.vertices[:, :2] > 0) & (mesh.vertices[:, :2] < 2)).all(axis=1)
    assert np.allclose(mesh.vertex_areas[inner], 4 / 16)
    assert np.allclose(mesh.triangle_normals, [0, 0, 1])
    assert np.allclose(mesh.vertex_normals, [0, 0, 1])
    assert len(mesh.edges) == 25 + 32 - 1  # Euler: n - e + m = 1
    assert not mesh.is_closed
    a, b = mesh.boundary_edges.T
    assert len(a) == 16
    middle = (mesh.vertices[a] + mesh.vertices[b])[:, :2] / 2
    assert (np.isclose(middle, 0) | np.isclose(middle, 2)).any(axis=1).all()


def test_edges_are_sorted_and_measured():
    mesh = TriangleMesh(*torus(12, 8))
    assert (mesh.edges[:, 0] < mesh.edges[:, 1]).all()
    assert len(np.unique(mesh.edges, axis=0)) == len(mesh.edges) == 3 * mesh.triangle_count // 2
    a, b = mesh.vertices[mesh.edges[:, 0]], mesh.vertices[mesh.edges[:, 1]]
    assert np.allclose(mesh.edge_lengths, np.sqrt(((a - b) ** 2).sum(axis=1)))


def test_each_border_is_as_long_as_it_is_around():
    mesh = TriangleMesh(*plane_with_hole(10, 0.3, 0.6))
    outer = ((mesh.vertices == 0) | (mesh.vertices == 1))[mesh.boundary_edges, :2].any(axis=2).all(axis=1)
    np.testing.assert_allclose(mesh.border_lengths, np.where(outer, 4, 4 * 0.3))
    assert not len(TriangleMesh(*icosphere(3)).border_lengths)


def test_areas_approach_those_of_smooth_shapes():
    def errors(make, exact):
        return [abs(TriangleMesh(*make(k)).area / exact - 1) for k in (1, 2)]

    for make, exact in (
        (lambda k: icosphere(6 * k), 4 * np.pi),
        (lambda k: cylinder(20 * k, 10), 4 * np.pi),
        (lambda k: torus(32 * k, 16 * k, 1.0, 0.35), 4 * np.pi**2 * 0.35),
    ):
        coarse, fine = errors(make, exact)
        assert fine < 0.3 * coarse < 0.02


def test_normals_of_a_sphere_point_outwards():
    mesh = TriangleMesh(*icosphere(8))
    assert mesh.is_closed
    assert len(mesh.boundary_edges) == 0
    assert (np.einsum("ij,ij->i", mesh.vertex_normals, mesh.vertices) > 0.99).all()
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    assert (np.einsum("ij,ij->i", mesh.triangle_normals, centres) > 0.9).all()


def test_degenerate_triangles_have_no_normal_and_no_area():
    mesh = TriangleMesh([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0], [5, 5, 5]], [[0, 1, 2], [0, 1, 3]])
    assert mesh.triangle_areas.tolist() == [0, 0.5]
    assert mesh.triangle_normals.tolist() == [[0, 0, 0], [0, 0, 1]]
    assert mesh.vertex_areas[[2, 4]].tolist() == [0, 0]
    assert mesh.vertex_normals[[2, 4]].tolist() == [[0, 0, 0], [0, 0, 0]]


def test_sum_at_vertices():
    mesh = TriangleMesh([*TRIANGLE, [1, 1, 0], [3, 3, 3]], [[0, 1, 2], [1, 3, 2]])
    assert mesh.sum_at_vertices(np.array([1.0, 10.0])).tolist() == [1, 11, 11, 10, 0]


def test_an_edge_of_three_triangles_is_neither_boundary_nor_closed():
    mesh = TriangleMesh([*TRIANGLE, [0, -1, 0], [0, 0, 1]], [[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    assert not mesh.is_closed
    assert [0, 1] not in mesh.boundary_edges.tolist()
    assert len(mesh.boundary_edges) == 6


def together(*shapes):
    vertices, triangles = zip(*shapes, strict=True)
    starts = np.cumsum([0, *map(len, vertices)])
    return np.concatenate(vertices), np.concatenate([t + s for t, s in zip(triangles, starts[:-1], strict=True)])


def test_components_by_area_and_loose_vertices_last():
    small, large, middle = icosphere(3, 0.5), icosphere(2, 2.0), icosphere(2, 1.0)
    vertices, triangles = together(small, large, middle)
    vertices = np.concatenate([vertices, [[9, 9, 9], [8, 8, 8]]])
    mesh = TriangleMesh(vertices, triangles)
    n, m = len(small[0]), len(large[0])
    assert mesh.component_count == 5
    assert mesh.component_labels.tolist() == [2] * n + [0] * m + [1] * m + [3, 4]


def test_components_are_those_of_the_shape_whatever_the_order():
    vertices, triangles = together(icosphere(3, 0.5), icosphere(2, 2.0), plane(4))
    shuffled, turned, new = permuted(vertices, triangles, seed=3)
    labels = TriangleMesh(shuffled, turned).component_labels
    assert np.array_equal(labels[new], TriangleMesh(vertices, triangles).component_labels)


def test_a_mesh_can_be_made_of_some_triangles():
    mesh = TriangleMesh(*plane(5))
    part, vertices = mesh.made_of(np.array([3, 8]))
    np.testing.assert_array_equal(vertices[part.triangles], mesh.triangles[[3, 8]])
    np.testing.assert_array_equal(part.vertices, mesh.vertices[vertices])
    assert (np.diff(vertices) > 0).all()
    same, _ = mesh.made_of(np.isin(np.arange(mesh.triangle_count), [3, 8]))
    np.testing.assert_array_equal(same.triangles, part.triangles)


def test_parts_of_chosen_vertices_hang_together_by_edges_between_them():
    mesh = TriangleMesh(*plane(5))
    left, right = (mesh.vertices[:, 0] < 0.3, mesh.vertices[:, 0] > 0.7)
    parts = mesh.parts_of(left | right)
    assert len(set(parts[left])) == len(set(parts[right])) == 1
    assert len(set(parts)) == 2 + (~(left | right)).sum()


def test_equal_components_are_numbered_by_their_first_vertex():
    vertices, triangles = together(plane(3), plane(3))
    mesh = TriangleMesh(vertices, triangles[::-1])
    assert mesh.component_labels.tolist() == [0] * 9 + [1] * 9


def test_touching_in_a_vertex_connects():
    mesh = TriangleMesh([*TRIANGLE, [-1, 0, 0], [0, -1, 0]], [[0, 1, 2], [0, 3, 4]])
    assert mesh.component_count == 1


def test_submesh_maps_back():
    vertices, triangles = together(icosphere(3), torus(12, 8))
    mesh = TriangleMesh(vertices, triangles)
    keep = mesh.vertices[:, 2] > 0.05
    part, old_vertices, old_triangles = mesh.submesh(keep)
    assert np.array_equal(old_vertices, np.flatnonzero(keep))
    assert np.array_equal(part.vertices, mesh.vertices[old_vertices])
    assert np.array_equal(old_vertices[part.triangles], mesh.triangles[old_triangles])
    assert np.array_equal(old_triangles, np.flatnonzero(keep[mesh.triangles].all(axis=1)))


def test_submesh_without_a_triangle_is_refused():
    mesh = TriangleMesh(*plane(4))
    with pytest.raises(MeshError, match="no faces"):
        mesh.submesh(np.arange(16) < 1)


def test_invariants_under_motion_and_scale():
    vertices, triangles, _ = creature(0.5, 14)
    mesh = TriangleMesh(vertices, triangles)
    turn = rotation([1, 2, -1], 0.8)
    moved = TriangleMesh(1000 * vertices @ turn.T + [5, -3, 1e3], triangles)
    assert mesh.is_closed
    assert mesh.component_count == 1
    assert np.allclose(moved.vertex_areas, 1e6 * mesh.vertex_areas)
    assert np.allclose(moved.vertex_normals, mesh.vertex_normals @ turn.T)
    assert moved.area == pytest.approx(1e6 * mesh.area)


def test_meshes_are_put_into_one_in_order():
    meshes = [TriangleMesh(*icosphere(2)), TriangleMesh(*icosphere(3, 2.0)), TriangleMesh(*icosphere(1))]
    whole = TriangleMesh.concatenated(meshes)
    assert whole.area == pytest.approx(sum(mesh.area for mesh in meshes))
    firsts = np.cumsum([0] + [mesh.vertex_count for mesh in meshes])
    for mesh, first, last in zip(meshes, firsts, firsts[1:], strict=False):
        np.testing.assert_array_equal(whole.vertices[first:last], mesh.vertices)
        inside = ((whole.triangles >= first) & (whole.triangles < last)).all(axis=1)
        np.testing.assert_array_equal(whole.triangles[inside] - first, mesh.triangles)
    assert TriangleMesh.concatenated(meshes[:1]) is meshes[0]
