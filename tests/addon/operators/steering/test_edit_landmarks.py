# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that add, change and remove landmarks."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.operators.steering import landmark_picking
from hiermatch.hiermatch_addon.storage.landmarks import find_landmarks, landmark_array
from mathutils import Matrix, Vector

from tests.addon.marks import add, add_third, edit, found, listed, select
from tests.addon.scenes import add_pair, edit_twin, snapshot


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

    def test_a_change_for_third_meshes_is_said(self, pair, capfd):
        third = add_third(pair)

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


def test_picking_needs_a_window(pair):
    assert pair
    with pytest.raises(RuntimeError, match="nothing to click on"):
        bpy.ops.hiermatch.pick_landmarks()
