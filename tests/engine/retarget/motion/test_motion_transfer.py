# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion that goes from one rig to another: the mesh ends up where the truth is."""

from itertools import pairwise

import numpy as np
import pytest

from engine import BonePairing, Motion, MotionSettings, RigError, Skeleton, transfer_motion
from engine.retarget.motion.motion_transfer import _smoothed
from tests.people import HANGING, at_rest_in, coarse_rig, fine_rig, moved, renamed, skinned, walk
from tests.shapes import rotation


@pytest.fixture(scope="module")
def wild(someone):
    """Random turns of all bones, and a random way."""
    random = np.random.default_rng(1)
    angles = {name: 0.3 * random.normal(size=(3, 3)) for name in someone.rig.names}
    return moved(someone.rig, angles, random.normal(size=(3, 3)))


def error(someone, body, rig, motion, found):
    """Mean distance of the vertices from where the plain rig takes them, by the height."""
    apart = skinned(body.mesh.vertices, rig, found.motion) - someone.posed(motion)
    return np.linalg.norm(apart, axis=2).mean() / someone.height


def test_with_other_names_and_another_order_every_vertex_is_where_it_was(someone, paired, wild):
    rig = renamed(someone.rig)
    found = transfer_motion(wild, paired(someone, rig), rig.skeleton)
    assert error(someone, someone, rig, wild, found) < 1e-6
    assert np.isclose(found.scale, 1)
    assert found.moved.all()
    assert found.placed.sum() == 1


@pytest.mark.parametrize(("make", "most"), [(fine_rig, 0.004), (coarse_rig, 0.01)])
def test_with_more_or_fewer_bones_the_body_is_nearly_there(someone, paired, wild, make, most):
    rig = make(someone)
    assert error(someone, someone, rig, wild, transfer_motion(wild, paired(someone, rig), rig.skeleton)) < most


def test_another_rest_pose_makes_no_difference(someone, paired, wild):
    body = at_rest_in(someone, HANGING)
    rig = renamed(body.rig)
    found = transfer_motion(wild, paired(body, rig), rig.skeleton)
    assert error(someone, body, rig, wild, found) < 0.01


def test_a_target_of_other_size_that_faces_elsewhere_goes_its_way(someone, paired, wild):
    pairing, turn = paired(someone, someone.rig), rotation([0, 0, 1], np.pi / 2)
    tree = someone.rig.skeleton
    large = Skeleton(tree.parents, 3 * tree.heads @ turn.T, 3 * tree.tails @ turn.T)
    rotations = turn @ pairing.rotations
    pairing = BonePairing(
        pairing.sources, pairing.targets, pairing.scores, rotations, 3 * pairing.places @ turn.T, turn
    )
    found = transfer_motion(wild, pairing, large)
    assert np.isclose(found.scale, 3)
    assert np.allclose(found.motion.heads, 3 * wild.heads @ turn.T, atol=1e-4)
    assert np.allclose(found.motion.turns, turn @ wild.turns @ turn.T, atol=1e-6)


def test_of_a_single_pair_the_lengths_of_the_bones_count():
    """Such as of balls and doors."""
    source, target = (Skeleton(np.array([-1]), np.zeros((1, 3)), np.array([[0, 0, size]])) for size in (100.0, 1.0))
    way = np.array([[[0.0, 0, 0]], [[50, 0, 0]]])
    motion = Motion(source, np.tile(np.eye(3), (2, 1, 1, 1)), way)
    none, same = np.zeros(1, np.int64), np.eye(3)[None]
    found = transfer_motion(motion, BonePairing(none, none, np.ones(1), same, target.heads, np.eye(3)), target)
    assert np.isclose(found.scale, 0.01)
    assert np.allclose(found.motion.heads, way / 100)


@pytest.fixture(scope="module")
def stretchy(someone):
    """Random turns, and a head, a forearm and a toe that are moved on what they hang on."""
    random = np.random.default_rng(2)
    angles = {name: 0.3 * random.normal(size=(4, 3)) for name in someone.rig.names}
    slides = {name: 0.1 * random.normal(size=(4, 3)) for name in ("head", "forearm.L", "toe.R")}
    return moved(someone.rig, angles, random.normal(size=(4, 3)), slides)


