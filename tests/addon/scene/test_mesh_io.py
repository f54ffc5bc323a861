# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading meshes as they stand in the world, and writing arrays onto them."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene import mesh_io
from hiermatch.hiermatch_addon.scene.attribute_io import add_values
from hiermatch.hiermatch_addon.scene.mesh_io import (
    add_colors,
    add_vertex_group,
    corner_vertices,
    face_corner_counts,
    position_digest,
    read_mesh,
    topology,
    unedited,
    vertex_positions,
)
from mathutils import Matrix

from tests.addon.scenes import add_blob, values_of, weights_of


def read(obj, *, use_modifiers=False):
    return read_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=use_modifiers)


def volume(mesh):
    """Signed volume: positive if the normals point outward."""
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def test_vertices_keep_their_numbers():
    obj = add_blob("Blob")
    mesh = read(obj)
    assert mesh.vertices == pytest.approx(np.array([vertex.co for vertex in obj.data.vertices]))
    assert mesh.vertices.dtype == np.float64


def test_quads_and_ngons_become_the_triangles_that_blender_draws():
    # A concave L of one six-sided face: a fan from its first corner would cover too much.
    outline = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]
    data = bpy.data.meshes.new("L")
    data.from_pydata(np.roll(outline, 2, axis=0).tolist(), [], [range(6)])
    obj = bpy.data.objects.new("L", data)
    bpy.context.collection.objects.link(obj)
    mesh = read(obj)
    assert mesh.triangle_count == 4
    assert mesh.area == pytest.approx(3)
    assert mesh.triangle_normals == pytest.approx(np.tile([0, 0, 1], (4, 1)))


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 0.5, 3), (-1, 1, 1), (-2, -1, -0.5), (-1, -1, 2)])
def test_transforms_count_and_normals_stay_outward(scale):
    obj = add_blob("Blob")
    local = np.array([vertex.co for vertex in obj.data.vertices])
    obj.location, obj.rotation_euler, obj.scale = (3, -2, 1), (0.3, -1.1, 2), scale
    mesh = read(obj)
    matrix = np.array(Matrix.LocRotScale(obj.location, obj.rotation_euler, obj.scale))
    assert mesh.vertices == pytest.approx(local @ matrix[:3, :3].T + matrix[:3, 3], abs=1e-5)
    assert volume(mesh) > 0


def test_parents_count():
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale = (2, 2, 2)
    obj = add_blob("Blob")
    area = read(obj).area
    obj.parent = parent
    assert read(obj).area == pytest.approx(4 * area)


def test_modifiers_only_when_asked_for():
    obj = add_blob("Blob")
    obj.modifiers.new("Wave", "CAST").factor = 0.7
    plain, cast = read(obj), read(obj, use_modifiers=True)
    assert plain.vertices == pytest.approx(np.array([vertex.co for vertex in obj.data.vertices]))
    assert np.abs(cast.vertices - plain.vertices).max() > 0.1
    assert (cast.triangles == plain.triangles).all()


def test_an_armature_counts_as_a_modifier():
    obj = add_blob("Blob")
    bpy.ops.object.armature_add()
    rig = bpy.context.object
    obj.vertex_groups.new(name="Bone").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
    obj.modifiers.new("Rig", "ARMATURE").object = rig
    rig.pose.bones["Bone"].location.y = 5
    moved = read(obj, use_modifiers=True).vertices - read(obj).vertices
    assert np.linalg.norm(moved, axis=1) == pytest.approx(5, abs=1e-4)


def test_shape_keys_count_as_they_are_shown():
    obj = add_blob("Blob")
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Long")
    for point in key.data:
        point.co.z *= 3
    key.value = 0.5
    plain, mixed = read(obj), read(obj, use_modifiers=True)
    assert mixed.vertices[:, 2] == pytest.approx(2 * plain.vertices[:, 2], abs=1e-5)


def test_modifiers_that_change_vertices_are_named():
    obj = add_blob("Blob")
    obj.modifiers.new("Harmless", "CAST")
    obj.modifiers.new("Finer", "SUBSURF")
    obj.modifiers.new("Half", "MIRROR").show_viewport = False
    with pytest.raises(ObjectError, match="Finer") as caught:
        read(obj, use_modifiers=True)
    assert "Harmless" not in str(caught.value)
    assert "Half" not in str(caught.value)
    assert "Use Modifiers" in str(caught.value)
    assert read(obj).vertex_count == len(obj.data.vertices)


def test_modifiers_that_change_faces_only_are_fine():
    obj = add_blob("Blob")
    obj.modifiers.new("Triangles", "TRIANGULATE")
    assert read(obj, use_modifiers=True).vertex_count == len(obj.data.vertices)


def test_no_evaluated_mesh_stays_behind():
    obj = add_blob("Blob")
    with mesh_io._shown_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=True) as lent:  # noqa: SLF001
        assert len(lent.vertices) == len(obj.data.vertices)
    with pytest.raises(ReferenceError):
        len(lent.vertices)


