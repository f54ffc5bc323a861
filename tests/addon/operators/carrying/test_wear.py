# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.wear`, as a script and a person use it."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.jobs import match_job, transfer_job
from hiermatch.hiermatch_addon.scene.character import parts_of, side_of
from hiermatch.hiermatch_addon.storage.linked_matches import linked_prefixes
from hiermatch.hiermatch_addon.transfers.wearing import wear_transfer
from hiermatch.hiermatch_addon.transfers.wearing.fit_colors import carriers_of_fit

from tests.addon.garments import add_item, add_twin, depths, fitted, in_world, made_copies, wear
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
    assert '"Shirt on Target" was fitted' in report.remarks
    name = copy.name
    assert wear("Shirt") == {"FINISHED"}
    assert fitted("Shirt").name == name
    assert len(bpy.data.collections["Outfit of Target"].objects) == 2
    assert source.name == "Source"
    assert coat.name == "Coat"


def test_of_several_bodies_it_is_said_on_which_an_item_is_to_be_checked(dressed_pair, monkeypatch):
    _, target, *_ = dressed_pair
    add_twin(target)
    monkeypatch.setattr(wear_transfer, "doubt", lambda name, _: f'"{name}" should be checked: it is a test.')
    named = [{"name": "Target"}, {"name": "Twin"}]
    assert wear("Shirt", target="", targets=named) == {"FINISHED"}
    report = bpy.context.scene.hiermatch_retarget.report
    for name in made_copies():
        assert f'"{name}" was fitted' in report.remarks
        assert f'"{name}" should be checked' in report.notes
    assert len(made_copies()) == 2


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


def test_what_is_painted_on_a_copy_is_said_to_change_nothing(dressed_pair):
    _, _, shirt, _ = dressed_pair
    shirt.vertex_groups.new(name="Loose").add([1, 2], 1.0, "REPLACE")
    assert wear("Shirt") == {"FINISHED"}
    assert "Loose" in fitted("Shirt").vertex_groups
    fitted("Shirt").vertex_groups.new(name="Tight").add([3, 4], 1.0, "REPLACE")
    assert wear("Shirt") == {"FINISHED"}
    notes = bpy.context.scene.hiermatch_retarget.report.notes
    assert 'What was painted on "Shirt on Target" in "Tight" changes nothing: paint it on "Shirt".' in notes


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


def test_a_body_of_a_library_is_dressed_as_long_as_nothing_is_written_on_it(dressed_pair, tmp_path, monkeypatch):
    source, target, *_ = dressed_pair
    for body in (source, target):
        assert bpy.ops.hiermatch.clear(object=body.name) == {"FINISHED"}
    library = str(tmp_path / "bodies.blend")
    bpy.data.libraries.write(library, {target}, fake_user=True)
    bpy.data.objects.remove(target)
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = ["Target"]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="is linked from"):
        wear("Shirt", wear_hide="KEY")
    count = []
    real = match_job.match_steps
    monkeypatch.setattr(match_job, "match_steps", lambda *bodies, **names: count.append(1) or real(*bodies, **names))
    for _ in range(2):
        assert wear("Shirt") == {"FINISHED"}
        assert made_copies() == ["Shirt on Target"]
    assert count == [1]  # the source keeps it
    assert linked_prefixes(source) == ("HM",)
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
    assert carriers_of_fit(bpy.context.view_layer) == [fitted("Shirt")]
    assert target.modifiers["Below Clothes"].vertex_group == "Below Clothes"
    assert "Below Clothes" not in target.data.shape_keys.key_blocks
    assert {"Distance to Skin", "Pushed", "Uncertain"} <= set(fitted("Shirt").data.attributes.keys())
    assert wear("Shirt", wear_hide="KEY") == {"FINISHED"}
    assert "Below Clothes" not in target.modifiers
    assert "Below Clothes" not in target.vertex_groups
    key = target.data.shape_keys.key_blocks["Below Clothes"]
    assert key.value == 1
    key.value = 0.5
    assert wear("Shirt", wear_hide="KEY") == {"FINISHED"}
    assert key.value == 0.5


def test_colors_of_an_original_say_nothing_of_its_copy(dressed_pair):
    _, _, shirt, _ = dressed_pair
    assert wear("Shirt", wear_result="KEY", wear_colors=True) == {"FINISHED"}
    shirt.data.color_attributes.new("Dye", "FLOAT_COLOR", "POINT")
    assert wear("Shirt") == {"FINISHED"}
    assert carriers_of_fit(bpy.context.view_layer) == [shirt]
    assert fitted("Shirt").data.color_attributes.keys() == ["Dye"]


def test_the_group_of_what_was_hidden_below_clothes_stays_if_a_modifier_of_the_user_needs_it(dressed_pair):
    _, target, *_ = dressed_pair
    assert wear("Shirt", wear_hide="MASK") == {"FINISHED"}
    target.modifiers.new("Own", "SMOOTH").vertex_group = "Below Clothes"
    assert wear("Shirt", wear_hide="KEY") == {"FINISHED"}
    assert "Below Clothes" not in target.modifiers
    assert target.modifiers["Own"].vertex_group == "Below Clothes"
    assert weights_of(target)["Below Clothes"]


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
    assert "kept the shape of 1 rigid part." in bpy.context.scene.hiermatch_retarget.report.remarks
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
