# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the viewport: computed as plain data, so it needs no window."""

from __future__ import annotations

import ast

import bpy
import numpy as np
import pytest
from hiermatch.engine import Preview
from hiermatch.hiermatch_addon.overlay import drawing as drawn
from hiermatch.hiermatch_addon.overlay.overlay_data import (
    Marks,
    Places,
    Shown,
    drawing,
    place,
    preview_points,
    project,
)
from hiermatch.hiermatch_addon.overlay.overlay_io import drawn_objects, read_drawing, settings, signature
from hiermatch.hiermatch_addon.storage.landmarks import add_landmarks
from hiermatch.hiermatch_addon.storage.views.colors import distortion_colors
from mathutils import Matrix

from tests.addon.scenes import QUICK, add_blob, add_pair
from tests.addon.test_rules import BLENDER, imported
from tools.source_extension import ROOT

NONE = Marks(np.empty((0, 3)), np.empty((0, 3)), np.empty(0, int))


def marks(count, chosen=-1, seed=0):
    random = np.random.default_rng(seed)
    return Marks(random.normal(size=(count, 3)), random.normal(size=(count, 3)), np.arange(1, count + 1), chosen)


def draw(pairs=NONE, landmarks=NONE, shown=None, **names):
    distortion = np.linspace(0.0, 1.0, len(pairs.numbers))
    return drawing(pairs, distortion, landmarks, np.ones(len(landmarks.numbers), bool), shown or Shown(), **names)


class TestData:
    def test_it_knows_no_blender(self):
        path = ROOT / "hiermatch_addon" / "overlay" / "overlay_data.py"
        assert not BLENDER & set(imported(path))
        names = [
            node.module for node in ast.walk(ast.parse(path.read_text("utf8"))) if isinstance(node, ast.ImportFrom)
        ]
        assert "access" not in names

    def test_points_and_lines_have_the_colors_of_the_distortion(self):
        pairs = marks(7)
        found = draw(pairs)
        (lines,), (points,) = found.lines, found.points
        assert points.positions == pytest.approx(np.concatenate([pairs.source, pairs.target]), abs=1e-6)
        shades = distortion_colors(np.linspace(0, 1, 7), 1.0)
        assert points.colors[:7, :3] == pytest.approx(shades, abs=1e-6)
        assert points.colors[7:, :3] == pytest.approx(shades, abs=1e-6)
        assert lines.positions[::2] == pytest.approx(pairs.source, abs=1e-6)
        assert lines.positions[1::2] == pytest.approx(pairs.target, abs=1e-6)
        assert lines.colors[1::2, :3] == pytest.approx(shades, abs=1e-6)
        assert (points.faint[:, 3] < points.colors[:, 3]).all()

    def test_all_arrays_can_be_uploaded_as_they_are(self):
        found = draw(marks(7, 2), marks(3, 1), Shown(labels=True), pending=(1, 2, 3))
        for group in (*found.lines, *found.points):
            for array in (group.positions, group.colors):
                assert array.dtype == np.float32
                assert array.flags.c_contiguous
            assert len(group.positions) == len(group.colors)
        assert all(cloud.faint.flags.c_contiguous for cloud in found.points)

    def test_the_active_pair_is_drawn_last_and_large(self):
        pairs = marks(7, 2)
        found = draw(pairs)
        assert found.points[-1].width > found.points[0].width
        assert found.points[-1].positions == pytest.approx(np.stack([pairs.source[2], pairs.target[2]]), abs=1e-6)
        assert found.lines[-1].width > found.lines[0].width

    def test_a_preview_has_the_same_color_at_both_ends(self):
        source, target = np.random.default_rng(0).normal(size=(2, 50, 3))
        cloud = preview_points(Preview(source, target))
        assert cloud.positions == pytest.approx(np.concatenate([source, target]), abs=1e-6)
        assert (cloud.colors[:50] == cloud.colors[50:]).all()
        assert len(np.unique(cloud.colors[:50], axis=0)) > 40

    def test_landmarks_that_are_off_are_grey(self):
        found = drawing(NONE, np.empty(0), marks(2), np.array([True, False]), Shown())
        on, off = found.points[0].colors[:2, :3]
        assert np.ptp(off) == 0
        assert np.ptp(on) > 0.3

    @pytest.mark.parametrize(
        ("shown", "lines", "points", "labels"),
        [
            (Shown(), 2, 2, 0),
            (Shown(points=False), 2, 1, 0),
            (Shown(lines=False), 0, 2, 0),
            (Shown(labels=True), 2, 2, 16),
            (Shown(points=False, labels=True), 2, 1, 6),
        ],
    )
    def test_what_is_wanted(self, shown, lines, points, labels):
        found = draw(marks(5), marks(3), shown)
        assert (len(found.lines), len(found.points), len(found.labels)) == (lines, points, labels)

    def test_nothing(self):
        found = draw()
        assert (found.lines, found.points, found.labels) == ((), (), ())

    def test_labels_are_numbers_on_both_sides(self):
        found = draw(marks(2), marks(1), Shown(labels=True))
        assert [label.text for label in found.labels] == ["1", "2", "1", "2", "L1", "L1"]

    def test_only_the_first_of_many_and_the_active_one_have_numbers(self):
        found = draw(marks(512, 300), NONE, Shown(labels=True))
        texts = [label.text for label in found.labels]
        assert len(texts) < 100
        assert texts[:3] == ["1", "2", "3"]
        assert texts.count("301") == 2

    def test_places_follow_the_matrix(self):
        positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
        places = Places(np.array([[0, 1, 2]]), np.array([[0.2, 0.3, 0.5]]))
        matrix = np.diag([2.0, 3.0, 4.0, 1.0])
        matrix[:3, 3] = [10, 20, 30]
        assert place(positions, places, matrix)[0] == pytest.approx([10.6, 21.5, 30])

    def test_vertices_that_are_gone_do_no_harm(self):
        places = Places(np.array([[0, 1, 7]]), np.array([[0.2, 0.3, 0.5]]))
        assert place(np.zeros((3, 3), np.float32), places, np.eye(4)).tolist() == [[0, 0, 0]]
        assert place(np.zeros((0, 3), np.float32), places, np.eye(4)).tolist() == [[0, 0, 0]]

    def test_projection(self):
        perspective = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, -1, 0]])  # looks along -z
        places = np.array([[0, 0, -2], [1, -1, -2], [0, 0, 2], [5, 0, -2]], float)
        pixels, visible = project(places, perspective, (200, 100))
        assert visible.tolist() == [True, True, False, False]
        assert pixels[:2].tolist() == [[100, 50], [150, 25]]


