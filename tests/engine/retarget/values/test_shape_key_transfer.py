# SPDX-License-Identifier: GPL-3.0-or-later
"""Offsets carried between surfaces whose maps are known."""

import numpy as np
import pytest

from engine import ClosestPoints, MatchError, SettingsError, SurfaceMap, TriangleMesh, run
from engine.retarget.values.deformation_gradients import LocalFrames, surface_frames
from engine.retarget.values.shape_key_transfer import carry_offsets_steps
from tests.shapes import creature, cut_open, icosphere, rotation

TURN = rotation([1.0, 2.0, -1.0], 2.0)


@pytest.fixture(scope="module")
def mesh():
    return TriangleMesh(*icosphere(6))


@pytest.fixture(scope="module")
def offsets(mesh):
    return np.random.default_rng(0).normal(size=(2, mesh.vertex_count, 3))


def unturned(count, scale=1.0):
    return LocalFrames(np.broadcast_to(np.eye(3), (count, 3, 3)), np.full(count, scale), scale)


def test_the_identity_carries_everything_as_it_is(mesh, offsets):
    carried = run(
        carry_offsets_steps(offsets, unturned(mesh.vertex_count), mesh, SurfaceMap.identity(mesh), threshold=0)
    )
    np.testing.assert_allclose(carried, offsets)


def test_what_was_cut_open_at_seams_moves_alike(mesh, offsets):
    vertices, triangles, home = cut_open(mesh.vertices, mesh.triangles, mesh.triangle_normals[:, 2] > 0)
    copies = np.arange(mesh.vertex_count, len(home))
    found, barycentric = SurfaceMap.identity(mesh).triangles[home], SurfaceMap.identity(mesh).barycentric[home]
    barycentric[copies] = 1 / 3
    back = SurfaceMap.from_barycentric(mesh, found, barycentric)
    target = TriangleMesh(vertices, triangles)
    carried = run(carry_offsets_steps(offsets, unturned(mesh.vertex_count), target, back, threshold=0))
    np.testing.assert_array_equal(carried, carried[:, home])
    apart = np.setdiff1d(np.arange(mesh.vertex_count), home[copies])
    np.testing.assert_allclose(carried[:, apart], offsets[:, apart])


@pytest.mark.parametrize(
    ("scaling", "size", "factor"),
    [
        ("auto", 1.1, 1),
        ("auto", 3.0, 3),
        ("auto", 0.3, 0.3),
        ("auto", 0.0088, 0.01),
        ("auto", 110.0, 100),
        ("none", 3.0, 1),
        ("overall", 1.1, 1.1),
        ("local", 3.0, 3),
    ],
)
def test_a_turned_body_turns_its_offsets(mesh, offsets, scaling, size, factor):
    images = size * mesh.vertices @ TURN.T
    target = TriangleMesh(images, mesh.triangles)
    frames = surface_frames(mesh, images)
    carried = run(carry_offsets_steps(offsets, frames, target, SurfaceMap.identity(mesh), scaling=scaling))
    np.testing.assert_allclose(carried, factor * offsets @ TURN.T, atol=1e-7 * max(1, factor) + 1e-3 * factor * 5)


def test_another_meshing_and_pose_of_a_body():
    rest, triangles, _ = creature(0.0, 9)
    bent, other, other_rest = creature(0.6, 9, turn=0.7)
    mesh, target = TriangleMesh(rest, triangles), TriangleMesh(bent, other)
    found = ClosestPoints(mesh).nearest(other_rest)
    back = SurfaceMap.from_barycentric(mesh, found.triangles, found.barycentric)

    def swollen(points):
        """Swelling of the hump, which turns little, in every point."""
        return np.exp(-((points - [-0.2, 0.15, 0.4]) ** 2).sum(axis=1) / 0.05)[:, None] * [0, 0, 1.0]

    carried = run(carry_offsets_steps([swollen(rest)], unturned(len(rest)), target, back))[0]
    assert np.linalg.norm(carried - swollen(other_rest)) < 0.08 * np.linalg.norm(swollen(other_rest))


def test_short_offsets_become_exactly_zero(mesh):
    lengths = np.linspace(0, 1, mesh.vertex_count)
    offsets = lengths[None, :, None] * [0, 0, 7.0]
    carried = run(
        carry_offsets_steps(offsets, unturned(mesh.vertex_count), mesh, SurfaceMap.identity(mesh), threshold=0.25)
    )
    np.testing.assert_array_equal((carried[0] == 0).all(axis=1), lengths <= 0.25)
    nothing = run(
        carry_offsets_steps(0 * offsets, unturned(mesh.vertex_count), mesh, SurfaceMap.identity(mesh), threshold=0.25)
    )
    assert (nothing == 0).all()


def test_places_without_confidence_are_filled_from_around(mesh):
    offsets = np.broadcast_to([1.0, 2.0, 3.0], (1, mesh.vertex_count, 3)).copy()
    doubted = mesh.vertices[:, 2] > 0.8
    offsets[0, doubted] = 50
    identity = SurfaceMap.identity(mesh)
    unsure = SurfaceMap(identity.points, np.where(doubted, 0.0, 1.0), mesh.vertex_count)
    carried = run(carry_offsets_steps(offsets, unturned(mesh.vertex_count), mesh, unsure))
    np.testing.assert_allclose(carried[0], np.broadcast_to([1, 2, 3], carried[0].shape), atol=1e-5)
    lost = SurfaceMap(identity.points, np.zeros(mesh.vertex_count), mesh.vertex_count)  # nothing to fill from
    carried = run(carry_offsets_steps(offsets, unturned(mesh.vertex_count), mesh, lost))
    np.testing.assert_allclose(carried, offsets)


def test_what_does_not_belong_together_is_refused(mesh, offsets):
    identity, frames = SurfaceMap.identity(mesh), unturned(mesh.vertex_count)
    for arguments, words in (
        ((offsets[:, 1:], frames, mesh, identity), "Offsets should have the shape"),
        ((offsets, unturned(5), mesh, identity), "do not belong together"),
        ((np.full_like(offsets, np.inf), frames, mesh, identity), "not a finite number"),
    ):
        with pytest.raises(MatchError, match=words):
            run(carry_offsets_steps(*arguments))
    with pytest.raises(SettingsError, match='cannot be scaled by "twice", but by auto'):
        run(carry_offsets_steps(offsets, frames, mesh, identity, scaling="twice"))
