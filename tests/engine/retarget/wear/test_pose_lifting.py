# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes that are lifted where the skin would come through them in poses."""

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from engine import ClosestPoints, Skeleton, TriangleMesh, run
from engine.retarget.wear.joint_bends import Pose, joint_bends
from engine.retarget.wear.pose_lifting import lift_for_poses_steps
from engine.retarget.wear.pose_mending import WeightedItem
from tests.shapes import cylinder, rotation

BONES = Skeleton(np.array([-1, 0]), np.array([[0, 0, 0], [0, 0, 2.0]]), np.array([[0, 0, 2.0], [0, 0, 4.0]]))
MOST, COARSE = 0.004, 0.15
"""How far cloth may be lifted, in sqrt(area), or as a part of the root of a vertex's area if that is more."""


def weights_of(vertices):
    """Weights of a limb with a joint at the height 2."""
    upper = 1 / (1 + np.exp(-4 * (vertices[:, 2] - 2)))
    return csr_array(np.stack([1 - upper, upper], axis=1))


def limb(x=0.0):
    vertices, triangles = cylinder(64, 96, 0.5, 4.0)
    return TriangleMesh(vertices + np.array([x, 0, 0]), triangles)


def sleeve(away, rings=8, around=64):
    """A sleeve so far from the limb, of so few rings that its triangles are large."""
    vertices, triangles = cylinder(around, rings, 0.5 + away, 3.6)
    vertices[:, 2] += 0.2
    return WeightedItem(vertices, triangles, weights_of(vertices))


def aslant(item):
    """The same turned and shifted a little, so that no place has two nearest triangles: rounding decides nothing."""
    positions = item.positions @ rotation([0, 0, 1], 0.013).T + np.array([0, 0, 0.007])
    return WeightedItem(positions, item.triangles, item.weights)


def lifts(body, *items):
    return run(lift_for_poses_steps(items, body=body, skin_weights=weights_of(body.vertices), skeleton=BONES))


def through(body, item, moves, angle=None):
    """How far the skin comes through a sleeve in the worst pose, at the 99th percentile, if the sleeve is moved.

    Poses are those that clothes are tried in, or the joint is bent by another angle about one axis, both ways.
    """
    on_item, worst = item.weights[:, [1]].toarray().ravel(), 0.0
    skin = body.vertices[np.abs(body.vertices[:, 2] - 2) < 1.5]
    on_skin = weights_of(skin)[:, [1]].toarray().ravel()
    for bend in joint_bends(body, weights_of(body.vertices), BONES, [1]):
        rotations = bend.rotations if angle is None else [rotation([1, 0, 0], sign * angle) for sign in (1, -1)]
        for turn in rotations:
            cloth = TriangleMesh(bend.bent(item.positions + moves, on_item, turn), item.triangles)
            points = bend.bent(skin, on_skin, turn)
            found = ClosestPoints(cloth).nearest(points)
            away = points - found.interpolate(cloth.triangles, cloth.vertices)
            above = np.einsum("ki,ki->k", away, cloth.triangle_normals[found.triangles])
            worst = max(worst, float(np.quantile(above, 0.99)))
    return worst


def test_large_triangles_are_lifted_over_the_skin_below_them():
    body = limb()
    item = sleeve(0.008)
    (moves,) = lifts(body, item)
    unit = np.sqrt(body.area)
    before, after = through(body, item, np.zeros_like(moves)), through(body, item, moves)
    assert before > 0.003
    assert after < 0.6 * before
    most = np.maximum(MOST * unit, COARSE * np.sqrt(item.mesh.vertex_areas))
    assert (np.linalg.norm(moves, axis=1) <= most * (1 + 1e-6)).all()
    outward = item.positions * [1, 1, 0]
    moved = np.linalg.norm(moves, axis=1) > 0.2 * MOST * unit
    assert (np.einsum("ki,ki->k", moves, outward)[moved] > 0).all()


def test_little_comes_through_a_joint_that_is_bent_as_in_a_squat():
    body, item = limb(), sleeve(0.02, around=16)
    (moves,) = lifts(body, item)
    bare, lifted = (through(body, item, part * moves, np.radians(80)) for part in (0, 1))
    assert bare > 0.02
    assert lifted < 0.3 * bare


def legs_in_a_skirt():
    """Two legs that hang on one bone, and a skirt of few large triangles around both, whose middle both move."""
    vertices, triangles = cylinder(48, 64, 0.5, 4.0)
    body = TriangleMesh.concatenated([TriangleMesh(vertices + np.array([x, 0, 0]), triangles) for x in (-0.55, 0.55)])
    bones = Skeleton(
        np.array([-1, 0, 0]),
        np.array([[0, 0, 4.0], [-0.55, 0, 3.8], [0.55, 0, 3.8]]),
        np.array([[0, 0, 5.0], [-0.55, 0, 0], [0.55, 0, 0]]),
    )

    def weights(points, left):
        legs = 1 / (1 + np.exp(8 * (points[:, 2] - 3.5)))
        return csr_array(np.stack([1 - legs, legs * left, legs * (1 - left)], axis=1))

    tube, faces = cylinder(12, 4, 1.0, 0.9)
    around = np.arctan2(tube[:, 1], tube[:, 0])
    places = np.stack([1.16 * np.cos(around), 0.62 * np.sin(around), tube[:, 2] + 3.0], axis=1)
    skirt = WeightedItem(places, faces, weights(places, (0.5 - places[:, 0]).clip(0, 1)))
    return body, weights(body.vertices, (body.vertices[:, 0] < 0).astype(float)), bones, skirt


