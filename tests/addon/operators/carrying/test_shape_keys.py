# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.transfer_shape_keys`."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.engine import ClosestPoints, SurfaceMap, fit_rig, run
from hiermatch.hiermatch_addon.jobs.transfer import Passage
from hiermatch.hiermatch_addon.scene.armatures import read_rig
from hiermatch.hiermatch_addon.scene.character import joined, read_surface
from hiermatch.hiermatch_addon.scene.mesh_io import read_mesh
from hiermatch.hiermatch_addon.storage.stored_map import find_maps
from hiermatch.hiermatch_addon.storage.vertex_maps import MapPair
from hiermatch.hiermatch_addon.transfers.options.shape_keys import ShapeKeySettings
from hiermatch.hiermatch_addon.transfers.shape_keys import ShapeKeyTransfer
from mathutils import Matrix

from tests.addon.rigs import (
    add_mesh,
    add_rigged,
    add_rigged_pair,
    add_target,
    find_armature,
    pose,
    split_up,
    true_passage,
    unpose,
)
from tests.addon.shape_keys import add_key, offsets_of, positions
from tests.shapes import creature


@pytest.fixture
def pair(dense_pair):
    """A matched pair whose source swells at one end, in two keys."""
    source, target = dense_pair
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    co = positions(source)
    bump = np.exp(-((co - [2.5, 0, 0.1]) ** 2).sum(axis=1) / 0.5)[:, None]
    add_key(source, "Swell", 0.2 * bump * [1, 0, 0])
    add_key(source, "Lift", 0.1 * bump * [0, 0, 1])
    return source, target


def carry(**options):
    return bpy.ops.hiermatch.transfer_shape_keys(
        **({"source": "Source", "target": "Target", "refine": False} | options)
    )


def names(obj):
    return [] if obj.data.shape_keys is None else [key.name for key in obj.data.shape_keys.key_blocks]


def test_offsets_arrive_where_they_belong(pair):
    target = pair[1]
    assert carry() == {"FINISHED"}
    assert names(target) == ["Basis", "Swell", "Lift"]
    moved = offsets_of(target, "Swell")
    co = positions(target)
    expected = 0.2 * np.exp(-((co - [2.5, 0, 0.1]) ** 2).sum(axis=1) / 0.5)[:, None] * [1, 0, 0]
    assert np.linalg.norm(moved - expected) < 0.25 * np.linalg.norm(expected)
    assert (moved == 0).all(axis=1).any()  # far away nothing moves at all
    np.testing.assert_allclose(offsets_of(target, "Basis"), 0)


def test_settings_of_keys_come_along(pair):
    source, target = pair
    keys = source.data.shape_keys.key_blocks
    keys["Swell"].slider_min, keys["Swell"].slider_max, keys["Swell"].value = -2, 3, -1.5
    keys["Lift"].mute, keys["Lift"].relative_key, keys["Lift"].vertex_group = True, keys["Swell"], "Ring"
    source.vertex_groups.new(name="Ring")
    keys["Lift"].vertex_group = "Ring"
    target.vertex_groups.new(name="Ring")
    assert carry() == {"FINISHED"}
    carried = target.data.shape_keys.key_blocks
    swell, lift = carried["Swell"], carried["Lift"]
    assert (swell.slider_min, swell.slider_max, swell.value) == (-2, 3, -1.5)
    assert (lift.mute, lift.relative_key, lift.vertex_group) == (True, swell, "Ring")
    assert swell.relative_key == carried["Basis"]
    # What is seen of the two together is not changed by one being relative to the other.
    assert np.abs(offsets_of(target, "Lift")).max() == pytest.approx(0.1, rel=0.2)


def test_the_key_that_lays_the_source_onto_the_target_stays_there(pair):
    source = pair[0]
    for name in ("Wrap to Target", "Wrap to Target 1/2", "Wrap to Target Practice"):
        add_key(source, name, np.full((len(source.data.vertices), 3), 0.1))
    assert carry() == {"FINISHED"}
    assert names(pair[1]) == ["Basis", "Swell", "Lift", "Wrap to Target Practice"]
    assert carry(key_choice="NAMED", key_names="Wrap to Target") == {"FINISHED"}
    assert "Wrap to Target" in names(pair[1])


