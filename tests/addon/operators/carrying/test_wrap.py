# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.wrap`."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.transfers.wrap import wrap_key_name
from scipy.spatial import cKDTree

from tests.addon.characters import add_person, match_at_once
from tests.addon.scenes import localised, mesh_snapshot
from tests.addon.shape_keys import positions


@pytest.fixture
def pair(dense_pair):
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    return dense_pair


def wrap(**options):
    return bpy.ops.hiermatch.wrap(**({"source": "Source", "target": "Target", "refine": False} | options))


def shown(obj):
    """Vertices (n, 3) in the world, as shape keys and drivers make them."""
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = obj.evaluated_get(depsgraph)
    found = np.array([evaluated.matrix_world @ vertex.co for vertex in evaluated.to_mesh().vertices])
    evaluated.to_mesh_clear()
    return found


def in_world(obj):
    matrix = np.array(obj.matrix_world)
    return positions(obj) @ matrix[:3, :3].T + matrix[:3, 3]


def gaps(points, obj):
    """Distances of points from the vertices of an object, of both sides of its surface's edges' lengths."""
    return cKDTree(in_world(obj)).query(points)[0]


def test_the_slider_leads_from_one_shape_to_the_other(pair):
    source, target = pair
    before, own = in_world(source), mesh_snapshot(target)
    assert wrap() == {"FINISHED"}
    key = source.data.shape_keys.key_blocks["Wrap to Target"]
    assert key.value == 1
    edge = np.mean([np.linalg.norm(in_world(target)[list(edge.vertices)].ptp(axis=0)) for edge in target.data.edges])
    assert gaps(shown(source), target).max() < 1.5 * edge
    key.value = 0
    np.testing.assert_allclose(shown(source), before, atol=1e-5)
    assert mesh_snapshot(target) == own
    assert wrap() == {"FINISHED"}  # again, it is replaced
    assert [key.name for key in source.data.shape_keys.key_blocks] == ["Basis", "Wrap to Target"]


def test_the_target_can_be_laid_onto_the_source_as_a_new_object(pair):
    source, target = pair
    before = [mesh_snapshot(obj) for obj in pair]
    assert wrap(wrap_moved="TARGET", wrap_result="OBJECT") == {"FINISHED"}
    assert [mesh_snapshot(obj) for obj in pair] == before
    assert source.data.shape_keys is None
    assert target.data.shape_keys is None
    made = bpy.data.objects["Target to Source"]
    assert made.matrix_world == target.matrix_world
    assert not [name for name in made.vertex_groups.keys() if name.startswith("HM")]  # noqa: SIM118
    assert "hiermatch" not in made.data
    assert gaps(shown(made), source).max() < 0.5


def test_a_new_object_is_bound_as_the_one_it_was_made_from(pair):
    source = pair[0]
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(armature)
    armature.location = (0.5, 1, 0)
    bpy.context.view_layer.update()
    source.parent, source.matrix_parent_inverse = armature, armature.matrix_world.inverted()
    modifier = source.modifiers.new("Skin", "ARMATURE")
    modifier.object, modifier.use_deform_preserve_volume = armature, True
    source.modifiers.new("Smooth", "SMOOTH")
    source.vertex_groups.new(name="Bone")
    bpy.context.view_layer.update()
    assert wrap(wrap_result="OBJECT") == {"FINISHED"}
    made = bpy.data.objects["Source to Target"]
    bpy.context.view_layer.update()
    assert made.parent == armature
    np.testing.assert_allclose(np.array(made.matrix_world), np.array(source.matrix_world), atol=1e-6)
    (kept,) = made.modifiers
    assert (kept.type, kept.object, kept.use_deform_preserve_volume) == ("ARMATURE", armature, True)
    assert "Bone" in made.vertex_groups


def test_the_own_place_is_kept(pair):
    source = pair[0]
    centre = shown(source).mean(axis=0)
    assert wrap(wrap_place="OWN") == {"FINISHED"}
    assert np.linalg.norm(shown(source).mean(axis=0) - centre) < 0.2


def test_in_betweens_follow_the_slider(pair):
    source = pair[0]
    assert wrap(wrap_in_betweens=3) == {"FINISHED"}
    blocks = source.data.shape_keys.key_blocks
    assert [key.name for key in blocks][1:] == [
        "Wrap to Target",
        "Wrap to Target 1/4",
        "Wrap to Target 2/4",
        "Wrap to Target 3/4",
    ]
    for value, expected in ((0.0, [0, 0, 0]), (0.375, [0.5, 0.5, 0]), (0.5, [0, 1, 0]), (1.0, [0, 0, 0])):
        blocks[1].value = value
        bpy.context.view_layer.update()
        evaluated = source.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.shape_keys.key_blocks
        assert [evaluated[key.name].value for key in list(blocks)[2:]] == pytest.approx(expected, abs=1e-6)
    assert wrap(wrap_in_betweens=3) == {"FINISHED"}
    assert len(source.data.shape_keys.animation_data.drivers) == 3


def test_names_fit_into_blender():
    assert wrap_key_name("Cube") == "Wrap to Cube"
    assert len((wrap_key_name("Ä" * 60) + " 15/16").encode()) <= 63
    assert wrap_key_name("x" * 60 + ".L") != wrap_key_name("x" * 60 + ".R")


