# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine import ClosestPoints, Skeleton, TriangleMesh
from engine.retarget.rig.bone_fit import fit_bones
from engine.retarget.rig.digit_groups import digit_groups, stunted_digits, with_stiff_digits
from tests.hands import ARM, PALM, hand_body, hand_bones


def test_a_hand_is_found_and_a_trunk_with_limbs_is_none():
    skeleton = hand_bones()
    mesh, weights = hand_body(skeleton)
    mass = mesh.vertex_areas / mesh.area @ weights
    (group,) = digit_groups(skeleton, mass)
    assert (group.above, group.hub) == (ARM, PALM)
    assert group.chains == ((3, 4), (5, 6), (7, 8), (9, 10), (11, 12))
    assert digit_groups(skeleton, np.where(np.arange(len(mass)) < 3, 0.0, 0.1)) == []
    few = Skeleton(skeleton.parents[:7], skeleton.heads[:7], skeleton.tails[:7])
    assert digit_groups(few, mass[:7]) == []


@pytest.fixture(scope="module")
def body():
    skeleton = hand_bones()
    return (*hand_body(skeleton), skeleton)


def stunted_in(body, kept):
    """Hands that are found stunted in a target that has the parts of some bones alone."""
    mesh, weights, skeleton = body
    faces = kept[weights.argmax(axis=1)[mesh.triangles[:, 0]]]
    used, corners = np.unique(mesh.triangles[faces], return_inverse=True)
    target = TriangleMesh(mesh.vertices[used], corners.reshape(-1, 3))
    matches = ClosestPoints(mesh).at_vertices(target.vertices, used)
    return stunted_digits(mesh, weights, skeleton, target, matches)


def test_a_whole_hand_is_not_stunted_and_one_of_stumps_is(body):
    skeleton = body[2]
    bones = np.arange(len(skeleton))
    assert stunted_in(body, bones >= 0) == []
    assert stunted_in(body, bones != len(skeleton) - 1) == []
    (group,) = stunted_in(body, (bones <= PALM) | (bones % 4 == 1))
    assert group.hub == PALM
    assert len(stunted_in(body, bones <= PALM)) == 1


def test_stiff_digits_go_where_the_palm_goes(body):
    mesh, weights, skeleton = body
    groups = stunted_in(body, np.arange(len(skeleton)) <= PALM)
    stiff = with_stiff_digits(weights, groups)
    np.testing.assert_allclose(stiff.sum(axis=1), weights.sum(axis=1))
    assert not stiff[:, groups[0].bones[1:]].nnz
    np.testing.assert_array_equal(stiff[:, [0, 1]].toarray(), weights[:, [0, 1]].toarray())
    linear, shift = np.diag([1.0, 2.0, 0.5]), np.array([0.1, 0.2, 0.3])
    bones = fit_bones(mesh.vertices, mesh.vertices @ linear + shift, mesh.vertex_areas, stiff, skeleton)
    np.testing.assert_array_equal(bones.linear[PALM + 1 :], np.tile(bones.linear[PALM], (10, 1, 1)))


def test_without_hands_nothing_changes(body):
    weights = body[1]
    np.testing.assert_array_equal(with_stiff_digits(weights, []).toarray(), weights.toarray())
