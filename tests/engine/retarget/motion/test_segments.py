# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones that stand for one another, in groups."""

import numpy as np
import pytest

from engine import Motion, Skeleton
from engine.retarget.motion import segments as segments_module
from engine.retarget.motion.segments import Segments
from tests.shapes import rotation


def tree(parents):
    points = np.zeros((len(parents), 3))
    return Skeleton(np.array(parents), points, points + np.array([0, 0, 1]))


def test_a_chain_of_two_that_stands_for_three_is_one_segment():
    sources, targets = np.array([0, 0, 1, 2]), np.array([0, 1, 1, 3])
    segments = Segments.of(sources, targets, tree([-1, 0, 1]), tree([-1, 0, 1, 2]))
    assert [part.tolist() for part in segments.targets] == [[0, 1], [3]]
    assert [part.tolist() for part in segments.sources] == [[0, 1], [2]]
    assert segments.parents.tolist() == [-1, 0]  # past a bone without a partner
    assert segments.single.tolist() == [False, True]
    assert segments.below(0).tolist() == [1]


def test_what_hangs_elsewhere_in_the_target_is_held_as_in_the_source():
    pairs = np.arange(4)
    normal, detached = tree([-1, 0, 1, 2]), tree([-1, 0, 1, 0])
    segments = Segments.of(pairs, pairs, normal, detached)
    assert segments.parents.tolist() == [-1, 0, 1, 2]
    assert segments.carried.tolist() == [True, True, True, False]
    assert Segments.of(pairs, pairs, detached, normal).carried.all()


def test_a_foot_that_hangs_on_nothing_is_held_by_the_leg_that_ends_in_it():
    # Hips, a leg of two bones and a foot of its own, at the origin, one below, two below and three below.
    parents = [-1, 0, 1, -1]
    heads = np.array([[0.0, 0, -number] for number in range(4)])
    bones = Skeleton(np.array(parents), heads, heads - [0, 0, 1])
    pairs = np.arange(4)
    segments = Segments.of(pairs, pairs, bones, bones)
    angles = np.linspace(0, 1, 5)
    places, turns = np.tile(heads, (5, 1, 1)), np.tile(np.eye(3), (5, 4, 1, 1))
    turns[:, 2] = [[[np.cos(a), 0, -np.sin(a)], [0, 1, 0], [np.sin(a), 0, np.cos(a)]] for a in angles]
    places[:, 3] = places[:, 2] + np.einsum("fij,j->fi", turns[:, 2], heads[3] - heads[2])
    held = segments.held_in(Motion(bones, turns, places))
    assert held.parents.tolist() == [-1, 0, 1, 2]
    assert held.carried.tolist() == [True, True, True, False]
    assert held.above(3) == [2, 1, 0]
    still = Motion(bones, np.tile(np.eye(3), (5, 4, 1, 1)), np.tile(heads, (5, 1, 1)))
    assert segments.held_in(still).parents.tolist() == [-1, 0, 1, -1]
    apart = places.copy()
    apart[:, 3, 0] += np.linspace(0, 2, 5)  # it goes its own way
    assert segments.held_in(Motion(bones, turns, apart)).parents.tolist() == [-1, 0, 1, -1]


def test_hips_that_move_above_a_root_have_a_place_of_their_own():
    parents = [-1, 0, 1, 2]
    heads = np.array([[0.0, 0, number] for number in range(4)])
    bones = Skeleton(np.array(parents), heads, heads + np.array([0, 0, 1]))
    segments = Segments.of(np.arange(4), np.arange(4), bones, bones)
    places, turns = np.tile(heads, (5, 1, 1)), np.tile(np.eye(3), (5, 4, 1, 1))
    assert segments.freed_in(Motion(bones, turns, places)).parents.tolist() == parents
    walking = places + np.linspace(0, 3, 5)[:, None, None] * [0, 1, 0]
    assert segments.freed_in(Motion(bones, turns, walking)).parents.tolist() == parents  # the root walks
    walking[:, 0] = heads[0]
    assert segments.freed_in(Motion(bones, turns, walking)).parents.tolist() == [-1, -1, 1, 2]
    stretched = places.copy()
    stretched[:, 3, 2] += np.linspace(0, 1, 5)  # a part that carries little stays where it hangs
    assert segments.freed_in(Motion(bones, turns, stretched)).parents.tolist() == parents


