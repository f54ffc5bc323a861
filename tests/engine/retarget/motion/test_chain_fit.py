# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones that do together what others do: all they carry lies where the source has it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine import Skeleton
from engine.retarget.motion import chain_fit
from engine.retarget.motion.bone_pairing import BonePairing
from engine.retarget.motion.chain_fit import fitted_chains
from engine.retarget.motion.limbs import limbs_of
from engine.retarget.motion.segments import Segments

UP = np.array([0.0, 0, 1])


def column(joints):
    """Bones in a row on the z axis, between heights."""
    joints = np.array(joints, float)[:, None] * UP
    return Skeleton(np.arange(-1, len(joints) - 2), joints[:-1], joints[1:])


def paired(sources, targets, source, target, rests=None, *, arms=False):
    """Pairs of bones, whose joints lie in the target where they are in the source, and the chains that they make."""
    sources, targets = np.array(sources), np.array(targets)
    rests = np.tile(np.eye(3), (len(sources), 1, 1)) if rests is None else rests
    pairing = BonePairing(sources, targets, np.ones(len(sources)), rests, source.heads[sources], np.eye(3))
    segments = Segments.of(sources, targets, source, target)
    arms = limbs_of(segments, source, target, np.array([UP, UP])) if arms else []
    return fitted_chains(pairing, rests, segments, (source, target), target.parents, arms=arms)


def turned(chains, turns, count):
    """Turns of all bones of the target, of which those without partners stay as they are."""
    result = np.tile(np.eye(3), (len(turns), count, 1, 1))
    for chain in chains:
        result[:, chain.bones] = chain.turns(turns)
    return result


def posed(tree, turns):
    """Heads of all bones (f, b, 3), and tails, if each turns so, and the first one's stays where it is."""
    heads = np.tile(tree.heads, (len(turns), 1, 1))
    for bone in tree.order:
        parent = tree.parents[bone]
        if parent >= 0:
            heads[:, bone] = heads[:, parent] + turns[:, parent] @ (tree.heads[bone] - tree.heads[parent])
    return heads, heads + np.einsum("fbij,bj->fbi", turns, tree.tails - tree.heads)


def bends(seed, frames, bones, size=0.3):
    """Turns (f, b, 3, 3) of bones in a row, each against the one before."""
    vectors = size * np.random.default_rng(seed).normal(size=(bones, frames, 3))
    found = [np.eye(3)]
    for each in vectors:
        found.append(found[-1] @ Rotation.from_rotvec(each).as_matrix())
    return np.stack(found[1:], axis=1)


def shoulders():
    """A back, a chest with two collar bones, and two arms and a neck that hang on them."""
    joints = {
        "back": (-1, (0, 0, 0), (0, 0, 1)),
        "chest": (0, (0, 0, 1), (0, 0, 2)),
        "left collar": (1, (0.1, 0, 1.8), (0.8, 0, 1.8)),
        "left arm": (2, (0.8, 0, 1.8), (2.5, 0, 1.8)),
        "right collar": (1, (-0.1, 0, 1.8), (-0.8, 0, 1.8)),
        "right arm": (4, (-0.8, 0, 1.8), (-2.5, 0, 1.8)),
        "neck": (1, (0, 0, 2), (0, 0, 2.6)),
    }
    return Skeleton(*(np.array(column) for column in zip(*joints.values(), strict=True)))


def test_one_bone_that_stands_for_one_turns_as_it_does_whatever_hangs_on_it():
    tree, turns = shoulders(), bends(0, 4, 7)
    rests = Rotation.random(7, random_state=1).as_matrix()
    found = turned(paired(range(7), range(7), tree, tree, rests), turns, 7)
    assert np.allclose(found, turns @ np.swapaxes(rests, 1, 2))


def test_two_bones_that_stand_for_one_turn_as_it_does():
    source, target = column([0, 1, 2]), column([0, 0.4, 1, 2])
    turns = bends(2, 5, 2)
    found = turned(paired([0, 0, 1], [0, 1, 2], source, target), turns, 3)
    assert np.allclose(found, turns[:, [0, 0, 1]])


@pytest.mark.parametrize(("joints", "pairs"), [([0, 1.5, 3], [0, 1, 1]), ([0, 0.6, 1.2, 1.8, 2.4, 3], [0, 0, 1, 2, 2])])
def test_a_chain_of_another_number_of_bones_holds_what_hangs_on_it_where_the_source_does(joints, pairs):
    source, target = column([0, 1, 2, 3, 4]), column([*joints, 4])
    fewer = len(pairs) == 3
    chain = (range(3), pairs) if fewer else (pairs, range(5))
    pairs = [*chain[0], 3], [*chain[1], len(joints) - 1]
    turns = bends(3, 6, 4)
    found = turned(paired(*pairs, source, target), turns, len(target))
    ends = posed(source, turns)[0][:, 3], posed(target, found)[0][:, -1]
    partner = dict(zip(pairs[1], pairs[0], strict=True))
    copies = turns[:, [partner[bone] for bone in range(len(target))]]
    apart = np.linalg.norm(ends[1] - ends[0], axis=1)
    copied = np.linalg.norm(posed(target, copies)[0][:, -1] - ends[0], axis=1)
    assert apart.mean() < 0.3 * copied.mean()
    assert np.allclose(found[:, -1], turns[:, 3])  # and what hangs there turns as it did


