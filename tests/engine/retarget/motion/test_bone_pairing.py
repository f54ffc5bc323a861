# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones paired by the surface, whatever they are called and however many there are."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import BonePairing, RigError, Skeleton, SurfaceMap, TriangleMesh, fit_rig, pair_bones
from engine.mesh.reflection import reflected_mesh
from engine.retarget.motion.bone_pairing import _by_joints
from tests.people import HANGING, Person, at_rest_in, coarse_rig, fine_rig, haunched_rig, person, renamed
from tests.shapes import rotation


def check_right(pairing, source, target):
    """Every pair does common work, and bones of the target that do some have a partner."""
    pairs = list(zip(pairing.sources, pairing.targets, strict=True))
    assert [(source.names[a], target.names[b]) for a, b in pairs if not source.origins[a] & target.origins[b]] == []
    assert [name for b, name in enumerate(target.names) if target.origins[b] and b not in pairing.targets] == []


@pytest.mark.parametrize("make", [lambda body: renamed(body.rig), fine_rig, coarse_rig])
@pytest.mark.parametrize("rest", [{}, HANGING])
def test_bones_are_paired_without_names_in_any_rest_pose(someone, paired, make, rest):
    body = at_rest_in(someone, rest)
    rig = make(body)
    pairing = paired(body, rig)
    check_right(pairing, someone.rig, rig)
    assert ((pairing.scores > 0.3) & (pairing.scores <= 1 + 1e-9)).all()
    assert np.allclose(pairing.upright, np.eye(3))


def test_of_the_same_rig_each_bone_is_its_own_partner_and_nothing_is_turned(someone, paired):
    pairing = paired(someone, someone.rig)
    assert (pairing.sources == np.arange(len(someone.rig.names))).all()
    assert (pairing.sources == pairing.targets).all()
    assert np.allclose(pairing.rotations, np.eye(3), atol=1e-6)
    assert np.allclose(pairing.places, someone.rig.skeleton.heads, atol=1e-4)
    assert pairing.scores.min() > 0.99


def test_twist_bones_and_controls_stay_alone(someone, paired):
    rig = fine_rig(someone)
    alone = {name for number, name in enumerate(rig.names) if number not in paired(someone, rig).targets}
    assert alone == {"X_root", "X_foot_ik.L", "X_foot_ik.R", "X_forearm_twist.L", "X_forearm_twist.R"}


def test_the_rest_pose_is_seen_by_the_surface(someone, paired):
    body = at_rest_in(someone, HANGING)
    pairing = paired(body, body.rig)
    arm = someone.rig.names.index("upper_arm.L")
    wanted = rotation(HANGING["upper_arm.L"], np.linalg.norm(HANGING["upper_arm.L"]))
    apart = wanted.T @ pairing.rotations[pairing.targets == arm][0]
    assert np.trace(apart) > 1 + 2 * np.cos(np.radians(4))


def fitted_into_itself(person, confidence):
    """A person's rig, fitted into the same person by a map of such a confidence."""
    same = SurfaceMap.identity(person.mesh)
    same = replace(same, confidence=np.full(len(same), confidence))
    named = {"weights": person.rig.weights, "skeleton": person.rig.skeleton, "refine": False}
    return fit_rig(person.mesh, person.mesh, same, same, **named)


@pytest.mark.parametrize(("confidence", "follows"), [(1.0, False), (0.1, True)])
def test_where_a_map_is_doubtful_joints_tell_where_limbs_point(someone, confidence, follows):
    tree, names = someone.rig.skeleton, someone.rig.names
    fitted = fitted_into_itself(someone, confidence)
    rotations = fitted.rotations.copy()
    for side, sign in (("L", 1), ("R", -1)):
        rotations[names.index(f"upper_arm.{side}")] = rotation([0, 1, 0], sign * np.radians(50))
    pairing = pair_bones(replace(fitted, rotations=rotations), someone.mesh, someone.mesh, tree, someone.rig.weights)
    arm, elbow = names.index("upper_arm.L"), names.index("forearm.L")
    way = tree.heads[elbow] - tree.heads[arm]
    turned = pairing.rotations[pairing.targets == arm][0] @ way
    angle = np.degrees(np.arccos(turned @ way / (way @ way)))
    assert angle < 5 if follows else angle > 40