def test_keys_relative_to_one_left_behind_move_alone(pair):
    source, target = pair
    keys = source.data.shape_keys.key_blocks
    keys["Lift"].relative_key = keys["Swell"]
    assert carry(key_choice="NAMED", key_names="Lift") == {"FINISHED"}
    assert names(target) == ["Basis", "Lift"]
    assert target.data.shape_keys.key_blocks["Lift"].relative_key.name == "Basis"
    assert offsets_of(target, "Lift")[:, 0].min() < -0.1  # back from Swell


def test_a_key_relative_to_itself_moves_nothing_there_either(pair):
    source, target = pair
    key = source.data.shape_keys.key_blocks["Swell"]
    key.relative_key, key.value = key, 1.0
    assert carry() == {"FINISHED"}
    made = target.data.shape_keys.key_blocks["Swell"]
    assert (made.relative_key, made.value) == (made, 1.0)
    assert np.abs(offsets_of(target, "Swell")).max() > 0.1  # it is there for when that is changed
    np.testing.assert_allclose(shown(target), positions(target), atol=1e-6)


def test_of_several_parts_those_that_a_key_moves_no_more_stand_still():
    vertices, triangles, _ = creature(0.0, 8)
    source = add_mesh("Source", vertices, triangles)
    parts = split_up(add_mesh("Target", vertices, triangles), lambda centers: centers[:, 0] > 0)
    target, co = joined("Target", parts), positions(source)
    key = add_key(source, "Swell", np.tile([0, 0, 0.2], (len(co), 1)))
    graph = bpy.context.evaluated_depsgraph_get()
    meshes = [read_surface(side, graph, use_modifiers=False) for side in (source, target)]
    places = [ClosestPoints(other).nearest(one.vertices) for one, other in (meshes, meshes[::-1])]
    maps = [
        SurfaceMap.from_barycentric(mesh, place.triangles, place.barycentric)
        for mesh, place in zip(meshes[::-1], places, strict=True)
    ]

    def moves():
        transfer = ShapeKeyTransfer(ShapeKeySettings())
        transfer.read(bpy.context, source, target)
        run(transfer.steps(Passage(MapPair(*meshes, *maps))))
        transfer.write(bpy.context, source, target)
        return [float(np.abs(offsets_of(part, "Swell")).max()) for part in parts]

    assert min(moves()) > 0.1
    key.data.foreach_set("co", (co + np.where(co[:, :1] > 0.3, [0, 0, 0.2], 0)).astype(np.float32).ravel())
    front = [np.mean(positions(part)[:, 0]) > 0 for part in parts]
    assert sorted(front) == [False, True]
    assert [move > 0.1 for move in moves()] == front


@pytest.mark.parametrize("existing", ["REPLACE", "SKIP"])
def test_keys_of_the_same_name(pair, existing):
    target = pair[1]
    add_key(target, "Swell", np.ones((len(target.data.vertices), 3))).value = 0.5
    target.active_shape_key_index = 1
    assert carry(key_existing=existing) == {"FINISHED"}
    assert names(target) == ["Basis", "Swell", "Lift"]
    assert (np.abs(offsets_of(target, "Swell")).max() > 0.9) == (existing == "SKIP")
    assert target.active_shape_key_index == 1
    assert (target.data.shape_keys.key_blocks["Swell"].value == 0) == (existing == "REPLACE")


def test_the_active_key_alone(pair):
    source, target = pair
    source.active_shape_key_index = 2
    assert carry(key_choice="ACTIVE") == {"FINISHED"}
    assert names(target) == ["Basis", "Lift"]


