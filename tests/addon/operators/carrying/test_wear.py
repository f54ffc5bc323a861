# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.wear`, as a script and a person use it."""

from __future__ import annotations

from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from hiermatch.engine import Progress
from hiermatch.hiermatch_addon.scene.character import Character, joined, parts_of, read_surface, side_of, whole
from hiermatch.hiermatch_addon.scene.garments import undressed
from hiermatch.hiermatch_addon.transfers.wearing import item_motion
from mathutils import Vector
from scipy.sparse import csr_array

from tests.addon.garments import add_item
from tests.addon.rigs import add_armature
from tests.addon.scenes import snapshot
from tests.addon.shape_keys import positions


def in_world(obj):
    matrix = np.array(obj.matrix_world)
    return positions(obj) @ matrix[:3, :3].T + matrix[:3, 3]


@pytest.fixture
def pair(dense_pair):
    """A matched pair, and a shirt and a coat on the source."""
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    source, target = dense_pair
    shirt, coat = add_item(source, "Shirt", 0.02), add_item(source, "Coat", 0.05)
    bpy.ops.object.select_all(action="DESELECT")
    return source, target, shirt, coat


def wear(*items, **options):
    named = [{"name": item} for item in items]
    return bpy.ops.hiermatch.wear(
        **({"source": "Source", "target": "Target", "items": named, "refine": False} | options)
    )


def fitted(item, body="Target"):
    found = [obj for obj in bpy.data.objects if obj.get("hiermatch_item") == item and obj.get("hiermatch_body") == body]
    assert len(found) == 1
    return found[0]


def depths(obj, body):
    """How far vertices are inside a body, by its nearest face."""
    into = body.matrix_world.inverted()
    found = []
    for point in in_world(obj):
        hit, place, normal, _ = body.closest_point_on_mesh(into @ Vector(point))
        assert hit
        found.append(-(into @ Vector(point) - place).dot(normal))
    return np.array(found)


def test_items_are_fitted_as_copies_and_again_in_place(pair):
    source, target, shirt, coat = pair
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


def test_a_shape_key_on_the_original(pair):
    _, target, shirt, _ = pair
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    key = shirt.data.shape_keys.key_blocks["Fit to Target"]
    assert key.value == 1
    assert not [obj for obj in bpy.data.objects if "hiermatch_body" in obj]
    moved = np.array([shirt.matrix_world @ point.co for point in key.data])
    assert np.linalg.norm(moved.mean(axis=0) - in_world(target).mean(axis=0)) < 0.3


def test_keys_of_an_item_go_along(pair):
    _, _, shirt, _ = pair
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


def test_items_follow_the_keys_of_the_body(pair):
    _, target, *_ = pair
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


def test_keys_of_an_item_that_the_body_drives_are_driven_by_the_other_body(pair):
    source, target, shirt, _ = pair
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


def test_selected_items_and_those_of_a_collection(pair):
    _, _, shirt, coat = pair
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


def test_all_that_the_armature_moves_gets_the_weights_of_the_other_rig(pair):
    source, target, shirt, _ = pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for bone in rigs[1].data.bones:
        bone.name = f"other {bone.name}"
    for obj, rig, name in ((source, rigs[0], "neck"), (shirt, rigs[0], "neck"), (target, rigs[1], "other neck")):
        obj.vertex_groups.new(name=name).add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
    assert wear(wear_poses=False) == {"FINISHED"}
    copy = fitted("Shirt")
    assert [obj.get("hiermatch_item") for obj in bpy.data.objects if "hiermatch_body" in obj] == ["Shirt"]
    assert copy.modifiers["Armature"].object == rigs[1]
    assert "other neck" in copy.vertex_groups
    assert "neck" not in copy.vertex_groups
    weights = [vertex.groups[0].weight for vertex in copy.data.vertices]
    np.testing.assert_allclose(weights, 1, atol=1e-3)


def test_what_a_target_wears_already_is_no_part_of_it(pair):
    """Picked by its armature, it is the same body when it is dressed."""
    source, target, _, _ = pair
    rig = add_armature("Rig B")
    target.vertex_groups.new(name="neck").add(range(len(target.data.vertices)), 1.0, "REPLACE")
    target.modifiers.new("Armature", "ARMATURE").object = rig
    for _ in range(2):
        assert wear("Shirt", target="Rig B", wear_poses=False) == {"FINISHED"}
        assert fitted("Shirt", target.name).modifiers["Armature"].object == rig
        assert parts_of(side_of(rig, bpy.context.view_layer)) == (target,)
    assert source.name == "Source"


