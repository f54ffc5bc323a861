# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.match`, as scripts and users call it."""

from __future__ import annotations

import bpy
import pytest
from hiermatch import engine
from hiermatch.hiermatch_addon.scene import mesh_io

from tests.addon.scenes import (
    QUICK,
    add_blob,
    add_pair,
    add_symmetric_pair,
    mesh_snapshot,
    snapshot,
    values_of,
    weights_of,
    without_mirrored,
)


@pytest.fixture
def pair():
    return add_pair()


def match(**options):
    return bpy.ops.hiermatch.match(**(QUICK | options))


def matched_vertices(obj):
    """For each matched point, the vertex with the largest weight."""
    return [max(weights, key=weights.get) for name, weights in weights_of(obj).items() if name.startswith("HM.")]


def summary():
    return bpy.context.scene.hiermatch.summary


class TestResult:
    def test_what_is_written_is_what_the_engine_finds(self, pair):
        assert match(source="Source", target="Target") == {"FINISHED"}
        depsgraph = bpy.context.evaluated_depsgraph_get()
        meshes = [mesh_io.read_mesh(obj, depsgraph, use_modifiers=False) for obj in pair]
        expected = engine.match(*meshes, engine.MatchSettings(**QUICK))
        for obj, points in zip(pair, (expected.source_points, expected.target_points), strict=True):
            written = weights_of(obj)
            assert list(written) == [f"HM.{number:03d}" for number in range(1, QUICK["points"] + 1)]
            for weights, corners, shares in zip(written.values(), points.corners, points.barycentric, strict=True):
                assert weights == pytest.approx({int(c): s for c, s in zip(corners, shares, strict=True) if s > 0})
        assert summary().points == QUICK["points"]
        assert (summary().source, summary().target) == ("Source", "Target")
        assert summary().distortion == pytest.approx(expected.distortion, abs=1e-6)
        assert summary().proven == expected.coarse.proven
        assert summary().orientation == pytest.approx(expected.orientation)
        assert summary().answers.splitlines() == ["direct", *(other.name for other in expected.alternatives)]

    def test_a_moved_and_scaled_copy_is_matched_to_itself(self, pair):
        source, target = pair
        match(source="Source", target="Target")
        assert matched_vertices(source) == matched_vertices(target)
        assert len(set(matched_vertices(source))) == QUICK["points"]
        colours = [values_of(obj.data.attributes["HM Match"]) for obj in pair]
        assert colours[0] == pytest.approx(colours[1], abs=0.02)

    def test_unapplied_transforms_make_no_difference(self, pair):
        source, target = pair
        source.rotation_euler, source.scale = (0.4, 2, -1), (0.7, 1.5, 1)
        target.rotation_euler, target.scale = (-1, 0.2, 0.6), (3, 2, 2.5)
        bpy.context.view_layer.update()
        match(source="Source", target="Target")
        unapplied = [matched_vertices(obj) for obj in pair]
        bpy.ops.hiermatch.clear(object="Source")
        bpy.ops.hiermatch.clear(object="Target")
        for obj in pair:
            obj.data.transform(obj.matrix_world)
            obj.matrix_world.identity()
        bpy.context.view_layer.update()
        match(source="Source", target="Target")
        assert [matched_vertices(obj) for obj in pair] == unapplied

    def test_the_same_twice_is_the_same(self, pair):
        match(source="Source", target="Target")
        once = [mesh_snapshot(obj) for obj in pair]
        match(source="Source", target="Target")
        assert [mesh_snapshot(obj) for obj in pair] == once

    def test_shown_shape_not_basis_when_modifiers_are_used(self, pair):
        target = pair[1]
        target.shape_key_add(name="Basis")
        key = target.shape_key_add(name="Flat")
        for point in key.data:
            point.co.z *= 0.05
        key.value = 1
        match(source="Source", target="Target")
        without = summary().distortion
        match(source="Source", target="Target", use_modifiers=True)
        assert summary().distortion > 10 * max(without, 1e-3)

    def test_ngons(self, pair):
        bpy.context.view_layer.objects.active = pair[1]
        pair[1].modifiers.new("Planar", "DECIMATE").decimate_type = "DISSOLVE"
        pair[1].modifiers["Planar"].angle_limit = 0.2
        bpy.ops.object.modifier_apply(modifier="Planar")
        assert max(len(polygon.vertices) for polygon in pair[1].data.polygons) > 4
        assert match(source="Source", target="Target") == {"FINISHED"}
        assert len(weights_of(pair[1])) == QUICK["points"]

    def test_the_mirrored_answer(self):
        _, target = add_symmetric_pair()
        match(source="Source", target="Target")
        first = matched_vertices(target)
        assert summary().answers == "direct\nmirrored"
        assert summary().answer == 0
        assert summary().orientation > 0.5
        match(source="Source", target="Target", alternative=1)
        assert matched_vertices(target) != first
        assert summary().answer == 1
        assert summary().orientation < -0.5
        assert not summary().notes

    def test_no_mirrored_answer_is_a_note(self, pair, monkeypatch):
        assert pair
        without_mirrored(monkeypatch)
        match(source="Source", target="Target", alternative=1)
        assert summary().answers == "direct"
        assert summary().answer == 0
        assert "There is no alternative 1, only 0" in summary().notes

    def test_choices_reach_the_engine(self):
        add_symmetric_pair()
        match(source="Source", target="Target")
        earth_mover = summary().distortion
        match(source="Source", target="Target", comparison="BIN_TO_BIN")
        assert summary().distortion != pytest.approx(earth_mover, rel=1e-3)

    def test_several_parts_are_a_warning(self, pair):
        island = add_blob("Island", 8, 6)
        island.location.x, island.scale = 9, (0.2, 0.2, 0.2)
        with bpy.context.temp_override(active_object=pair[0], selected_editable_objects=[pair[0], island]):
            bpy.ops.object.join()
        assert match(source="Source", target="Target") == {"FINISHED"}
        assert "smaller part" in summary().notes
        assert (values_of(pair[0].data.attributes["HM Distortion Value"]) == -1).any()


