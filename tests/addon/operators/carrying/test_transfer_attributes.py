# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.transfer_attributes`."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.engine.runtime.progress import run
from hiermatch.hiermatch_addon.scene.attribute_io import (
    AttributeLayout,
    attribute_layouts,
    read_attribute,
    read_corner_normals,
    read_face_materials,
    read_seams,
    write_attribute,
    write_corner_normals,
    write_seams,
)
from hiermatch.hiermatch_addon.transfers.attributes import AttributeTransfer
from hiermatch.hiermatch_addon.transfers.options.attributes import AttributeSettings

from tests.addon.rigs import true_passage
from tests.addon.scenes import add_blob, mesh_snapshot


@pytest.fixture
def pair(dense_pair):
    """A matched pair: long bodies of the same shape, the target 5 further along x."""
    source, target = dense_pair
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    return source, target


def carry(**options):
    return bpy.ops.hiermatch.transfer_attributes(
        **({"source": "Source", "target": "Target", "refine": False} | options)
    )


def along(obj):
    """Place of each vertex along the body."""
    return np.array([vertex.co.x for vertex in obj.data.vertices])


def face_places(obj):
    return np.array([polygon.center.x for polygon in obj.data.polygons])


def add(obj, name, kind, domain, values):
    write_attribute(obj.data, AttributeLayout(name, kind, domain), np.asarray(values))


def tops(obj):
    """Edges of the ring around the body that lies nearest to z = 0."""
    height = np.array([vertex.co.z for vertex in obj.data.vertices])
    ring = np.abs(height) < 1e-4
    ends = np.array([edge.vertices for edge in obj.data.edges])
    return ring[ends].all(axis=1)


def test_numbers_and_colors_arrive_where_they_belong(pair):
    source, target = pair
    x = along(source)
    add(source, "Along", "FLOAT", "POINT", x)
    add(source, "Right", "BOOLEAN", "POINT", x > 0.5)
    add(source, "Paint", "FLOAT_COLOR", "POINT", np.stack([x, 0 * x, -x, 0 * x + 1], axis=1))
    add(source, "Corner Paint", "BYTE_COLOR", "CORNER", np.tile([0.2, 0.4, 0.6, 1], (len(source.data.loops), 1)))
    add(source, "Part", "INT", "FACE", np.where(face_places(source) > 0.5, 7, 3))
    assert carry() == {"FINISHED"}
    there = along(target)
    assert abs(read_attribute(target.data, "Along") - there).mean() < 0.1
    clear = abs(there - 0.5) > 0.3
    np.testing.assert_array_equal(read_attribute(target.data, "Right")[clear], (there > 0.5)[clear])
    assert abs(read_attribute(target.data, "Paint")[:, 0] - there).mean() < 0.1
    np.testing.assert_allclose(read_attribute(target.data, "Corner Paint")[:, 1], 0.4, atol=0.01)
    faces = face_places(target)
    clear = abs(faces - 0.5) > 0.4
    np.testing.assert_array_equal(read_attribute(target.data, "Part")[clear], np.where(faces > 0.5, 7, 3)[clear])
    layouts = attribute_layouts(source.data)
    for name in ("Along", "Right", "Paint", "Corner Paint", "Part"):
        assert attribute_layouts(target.data)[name] == layouts[name]


def test_what_matches_wrote_stays_where_it_is(pair):
    source, target = pair
    add(source, "Along", "FLOAT", "POINT", along(source))
    add(source, "HM Other", "FLOAT", "POINT", along(source))
    before = mesh_snapshot(target)
    carry()
    after = mesh_snapshot(target)
    new = [entry for entry in after["attributes"] if entry not in before["attributes"]]
    assert {entry[0] for entry in new} <= {"Along", "sharp_face"}


def test_only_some(pair):
    source, target = pair
    add(source, "Along", "FLOAT", "POINT", along(source))
    add(source, "Other", "FLOAT", "POINT", along(source))
    add(source, "Paint", "FLOAT_COLOR", "POINT", np.ones((len(source.data.vertices), 4)))
    carry(attribute_names="Other")
    names = set(attribute_layouts(target.data))
    assert "Other" in names
    assert not names & {"Along", "Paint"}
    carry(attribute_values=False)
    names = set(attribute_layouts(target.data))
    assert "Paint" in names
    assert "Along" not in names


def test_empty_slots_take_no_material_away(pair):
    source, target = pair
    source.data.materials.append(None)
    target.data.materials.append(bpy.data.materials.new("Own"))
    assert carry() == {"FINISHED"}
    assert "material" not in bpy.context.scene.hiermatch_retarget.report.done
    assert [slot.name for slot in target.material_slots] == ["Own"]


def test_materials_are_added_to_the_slots_once(pair):
    source, target = pair
    skin, cloth, metal = (bpy.data.materials.new(name) for name in ("Skin", "Cloth", "Metal"))
    for material in (skin, metal, cloth):
        source.data.materials.append(material)
    for material in (metal, cloth):
        target.data.materials.append(material)
    right = face_places(source) > 0.5
    for polygon, is_right in zip(source.data.polygons, right, strict=True):
        polygon.material_index = 2 if is_right else 0
    carry()
    assert [slot.material for slot in target.material_slots] == [metal, cloth, skin]
    faces = face_places(target)
    clear = abs(faces - 0.5) > 0.4
    np.testing.assert_array_equal(read_face_materials(target.data)[clear], np.where(faces > 0.5, 1, 2)[clear])
    carry()
    assert len(target.material_slots) == 3


