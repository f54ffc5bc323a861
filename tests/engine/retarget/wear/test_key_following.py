# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys of a body that its clothes follow."""

import numpy as np
import pytest

from engine import ClosestPoints, MeshError, TriangleMesh, run
from engine.retarget.wear.key_following import follow_keys_steps
from engine.retarget.wear.worn_item import WornItem
from tests.engine.retarget.wear.test_wearing import BODY, BUTTON, SHIRT, ball, similarity_error

HAT = ball(3, 0.2, (0.0, 0.0, 1.3))


def bump(points, height=0.15):
    """A belly on the ball: by how much it moves points."""
    near = np.exp(-np.square(points - [0.0, -0.8, 0.6]).sum(axis=1) / 0.05)
    return height * np.where(near > 1e-3, near, 0.0)[:, None] * points


def follow(offsets, *items):
    return run(follow_keys_steps(BODY, np.array(offsets), items))


def test_clothes_go_out_with_a_belly_and_stay_outside():
    keys = [bump(BODY.vertices), np.zeros_like(BODY.vertices), bump(BODY.vertices, -0.15)]
    (moved,) = follow(keys, WornItem(SHIRT))
    assert not moved[1].any()
    far = np.square(SHIRT.vertices - [0.0, -0.8, 0.6]).sum(axis=1) > 0.6
    top = np.linalg.norm(bump(SHIRT.vertices), axis=1).argmax()
    for number, sign in ((0, 1), (2, -1)):
        assert np.abs(moved[number][far]).max() < 0.002
        outwards = sign * moved[number][top] @ SHIRT.vertices[top] / np.linalg.norm(SHIRT.vertices[top])
        assert 0.1 < outwards < 0.18
        body = TriangleMesh(BODY.vertices + keys[number], BODY.triangles)
        found = ClosestPoints(body).nearest(SHIRT.vertices + moved[number])
        feet = np.einsum("kc,kci->ki", found.barycentric, body.vertices[body.triangles[found.triangles]])
        normals = body.triangle_normals[found.triangles]
        assert (np.einsum("ki,ki->k", SHIRT.vertices + moved[number] - feet, normals) > 0).all()


def test_an_item_that_the_key_does_not_reach_does_not_follow():
    shirt, hat = follow([bump(BODY.vertices), 0.001 * bump(BODY.vertices)], WornItem(SHIRT), WornItem(HAT))
    assert shirt[0].any()
    assert not shirt[1].any()
    assert not hat.any()
    assert hat.shape == (2, HAT.vertex_count, 3)


def test_known_pieces_stay_rigid():
    both = TriangleMesh.concatenated([SHIRT, BUTTON])
    pieces = np.where(np.arange(both.vertex_count) < SHIRT.vertex_count, -1, 0)
    keys = [BODY.vertices * [0.3, 0.2, 0.0] * (1.2 + BODY.vertices[:, :1])]
    known, free = follow(keys, WornItem(both, pieces=pieces), WornItem(both, pieces=np.full_like(pieces, -1)))
    button = slice(SHIRT.vertex_count, None)
    assert similarity_error(BUTTON.vertices, BUTTON.vertices + known[0][button])[0] < 1e-6
    assert similarity_error(BUTTON.vertices, BUTTON.vertices + free[0][button])[0] > 1e-4


def test_loose_vertices_of_the_body_do_no_harm():
    body = TriangleMesh(np.vstack([BODY.vertices, [[0.0, 0.0, 5.0]]]), BODY.triangles)
    offsets = np.vstack([bump(BODY.vertices), [[1.0, 0.0, 0.0]]])
    (loose,) = run(follow_keys_steps(body, offsets[None], [WornItem(SHIRT)]))
    (moved,) = follow([bump(BODY.vertices)], WornItem(SHIRT))
    np.testing.assert_allclose(loose, moved, atol=1e-9)


def test_offsets_of_another_body_are_refused():
    with pytest.raises(MeshError, match="needs offsets"):
        follow([np.zeros((5, 3))], WornItem(SHIRT))
