# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import FittedRig, RigError, Skeleton, SurfaceMap, TriangleMesh
from engine.retarget.rig.joint_carriers import carriers_of
from engine.retarget.rig.joint_placement import place_joints, standing
from tests.shapes import creature, rotation
from tests.skeletons import CONTROLS, creature_bones, creature_weights

NAMES, PARENTS, HEADS, TAILS = creature_bones()
NUMBER = {name: number for number, name in enumerate(NAMES)}


@pytest.fixture(scope="module")
def body():
    vertices, triangles, _ = creature(0.0, 7)
    return TriangleMesh(vertices, triangles)


def fitted(body, linear, translations, *, skeleton=None, weights=None):
    """A rig whose bones have such transforms (b, 3, 3) and (b, 3)."""
    skeleton = Skeleton(PARENTS, HEADS, TAILS) if skeleton is None else skeleton
    weights = creature_weights(body.vertices) if weights is None else weights
    left, stretch, right = np.linalg.svd(linear)
    same = SurfaceMap.identity(body)
    turns, scales = left @ right, stretch.mean(axis=1)
    return FittedRig(
        skeleton,
        weights,
        linear,
        translations,
        turns,
        scales,
        body.vertices,
        body.vertices,
        same,
        same,
    )


def everywhere(linear, translation):
    return np.tile(linear, (len(NAMES), 1, 1)), np.tile(translation, (len(NAMES), 1))


def bent(angles):
    """Transforms of the bones if some turn about the y axis through their heads, by chain; and true heads and tails."""
    linear, translations = everywhere(np.eye(3), np.zeros(3))
    for bone, (name, parent) in enumerate(zip(NAMES, PARENTS, strict=True)):
        if parent >= 0:
            linear[bone], translations[bone] = linear[parent], translations[parent]
        if name in angles:
            turn = rotation([0, 1, 0], angles[name])
            linear[bone] = linear[bone] @ turn
            translations[bone] += linear[bone] @ (turn.T @ HEADS[bone] - HEADS[bone])
    return linear, translations


def normals():
    """Directions that are nowhere along a bone."""
    return np.tile([0.1, 1.0, 0.2], (len(NAMES), 1))


def test_a_similarity_carries_all_joints_and_normals_with_it(body):
    linear, shift = 1.7 * rotation([1, 2, 3], 0.8), np.array([3.0, -1.0, 2.0])
    rig = fitted(body, *everywhere(linear, shift))
    placed = place_joints(replace(rig, registered=body.vertices @ linear.T + shift), body, normals())
    np.testing.assert_allclose(placed.heads, HEADS @ linear.T + shift, atol=1e-9)
    np.testing.assert_allclose(placed.tails, TAILS @ linear.T + shift, atol=1e-9)
    np.testing.assert_allclose(placed.rotations, np.tile(linear / 1.7, (len(NAMES), 1, 1)), atol=1e-9)
    axes = (TAILS - HEADS) / np.linalg.norm(TAILS - HEADS, axis=1, keepdims=True)
    across = normals() - (normals() * axes).sum(axis=1, keepdims=True) * axes
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    np.testing.assert_allclose(placed.normals, across @ linear.T / 1.7, atol=1e-9)


def test_a_pose_carries_all_moving_joints_exactly(body):
    linear, translations = bent({"neck": 0.5, "lower front.L": -0.9, "tail": 0.7})
    placed = place_joints(fitted(body, linear, translations), body, normals())
    moving = [bone for bone, name in enumerate(NAMES) if name not in CONTROLS]
    for got, points in ((placed.heads, HEADS), (placed.tails, TAILS)):
        truth = np.einsum("bij,bj->bi", linear, points) + translations
        np.testing.assert_allclose(got[moving], truth[moving], atol=1e-9)
    np.testing.assert_allclose(placed.rotations[moving], linear[moving], atol=1e-9)


def test_bones_that_were_connected_stay_so_when_their_transforms_disagree(body):
    random = np.random.default_rng(4)
    linear, translations = everywhere(np.eye(3), np.zeros(3))
    translations += random.normal(0, 0.05, translations.shape)
    placed = place_joints(fitted(body, linear, translations), body, normals())
    upper, lower = NUMBER["upper front.L"], NUMBER["lower front.L"]
    np.testing.assert_array_equal(placed.tails[upper], placed.heads[lower])
    middle = HEADS[lower] + (translations[upper] + translations[lower]) / 2
    np.testing.assert_allclose(placed.heads[lower], middle, atol=1e-12)


