# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.wear`, as a script and a person use it."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.jobs import transfer_job
from hiermatch.hiermatch_addon.scene.character import parts_of, side_of
from hiermatch.hiermatch_addon.transfers.wearing import wear_transfer

from tests.addon.garments import add_item, depths, fitted, in_world, wear
from tests.addon.rigs import add_armature
from tests.addon.scenes import DENSE, snapshot, weights_of
from tests.addon.shape_keys import positions


def test_items_are_fitted_as_copies_and_again_in_place(dressed_pair):
    source, target, shirt, coat = dressed_pair
    material = bpy.data.materials.new("Cotton")
    shirt.data.materials.append(material)
    shirt["size"] = "M"
    shirt.modifiers.new("Thick", "SOLIDIFY").thickness = 0.01
    before = positions(shirt).copy()
    assert wear("Shirt", "Coat") == {"FINISHED"}
    copy = fitted("Shirt")
    assert copy.users_collection[0].name == "Outfit of Target"
    assert copy.data.materials[0] == material
    assert copy["size"] == "M"
    assert [modifier.type for modifier in copy.modifiers] == ["SOLIDIFY"]
    assert depths(copy, target).max() < 1e-4
    assert depths(fitted("Coat"), target).max() < 1e-4
    np.testing.assert_array_equal(positions(shirt), before)
    report = bpy.context.scene.hiermatch_retarget.report
    assert "2 items" in report.done
    assert '"Shirt" was fitted' in report.remarks
    name = copy.name
    assert wear("Shirt") == {"FINISHED"}
    assert fitted("Shirt").name == name
    assert len(bpy.data.collections["Outfit of Target"].objects) == 2
    assert source.name == "Source"
    assert coat.name == "Coat"


def made_copies():
    return sorted(obj.name for obj in bpy.data.objects if "hiermatch_body" in obj)


def test_copies_are_found_again_after_renaming(dressed_pair):
    _, target, shirt, _ = dressed_pair
    assert wear("Shirt", "Coat") == {"FINISHED"}
    target.name, shirt.name = "Giant", "Blouse"
    fitted("Coat").name = "My Coat"
    assert wear("Blouse", target="Giant") == {"FINISHED"}
    assert made_copies() == ["Blouse on Giant", "My Coat"]
    assert fitted("Coat", "Giant").name == "My Coat"
    assert [one.name for one in bpy.data.collections if "hiermatch_body" in one] == ["Outfit of Giant"]
    assert not set(fitted("Blouse", "Giant").keys()) & {"hiermatch_item_name", "hiermatch_body_name"}


def test_a_shape_key_is_found_again_after_renaming(dressed_pair):
    _, target, shirt, _ = dressed_pair
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    target.name = "Giant"
    assert wear("Shirt", target="Giant", wear_result="KEY") == {"FINISHED"}
    assert shirt.data.shape_keys.key_blocks.keys() == ["Basis", "Fit to Giant"]


def add_twin(body):
    """Add a copy of a body, at the same place."""
    twin = body.copy()
    twin.data = body.data.copy()
    twin.name = "Twin"
    bpy.context.scene.collection.objects.link(twin)
    bpy.context.view_layer.update()
    return twin


def test_what_another_body_wears_is_left_alone(dressed_pair):
    _, target, *_ = dressed_pair
    assert wear("Shirt") == {"FINISHED"}
    add_twin(target)
    assert wear("Shirt", target="Twin") == {"FINISHED"}
    assert made_copies() == ["Shirt on Target", "Shirt on Twin"]


def test_a_copy_that_was_edited_is_kept_aside(dressed_pair):
    assert dressed_pair
    assert wear("Shirt", "Coat") == {"FINISHED"}
    fitted("Shirt").data.vertices[3].co.z += 0.5
    where = tuple(fitted("Shirt").data.vertices[3].co)
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert made_copies() == ["Coat on Target", "Shirt on Target", "Shirt on Target (edited)"]
    kept = bpy.data.objects["Shirt on Target (edited)"]
    assert tuple(kept.data.vertices[3].co) == where
    assert kept.users_collection == fitted("Shirt").users_collection
    assert kept.hide_get()
    assert kept.hide_render
    assert "was edited after it had been fitted" in bpy.context.scene.hiermatch_retarget.report.notes
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert len(made_copies()) == 3


