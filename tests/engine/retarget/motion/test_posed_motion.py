# SPDX-License-Identifier: GPL-3.0-or-later
"""Forward kinematics and back."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine import Motion, RigError, Skeleton, local_transforms, posed_motion
from tests.shapes import rotation


@pytest.fixture
def limb():
    """Three bones in a row with random axes: skeleton and (b, 4, 4) at rest."""
    random = np.random.default_rng(0)
    heads = random.normal(size=(3, 3))
    rest = np.tile(np.eye(4), (3, 1, 1))
    rest[:, :3, :3], rest[:, :3, 3] = Rotation.random(3, random_state=1).as_matrix(), heads
    return Skeleton(np.array([-1, 0, 1]), heads, heads + rest[:, :3, 1]), rest


def basis_of(random, count=4, bones=3):
    basis = np.tile(np.eye(4), (count, bones, 1, 1))
    basis[..., :3, :3] = Rotation.random(count * bones, random_state=2).as_matrix().reshape(count, bones, 3, 3)
    basis[..., :3, 3] = random.normal(size=(count, bones, 3))
    return basis


def test_local_transforms_are_the_inverse_of_posing(limb):
    skeleton, rest = limb
    basis = basis_of(np.random.default_rng(3))
    motion = posed_motion(skeleton, rest, basis)
    local = local_transforms(motion, rest[:, :3, :3])
    assert np.allclose(local.rotations, basis[..., :3, :3])
    assert np.allclose(local.locations, basis[..., :3, 3])
    assert not motion.slides[:, 0].any()
    ways = np.einsum("fij,fj->fi", motion.turns[:, 0] @ rest[1, :3, :3], basis[:, 1, :3, 3])
    assert np.allclose(motion.slides[:, 1], ways)


def test_a_bone_that_does_not_turn_with_its_parent_stores_all_of_its_turn(limb):
    skeleton, rest = limb
    motion = posed_motion(skeleton, rest, basis_of(np.random.default_rng(3)))
    local = local_transforms(motion, rest[:, :3, :3], np.array([True, True, False]))
    axes = rest[2, :3, :3]
    assert np.allclose(axes @ local.rotations[:, 2] @ axes.T, motion.turns[:, 2])


def test_places_may_be_kept_in_the_axes_of_the_parent(limb):
    skeleton, rest = limb
    basis, axes = basis_of(np.random.default_rng(3)), rest[:, :3, :3]
    local = local_transforms(posed_motion(skeleton, rest, basis), axes, None, np.array([False, False, True]))
    above = np.stack([np.eye(3), axes[0]])
    wanted = np.einsum("bji,bjk,fbk->fbi", above, axes[:2], basis[:, :2, :3, 3])
    assert np.allclose(local.locations[:, :2], wanted)
    assert np.allclose(local.locations[:, 2], basis[:, 2, :3, 3])


def test_scale_moves_children_but_turns_nothing(limb):
    skeleton, rest = limb
    basis = np.tile(np.eye(4), (1, 3, 1, 1))
    basis[0, 0, :3, :3] *= 2
    motion = posed_motion(skeleton, rest, basis)
    assert np.allclose(motion.turns, np.eye(3))
    assert np.allclose(motion.heads[0] - motion.heads[0, 0], 2 * (skeleton.heads - skeleton.heads[0]))
    assert np.allclose(motion.slides, 0)


def test_tails_are_where_the_children_of_connected_bones_are(limb):
    skeleton, rest = limb
    connected = Skeleton(skeleton.parents, skeleton.heads, np.concatenate([skeleton.heads[1:], skeleton.tails[2:]]))
    basis = basis_of(np.random.default_rng(4))
    basis[:, 1:, :3, 3] = 0
    motion = posed_motion(connected, rest, basis)
    assert np.allclose(motion.tails[:, :2], motion.heads[:, 1:])


def test_what_is_no_motion_of_the_skeleton_is_refused(limb):
    with pytest.raises(RigError, match="needs a rotation and a place"):
        Motion(limb[0], np.tile(np.eye(3), (2, 4, 1, 1)), np.zeros((2, 4, 3)))
    turns, heads = np.tile(np.eye(3), (2, 3, 1, 1)), np.zeros((2, 3, 3))
    with pytest.raises(RigError, match="needs a rotation and a place"):
        Motion(limb[0], turns, heads, heads[:, :2])
    for places in ((heads + np.nan, None), (heads, heads + np.nan)):
        with pytest.raises(RigError, match="not finite"):
            Motion(limb[0], turns, *places)


def test_moved_as_a_whole_ends_of_bones_move_with_it_and_bones_turn():
    skeleton = Skeleton(np.array([-1, 0]), np.array([[0.0, 0, 0], [0, 0, 1]]), np.array([[0.0, 0, 1], [0, 0, 3]]))
    turns = np.stack([[np.eye(3), rotation([0, 1, 0], 0.4)], [rotation([1, 0, 0], 0.2)] * 2])
    slides = np.tile([[0.0, 0, 0], [0.1, 0, 0]], (2, 1, 1))
    motion = Motion(skeleton, turns, np.tile(skeleton.heads, (2, 1, 1)), slides)
    transforms = np.tile(np.eye(4), (2, 1, 1))
    transforms[1, :3, :3], transforms[1, :3, 3] = 2 * rotation([0, 0, 1], 0.7), (1, 2, 3)
    moved = motion.moved(transforms)
    np.testing.assert_allclose(moved.turns[0], motion.turns[0])
    np.testing.assert_allclose(moved.heads[1], motion.heads[1] @ transforms[1, :3, :3].T + (1, 2, 3))
    np.testing.assert_allclose(moved.turns[1], rotation([0, 0, 1], 0.7) @ motion.turns[1], atol=1e-12)
    np.testing.assert_allclose(moved.slides[1], slides[1] @ transforms[1, :3, :3].T)


def test_motions_are_joined(limb):
    skeleton, rest = limb
    motion = posed_motion(skeleton, rest, basis_of(np.random.default_rng(3)))
    still = Motion(skeleton, motion.turns[:1], motion.heads[:1])
    joined = Motion.joined([motion, still])
    assert np.array_equal(joined.heads, motion.heads[[0, 1, 2, 3, 0]])
    assert np.array_equal(joined.slides, [*motion.slides, np.zeros((3, 3))])