def test_bones_of_an_item_come_along_onto_the_other_rig(pair):
    source, target, shirt, coat = pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for bone in rigs[1].data.bones:
        bone.name = f"other {bone.name}"
    bpy.context.view_layer.objects.active = rigs[0]
    bpy.ops.object.mode_set(mode="EDIT")
    middle = Vector(in_world(source).mean(axis=0))
    for name, parent, low in (("skirt", "neck", 0.0), ("skirt end", "skirt", 0.2), ("unused", "neck", 0.0)):
        made = rigs[0].data.edit_bones.new(name)
        made.parent = rigs[0].data.edit_bones[parent]
        made.head, made.tail = middle - Vector((0, 0, low)), middle - Vector((0, 0, low + 0.2))
        made.use_connect = name == "skirt end"
    bpy.ops.object.mode_set(mode="OBJECT")
    for obj, rig, names in (
        (source, rigs[0], ["neck"]),
        (shirt, rigs[0], ["neck", "skirt end"]),
        (coat, rigs[0], ["neck"]),
        (target, rigs[1], ["other neck"]),
    ):
        for name in names:
            obj.vertex_groups.new(name=name).add(range(len(obj.data.vertices)), 1 / len(names), "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
    before = rigs[1].data.bones.keys()
    for _ in range(2):  # again in place
        assert wear("Shirt", "Coat") == {"FINISHED"}
        bones = rigs[1].data.bones
        assert sorted(bones.keys()) == sorted([*before, "skirt", "skirt end"])
        assert bones["skirt"].parent.name == "other neck"
        assert bones["skirt end"].parent.name == "skirt"
        assert bones["skirt end"].use_connect
        points = in_world(target)
        head = np.array(rigs[1].matrix_world @ bones["skirt"].head_local)
        assert (points.min(axis=0) < head).all()
        assert (head < points.max(axis=0)).all()
        groups = {group.name: group.index for group in fitted("Shirt").vertex_groups}
        assert {"other neck", "skirt end"} <= set(groups)
        assert "neck" not in groups
        weights = [{one.group: one.weight for one in vertex.groups} for vertex in fitted("Shirt").data.vertices]
        np.testing.assert_allclose([each[groups["skirt end"]] for each in weights], 0.5, atol=1e-3)
        np.testing.assert_allclose([each[groups["other neck"]] for each in weights], 0.5, atol=1e-3)
        assert "skirt end" not in fitted("Coat").vertex_groups
    assert (
        '2 bones of the items were added to the rig of "Target"' in bpy.context.scene.hiermatch_retarget.report.remarks
    )


def test_an_item_below_an_unevenly_scaled_parent_is_fitted_where_it_belongs(pair):
    """A copy hangs on nothing, and what hangs on nothing cannot be sheared."""
    target, shirt = pair[1:3]
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
    assert target.name == "Target"


def test_a_copy_that_was_taken_out_of_the_scene_is_shown_again(pair):
    assert pair
    scene = bpy.context.scene
    assert wear("Shirt") == {"FINISHED"}
    bpy.data.collections["Outfit of Target"].objects.unlink(fitted("Shirt"))
    assert wear("Shirt") == {"FINISHED"}
    assert fitted("Shirt").name in scene.objects
    scene.collection.children.unlink(bpy.data.collections["Outfit of Target"])
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert {fitted("Shirt").name, fitted("Coat").name} <= set(scene.objects.keys())
    assert bpy.data.collections["Outfit of Target"].users == 1


def test_an_item_that_hangs_on_a_bone_is_moved_by_it_alone_and_fitted_at_rest(pair):
    """As helmets and glasses are in files for games."""
    source, target, shirt, _ = pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for obj, rig in ((source, rigs[0]), (target, rigs[1])):
        for name in ("neck", "tail"):
            obj.vertex_groups.new(name=name).add(range(len(obj.data.vertices)), 0.5, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
    stood = shirt.matrix_world.copy()
    shirt.parent, shirt.parent_type, shirt.parent_bone = rigs[0], "BONE", "neck"
    bpy.context.view_layer.update()
    shirt.matrix_world = stood
    found = []
    for turn in (0.0, 1.2):
        rigs[0].pose.bones["neck"].rotation_mode = "XYZ"
        rigs[0].pose.bones["neck"].rotation_euler = (turn, 0.0, turn)
        bpy.context.view_layer.update()
        assert wear("Shirt", wear_poses=False) == {"FINISHED"}
        copy = fitted("Shirt")
        neck = copy.vertex_groups["neck"].index
        weights = [{one.group: one.weight for one in vertex.groups} for vertex in copy.data.vertices]
        assert {each[neck] for each in weights} == {1.0}
        assert "tail" not in copy.vertex_groups
        assert copy.modifiers["Armature"].object == rigs[1]
        found.append(in_world(copy))
    np.testing.assert_allclose(found[1], found[0], atol=1e-3)
    for bone in rigs[1].data.bones:
        bone.name = f"other {bone.name}"
    assert wear("Shirt", wear_poses=False) == {"FINISHED"}
    assert "neck" not in fitted("Shirt").vertex_groups


@pytest.mark.parametrize("overridden", [False, True], ids=["linked", "overridden"])
def test_items_of_a_library_are_copied_into_the_file(pair, tmp_path, overridden):
    """A wardrobe is often a file of its own."""
    source, _, shirt, _ = pair
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
    assert source.name == "Source"


def test_weights_that_are_mended_for_poses_keep_to_the_limit(pair, monkeypatch):
    source, target, shirt, _ = pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for obj, rig in ((source, rigs[0]), (shirt, rigs[0]), (target, rigs[1])):
        obj.vertex_groups.new(name="neck").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig

    def spread_out(items, **_):
        yield Progress(0.5, "Weights")
        shapes = [item.weights.shape for item in items]
        return [
            SimpleNamespace(weights=csr_array(np.full(shape, 1 / shape[1])), changed=np.ones(shape[0], bool))
            for shape in shapes
        ]

    monkeypatch.setattr(item_motion, "mend_weights_steps", spread_out)
    assert wear("Shirt", wear_limit=2) == {"FINISHED"}
    copy = fitted("Shirt")
    bones = {group.index for group in copy.vertex_groups if group.name in rigs[1].data.bones}
    weights = [[one.weight for one in vertex.groups if one.group in bones] for vertex in copy.data.vertices]
    assert {sum(weight > 0 for weight in each) for each in weights} == {2}
    np.testing.assert_allclose([sum(each) for each in weights], 1, atol=1e-5)
    shirt.modifiers.remove(shirt.modifiers["Armature"])
    shirt.parent, shirt.parent_type, shirt.parent_bone = rigs[0], "BONE", "neck"
    bpy.context.view_layer.update()
    shirt.matrix_world = source.matrix_world
    assert wear("Shirt") == {"FINISHED"}  # what hangs on a bone moves as one
    assert not {"tail", "spine"} & set(fitted("Shirt").vertex_groups.keys())


def test_a_body_that_gets_another_rig_wears_its_clothes_with_that_the_next_time(pair):
    source, target, shirt, _ = pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for obj, rig in ((source, rigs[0]), (shirt, rigs[0]), (target, rigs[1])):
        obj.vertex_groups.new(name="neck").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
    assert wear("Shirt", target="Rig B", wear_poses=False) == {"FINISHED"}
    body = fitted("Shirt", target.name)["hiermatch_body"]
    bpy.ops.hiermatch.retarget(source="Source", target="Rig B", refine=False, rest_pose_like_source="OFF")
    made = target.modifiers[0].object
    assert made not in rigs
    remarks = bpy.context.scene.hiermatch_retarget.report.remarks
    assert f'still moved by "Rig B": "{fitted("Shirt", body).name}"' in remarks
    assert rigs[1].visible_get()  # as long as it moves something
    for name in ("Rig B", target.name):
        assert wear("Shirt", target=name, wear_poses=False) == {"FINISHED"}
        armatures = [one.object for one in fitted("Shirt", body).modifiers if one.type == "ARMATURE"]
        assert armatures == [made]


def test_drivers_of_modifiers_come_along_and_nothing_else_that_moves_an_item(pair):
    source, target, shirt, _ = pair
    source["tailor"], target["tailor"] = 0.02, 0.03
    shirt["size"] = 3
    modifier = shirt.modifiers.new("Thick", "SOLIDIFY")
    modifier.thickness = 0.01
    shirt.keyframe_insert("location", frame=1)
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
    assert len(shirt.animation_data.drivers) == 3
    del target["tailor"]
    assert wear("Shirt") == {"FINISHED"}
    assert 'still read from "Source"' in bpy.context.scene.hiermatch_retarget.report.notes


def test_the_body_below_is_drawn_in_or_hidden(pair):
    _, target, *_ = pair
    assert wear("Shirt", wear_hide="KEY") == {"FINISHED"}
    assert target.data.shape_keys.key_blocks["Below Clothes"].value == 1
    assert wear("Shirt", wear_hide="MASK", wear_colors=True) == {"FINISHED"}
    assert target.modifiers["Below Clothes"].vertex_group == "Below Clothes"
    assert {"Distance to Skin", "Pushed", "Uncertain"} <= set(fitted("Shirt").data.attributes.keys())


def test_how_an_item_fits_is_kept_on_it(pair):
    _, _, shirt, _ = pair
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
        (["Nothing"], None, "no object called"),
        ([], None, "No clothes"),
    ],
)
def test_what_cannot_be_worn_changes_nothing(pair, items, change, message):
    shirt = pair[2]
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Hair", bpy.data.curves.new("Hair", "CURVE")))
    if change is not None:
        change(shirt)
        bpy.context.view_layer.update()
    before = snapshot()
    with pytest.raises(RuntimeError, match=message):
        wear(*items)
    assert snapshot() == before


