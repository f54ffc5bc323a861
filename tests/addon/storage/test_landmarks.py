# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks: named, kept on the meshes, edited, saved, mirrored, and kept to by a match."""

from __future__ import annotations

import json
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from hiermatch.engine import Progress
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.jobs import landmark_mirroring
from hiermatch.hiermatch_addon.operators.steering import landmark_picking
from hiermatch.hiermatch_addon.properties.steering_lists import sync_lists
from hiermatch.hiermatch_addon.storage import landmark_layer
from hiermatch.hiermatch_addon.storage.excluded_regions import excluded_vertices, region_names
from hiermatch.hiermatch_addon.storage.landmark_layer import LANDMARKS, read_marks, write_marks
from hiermatch.hiermatch_addon.storage.landmarks import Landmark, add_landmarks, find_landmarks, landmark_array
from hiermatch.hiermatch_addon.storage.written_names import written_names
from mathutils import Matrix, Vector
from scipy.spatial import cKDTree

from tests.addon.scenes import QUICK, add_pair, add_symmetric_pair, edit_twin, mesh_snapshot, snapshot, weights_of


@pytest.fixture
def pair():
    source, target = add_pair()
    state = bpy.context.scene.hiermatch
    state.source, state.target = source, target
    return source, target


@pytest.fixture
def third(pair):
    """A mesh with landmarks 1 to 3 in common with the source, of which the pair has removed number 2."""
    other = pair[1].copy()
    other.data = pair[1].data.copy()
    bpy.context.collection.objects.link(other)
    for target in (pair[1], other):
        add_landmarks(pair[0], target, [(70, 30), (80, 40), (90, 50)])
    bpy.ops.hiermatch.remove_landmark(number=2)
    return other


def add(source_vertex, target_vertex):
    return bpy.ops.hiermatch.add_landmark(source_vertex=source_vertex, target_vertex=target_vertex)


def found(pair):
    return [(one.number, one.source, one.target) for one in find_landmarks(*pair)]


def listed():
    return [(one.number, one.source, one.target) for one in bpy.context.scene.hiermatch_steering.landmarks]


