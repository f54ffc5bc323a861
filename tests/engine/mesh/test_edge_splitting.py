# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import TriangleMesh
from engine.mesh.edge_splitting import split_longest_edges
from tests.shapes import creature, icosphere, permuted, plane, rotation

MESHES = {
    "closed": TriangleMesh(*creature(0.4, 9)[:2]),
    "sphere": TriangleMesh(*icosphere(4)),
    "open": TriangleMesh(*plane(8, jitter=0.3, seed=1)),
    "one triangle": TriangleMesh([[0, 0, 0], [3, 0, 0], [0, 2, 1]], [[0, 1, 2]]),
}


def parts_of_edges(mesh):
    return (0, 1, 2, len(mesh.edges) // 3, len(mesh.edges) // 2, len(mesh.edges) - 1, len(mesh.edges))


@pytest.mark.parametrize("name", MESHES)
def test_the_surface_stays_what_and_where_it_is(name):
    mesh = MESHES[name]
    for count in parts_of_edges(mesh):
        fine, ends = split_longest_edges(mesh, count)
        assert fine.vertex_count == mesh.vertex_count + len(ends)
        assert count <= len(ends) <= len(mesh.edges)
        np.testing.assert_array_equal(fine.vertices[: mesh.vertex_count], mesh.vertices)
        np.testing.assert_allclose(fine.vertices[mesh.vertex_count :], mesh.vertices[ends].mean(axis=1))
        assert len(np.unique(fine.triangles)) == fine.vertex_count
        characteristic = fine.vertex_count - len(fine.edges) + fine.triangle_count
        assert characteristic == mesh.vertex_count - len(mesh.edges) + mesh.triangle_count
        assert fine.is_closed == mesh.is_closed
        assert fine.area == pytest.approx(mesh.area)
        assert fine.triangle_areas.min() >= mesh.triangle_areas.min() / 4 * (1 - 1e-9)


@pytest.mark.parametrize("name", MESHES)
def test_each_part_lies_in_its_triangle_and_looks_the_same_way(name):
    mesh = MESHES[name]
    for count in parts_of_edges(mesh):
        fine, ends = split_longest_edges(mesh, count)
        # The old vertices that each new one stands between name the triangle, as all three corners of it are met.
        origin = [{v} for v in range(mesh.vertex_count)] + [set(pair) for pair in ends.tolist()]
        names = {frozenset(t): number for number, t in enumerate(mesh.triangles.tolist())}
        shares = np.zeros(mesh.triangle_count)
        for corners, normal, area in zip(
            fine.triangles.tolist(), fine.triangle_normals, fine.triangle_areas, strict=True
        ):
            parent = names[frozenset(set().union(*(origin[corner] for corner in corners)))]
            np.testing.assert_allclose(normal, mesh.triangle_normals[parent], atol=1e-9)
            shares[parent] += area
        np.testing.assert_allclose(shares, mesh.triangle_areas)


def test_the_longest_edges_are_split_and_each_once():
    mesh = MESHES["closed"]
    _, ends = split_longest_edges(mesh, 100)
    lengths = np.linalg.norm(mesh.vertices[ends[:, 0]] - mesh.vertices[ends[:, 1]], axis=1)
    np.testing.assert_allclose(np.sort(lengths), np.sort(mesh.edge_lengths)[-len(ends) :])
    assert lengths.min() == pytest.approx(np.sort(mesh.edge_lengths)[-100], rel=1e-5)
    fine, ends = split_longest_edges(mesh, 10**6)
    assert len(ends) == len(np.unique(ends, axis=0)) == len(mesh.edges)
    assert fine.triangle_count == 4 * mesh.triangle_count


def test_edges_that_are_equally_long_are_split_together():
    for grid in (TriangleMesh(*plane(8)), TriangleMesh(*icosphere(4))):
        kinds = np.unique(np.round(grid.edge_lengths, 6))
        for count in (1, len(grid.edges) // 2):
            _, ends = split_longest_edges(grid, count)
            lengths = np.linalg.norm(grid.vertices[ends[:, 0]] - grid.vertices[ends[:, 1]], axis=1)
            longest = kinds[kinds >= lengths.min() - 1e-5]
            assert len(ends) == np.isin(np.round(grid.edge_lengths, 6), longest).sum()


@pytest.mark.parametrize(("corner", "diagonal"), [((1, 2), [(1, 2), (3, 0)]), ((-1, 1), [(0, 0), (2.5, 0.5)])])
@pytest.mark.parametrize("first", range(3))
def test_a_quadrilateral_is_cut_along_its_shorter_diagonal(corner, diagonal, first):
    # The two edges at (6, 0) are the longer ones.
    mesh = TriangleMesh([[0, 0, 0], [6, 0, 0], [*corner, 0]], [np.roll([0, 1, 2], first)])
    fine, _ = split_longest_edges(mesh, 2)
    border = fine.boundary_edges.tolist()
    inner = [fine.vertices[edge, :2].tolist() for edge in fine.edges.tolist() if edge not in border]
    assert len(inner) == 2
    assert sorted(map(list, diagonal)) in [sorted(edge) for edge in inner]


@pytest.mark.parametrize("name", MESHES)
def test_neither_numbers_nor_place_matter(name):
    mesh = MESHES[name]
    turn = rotation([1, 2, -0.5], 1.1)
    moved, renumbered, _ = permuted(3 * mesh.vertices @ turn.T + [5, -4, 7], mesh.triangles, seed=3)
    for count in parts_of_edges(mesh)[1:]:
        first, _ = split_longest_edges(mesh, count)
        second, _ = split_longest_edges(TriangleMesh(moved, renumbered), count)
        assert first.vertex_count == second.vertex_count
        there = (second.vertices - [5, -4, 7]) @ turn / 3
        np.testing.assert_allclose(cKDTree(first.vertices).query(there)[0], 0, atol=1e-9)