class TestObjects:
    def test_active_object_and_the_other_selected_one(self, pair):
        source, target = pair
        source.select_set(state=True)
        target.select_set(state=True)
        bpy.context.view_layer.objects.active = target
        assert match() == {"FINISHED"}
        assert (summary().source, summary().target) == ("Target", "Source")

    def test_repeating_it_means_the_same_two_whatever_is_selected_then(self, pair):
        for obj in pair:
            obj.select_set(state=True)
        bpy.context.view_layer.objects.active = pair[0]
        bpy.ops.hiermatch.match("EXEC_DEFAULT", True, **QUICK)  # noqa: FBT003 - registers it for Adjust Last Operation
        last = bpy.context.window_manager.operators[-1].properties
        assert (last.source, last.target) == ("Source", "Target")

    def test_picked_in_the_panel(self, pair):
        state = bpy.context.scene.hiermatch
        state.source, state.target = pair
        assert match() == {"FINISHED"}
        assert (summary().source, summary().target) == ("Source", "Target")

    def test_swap_exchanges_the_picked_ones(self, pair):
        state = bpy.context.scene.hiermatch
        state.source, state.target = pair
        assert bpy.ops.hiermatch.swap() == {"FINISHED"}
        assert (state.source, state.target) == pair[::-1]

    def test_swap_says_why_it_cannot(self, pair):
        assert pair
        with pytest.raises(RuntimeError, match="Pick a Source or a Target first"):
            bpy.ops.hiermatch.swap()

    def test_selection_and_active_object_stay(self, pair):
        pair[1].select_set(state=True)
        bpy.context.view_layer.objects.active = pair[1]
        match(source="Source", target="Target")
        assert bpy.context.selected_objects == [pair[1]]
        assert bpy.context.view_layer.objects.active == pair[1]

    def test_an_active_light_is_no_source(self, pair):
        light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
        bpy.context.collection.objects.link(light)
        light.select_set(state=True)
        pair[0].select_set(state=True)
        bpy.context.view_layer.objects.active = light
        with pytest.raises(RuntimeError, match='"Light" is not a mesh'):
            match()


def two_points_too_many():
    return {"points": len(bpy.data.objects["Source"].data.vertices) + 2}


def edge_only():
    bpy.data.objects["Target"].data.clear_geometry()
    bpy.data.objects["Target"].data.from_pydata([(0, 0, 0), (1, 0, 0)] * 50, [(0, 1)], [])
    return {}