def test_bodies_of_several_objects(pair):
    """Each has eyes that are objects of their own, and all of it is covered."""
    source, target, _, _ = pair
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


def test_items_that_are_parts_of_the_source_are_worn_by_the_others(pair):
    _, target, _, _ = pair
    assert wear("Coat", source="Source + Coat") == {"FINISHED"}
    assert depths(fitted("Coat"), target).max() < 1e-4
    bpy.data.objects["Shirt"].select_set(state=True)
    assert wear(source="Source + Shirt") == {"FINISHED"}
    assert fitted("Shirt")


def test_where_all_meshes_of_a_character_are_selected_it_is_said_that_they_are_its_body(pair):
    for obj in (pair[0], pair[2]):
        obj.select_set(state=True)
    before = snapshot()
    with pytest.raises(RuntimeError, match="all of its meshes count as its body"):
        wear(source="Source + Shirt")
    assert snapshot() == before


def cut_off(body, name):
    """Cut off all but the upper end of a body, as an object of its own."""
    half = body.copy()
    half.data, half.name = body.data.copy(), name
    bpy.context.scene.collection.objects.link(half)
    height = np.quantile(in_world(body)[:, 2], 0.9)
    for obj, upper in ((body, True), (half, False)):
        build = bmesh.new()
        build.from_mesh(obj.data)
        faces = [f for f in build.faces if ((obj.matrix_world @ f.calc_center_median()).z > height) != upper]
        bmesh.ops.delete(build, geom=faces, context="FACES")
        build.to_mesh(obj.data)
        build.free()
    bpy.context.view_layer.update()
    return half