def test_a_chest_without_collar_bones_holds_the_arms_where_these_would():
    source, tree = shoulders(), shoulders()
    kept = [0, 1, 3, 5, 6]
    target = Skeleton(np.array([-1, 0, 1, 1, 1]), tree.heads[kept], tree.tails[kept])
    turns = np.tile(np.eye(3), (1, 7, 1, 1))
    turns[0, 2:4] = Rotation.from_rotvec([0, -0.5, 0]).as_matrix()  # one shoulder is raised
    found = turned(paired(kept, range(5), source, target), turns, 5)
    wanted = posed(source, turns)[0][:, kept]
    apart, stiff = (np.linalg.norm(posed(target, each)[0] - wanted, axis=2)[0] for each in (found, turns[:, kept]))
    assert np.allclose(found[:, [0, 2, 3, 4]], turns[:, [0, 3, 5, 6]])
    assert np.square(apart[2:]).sum() < 0.8 * np.square(stiff[2:]).sum()
    # Whatever the chest is turned further, no sum of squares is less, each by what hangs there.
    masses = np.array([1.7, 1.7, 0.6])
    for vector in 0.1 * np.random.default_rng(4).normal(size=(20, 3)):
        other = found.copy()
        other[:, 1] = Rotation.from_rotvec(vector).as_matrix() @ other[:, 1]
        away = np.linalg.norm(posed(target, other)[0] - wanted, axis=2)[0]
        own = np.linalg.norm(vector) ** 2 / 3  # the chest itself, which is turned away from the source's
        assert masses @ np.square(away[2:]) + own > masses @ np.square(apart[2:]) - 1e-9


def test_fits_do_not_depend_on_units_and_on_how_the_rigs_stand():
    source, target = column([0, 1, 2, 3]), column([0, 1.5, 3])
    pairs, turns = ([0, 1, 2], [0, 1, 1]), bends(5, 3, 3)
    found = turned(paired(*pairs, source, target), turns, 2)
    turn = Rotation.from_rotvec([0.3, -1, 2]).as_matrix()
    large = [Skeleton(tree.parents, 1e3 * tree.heads @ turn.T, 1e3 * tree.tails @ turn.T) for tree in (source, target)]
    other = turned(paired(*pairs, *large), turn @ turns @ turn.T, 2)
    assert np.allclose(other, turn @ found @ turn.T, atol=1e-6)


def test_every_paired_bone_is_in_one_chain():
    """Also where one bone of the source stands for two that do not hang on one another."""
    source, target = column([0, 1, 2]), shoulders()
    chains = paired([0, 1, 1, 1], [0, 3, 5, 6], source, target)
    assert sorted(bone for chain in chains for bone in chain.bones.tolist()) == [0, 3, 5, 6]
    whole = np.tile(Rotation.random(1, random_state=6).as_matrix(), (1, 2, 1, 1))
    assert np.allclose(turned(chains, whole, 7)[:, [0, 3, 5, 6]], whole[:, :1])  # what turns as a whole does so here


def test_a_foot_that_hangs_on_nothing_in_the_source_hangs_on_the_leg():
    """As where a solver moves it: it turns by itself, and takes no part of the leg along."""
    legs, target = column([0, 1, 2, 3]), column([0, 1, 2.4, 2.7, 3])
    source = Skeleton(np.array([-1, 0, -1]), legs.heads, legs.tails)
    turns = bends(7, 3, 3)
    found = turned(paired([0, 1, 2, 2], [0, 1, 2, 3], source, target), turns, 4)
    held = turned(paired([0, 1, 2, 2], [0, 1, 2, 3], legs, target), turns, 4)
    assert np.allclose(found, held)


def test_what_hangs_elsewhere_in_the_source_weighs_all_the_same():
    """A chest that carries arms as well is turned less for the neck, also if those hang on the back in the source."""
    heads = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0.3, 2.3], [0.8, 0, 1.8], [-0.8, 0, 1.8]])
    tails = np.array([[0, 0, 1], [0, 0, 2], [0, 0.3, 2.3], [0, 0.4, 3.0], [2.5, 0, 1.8], [-2.5, 0, 1.8]])
    source = Skeleton(np.array([-1, 0, 1, 2, 0, 0]), heads, tails)  # its nape has no partner
    kept = [0, 1, 3, 4, 5]
    target = Skeleton(np.array([-1, 0, 1, 1, 1]), heads[kept], tails[kept])
    turns = np.tile(np.eye(3), (1, 6, 1, 1))
    turns[0, 2:4] = Rotation.from_rotvec([0.6, 0, 0]).as_matrix()
    angles = [
        Rotation.from_matrix(turned(paired(kept[:count], range(count), source, target), turns, 5)[0, 1]).magnitude()
        for count in (3, 5)
    ]
    assert angles[0] > 1.5 * angles[1] > 0


