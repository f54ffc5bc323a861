# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of all types and domains, read and written."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.attribute_io import (
    AttributeLayout,
    add_values,
    attribute_layouts,
    is_known,
    read_attribute,
    read_corner_normals,
    read_face_materials,
    read_polygons,
    read_seams,
    read_values,
    write_attribute,
    write_corner_normals,
    write_face_materials,
    write_seams,
)
from hiermatch.hiermatch_addon.scene.mesh_io import read_mesh

from tests.addon.scenes import add_blob

KINDS = {
    "FLOAT": (),
    "FLOAT2": (2,),
    "FLOAT_VECTOR": (3,),
    "FLOAT4": (4,),
    "FLOAT_COLOR": (4,),
    "BYTE_COLOR": (4,),
    "QUATERNION": (4,),
    "FLOAT4X4": (16,),
    "INT": (),
    "INT8": (),
    "INT16_2D": (2,),
    "INT32_2D": (2,),
    "BOOLEAN": (),
}


def available(mesh):
    """Types that this version of Blender knows."""
    items = mesh.attributes.bl_rna.functions["new"].parameters["type"].enum_items
    return [kind for kind in KINDS if kind in items]


@pytest.mark.parametrize("domain", ["POINT", "EDGE", "FACE", "CORNER"])
def test_every_type_is_written_and_read(domain):
    mesh = add_blob("Blob").data
    count = {
        "POINT": len(mesh.vertices),
        "EDGE": len(mesh.edges),
        "FACE": len(mesh.polygons),
        "CORNER": len(mesh.loops),
    }[domain]
    random = np.random.default_rng(1)
    assert len(available(mesh)) >= 11
    for kind in available(mesh):
        values = random.integers(0, 2, (count, *KINDS[kind]))
        layout = AttributeLayout(f"Test {kind}", kind, domain)
        write_attribute(mesh, layout, values)
        assert attribute_layouts(mesh)[layout.name] == layout
        np.testing.assert_allclose(read_attribute(mesh, layout.name), values, atol=1e-6)
        write_attribute(mesh, layout, 1 - values)  # over the old
        np.testing.assert_allclose(read_attribute(mesh, layout.name), 1 - values, atol=1e-6)


def test_what_is_blenders_own_is_not_listed():
    mesh = add_blob("Blob").data
    mesh.attributes.new("Mine", "INT", "POINT")
    names = set(attribute_layouts(mesh))
    assert {"Mine", "UVMap"} <= names
    assert not names & {"position", ".corner_vert"}
    assert is_known("INT")
    assert not is_known("SPLINE")


def test_faces_are_those_of_the_mesh():
    obj = add_blob("Blob")
    faces = read_polygons(obj.data)
    assert faces.face_count == len(obj.data.polygons)
    assert len(faces.edges) == len(obj.data.edges)
    for polygon in obj.data.polygons:
        corners = slice(faces.starts[polygon.index], faces.starts[polygon.index + 1])
        np.testing.assert_array_equal(faces.corner_vertices[corners], polygon.vertices)
    mesh = read_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=False)
    np.testing.assert_array_equal(faces.corner_vertices[faces.cut_as(mesh).triangle_corners], mesh.triangles)


def test_faces_of_a_mirrored_object_are_cut_as_its_mesh():
    obj = add_blob("Blob")
    obj.scale.x = -1
    bpy.context.view_layer.update()
    faces = read_polygons(obj.data)
    mesh = read_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=False)
    np.testing.assert_array_equal(faces.corner_vertices[faces.cut_as(mesh).triangle_corners], mesh.triangles)


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("INT", np.arange(254)),
        ("INT", np.arange(254, dtype=np.int32) + 2**30),
        ("FLOAT", np.linspace(0, 1, 254)),
        ("FLOAT_VECTOR", np.linspace(0, 1, 762).reshape(254, 3)),
    ],
)
def test_values_come_back(kind, values):
    data = add_blob("Blob", 18, 15).data
    assert len(data.vertices) == 254
    add_values(data, "Values", values)
    assert data.attributes["Values"].data_type == kind
    back = read_values(data, "Values", kind)
    assert back.shape == values.shape
    assert back == pytest.approx(values, rel=1e-7)
    assert read_values(data, "Nothing", kind) is None
    assert read_values(data, "Values", "FLOAT" if kind == "INT" else "INT") is None


def test_values_elsewhere_than_at_vertices_are_not_read():
    data = add_blob("Blob").data
    data.attributes.new("Values", "INT", "FACE")
    assert read_values(data, "Values", "INT") is None


def test_seams_materials_and_normals():
    mesh = add_blob("Blob").data
    seams = np.arange(len(mesh.edges)) % 3 == 0
    write_seams(mesh, seams)
    np.testing.assert_array_equal(read_seams(mesh), seams)
    assert [edge.use_seam for edge in mesh.edges] == seams.tolist()
    slots = np.arange(len(mesh.polygons)) % 2
    write_face_materials(mesh, slots)
    np.testing.assert_array_equal(read_face_materials(mesh), slots)
    normals = np.tile([0.6, 0, 0.8], (len(mesh.loops), 1))
    write_corner_normals(mesh, normals)
    assert mesh.has_custom_normals
    np.testing.assert_allclose(read_corner_normals(mesh), normals, atol=0.02)