def thicken(copy):
    copy.modifiers["Thick"].thickness = 0.3


def nudge(copy):
    copy.location.z += 0.2


@pytest.mark.parametrize("change", [thicken, nudge])
def test_a_copy_whose_modifier_was_set_or_that_was_moved_is_kept_aside(dressed_pair, change):
    _, target, shirt, _ = dressed_pair
    shirt.modifiers.new("Thick", "SOLIDIFY").thickness = 0.01
    assert wear("Shirt") == {"FINISHED"}
    bpy.context.view_layer.update()
    target.location.y += 2  # with all that it wears
    fitted("Shirt").location.y += 2
    bpy.context.view_layer.update()
    assert wear("Shirt") == {"FINISHED"}
    assert made_copies() == ["Shirt on Target"]
    change(fitted("Shirt"))
    thickness, height = fitted("Shirt").modifiers["Thick"].thickness, fitted("Shirt").location.z
    assert wear("Shirt") == {"FINISHED"}
    assert made_copies() == ["Shirt on Target", "Shirt on Target (edited)"]
    kept = bpy.data.objects["Shirt on Target (edited)"]
    assert (kept.modifiers["Thick"].thickness, kept.location.z) == (thickness, height)


def test_a_surface_deform_is_bound_to_the_other_body(dressed_pair):
    source, target, shirt, _ = dressed_pair
    modifier = shirt.modifiers.new("Follow", "SURFACE_DEFORM")
    modifier.target = source
    with bpy.context.temp_override(object=shirt, active_object=shirt):
        bpy.ops.object.surfacedeform_bind(modifier="Follow")
    assert wear("Shirt") == {"FINISHED"}
    copy = fitted("Shirt")
    assert copy.modifiers["Follow"].target == target
    assert copy.modifiers["Follow"].is_bound
    before = positions(copy)
    for vertex in target.data.vertices:
        vertex.co.z += 0.5
    target.data.update()
    bpy.context.view_layer.update()
    mesh = copy.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    moved = np.array([vertex.co for vertex in mesh.vertices]) - before
    assert np.abs(np.abs(moved).max(axis=1) - 0.5).max() < 0.05


def test_a_shape_key_on_the_original(dressed_pair):
    _, target, shirt, _ = dressed_pair
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    key = shirt.data.shape_keys.key_blocks["Fit to Target"]
    assert key.value == 1
    assert not [obj for obj in bpy.data.objects if "hiermatch_body" in obj]
    moved = np.array([shirt.matrix_world @ point.co for point in key.data])
    assert np.linalg.norm(moved.mean(axis=0) - in_world(target).mean(axis=0)) < 0.3


def test_shape_keys_for_several_bodies_stay_as_far_on_as_they_are(dressed_pair):
    _, target, shirt, _ = dressed_pair
    add_twin(target)
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    assert wear("Shirt", target="Twin", wear_result="KEY") == {"FINISHED"}
    keys = shirt.data.shape_keys.key_blocks
    assert [keys["Fit to Target"].value, keys["Fit to Twin"].value] == [1, 0]
    keys["Fit to Twin"].value, keys["Fit to Twin"].slider_max = 0.5, 2
    for body in ("Target", "Twin"):
        assert wear("Shirt", target=body, wear_result="KEY") == {"FINISHED"}
    assert [keys["Fit to Target"].value, keys["Fit to Twin"].value] == [1, 0.5]
    assert keys["Fit to Twin"].slider_max == 2


def test_a_copy_of_an_item_with_shape_keys_for_bodies_is_not_fitted_twice(dressed_pair):
    _, target, shirt, coat = dressed_pair
    coat.shape_key_add(name="Basis")
    coat.shape_key_add(name="Puffed", from_mix=False)
    assert wear("Shirt", "Coat", wear_result="KEY") == {"FINISHED"}
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert fitted("Shirt").data.shape_keys is None
    assert fitted("Coat").data.shape_keys.key_blocks.keys() == ["Basis", "Puffed"]
    assert shirt.data.shape_keys.key_blocks["Fit to Target"].value == 1
    bpy.context.view_layer.update()
    seen = fitted("Coat").evaluated_get(bpy.context.evaluated_depsgraph_get())
    middle = np.mean([seen.matrix_world @ vertex.co for vertex in seen.data.vertices], axis=0)
    assert np.linalg.norm(middle - in_world(target).mean(axis=0)) < 0.3


