# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand of tubes, laid onto one that is bent otherwise."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import Skeleton, TriangleMesh
from engine.mesh.closest_points import ClosestPoints
from engine.retarget.rig.articulated_hand import Hand, HandPose, HandSolver
from engine.retarget.rig.digit_groups import DigitGroup
from tests.messes import together
from tests.shapes import icosphere, rotation

# Forearm, palm, and three digits of two bones each, which spread out from the palm.
SPREAD = np.array([-0.5, 0.0, 0.5])
OUT = np.stack([np.sin(SPREAD), np.zeros(3), np.cos(SPREAD)], axis=1)
WRIST = np.array([0.2, 0.1, 3.0])
HEADS = WRIST + np.concatenate([[[0, 0, -1.0], [0, 0, 0]], 0.4 * OUT, 0.7 * OUT])
TAILS = WRIST + np.concatenate([[[0, 0, 0], [0, 0, 0.3]], 0.7 * OUT, 1.0 * OUT])
PARENTS = np.array([-1, 0, 1, 1, 1, 2, 3, 4])
GROUP = DigitGroup(0, 1, ((2, 5), (3, 6), (4, 7)))
NUMBERS = np.array([0, *GROUP.bones])


@pytest.fixture(scope="module")
def body():
    """An egg around each bone of the skeleton, and which bone moves each vertex."""
    ball, triangles = icosphere(4)
    eggs = []
    for head, tail in zip(HEADS, TAILS, strict=True):
        along = (tail - head) / np.linalg.norm(tail - head)
        across = np.cross(along, [0, 1, 0])
        half = np.linalg.norm(tail - head) / 2
        frame = np.stack([0.07 * across, 0.05 * np.array([0, 1, 0]), 1.1 * half * along])
        eggs.append(((head + tail) / 2 + ball @ frame, triangles[:, ::-1]))
    mesh = TriangleMesh(*together(*eggs))
    if np.linalg.det(mesh.vertices[mesh.triangles] - WRIST).sum() < 0:
        mesh = TriangleMesh(mesh.vertices, mesh.triangles[:, ::-1])
    return mesh, csr_array(np.repeat(np.eye(len(HEADS)), len(ball), axis=0))


def pose_of(turns, scale=1.0, shift=(0.0, 0, 0)):
    """The pose in which some bones are bent, not turned about themselves, in their heads, then all moved."""
    rotations, places = np.tile(np.eye(3), (len(HEADS), 1, 1)), HEADS - WRIST
    for bone in range(1, len(HEADS)):
        parent = PARENTS[bone]
        places[bone] = places[parent] + rotations[parent] @ (HEADS[bone] - HEADS[parent])
        rotations[bone] = rotations[parent] @ rotation(
            np.cross([0, 1, 0], TAILS[bone] - HEADS[bone]), turns.get(bone, 0.0)
        )
    translations = places - np.einsum("bij,bj->bi", rotations, HEADS - WRIST)
    linear = scale * rotations
    unknowns = np.concatenate(
        [linear.transpose(0, 2, 1), (WRIST + scale * translations + np.array(shift))[:, None]], axis=1
    )
    return HandPose(unknowns[NUMBERS], rotations[NUMBERS], np.full(len(NUMBERS), scale))


def posed(body, pose):
    """The body in a pose."""
    mesh, weights = body
    number = np.argsort(NUMBERS)[weights.toarray().argmax(axis=1)]
    ends = np.concatenate([mesh.vertices - WRIST, np.ones((mesh.vertex_count, 1))], axis=1)
    return TriangleMesh(np.einsum("ni,nij->nj", ends, pose.unknowns[number]), mesh.triangles)


def solver_for(body, target, found, scale=1.0):
    mesh, weights = body
    same = ClosestPoints(mesh).at_vertices(mesh.vertices, np.arange(mesh.vertex_count))
    hand = Hand.of(GROUP, mesh, weights, Skeleton(PARENTS, HEADS, TAILS), target, matches=same)
    return hand, HandSolver(hand, scale * hand.length, found)