def test_faults_of_the_mesh_name_the_object():
    data = bpy.data.meshes.new("Wire")
    data.from_pydata([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [], [(0, 1, 2)])
    obj = bpy.data.objects.new("Wire", data)
    bpy.context.collection.objects.link(obj)
    with pytest.raises(ObjectError, match=r'^"Wire": .*zero area'):
        read(obj)


def make(vertices, faces):
    data = bpy.data.meshes.new("Made")
    data.from_pydata(vertices, [], faces)
    obj = bpy.data.objects.new("Made", data)
    bpy.context.collection.objects.link(obj)
    return obj


CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def test_triangles_that_use_a_vertex_twice_are_left_out():
    mesh = read(make(CORNERS, [(0, 1, 2), (0, 2, 2), (1, 1, 1), (0, 2, 3), (0, 1, 1, 3)]))
    assert (mesh.triangles != np.roll(mesh.triangles, 1, axis=1)).all()
    assert {(0, 1, 2), (0, 2, 3)} <= {tuple(corners) for corners in mesh.triangles.tolist()}
    assert mesh.vertex_count == 4


def test_a_mesh_of_such_triangles_only_is_told():
    with pytest.raises(ObjectError, match=r'^"Made" has no surface: each of its faces uses a vertex twice'):
        read(make(CORNERS, [(0, 2, 2), (1, 1, 1)]))


def test_the_winding_of_a_mirrored_object_is_that_of_its_image():
    obj = make(CORNERS, [(0, 1, 2, 3)])
    upward = read(obj).triangle_normals
    obj.scale.x = -2
    assert read(obj).triangle_normals == pytest.approx(upward)
    assert read(obj).area == pytest.approx(2)
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale.y, obj.parent = -1, parent  # mirrored twice: turned
    assert read(obj).triangle_normals == pytest.approx(upward)


class TestPositionDigest:
    def test_the_object_and_an_undisturbed_edit_do_not_matter(self):
        obj = add_blob("Blob")
        before = position_digest(obj.data)
        obj.location.x, obj.scale, obj.name, obj.data.name = 3, (2, 2, -2), "Other", "Mesh"
        obj.data.flip_normals()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.object.mode_set(mode="OBJECT")
        assert position_digest(obj.data) == before
        assert position_digest(obj.data.copy()) == before

    def test_one_vertex_matters(self):
        data = add_blob("Blob").data
        before = position_digest(data)
        data.vertices[5].co.z += 1e-4
        assert position_digest(data) != before


class TestOwnArrays:
    def test_they_are_read_where_blender_keeps_them(self):
        """Its slow ways take 50 to 200 times longer, which is seconds for large meshes at each undo."""
        mesh = add_blob("Blob").data
        lists = {"vertices": [None] * len(mesh.vertices), "loops": [None] * len(mesh.loops)}  # without slow ways
        stored = SimpleNamespace(attributes=mesh.attributes, **lists)
        assert vertex_positions(stored) == pytest.approx(np.array([vertex.co for vertex in mesh.vertices]))
        assert corner_vertices(stored).tolist() == [loop.vertex_index for loop in mesh.loops]

    def test_edit_mode_and_none(self):
        obj = add_blob("Blob")
        before = topology(obj.data), position_digest(obj.data)
        assert face_corner_counts(obj.data).tolist() == [polygon.loop_total for polygon in obj.data.polygons]
        bpy.ops.object.mode_set(mode="EDIT")
        assert (topology(obj.data), position_digest(obj.data)) == before
        bpy.ops.object.mode_set(mode="OBJECT")
        empty = bpy.data.meshes.new("Empty")
        counts = [len(read(empty)) for read in (vertex_positions, corner_vertices, face_corner_counts)]
        assert counts == [0, 0, 0]

    def test_faces_are_looked_at_once_while_nothing_is_edited(self):
        mesh = add_blob("Blob").data
        with unedited():
            before = topology(mesh)
            mesh.flip_normals()
            assert topology(mesh) == before
        assert topology(mesh) != before


def test_arrays_arrive_where_they_belong():
    obj = add_blob("Blob")
    n = len(obj.data.vertices)
    rgba = np.linspace(0, 1, 4 * n, dtype=np.float32).reshape(n, 4)
    add_colors(obj.data, "Colours", np.asfortranarray(rgba))
    add_values(obj.data, "Values", np.arange(n, dtype=np.float64)[::-1])
    add_vertex_group(obj, "Group", np.array([5, 2]), np.array([0.25, 0.75]))
    assert values_of(obj.data.attributes["Colours"]).tolist() == rgba.ravel().tolist()
    assert values_of(obj.data.attributes["Values"]).tolist() == list(range(n))[::-1]
    assert obj.data.attributes["Colours"].domain == obj.data.attributes["Values"].domain == "POINT"
    assert weights_of(obj) == {"Group": {5: 0.25, 2: 0.75}}
