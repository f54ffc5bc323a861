# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np
import pytest

from engine import (
    MatchError,
    RigError,
    Skeleton,
    SurfaceMap,
    TriangleMesh,
    carry_standing_rig,
    moved_into,
    standing_share,
)
from engine.mesh.reflection import reflected_mesh
from tests.people import HANGING, at_rest_in, person
from tests.shapes import rotation


@pytest.fixture(scope="module")
def someone():
    return person(resolution=20, fingers=False)


def across(skeleton):
    """Some direction across each bone."""
    axes = skeleton.tails - skeleton.heads
    found = np.cross(axes, np.eye(3)[np.abs(axes).argmin(axis=1)])
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def carried(source, target, skeleton, **options):
    """The rig in a target whose vertices are numbered alike."""
    maps = SurfaceMap.identity(target), SurfaceMap.identity(source)
    return carry_standing_rig(source, target, *maps, skeleton=skeleton, normals=across(skeleton), **options)


def test_exact_under_similarities(someone):
    turn, scale, way = rotation(np.array([1.0, 2, 3]), 0.8), 37.0, np.array([5.0, -1, 2])
    vertices = scale * someone.mesh.vertices @ turn.T + way
    skeleton = someone.rig.skeleton
    placed = carried(someone.mesh, TriangleMesh(vertices, someone.mesh.triangles), skeleton)
    for ends, before in ((placed.heads, skeleton.heads), (placed.tails, skeleton.tails)):
        np.testing.assert_allclose(ends, scale * before @ turn.T + way, atol=1e-6 * scale)
    np.testing.assert_allclose(placed.normals, across(skeleton) @ turn.T, atol=1e-6)
    np.testing.assert_allclose(placed.rotations, np.tile(turn, (len(skeleton), 1, 1)), atol=1e-6)


def test_in_another_pose(someone):
    other = at_rest_in(someone, HANGING)
    placed = carried(someone.mesh, other.mesh, someone.rig.skeleton)
    height = np.ptp(someone.mesh.vertices[:, 2])
    missed = np.linalg.norm(placed.heads - other.rig.skeleton.heads, axis=1) / height
    assert missed.mean() < 0.006
    assert missed.max() < 0.025
    along = [ends.tails - ends.heads for ends in (placed, other.rig.skeleton)]
    cosines = np.prod([np.linalg.norm(each, axis=1) for each in along], axis=0)
    assert np.degrees(np.arccos(((along[0] * along[1]).sum(axis=1) / cosines).clip(-1, 1))).mean() < 4


def test_units_do_not_matter(someone):
    other = at_rest_in(someone, HANGING).mesh
    skeleton = someone.rig.skeleton
    placed = carried(someone.mesh, other, skeleton)
    larger = [TriangleMesh(1000 * mesh.vertices, mesh.triangles) for mesh in (someone.mesh, other)]
    again = carried(*larger, Skeleton(skeleton.parents, 1000 * skeleton.heads, 1000 * skeleton.tails))
    np.testing.assert_allclose(again.heads, 1000 * placed.heads, atol=1e-4)


def test_joints_at_one_place_stay_together(someone):
    skeleton = someone.rig.skeleton
    placed = carried(someone.mesh, at_rest_in(someone, HANGING).mesh, skeleton)
    joined = [b for b, p in enumerate(skeleton.parents) if p >= 0 and np.allclose(skeleton.heads[b], skeleton.tails[p])]
    assert joined
    np.testing.assert_allclose(placed.heads[joined], placed.tails[skeleton.parents[joined]], atol=1e-12)


def test_a_root_on_the_ground_stays_upright(someone):
    skeleton = someone.rig.skeleton
    low = someone.mesh.vertices[:, 2].min() - 0.05
    root = np.array([[0.0, 0, low]])
    with_root = Skeleton(
        np.append(skeleton.parents, -1),
        np.concatenate([skeleton.heads, root]),
        np.concatenate([skeleton.tails, root + np.array([0, 0, 0.02])]),
    )
    other = at_rest_in(someone, HANGING | {"thigh.L": (0.9, 0.0, 0.0)}).mesh
    placed = carried(someone.mesh, other, with_root, frames=np.eye(3)[None])
    np.testing.assert_allclose(placed.rotations[-1], np.eye(3), atol=1e-9)