def test_what_is_painted_on_a_copy_is_said_to_change_nothing(dressed_pair):
    _, _, shirt, _ = dressed_pair
    shirt.vertex_groups.new(name="Loose").add([1, 2], 1.0, "REPLACE")
    assert wear("Shirt") == {"FINISHED"}
    assert "Loose" in fitted("Shirt").vertex_groups
    fitted("Shirt").vertex_groups.new(name="Tight").add([3, 4], 1.0, "REPLACE")
    assert wear("Shirt") == {"FINISHED"}
    notes = bpy.context.scene.hiermatch_retarget.report.notes
    assert 'What was painted on "Shirt on Target" in "Tight" changes nothing: paint it on "Shirt".' in notes


def test_a_locked_shape_key_is_not_written_over(dressed_pair):
    _, _, shirt, _ = dressed_pair
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    shirt.data.shape_keys.key_blocks["Fit to Target"].lock_shape = True
    with pytest.raises(RuntimeError, match='The shape key "Fit to Target" of "Shirt" is locked'):
        wear("Shirt", wear_result="KEY")


def test_bodies_with_long_names_get_shape_keys_of_their_own(dressed_pair):
    _, target, shirt, _ = dressed_pair
    other = add_twin(target)
    for body, end in ((target, "A"), (other, "B")):
        body.name = "\u4eba" * 20 + end  # with "Fit to " longer than the name of a key can be
    for body in (target, other, target):
        assert wear("Shirt", target=body.name, wear_result="KEY") == {"FINISHED"}
    _, *made = shirt.data.shape_keys.key_blocks.keys()
    assert len(made) == 2
    assert all(name.startswith("Fit to \u4eba\u4eba") for name in made)


def test_keys_of_an_item_go_along(dressed_pair):
    _, _, shirt, _ = dressed_pair
    shirt.shape_key_add(name="Basis")
    key = shirt.shape_key_add(name="Puffed")
    up = np.zeros((len(key.data), 3))
    up[:, 2] = 0.1
    key.data.foreach_set("co", (positions(shirt) + up).astype(np.float32).ravel())
    assert wear("Shirt") == {"FINISHED"}
    copy = fitted("Shirt")
    basis, puffed = (np.array([p.co for p in copy.data.shape_keys.key_blocks[n].data]) for n in ("Basis", "Puffed"))
    lengths = np.linalg.norm(puffed - basis, axis=1)
    assert lengths.min() > 0.03
    assert lengths.max() < 0.4


def add_belly(body, name="Belly"):
    """Add a key that moves one end of a body outwards; return which of its vertices."""
    if body.data.shape_keys is None:
        body.shape_key_add(name="Basis")
    key = body.shape_key_add(name=name, from_mix=False)
    key.value = 0
    points = positions(body)
    chosen = points[:, 0] > np.quantile(points[:, 0], 0.8)
    normals = np.array([vertex.normal for vertex in body.data.vertices])
    key.data.foreach_set("co", (points + 0.1 * chosen[:, None] * normals).astype(np.float32).ravel())
    return chosen


