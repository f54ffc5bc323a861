# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from engine import Skeleton
from engine.retarget.rig.bone_fit import fit_bones, skinned
from tests.shapes import creature
from tests.skeletons import CONTROLS, creature_bones, creature_weights


@pytest.fixture(scope="module")
def body():
    names, parents, heads, tails = creature_bones()
    vertices, _, _ = creature(0.0, 7)
    return vertices, creature_weights(vertices), Skeleton(parents, heads, tails), names


def pose(skeleton, angle=0.6, scale=1.0, seed=0):
    """Random transforms of bones that hang together at their joints: linear parts and translations."""
    random = np.random.default_rng(seed)
    count = len(skeleton)
    linear, translations = np.empty((count, 3, 3)), np.empty((count, 3))
    for bone in skeleton.order:
        turn = Rotation.from_rotvec(angle * random.uniform(-1, 1, 3)).as_matrix()
        parent = skeleton.parents[bone]
        head = skeleton.heads[bone]
        linear[bone] = scale * turn if parent < 0 else linear[parent] @ turn
        place = head + np.array([1.0, 2.0, 3.0]) if parent < 0 else linear[parent] @ head + translations[parent]
        translations[bone] = place - linear[bone] @ head
    return linear, translations


@pytest.mark.parametrize("scale", [1.0, 0.01, 40.0])
def test_the_bones_of_a_skinned_body_are_found_again(body, scale):
    vertices, weights, skeleton, names = body
    linear, translations = pose(skeleton, scale=scale)
    positions = skinned(vertices, weights, linear, translations)
    bones = fit_bones(vertices, positions, np.ones(len(vertices)), weights, skeleton)
    moving = np.array([name not in CONTROLS for name in names])
    assert np.abs(bones.posed - positions).max() < 2e-3 * scale
    heads = np.einsum("bij,bj->bi", bones.linear - linear, skeleton.heads) + bones.translations - translations
    assert np.linalg.norm(heads[moving], axis=1).max() < 5e-3 * scale
    turned = Rotation.from_matrix(bones.rotations @ (linear / scale).transpose(0, 2, 1)).magnitude()
    assert turned[moving].max() < np.radians(5)
    np.testing.assert_allclose(bones.scales[moving], scale, rtol=0.02)


def test_it_does_not_matter_where_the_body_is(body):
    vertices, weights, skeleton, _ = body
    positions = skinned(vertices, weights, *pose(skeleton))
    areas = np.ones(len(vertices))
    turn, shift = Rotation.from_rotvec([0.3, 2.0, -1.0]).as_matrix(), np.array([50.0, -20.0, 8.0])
    here = fit_bones(vertices, positions, areas, weights, skeleton)
    moved = Skeleton(skeleton.parents, skeleton.heads @ turn.T + shift, skeleton.tails @ turn.T + shift)
    there = fit_bones(vertices @ turn.T + shift, positions, areas, weights, moved)
    np.testing.assert_allclose(there.posed, here.posed, atol=1e-6)
    np.testing.assert_allclose(there.rotations @ turn, here.rotations, atol=1e-5)


def test_a_bone_that_moves_nothing_follows_the_one_that_it_hangs_on(body):
    vertices, weights, skeleton, names = body
    positions = skinned(vertices, weights, *pose(skeleton))
    without = weights.toarray()
    tip, tail = names.index("tail tip"), names.index("tail")
    without[:, tail] += without[:, tip]
    without[:, tip] = 0
    bones = fit_bones(vertices, positions, np.ones(len(vertices)), csr_array(without), skeleton)
    np.testing.assert_allclose(bones.linear[tip], bones.linear[tail])
    np.testing.assert_allclose(bones.translations[tip], bones.translations[tail])


def test_bones_above_all_others_follow_the_whole_body(body):
    vertices, weights, skeleton, names = body
    shift = np.array([0.0, 0.0, 5.0])
    bones = fit_bones(vertices, 2 * vertices + shift, np.ones(len(vertices)), weights, skeleton)
    root = names.index("root")
    np.testing.assert_allclose(bones.linear[root], 2 * np.eye(3), atol=1e-6)
    np.testing.assert_allclose(bones.translations[root], shift, atol=1e-6)


def test_a_tenth_of_nonsense_is_not_believed(body):
    vertices, weights, skeleton, _ = body
    positions = skinned(vertices, weights, *pose(skeleton, angle=0.4))
    random = np.random.default_rng(3)
    wrong = random.random(len(vertices)) < 0.1
    spoiled = np.where(wrong[:, None], positions + random.normal(0, 0.5, positions.shape), positions)
    bones = fit_bones(vertices, spoiled, np.ones(len(vertices)), weights, skeleton)
    assert np.median(np.linalg.norm(bones.posed - positions, axis=1)) < 0.003


def test_what_nobody_knows_does_not_count(body):
    vertices, weights, skeleton, _ = body
    positions = skinned(vertices, weights, *pose(skeleton))
    areas = np.ones(len(vertices))
    areas[::7] = 0
    spoiled = positions.copy()
    spoiled[::7] += 100
    known = fit_bones(vertices, spoiled, areas, weights, skeleton)
    assert np.abs(known.posed - positions).max() < 5e-3


def test_from_bones_that_are_nearly_right_the_same_are_found(body):
    vertices, weights, skeleton, names = body
    areas, random = np.ones(len(vertices)), np.random.default_rng(1)
    before = skinned(vertices, weights, *pose(skeleton, angle=0.5))
    positions = skinned(vertices, weights, *pose(skeleton, angle=0.52))
    lost = random.random(len(vertices)) < 0.1  # what is not to be trusted
    positions[lost] += random.normal(0, 0.3, (lost.sum(), 3))
    whole = fit_bones(vertices, positions, areas, weights, skeleton)
    begun = fit_bones(vertices, before, areas, weights, skeleton)
    found = fit_bones(vertices, positions, areas, weights, skeleton, begun=begun)
    moving = np.array([name not in CONTROLS for name in names])
    apart = np.linalg.norm(found.posed - whole.posed, axis=1)
    assert apart.max() < 0.02
    assert apart.mean() < 0.2 * np.linalg.norm(begun.posed - whole.posed, axis=1).mean()
    turned = Rotation.from_matrix(found.rotations @ whole.rotations.transpose(0, 2, 1)).magnitude()
    assert turned[moving].max() < np.radians(5)