def apart_at_joints(pose):
    """How far the transforms of neighbours take their joint apart."""
    number = np.argsort(NUMBERS)
    ends = np.concatenate([HEADS - WRIST, np.ones((len(HEADS), 1))], axis=1)[1:]
    child, parent = (np.einsum("bi,bij->bj", ends, pose.unknowns[number[of]]) for of in (np.arange(1, 8), PARENTS[1:]))
    return np.linalg.norm(child - parent, axis=1)


BENT = {2: 0.4, 5: 0.5, 3: 0.2, 6: 0.6, 4: 0.3, 7: 0.3}


def test_the_hand_is_what_its_bones_move(body):
    hand, _ = solver_for(body, body[0], pose_of({}))
    assert len(hand.points) == len(hand.places) == 350
    np.testing.assert_array_equal(hand.numbers, NUMBERS)
    np.testing.assert_allclose(hand.weights.sum(axis=1), 1)
    assert hand.length == pytest.approx(1)
    # Of the forearm what is near to the wrist, half of the hand's length.
    lowest = hand.points[:, 2].min()
    assert -0.5 <= lowest < -0.2


def test_a_body_without_a_hand_has_none(body):
    mesh, weights = body
    nowhere = weights.toarray()
    nowhere[:, 0] = 1
    nowhere[:, 1:] = 0
    same = ClosestPoints(mesh).at_vertices(mesh.vertices + 9, np.arange(mesh.vertex_count))
    far = Skeleton(PARENTS, HEADS + 9, TAILS + 9)
    assert Hand.of(GROUP, mesh, csr_array(nowhere), far, mesh, matches=same) is None


@pytest.mark.parametrize("turns", [{}, BENT])
def test_only_the_true_pose_costs_nothing(body, turns):
    true, wrong = pose_of(turns), pose_of({} if turns else BENT)
    _, solver = solver_for(body, posed(body, true), wrong)
    # Either surface is compared at points of its own.
    assert solver.cost(true) < 0.25 * solver.cost(wrong)


def test_a_hand_that_lies_well_stays(body):
    true = pose_of(BENT, 1.5, [1, 2, 0])
    _, solver = solver_for(body, posed(body, true), true, 1.5)
    found = solver.improved(true, 0.5, 6)
    hand = body[0].vertices[:, 2] > WRIST[2]
    moved = np.linalg.norm(posed(body, found).vertices - posed(body, true).vertices, axis=1)[hand]
    assert moved.mean() < 0.03 * 1.5
    np.testing.assert_allclose(found.scales, 1.5, rtol=0.05)


def test_digits_are_bent_to_where_they_are(body):
    true, rest = pose_of(BENT), pose_of({})
    _, solver = solver_for(body, posed(body, true), rest)
    found = solver.improved(rest, 0.0, 25)
    assert found.cost == pytest.approx(solver.cost(found))
    assert found.cost < 0.3 * solver.cost(rest)
    before, after = (np.linalg.norm(pose.rotations - true.rotations, axis=(1, 2)) for pose in (rest, found))
    assert (after[2:] < 0.6 * before[2:]).all()


def test_joints_hold_together(body):
    true, rest = pose_of(BENT), pose_of({})
    assert apart_at_joints(true).max() < 1e-12
    _, solver = solver_for(body, posed(body, true), rest)
    assert apart_at_joints(solver.improved(rest, 0.0, 10)).max() < 0.02


def test_the_forearm_stays_where_it_was_found(body):
    true, rest = pose_of(BENT), pose_of({})
    _, solver = solver_for(body, posed(body, true), rest)
    found = solver.improved(rest, 0.0, 10)
    np.testing.assert_allclose(found.unknowns[0], rest.unknowns[0], atol=0.02)