def test_drivers_point_to_the_target(pair):
    source, target = pair
    keys = source.data.shape_keys
    other = bpy.data.objects.new("Slider", None)
    bpy.context.scene.collection.objects.link(other)
    for key, thing in (("Swell", source), ("Lift", other)):
        driver = keys.key_blocks[key].driver_add("value").driver
        driver.expression = "2 * much"
        variable = driver.variables.new()
        variable.name, variable.type = "much", "SINGLE_PROP"
        variable.targets[0].id, variable.targets[0].data_path = thing, "location.x"
    for _ in range(2):  # a second time replaces them
        assert carry() == {"FINISHED"}
    drivers = target.data.shape_keys.animation_data.drivers
    assert len(drivers) == 2
    found = {curve.data_path: curve.driver for curve in drivers}
    swell, lift = (found[f'key_blocks["{name}"].value'] for name in ("Swell", "Lift"))
    assert swell.expression == lift.expression == "2 * much"
    assert swell.variables[0].targets[0].id == target
    assert lift.variables[0].targets[0].id == other
    assert source.data.shape_keys.animation_data.drivers[0].driver.variables[0].targets[0].id == source
    target.shape_key_clear()
    assert carry(key_drivers=False) == {"FINISHED"}
    assert target.data.shape_keys.animation_data is None


def run_transfer(source, target, passage, **settings):
    """Do what the job does, across a known way."""
    transfer = ShapeKeyTransfer(ShapeKeySettings(**settings))
    transfer.read(bpy.context, source, target)
    for _ in transfer.steps(passage):
        pass
    return transfer.write(bpy.context, source, target)


def test_bones_turn_the_offsets_of_a_posed_body():
    source, target = add_rigged_pair()
    armature = find_armature(source)
    head = positions(source)[:, 0] > 0.9
    add_key(source, "Nod", np.where(head[:, None], [0.1, 0.05, 0.2], 0))
    # The truth is what the armature makes of the key.
    pose(armature)
    shown = []
    for value in (0, 1):
        source.data.shape_keys.key_blocks["Nod"].value = value
        bpy.context.view_layer.update()
        mesh = read_mesh(source, bpy.context.evaluated_depsgraph_get(), use_modifiers=True)
        shown.append(mesh.vertices)
    unpose(armature)
    report = run_transfer(source, target, true_passage(source, target))
    assert report.done == "1 shape key"
    truth = shown[1] - shown[0]
    assert np.linalg.norm(offsets_of(target, "Nod") - truth) < 0.05 * np.linalg.norm(truth)


@pytest.mark.parametrize("rigged", [True, False])
def test_across_a_map_to_the_mirror_image_offsets_are_mirrored(rigged):
    """The target is the source but for a negative scale: in its own space a key is the same."""
    source, _ = add_rigged()
    target, _ = add_target(source, matrix=Matrix.Scale(-1, 4, (0, 1, 0)), part=0.0)
    head = positions(source)[:, 0] > 0.9
    add_key(source, "Nod", np.where(head[:, None], [0.1, 0.05, 0.2], 0))
    pair, rig = true_passage(source, target).pair, read_rig(source)
    maps = pair.source_to_target, pair.target_to_source
    fitted = fit_rig(pair.source, pair.target, *maps, weights=rig.weights, skeleton=rig.skeleton, refine=False)
    run_transfer(source, target, Passage(pair, fitted, rig.names) if rigged else Passage(pair))
    np.testing.assert_allclose(offsets_of(target, "Nod"), offsets_of(source, "Nod"), atol=0.01)


def test_drivers_by_bones_point_to_the_armature_of_the_target():
    source, target = add_rigged_pair()
    mine = find_armature(source)
    add_key(source, "Nod", 0.1 * positions(source))
    driver = source.data.shape_keys.key_blocks["Nod"].driver_add("value").driver
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].bone_target = mine, "neck"
    passage = true_passage(source, target)
    report = run_transfer(source, target, passage)
    assert report.done == "1 shape key, 1 driver"
    assert "still point to" in report.notes[0]
    theirs = mine.copy()
    bpy.context.scene.collection.objects.link(theirs)
    target.modifiers.new("Armature", "ARMATURE").object = theirs
    report = run_transfer(source, target, passage)
    assert not report.notes
    place = target.data.shape_keys.animation_data.drivers[0].driver.variables[0].targets[0]
    assert (place.id, place.bone_target) == (theirs, "neck")


