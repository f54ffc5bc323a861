# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces laid onto others along maps that are known."""

import numpy as np
import pytest

from engine import ClosestPoints, MatchError, SurfaceMap, TriangleMesh, run
from engine.mesh.reflection import reflected_map, reflected_mesh
from engine.retarget.wrapping import _folded, _smoothed, _united, kept_in_place, wrap_steps
from tests.shapes import creature, cut_open, icosphere, irregular, rotation

TURN = rotation([1.0, 2.0, -1.0], 2.0)


def near(mesh, points):
    found = ClosestPoints(mesh).nearest(points)
    return found.triangles, found.barycentric


def both(meshes, rest):
    """Maps both ways between two meshings of a body, by where their points are at rest."""
    at_rest = [TriangleMesh(points, mesh.triangles) for points, mesh in zip(rest, meshes, strict=True)]
    there = SurfaceMap.from_barycentric(meshes[1], *near(at_rest[1], rest[0]))
    return there, SurfaceMap.from_barycentric(meshes[0], *near(at_rest[0], rest[1]))


@pytest.fixture(scope="module")
def bodies():
    """A body at rest and, in another meshing, bent and in other units; and the maps between them."""
    first, second = creature(0.0, 9), creature(0.7, 9, turn=0.7)
    source, target = TriangleMesh(*first[:2]), TriangleMesh(30 * second[0], second[1])
    return source, target, *both((source, target), (first[2], second[2]))


def test_a_body_lies_on_the_other_without_folds(bodies):
    source, target, there, back = bodies
    wrapped = run(wrap_steps(source, target, there, back))
    assert wrapped.held.mean() > 0.99
    assert wrapped.folded < 0.002
    size = np.sqrt(target.area)
    gaps = np.sqrt(ClosestPoints(target).nearest(wrapped.positions).squared_distances) / size
    assert gaps.mean() < 0.003
    assert gaps.max() < 0.03
    away = np.linalg.norm(wrapped.positions - there.positions, axis=1) / size
    assert away.mean() < 0.005


def test_a_registration_that_is_given_is_followed(bodies):
    source, target, there, back = bodies
    registered = there.positions + np.array([100.0, 0, 0])
    wrapped = run(wrap_steps(source, target, there, back, registered))
    gaps = np.linalg.norm(wrapped.positions - registered, axis=1) / np.sqrt(target.area)
    assert gaps.mean() < 0.005


def test_what_was_cut_open_at_seams_stays_whole(bodies):
    source, target, there, back = bodies
    centres = source.vertices[source.triangles].mean(axis=1)
    vertices, triangles, home = cut_open(source.vertices, source.triangles, centres[:, 1] > 0)
    cut = TriangleMesh(vertices, triangles)
    copies = np.arange(source.vertex_count, len(home))
    assert len(copies) > 50
    # The map leads the copies elsewhere than what they are copies of: to the middle of the triangle.
    barycentric, confidence = there.barycentric[home], there.confidence[home]
    barycentric[copies] = 1 / 3
    confidence[copies] *= 0.9
    there_cut = SurfaceMap.from_barycentric(target, there.triangles[home], barycentric, confidence)
    found, weights = near(cut, back.positions)
    back_cut = SurfaceMap.from_barycentric(cut, found, weights, back.confidence)
    wrapped = run(wrap_steps(cut, target, there_cut, back_cut))
    np.testing.assert_array_equal(wrapped.positions, wrapped.positions[home])
    np.testing.assert_array_equal(wrapped.held, wrapped.held[home])
    whole = run(wrap_steps(source, target, there, back))
    away = np.linalg.norm(wrapped.positions - whole.positions[home], axis=1) / np.sqrt(target.area)
    assert away.max() < 0.005


def test_folds_of_a_map_are_opened():
    mesh = TriangleMesh(*icosphere(8))
    there = SurfaceMap.identity(mesh)
    corners = mesh.triangles[40]
    triangles, barycentric = there.triangles.copy(), there.barycentric.copy()
    shuffled = [1, 2, 0]  # a triangle turned around folds those beside it
    triangles[corners], barycentric[corners] = triangles[corners[shuffled]], barycentric[corners[shuffled]]
    folded = SurfaceMap.from_barycentric(mesh, triangles, barycentric)
    assert folded.flipped_faces(mesh, mesh) > 0.002
    wrapped = run(wrap_steps(mesh, mesh, folded, SurfaceMap.identity(mesh)))
    assert wrapped.folded == 0
    assert np.abs(wrapped.positions - mesh.vertices).max() < 0.15


def test_what_is_folded_at_the_end_is_smoothed():
    mesh = TriangleMesh(*irregular(*icosphere(8), rounds=1))
    positions = mesh.vertices.copy()
    tip = mesh.triangles[40][0]
    positions[tip] += 1.3 * (positions[mesh.triangles[40][1]] - positions[tip])  # over the edge of its ring
    folded = _folded(mesh, positions)
    assert folded.any()
    smooth, still = _smoothed(mesh, positions, folded)
    assert not still.any()
    moved = np.linalg.norm(smooth - mesh.vertices, axis=1)
    assert moved.max() < 0.1
    assert (moved > 0).mean() < 0.1


