# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import FittedRig, RigError, Skeleton, SurfaceMap, TriangleMesh
from engine.retarget.rig.bone_fit import skinned
from engine.retarget.rig.joint_placement import place_joints
from engine.retarget.rig.rest_pose import RestPose, bend_angles, is_posed, rest_pose, unposed
from tests.shapes import creature, rotation
from tests.skeletons import CONTROLS, creature_bones, creature_weights

NAMES, PARENTS, HEADS, TAILS = creature_bones()
NUMBER = {name: number for number, name in enumerate(NAMES)}
POSE = {"neck": 0.5, "upper front.L": -0.8, "lower front.L": 0.9, "upper hind.R": 0.7, "tail": 0.6}


@pytest.fixture(scope="module")
def body():
    vertices, triangles, _ = creature(0.0, 7)
    return TriangleMesh(vertices, triangles)


def posed_rig(body, angles, turn=None, shift=(0.0, 0.0, 0.0)):
    """The rig of a body whose bones turn about the y axis through their heads, and that is turned as a whole."""
    turn = np.eye(3) if turn is None else turn
    linear, translations = np.tile(turn, (len(NAMES), 1, 1)), np.tile(np.asarray(shift, float), (len(NAMES), 1))
    for bone, (name, parent) in enumerate(zip(NAMES, PARENTS, strict=True)):
        if parent >= 0:
            linear[bone], translations[bone] = linear[parent], translations[parent]
        if name in angles:
            bend = rotation([0, 1, 0], angles[name])
            linear[bone] = linear[bone] @ bend
            translations[bone] += linear[bone] @ (bend.T @ HEADS[bone] - HEADS[bone])
    weights = creature_weights(body.vertices)
    posed = skinned(body.vertices, weights, linear, translations)
    same = SurfaceMap.identity(body)
    skeleton = Skeleton(PARENTS, HEADS, TAILS)
    return FittedRig(skeleton, weights, linear, translations, linear, np.ones(len(NAMES)), posed, posed, same, same)


def placed_joints(body, rig):
    return place_joints(rig, body, np.tile([0.1, 1.0, 0.2], (len(NAMES), 1)), np.eye(3)[None])


def moving(values):
    return values[[bone for bone, name in enumerate(NAMES) if name not in CONTROLS]]


def test_what_skinning_posed_comes_back_to_rest(body):
    rig = posed_rig(body, POSE)
    rest = rest_pose(rig, body, placed_joints(body, rig), np.eye(3)[None])
    np.testing.assert_allclose(unposed(rig.posed, rig.weights, rest), body.vertices, atol=1e-9)
    np.testing.assert_allclose(moving(rest.heads), moving(HEADS), atol=1e-9)
    np.testing.assert_allclose(moving(rest.turns), moving(rig.linear).transpose(0, 2, 1), atol=1e-9)


def test_where_bones_turn_opposite_ways_a_vertex_goes_between_its_images():
    posed, heads = np.array([[0.0, 0, 1], [1.0, 2, 1]]), np.array([[0.5, 0, 0], [1.0, 0, 0]])
    turns = np.stack([np.eye(3), rotation([0, 0, 1], np.pi)])
    vertex = np.array([[0.3, 1.0, 1.5]])
    found = unposed(vertex, csr_array([[0.5, 0.5]]), RestPose(posed_heads=posed, heads=heads, turns=turns))
    images = heads + np.einsum("bij,bj->bi", turns, vertex - posed)
    np.testing.assert_allclose(found, [images.mean(axis=0)], atol=1e-12)


def test_lengths_and_place_are_the_targets_own(body):
    rig = posed_rig(body, POSE, shift=(5, 0, 0))
    placed = placed_joints(body, rig)
    longer = 1.0 + 0.5 * (np.arange(len(NAMES)) == NUMBER["neck"])
    placed.tails[:] = placed.heads + longer[:, None] * (placed.tails - placed.heads)
    placed.heads[NUMBER["head"]] = placed.tails[NUMBER["neck"]]
    rest = rest_pose(rig, body, placed, np.eye(3)[None])
    np.testing.assert_allclose(rest.heads[NUMBER["spine"]], HEADS[NUMBER["spine"]] + [5, 0, 0], atol=1e-9)
    neck = rest.heads[NUMBER["head"]] - rest.heads[NUMBER["neck"]]
    np.testing.assert_allclose(neck, 1.5 * (TAILS - HEADS)[NUMBER["neck"]], atol=1e-9)


def test_a_control_stands_at_its_joint_again(body):
    rig = posed_rig(body, POSE)
    placed = placed_joints(body, rig)
    rest = rest_pose(rig, body, placed, np.eye(3)[None])
    control = NUMBER["target front.L"]
    np.testing.assert_allclose(rest.heads[control], HEADS[control], atol=1e-9)
    direction = rest.turns[control] @ (placed.tails[control] - placed.heads[control])
    np.testing.assert_allclose(direction, TAILS[control] - HEADS[control], atol=1e-9)