def test_drivers_by_what_the_target_lacks_still_point_to_the_source(pair):
    source, target = pair
    source["Much"] = 0.5
    driver = source.data.shape_keys.key_blocks["Swell"].driver_add("value").driver
    driver.expression = "much"
    variable = driver.variables.new()
    variable.name = "much"
    variable.targets[0].id, variable.targets[0].data_path = source, '["Much"]'
    for owner, value in ((source, 0.5), (target, 0.8)):
        assert carry() == {"FINISHED"}
        place = target.data.shape_keys.animation_data.drivers[0].driver.variables[0].targets[0]
        assert place.id == owner
        notes = bpy.context.scene.hiermatch_retarget.report.notes
        assert (f'still point to "{source.name}"' in notes) == (owner == source)
        bpy.context.view_layer.update()
        assert target.data.shape_keys.key_blocks["Swell"].value == pytest.approx(value)
        target["Much"] = 0.8


def test_a_driver_that_asks_a_mesh_for_a_bone_is_copied_as_it_is(pair):
    source, target = pair
    variable = source.data.shape_keys.key_blocks["Swell"].driver_add("value").driver.variables.new()
    place = variable.targets[0]
    place.id_type, place.id = "MESH", source.data
    variable.type, place.bone_target = "TRANSFORMS", "neck"
    assert place.id == source.data
    assert carry() == {"FINISHED"}
    assert target.data.shape_keys.animation_data.drivers[0].driver.variables[0].targets[0].id == source.data


def test_a_key_without_finite_numbers_is_left_out_alone(pair):
    source, target = pair
    source.data.shape_keys.key_blocks["Swell"].data[3].co.x = float("nan")
    assert carry() == {"FINISHED"}
    assert names(target) == ["Basis", "Lift"]
    assert '"Swell" of "Source" was left out' in bpy.context.scene.hiermatch_retarget.report.notes


@pytest.mark.parametrize("scale", [(1, 2, 0.5), (-1, 1, 1)])
def test_offsets_are_those_of_the_world(pair, scale):
    source, target = pair
    carry()
    before = offsets_of(target, "Lift")
    depsgraph = bpy.context.evaluated_depsgraph_get()
    passage = Passage(
        find_maps(source, target).maps.between(
            *(read_mesh(obj, depsgraph, use_modifiers=False) for obj in (source, target))
        )
    )
    # The same shape in the world, written in other coordinates.
    flat = (positions(target) / scale).astype(np.float32)
    target.shape_key_clear()
    target.data.vertices.foreach_set("co", flat.ravel())
    target.scale = scale
    bpy.context.view_layer.update()
    assert run_transfer(source, target, passage).done == "2 shape keys"
    np.testing.assert_allclose(offsets_of(target, "Lift") * scale, before, atol=2e-3)


def make_absolute(obj, frames):
    """Give an object's keys frames of their own, in the order of their names; Blender only does that to new keys."""
    keys = obj.data.shape_keys
    shapes = {key.name: positions(obj) + offsets_of(obj, key.name) for key in keys.key_blocks[1:]}
    for key in list(keys.key_blocks[1:]):
        obj.shape_key_remove(key)
    keys.use_relative = False
    for (name, shape), frame in zip(shapes.items(), frames, strict=True):
        keys.eval_time = frame
        obj.shape_key_add(name=name, from_mix=False).data.foreach_set("co", shape.astype(np.float32).ravel())
    return keys


def shown(obj):
    """Vertices as the shape keys move them."""
    bpy.context.view_layer.update()
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return np.array([vertex.co for vertex in mesh.vertices])