def test_where_the_target_has_a_bone_between_as_well_the_chest_stays():
    source, turns = shoulders(), np.tile(np.eye(3), (1, 7, 1, 1))
    turns[0, 2:4] = Rotation.from_rotvec([0, -0.5, 0]).as_matrix()
    kept = [0, 1, 3, 5, 6]  # collar bones of either have no partners
    assert np.allclose(turned(paired(kept, kept, source, source), turns, 7)[:, 1], turns[:, 1])


def test_bones_that_hang_the_other_way_round_are_fitted_all_the_same():
    source, target = column([0, 1, 2, 3]), column([0, 1, 1.6, 2.2, 3])
    backwards = Skeleton(np.array([1, 2, -1]), source.heads, source.tails)
    turns = bends(8, 2, 3)
    for tree in (source, backwards):
        found = turned(paired([0, 1, 1, 2, 0], [0, 1, 2, 3, 2], tree, target), turns, 4)
        assert np.allclose(found @ np.swapaxes(found, 2, 3), np.eye(3))


def test_an_arm_is_bent_at_the_elbow_wherever_the_map_puts_that():
    """The target has a collar bone, so that its elbow lies elsewhere than that of the source, which has none."""
    joints = np.array([[0, 0, 0], [0.3, 0, 1], [1, 0, 1], [2, 0, 1], [0, 0, 1.2], [0, 0, 1.6]])
    source = Skeleton(np.array([-1, 0, 1, 0]), joints[[0, 1, 2, 4]], joints[[4, 2, 3, 5]])
    other = np.array([[0, 0, 0], [0.1, 0, 1], [0.6, 0, 1], [1.5, 0, 1], [2, 0, 1], [0, 0, 1.2], [0, 0, 1.6]])
    target = Skeleton(np.array([-1, 0, 1, 2, 0]), other[[0, 1, 2, 3, 5]], other[[5, 2, 3, 4, 6]])
    turns, pairs = bends(9, 4, 4), [0, 1, 1, 2, 3]
    bent, loose = (turned(paired(pairs, range(5), source, target, arms=arms), turns, 5) for arms in (True, False))
    assert np.allclose(bent, turns[:, pairs])
    assert not np.allclose(loose, bent)


def test_what_hangs_on_a_chain_weighs_as_much_in_one_bone_as_in_several_side_by_side():
    """Such as the one bone of a mitten, or two that are half as long."""
    source, heights = column([0, 1, 2, 3]), [0, 0.6, 1.2, 2]
    chain, pairs, turns = column(heights), ([0, 0, 1], [0, 1, 2]), bends(11, 6, 3, 0.6)
    found = []
    for count in (1, 2, 3):
        parents = np.append(chain.parents, [2] * count)
        heads, tails = (
            np.concatenate([own, [end * UP] * count]) for own, end in ((chain.heads, 2), (chain.tails, 2 + 1 / count))
        )
        target = Skeleton(parents, heads, tails)
        both = [*pairs[0], *[2] * count], [*pairs[1], *range(3, 3 + count)]
        found.append(turned(paired(*both, source, target), turns, len(target))[:, :3])
    assert not np.allclose(found[0], turns[:, [0, 0, 1]], atol=1e-3)
    assert np.allclose(found[1], found[0])
    assert np.allclose(found[2], found[0])


def test_what_hangs_on_a_chain_weighs_as_much_in_one_bone_as_in_a_row():
    """Such as a hand with a finger, or one that is as long as both."""
    joints, pairs, turns = [0, 0.6, 1.2, 2], ([0, 0, 1, 2], [0, 1, 2, 3]), bends(12, 6, 4, 0.6)
    source, short, long = column([0, 1, 2, 2.5, 3]), column([*joints, 2.5, 3]), column([*joints, 3])
    row = turned(paired([*pairs[0], 3], [*pairs[1], 4], source, short), turns, 5)[:, :3]
    assert np.allclose(turned(paired(*pairs, source, long), turns, 4)[:, :3], row)
    light = turned(paired(*pairs, source, short), turns, 5)[:, :3]  # the finger has no partner
    assert not np.allclose(light, row, atol=1e-3)


def test_the_bones_of_a_chain_have_come_to_rest(monkeypatch):
    source, target, turns = column([0, 1, 2, 3, 4]), column([0, 0.6, 1.2, 1.8, 2.4, 3, 4]), bends(13, 6, 4, 0.6)
    chains = paired([0, 0, 1, 2, 2, 3], range(6), source, target)
    found = turned(chains, turns, 6)
    monkeypatch.setattr(chain_fit, "_ROUNDS", 200)
    ends = [posed(target, each)[0] for each in (found, turned(chains, turns, 6))]
    assert np.linalg.norm(ends[1] - ends[0], axis=2).max() < 0.005 * 4