def edit(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(state=True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")


def select(obj, vertices):
    edited = bmesh.from_edit_mesh(obj.data)
    for vertex in edited.verts:
        vertex.select = vertex.index in vertices
    bmesh.update_edit_mesh(obj.data)


class TestKeeping:
    def test_numbers_count_up_and_are_listed(self, pair):
        add(3, 5)
        add(10, 11)
        assert found(pair) == listed() == [(1, 3, 5), (2, 10, 11)]
        assert landmark_array(find_landmarks(*pair)).tolist() == [[3, 5], [10, 11]]

    def test_a_vertex_has_one_landmark(self, pair):
        add(3, 5)
        add(3, 6)
        assert found(pair) == [(1, 3, 6)]
        add(4, 6)
        assert found(pair) == [(1, 4, 6)]
        add(8, 9)
        add(4, 9)
        assert found(pair) == [(1, 4, 9)]

    def test_one_mesh_serves_several(self, pair):
        other = pair[1].copy()
        other.data = pair[1].data.copy()
        bpy.context.collection.objects.link(other)
        add_landmarks(*pair, [(3, 5)])
        add_landmarks(pair[0], other, [(3, 7), (4, 8)])
        assert found(pair) == [(1, 3, 5)]
        assert found((pair[0], other)) == [(1, 3, 7), (2, 4, 8)]

    @pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
    def test_a_number_that_a_third_mesh_has_is_not_given_again(self, pair, third, mode):
        if mode == "EDIT":
            edit(third)
        add(200, 200)
        assert found(pair) == [(1, 70, 30), (3, 90, 50), (4, 200, 200)]
        assert found((pair[0], third)) == [(1, 70, 30), (3, 90, 50)]

    def test_they_survive_saving_renaming_and_undo(self, pair, tmp_path):
        bpy.ops.ed.undo_push(message="Before")
        add(3, 5)
        bpy.ops.ed.undo_push(message="Added")
        bpy.ops.ed.undo()
        pair = bpy.data.objects["Source"], bpy.data.objects["Target"]
        assert found(pair) == listed() == []
        bpy.ops.ed.redo()
        pair = bpy.data.objects["Source"], bpy.data.objects["Target"]
        pair[0].name, pair[0].data.name = "Renamed", "Renamed"
        path = str(tmp_path / "landmarks.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        assert found((bpy.data.objects["Renamed"], bpy.data.objects["Target"])) == listed() == [(1, 3, 5)]

    def test_they_survive_edits_that_renumber_and_those_that_cut(self, pair):
        source, _ = pair
        co = [source.data.vertices[vertex].co.copy() for vertex in (100, 101)]
        add_landmarks(*pair, [(100, 5), (101, 6)])
        edit(source)
        select(source, range(20, 40))
        bpy.ops.mesh.delete(type="VERT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide(number_cuts=3)
        bpy.ops.object.mode_set(mode="OBJECT")
        marks = read_marks(source)
        assert list(marks) == [1, 2]
        for (vertex, use), place in zip(marks.values(), co, strict=True):
            assert use
            assert source.data.vertices[vertex].co == place

    def test_no_mean_of_two_landmarks_is_one(self):
        numbers = np.arange(5)
        kept = np.column_stack([numbers, numbers**2, 0 * numbers]).astype(np.float32)
        for share in (0.1, 0.25, 0.5, 0.75):
            mixed = share * kept[:, None] + (1 - share) * kept[None]
            mixed[numbers, numbers] = 0
            assert not landmark_layer._marks(mixed.reshape(-1, 3))  # noqa: SLF001

    def test_they_are_none_of_the_attributes_to_carry(self, pair):
        add(3, 5)
        assert LANDMARKS in written_names(pair[0])

    def test_the_last_one_takes_the_attribute_with_it(self, pair):
        before = snapshot()["meshes"]
        add(3, 5)
        assert LANDMARKS in pair[0].data.attributes
        bpy.ops.hiermatch.remove_landmark(number=1)
        assert snapshot()["meshes"] == before


class TestEditing:
    def test_off_and_on(self, pair):
        add(3, 5)
        bpy.ops.hiermatch.switch_landmark(number=1, use=False)
        assert not find_landmarks(*pair)[0].use
        assert not bpy.context.scene.hiermatch_steering.landmarks[0].use
        assert landmark_array(find_landmarks(*pair)) is None
        bpy.ops.hiermatch.switch_landmark(number=1, use=True)
        assert find_landmarks(*pair)[0].use

    def test_remove_the_active_one_and_clear(self, pair):
        for vertex in range(4):
            add(vertex, vertex)
        bpy.context.scene.hiermatch_steering.landmark_index = 1
        bpy.ops.hiermatch.remove_landmark()
        assert [number for number, *_ in found(pair)] == [1, 3, 4]
        bpy.ops.hiermatch.clear_landmarks()
        assert found(pair) == listed() == []

    def test_a_change_for_third_meshes_is_said(self, pair, third, capfd):
        def said():
            return [line for line in capfd.readouterr().out.splitlines() if "as well" in line]

        said()
        add(200, 200)
        bpy.ops.hiermatch.select_landmark(number=4)
        bpy.ops.hiermatch.remove_landmark(number=4)
        assert not said()  # the third has none of that number
        add(70, 31)
        assert said() == ['Info: "Target" had that in common with "Target.001" as well']
        bpy.ops.hiermatch.switch_landmark(number=3, use=False)
        both = ['Info: "Source", "Target" had that in common with "Target.001" as well']
        assert said() == both
        bpy.ops.hiermatch.remove_landmark(number=3)
        assert said() == both
        bpy.ops.hiermatch.clear_landmarks()
        assert said() == both
        bpy.data.objects.remove(third)
        add(70, 30)
        bpy.ops.hiermatch.clear_landmarks()
        assert not said()
        assert not found(pair)

    @pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
    def test_select(self, pair, mode):
        add(3, 5)
        add(7, 8)
        if mode == "EDIT":
            edit(*pair)
        bpy.ops.hiermatch.select_landmark(number=2)
        assert bpy.context.scene.hiermatch_steering.landmark_index == 1
        if mode == "OBJECT":
            edit(*pair)
        assert [landmark_picking.selected_vertices(obj) for obj in pair] == [[7], [8]]

    def test_in_edit_mode(self, pair):
        edit(*pair)
        for vertices in ((3, 5), (7, 8)):
            for obj, vertex in zip(pair, vertices, strict=True):
                select(obj, [vertex])
            assert bpy.ops.hiermatch.add_landmark() == {"FINISHED"}
        assert found(pair) == [(1, 3, 5), (2, 7, 8)]
        bpy.ops.hiermatch.switch_landmark(number=1, use=False)
        bpy.ops.object.mode_set(mode="OBJECT")
        assert found(pair) == [(1, 3, 5), (2, 7, 8)]
        assert [one.use for one in find_landmarks(*pair)] == [False, True]

    def test_a_mesh_that_is_edited_through_another_object_is_read_and_left_alone(self, pair):
        add(3, 5)
        edit_twin(pair[0])
        bpy.context.scene.hiermatch.source = pair[0]
        assert found(pair) == listed() == [(1, 3, 5)]
        for operator in (lambda: add(7, 8), lambda: bpy.ops.hiermatch.select_landmark(number=1)):
            with pytest.raises(RuntimeError, match='"Source" shares its mesh with an object in Edit Mode'):
                operator()
        assert found(pair) == [(1, 3, 5)]

    @pytest.mark.parametrize("chosen", [(), (1, 2)])
    def test_one_vertex_on_each_has_to_be_selected(self, pair, chosen):
        edit(*pair)
        select(pair[0], [3])
        select(pair[1], chosen)
        with pytest.raises(RuntimeError, match="Select exactly one vertex on each"):
            bpy.ops.hiermatch.add_landmark()

    def test_by_empties(self, pair):
        for obj, vertex in zip(reversed(pair), (9, 20), strict=True):
            bpy.ops.object.empty_add(location=obj.matrix_world @ obj.data.vertices[vertex].co + Vector((0.01, 0, 0)))
        for obj in bpy.data.objects:
            obj.select_set(obj.type == "EMPTY")
        bpy.ops.hiermatch.add_landmark()
        assert found(pair) == [(1, 20, 9)]

    def test_without_anything_to_go_by(self, pair):
        assert pair
        with pytest.raises(RuntimeError, match="open which vertices correspond"):
            bpy.ops.hiermatch.add_landmark()

    def test_a_vertex_that_is_not_there(self, pair):
        assert pair
        before = snapshot()
        with pytest.raises(RuntimeError, match='"Target" has no vertex 99999'):
            add(3, 99999)
        assert snapshot() == before

    def test_the_pair_is_picked(self):
        source, target = add_pair()
        bpy.ops.hiermatch.add_landmark(source="Source", target="Target", source_vertex=1, target_vertex=2)
        state = bpy.context.scene.hiermatch
        assert (state.source, state.target) == (source, target)
        assert listed() == [(1, 1, 2)]
        bpy.ops.hiermatch.swap()
        assert listed() == [(1, 2, 1)]

    def test_a_click(self, pair):
        source, target = pair
        source.scale = (1, 2, 3)
        bpy.context.view_layer.update()
        vertex = 77
        place = source.matrix_world @ source.data.vertices[vertex].co
        outward = (
            source.matrix_world.to_3x3().inverted().transposed() @ source.data.vertices[vertex].normal
        ).normalized()
        hit = landmark_picking.cast_ray(bpy.context, pair, place + 0.1 * outward, -outward)
        assert (hit.obj, hit.vertex) == (source, vertex)
        assert landmark_picking.cast_ray(bpy.context, pair, place + outward, outward) is None
        source.hide_set(state=True)
        assert landmark_picking.cast_ray(bpy.context, (source,), place + 0.1 * outward, -outward) is None
        assert target

    def test_a_click_on_the_half_that_a_modifier_mirrors(self, pair):
        source = pair[0]
        source.data.transform(Matrix.Translation((0, 0, 5)))
        source.modifiers.new("Other half", "MIRROR").use_axis = (False, False, True)
        bpy.context.view_layer.update()
        assert landmark_picking.cast_ray(bpy.context, (source,), Vector((0, 0, 20)), Vector((0, 0, -1))) is not None
        with pytest.raises(ObjectError, match="is shown by its Mirror modifier"):
            landmark_picking.cast_ray(bpy.context, (source,), Vector((0, 0, -20)), Vector((0, 0, 1)))

    def test_a_click_on_a_subdivided_mesh(self, pair):
        source, _ = pair
        source.modifiers.new("More", "SUBSURF").levels = 1
        place, outward = source.data.vertices[77].co, source.data.vertices[77].normal
        assert landmark_picking.cast_ray(bpy.context, pair, place + outward, -outward).vertex == 77
        source.modifiers.new("Away", "SIMPLE_DEFORM").deform_method = "STRETCH"
        source.modifiers["Away"].factor = 5
        bpy.context.view_layer.update()
        with pytest.raises(ObjectError, match="far away from its own vertices"):
            landmark_picking.cast_ray(bpy.context, pair, Vector((0, 0, 20)), Vector((0, 0, -1)))


class TestMatching:
    def test_a_match_keeps_to_them(self, pair):
        rows = [(30, 200), (150, 40)]
        add_landmarks(*pair, rows)
        bpy.ops.hiermatch.match(**QUICK)
        for number, (source_vertex, target_vertex) in enumerate(rows, start=1):
            assert weights_of(pair[0])[f"HM.{number:03d}"] == {source_vertex: 1}
            assert weights_of(pair[1])[f"HM.{number:03d}"] == {target_vertex: 1}

    def test_unless_it_is_told_not_to(self, pair):
        bpy.ops.hiermatch.match(**QUICK)
        before = [weights_of(obj) for obj in pair]
        add_landmarks(*pair, [(30, 200)])
        bpy.ops.hiermatch.match(use_landmarks=False, **QUICK)
        assert [weights_of(obj) for obj in pair] == before

    @pytest.mark.parametrize("kind", ["group", "attribute"])
    @pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
    def test_what_the_user_called_so_is_left_alone(self, pair, kind, mode):
        if kind == "group":
            pair[1].vertex_groups.new(name=LANDMARKS)
        else:
            pair[1].data.attributes.new(LANDMARKS, "FLOAT", "POINT")
        before = [mesh_snapshot(obj) for obj in pair]
        if mode == "EDIT":
            edit(*pair)
        with pytest.raises(ObjectError, match=r'called "HM Landmark" that HierMatch did not write\. Rename it'):
            add_landmarks(*pair, [(3, 5)])
        if mode == "EDIT":
            bpy.ops.object.mode_set(mode="OBJECT")
        assert [mesh_snapshot(obj) for obj in pair] == before

    def test_too_many(self, pair):
        add_landmarks(*pair, [(vertex, vertex) for vertex in range(10, 23)])
        before = snapshot()
        with pytest.raises(RuntimeError, match="13 landmarks are more than the 12 points"):
            bpy.ops.hiermatch.match(**QUICK)
        assert snapshot() == before


def mark_faces(obj, faces):
    attribute = obj.data.attributes.new("Marked", "BOOLEAN", "FACE")
    for face in faces:
        attribute.data[face].value = True


class TestRegions:
    def test_a_group(self, pair):
        group = pair[0].vertex_groups.new(name="Tail")
        group.add([1, 2, 3], 1.0, "REPLACE")
        group.add([4], 0.2, "REPLACE")
        assert np.flatnonzero(excluded_vertices(pair[0], "Tail")).tolist() == [1, 2, 3]
        assert region_names(pair[0]) == ["Tail"]

    def test_faces_and_materials(self, pair):
        source = pair[0]
        ring = [face.index for face in source.data.polygons if 0 in face.vertices]
        mark_faces(source, ring)
        assert np.flatnonzero(excluded_vertices(source, "Marked")).tolist() == [0]
        for name in ("Skin", "Eye"):
            source.data.materials.append(bpy.data.materials.new(name))
        for face in ring:
            source.data.polygons[face].material_index = 1
        assert np.flatnonzero(excluded_vertices(source, "Eye")).tolist() == [0]
        assert region_names(source) == ["Marked", "Skin", "Eye"]

    def test_face_sets(self, pair):
        source = pair[0]
        ring = [face.index for face in source.data.polygons if 0 in face.vertices]
        sets = source.data.attributes.new(".sculpt_face_set", "INT", "FACE")
        for face in source.data.polygons:
            sets.data[face.index].value = 7 if face.index in ring else 1
        assert region_names(source) == ["Face Set 1", "Face Set 7"]
        assert np.flatnonzero(excluded_vertices(source, "Face Set 7")).tolist() == [0]
        with pytest.raises(ObjectError, match="face set called"):
            excluded_vertices(source, "Face Set 2")

    def test_nothing_is_left_out_without_a_name(self, pair):
        assert excluded_vertices(pair[0], "") is None

    @pytest.mark.parametrize(
        ("weight", "message"), [(None, "has no vertex group"), (0.0, "No vertex of"), (1.0, "nothing remains to match")]
    )
    def test_regions_that_cannot_be(self, pair, weight, message):
        if weight is not None:
            group = pair[1].vertex_groups.new(name="Tail")
            group.add(range(len(pair[1].data.vertices)), weight, "REPLACE")
        before = snapshot()
        with pytest.raises(RuntimeError, match=message):
            bpy.ops.hiermatch.match(exclude_target="Tail", **QUICK)
        assert snapshot() == before

    def test_a_match_without_them(self, pair):
        top = [[vertex.index for vertex in obj.data.vertices if vertex.co.z > 0.8] for obj in pair]
        for obj, vertices in zip(pair, top, strict=True):
            obj.vertex_groups.new(name="Top").add(vertices, 1.0, "REPLACE")
        bpy.ops.hiermatch.match(exclude_source="Top", exclude_target="Top", **QUICK)
        for obj, vertices in zip(pair, top, strict=True):
            points = {vertex for name, group in weights_of(obj).items() if name != "Top" for vertex in group}
            assert not points & set(vertices)

    def test_swapping_swaps_them(self, pair):
        assert pair
        state = bpy.context.scene.hiermatch
        state.exclude_source = "Tail"
        bpy.ops.hiermatch.swap()
        assert (state.exclude_source, state.exclude_target) == ("", "Tail")


def with_landmark(**changes):
    """Return what changes the first landmark in the text of a file."""

    def change(text):
        plain = json.loads(text)
        plain["landmarks"][0] |= changes
        return json.dumps(plain)

    return change


class TestFiles:
    @pytest.fixture
    def path(self, pair, tmp_path):
        add_landmarks(*pair, [(3, 5), (100, 110)])
        bpy.ops.hiermatch.switch_landmark(number=2, use=False)
        path = tmp_path / "landmarks"
        bpy.ops.hiermatch.save_landmarks(filepath=str(path))
        bpy.ops.hiermatch.clear_landmarks()
        return path.with_suffix(".json")

    def test_there_and_back(self, pair, path):
        add_landmarks(*pair, [(50, 60)])
        bpy.ops.hiermatch.load_landmarks(filepath=str(path))
        assert find_landmarks(*pair) == [Landmark(1, 3, 5), Landmark(2, 100, 110, use=False)]

    def test_beside_what_is_there(self, pair, path):
        add_landmarks(*pair, [(50, 60)])
        bpy.ops.hiermatch.load_landmarks(filepath=str(path), replace=False)
        assert found(pair) == [(1, 50, 60), (2, 3, 5), (3, 100, 110)]

    def test_what_is_there_keeps_its_number_for_third_meshes(self, pair, third, tmp_path):
        path = str(tmp_path / "two.json")
        bpy.ops.hiermatch.save_landmarks(filepath=path)
        bpy.ops.hiermatch.load_landmarks(filepath=path)
        assert found(pair) == found((pair[0], third)) == [(1, 70, 30), (3, 90, 50)]

    def test_on_a_mesh_that_was_renumbered(self, pair, path):
        places = [pair[0].data.vertices[vertex].co.copy() for vertex in (3, 100)]
        edit(pair[0])
        select(pair[0], [50])
        bpy.ops.mesh.delete(type="VERT")
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.hiermatch.load_landmarks(filepath=str(path))
        assert [pair[0].data.vertices[one.source].co for one in find_landmarks(*pair)] == places

    def test_on_another_mesh(self, pair, path):
        pair[0].data.vertices.add(1)
        for vertex in pair[0].data.vertices:
            vertex.co *= 3
        before = snapshot()
        with pytest.raises(RuntimeError, match="saved for another mesh"):
            bpy.ops.hiermatch.load_landmarks(filepath=str(path))
        assert snapshot() == before

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            (lambda text: text[:50], "no file of landmarks"),
            (lambda _text: '{"format": "else"}', "no file of landmarks"),
            (lambda text: json.dumps(json.loads(text) | {"version": 2}), "newer version"),
            (lambda _text: "[" * 100_000, "no file of landmarks"),
            (with_landmark(number=float("inf")), "no file of landmarks"),
            (with_landmark(name="half a character: \ud800"), "no file of landmarks"),
            (with_landmark(name="an end\0and more"), "no file of landmarks"),
            (with_landmark(source={"vertex": float("inf"), "position": [0, 0, 0]}), "no file of landmarks"),
            (with_landmark(source={"vertex": 100, "position": [0, 0, 0]}), "no file of landmarks"),  # as the other one
        ],
    )
    def test_files_that_cannot_be_read(self, pair, path, change, message):
        add_landmarks(*pair, [(100, 5), (50, 60)])
        path.write_text(change(path.read_text("utf8")), "utf8")
        before = snapshot()
        with pytest.raises(RuntimeError, match=message):
            bpy.ops.hiermatch.load_landmarks(filepath=str(path))
        assert snapshot() == before

    def test_a_name_may_be_long(self, pair, path):
        """Blender cuts a property that has a greatest length in the middle of a letter, and then cannot read it."""
        name = "a" + 40 * "目"
        path.write_text(with_landmark(name=name)(path.read_text("utf8")), "utf8")
        bpy.ops.hiermatch.load_landmarks(filepath=str(path))
        assert find_landmarks(*pair)[0].name == name
        sync_lists(bpy.context.scene)
        steering = bpy.context.scene.hiermatch_steering
        assert [row.label for row in steering.landmarks] == [name, "Landmark 2"]
        revision = steering.revision
        sync_lists(bpy.context.scene)
        assert steering.revision == revision

    def test_as_editors_on_windows_save_it(self, pair, path):
        path.write_text(path.read_text("utf8"), "utf-8-sig")
        bpy.ops.hiermatch.load_landmarks(filepath=str(path))
        assert found(pair) == [(1, 3, 5), (2, 100, 110)]

    def test_no_file_and_nothing_to_save(self, pair, tmp_path):
        assert pair
        with pytest.raises(RuntimeError, match="cannot be read"):
            bpy.ops.hiermatch.load_landmarks(filepath=str(tmp_path / "none.json"))
        with pytest.raises(RuntimeError, match="no landmarks in common"):
            bpy.ops.hiermatch.save_landmarks(filepath=str(tmp_path / "none.json"))
        add(3, 5)
        (tmp_path / "no folder").touch()
        with pytest.raises(RuntimeError, match="cannot be written"):
            bpy.ops.hiermatch.save_landmarks(filepath=str(tmp_path / "no folder" / "a.json"))


def mirrored(mesh):
    """Take each vertex to the one that is nearest to its mirror image."""
    images = cKDTree(mesh.vertices).query(mesh.vertices * [1, -1, 1])[1]
    yield Progress(0.5, "Looking")
    return as_map(images)


def as_map(images, confidence=1.0):
    """Stand for a left-right map."""
    return SimpleNamespace(
        source_to_target=SimpleNamespace(nearest_vertices=images), quality=SimpleNamespace(confidence=confidence)
    )


class TestMirror:
    @pytest.mark.parametrize("confidence", [0.98, 0.4])
    def test_meshes_that_are_hardly_symmetric_are_named(self, monkeypatch, capfd, confidence):
        def unsure(mesh):
            found = yield from mirrored(mesh)
            return as_map(found.source_to_target.nearest_vertices, confidence)

        monkeypatch.setattr(landmark_mirroring, "symmetry_map_steps", unsure)
        pair = add_symmetric_pair()
        state = bpy.context.scene.hiermatch
        state.source, state.target = pair
        add_landmarks(*pair, [tuple(max(o.data.vertices, key=lambda vertex: vertex.co.y).index for o in pair)])
        bpy.ops.hiermatch.mirror_landmarks()
        said = capfd.readouterr().out
        assert ("is hardly symmetric" in said) == (confidence < 0.5)
        bpy.ops.hiermatch.mirror_landmarks()
        assert "Nothing to mirror" in capfd.readouterr().out

    def test_to_the_other_side(self, monkeypatch):
        monkeypatch.setattr(landmark_mirroring, "symmetry_map_steps", mirrored)
        pair = add_symmetric_pair()
        state = bpy.context.scene.hiermatch
        state.source, state.target = pair
        left = [max(obj.data.vertices, key=lambda vertex: vertex.co.y).index for obj in pair]
        top = [max(obj.data.vertices, key=lambda vertex: vertex.co.z).index for obj in pair]
        add_landmarks(*pair, [tuple(left), tuple(top)])
        bpy.ops.hiermatch.mirror_landmarks()
        landmarks = find_landmarks(*pair)
        assert len(landmarks) == 3
        for obj, vertex, before in zip(pair, (landmarks[2].source, landmarks[2].target), left, strict=True):
            place = obj.data.vertices[before].co * Vector((1, -1, 1))
            assert (obj.data.vertices[vertex].co - place).length < 1e-3
        bpy.ops.hiermatch.mirror_landmarks()
        assert find_landmarks(*pair) == landmarks

    def test_what_contradicts_the_match_is_left_out(self, dense_pair, monkeypatch):
        def turned(mesh):
            """Mirror the source, and turn the target, which has more vertices, upside down."""
            signs = [1, -1, 1] if mesh.vertex_count == len(dense_pair[0].data.vertices) else [1, -1, -1]
            centre = mesh.vertices.mean(axis=0)
            images = cKDTree(mesh.vertices).query((mesh.vertices - centre) * signs + centre)[1]
            yield Progress(0.5, "Looking")
            return as_map(images)

        monkeypatch.setattr(landmark_mirroring, "symmetry_map_steps", turned)
        high = [max(obj.data.vertices, key=lambda vertex: vertex.co.y + 0.6 * vertex.co.z).index for obj in dense_pair]
        add_landmarks(*dense_pair, [tuple(high)])
        bpy.ops.hiermatch.mirror_landmarks()
        assert len(find_landmarks(*dense_pair)) == 1
        monkeypatch.setattr(landmark_mirroring, "symmetry_map_steps", mirrored)
        bpy.ops.hiermatch.mirror_landmarks()
        assert len(find_landmarks(*dense_pair)) == 2

    def test_nothing_to_mirror(self, pair):
        assert pair
        with pytest.raises(RuntimeError, match="no landmarks in common"):
            bpy.ops.hiermatch.mirror_landmarks()


def test_picking_needs_a_window(pair):
    assert pair
    with pytest.raises(RuntimeError, match="nothing to click on"):
        bpy.ops.hiermatch.pick_landmarks()


def test_marks_are_written_as_they_are_read(pair):
    marks = {1: (3, True), 4: (5, False)}
    write_marks(pair[0], marks)
    assert read_marks(pair[0]) == marks
