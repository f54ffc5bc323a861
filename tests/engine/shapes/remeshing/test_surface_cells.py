# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells of a surface."""

import numpy as np
import pytest
from scipy.sparse.csgraph import connected_components

from engine import TriangleMesh
from engine.shapes.remeshing.surface_cells import SurfaceCells, grid_labels, nearest_members
from tests.shapes import icosphere, permuted, plane, plane_with_hole, torus


def characteristic(cells, regions):
    """Euler characteristic of each region of cells, from the cells alone."""
    count = regions.max() + 1
    pairs, triples = regions[cells.pairs], regions[cells.triples]
    inside = pairs[:, 0] == pairs[:, 1]
    whole = (triples == triples[:, :1]).all(axis=1)
    return (
        np.bincount(regions, cells.characteristics, count)
        + np.bincount(pairs[inside, 0], cells.pair_characteristics[inside], count)
        + np.bincount(triples[whole, 0], minlength=count)
    )


@pytest.mark.parametrize("shape", [icosphere(12), torus(40, 16), plane_with_hole(20)])
def test_cells_are_connected_and_small(shape):
    mesh = TriangleMesh(*shape)
    labels = grid_labels(mesh, 0.25)
    a, b = mesh.edges.T
    cells = SurfaceCells.build(mesh, labels)
    assert cells.count == labels.max() + 1 < mesh.vertex_count
    for cell in range(cells.count):
        members = np.flatnonzero(labels == cell)
        assert (np.ptp(mesh.vertices[members], axis=0) <= 0.25).all()
        inside = (labels[a] == cell) & (labels[b] == cell)
        joined = np.zeros((mesh.vertex_count, mesh.vertex_count), bool)
        joined[a[inside], b[inside]] = True
        assert connected_components(joined[np.ix_(members, members)], directed=False)[0] == 1


def test_sums_and_means_are_those_of_the_vertices():
    mesh = TriangleMesh(*torus(40, 16))
    cells = SurfaceCells.build(mesh, grid_labels(mesh, 0.3))
    assert cells.areas.sum() == pytest.approx(mesh.area)
    assert cells.unit**2 == pytest.approx(mesh.area)
    for cell in (0, cells.count // 2, cells.count - 1):
        members = cells.labels == cell
        np.testing.assert_allclose(cells.positions[cell], mesh.vertices[members].mean(axis=0))
        np.testing.assert_allclose(cells.normals[cell], mesh.vertex_normals[members].mean(axis=0), atol=1e-12)
    nearest = cells.nearest_vertices(mesh.vertices)
    assert (cells.labels[nearest] == np.arange(cells.count)).all()


def test_the_graph_joins_neighbours_by_their_distance():
    mesh = TriangleMesh(*plane(12))
    cells = SurfaceCells.build(mesh, grid_labels(mesh, 0.2))
    graph = cells.graph.toarray()
    np.testing.assert_array_equal(graph, graph.T)
    ends = np.sort(cells.labels[mesh.edges], axis=1)
    expected = {tuple(pair) for pair in ends if pair[0] != pair[1]}
    assert {tuple(pair) for pair in cells.pairs} == expected
    for a, b in expected:
        assert graph[a, b] == pytest.approx(np.linalg.norm(cells.positions[a] - cells.positions[b]))
    assert np.count_nonzero(graph) == 2 * len(expected)
    assert connected_components(graph)[0] == 1


@pytest.mark.parametrize(("shape", "expected"), [(icosphere(12), 2), (torus(40, 16), 0), (plane_with_hole(20), 0)])
@pytest.mark.parametrize("size", [0.01, 0.2, 0.6])
def test_characteristics_add_up_to_that_of_the_surface(shape, expected, size):
    mesh = TriangleMesh(*shape)
    cells = SurfaceCells.build(mesh, grid_labels(mesh, size))
    assert characteristic(cells, np.zeros(cells.count, np.int64)) == [expected]


def test_characteristic_of_a_band_and_of_caps():
    mesh = TriangleMesh(*icosphere(12))
    cells = SurfaceCells.build(mesh, np.arange(mesh.vertex_count))
    regions = np.digitize(mesh.vertices[:, 2], [-0.5, 0.5])
    np.testing.assert_array_equal(characteristic(cells, regions), [1, 0, 1])


def test_boundaries_are_known():
    mesh = TriangleMesh(*plane_with_hole(20))
    cells = SurfaceCells.build(mesh, grid_labels(mesh, 0.1))
    expected = np.zeros(cells.count, bool)
    expected[cells.labels[np.unique(mesh.boundary_edges)]] = True
    np.testing.assert_array_equal(cells.at_boundary, expected)
    assert 0 < expected.sum() < cells.count


def test_sheets_in_the_same_cube_stay_apart():
    vertices, triangles = plane(15)
    above = np.array([0, 0, 1e-3])
    both = TriangleMesh(
        np.concatenate([vertices, vertices + above]), np.concatenate([triangles, triangles + len(vertices)])
    )
    labels = grid_labels(both, 0.3)
    assert not np.intersect1d(labels[: len(vertices)], labels[len(vertices) :]).size


def test_labels_do_not_depend_on_the_order_or_scale():
    vertices, triangles = icosphere(12)
    labels = grid_labels(TriangleMesh(vertices, triangles), 0.3)
    shuffled, turned, new = permuted(vertices, triangles)
    np.testing.assert_array_equal(grid_labels(TriangleMesh(shuffled, turned), 0.3)[new], labels)
    np.testing.assert_array_equal(grid_labels(TriangleMesh(vertices * 1024, triangles), 0.3 * 1024), labels)


def test_dissolved_cells_fall_apart_into_vertices():
    mesh = TriangleMesh(*torus(40, 16))
    cells = SurfaceCells.build(mesh, grid_labels(mesh, 0.4))
    some = np.arange(cells.count) % 3 == 0
    finer = cells.dissolved(mesh, some)
    sizes = np.bincount(finer.labels)
    assert (sizes[finer.labels[some[cells.labels]]] == 1).all()
    assert finer.count == (~some).sum() + some[cells.labels].sum()
    assert characteristic(finer, np.zeros(finer.count, np.int64)) == [0]


def test_nearest_members():
    groups, distances = np.array([0, 2, 2, 0, 2]), np.array([3.0, 1.0, 0.5, 3.0, 0.5])
    np.testing.assert_array_equal(nearest_members(groups, distances, 4), [0, -1, 2, -1])
