# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from engine import ClosestPoints, TriangleMesh
from engine.retarget.rig.bone_fit import fit_bones, skinned
from engine.retarget.rig.digit_fit import with_digits
from tests.hands import ARM, PALM, TRUNK, hand_body, hand_bones, hand_pose


@pytest.fixture(scope="module")
def body():
    skeleton = hand_bones()
    return (*hand_body(skeleton), skeleton)


def found_and_true(body, pose, shift=0):
    """Bones fitted to a map that takes each finger for one farther on, those of the truth, and what they were from."""
    mesh, weights, skeleton = body
    linear, translations = hand_pose(skeleton, **pose)
    other, other_weights = hand_body(skeleton, 5)
    target = TriangleMesh(skinned(other.vertices, other_weights, linear, translations), other.triangles)
    owner = other_weights.argmax(axis=1)
    taken_for = np.where(owner > PALM, PALM + 1 + (owner - PALM - 1 + 2 * shift) % 10, owner)
    middles = (skeleton.heads + skeleton.tails) / 2
    places = other.vertices - middles[owner] + middles[taken_for]
    matches = ClosestPoints(mesh).nearest(places)
    points = np.einsum("kc,kcd->kd", matches.barycentric, mesh.vertices[mesh.triangles[matches.triangles]])
    found = fit_bones(points, target.vertices, target.vertex_areas, _weights_at(matches, mesh, weights), skeleton)
    return target, matches, found, (linear, translations)


def _weights_at(matches, mesh, weights):
    rows = np.repeat(np.arange(len(matches)), 3)
    corners = mesh.triangles[matches.triangles].ravel()
    values = csr_array((matches.barycentric.ravel(), (rows, corners)), shape=(len(matches), mesh.vertex_count))
    return csr_array(values @ weights)


def tip_errors(skeleton, linear, translations, truth):
    """Distance of each fingertip from its true place."""
    tips = np.arange(4, len(skeleton), 2)

    def placed(matrices, shifts):
        return np.einsum("bij,bj->bi", matrices[tips], skeleton.tails[tips]) + shifts[tips]

    return np.linalg.norm(placed(linear, translations) - placed(*truth), axis=1)


@pytest.mark.parametrize(
    "pose",
    [{"roll": 10.0, "curl": 20.0}, {"roll": -70.0, "curl": 10.0, "tilt": 20.0}, {"roll": 30.0, "curl": 55.0}],
)
def test_fingers_that_were_taken_for_others_are_put_right(body, pose):
    mesh, weights, skeleton = body
    target, matches, found, truth = found_and_true(body, pose, shift=1)
    assert tip_errors(skeleton, found.linear, found.translations, truth).mean() > 0.3
    bones = with_digits(mesh, weights, skeleton, target, matches, bones=found)
    assert tip_errors(skeleton, bones.linear, bones.translations, truth).max() < 0.15
    np.testing.assert_array_equal(bones.linear[[TRUNK, ARM]], found.linear[[TRUNK, ARM]])
    np.testing.assert_allclose(
        bones.posed, skinned(mesh.vertices, weights, bones.linear, bones.translations), atol=1e-9
    )


def test_round_fingers_do_not_turn_around_themselves(body):
    mesh, weights, skeleton = body
    target, matches, found, _ = found_and_true(body, {"roll": 30.0, "curl": 55.0}, shift=1)
    bones = with_digits(mesh, weights, skeleton, target, matches, bones=found)
    fingers = np.arange(PALM + 1, len(skeleton))
    above = bones.rotations[skeleton.parents[fingers]]
    spin = Rotation.from_matrix(above.transpose(0, 2, 1) @ bones.rotations[fingers]).as_quat(canonical=True)
    axes = skeleton.tails[fingers] - skeleton.heads[fingers]
    along = np.einsum("kd,kd->k", spin[:, :3], axes / np.linalg.norm(axes, axis=1, keepdims=True))
    assert np.degrees(2 * np.abs(np.arctan2(along, spin[:, 3]))).max() < 12


def test_a_hand_that_was_right_stays_as_it_was(body):
    mesh, weights, skeleton = body
    target, matches, found, truth = found_and_true(body, {"roll": 20.0, "curl": 30.0})
    assert tip_errors(skeleton, found.linear, found.translations, truth).max() < 0.1
    bones = with_digits(mesh, weights, skeleton, target, matches, bones=found)
    assert tip_errors(skeleton, bones.linear, bones.translations, truth).max() < 0.1


def test_a_target_without_a_hand_changes_nothing(body):
    mesh, weights, skeleton = body
    target, matches, found, _ = found_and_true(body, {"roll": 0.0})
    of_trunk = matches.triangles < mesh.triangle_count // len(skeleton)
    keep = np.flatnonzero(of_trunk)
    trunk = TriangleMesh(target.vertices, target.triangles[: target.triangle_count // len(skeleton)])
    stump = TriangleMesh(trunk.vertices[keep], trunk.triangles)
    part = type(matches)(matches.triangles[keep], matches.barycentric[keep], matches.squared_distances[keep])
    bones = with_digits(mesh, weights, skeleton, stump, part, bones=found)
    np.testing.assert_array_equal(bones.linear, found.linear)