def evaluated(obj):
    bpy.context.view_layer.update()
    made = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    matrix = np.array(made.matrix_world)
    return np.array([vertex.co for vertex in made.data.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]


def test_items_follow_the_keys_of_the_body(dressed_pair):
    _, target, *_ = dressed_pair
    add_belly(target)
    target.data.shape_keys.key_blocks["Belly"].slider_max = 2
    target.shape_key_add(name="Nothing", from_mix=False)
    assert wear("Shirt", "Coat") == {"FINISHED"}
    for name in ("Shirt", "Coat"):
        copy = fitted(name)
        assert copy.data.shape_keys.key_blocks.keys() == ["Basis", "Belly"]
        assert copy.data.shape_keys.key_blocks["Belly"].slider_max == 2
        before = evaluated(copy)
        target.data.shape_keys.key_blocks["Belly"].value = 1
        moved = np.linalg.norm(evaluated(copy) - before, axis=1)
        target.data.shape_keys.key_blocks["Belly"].value = 0
        assert moved.max() > 0.05
        assert (moved == 0).any()
    assert 'follows 1 shape key of "Target"' in bpy.context.scene.hiermatch_retarget.report.remarks
    assert wear("Shirt", wear_keys=False) == {"FINISHED"}
    assert fitted("Shirt").data.shape_keys is None


def drive(obj, name, body, leader):
    """Let a key of an object be driven by one of a body's."""
    driver = obj.data.shape_keys.driver_add(f'key_blocks["{name}"].value').driver
    driver.type = "AVERAGE"
    place = driver.variables.new().targets[0]
    place.id_type, place.id = "KEY", body.data.shape_keys
    place.data_path = f'key_blocks["{leader}"].value'


def test_keys_of_an_item_that_the_body_drives_are_driven_by_the_other_body(dressed_pair):
    source, target, shirt, _ = dressed_pair
    for body in (source, target):
        add_belly(body)
    add_belly(source, "Tail")
    for name in ("Belly", "Tail"):
        add_belly(shirt, name)
        drive(shirt, name, source, name)
    assert wear("Shirt") == {"FINISHED"}
    keys = fitted("Shirt").data.shape_keys
    assert keys.key_blocks.keys() == ["Basis", "Belly", "Tail"]
    read = {curve.data_path: curve.driver.variables[0].targets[0].id for curve in keys.animation_data.drivers}
    assert read == {
        'key_blocks["Belly"].value': target.data.shape_keys,
        'key_blocks["Tail"].value': source.data.shape_keys,
    }
    assert f'still read from "{source.data.shape_keys.name}"' in bpy.context.scene.hiermatch_retarget.report.notes


def test_selected_items_and_those_of_a_collection(dressed_pair):
    _, _, shirt, coat = dressed_pair
    shirt.select_set(state=True)
    assert wear() == {"FINISHED"}
    assert fitted("Shirt")
    closet = bpy.data.collections.new("Closet")
    bpy.context.scene.collection.children.link(closet)
    closet.objects.link(coat)
    assert wear(collection="Closet") == {"FINISHED"}
    assert fitted("Coat")
    with pytest.raises(RuntimeError, match="no collection"):
        wear(collection="Wardrobe")


def test_what_a_target_wears_already_is_no_part_of_it(dressed_pair):
    """Picked by its armature, it is the same body when it is dressed."""
    source, target, _, _ = dressed_pair
    rig = add_armature("Rig B")
    target.vertex_groups.new(name="neck").add(range(len(target.data.vertices)), 1.0, "REPLACE")
    target.modifiers.new("Armature", "ARMATURE").object = rig
    for _ in range(2):
        assert wear("Shirt", target="Rig B", wear_poses=False) == {"FINISHED"}
        assert fitted("Shirt", target.name).modifiers["Armature"].object == rig
        assert parts_of(side_of(rig, bpy.context.view_layer)) == (target,)
    assert source.name == "Source"


def test_an_item_below_an_unevenly_scaled_parent_is_fitted_where_it_belongs(dressed_pair):
    """A copy hangs on nothing, and what hangs on nothing cannot be sheared."""
    shirt = dressed_pair[2]
    assert wear("Shirt") == {"FINISHED"}
    expected, stood = in_world(fitted("Shirt")), in_world(shirt)
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    empty.scale, empty.rotation_euler = (1.0, 3.0, 0.5), (0.3, 0.5, 0.2)
    shirt.parent, shirt.rotation_euler = empty, (0.5, 0.2, 1.0)
    bpy.context.view_layer.update()
    matrix = np.linalg.inv(np.array(shirt.matrix_world))
    local = stood @ matrix[:3, :3].T + matrix[:3, 3]
    shirt.data.vertices.foreach_set("co", local.astype(np.float32).ravel())
    assert wear("Shirt") == {"FINISHED"}
    bpy.context.view_layer.update()
    np.testing.assert_allclose(in_world(fitted("Shirt")), expected, atol=1e-3)


def test_a_copy_that_was_taken_out_of_the_scene_is_shown_again(dressed_pair):
    del dressed_pair
    scene = bpy.context.scene
    assert wear("Shirt") == {"FINISHED"}
    bpy.data.collections["Outfit of Target"].objects.unlink(fitted("Shirt"))
    assert wear("Shirt") == {"FINISHED"}
    assert fitted("Shirt").name in scene.objects
    scene.collection.children.unlink(bpy.data.collections["Outfit of Target"])
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert {fitted("Shirt").name, fitted("Coat").name} <= set(scene.objects.keys())
    assert bpy.data.collections["Outfit of Target"].users == 1


@pytest.mark.parametrize("overridden", [False, True], ids=["linked", "overridden"])
def test_items_of_a_library_are_copied_into_the_file(dressed_pair, tmp_path, overridden):
    """A wardrobe is often a file of its own."""
    shirt = dressed_pair[2]
    shirt.modifiers.new("Thick", "SOLIDIFY").thickness = 0.01
    stood = in_world(shirt)
    wardrobe = str(tmp_path / "wardrobe.blend")
    bpy.data.libraries.write(wardrobe, {shirt}, fake_user=True)
    bpy.data.objects.remove(shirt)
    with bpy.data.libraries.load(wardrobe, link=True) as (_, wanted):
        wanted.objects = ["Shirt"]
    linked = wanted.objects[0]
    item = linked.override_create() if overridden else linked
    bpy.context.scene.collection.objects.link(item)
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="cannot be written to"):
        wear("Shirt", wear_result="KEY")
    for _ in range(2):
        assert wear("Shirt") == {"FINISHED"}
        copy = fitted("Shirt")
        owned = (copy, copy.data)
        assert {(one.library, one.override_library) for one in owned} == {(None, None)}
        assert copy.modifiers.keys() == ["Thick"]
    np.testing.assert_array_equal(in_world(item), stood)