def test_sharp_edges_and_seams_make_one_line(pair):
    source, target = pair
    ring = tops(source)
    assert ring.sum() > 10
    add(source, "sharp_edge", "BOOLEAN", "EDGE", ring)
    write_seams(source.data, ring)
    target.data.edges[3].use_edge_sharp = True
    carry(attribute_seams=True)
    sharp = read_attribute(target.data, "sharp_edge")
    np.testing.assert_array_equal(read_seams(target.data), sharp)
    ends = np.array([edge.vertices for edge in target.data.edges])[sharp]
    assert set(np.bincount(ends.ravel()).tolist()) == {0, 2}


def test_creases_keep_their_values(pair):
    source, target = pair
    add(source, "crease_edge", "FLOAT", "EDGE", 0.75 * tops(source))
    add(source, "crease_vert", "FLOAT", "POINT", np.eye(1, len(source.data.vertices), 5)[0])
    carry()
    creases = read_attribute(target.data, "crease_edge")
    assert set(np.unique(creases)) == {0, 0.75}
    assert sorted(read_attribute(target.data, "crease_vert"))[-2:] == [0, 1]
    assert "sharp_edge" not in attribute_layouts(target.data)


def test_custom_normals_turn_with_the_object(pair):
    source, target = pair
    target.rotation_euler.x = 1.0
    target.scale = (1, 2, 1)
    bpy.context.view_layer.update()
    write_corner_normals(source.data, read_corner_normals(source.data) * 1.0)
    assert source.data.has_custom_normals
    for polygon in target.data.polygons:
        polygon.use_smooth = True
    smooth = read_corner_normals(target.data)
    carry(attribute_sharp=False)
    assert target.data.has_custom_normals
    # The source's are those of flat faces; at the corners of a face of the target they lean to both sides.
    products = np.einsum("ld,ld->l", read_corner_normals(target.data), smooth)
    assert products.mean() > 0.9


def test_across_a_map_to_the_mirror_image_custom_normals_are_mirrored():
    """The target is the source but for a negative scale, and the normals lean along the body and to one side."""
    source, target = add_blob("Source"), add_blob("Target")
    target.scale.y = -1
    bpy.context.view_layer.update()
    leaning = read_corner_normals(source.data) + np.array([0.3, 0.5, 0.0])
    write_corner_normals(source.data, leaning / np.linalg.norm(leaning, axis=1, keepdims=True))
    transfer = AttributeTransfer(AttributeSettings())
    transfer.read(bpy.context, source, target)
    run(transfer.steps(true_passage(source, target)))
    transfer.write(bpy.context, source, target)
    products = np.einsum("ld,ld->l", read_corner_normals(target.data), read_corner_normals(source.data))
    assert products.mean() > 0.99


def test_other_things_of_the_same_name_are_left_alone(pair):
    source, target = pair
    add(source, "Along", "FLOAT", "POINT", along(source))
    add(source, "Group", "FLOAT", "POINT", along(source))
    target.data.attributes.new("Along", "INT", "FACE")
    target.vertex_groups.new(name="Group")
    assert carry() == {"FINISHED"}
    assert attribute_layouts(target.data)["Along"].kind == "INT"
    assert "Group" not in attribute_layouts(target.data)


def test_texts_arrive_where_they_belong(pair):
    source, target = pair
    names = source.data.attributes.new("Names", "STRING", "FACE")
    for face, place in enumerate(face_places(source)):
        names.data[face].value = "Köpfchen".encode() if place > 0.5 else b""
    assert carry() == {"FINISHED"}
    faces = face_places(target)
    clear = abs(faces - 0.5) > 0.4
    found = np.array([element.value.decode() for element in target.data.attributes["Names"].data])
    np.testing.assert_array_equal(found[clear], np.where(faces > 0.5, "Köpfchen", "")[clear])


def test_the_active_color_is_shown_if_there_was_none(pair):
    source, target = pair
    target.data.attributes.active_color_name = target.data.attributes.default_color_name = ""
    add(source, "Paint", "FLOAT_COLOR", "POINT", np.ones((len(source.data.vertices), 4)))
    source.data.attributes.active_color_name = "Paint"
    carry()
    assert target.data.attributes.active_color_name == "Paint"


def test_unknown_names_change_nothing(pair):
    before = mesh_snapshot(pair[1])
    with pytest.raises(RuntimeError, match='no attribute "Other"'):
        carry(attribute_names="Other")
    assert mesh_snapshot(pair[1]) == before


def test_nothing_to_carry(pair):
    before = mesh_snapshot(pair[1])
    with pytest.raises(RuntimeError, match="has nothing of what is to be carried over"):
        carry(attribute_sharp=False)
    assert mesh_snapshot(pair[1]) == before