def test_an_item_without_skin_below_it_is_part_of_the_body_as_well(pair):
    source, target, _, _ = pair
    boots = cut_off(source, "Boots")
    before = in_world(boots).copy()
    assert wear("Boots", source="Source + Boots", accept_doubtful=True) == {"FINISHED"}
    report = bpy.context.scene.hiermatch_retarget.report
    assert '"Boots" counts as part of the body as well: "Source" has no skin below it.' in report.remarks
    copy = fitted("Boots")
    assert depths(copy, target).max() < 1e-4
    assert np.ptp(in_world(copy)[:, 2]) > 0.6 * np.ptp(in_world(target)[:, 2])
    np.testing.assert_array_equal(in_world(boots), before)
    with pytest.raises(RuntimeError, match='"Boots" is the body itself, picked as the Source'):
        wear("Boots", "Source", source="Source + Boots")


def test_of_layers_over_nothing_the_inner_one_stands_for_the_body(pair):
    source, _, _, _ = pair
    made = []
    for name, low, high, size in (("Head", 2, 3, 1), ("Legs", -3, -2, 1), ("Vest", -2, 2, 1), ("Cloak", -2, 2, 1.2)):
        bpy.ops.mesh.primitive_cylinder_add(radius=size, depth=high - low, location=(9, 0, (low + high) / 2))
        made.append(bpy.context.object)
        made[-1].name = name
    depsgraph = bpy.context.evaluated_depsgraph_get()
    body = joined("Doll", made)
    worn = undressed(body, ["Vest", "Cloak"], depsgraph)
    assert [part.name for part in parts_of(worn)] == ["Head", "Legs", "Vest"]
    assert undressed(source, ["Shirt"], depsgraph) is source


