# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from engine import ClosestPoints, Skeleton, TriangleMesh
from engine.bone_fit import fit_bones, skinned
from engine.digit_fit import digit_groups, with_digits
from tests.shapes import icosphere

TRUNK, ARM, PALM = 0, 1, 2
LENGTHS = (0.5, 0.8, 0.9, 0.85, 0.65)
"""Of the fingers, the thumb first."""


def hand_bones():
    """A trunk, an arm along x, a palm, and five fingers of two bones: parents, heads, tails."""
    parents, heads, tails = [-1, 0, 1], [[-8.0, 0, 0], [-3.0, 0, 0], [0, 0, 0]], [[-5.0, 0, 0], [0, 0, 0], [0.9, 0, 0]]
    for number, length in enumerate(LENGTHS):
        thumb = number == 0
        base = np.array([0.3, -0.5, 0.1] if thumb else [1.0, -0.55 + 0.3 * number, 0])
        along = np.array([0.6, -0.8, 0.2] if thumb else [1.0, 0.06 * (number - 2), 0])
        middle, tip = base + length / 2 * along, base + length * along
        parents += [PALM, len(parents)]
        heads += [base, middle]
        tails += [middle, tip]
    return Skeleton(np.array(parents), np.array(heads), np.array(tails))


def hand_body(skeleton, resolution=4):
    """An ellipsoid around each bone, which moves with it: a mesh and weights."""
    vertices, triangles, owner = [], [], []
    ball, faces = icosphere(resolution)
    for bone, (head, tail) in enumerate(zip(skeleton.heads, skeleton.tails, strict=True)):
        axis = (tail - head) / np.linalg.norm(tail - head)
        across = np.cross([0.0, 0.0, 1.0], axis)
        frame = np.stack([axis, across / np.linalg.norm(across), np.cross(axis, across / np.linalg.norm(across))])
        width, height = {TRUNK: (3.0, 3.0), ARM: (0.4, 0.35), PALM: (0.6, 0.2)}.get(bone, (0.12, 0.1))
        size = np.array([0.6 * np.linalg.norm(tail - head), width, height])
        triangles.append(faces + len(ball) * bone)
        vertices.append((ball * size) @ frame + (head + tail) / 2)
        owner += [bone] * len(ball)
    weights = csr_array((np.ones(len(owner)), (np.arange(len(owner)), owner)), shape=(len(owner), len(skeleton)))
    return TriangleMesh(np.concatenate(vertices), np.concatenate(triangles)), weights


def hand_pose(skeleton, roll=0.0, curl=0.0, tilt=0.0):
    """Transforms of a hand that is turned and tilted at the wrist, with bent fingers; angles in degrees."""
    linear, translations = np.empty((len(skeleton), 3, 3)), np.empty((len(skeleton), 3))
    for bone in skeleton.order:
        turn = Rotation.identity()
        if bone == ARM:
            turn = Rotation.from_rotvec([0.2, 0.5, -0.3])
        elif bone == PALM:
            turn = Rotation.from_rotvec(np.radians([roll, tilt, 0.0]))
        elif bone > PALM:
            turn = Rotation.from_rotvec(np.radians([0.0, curl, 0.0]))
        parent = skeleton.parents[bone]
        linear[bone] = turn.as_matrix() if parent < 0 else linear[parent] @ turn.as_matrix()
        head = skeleton.heads[bone]
        place = head if parent < 0 else linear[parent] @ head + translations[parent]
        translations[bone] = place - linear[bone] @ head
    return linear, translations


@pytest.fixture(scope="module")
def body():
    skeleton = hand_bones()
    return (*hand_body(skeleton), skeleton)


def test_a_hand_is_found_and_a_trunk_with_limbs_is_none(body):
    mesh, weights, skeleton = body
    mass = mesh.vertex_areas / mesh.area @ weights
    (group,) = digit_groups(skeleton, mass)
    assert (group.above, group.hub) == (ARM, PALM)
    assert group.chains == ((3, 4), (5, 6), (7, 8), (9, 10), (11, 12))
    assert digit_groups(skeleton, np.where(np.arange(len(mass)) < 3, 0.0, 0.1)) == []
    few = Skeleton(skeleton.parents[:7], skeleton.heads[:7], skeleton.tails[:7])
    assert digit_groups(few, mass[:7]) == []


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