@pytest.mark.parametrize(("confidence", "right"), [(1.0, False), (0.1, True)])
def test_where_a_map_is_doubtful_limbs_are_paired_in_order(someone, confidence, right):
    # As if the map took the lower leg to the foot, as that of a large head on short legs with large feet does.
    tree, names = someone.rig.skeleton, someone.rig.names
    fitted = fitted_into_itself(someone, confidence)
    shifted = {
        f"{one}.{side}": f"{other}.{side}" for one, other in (("shin", "foot"), ("foot", "toe")) for side in "LR"
    }
    shifted |= {f"toe.{side}": f"shin.{side}" for side in "LR"}
    order = [names.index(shifted.get(name, name)) for name in names]
    pairing = pair_bones(fitted, someone.mesh, someone.mesh, tree, someone.rig.weights[:, order])
    pairs = {(names[a], names[b]) for a, b in zip(pairing.sources, pairing.targets, strict=True)}
    for side in "LR":
        assert ({(f"shin.{side}", f"shin.{side}"), (f"foot.{side}", f"foot.{side}")} <= pairs) == right


def test_a_body_that_faces_elsewhere_is_turned_as_a_whole(someone, paired):
    turn = rotation([0, 0, 1], np.pi / 2)
    rig = renamed(someone.rig)
    skeleton = type(rig.skeleton)(rig.skeleton.parents, rig.skeleton.heads @ turn.T, rig.skeleton.tails @ turn.T)
    rig = type(rig)(rig.names, skeleton, rig.weights, rig.origins)
    body = Person(TriangleMesh(someone.mesh.vertices @ turn.T, someone.mesh.triangles), rig)
    pairing = paired(body, rig)
    check_right(pairing, someone.rig, rig)
    assert np.allclose(pairing.upright, turn)


def test_where_tails_point_does_not_matter(someone):
    # Files of other programs know joints only: whoever reads them lets bones end anywhere.
    tree, same = someone.rig.skeleton, SurfaceMap.identity(someone.mesh)
    odd = Skeleton(tree.parents, tree.heads, tree.heads + 0.1 * np.random.default_rng(0).normal(size=tree.heads.shape))
    fitted = fit_rig(someone.mesh, someone.mesh, same, same, weights=someone.rig.weights, skeleton=odd, refine=False)
    pairing = pair_bones(fitted, someone.mesh, someone.mesh, tree, someone.rig.weights)
    check_right(pairing, someone.rig, someone.rig)
    assert np.allclose(pairing.rotations, np.eye(3), atol=1e-3)


@pytest.mark.parametrize("reaches", [(0.03, 0.4), (0.03, 0.03), (0.4, 0.4)])
def test_a_bone_that_swings_from_another_joint_is_no_partner_though_both_carry_the_same_leg(someone, reaches):
    # The hip of an animal turns at the hip in one rig, and reaches there from the middle of the back in the other.
    source, target = (haunched_rig(someone, reach) for reach in reaches)
    same = SurfaceMap.identity(someone.mesh)
    named = {"weights": source.weights, "skeleton": source.skeleton, "refine": False}
    fitted = fit_rig(someone.mesh, someone.mesh, same, same, **named)
    pairing = pair_bones(fitted, someone.mesh, someone.mesh, target.skeleton, target.weights)
    pairs = {(source.names[a], target.names[b]) for a, b in zip(pairing.sources, pairing.targets, strict=True)}
    for side in "LR":
        assert (f"Z_thigh.{side}", f"Z_thigh.{side}") in pairs
        assert ((f"Z_haunch.{side}", f"Z_haunch.{side}") in pairs) == (reaches[0] == reaches[1])


def test_a_hand_that_the_map_slid_onto_the_arm_goes_with_the_hand_and_not_with_a_finger():
    body = person(resolution=24)
    rig, same = body.rig, SurfaceMap.identity(body.mesh)
    weights = rig.weights.toarray()
    for side in "LR":
        forearm, hand, finger = (rig.names.index(f"{name}.{side}") for name in ("forearm", "hand", "middle1"))
        elbow, wrist = abs(rig.skeleton.heads[forearm, 0]), abs(rig.skeleton.tails[forearm, 0])
        along = (np.abs(body.mesh.vertices[:, 0]) - elbow) / (wrist - elbow)
        weights[:, finger] += weights[:, hand] + np.where(along > 0.7, weights[:, forearm], 0.0)
        weights[:, hand] = np.where((along > 0.4) & (along < 0.7), weights[:, forearm], 0.0)
        weights[along > 0.4, forearm] = 0.0
    slid = {"weights": csr_array(weights), "skeleton": rig.skeleton, "refine": False}
    fitted = fit_rig(body.mesh, body.mesh, same, same, **slid)
    pairing = pair_bones(fitted, body.mesh, body.mesh, rig.skeleton, rig.weights)
    pairs = {(rig.names[a], rig.names[b]) for a, b in zip(pairing.sources, pairing.targets, strict=True)}
    assert {("hand.L", "hand.L"), ("hand.R", "hand.R")} <= pairs