def test_a_skirt_is_no_skin_where_there_are_legs_in_it(pair):
    del pair
    bpy.ops.mesh.primitive_cone_add(
        vertices=24, radius1=0.95, radius2=0.65, depth=1.9, end_fill_type="NOTHING", location=(9, 0, 1.25)
    )
    made = [bpy.context.object]
    for name, x, low, high, size in (
        ("Trunk", 0, 2.2, 5, 0.65),
        ("Leg.L", 0.45, -2, 1.2, 0.33),
        ("Leg.R", -0.45, -2, 1.2, 0.33),
    ):
        bpy.ops.mesh.primitive_cylinder_add(radius=size, depth=high - low, location=(9 + x, 0, (low + high) / 2))
        made.append(bpy.context.object)
        made[-1].name = name
    made[0].name = "Skirt"
    bpy.ops.object.select_all(action="DESELECT")
    for obj in made:  # faces as small as those of clothes
        obj.select_set(state=True)
        build = bmesh.new()
        build.from_mesh(obj.data)
        bmesh.ops.subdivide_edges(build, edges=build.edges, cuts=6, use_grid_fill=True)
        build.to_mesh(obj.data)
        build.free()
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    body = undressed(joined("Doll", made), ["Skirt"], depsgraph)
    assert set(parts_of(body)) == set(made)
    seen, every = (read_surface(side, depsgraph, use_modifiers=False) for side in (body, whole(body)))
    assert seen.vertex_count == every.vertex_count
    assert every.triangle_count == read_surface(joined("Doll", made), depsgraph, use_modifiers=False).triangle_count
    left_out = np.array(sorted(body.left_out))
    assert seen.triangle_count == every.triangle_count - len(left_out)
    middles = every.vertices[every.triangles[left_out]].mean(axis=1)
    assert np.linalg.norm(middles[:, :2] - [9, 0], axis=1).min() > 0.6  # none of the legs
    assert middles[:, 2].min() < 0.5
    assert middles[:, 2].max() < 2.0
    bare = undressed(joined("Doll", made), [], depsgraph)
    assert not bare.left_out


def test_a_match_that_knows_what_hangs_is_used_as_it_is(pair, monkeypatch):
    """As one that was made by the button Match, before."""
    source, target, _, _ = pair
    hanging = frozenset(range(len(source.data.polygons) // 2))
    worn = Character(source.name, (source,), hanging)
    monkeypatch.setattr("hiermatch.hiermatch_addon.operators.carrying.wear.undressed", lambda *_: worn)
    assert read_surface(worn, bpy.context.evaluated_depsgraph_get(), use_modifiers=False).triangle_count > 0
    assert wear("Shirt") == {"FINISHED"}
    assert depths(fitted("Shirt"), target).max() < 1e-4


def test_shoes_below_closed_legs_are_part_of_a_body_with_a_rig(pair):
    del pair
    rig = add_armature("Doll Rig")
    foot, above = rig.data.bones["head"], "neck"
    joint = rig.matrix_world @ foot.head_local
    made = []
    for name, height, moved_by in (("Leg", 1.0, above), ("Shoe", -0.3, foot.name)):
        bpy.ops.mesh.primitive_uv_sphere_add(location=joint + Vector((0, 0, height)))
        obj = bpy.context.object
        obj.name, obj.scale = name, (0.2, 0.2, height if height > 0 else 0.25)
        obj.vertex_groups.new(name=moved_by).add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
        made.append(obj)
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    body = joined("Doll", made)
    assert parts_of(undressed(body, ["Shoe"], depsgraph)) == tuple(made)
    made[1].vertex_groups[0].name = above
    assert parts_of(undressed(body, ["Shoe"], depsgraph)) == (made[0],)