def test_what_is_moved_on_what_it_hangs_on_is_moved_so(someone, paired, stretchy):
    rig = renamed(someone.rig)
    found = transfer_motion(stretchy, paired(someone, rig), rig.skeleton)
    assert error(someone, someone, rig, stretchy, found) < 1e-6
    assert np.allclose(np.sort(found.motion.heads, axis=1), np.sort(stretchy.heads, axis=1))
    origins = [rig.origins[bone] for bone in np.flatnonzero(found.placed & ~found.rooted)]
    assert set(origins) == {frozenset([name]) for name in ("head", "forearm.L", "toe.R")}
    assert not found.fixed.any()
    connected = np.array([origin == {"head"} for origin in rig.origins])
    held = transfer_motion(stretchy, paired(someone, rig), rig.skeleton, connected=connected)
    assert np.array_equal(held.fixed, connected)
    assert np.array_equal(held.placed, found.placed & ~connected)
    assert np.allclose(held.motion.heads[:, ~connected], found.motion.heads[:, ~connected])
    neck = rig.skeleton.parents[connected]
    spans = [each.heads[:, connected] - each.heads[:, neck] for each in (held.motion, found.motion)]
    rest = np.linalg.norm(rig.skeleton.heads[connected] - rig.skeleton.heads[neck])
    assert np.allclose(np.linalg.norm(spans[0], axis=-1), rest)
    assert np.ptp(np.linalg.norm(spans[1], axis=-1)) > 0.01


@pytest.mark.parametrize(("make", "most"), [(fine_rig, 0.004), (coarse_rig, 0.012)])
def test_with_more_or_fewer_bones_what_slides_is_nearly_there(someone, paired, stretchy, make, most):
    rig = make(someone)
    still = Motion(stretchy.skeleton, stretchy.turns, stretchy.heads)
    errors = [
        error(someone, someone, rig, stretchy, transfer_motion(motion, paired(someone, rig), rig.skeleton))
        for motion in (stretchy, still)
    ]
    assert errors[0] < most
    assert errors[1] > errors[0] + 0.005


def test_what_slides_does_so_in_units_of_what_is_around(someone, stretchy):
    """A jaw goes as far as the head is large, however long the legs are."""
    tree, numbers = someone.rig.skeleton, np.arange(len(someone.rig.names))
    knees = [0.0, 0.92, 2.0], [0.0, 1.84, 2.92]  # heights of soles, hips, heads
    ends = [np.c_[points[:, :2], np.interp(points[:, 2], *knees)] for points in (tree.heads, tree.tails)]
    target, same = Skeleton(tree.parents, *ends), np.tile(np.eye(3), (len(tree), 1, 1))
    pairing = BonePairing(numbers, numbers, np.ones(len(tree)), same, target.heads, np.eye(3))
    found = transfer_motion(stretchy, pairing, target, MotionSettings(feet=True, in_place=True))
    assert found.scale > 1.5
    for bone, above in (("forearm.L", "upper_arm.L"), ("head", "neck")):
        ways = [
            each.heads[:, someone.rig.names.index(bone)] - each.heads[:, someone.rig.names.index(above)]
            for each in (found.motion, stretchy)
        ]
        assert np.allclose(*ways)


def slide(heads, standing):
    """How far feet move at most while they stand."""
    starts = np.flatnonzero(np.append(True, standing[1:] != standing[:-1]))
    runs = zip(starts, np.append(starts[1:], len(standing)), strict=True)
    return max(np.ptp(heads[a:b, standing[a]], axis=0).max() for a, b in runs if b - a > 3)


def stretched(person, legs=1.3):
    """The person's bones with longer legs, and pairs of all."""
    tree = person.rig.skeleton
    lengthen = [points * [1, 1, legs] for points in (tree.heads, tree.tails)]
    target = Skeleton(tree.parents, *lengthen)
    numbers = np.arange(len(tree))
    same = np.tile(np.eye(3), (len(tree), 1, 1))
    return target, BonePairing(numbers, numbers, np.ones(len(tree)), same, target.heads, np.eye(3))


def test_feet_do_not_slide_on_longer_legs(someone):
    motion, sides = walk(someone)
    standing = np.array([someone.rig.names.index(f"toe.{side}") for side in sides])
    target, pairing = stretched(someone)
    settings = {"rate": 24.0}
    assert slide(motion.heads, standing) < 1e-9
    free = transfer_motion(motion, pairing, target, MotionSettings(**settings))
    held = transfer_motion(motion, pairing, target, MotionSettings(feet=True, **settings))
    assert slide(free.motion.heads, standing) > 0.002
    assert slide(held.motion.heads, standing) < 0.001
    toes = held.motion.heads[np.arange(len(motion)), standing, 2]
    assert np.ptp(toes) < 0.005  # they stay on the ground as well
    lengths = np.linalg.norm(target.tails - target.heads, axis=1)
    assert np.allclose(np.linalg.norm(held.motion.tails - held.motion.heads, axis=2), lengths)