def test_an_edge_without_length_stays_closed():
    """Both of its ends are whole around, so nothing says that they are one but their place."""
    ball, triangles = irregular(*icosphere(5), rounds=1)
    (one, other), apart = triangles[0][:2], np.linalg.norm(np.diff(ball[triangles[0][:2]], axis=0))
    ball[other] = ball[one]
    rest = TriangleMesh(ball, triangles)
    moved = 2 * ball
    moved[other] += [0.1 * apart, 0, 0]
    turns = np.tile(2 * np.eye(3), (len(ball), 1, 1))
    together = _united(rest, moved, turns)
    np.testing.assert_array_equal(together[one], together[other])
    moved[other] += [50 * apart, 0, 0]  # another place by now
    np.testing.assert_array_equal(_united(rest, moved, turns), moved)


def test_an_edge_of_next_to_no_length_keeps_it():
    """Without any, its triangles have no normal, and custom normals around it cannot be told from it."""
    ball, triangles = irregular(*icosphere(5), rounds=1)
    one, other = triangles[0][:2]
    tiny = np.array([2e-7, -1e-7, 3e-7])
    ball[other] = ball[one] + tiny
    mesh = TriangleMesh(ball, triangles)
    target = TriangleMesh(2 * ball @ TURN.T, triangles)
    there, back = SurfaceMap.identity(target), SurfaceMap.identity(mesh)
    wrapped = run(wrap_steps(mesh, target, there, back)).positions
    np.testing.assert_allclose(wrapped[other] - wrapped[one], 2 * TURN @ tiny, rtol=0, atol=2e-8)


def test_parts_that_the_other_lacks_move_with_what_is_around_them():
    ball, triangles = irregular(*icosphere(6), rounds=1)
    inner, inside = icosphere(2, radius=0.1)
    eye = inner + np.array([0.3, 0.2, 0.5])
    source = TriangleMesh(np.concatenate([ball, eye, [[0, 0, 3.0]]]), np.concatenate([triangles, inside + len(ball)]))
    target = TriangleMesh(2 * ball @ TURN.T, triangles)
    loose = np.arange(len(ball), source.vertex_count)
    # What has no place lies somewhere, all in one point.
    found, barycentric = near(target, 2 * source.vertices @ TURN.T)
    found[loose], barycentric[loose] = found[0], barycentric[0]
    there = SurfaceMap.from_barycentric(target, found, barycentric)
    back = SurfaceMap.from_barycentric(
        source, np.arange(len(triangles))[near(target, target.vertices)[0]], near(target, target.vertices)[1]
    )
    wrapped = run(wrap_steps(source, target, there, back))
    assert not wrapped.held[loose[1:]].any()
    assert wrapped.held[: len(ball)].all()
    np.testing.assert_allclose(wrapped.positions, 2 * source.vertices @ TURN.T, atol=0.1)
    rim = wrapped.positions[len(ball) : -1]
    assert np.ptp(np.linalg.norm(rim - rim.mean(axis=0), axis=1)) < 0.05  # still a ball


def test_the_own_place_is_that_of_least_motion():
    mesh = TriangleMesh(*irregular(*icosphere(4), rounds=1))
    kept = kept_in_place(mesh, mesh.vertices @ TURN.T + [5, 6, 7])
    np.testing.assert_allclose(kept, mesh.vertices, atol=1e-10)
    mirrored = kept_in_place(mesh, -mesh.vertices)
    a, b, c = mirrored[mesh.triangles].transpose(1, 0, 2)
    assert np.einsum("ij,ij->i", np.cross(b - a, c - a), a).mean() < 0  # turned, but never mirrored back


def test_maps_of_other_meshes_are_refused(bodies):
    source, target, there, back = bodies
    with pytest.raises(MatchError, match="the mesh it should lead from has"):
        run(wrap_steps(target, source, there, back))
    with pytest.raises(MatchError, match=r"places where they belong of the shape \(3, 3\)"):
        run(wrap_steps(source, target, there, back, np.zeros((3, 3))))
    doubted = SurfaceMap(there.points, np.zeros(len(there)), target.vertex_count)
    with pytest.raises(MatchError, match="does not hold"):
        run(wrap_steps(source, target, doubted, back))


def test_where_the_map_leads_to_the_mirror_image_that_lies_there_without_folds(bodies):
    source, target, there, back = bodies
    mirror = reflected_mesh(target)
    wrapped, seen = (
        run(wrap_steps(source, end, led, back))
        for end, led in ((target, there), (mirror, reflected_map(mirror, there)))
    )
    np.testing.assert_allclose(seen.positions, wrapped.positions * [-1, 1, 1], atol=1e-4)
    assert seen.folded < 0.002
