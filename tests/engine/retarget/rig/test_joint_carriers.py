# SPDX-License-Identifier: GPL-3.0-or-later
"""Which bones carry which joints."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import FittedRig, RigError, Skeleton, SurfaceMap, TriangleMesh
from engine.retarget.rig.joint_carriers import carriers_of, moved_areas, nearest_on_bones
from tests.shapes import cylinder

# A chain of three along a tube, and bones beside it: parent, head, tail.
BONES = {
    "lower": (4, (0, 0, 0), (0, 0, 1)),
    "middle": (0, (0, 0, 1), (0, 0, 2)),
    "upper": (1, (0, 0, 2), (0, 0, 3)),
    "target": (4, (0, 0, 2), (0.5, 0, 2)),
    "root": (-1, (0, 0, -1), (0, 1, -1)),
    "pole": (4, (1, 0, 1.75), (1.5, 0, 1.75)),
    "pocket": (1, (0.4, 0, 1.5), (0.4, 0.3, 1.5)),
}
LOWER, MIDDLE, UPPER, TARGET, ROOT, POLE, POCKET = range(7)


@pytest.fixture(scope="module")
def tube():
    return TriangleMesh(*cylinder(12, 30, radius=0.1, height=3.0))


def rig_of(mesh, weights, bones=BONES):
    parents, heads, tails = (np.array(column) for column in zip(*bones.values(), strict=True))
    count, same = len(bones), SurfaceMap.identity(mesh)
    turns = np.tile(np.eye(3), (count, 1, 1))
    return FittedRig(
        Skeleton(parents, heads, tails),
        csr_array(weights),
        turns,
        np.zeros((count, 3)),
        turns,
        np.ones(count),
        mesh.vertices,
        mesh.vertices,
        same,
        same,
    )


def by_height(mesh, more=0):
    """Weights (n, b) of the nearest bone of the chain alone."""
    return np.eye(len(BONES) + more)[np.minimum(mesh.vertices[:, 2], 2.9).astype(int)]


@pytest.fixture(scope="module")
def carriers(tube):
    return carriers_of(rig_of(tube, by_height(tube)), tube)


def place_of(carriers, bone, *, tail=False):
    return carriers.places[bone + tail * len(BONES)]


def test_bones_that_move_vertices_are_known(carriers):
    assert np.flatnonzero(carriers.moving).tolist() == [LOWER, MIDDLE, UPPER]


def test_joints_at_one_place_are_one(carriers):
    assert place_of(carriers, LOWER, tail=True) == place_of(carriers, MIDDLE)
    assert place_of(carriers, MIDDLE, tail=True) == place_of(carriers, UPPER) == place_of(carriers, TARGET)
    assert len(np.unique(carriers.places)) == len(carriers.of_places) == 2 * len(BONES) - 3


def test_parts_sum_to_one(carriers):
    for parts in (carriers.of_places, carriers.of_turns):
        assert (parts >= 0).all()
        np.testing.assert_allclose(parts.sum(axis=1), 1)
        assert not parts[:, ~carriers.moving].any()


def test_joints_of_a_chain_are_carried_by_both_bones(carriers):
    for place, bones in (
        (place_of(carriers, LOWER), [LOWER]),
        (place_of(carriers, MIDDLE), [LOWER, MIDDLE]),
        (place_of(carriers, UPPER), [MIDDLE, UPPER]),
        (place_of(carriers, UPPER, tail=True), [UPPER]),
    ):
        np.testing.assert_allclose(carriers.of_places[place], np.eye(len(BONES))[bones].mean(axis=0))


def test_a_joint_apart_from_the_bone_above_is_carried_by_it_too(tube):
    bones = BONES | {"upper": (1, (0.05, 0, 2.2), (0, 0, 3))}
    found = carriers_of(rig_of(tube, by_height(tube), bones), tube)
    np.testing.assert_allclose(
        found.of_places[place_of(found, UPPER)], np.eye(len(BONES))[[MIDDLE, UPPER]].mean(axis=0)
    )


def test_bones_that_move_vertices_turn_with_themselves(carriers):
    np.testing.assert_array_equal(carriers.of_turns[:3], np.eye(len(BONES))[:3])


def test_a_control_at_a_joint_turns_with_the_bone_that_begins_there(carriers):
    np.testing.assert_array_equal(carriers.of_turns[TARGET], np.eye(len(BONES))[UPPER])


def test_a_bone_that_hangs_on_others_turns_with_the_nearest_above(carriers):
    np.testing.assert_array_equal(carriers.of_turns[POCKET], np.eye(len(BONES))[MIDDLE])
    np.testing.assert_array_equal(carriers.of_places[place_of(carriers, POCKET)], np.eye(len(BONES))[MIDDLE])
    assert carriers.above.tolist() == [-1, LOWER, MIDDLE, -1, -1, -1, MIDDLE]


def test_a_control_beside_the_body_turns_with_what_is_near(carriers):
    # At (1, 0, 1.75) the middle bone is 1 away, the others by how much lower or higher they end.
    distances = np.array([np.hypot(1, 0.75), 1, np.hypot(1, 0.25)])
    expected = distances**-4.0 / (distances**-4.0).sum()
    np.testing.assert_allclose(carriers.of_turns[POLE, :3], expected)


def test_what_is_above_most_of_the_body_is_anchored_to_its_heaviest_bone(carriers):
    assert carriers.anchors.tolist() == [-1, -1, -1, -1, LOWER, -1, -1]


def test_bones_that_end_where_no_other_does_and_move_nothing_are_loose(carriers):
    assert np.flatnonzero(carriers.free & ~carriers.moving).tolist() == [TARGET, ROOT, POLE, POCKET]


def test_bones_share_the_area_of_the_body(tube):
    areas = moved_areas(rig_of(tube, by_height(tube)), tube)
    assert areas.sum() == pytest.approx(tube.area)
    np.testing.assert_allclose(areas[:3], tube.area / 3, rtol=0.1)
    np.testing.assert_array_equal(areas[3:], 0)


def test_next_to_no_weight_moves_nothing(tube):
    weights = by_height(tube)
    weights[0, POLE] = 1e-5
    assert moved_areas(rig_of(tube, weights), tube)[POLE] == 0
    weights[0, POLE] = 0.1
    assert moved_areas(rig_of(tube, weights), tube)[POLE] > 0


def test_a_rig_that_moves_nothing_or_another_body_is_refused(tube):
    with pytest.raises(RigError, match="No bone"):
        carriers_of(rig_of(tube, np.zeros((tube.vertex_count, len(BONES)))), tube)
    with pytest.raises(RigError, match=f"moves {tube.vertex_count} vertices"):
        carriers_of(rig_of(tube, by_height(tube)), TriangleMesh(*cylinder(5, 5)))


def test_the_size_of_the_rig_does_not_matter(tube, carriers):
    scale = 1e-3
    small = TriangleMesh(scale * tube.vertices, tube.triangles)
    bones = {
        name: (parent, scale * np.array(head), scale * np.array(tail)) for name, (parent, head, tail) in BONES.items()
    }
    found = carriers_of(rig_of(small, by_height(tube), bones), small)
    np.testing.assert_array_equal(found.places, carriers.places)
    np.testing.assert_allclose(found.of_turns, carriers.of_turns)


def test_the_ends_of_a_very_short_bone_stay_two_places(tube):
    bones = BONES | {"dot": (0, (0, 0.5, 1), (0, 0.5, 1 + 1e-6))}
    found = carriers_of(rig_of(tube, by_height(tube, 1), bones), tube)
    assert found.places[7] != found.places[15]


def test_the_nearest_points_on_bones_are_between_their_ends():
    rng = np.random.default_rng(0)
    heads, tails, point = rng.normal(size=(20, 3)), rng.normal(size=(20, 3)), rng.normal(size=3)
    tails[0] = heads[0]
    found = nearest_on_bones(Skeleton(np.full(20, -1), heads, tails), point)
    part = np.linspace(0, 1, 20001)[:, None, None]
    tried = np.linalg.norm((1 - part) * heads + part * tails - point, axis=2).min(axis=0)
    np.testing.assert_allclose(np.linalg.norm(found - point, axis=1), tried, atol=1e-6)
    detour = np.linalg.norm(found - heads, axis=1) + np.linalg.norm(found - tails, axis=1)
    np.testing.assert_allclose(detour, np.linalg.norm(tails - heads, axis=1), atol=1e-12)