def test_a_body_of_a_library_is_dressed_as_long_as_nothing_is_written_on_it(dressed_pair, tmp_path):
    source, target, *_ = dressed_pair
    library = str(tmp_path / "bodies.blend")
    bpy.data.libraries.write(library, {target}, fake_user=True)
    bpy.data.objects.remove(target)
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = ["Target"]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="is linked from"):
        wear("Shirt", wear_hide="KEY")
    for _ in range(2):
        assert wear("Shirt") == {"FINISHED"}
        assert made_copies() == ["Shirt on Target"]
    assert source.library is None
    source.vertex_groups.new(name="neck").add(range(len(source.data.vertices)), 1.0, "REPLACE")
    source.modifiers.new("Armature", "ARMATURE").object = add_armature("Rig")
    bpy.context.view_layer.update()
    before = snapshot()
    with pytest.raises(RuntimeError, match="is linked from"):  # as it would get a rig
        wear("Coat")
    assert snapshot() == before


@pytest.mark.parametrize("what", ["an item", "bones"])
def test_what_was_edited_meanwhile_is_told_before_anything_is_written(dressed_pair, monkeypatch, what):
    source, target, shirt, _ = dressed_pair
    rig = add_armature("Rig")
    source.modifiers.new("Armature", "ARMATURE").object = rig
    assert bpy.ops.hiermatch.clear(object="Source") == bpy.ops.hiermatch.clear(object="Target") == {"FINISHED"}
    for name, value in DENSE.items():
        setattr(bpy.context.scene.hiermatch, name, value)
    before = snapshot()["meshes"]
    real = wear_transfer.wear_steps

    def steps(*arguments, **names):
        made = yield from real(*arguments, **names)
        if what == "bones":
            bpy.data.objects.remove(rig)
        else:
            shirt.data.vertices[0].co.z += 1
        return made

    monkeypatch.setattr(wear_transfer, "wear_steps", steps)
    with pytest.raises(RuntimeError, match="was edited meanwhile"):
        wear("Shirt", wear_fit_rig=False)
    after = snapshot()["meshes"]
    assert [after[body.name] for body in (source, target)] == [before[body.name] for body in (source, target)]
    assert not made_copies()