def test_a_flat_rig_comes_apart_between_keys(someone, paired):
    own = someone.rig.skeleton
    flat = Skeleton(np.full(len(own), -1), own.heads, own.tails)
    pairing = paired(someone, someone.rig)
    assert pairing.comes_apart(own, flat)
    assert not pairing.comes_apart(own, own)
    assert not pairing.comes_apart(flat, own)


def test_given_pairs_and_bones_left_alone_are_respected(someone, paired):
    names = someone.rig.names
    hand, foot, head = (names.index(name) for name in ("hand.L", "foot.R", "head"))
    pairing = paired(someone, someone.rig, fixed=[(hand, foot)], alone=[head])
    assert pairing.sources[pairing.targets == foot].tolist() == [hand]
    assert pairing.scores[pairing.targets == foot] == 1
    assert head not in pairing.targets
    others = [bone for bone in range(len(names)) if bone not in {hand, foot, head}]
    assert all(bone in pairing.sources[pairing.targets == bone] for bone in others)


def test_a_rig_without_weights_is_paired_by_where_its_bones_are(someone, paired):
    body = at_rest_in(someone, HANGING)
    rig = renamed(body.rig)
    bare = type(rig)(rig.names, rig.skeleton, csr_array(rig.weights.shape), rig.origins)
    pairing = paired(body, bare)
    limbs = [b for b, origin in enumerate(rig.origins) if origin & {"upper_arm.L", "forearm.R", "thigh.L", "shin.R"}]
    for bone in limbs:
        assert any(someone.rig.origins[a] & rig.origins[bone] for a in pairing.sources[pairing.targets == bone])


def test_what_does_not_fit_together_is_refused(someone, paired):
    rig = renamed(someone.rig)
    with pytest.raises(RigError, match="need weights of that shape"):
        paired(someone, type(rig)(rig.names, rig.skeleton, csr_array((3, 3)), rig.origins))
    with pytest.raises(RigError, match="there is no bone 99"):
        paired(someone, rig, alone=[99])
    for bones in ((99, 0), (-1, 0)):
        with pytest.raises(RigError, match=f"The source has .* there is no bone {bones[0]}"):
            paired(someone, rig, fixed=[bones])
    with pytest.raises(RigError, match="need scores of the shape"):
        BonePairing(*np.zeros((2, 1), int), np.zeros(2), np.zeros((1, 3, 3)), np.zeros((1, 3)), np.eye(3))


def test_nothing_is_paired_across_a_map_to_the_mirror_image(someone, paired):
    with pytest.raises(RigError, match="exchanges left and right"):
        paired(Person(reflected_mesh(someone.mesh), someone.rig), someone.rig)


def test_by_joints_alone_a_bone_points_to_the_one_that_follows_and_where_several_do_it_rests_as_the_body_does():
    """A back, a chest with two arms and a neck, and hands that end the arms."""
    heads = np.array([[0.0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1], [-1, 0, 1], [-2, 0, 1], [0, 0, 2]])
    parents = np.array([-1, 0, 1, 2, 1, 4, 1])
    source = Skeleton(parents, heads, heads)
    other = heads + np.array([[0, 0, 0], [0, 0.5, 0], [0, 1, 0], [0, 2, 0], [0, 0, 1], [0, 0, 2], [0, 1, 0]])
    turn = rotation([0, 0, 1], np.pi / 2)
    target = Skeleton(parents, other @ turn.T, other @ turn.T)
    numbers = np.arange(7)
    turned = _by_joints((numbers, numbers), (source, target), turn)
    for bone, after in ((0, 1), (2, 3), (4, 5)):
        ways = [tree.heads[after] - tree.heads[bone] for tree in (source, target)]
        ways = [way / np.linalg.norm(way) for way in ways]
        assert np.allclose(turned[bone] @ ways[0], ways[1])
        assert not np.allclose(turned[bone], turn, atol=0.1)
    assert np.allclose(turned[[1, 6]], turn)
    assert np.allclose(turned[[3, 5]], turned[[2, 4]])
    assert np.allclose(np.linalg.det(turned), 1)