def test_what_is_moved_on_what_it_hangs_on_slides():
    heads = np.array([[0.0, 0, number] for number in range(5)])
    bones = Skeleton(np.arange(5) - 1, heads, heads + np.array([0, 0, 1]))
    segments = Segments.of(np.array([0, 1, 2, 3, 4]), np.array([0, 1, 1, 1, 2]), bones, tree([-1, 0, 1]))
    turns = np.tile(rotation([1, 0, 0], 0.3), (5, 5, 1, 1))
    places, none = np.tile(heads, (5, 1, 1)), np.zeros((5, 5, 3))
    assert not segments.sliding_in(Motion(bones, turns, places))
    assert not segments.sliding_in(Motion(bones, turns, places, none))
    slides, way = none.copy(), np.linspace(0, 1, 5)[:, None] * [0, 0, 0.5]
    slides[:, 4] = way
    found = segments.sliding_in(Motion(bones, turns, places, slides))
    assert list(found) == [2]
    assert np.allclose(found[2], way)
    # What slides within three bones that stand for one moves what hangs on that, and their first moves that.
    slides[:, 1], slides[:, 2], slides[:, 3] = -way, 2 * way, 3 * way
    found = segments.sliding_in(Motion(bones, turns, places, slides))
    assert np.allclose(found[1], -way)
    assert np.allclose(found[2], 6 * way)
    # A rig that is built otherwise than its rest says, and rounding.
    for still in (np.full((5, 5, 3), 0.2), 1e-6 * slides):
        assert not segments.sliding_in(Motion(bones, turns, places, still))
    assert list(segments.sliding_in(Motion(bones, turns[:1], places[:1], slides[-1:]))) == [1, 2]


def test_without_pairs_there_are_none():
    nothing = np.zeros(0, np.int64)
    assert len(Segments.of(nothing, nothing, tree([-1]), tree([-1]))) == 0


def test_a_chain_that_is_cut_in_other_places_is_one():
    def column(joints):
        points = np.array(joints, float)[:, None] * [0, 0, 1]
        return Skeleton(np.arange(-1, len(joints) - 2), points[:-1], points[1:])

    sources, targets = np.array([0, 1, 2, 3]), np.array([0, 1, 1, 2])
    for joints, expected in (([0, 1, 3, 4], [[0], [1], [2]]), ([0, 1.5, 3, 4], [[0, 1], [2]])):
        source, target = column([0, 1, 2, 3, 4]), column(joints)
        segments = Segments.of(sources, targets, source, target)
        chains = segments.chains(sources, source.heads[sources], target)
        assert [parts for parts, _ in chains] == expected
        assert [bone for _, bones in chains for bone in bones.tolist()] == [0, 1, 2]


def test_bones_of_a_segment_that_hang_on_no_other_of_it():
    sources, targets = np.array([0, 0, 0]), np.array([1, 2, 3])
    segments = Segments.of(sources, targets, tree([-1]), tree([-1, 0, 1, 0]))
    assert segments.tops(0, tree([-1, 0, 1, 0])) == [1, 3]


@pytest.mark.parametrize("flat", [True, False])
def test_work_does_not_grow_with_the_square_of_the_bones(monkeypatch, flat):
    """Rigs of clothes and of faces have hundreds of bones."""
    calls = {np.einsum: 0, segments_module.way_to_root: 0}

    def counted(function):
        def call(*arguments, **names):
            calls[function] += 1
            return function(*arguments, **names)

        return call

    monkeypatch.setattr(segments_module, "way_to_root", counted(segments_module.way_to_root))
    monkeypatch.setattr(np, "einsum", counted(np.einsum))
    count, random = 80, np.random.default_rng(0)
    heads, pairs = random.normal(size=(count, 3)), np.arange(count)
    bones = Skeleton(np.full(count, -1) if flat else np.arange(-1, count - 1), heads, heads + np.array([0, 0, 1]))
    motion = Motion(bones, np.tile(np.eye(3), (3, count, 1, 1)), heads + random.normal(size=(3, count, 3)))
    segments = Segments.of(pairs, pairs, bones, bones).held_in(motion).freed_in(motion)
    assert len(segments) == count
    assert max(calls.values()) < 10 * count
    assert segments.hanging.sum() == sum(len(segments.above(part)) for part in range(count))
