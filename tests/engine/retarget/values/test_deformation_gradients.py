# SPDX-License-Identifier: GPL-3.0-or-later
"""What deformations do to a surface around each vertex."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import FittedRig, MeshError, Skeleton, SurfaceMap, TriangleMesh
from engine.retarget.values.deformation_gradients import (
    LocalFrames,
    bearers,
    bone_frames,
    evened_frames,
    surface_frames,
)
from tests.shapes import creature, icosphere, irregular, permuted, plane, rotation

TURN = rotation([1.0, 2.0, -1.0], 2.0)


@pytest.fixture(scope="module")
def mesh():
    return TriangleMesh(*irregular(*icosphere(6), rounds=1))


def test_a_similarity_is_found_exactly(mesh):
    frames = surface_frames(mesh, 2.5 * mesh.vertices @ TURN.T + [1, 2, 3])
    np.testing.assert_allclose(frames.rotations, np.broadcast_to(TURN, (len(frames), 3, 3)), atol=1e-8)
    np.testing.assert_allclose(frames.scales, 2.5, rtol=1e-8)
    assert frames.overall == pytest.approx(2.5)
    vectors = np.random.default_rng(0).normal(size=(4, mesh.vertex_count, 3))
    np.testing.assert_allclose(frames.turned(vectors), vectors @ TURN.T, atol=1e-7)


def test_a_mirror_image_gives_reflections(mesh):
    mirror = np.diag([1.0, -1.0, 1.0])
    frames = surface_frames(mesh, mesh.vertices @ mirror, mirrored=True)
    np.testing.assert_allclose(frames.rotations, np.broadcast_to(mirror, (len(frames), 3, 3)), atol=1e-8)


def test_limbs_turn_by_themselves():
    rest, triangles, _ = creature(0.0, 9)
    bent = creature(1.0, 9)[0]
    mesh = TriangleMesh(rest, triangles)
    frames = surface_frames(mesh, bent, radius=0.02)
    snout = rest[:, 0] > 1.15
    expected, _, right = np.linalg.svd(
        (bent[snout] - bent[snout].mean(axis=0)).T @ (rest[snout] - rest[snout].mean(axis=0))
    )
    turn = expected @ right
    torso = (np.abs(rest[:, 0]) < 0.2) & (rest[:, 2] > -0.1)
    assert np.abs(frames.rotations[torso] - np.eye(3)).max() < 0.05
    assert np.abs(frames.rotations[snout] - turn).max() < 0.3
    np.testing.assert_allclose(np.linalg.det(frames.rotations), 1)


def test_neither_units_nor_numbering_matter(mesh):
    images = mesh.vertices * [1, 1.5, 0.7] + 0.1 * np.sin(3 * mesh.vertices[:, ::-1])
    frames = surface_frames(mesh, images)
    vertices, triangles, new = permuted(mesh.vertices, mesh.triangles, seed=3)
    moved = np.empty_like(images)
    moved[new] = images
    other = surface_frames(TriangleMesh(1000 * vertices, triangles), 10 * moved)
    np.testing.assert_allclose(other.rotations[new], frames.rotations, atol=1e-6)
    np.testing.assert_allclose(other.scales[new], frames.scales / 100, rtol=1e-6)


def test_needles_collapsed_triangles_and_loose_vertices_are_bounded(mesh):
    vertices = np.concatenate([mesh.vertices, [[9.0, 9, 9]]])
    images = np.concatenate([mesh.vertices @ TURN.T, [[0.0, 0, 0]]])
    images[mesh.triangles[0]] = images[mesh.triangles[0, 0]]
    frames = surface_frames(TriangleMesh(vertices, mesh.triangles), images)
    assert np.isfinite(frames.rotations).all()
    assert np.abs(frames.rotations - TURN).max() < 0.2
    assert (frames.scales > 0.2).all()


def test_a_small_piece_turns_as_what_it_lies_on(mesh):
    near = mesh.triangles[np.linalg.norm(mesh.vertices[mesh.triangles].mean(axis=1) - mesh.vertices[0], axis=1) < 0.25]
    used, numbers = np.unique(near, return_inverse=True)
    lash = 1.02 * mesh.vertices[used]
    both = TriangleMesh(
        np.concatenate([mesh.vertices, lash]),
        np.concatenate([mesh.triangles, numbers.reshape(-1, 3) + mesh.vertex_count]),
    )
    images = both.vertices @ TURN.T
    images[mesh.vertex_count :] = lash @ rotation([0, 1, 0], 1.5).T  # mapped anyhow
    frames = surface_frames(both, images)
    np.testing.assert_allclose(frames.rotations, np.broadcast_to(TURN, (len(both.vertices), 3, 3)), atol=1e-6)
    away = both.vertices.copy()
    away[mesh.vertex_count :] += mesh.vertices[0]  # a hand beside its arm turns by itself
    images[mesh.vertex_count :] = away[mesh.vertex_count :] @ rotation([0, 1, 0], 1.5).T
    alone = surface_frames(TriangleMesh(away, both.triangles), images)
    assert np.abs(alone.rotations[mesh.vertex_count :] - rotation([0, 1, 0], 1.5)).max() < 1e-6


def test_what_turns_alike_is_evened_out_and_a_joint_stays(mesh):
    def errors(angle):
        """Error of noisy rotations on either side of a bend by this angle, before and after."""
        bent = mesh.vertices[:, 2] > 0
        turned = np.where(bent[:, None, None], rotation([1.0, 0, 0], angle) @ TURN, TURN)
        noise = [rotation([0, 1.0, 0], 0.03 * np.sin(9 * x)) for x in mesh.vertices[:, 0]]
        frames = LocalFrames(np.array(noise) @ turned, np.full(mesh.vertex_count, 3.0), 3.0)
        evened = evened_frames(mesh, frames)
        np.testing.assert_array_equal(evened.scales, frames.scales)
        np.testing.assert_allclose(np.linalg.det(evened.rotations), 1)
        return [np.linalg.norm(each.rotations - turned, axis=(1, 2)).mean() for each in (frames, evened)]

    for angle in (0.0, 1.0):
        before, after = errors(angle)
        assert after < before / 2
    same = LocalFrames(np.broadcast_to(-TURN, (mesh.vertex_count, 3, 3)), np.ones(mesh.vertex_count), 1.0)
    np.testing.assert_allclose(evened_frames(mesh, same).rotations, same.rotations, atol=1e-8)


def test_bad_images_are_refused(mesh):
    with pytest.raises(MeshError, match="one finite position"):
        surface_frames(mesh, mesh.vertices[1:])
    with pytest.raises(MeshError, match="one finite position"):
        surface_frames(mesh, np.full_like(mesh.vertices, np.nan))


def rig(mesh, weights):
    """Two bones, one at rest and one turned and twice as large."""
    skeleton = Skeleton(np.array([-1, 0]), np.zeros((2, 3)), np.array([[0, 0, 1.0], [0, 1, 0]]))
    identity = SurfaceMap.identity(mesh)
    rotations = np.stack([np.eye(3), TURN])
    scales = np.array([1.0, 2.0])
    return FittedRig(
        skeleton=skeleton,
        weights=csr_array(weights),
        linear=scales[:, None, None] * rotations,
        translations=np.zeros((2, 3)),
        rotations=rotations,
        scales=scales,
        posed=mesh.vertices,
        registered=mesh.vertices,
        source_to_target=identity,
        target_to_source=identity,
    )


def test_bones_turn_what_they_move(mesh):
    n = mesh.vertex_count
    otherwise = LocalFrames(np.broadcast_to(rotation([0, 0, 1], 1.0), (n, 3, 3)), np.full(n, 5.0), 1.1)
    weights = np.zeros((n, 2))
    weights[0, 0], weights[1, 1], weights[2] = 1, 1, 0.5
    frames = bone_frames(rig(mesh, weights), otherwise)
    np.testing.assert_allclose(frames.rotations[0], np.eye(3), atol=1e-12)
    np.testing.assert_allclose(frames.rotations[1], TURN, atol=1e-12)
    np.testing.assert_allclose(frames.rotations[2] @ frames.rotations[2], TURN, atol=1e-9)  # half of the way
    np.testing.assert_allclose(frames.rotations[3:], otherwise.rotations[3:])
    np.testing.assert_allclose(frames.scales[:4], [1, 2, 1.5, 5])
    assert frames.overall == 1.1
    with pytest.raises(MeshError, match="The rig moves"):
        bone_frames(rig(mesh, weights), LocalFrames(otherwise.rotations[1:], otherwise.scales[1:], 1.0))


def test_the_tip_of_a_lash_is_borne_by_what_its_root_lies_on():
    """The lash grows from the one of two planes, and its tip is nearer to the other one."""
    vertices, triangles = plane(41, size=20.0)
    brow = vertices + np.array([0.0, 0.0, 0.5])
    z = np.linspace(0.01, 0.4, 9)
    strip = np.concatenate([np.stack([0 * z + 10 + side, 0 * z + 10, z], axis=1) for side in (0.0, 0.5)])
    faces = [(i, i + 1, i + 9) for i in range(8)] + [(i + 1, i + 10, i + 9) for i in range(8)]
    count = len(vertices)
    mesh = TriangleMesh(
        np.concatenate([vertices, brow, strip]),
        np.concatenate([triangles, triangles + count, np.add(faces, 2 * count)]),
    )
    found = bearers(mesh)
    np.testing.assert_array_equal(found[: 2 * count], np.arange(2 * count))
    assert (found[2 * count :] < count).all()