def test_a_control_goes_where_the_bones_around_it_go(body):
    linear, translations = bent({"upper front.L": -0.8, "lower front.L": 0.9})
    placed = place_joints(fitted(body, linear, translations), body, normals())
    lower, control, pole = NUMBER["lower front.L"], NUMBER["target front.L"], NUMBER["pole front.L"]
    np.testing.assert_allclose(placed.heads[control], placed.tails[lower], atol=1e-9)
    np.testing.assert_allclose(placed.rotations[control], linear[lower], atol=1e-9)
    # In front of the knee still.
    knee = placed.heads[lower]
    thigh, shin = placed.heads[NUMBER["upper front.L"]] - knee, placed.tails[lower] - knee
    forward = -(thigh / np.linalg.norm(thigh) + shin / np.linalg.norm(shin))
    away = placed.heads[pole] - knee
    assert away @ forward > 0.9 * np.linalg.norm(away) * np.linalg.norm(forward)


def test_the_root_turns_with_the_whole_body_not_with_a_leg(body):
    linear, translations = bent({"lower front.L": -1.2, "lower front.R": -1.2})
    placed = place_joints(fitted(body, linear, translations), body, normals())
    np.testing.assert_allclose(placed.rotations[NUMBER["root"]], np.eye(3), atol=0.05)


def test_a_root_on_the_ground_stays_there_when_the_legs_are_bent(body):
    crouched = body.vertices * [1, 1, 0.5] + [2, 0, 1]  # all bones stay as they are; only the surface tells
    rig = fitted(body, *everywhere(np.eye(3), np.array([2.0, 0, 1])))
    root = place_joints(replace(rig, registered=crouched), body, normals()).heads[NUMBER["root"]]
    spine = HEADS[NUMBER["spine"]]
    moved, away = spine + np.array([2, 0, 1]), HEADS[NUMBER["root"]] - spine
    down = HEADS[NUMBER["root"]] - body.vertex_areas @ body.vertices / body.area
    down /= np.linalg.norm(down)
    reaches = [((points - start) @ down).max() for points, start in ((body.vertices, spine), (crouched, moved))]
    expected = moved + away + (reaches[1] / reaches[0] - 1) * (away @ down) * down
    np.testing.assert_allclose(root, expected, atol=1e-9)


def test_the_whole_body_is_turned_by_a_frame_if_one_is_near(body):
    turn = rotation([0, 0, 1], 1.0)
    linear, _ = bent({"lower front.L": -1.2})
    rig = fitted(body, turn @ rotation([1, 0, 0], 0.1) @ linear, np.zeros((len(NAMES), 3)))
    np.testing.assert_array_equal(standing(rig, body, np.stack([np.eye(3), turn])), turn)
    far = standing(rig, body, rotation([1, 0, 0], 2.5)[None])
    np.testing.assert_allclose(far, turn @ rotation([1, 0, 0], 0.1), atol=0.05)
    np.testing.assert_array_equal(standing(rig, body), far)


def test_a_bone_without_weights_follows_the_one_above(body):
    parents = np.append(PARENTS, NUMBER["head"])
    skeleton = Skeleton(parents, np.vstack([HEADS, [1.2, 0.0, 0.8]]), np.vstack([TAILS, [1.3, 0.0, 0.9]]))
    weights = creature_weights(body.vertices)
    weights.resize(len(body.vertices), len(parents))
    linear, translations = bent({"head": 0.6})
    linear = np.concatenate([linear, np.eye(3)[None]])
    translations = np.vstack([translations, np.zeros(3)])
    rig = fitted(body, linear, translations, skeleton=skeleton, weights=weights)
    placed = place_joints(rig, body, np.ones((len(parents), 3)))
    head = NUMBER["head"]
    np.testing.assert_allclose(placed.tails[-1], linear[head] @ skeleton.tails[-1] + translations[head], atol=1e-9)
    np.testing.assert_allclose(placed.rotations[-1], linear[head], atol=1e-9)


def test_no_bone_loses_its_length(body):
    linear, translations = everywhere(np.eye(3), np.zeros(3))
    # The lower leg is pulled up until its tail lies at its head.
    lower = NUMBER["lower hind.L"]
    linear[lower] = np.eye(3) - np.outer(*2 * [(TAILS - HEADS)[lower] / np.linalg.norm((TAILS - HEADS)[lower])])
    translations[lower] = HEADS[lower] - linear[lower] @ HEADS[lower]
    rig = fitted(body, linear, translations)
    rotations = rig.rotations.copy()
    rotations[lower] = np.eye(3)
    placed = place_joints(replace(rig, rotations=rotations), body, normals())
    lengths, before = (np.linalg.norm(ends, axis=1) for ends in (placed.tails - placed.heads, TAILS - HEADS))
    assert (lengths > 0.5 * before).all()


