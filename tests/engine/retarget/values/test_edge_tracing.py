# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked edges, traced on another mesh."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MatchError, SurfaceMap, TriangleMesh, run
from engine.mesh.connectivity.edge_chains import edge_chains
from engine.retarget.values.edge_tracing import nearest_edge_values, trace_edges_steps
from tests.faces import closest_map, grid, triangulated
from tests.shapes import icosphere, plane, plane_with_hole, rotation


def trace(source, marked, values, target):
    return run(
        trace_edges_steps(
            marked,
            values,
            source,
            target.edges,
            source_to_target=closest_map(source.vertices, target),
            target_to_source=closest_map(target.vertices, source),
        )
    )


def on_line(mesh, normal, offset):
    """Edges of a mesh that lie in a plane."""
    return mesh.edges[(abs(mesh.vertices[mesh.edges] @ np.asarray(normal, float) - offset) < 1e-9).all(axis=1)]


def length(mesh, edges):
    return np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1).sum()


def degrees(edges):
    count = np.bincount(edges.ravel())
    return sorted(count[count > 0].tolist())


def test_the_same_mesh_gets_the_same_edges():
    mesh = TriangleMesh(*icosphere(8))
    random = np.random.default_rng(3)
    marked = random.random(len(mesh.edges)) < 0.15
    values = random.uniform(0.2, 1, marked.sum())
    carried = run(
        trace_edges_steps(
            mesh.edges[marked],
            values,
            mesh,
            mesh.edges,
            source_to_target=SurfaceMap.identity(mesh),
            target_to_source=SurfaceMap.identity(mesh),
        )
    )
    expected = np.zeros(len(mesh.edges))
    expected[marked] = values
    np.testing.assert_allclose(carried.values, expected)
    assert carried.lost == 0


