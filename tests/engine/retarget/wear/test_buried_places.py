# SPDX-License-Identifier: GPL-3.0-or-later
"""Places that lie within a solid, where parts of a character are closed."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.retarget.wear.buried_places import BuriedPlaces
from engine.retarget.wear.contact import Surface
from tests.shapes import icosphere, rotation


def joined(*meshes):
    starts = np.cumsum([0, *(mesh.vertex_count for mesh in meshes[:-1])])
    triangles = [mesh.triangles + start for mesh, start in zip(meshes, starts, strict=True)]
    return TriangleMesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(triangles))


def ball(centre, size=(1.0, 1.0, 1.0)):
    vertices, triangles = icosphere(10)
    return TriangleMesh(vertices * size + np.array(centre), triangles)


def buried_vertices(mesh):
    """Vertices that are buried if the body stays as it is."""
    return BuriedPlaces.of(mesh).on(Surface(mesh), mesh.vertices).vertices


def thigh(x):
    """A box, one of whose sides faces the other's with little air between."""
    vertices, triangles = icosphere(10)
    return TriangleMesh((1.4 * vertices).clip(-0.7, 0.7) * [0.43, 0.6, 2.0] + np.array([x, 0, 0]), triangles)


@pytest.mark.parametrize("turned", [False, True])
def test_where_solids_cross_the_inner_sides_are_buried(turned):
    first, second = ball((0, 0, 0)), ball((0, 0, 1.2))
    depth = np.concatenate(
        [
            1 - np.linalg.norm(first.vertices - [0, 0, 1.2], axis=1),
            1 - np.linalg.norm(second.vertices, axis=1),
        ]
    )
    body = joined(first, second)
    if turned:
        body = TriangleMesh(
            50.0 * body.vertices @ rotation([1.0, 2.0, -0.5], 0.7).T + [900.0, 0.0, 3.0], body.triangles
        )
    buried = buried_vertices(body)
    assert buried[depth > 0.15].all()
    assert not buried[depth < 0.0].any()


def test_thighs_side_by_side_are_not_buried():
    assert not buried_vertices(joined(thigh(-0.32), thigh(0.32))).any()


def test_the_inside_of_a_bowl_is_air():
    outer = ball((0, 0, 0)).vertices
    # A deep bowl: the upper half is folded inwards.
    folded = np.where(outer[:, 2:] > 0, outer * [0.9, 0.9, -0.9], outer)
    assert not buried_vertices(TriangleMesh(folded, ball((0, 0, 0)).triangles)).any()


def test_what_is_hidden_and_comes_to_lie_deep_in_the_other_body_is_buried():
    """A disc across a ball, whose faces are turned over."""
    outer, (vertices, triangles) = ball((0, 0, 0)), icosphere(8)
    disc = TriangleMesh(vertices * [0.8, 0.8, 1e-3], triangles)
    body = joined(TriangleMesh(outer.vertices, outer.triangles[:, ::-1]), disc)
    assert not BuriedPlaces.of(body).within.any()
    buried = BuriedPlaces.of(body).on(Surface(outer), body.vertices).vertices
    inner = np.linalg.norm(body.vertices, axis=1) < 0.7
    assert buried[inner].all()
    assert not buried[: outer.vertex_count].any()
    # What is hidden between thighs comes to lie on the other's skin.
    between = joined(thigh(-0.32), thigh(0.32))
    assert len(BuriedPlaces.of(between).hidden)
    assert not BuriedPlaces.of(between).on(Surface(between), between.vertices).vertices.any()


def prism(low, high):
    """A closed box of eight sides, whose ends are fans around a corner."""
    angles = np.pi * np.arange(8) / 4
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    walls = [np.column_stack([ring, np.full(8, z)]) for z in (low, high)]
    corners, following = np.arange(8), (np.arange(8) + 1) % 8
    sides = [(corners, following, following + 8), (corners, following + 8, corners + 8)]
    fan = np.stack([np.zeros(6, int), corners[1:-1], corners[2:]], axis=1)
    return TriangleMesh(
        np.concatenate(walls), np.concatenate([*(np.stack(one, axis=1) for one in sides), fan[:, ::-1], fan + 8])
    )


def test_large_triangles_that_close_a_waist_are_buried_without_their_corners():
    body = joined(prism(-2.0, 0.0), prism(-0.01, 2.0))
    buried = BuriedPlaces.of(body).on(Surface(body), body.vertices)
    assert not buried.vertices.any()
    assert len(buried.middles)
    assert (np.abs(buried.middles[:, 2]) < 0.02).all()
    apart = joined(prism(-2.0, 0.0), prism(1.0, 3.0))
    assert not len(BuriedPlaces.of(apart).on(Surface(apart), apart.vertices).middles)


@pytest.mark.parametrize("turn_over", [False, True])
def test_faces_that_close_two_parts_at_one_place_are_buried_whichever_way_they_look(turn_over):
    lower, upper = prism(-2.0, 0.0), prism(0.0, 2.0)
    triangles = upper.triangles.copy()
    lid = (upper.vertices[triangles][:, :, 2] == 0).all(axis=1)
    if turn_over:
        triangles[lid] = triangles[lid][:, ::-1]
    # As single precision leaves them, the lids are not quite one.
    shaken = upper.vertices + 1e-7 * np.random.default_rng(0).standard_normal(upper.vertices.shape)
    body = joined(lower, TriangleMesh(shaken, triangles))
    # They have no place on the other body either, but come to lie at its own lids.
    found = BuriedPlaces.of(body).on(Surface(body), body.vertices)
    assert len(found.middles)
    assert (np.abs(found.middles[:, 2]) < 0.01).all()


def test_a_body_whose_faces_are_all_there_twice_has_an_outside():
    body = joined(ball((0, 0, 0)), ball((0, 0, 0)))
    assert not buried_vertices(body).any()