class TestScene:
    @pytest.fixture
    def pair(self):
        source, target = add_pair()
        state = bpy.context.scene.hiermatch
        state.source, state.target = source, target
        bpy.ops.hiermatch.match(**QUICK)
        bpy.context.scene.hiermatch_steering.show_overlay = True
        return source, target

    def read(self, pending=None):
        return read_drawing(bpy.context.scene, bpy.context.evaluated_depsgraph_get(), pending)

    def test_points_lie_where_their_groups_are(self, pair):
        found = self.read().points[0]
        numbers = [item.number for item in bpy.context.scene.hiermatch_steering.pairs]
        for side, obj in enumerate(pair):
            for row, number in enumerate(numbers):
                group = obj.vertex_groups[f"HM.{number:03d}"].index
                place = np.zeros(3)
                for vertex in obj.data.vertices:
                    for element in vertex.groups:
                        if element.group == group:
                            place = place + element.weight * np.array(obj.matrix_world @ vertex.co)
                assert found.positions[side * len(numbers) + row] == pytest.approx(place, abs=1e-5)

    def test_the_worst_come_first(self, pair):
        assert pair
        distortion = [item.distortion for item in bpy.context.scene.hiermatch_steering.pairs]
        assert distortion == sorted(distortion, reverse=True)
        assert len(distortion) == QUICK["points"]

    def test_it_follows_the_objects(self, pair):
        before = self.read().points[0].positions
        turn = Matrix.Rotation(1.0, 4, "X") @ Matrix.Translation((1, 2, 3)) @ Matrix.Diagonal((1, 2, 3, 1))
        pair[1].matrix_world = turn @ pair[1].matrix_world
        bpy.context.view_layer.update()
        after = self.read().points[0].positions
        half = len(before) // 2
        assert after[:half].tolist() == before[:half].tolist()
        expected = np.column_stack([before[half:], np.ones(half)]) @ np.array(turn).T
        assert after[half:] == pytest.approx(expected[:, :3], abs=1e-4)

    def test_it_follows_modifiers(self, pair):
        before = self.read().points[0].positions
        modifier = pair[0].modifiers.new("Up", "DISPLACE")
        modifier.direction, modifier.mid_level = "Z", 0.0
        bpy.context.view_layer.update()
        after = self.read().points[0].positions
        half = len(before) // 2
        assert after[:half] - before[:half] == pytest.approx(np.tile([0, 0, 1], (half, 1)), abs=1e-5)

    def test_it_is_read_again_in_another_frame(self, pair):
        obj = pair[0]
        obj.shape_key_add(name="Basis")
        key = obj.shape_key_add(name="Up")
        for point in key.data:
            point.co.z += 1
        for frame, value in ((1, 0.0), (2, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        bpy.context.scene.frame_set(1)
        before = self.read().points[0].positions
        drawn._overlay.edited = False  # noqa: SLF001
        bpy.context.scene.frame_set(2)
        assert drawn._overlay.edited  # noqa: SLF001
        assert not np.allclose(self.read().points[0].positions, before)

    def test_meshes_are_read_again_if_they_are_edited_or_posed_but_not_if_others_are(self, pair):
        bpy.ops.object.armature_add()
        rig, other = bpy.context.object, add_blob("Other")
        for obj in (pair[0], other):
            obj.modifiers.new("Rig", "ARMATURE").object = rig
            obj.vertex_groups.new(name="Bone").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        bpy.context.view_layer.update()
        drawn._overlay.drawn = drawn_objects(bpy.context.scene)  # noqa: SLF001

        def is_read_again(change):
            drawn._overlay.edited = False  # noqa: SLF001
            change()
            bpy.context.view_layer.update()
            return drawn._overlay.edited  # noqa: SLF001

        def edit(obj):
            obj.data.vertices[0].co.x += 1
            obj.data.update()

        assert not is_read_again(lambda: edit(other))
        assert is_read_again(lambda: edit(pair[1]))
        assert is_read_again(lambda: setattr(rig.pose.bones["Bone"].location, "y", 5))
        assert is_read_again(lambda: pair[1].shape_key_add(name="Basis"))

    def test_what_it_depends_on(self, pair):
        scene = bpy.context.scene
        steering = scene.hiermatch_steering

        def read(pending=None):
            return settings(scene, bpy.context.view_layer, pending), signature(scene)

        seen = [read()]
        assert read() == seen[0]

        def changed():
            bpy.context.view_layer.update()
            seen.append(read())
            assert seen[-1] not in seen[:-1]

        pair[0].location.x += 1
        changed()
        steering.show_lines = False
        changed()
        steering.pair_index = 3
        changed()
        bpy.ops.hiermatch.add_landmark(source_vertex=3, target_vertex=4)
        changed()
        pair[0].hide_set(state=True)
        changed()
        assert not self.read().points
        assert read(("Source", 3)) != seen[-1]
        steering.show_overlay = False
        assert read()[0] is None

    def test_objects_are_looked_up_again_only_if_something_has_changed(self, pair, monkeypatch):
        """Viewports are drawn at each move of the mouse, and a picked rig or collection may have thousands of parts."""
        looked, uploaded = [], []
        monkeypatch.setattr(drawn, "signature", lambda scene: (looked.append(scene), signature(scene))[1])
        overlay = drawn._overlay  # noqa: SLF001
        monkeypatch.setattr(overlay, "_upload", lambda: uploaded.append(1), raising=False)
        bpy.context.view_layer.update()

        def count(change):
            change()
            bpy.context.view_layer.update()
            looked.clear()
            uploaded.clear()
            for _ in range(3):
                assert overlay.update(bpy.context)
            return len(looked), len(uploaded)

        def undo():
            pair[0].location.x += 1
            bpy.ops.ed.undo_push(message="Moved")
            count(lambda: None)
            bpy.ops.ed.undo()

        bpy.ops.ed.undo_push(message="Before")
        assert count(lambda: None) == (1, 1)
        assert count(lambda: None) == (0, 0)
        assert count(lambda: setattr(pair[1].location, "x", 7)) == (1, 1)
        assert count(lambda: add_blob("Other")) == (1, 0)
        assert count(lambda: pair[0].hide_set(state=True)) == (1, 1)
        assert count(lambda: pair[0].hide_set(state=False)) == (1, 1)
        bpy.ops.ed.undo_push(message="Before")
        assert count(undo) == (1, 1)

    def test_a_place_that_waits(self, pair):
        found = self.read(("Target", 7)).points[-1]
        assert found.positions[0] == pytest.approx(pair[1].matrix_world @ pair[1].data.vertices[7].co, abs=1e-5)

    def test_landmarks_without_a_match(self):
        source, target = add_pair()
        add_landmarks(source, target, [(3, 5)])
        bpy.context.scene.hiermatch.source, bpy.context.scene.hiermatch.target = source, target
        found = self.read().points[0]
        assert found.positions[1] == pytest.approx(target.matrix_world @ target.data.vertices[5].co, abs=1e-5)

    def test_clearing_empties_it(self, pair):
        assert pair
        bpy.ops.hiermatch.clear()
        assert not bpy.context.scene.hiermatch_steering.pairs
        assert not self.read().points