def test_the_foot_that_carries_is_on_the_ground_whatever_the_legs_are_like(someone):
    motion, sides = walk(someone)
    tree, numbers = someone.rig.skeleton, np.arange(len(someone.rig.names))
    knees = [0.0, 0.1, 0.5, 0.92, 2.0], [0.0, 0.1, 0.25, 0.92, 2.0]  # heights of soles, ankles, knees, hips, heads
    ends = [np.c_[points[:, :2], np.interp(points[:, 2], *knees)] for points in (tree.heads, tree.tails)]
    target = Skeleton(tree.parents, *ends)
    same = np.tile(np.eye(3), (len(tree), 1, 1))
    pairing = BonePairing(numbers, numbers, np.ones(len(tree)), same, target.heads, np.eye(3))
    standing = np.array([someone.rig.names.index(f"toe.{side}") for side in sides])
    found = transfer_motion(motion, pairing, target)
    toes = found.motion.heads[np.arange(len(motion)), standing, 2]
    assert np.abs(toes - target.heads[standing, 2]).max() < 0.01
    large = Skeleton(tree.parents, *(100 * each for each in ends))
    scaled = BonePairing(numbers, numbers, np.ones(len(tree)), same, large.heads, np.eye(3))
    giant = Motion(Skeleton(tree.parents, 100 * tree.heads, 100 * tree.tails), motion.turns, 100 * motion.heads)
    for feet in (False, True):
        settings = MotionSettings(feet=feet)
        one, other, same_again = (
            transfer_motion(*each, settings).motion.heads
            for each in ((motion, pairing, target), (motion, scaled, large), (giant, pairing, target))
        )
        np.testing.assert_allclose(other, 100 * one, atol=1e-6)
        np.testing.assert_allclose(same_again, one, atol=1e-8)
    # Far above the ground there is nothing to stand on.
    plain, above = (
        transfer_motion(Motion(tree, motion.turns, motion.heads + up), pairing, target).motion.heads
        for up in np.array([[0, 0, 1], [0, 0, 2]])
    )
    assert np.allclose(above - plain, [0, 0, found.scale])


def test_feet_that_stand_already_are_left_alone(someone):
    motion, _ = walk(someone)
    _, pairing = stretched(someone, 1.0)
    tree = someone.rig.skeleton
    found = transfer_motion(motion, pairing, tree, MotionSettings(feet=True))
    assert np.abs(found.motion.heads - motion.heads).max() < 0.005


def test_stride_and_place(someone):
    motion, _ = walk(someone)
    _, pairing = stretched(someone, 1.0)
    tree = someone.rig.skeleton
    ways = {}
    for name, settings in {"usual": {}, "half": {"stride": 0.5}, "none": {"in_place": True}}.items():
        heads = transfer_motion(motion, pairing, tree, MotionSettings(**settings)).motion.heads[:, 0]
        ways[name] = heads[-1] - heads[0]
    assert np.allclose(ways["half"][:2], ways["usual"][:2] / 2)
    assert np.allclose(ways["none"][:2], 0, atol=1e-9)
    assert np.allclose([way[2] for way in ways.values()], ways["usual"][2])


def test_the_way_is_taken_out_evenly_in_time(someone):
    """Poses lie close together around keys, and keys do not lie evenly."""
    times = np.array([-0.01, 0, 0.01, 0.19, 0.2, 0.21, 0.99, 1, 1.01])
    motion = moved(someone.rig, {"head": np.zeros((len(times), 3))}, np.outer(times, [2.0, 1, 0]) + np.ones(3))
    _, pairing = stretched(someone, 1.0)
    settings, tree = MotionSettings(in_place=True), someone.rig.skeleton
    heads = transfer_motion(motion, pairing, tree, settings, times=times).motion.heads
    assert np.allclose(heads, heads[1], atol=1e-9)
    with pytest.raises(RigError, match="a time for each of the 9 poses"):
        transfer_motion(motion, pairing, tree, settings, times=times[1:])


def test_hands_on_the_body_stay_on_it_with_longer_arms(someone):
    names, tree = list(someone.rig.names), someone.rig.skeleton
    # Both hands on the hips.
    angles = {}
    for side, sign in (("L", 1), ("R", -1)):
        angles[f"upper_arm.{side}"] = [[0, 0.7 * sign, 0]]
        angles[f"forearm.{side}"] = [[0, 1.6 * sign, 0]]
    motion = moved(someone.rig, angles)
    wide = Skeleton(tree.parents, tree.heads * [1.3, 1, 1], tree.tails * [1.3, 1, 1])
    numbers = np.arange(len(tree))
    same = np.tile(np.eye(3), (len(tree), 1, 1))
    pairing = BonePairing(numbers, numbers, np.ones(len(tree)), same, wide.heads, np.eye(3))
    hand = names.index("hand.L")
    middle = names.index("hips")
    wanted = motion.heads[0, hand] - motion.heads[0, middle]
    errors = []
    for hands in (False, True):
        heads = transfer_motion(motion, pairing, wide, MotionSettings(hands=hands)).motion.heads[0]
        errors.append(np.linalg.norm(heads[hand] - heads[middle] - wanted))
    assert errors[1] < 0.5 * errors[0]