def test_shared_meshes_are_refused(pair):
    source = pair[0]
    bpy.data.objects.new("Sharer", source.data)
    with pytest.raises(RuntimeError, match="shares its mesh"):
        wrap()
    assert source.data.shape_keys is None


@pytest.fixture
def people(monkeypatch):
    """Two persons of two objects each, one standing otherwise, smoothly shaded across the border of their objects."""
    match_at_once(monkeypatch)
    rigs = add_person("Hero")[0], add_person("Other", hanging=True)[0]
    for rig in rigs:
        _shade_as_one(parts_of_person(rig))
    bpy.context.view_layer.update()
    return rigs


def parts_of_person(rig):
    return [bpy.data.objects[f"{rig.name} {part}"] for part in ("Body", "Head")]


def _shade_as_one(parts):
    """Give parts the custom normals of the surface that they are together."""
    normals = np.concatenate([[vertex.normal for vertex in part.data.vertices] for part in parts])
    where, place = np.unique(np.concatenate([positions(part) for part in parts]), axis=0, return_inverse=True)
    sums = np.stack([np.bincount(place.ravel(), axis, len(where)) for axis in normals.T], axis=1)[place.ravel()]
    sums /= np.linalg.norm(sums, axis=1, keepdims=True)
    start = 0
    for part in parts:
        part.data.polygons.foreach_set("use_smooth", [True] * len(part.data.polygons))
        own = sums[start : start + len(part.data.vertices)]
        start += len(own)
        part.data.normals_split_custom_set_from_vertices(own.tolist())


def seam_of(parts):
    """Gaps and angles, in degrees, between two parts as shown, where their meshes have vertices at one place."""
    first, second = (positions(part) for part in parts)
    found, other = cKDTree(first).query(second)
    along = np.flatnonzero(found == 0)
    assert len(along) > 20
    graph = bpy.context.evaluated_depsgraph_get()
    places, normals = [], []
    for part, chosen in zip(parts, (other[along], along), strict=True):
        mesh = part.evaluated_get(graph).data
        places.append(np.array([mesh.vertices[number].co for number in chosen]))
        corner = {loop.vertex_index: loop.index for loop in mesh.loops}
        normals.append(np.array([mesh.corner_normals[corner[number]].vector for number in chosen]))
    cosines = np.einsum("nd,nd->n", *normals).clip(-1, 1)
    return np.linalg.norm(np.subtract(*places), axis=1), np.degrees(np.arccos(cosines))


def test_a_new_object_of_one_in_an_overridden_collection_is_put_beside_it(pair, tmp_path):
    source = localised(pair[0], tmp_path)
    assert wrap(wrap_result="OBJECT") == {"FINISHED"}
    assert source.data.shape_keys is None
    assert list(bpy.data.objects["Source to Target"].users_collection) == [bpy.context.scene.collection]


@pytest.mark.parametrize("result", ["KEY", "OBJECT"])
def test_coincident_vertices_of_two_objects_stay_so(people, result):
    assert wrap(source="Hero", target="Other", wrap_result=result) == {"FINISHED"}
    parts = parts_of_person(people[0])
    if result == "OBJECT":
        parts = [bpy.data.objects[f"{part.name} to Other"] for part in parts]
    for part in parts:
        part.modifiers.clear()
    bpy.context.view_layer.update()
    gaps, angles = seam_of(parts)
    assert gaps.max() < 1e-6
    remarks = bpy.context.scene.hiermatch_retarget.report.remarks
    assert ("Custom normals" in remarks) == (result == "KEY")
    if result == "OBJECT":
        assert angles.max() < 2


def test_a_new_object_is_moved_by_the_rig_of_what_it_was_laid_onto(people):
    source, target = people
    assert wrap(source="Hero", target="Other", wrap_result="OBJECT") == {"FINISHED"}
    for rig in people:
        assert all(part.data.shape_keys is None for part in parts_of_person(rig))
        assert all([one.object for one in part.modifiers] == [rig] for part in parts_of_person(rig))
    made = [bpy.data.objects[f"{part.name} to Other"] for part in parts_of_person(source)]
    for part in made:
        assert [modifier.object for modifier in part.modifiers] == [target]
        assert part.parent == target
    for bone in ("thigh.L", "upper_arm.R"):
        target.pose.bones[bone].rotation_mode = "QUATERNION"
        target.pose.bones[bone].rotation_quaternion = (0.9, 0.3, 0.2, 0.25)
    for part, model in zip(made, parts_of_person(target), strict=True):
        np.testing.assert_allclose(shown(part), shown(model), atol=0.02)


@pytest.mark.parametrize("kept", ["other bones", "own place"])
def test_a_new_object_keeps_its_rig_where_the_other_has_none_for_it(people, kept):
    source, target = people
    if kept == "other bones":
        target.data.bones["spine1"].name = "torso"
    options = {"wrap_place": "OWN"} if kept == "own place" else {}
    assert wrap(source="Hero", target="Other", wrap_result="OBJECT", **options) == {"FINISHED"}
    made = bpy.data.objects["Hero Body to Other"]
    assert [modifier.object for modifier in made.modifiers] == [source]
    assert made.parent == source