def test_a_mirrored_match_is_refused_before_the_work(dressed_pair, monkeypatch):
    assert dressed_pair
    bpy.ops.hiermatch.flip(object="Source")
    monkeypatch.setattr(transfer_job, "fit_rig_steps", None)
    monkeypatch.setattr(wear_transfer, "wrap_steps", None)
    with pytest.raises(RuntimeError, match=r"exchanges left and right .* Use Mirrored Match once more"):
        wear("Shirt")


def test_drivers_of_modifiers_come_along_and_nothing_else_that_moves_an_item(dressed_pair):
    source, target, shirt, _ = dressed_pair
    source["tailor"], target["tailor"] = 0.02, 0.03
    shirt["size"] = 3
    modifier = shirt.modifiers.new("Thick", "SOLIDIFY")
    modifier.thickness = 0.01
    shirt.keyframe_insert("location", frame=1)
    animation = shirt.animation_data
    strip, animation.action = animation.nla_tracks.new().strips.new("Strip", 1, animation.action), None
    strip.select, animation.nla_tracks.active, animation.use_tweak_mode = True, animation.nla_tracks[0], True
    paths = {'modifiers["Thick"].thickness': (source, '["tailor"]'), 'modifiers["Thick"].offset': (shirt, '["size"]')}
    for path, (leader, read) in {**paths, "hide_render": (source, '["tailor"]')}.items():
        driver = shirt.driver_add(path).driver
        driver.type = "AVERAGE"
        place = driver.variables.new().targets[0]
        place.id, place.data_path = leader, read
    assert wear("Shirt") == {"FINISHED"}
    copy = fitted("Shirt")
    read = {curve.data_path: curve.driver.variables[0].targets[0].id for curve in copy.animation_data.drivers}
    assert read == {'modifiers["Thick"].thickness': target, 'modifiers["Thick"].offset': copy}
    assert copy.animation_data.action is None
    assert not copy.animation_data.nla_tracks
    assert animation.use_tweak_mode
    assert len(shirt.animation_data.drivers) == 3
    del target["tailor"]
    assert wear("Shirt") == {"FINISHED"}
    assert 'still read from "Source"' in bpy.context.scene.hiermatch_retarget.report.notes


def test_the_body_below_is_drawn_in_or_hidden(dressed_pair):
    _, target, *_ = dressed_pair
    assert wear("Shirt", wear_hide="KEY") == {"FINISHED"}
    assert target.data.shape_keys.key_blocks["Below Clothes"].value == 1
    assert wear("Shirt", wear_hide="MASK", wear_colors=True) == {"FINISHED"}
    assert target.modifiers["Below Clothes"].vertex_group == "Below Clothes"
    assert "Below Clothes" not in target.data.shape_keys.key_blocks
    assert {"Distance to Skin", "Pushed", "Uncertain"} <= set(fitted("Shirt").data.attributes.keys())
    assert wear("Shirt", wear_hide="KEY") == {"FINISHED"}
    assert "Below Clothes" not in target.modifiers
    assert target.data.shape_keys.key_blocks["Below Clothes"].value == 1


def keep_half(item, sign):
    """Delete one half of an item."""
    edited = bmesh.new()
    edited.from_mesh(item.data)
    gone = [vertex for vertex in edited.verts if sign * vertex.co.x < 0]
    bmesh.ops.delete(edited, geom=gone, context="VERTS")
    edited.to_mesh(item.data)
    edited.free()


def test_the_body_stays_hidden_below_what_it_wears_already(dressed_pair):
    source, target, shirt, _ = dressed_pair
    trousers = add_item(source, "Trousers", 0.02)
    keep_half(shirt, 1)
    keep_half(trousers, -1)

    def hidden():
        return set(weights_of(target)["Below Clothes"])

    assert wear("Shirt", "Trousers", wear_hide="MASK") == {"FINISHED"}
    both = hidden()
    assert wear("Shirt", wear_hide="MASK") == {"FINISHED"}
    assert hidden() == both
    fitted("Trousers").hide_set(state=True)
    assert wear("Shirt", wear_hide="MASK") == {"FINISHED"}
    assert hidden() < both