def test_less_comes_through_a_skirt_in_a_stride():
    body, on_skin, bones, skirt = legs_in_a_skirt()
    (moves,) = run(lift_for_poses_steps([skirt], body=body, skin_weights=on_skin, skeleton=bones))
    bends = tuple(bend for bend in joint_bends(body, on_skin, bones, range(3)) if bend.bone)
    below = np.abs(body.vertices[:, 2] - 3.3) < 0.3
    forward = rotation([1, 0, 0], 0.6)
    stride = Pose(bends, np.stack([forward, forward.T]))
    skin = stride.bent(body.vertices[below], [bend.on_skin[below] for bend in bends])
    depths = []
    for part in (0, 1):
        places = stride.bent(skirt.positions + part * moves, list(skirt.weights[:, [1, 2]].toarray().T))
        cloth = TriangleMesh(places, skirt.triangles)
        found = ClosestPoints(cloth).nearest(skin)
        away = skin - found.interpolate(cloth.triangles, cloth.vertices)
        above = np.einsum("ki,ki->k", away, cloth.triangle_normals[found.triangles])
        depths.append(float(np.quantile(above, 0.99)))
    assert depths[0] > 0.05
    assert depths[1] < 0.5 * depths[0]


def test_what_has_enough_room_stays():
    (moves,) = lifts(limb(), sleeve(0.08))
    assert not moves.any()


def test_nothing_depends_on_units_or_place():
    body, item = limb(), aslant(sleeve(0.008))
    (moves,) = lifts(body, item)
    shift = np.array([3.0, -2.0, 5.0])
    bigger = TriangleMesh(100 * (body.vertices + shift), body.triangles)
    other = WeightedItem(100 * (item.positions + shift), item.triangles, item.weights)
    bones = Skeleton(BONES.parents, 100 * (BONES.heads + shift), 100 * (BONES.tails + shift))
    (found,) = run(lift_for_poses_steps([other], body=bigger, skin_weights=weights_of(body.vertices), skeleton=bones))
    np.testing.assert_allclose(found, 100 * moves, atol=1e-4)  # of 1.4


def test_layers_are_lifted_together():
    body = limb()
    inner, outer = sleeve(0.008), sleeve(0.011)
    below, above = lifts(body, inner, outer)
    assert np.linalg.norm(below, axis=1).max() > 0.005
    radii = [
        np.linalg.norm((item.positions + moves)[:, :2], axis=1) for item, moves in ((inner, below), (outer, above))
    ]
    assert (radii[1] - radii[0] > 0.001).all()


def test_parts_that_meet_at_a_seam_are_lifted_as_one():
    upper, lower = (cylinder(16, rings, 0.52, 1.8) for rings in (8, 3))
    upper[0][:, 2] += 2.0
    lower[0][:, 2] += 0.2
    items = [WeightedItem(vertices, triangles, weights_of(vertices)) for vertices, triangles in (upper, lower)]
    above, below = lifts(limb(), *items)
    gaps, partners = cKDTree(lower[0]).query(upper[0])
    both = np.flatnonzero(gaps < 1e-9)
    assert len(both) >= 16
    assert np.linalg.norm(above[both], axis=1).max() > 0.01
    np.testing.assert_allclose(above[both], below[partners[both]], atol=4e-4)


def test_seams_stay_closed():
    body, item = limb(), aslant(sleeve(0.008))
    corners = item.triangles.ravel()  # every triangle by itself
    cut = WeightedItem(item.positions[corners], np.arange(len(corners)).reshape(-1, 3), item.weights[corners])
    (moves,), (apart,) = lifts(body, item), lifts(body, cut)
    np.testing.assert_allclose(apart, moves[corners], atol=2e-5)


@pytest.mark.parametrize("kind", ["rigid", "left"])
def test_rigid_pieces_move_as_one_and_what_is_left_stays(kind):
    body, item = limb(), sleeve(0.008)
    front = (np.abs(item.positions[:, 2] - 2) < 0.6) & (item.positions[:, 0] > 0.4)
    if kind == "rigid":
        (moves,) = lifts(
            body, WeightedItem(item.positions, item.triangles, item.weights, pieces=np.where(front, 0, -1))
        )
        assert np.ptp(moves[front], axis=0).max() < 1e-12
        assert moves[front].any()
    else:
        (moves,) = lifts(body, WeightedItem(item.positions, item.triangles, item.weights, left=front))
        assert not moves[front].any()
    assert moves[~front].any()


def test_nothing_is_lifted_into_other_skin():
    one, other = limb(), limb(1.02)
    both = TriangleMesh(
        np.concatenate([one.vertices, other.vertices]),
        np.concatenate([one.triangles, other.triangles + one.vertex_count]),
    )
    item = sleeve(0.008)
    (moves,) = lifts(both, item)
    inner = item.positions[:, 0] > 0.5  # at the other limb, which is 0.012 away
    assert not moves[inner].any()
    assert moves[item.positions[:, 0] < 0].any()


def test_no_items_and_no_bones_are_nothing_to_do():
    body, item = limb(), sleeve(0.008)
    assert lifts(body) == []
    none = csr_array((body.vertex_count, 0))
    bones = Skeleton(np.empty(0, int), np.empty((0, 3)), np.empty((0, 3)))
    unbound = WeightedItem(item.positions, item.triangles, csr_array((len(item.positions), 0)))
    (moves,) = run(lift_for_poses_steps([unbound], body=body, skin_weights=none, skeleton=bones))
    assert not moves.any()
    (moves,) = lifts(body, WeightedItem(item.positions, item.triangles, csr_array((len(item.positions), 2))))
    assert not moves.any()