@pytest.mark.parametrize("counts", [(40, 21), (11, 61)], ids=["coarser", "finer"])
def test_a_line_that_the_target_has_is_found_exactly(counts):
    source, target = (TriangleMesh(*plane(count)) for count in counts)
    line = source.vertices[counts[0] // 2 * counts[0], 0]
    marked = on_line(source, [1, 0, 0], line)
    traced = trace(source, marked, np.ones(len(marked)), target).values > 0
    edges = target.edges[traced]
    assert length(target, edges) == pytest.approx(1)
    assert degrees(edges) == [1, 1] + [2] * (counts[1] - 2)
    assert abs(target.vertices[edges][:, :, 0] - line).max() < 0.5 / (counts[1] - 1) + 1e-9


def test_a_line_that_the_target_has_not_is_followed_as_near_as_edges_are():
    source, target = TriangleMesh(*plane(21)), TriangleMesh(*plane(61, jitter=0.35))
    marked = on_line(source, [1, 0, 0], 0.5)
    edges = target.edges[trace(source, marked, np.ones(len(marked)), target).values > 0]
    away = 60 * abs(target.vertices[edges].mean(axis=1)[:, 0] - 0.5)
    assert away.mean() < 0.18
    assert away.max() < 0.7
    assert length(target, edges) < 1.08


def test_a_loop_stays_a_single_loop():
    source = TriangleMesh(*icosphere(12))
    target = TriangleMesh(icosphere(9)[0] @ rotation([3, 1, 2], 0.8).T, icosphere(9)[1])
    # A ring around the sphere, along edges of the icosahedron's faces.
    height = source.vertices @ rotation([1, 2, 0.5], 0.3)[2]
    above = height[source.triangles].mean(axis=1) > 0.2
    sides = np.sort(np.stack([source.triangles, np.roll(source.triangles, -1, axis=1)], axis=2)[above].reshape(-1, 2))
    marked, count = np.unique(sides, axis=0, return_counts=True)
    marked = marked[count == 1]
    edges = target.edges[trace(source, marked, np.ones(len(marked)), target).values > 0]
    assert set(degrees(edges)) == {2}
    assert len(edge_chains(edges)) == 1
    assert length(target, edges) == pytest.approx(length(source, marked), rel=0.25)
    away = target.vertices[edges].mean(axis=1) @ rotation([1, 2, 0.5], 0.3)[2]
    assert abs(away - 0.2).max() < 0.2


def test_lines_that_cross_still_cross():
    source, target = TriangleMesh(*plane(21)), TriangleMesh(*plane(31, jitter=0.3))
    marked = np.concatenate([on_line(source, [1, 0, 0], 0.5), on_line(source, [0, 1, 0], 0.5)])
    edges = target.edges[trace(source, marked, np.ones(len(marked)), target).values > 0]
    found = degrees(edges)
    assert found.count(1) == 4
    assert set(found) <= {1, 2, 3, 4}
    centre = np.linalg.norm(target.vertices[:, :2] - 0.5, axis=1)
    crossing = np.flatnonzero(np.bincount(edges.ravel(), minlength=target.vertex_count) > 2)
    assert centre[crossing].max() < 0.1


def test_a_line_that_comes_back_beside_its_beginning_takes_no_short_cut():
    source, target = TriangleMesh(*plane(41)), TriangleMesh(*plane(29))
    sides = [on_line(source, [1, 0, 0], 0.25), on_line(source, [1, 0, 0], 0.3), on_line(source, [0, 1, 0], 0.75)]
    marked = np.concatenate(sides)
    x, y = source.vertices[marked][:, :, 0], source.vertices[marked][:, :, 1]
    marked = marked[((y < 0.75 + 1e-9) & (x > 0.25 - 1e-9) & (x < 0.3 + 1e-9)).all(axis=1)]
    assert len(edge_chains(marked)) == 1
    edges = target.edges[trace(source, marked, np.ones(len(marked)), target).values > 0]
    assert target.vertices[edges][:, :, 1].max() == pytest.approx(0.75, abs=0.04)
    assert length(target, edges) > 1.4


def test_values_along_a_line_stay_in_their_places():
    source, target = TriangleMesh(*plane(21)), TriangleMesh(*plane(41))
    marked = on_line(source, [1, 0, 0], 0.5)
    values = 1 + source.vertices[marked].mean(axis=1)[:, 1]
    traced = trace(source, marked, values, target).values
    middles = target.vertices[target.edges[traced > 0]].mean(axis=1)[:, 1]
    assert abs(traced[traced > 0] - 1 - middles).max() <= 0.5 / 20


def test_a_line_where_the_target_has_nothing_is_lost():
    source = TriangleMesh(*plane(41))
    target = TriangleMesh(plane(41)[0] * [0.5, 1, 1], plane(41)[1])
    marked = np.concatenate([on_line(source, [1, 0, 0], 0.25), on_line(source, [1, 0, 0], 0.9)])
    carried = trace(source, marked, np.ones(len(marked)), target)
    assert carried.lost == 1
    edges = target.edges[carried.values > 0]
    assert target.vertices[edges][:, :, 0].max() < 0.3


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_scale_and_place_do_not_matter(factor):
    source, target = TriangleMesh(*plane(21)), TriangleMesh(*plane(31, jitter=0.3))
    marked = on_line(source, [1, 0, 0], 0.5)
    expected = trace(source, marked, np.ones(len(marked)), target).values
    turn = factor * rotation([1, 2, 3], 0.7)
    moved = [TriangleMesh(mesh.vertices @ turn.T + 5 * factor, mesh.triangles) for mesh in (source, target)]
    np.testing.assert_array_equal(trace(moved[0], marked, np.ones(len(marked)), moved[1]).values, expected)


def test_values_of_all_edges_come_from_the_nearest():
    vertices, faces, _ = grid(4, 4)
    mesh = triangulated(vertices, faces)
    values = np.arange(len(faces.edges))
    carried = nearest_edge_values(values, mesh, faces.edges, faces.edges, SurfaceMap.identity(mesh))
    np.testing.assert_array_equal(carried, values)


def test_nothing_marked_and_what_does_not_fit():
    mesh = TriangleMesh(*plane(5))
    identity = SurfaceMap.identity(mesh)
    maps = {"source_to_target": identity, "target_to_source": identity}
    nothing = np.zeros((0, 2), int)
    assert not run(trace_edges_steps(nothing, [], mesh, mesh.edges, **maps)).values.any()
    other = TriangleMesh(*plane(6))
    with pytest.raises(MatchError, match="maps are of meshes"):
        run(trace_edges_steps(nothing, [], other, mesh.edges, **maps))
    with pytest.raises(MatchError, match="do not belong together"):
        run(trace_edges_steps(nothing, [], mesh, other.edges, **maps))


@pytest.mark.parametrize("seed", range(4))
def test_each_edge_has_the_value_of_the_marked_edge_beside_its_middle(seed):
    """Where values change along a line of long and short edges, and the target's edges are not all of one length."""
    random = np.random.default_rng(seed)
    spots = np.append(0, np.cumsum(random.uniform(0.6, 1.4, 12)))
    bounds = np.array([0, 3.3, 3.9, 8.6, spots[-1]])

    def strip(along):
        """Mesh a strip around the x axis with vertices there at some places."""
        vertices = np.concatenate([np.c_[along, np.full(len(along), y), np.zeros(len(along))] for y in (-1, 0, 1)])
        first = np.add.outer(len(along) * np.arange(2), np.arange(len(along) - 1)).ravel()
        second = first + len(along)
        triangles = np.concatenate([np.c_[first, first + 1, second], np.c_[first + 1, second + 1, second]])
        return TriangleMesh(vertices, triangles)

    source, target = strip(bounds), strip(spots)
    marked = on_line(source, [0, 1, 0], 0.0)
    order = source.vertices[marked].mean(axis=1)[:, 0].argsort()
    traced = trace(source, marked[order], np.array([1.0, 2, 3, 4]), target).values
    along = on_line(target, [0, 1, 0], 0.0)
    middles = target.vertices[target.edges].mean(axis=1)
    found = abs(middles[:, 1]) < 1e-9
    assert len(along) == found.sum() == (traced > 0).sum()
    apart = abs(middles[found, 0, None] - bounds[1:-1]).min(axis=1)
    clear = apart > 0.13  # an eighth of an edge
    assert (traced[found] == np.searchsorted(bounds, middles[found, 0]))[clear].all()


def test_a_line_goes_around_a_hole_of_the_target_however_wide():
    source, target = TriangleMesh(*plane(21)), TriangleMesh(*plane_with_hole(40, 0.3, 0.6))
    marked = on_line(source, [1, 0, 0], 0.45)
    edges = target.edges[trace(source, marked, np.ones(len(marked)), target).values > 0]
    assert degrees(edges) == [1, 1] + [2] * (len(edges) - 1)
    assert length(target, edges) == pytest.approx(1 + 2 * 0.15)