def test_how_an_item_fits_is_kept_on_it(dressed_pair):
    _, _, shirt, _ = dressed_pair
    shirt.hiermatch_wear.fit = "RIGID"
    assert wear("Shirt") == {"FINISHED"}
    assert "1 rigid part" in bpy.context.scene.hiermatch_retarget.report.remarks
    assert fitted("Shirt").hiermatch_wear.fit == "RIGID"
    shirt.hiermatch_wear.fit = "LOOSE"
    assert wear("Shirt") == {"FINISHED"}
    assert "rigid part" not in bpy.context.scene.hiermatch_retarget.report.remarks


def move_away(shirt):
    shirt.location.x += 30


def onto_the_other(shirt):
    shirt.matrix_world = bpy.data.objects["Target"].matrix_world
    shirt.data.vertices.foreach_set("co", positions(bpy.data.objects["Target"]).astype(np.float32).ravel())


@pytest.mark.parametrize(
    ("items", "change", "message"),
    [
        (["Source"], None, "is the body itself"),
        (["Shirt"], move_away, "is far from"),
        (["Shirt"], onto_the_other, "Swap Source and Target"),
        (["Hair"], None, "Convert"),
        (["Shirt Rig"], None, r'"Shirt Rig" is an armature, .* Name those that it moves: "Shirt"\.'),
        (["Source Rig"], None, '"Source Rig" is an armature, .* moves none but a body'),
        (["Nothing"], None, "no object called"),
        ([], None, "No clothes"),
    ],
)
def test_what_cannot_be_worn_changes_nothing(dressed_pair, items, change, message):
    shirt = dressed_pair[2]
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Hair", bpy.data.curves.new("Hair", "CURVE")))
    for obj in (shirt, dressed_pair[0]):
        if any("Rig" in name for name in items):
            rig = bpy.data.objects.new(f"{obj.name} Rig", bpy.data.armatures.new("Rig"))
            bpy.context.scene.collection.objects.link(rig)
            obj.modifiers.new("Armature", "ARMATURE").object = rig
    if change is not None:
        change(shirt)
        bpy.context.view_layer.update()
    before = snapshot()
    with pytest.raises(RuntimeError, match=message):
        wear(*items)
    assert snapshot() == before


def test_bodies_of_several_objects(dressed_pair):
    """Each has eyes that are objects of their own, and all of it is covered."""
    source, target, _, _ = dressed_pair
    for body, name in ((source, "Eyes"), (target, "Other Eyes")):
        mesh = bpy.data.meshes.new(name)
        corners = in_world(body)[[polygon.vertices[0] for polygon in body.data.polygons[:3]]]
        mesh.from_pydata((corners.mean(axis=0) + 0.01 * np.vstack([np.eye(3), np.zeros(3)])).tolist(), [], [(0, 1, 2)])
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    bpy.context.view_layer.update()
    done = wear("Shirt", source="Source + Eyes", target="Target + Other Eyes", wear_hide="KEY")
    assert done == {"FINISHED"}
    copy = fitted("Shirt")
    assert depths(copy, target).max() < 1e-4
    assert "Below Clothes" in target.data.shape_keys.key_blocks


def test_items_that_are_parts_of_the_source_are_worn_by_the_others(dressed_pair):
    _, target, _, _ = dressed_pair
    assert wear("Coat", source="Source + Coat") == {"FINISHED"}
    assert depths(fitted("Coat"), target).max() < 1e-4
    bpy.data.objects["Shirt"].select_set(state=True)
    assert wear(source="Source + Shirt") == {"FINISHED"}
    assert fitted("Shirt")


def test_where_all_meshes_of_a_character_are_selected_it_is_said_that_they_are_its_body(dressed_pair):
    for obj in (dressed_pair[0], dressed_pair[2]):
        obj.select_set(state=True)
    before = snapshot()
    with pytest.raises(RuntimeError, match="all of its meshes count as its body"):
        wear(source="Source + Shirt")
    assert snapshot() == before