def test_units_and_the_order_of_bones_change_nothing(body):
    linear, translations = bent({"neck": 0.5, "upper front.L": 0.8})
    plain = place_joints(fitted(body, linear, translations), body, normals())
    big = TriangleMesh(1000 * body.vertices, body.triangles)
    skeleton = Skeleton(PARENTS, 1000 * HEADS, 1000 * TAILS)
    weights = creature_weights(body.vertices)
    rig = fitted(big, linear, 1000 * translations, skeleton=skeleton, weights=weights)
    np.testing.assert_allclose(place_joints(rig, big, normals()).tails, 1000 * plain.tails, atol=1e-6)
    order = np.random.default_rng(1).permutation(len(NAMES))
    parents = np.where(PARENTS[order] < 0, -1, np.argsort(order)[PARENTS[order]])
    skeleton = Skeleton(parents, HEADS[order], TAILS[order])
    rig = fitted(body, linear[order], translations[order], skeleton=skeleton, weights=weights[:, order])
    np.testing.assert_allclose(place_joints(rig, body, normals()).tails, plain.tails[order], atol=1e-9)


def test_carriers_are_parts_of_one(body):
    carriers = carriers_of(fitted(body, *everywhere(np.eye(3), np.zeros(3))), body)
    np.testing.assert_allclose(carriers.of_places.sum(axis=1), 1)
    np.testing.assert_allclose(carriers.of_turns.sum(axis=1), 1)
    assert not carriers.of_turns[:, ~carriers.moving].any()
    assert carriers.places.max() + 1 == len(carriers.of_places)


def test_arrays_that_do_not_fit_are_refused(body):
    rig = fitted(body, *everywhere(np.eye(3), np.zeros(3)))
    with pytest.raises(RigError, match="one normal each"):
        place_joints(rig, body, normals()[1:])
    with pytest.raises(RigError, match="the body has"):
        place_joints(rig, TriangleMesh(*creature(0.0, 6)[:2]), normals())
    nothing = fitted(body, *everywhere(np.eye(3), np.zeros(3)), weights=0 * creature_weights(body.vertices))
    with pytest.raises(RigError, match="No bone"):
        place_joints(nothing, body, normals())


@pytest.mark.parametrize("length", [1e-3, 0.05])
def test_where_an_importer_ends_a_bone_turns_nothing(body, length):
    random = np.random.default_rng(3)
    linear, translations = bent({"neck": 0.5, "lower front.L": -0.9, "tail": 0.7})
    translations += random.normal(0, 0.01, translations.shape)  # as fitted bones do, they disagree at their joints
    true = place_joints(fitted(body, linear, translations), body, normals())
    ends = random.normal(size=(len(NAMES), 3))  # as glTF files say nothing of where bones end
    ends *= length / np.linalg.norm(ends, axis=1, keepdims=True)
    skeleton = Skeleton(PARENTS, HEADS, HEADS + ends)
    placed = place_joints(fitted(body, linear, translations, skeleton=skeleton), body, ends[:, [1, 2, 0]])
    moving = [bone for bone, name in enumerate(NAMES) if name not in CONTROLS]
    apart = np.einsum("bji,bjk->bik", true.rotations[moving], placed.rotations[moving])
    angles = np.degrees(np.arccos(((np.trace(apart, axis1=1, axis2=2) - 1) / 2).clip(-1, 1)))
    assert angles.max() < 8
    np.testing.assert_allclose(placed.heads[moving], true.heads[moving], atol=0.02)
    np.testing.assert_allclose(np.linalg.norm(placed.tails - placed.heads, axis=1)[moving], length, rtol=1e-6)


def test_seen_in_a_mirror_joints_and_normals_are_mirrored(body):
    linear, translations = bent({"neck": 0.4, "tail": -0.3, "lower hind.L": 0.5})
    flip = rotation([1, 2, 3], 0.1) @ np.diag([1.0, -1.0, 1.0])
    direct = fitted(body, linear, translations)
    mirrored = fitted(body, flip @ linear, translations @ flip.T)
    mirrored = replace(mirrored, registered=direct.registered @ flip.T)
    assert mirrored.handedness == -1
    placed, seen = (place_joints(rig, body, normals()) for rig in (direct, mirrored))
    for ends, others in ((placed.heads, seen.heads), (placed.tails, seen.tails), (placed.normals, seen.normals)):
        np.testing.assert_allclose(others, ends @ flip.T, atol=1e-9)
    np.testing.assert_allclose(seen.rotations, flip @ placed.rotations, atol=1e-9)


def test_seen_in_a_mirror_the_whole_body_may_be_turned_by_a_frame_after_it(body):
    flip = rotation([1, 2, 3], 0.1) @ np.diag([1.0, -1.0, 1.0])
    rig = fitted(body, *everywhere(flip, np.zeros(3)))
    np.testing.assert_allclose(standing(rig, body), flip, atol=1e-9)
    np.testing.assert_array_equal(standing(rig, body, np.eye(3)[None]), np.diag([1.0, -1.0, 1.0]))