def test_absolute_keys_stay_absolute(pair):
    source, target = pair
    keys = make_absolute(source, [12.5, 40])
    keys.key_blocks["Swell"].interpolation = "KEY_CARDINAL"
    keys.eval_time = 12.5
    for _ in range(2):  # the second time they are there already
        assert carry() == {"FINISHED"}
        carried = target.data.shape_keys
        assert not carried.use_relative
        assert carried.eval_time == 12.5
        assert [(key.name, key.frame) for key in carried.key_blocks] == [("Basis", 0), ("Swell", 12.5), ("Lift", 40)]
        assert carried.key_blocks["Swell"].interpolation == "KEY_CARDINAL"
        np.testing.assert_allclose(shown(target) - positions(target), offsets_of(target, "Swell"), atol=1e-5)


def test_absolute_keys_become_relative_beside_others(pair):
    source, target = pair
    make_absolute(source, [10, 20])
    add_key(target, "Own", 0 * positions(target))
    assert carry() == {"FINISHED"}
    assert target.data.shape_keys.use_relative
    assert names(target) == ["Basis", "Own", "Swell", "Lift"]
    assert "they are relative" in bpy.context.scene.hiermatch_retarget.report.notes


@pytest.mark.parametrize("absolute", [False, True])
def test_the_action_of_the_keys_is_shared(pair, absolute):
    source, target = pair
    keys = make_absolute(source, [10, 20]) if absolute else source.data.shape_keys
    moved = keys if absolute else keys.key_blocks["Swell"]
    for frame, value in ((1, 0), (11, 10 if absolute else 1)):
        setattr(moved, "eval_time" if absolute else "value", value)
        moved.keyframe_insert("eval_time" if absolute else "value", frame=frame)
    carry(key_action=False)
    assert target.data.shape_keys.animation_data is None
    assert carry() == {"FINISHED"}
    assert target.data.shape_keys.animation_data.action == keys.animation_data.action
    bpy.context.scene.frame_set(11)
    np.testing.assert_allclose(shown(target) - positions(target), offsets_of(target, "Swell"), atol=1e-5)
    assert f'the action "{keys.animation_data.action.name}"' in bpy.context.scene.hiermatch_retarget.report.done


def test_locked_keys_stay_as_they_are(pair):
    target = pair[1]
    own = np.full_like(positions(target), 0.3)
    add_key(target, "Swell", own).lock_shape = True
    assert carry() == {"FINISHED"}
    assert names(target) == ["Basis", "Swell", "Lift"]
    np.testing.assert_allclose(offsets_of(target, "Swell"), own, atol=1e-6)
    assert 'were left alone: "Swell"' in bpy.context.scene.hiermatch_retarget.report.notes


def test_an_action_of_its_own_stays(pair):
    source, target = pair
    source.data.shape_keys.key_blocks["Swell"].keyframe_insert("value", frame=1)
    own = add_key(target, "Own", 0 * positions(target))
    own.keyframe_insert("value", frame=1)
    mine = target.data.shape_keys.animation_data.action
    assert carry() == {"FINISHED"}
    assert target.data.shape_keys.animation_data.action == mine
    assert "keep their own action" in bpy.context.scene.hiermatch_retarget.report.notes


def test_bad_input_changes_nothing(pair):
    source, target = pair
    for options, words in (
        ({"key_choice": "NAMED", "key_names": "Swell, Smile"}, '"Smile"'),
        ({"key_choice": "NAMED", "key_names": " ,"}, "No shape key is named"),
    ):
        with pytest.raises(RuntimeError, match=words):
            carry(**options)
    source.active_shape_key_index = 0
    with pytest.raises(RuntimeError, match="is its basis"):
        carry(key_choice="ACTIVE")
    sharer = bpy.data.objects.new("Sharer", target.data)
    with pytest.raises(RuntimeError, match="shares its mesh"):
        carry()
    bpy.data.objects.remove(sharer)
    assert names(target) == []
    target.shape_key_add(name="Swell")
    with pytest.raises(RuntimeError, match="basis of the shape keys"):
        carry()
    target.data.shape_keys.use_relative = False
    with pytest.raises(RuntimeError, match="are absolute"):
        carry()
    assert names(target) == ["Swell"]
    source.shape_key_clear()
    with pytest.raises(RuntimeError, match="has no shape keys"):
        carry()
