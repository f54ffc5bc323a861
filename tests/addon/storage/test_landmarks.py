# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks: named, kept on the meshes, and kept to by a match."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.storage import landmark_layer
from hiermatch.hiermatch_addon.storage.landmark_layer import LANDMARKS, read_marks, write_marks
from hiermatch.hiermatch_addon.storage.landmarks import add_landmarks, find_landmarks, landmark_array
from hiermatch.hiermatch_addon.storage.written_names import written_names

from tests.addon.marks import add, add_third, edit, found, listed, select
from tests.addon.scenes import QUICK, mesh_snapshot, snapshot, weights_of


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
    def test_a_number_that_a_third_mesh_has_is_not_given_again(self, pair, mode):
        third = add_third(pair)
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


def test_marks_are_written_as_they_are_read(pair):
    marks = {1: (3, True), 4: (5, False)}
    write_marks(pair[0], marks)
    assert read_marks(pair[0]) == marks