def test_what_makes_no_motion_is_refused(someone, wild):
    tree = someone.rig.skeleton
    _, pairing = stretched(someone)
    none = np.zeros(0, int)
    empty = BonePairing(none, none, np.zeros(0), np.zeros((0, 3, 3)), np.zeros((0, 3)), np.eye(3))
    with pytest.raises(RigError, match="No bones of the two rigs are paired"):
        transfer_motion(wild, empty, tree)
    with pytest.raises(RigError, match="name bones that the rigs do not have"):
        transfer_motion(wild, pairing, Skeleton(tree.parents[:3], tree.heads[:3], tree.tails[:3]))
    with pytest.raises(RigError, match="frame rate"):
        transfer_motion(wild, pairing, tree, MotionSettings(rate=0))
    with pytest.raises(RigError, match="away from the ground has no length"):
        transfer_motion(wild, pairing, tree, ups=np.zeros((2, 3)))
    with pytest.raises(RigError, match="cannot be said by 2 values"):
        transfer_motion(wild, pairing, tree, connected=np.ones(2, bool))


def four_legged(chest=1.0, heels=0.0, bend=0.08):
    """Bones of an animal: height of its chest, of its hind feet above the ground, and how far its elbows bend."""
    bones = [(-1, (0, 0.0, 1.0), (0, 0.6, (1.0 + chest) / 2)), (0, (0, 0.6, (1.0 + chest) / 2), (0, 1.2, chest))]
    bones.append((1, (0, 1.2, chest), (0, 1.7, chest + 0.4)))
    for trunk, y, top, low, out in ((0, 0.0, 1.0, heels, 0.08), (1, 1.2, chest, 0.0, bend)):
        for x in (-0.2, 0.2):
            above = trunk
            knee, ankle = low + 0.55 * (top - low), low + 0.1
            ends = [(x, y, top), (x, y + out, knee), (x, y, ankle), (x, y + 0.15, low)]
            for head, tail in pairwise(ends):
                bones.append((above, head, tail))
                above = len(bones) - 1
    parents, heads, tails = (np.array(column) for column in zip(*bones, strict=True))
    return Skeleton(parents, heads.astype(float), tails.astype(float))


def test_each_foot_stands_at_its_own_height():
    """The target rests with bent elbows, so that what lies as the source's does takes its fore feet down."""
    source, target = four_legged(), four_legged(1.1, heels=0.06, bend=0.4)
    numbers = np.arange(len(source))
    # At rest each bone of the target is turned in the plane of the body from its partner.
    angles = [np.arctan2(*(tree.tails - tree.heads)[:, :0:-1].T) for tree in (source, target)]
    turns = np.stack([rotation([1, 0, 0], angle) for angle in angles[1] - angles[0]])
    pairing = BonePairing(numbers, numbers, np.ones(len(source)), turns, target.heads, np.eye(3))
    motion = Motion(source, np.tile(np.eye(3), (24, len(source), 1, 1)), np.tile(source.heads, (24, 1, 1)))
    toes = [5, 8, 11, 14]
    free = transfer_motion(motion, pairing, target, MotionSettings())
    held = transfer_motion(motion, pairing, target, MotionSettings(feet=True))
    wanted = target.tails[toes, 2]
    assert np.ptp(wanted) > 0.05
    assert np.ptp(free.motion.tails[:, toes, 2] - wanted, axis=1).min() > 0.1
    assert np.abs(held.motion.tails[:, toes, 2] - wanted).max() < 0.01


@pytest.mark.parametrize("rate", [24.0, 60.0, 240.0])
def test_the_body_goes_down_before_a_leg_is_too_short_and_not_at_once(rate):
    """A tenth of a second before it has to be down it begins to, and not more than two."""
    times = np.arange(round(3 * rate)) / rate
    drops = np.where(abs(times - 1.5) < 0.01, 1.0, 0.0)
    lower = _smoothed(drops, rate)
    assert (lower >= drops - 1e-9).all()
    assert abs(np.diff(lower)).max() < 1.1 / (0.2 * rate)
    assert np.allclose(lower[abs(times - 1.5) > 0.25], 0)
    assert (lower[abs(times - 1.5) < 0.1] > 0.4).all()


def test_where_the_body_has_to_be_lower_all_the_time_it_is_so_from_the_first_pose_to_the_last():
    assert np.allclose(_smoothed(np.full(10, 0.3), 24.0), 0.3)
    falling = np.linspace(1, 0, 48)
    assert (_smoothed(falling, 24.0) >= falling - 1e-9).all()