def test_what_has_no_partner_counts_nothing(someone):
    vertices = someone.mesh.vertices.copy()
    arm = someone.mesh.vertices[:, 0] > 0.3
    vertices[arm] += [0, 0, 5.0]
    other = TriangleMesh(vertices, someone.mesh.triangles)
    maps = []
    for mesh in (other, someone.mesh):
        same = SurfaceMap.identity(mesh)
        maps.append(SurfaceMap(same.points, np.where(arm, 0.0, 1.0), same.image_vertex_count, ~arm))
    skeleton = someone.rig.skeleton
    placed = carry_standing_rig(someone.mesh, other, *maps, skeleton=skeleton, normals=across(skeleton))
    np.testing.assert_allclose(placed.heads, skeleton.heads, atol=1e-6)


def test_wrong_input_is_refused(someone):
    maps = SurfaceMap.identity(someone.mesh), SurfaceMap.identity(someone.mesh)
    with pytest.raises(RigError, match="normal"):
        carry_standing_rig(someone.mesh, someone.mesh, *maps, skeleton=someone.rig.skeleton, normals=np.zeros((2, 3)))
    nothing = [
        SurfaceMap(each.points, each.confidence, each.image_vertex_count, np.zeros(len(each), bool)) for each in maps
    ]
    skeleton = someone.rig.skeleton
    few = SurfaceMap.identity(TriangleMesh(np.eye(3), [[0, 1, 2]]))
    with pytest.raises(MatchError, match="one of 3 vertices"):
        carry_standing_rig(someone.mesh, someone.mesh, maps[0], few, skeleton=skeleton, normals=across(skeleton))
    with pytest.raises(RigError, match="nothing in common"):
        carry_standing_rig(someone.mesh, someone.mesh, *nothing, skeleton=skeleton, normals=across(skeleton))


def test_whether_a_rig_stands_in_a_body(someone):
    skeleton = someone.rig.skeleton
    every = np.ones(len(skeleton), bool)
    assert standing_share(skeleton, someone.mesh, every) > 0.85
    way = np.array([2.0, 0, 0])
    beside = Skeleton(skeleton.parents, skeleton.heads + way, skeleton.tails + way)
    assert standing_share(beside, someone.mesh, every) < 0.3
    one = np.arange(len(every)) == someone.rig.names.index("thigh.L")
    assert standing_share(skeleton, someone.mesh, one) == 1


@pytest.mark.parametrize("turned", [False, True])
def test_a_rig_of_any_size_is_moved_into_a_body(someone, turned):
    """Also where another axis is up."""
    turn = rotation(np.array([1.0, 0, 0]), np.pi / 2) if turned else np.eye(3)
    mesh = TriangleMesh(someone.mesh.vertices @ turn.T, someone.mesh.triangles)
    skeleton, every = someone.rig.skeleton, np.ones(len(someone.rig.names), bool)
    elsewhere = Skeleton(skeleton.parents, *(70 * ends @ turn.T + 30 for ends in (skeleton.heads, skeleton.tails)))
    moved = moved_into(elsewhere, mesh, every, turn[:, 2])
    assert standing_share(moved, mesh, every) > 0.85
    assert np.linalg.norm(moved.heads - skeleton.heads @ turn.T, axis=1).max() < 0.06


def test_across_a_map_to_the_mirror_image_it_is_mirrored(someone):
    other = at_rest_in(someone, {"upper_arm.L": (0.0, 0.6, 0.0)}).mesh
    skeleton = someone.rig.skeleton
    placed = carried(someone.mesh, other, skeleton)
    seen = carried(someone.mesh, reflected_mesh(other), skeleton)
    for ends, others in ((placed.heads, seen.heads), (placed.tails, seen.tails), (placed.normals, seen.normals)):
        np.testing.assert_allclose(others, ends * [-1, 1, 1], atol=1e-4)