def test_the_body_stands_up_on_its_feet(body):
    bent = {name: 0.9 if name.startswith("lower") else -0.7 for name in NAMES if name.startswith(("upper", "lower"))}
    rig = posed_rig(body, bent)
    rest = rest_pose(rig, body, placed_joints(body, rig), np.eye(3)[None])
    standing = unposed(rig.posed, rig.weights, rest)
    lowest = rig.posed[:, 2].min()
    assert lowest > body.vertices[:, 2].min() + 0.1
    shift = (standing - body.vertices).mean(axis=0)
    np.testing.assert_allclose(standing - body.vertices, np.tile(shift, (len(standing), 1)), atol=1e-9)
    np.testing.assert_allclose(standing[:, 2].min(), lowest, atol=0.02)  # the root is not quite below the middle


def test_a_turned_body_stays_turned_unless_it_is_near_a_frame(body):
    turn = rotation([0, 0, 1], 1.2)
    rig = posed_rig(body, POSE, turn=turn)
    placed = placed_joints(body, rig)
    kept = unposed(rig.posed, rig.weights, rest_pose(rig, body, placed, np.stack([np.eye(3), turn])))
    np.testing.assert_allclose(kept, body.vertices @ turn.T, atol=1e-6)


def test_a_pose_is_told_from_a_build(body):
    mild, bent = posed_rig(body, {"neck": 0.3, "tail tip": 0.2}), posed_rig(body, {"lower hind.L": -1.0})
    assert not is_posed(mild, body, placed_joints(body, mild))
    assert is_posed(bent, body, placed_joints(body, bent))
    angles = bend_angles(bent, body, placed_joints(body, bent))
    np.testing.assert_allclose(angles[NUMBER["lower hind.L"]], 1.0, atol=1e-6)
    np.testing.assert_allclose(np.delete(angles, NUMBER["lower hind.L"]), 0, atol=1e-6)


def test_the_angle_of_a_whole_body_is_no_pose(body):
    rig = posed_rig(body, {}, turn=rotation([1, 2, 3], 2.0))
    assert not is_posed(rig, body, placed_joints(body, rig))


def test_vertices_without_weights_stay(body):
    rig = posed_rig(body, POSE)
    rest = rest_pose(rig, body, placed_joints(body, rig), np.eye(3)[None])
    weights = rig.weights.tolil()
    weights[3] = 0
    back = unposed(rig.posed, weights.tocsr(), rest)
    np.testing.assert_array_equal(back[3], rig.posed[3])
    assert np.isfinite(back).all()


def test_opposite_turns_leave_finite_positions(body):
    rig = posed_rig(body, {"lower front.L": np.pi})
    rest = rest_pose(rig, body, placed_joints(body, rig), np.eye(3)[None])
    back = unposed(rig.posed, rig.weights, rest)
    assert np.isfinite(back).all()
    assert np.abs(back).max() < 10


def test_weights_of_another_body_are_refused(body):
    rig = posed_rig(body, POSE)
    rest = rest_pose(rig, body, placed_joints(body, rig), np.eye(3)[None])
    with pytest.raises(RigError, match="Weights of"):
        unposed(rig.posed[1:], rig.weights, rest)


def test_a_foot_that_hangs_on_nothing_goes_with_the_leg(body):
    apart = PARENTS.copy()
    apart[[NUMBER["lower front.L"], NUMBER["lower hind.R"]]] = -1  # as where inverse kinematics move them
    rig = posed_rig(body, POSE)
    rig = replace(rig, skeleton=Skeleton(apart, HEADS, TAILS))
    rest = rest_pose(rig, body, placed_joints(body, rig), np.eye(3)[None])
    lower = [NUMBER["lower front.L"], NUMBER["lower hind.R"]]
    np.testing.assert_allclose(rest.heads[lower], HEADS[lower], atol=0.02)
    np.testing.assert_allclose(unposed(rig.posed, rig.weights, rest), body.vertices, atol=0.03)


def test_seen_in_a_mirror_the_rest_pose_is_that_of_the_mirror_image(body):
    flip = np.diag([1.0, -1.0, 1.0])
    direct = posed_rig(body, POSE)
    moved = {"linear": flip @ direct.linear, "rotations": flip @ direct.rotations}
    seen = {name: getattr(direct, name) @ flip for name in ("translations", "posed", "registered")}
    mirrored = replace(direct, **moved, **seen)
    placed = [placed_joints(body, rig) for rig in (direct, mirrored)]
    assert is_posed(mirrored, body, placed[1])
    np.testing.assert_allclose(
        *(bend_angles(rig, body, at) for rig, at in zip((direct, mirrored), placed, strict=True))
    )
    rests = [rest_pose(rig, body, at, np.eye(3)[None]) for rig, at in zip((direct, mirrored), placed, strict=True)]
    np.testing.assert_allclose(rests[1].heads, rests[0].heads @ flip, atol=1e-9)
    np.testing.assert_allclose(rests[1].turns, flip @ rests[0].turns @ flip, atol=1e-9)
