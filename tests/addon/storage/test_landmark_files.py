# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks in files."""

from __future__ import annotations

import json

import bpy
import pytest
from hiermatch.hiermatch_addon.properties.steering_lists import sync_lists
from hiermatch.hiermatch_addon.storage.landmarks import Landmark, add_landmarks, find_landmarks

from tests.addon.marks import add, add_third, edit, found, select
from tests.addon.scenes import snapshot


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

    def test_on_vertices_that_lie_at_one_place(self, pair, tmp_path, capfd):
        for obj in pair:
            obj.data.vertices[101].co = obj.data.vertices[100].co
        add_landmarks(*pair, [(101, 101)])
        path = str(tmp_path / "doubled.json")
        bpy.ops.hiermatch.save_landmarks(filepath=path)
        bpy.ops.hiermatch.clear_landmarks()
        bpy.ops.hiermatch.load_landmarks(filepath=path)
        assert found(pair) == [(1, 101, 101)]
        assert "has other vertices" not in capfd.readouterr().out

    def test_beside_what_is_there(self, pair, path):
        add_landmarks(*pair, [(50, 60)])
        bpy.ops.hiermatch.load_landmarks(filepath=str(path), replace=False)
        assert found(pair) == [(1, 50, 60), (2, 3, 5), (3, 100, 110)]

    def test_what_is_there_keeps_its_number_for_third_meshes(self, pair, tmp_path):
        third = add_third(pair)
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