def clash():
    bpy.data.objects["Target"].vertex_groups.new(name="HM.003")
    return {}


def subdivided():
    bpy.data.objects["Target"].modifiers.new("Finer", "SUBSURF")
    return {"use_modifiers": True}


def not_finite():
    bpy.data.objects["Target"].data.vertices[3].co.x = float("nan")
    return {}


ERRORS = {
    "points": (two_points_too_many, "too few for .* Points"),
    "no faces": (edge_only, "has no faces"),
    "clash": (clash, "already has a vertex group"),
    "modifiers": (subdivided, '"Finer"'),
    "not finite": (not_finite, "not a finite number"),
    "settings": (lambda: {"coarse_points": 20, "coarse_candidates": 5}, "Coarse Candidates"),
    "prefix": (lambda: {"prefix": "  "}, "Prefix is empty"),
    "unknown": (lambda: {"target": "Taget"}, "no object called"),
    "same": (lambda: {"target": "Source"}, "both"),
    "scale": (lambda: setattr(bpy.data.objects["Target"], "scale", (0, 0, 0)) or {}, "scale of zero"),
    "hidden": (lambda: bpy.data.objects["Target"].hide_set(state=True) or {}, "hidden"),
}


def test_a_cube_is_matched_by_as_many_points_as_it_has():
    for name in ("Source", "Target"):
        bpy.ops.mesh.primitive_cube_add()
        bpy.context.object.name = name
    count = len(bpy.context.object.data.vertices)
    options = {"coarse_points": 10, "coarse_candidates": 20, "dense": True}
    with pytest.raises(RuntimeError, match=f"Set Points to {count} or fewer"):
        match(source="Source", target="Target", points=64, **options)
    assert match(source="Source", target="Target", points=count, **options) == {"FINISHED"}


@pytest.mark.parametrize("error", ERRORS)
def test_errors_are_told_and_change_nothing(pair, error):
    prepare, message = ERRORS[error]
    match(source="Source", target="Target", prefix="Earlier")
    options = {"source": "Source", "target": "Target"} | prepare()
    bpy.context.view_layer.update()
    before = repr(snapshot())  # as text, for nan is not equal to itself
    with pytest.raises(RuntimeError, match=message) as caught:
        match(**options)
    assert "Traceback" not in str(caught.value)
    assert repr(snapshot()) == before
    assert pair


def test_a_bug_is_not_swallowed(pair, monkeypatch):
    def broken(*_arguments, **_names):
        raise ZeroDivisionError("a bug")

    monkeypatch.setattr("hiermatch.hiermatch_addon.jobs.match_job.contents_steps", broken)
    before = snapshot()
    with pytest.raises(RuntimeError, match=r"(?s)Traceback.*ZeroDivisionError: a bug"):
        match(source="Source", target="Target")
    assert snapshot() == before
    assert pair


def test_edit_mode_is_refused_by_the_button(pair):
    bpy.context.view_layer.objects.active = pair[0]
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Switch to Object Mode first"):
        match(source="Source", target="Target")
    bpy.ops.object.mode_set(mode="OBJECT")


def test_one_mesh_is_refused_by_the_button():
    add_blob("Alone")
    with pytest.raises(RuntimeError, match="Two mesh objects are needed in this view layer"):
        match()


def test_instances_of_collections_are_told_to_be_no_meshes():
    add_blob("Alone")
    instance = bpy.data.objects.new("Hero", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", bpy.data.collections.new("Hero")
    bpy.context.scene.collection.objects.link(instance)
    with pytest.raises(RuntimeError, match="Make library overrides of what instances show"):
        match()
    with pytest.raises(RuntimeError, match="Make library overrides of what instances show"):
        bpy.ops.hiermatch.retarget()


def test_one_undo_takes_it_back_and_redo_brings_it_again(pair):
    assert pair
    before = snapshot()
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.hiermatch.match("EXEC_DEFAULT", True, source="Source", target="Target", **QUICK)  # noqa: FBT003
    after = snapshot()
    assert after != before
    bpy.ops.ed.undo()
    assert snapshot() == before
    bpy.ops.ed.redo()
    assert snapshot() == after
