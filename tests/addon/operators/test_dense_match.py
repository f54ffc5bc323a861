# SPDX-License-Identifier: GPL-3.0-or-later
"""The dense map, from the operators' side: written, shown, kept, flipped, swapped and cleared."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch import engine
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene import mesh_io
from hiermatch.hiermatch_addon.storage.stored_map import find_maps
from hiermatch.hiermatch_addon.storage.views import colors
from hiermatch.hiermatch_addon.storage.writing import change_kept, kept

from tests.addon.scenes import (
    DENSE,
    MAP_ATTRIBUTES,
    QUICK,
    add_blob,
    add_pair,
    add_symmetric_pair,
    maps_of,
    mesh_snapshot,
    snapshot,
    values_of,
    weights_of,
)

SHOWN = ["HM Match", "HM Distortion", "HM Distortion Value", "HM Confidence"]
OTHER_MAP_ATTRIBUTES = [name.replace("Map", "Other Map") for name in MAP_ATTRIBUTES]


def match(**options):
    assert bpy.ops.hiermatch.match(**({"source": "Source", "target": "Target"} | DENSE | options)) == {"FINISHED"}


def flip(**options):
    assert bpy.ops.hiermatch.flip(**options) == {"FINISHED"}


def summary():
    return bpy.context.scene.hiermatch.summary


def attributes(obj):
    return {name: values_of(obj.data.attributes[name]) for name in obj.data.attributes.keys() if name.startswith("HM")}  # noqa: SIM118


def read(obj):
    return mesh_io.read_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=False)


def same_maps(one, other):
    return all(
        np.array_equal(getattr(getattr(one, way).points, field), getattr(getattr(other, way).points, field))
        and np.array_equal(getattr(one, way).confidence, getattr(other, way).confidence)
        for way in ("source_to_target", "target_to_source")
        for field in ("corners", "barycentric", "positions")
    )


class TestWritten:
    def test_what_stands_on_both_meshes(self, dense_pair):
        kinds = dict.fromkeys(SHOWN, "FLOAT_COLOR") | dict.fromkeys(MAP_ATTRIBUTES, "INT")
        kinds |= {"HM Distortion Value": "FLOAT", "HM Map Weights": "FLOAT_VECTOR", "HM Map Confidence": "FLOAT"}
        for obj, other in zip(dense_pair, dense_pair[::-1], strict=True):
            found = {name: obj.data.attributes[name] for name in attributes(obj)}
            assert {name: attribute.data_type for name, attribute in found.items()} == kinds
            assert {attribute.domain for attribute in found.values()} == {"POINT"}
            assert obj.data.attributes.active_color_name == "HM Match"
            values = attributes(obj)
            for number in (1, 2, 3):
                assert values[f"HM Map Vertex {number}"].min() >= 0
                assert values[f"HM Map Vertex {number}"].max() < len(other.data.vertices)
            assert values["HM Map Weights"].reshape(-1, 3).sum(axis=1) == pytest.approx(1, abs=1e-6)
            assert all(np.isfinite(array).all() for array in values.values())

    def test_it_is_what_the_engine_finds(self, dense_pair):
        meshes = [read(obj) for obj in dense_pair]
        expected = engine.match(*meshes, engine.MatchSettings(**DENSE))
        found = maps_of(*dense_pair)
        for way in ("source_to_target", "target_to_source"):
            assert getattr(found, way).positions == pytest.approx(getattr(expected, way).positions, abs=1e-5)
            assert getattr(found, way).confidence == pytest.approx(getattr(expected, way).confidence, abs=1e-6)
        assert (found.source.vertices == meshes[0].vertices).all()
        assert summary().verdict == expected.quality.sentence
        assert summary().confidence == pytest.approx(expected.quality.confidence)

    def test_colours_are_carried_by_the_map(self, dense_pair):
        maps = maps_of(*dense_pair)
        own = colors.match_colors(maps.source.vertices, maps.source.vertex_areas)
        for obj, shown in zip(dense_pair, (own, maps.target_to_source.transfer(own)), strict=True):
            written = attributes(obj)["HM Match"].reshape(-1, 4)
            assert written[:, :3] == pytest.approx(colors.to_linear(shown), abs=1e-6)
        confidence = attributes(dense_pair[1])["HM Confidence"].reshape(-1, 4)[:, :3]
        shades = colors.confidence_colors(maps.target_to_source.confidence)
        assert confidence == pytest.approx(colors.to_linear(shades), abs=1e-6)

    def test_the_matched_points_lie_where_the_map_takes_them(self, dense_pair):
        source, target = dense_pair
        maps = maps_of(source, target)
        there = maps.source_to_target.positions
        for name, weights in weights_of(source).items():
            (vertex,) = weights
            place = sum(
                w * np.array(target.matrix_world @ target.data.vertices[v].co)
                for v, w in weights_of(target)[name].items()
            )
            assert np.linalg.norm(there[vertex] - place) < 0.05 * np.sqrt(maps.target.area)

    def test_a_moved_and_scaled_copy_is_mapped_to_itself(self):
        pair = add_pair()
        match()
        maps = maps_of(*pair)
        for way in (maps.source_to_target, maps.target_to_source):
            assert (way.nearest_vertices == np.arange(len(way))).mean() > 0.98
        for name in ("HM Match", "HM Distortion"):
            one, other = (attributes(obj)[name] for obj in pair)
            assert np.quantile(np.abs(one - other), 0.98) < 0.02
        assert np.median(attributes(pair[0])["HM Distortion Value"]) < 0.02
        assert maps.source_to_target.confidence.min() > 0.5
        assert summary().confidence > 0.5

    @pytest.mark.parametrize("missing", ["colors", "distortion", "confidence"])
    def test_each_kind_can_be_left_out_and_the_map_is_kept(self, missing):
        pair = add_pair()
        match(**{f"write_{missing}": False})
        left_out = {"colors": SHOWN[:1], "distortion": SHOWN[1:3], "confidence": SHOWN[3:]}[missing]
        assert set(attributes(pair[0])) == {*SHOWN, *MAP_ATTRIBUTES} - set(left_out)
        assert maps_of(*pair)

    def test_parts_follow_their_surroundings(self):
        pair = add_pair()
        island = add_blob("Island", 8, 6)
        island.location, island.scale = (0, 0, 1.6), (0.1, 0.1, 0.1)
        with bpy.context.temp_override(active_object=pair[0], selected_editable_objects=[pair[0], island]):
            bpy.ops.object.join()
        match()
        assert "smaller part" in summary().notes
        assert len(maps_of(*pair).source_to_target) == len(pair[0].data.vertices)
        assert (attributes(pair[0])["HM Distortion Value"] >= 0).all()

    def test_vertices_without_a_face_have_a_place_but_no_distortion(self):
        pair = add_pair()
        pair[1].data.vertices.add(2)
        match()
        assert (attributes(pair[1])["HM Distortion Value"][-2:] == -1).all()
        grey = colors.to_linear(np.full((1, 3), colors.NEUTRAL))
        assert attributes(pair[1])["HM Distortion"].reshape(-1, 4)[-2:, :3] == pytest.approx(np.repeat(grey, 2, axis=0))
        assert len(maps_of(*pair).target_to_source) == len(pair[1].data.vertices)


class TestOff:
    def test_nothing_dense_is_written_or_told(self):
        pair = add_pair()
        match(**QUICK)
        assert set(attributes(pair[0])) == set(SHOWN[:3])
        assert not summary().verdict
        with pytest.raises(ObjectError, match=r"has no dense map\. Match them again with Dense Map on"):
            maps_of(*pair)

    def test_matching_again_without_takes_the_map_away(self, dense_pair):
        flip()
        assert set(OTHER_MAP_ATTRIBUTES) <= set(attributes(dense_pair[0]))
        match(**QUICK)
        assert set(attributes(dense_pair[0])) == set(SHOWN[:3])

    def test_matching_again_gives_a_fresh_map_only(self, dense_pair):
        first = attributes(dense_pair[1])
        flip()
        match()
        again = attributes(dense_pair[1])
        assert again.keys() == first.keys()
        assert all((again[name] == first[name]).all() for name in first)


class TestTransforms:
    @pytest.mark.parametrize("scale", [(1, 1, 1), (0.5, 2, 1.25), (-1, 1, 1), (-0.5, -3, -2)])
    def test_unapplied_scale_makes_no_difference(self, scale):
        # The mesh is distorted the other way, so that it stands in the world as the source does.
        source, target = add_pair()
        target.rotation_euler, target.scale = (0.5, 1, -2), scale
        for vertex in target.data.vertices:
            vertex.co = [c / s for c, s in zip(vertex.co, scale, strict=True)]
        if np.prod(scale) < 0:
            target.data.flip_normals()
        bpy.context.view_layer.update()
        match()
        maps = maps_of(source, target)
        assert (maps.target_to_source.nearest_vertices == np.arange(len(target.data.vertices))).mean() > 0.95
        assert maps.target_to_source.orientation(maps.target, maps.source) > 0.95
        assert summary().orientation > 0.5

    def test_the_world_counts_not_the_mesh(self):
        source, target = add_pair()
        target.scale = (1, 1, 2.5)  # not the same shape any more
        bpy.context.view_layer.update()
        match()
        assert np.median(attributes(target)["HM Distortion Value"]) > 0.1
        source.scale = (1, 1, 2.5)
        bpy.context.view_layer.update()
        match()
        assert np.median(attributes(target)["HM Distortion Value"]) < 0.02

    def test_moving_the_objects_keeps_the_map(self, dense_pair):
        before = maps_of(*dense_pair)
        for obj in dense_pair:
            obj.rotation_euler, obj.location, obj.scale = (0.3, -1, 2), (4, 5, 6), (3, 1, 2)
        bpy.context.view_layer.update()
        after = maps_of(*dense_pair)
        assert (after.source_to_target.nearest_vertices == before.source_to_target.nearest_vertices).all()
        assert after.source_to_target.positions == pytest.approx(
            after.source_to_target.transfer(after.target.vertices), abs=1e-6
        )


def test_ngons():
    pair = add_pair()
    bpy.context.view_layer.objects.active = pair[1]
    pair[1].modifiers.new("Planar", "DECIMATE").decimate_type = "DISSOLVE"
    pair[1].modifiers["Planar"].angle_limit = 0.2
    bpy.ops.object.modifier_apply(modifier="Planar")
    faces = [set(polygon.vertices) for polygon in pair[1].data.polygons]
    assert max(map(len, faces)) > 4
    match()
    corners = maps_of(*pair).source_to_target.corners
    assert all(any(set(row) <= face for face in faces) for row in corners[::7].tolist())


class TestFlip:
    def test_everything_is_that_of_the_other_answer_then(self, dense_pair):
        first = maps_of(*dense_pair)
        before = [attributes(obj) for obj in dense_pair]
        flip()
        maps = maps_of(*dense_pair)
        assert summary().answer == 1
        assert summary().orientation < -0.5
        assert maps.target_to_source.orientation(maps.target, maps.source) < -0.8
        assert first.target_to_source.orientation(first.target, first.source) > 0.8
        own = colors.match_colors(maps.source.vertices, maps.source.vertex_areas)
        shown = attributes(dense_pair[1])["HM Match"].reshape(-1, 4)[:, :3]
        assert shown == pytest.approx(colors.to_linear(maps.target_to_source.transfer(own)), abs=1e-6)
        after = [attributes(obj) for obj in dense_pair]
        assert (after[0]["HM Match"] == before[0]["HM Match"]).all()
        assert (after[1]["HM Match"] != before[1]["HM Match"]).any()
        for name, other in zip(MAP_ATTRIBUTES, OTHER_MAP_ATTRIBUTES, strict=True):
            assert (after[1][other] == before[1][name]).all()

    def test_back_again_takes_no_computing(self, dense_pair, monkeypatch):
        before, told = maps_of(*dense_pair), snapshot()["summary"]
        shown = [{name: attributes(obj)[name] for name in SHOWN} for obj in dense_pair]
        flip()
        flipped = snapshot()

        def forbidden(*_arguments):
            raise AssertionError("computed again")

        monkeypatch.setattr("hiermatch.hiermatch_addon.jobs.flipping.densify_steps", forbidden)
        flip()
        assert same_maps(maps_of(*dense_pair), before)
        assert snapshot()["summary"] == told
        for obj, expected in zip(dense_pair, shown, strict=True):
            assert all((attributes(obj)[name] == values).all() for name, values in expected.items())
        flip()
        assert snapshot() == flipped

    def test_a_map_that_the_user_removed_is_made_again(self, dense_pair):
        data = dense_pair[0].data
        data.attributes.remove(data.attributes["HM Map Weights"])
        with pytest.raises(ObjectError, match=r"dense map of .* was removed"):
            maps_of(*dense_pair)
        flip()
        assert not set(OTHER_MAP_ATTRIBUTES) & set(attributes(dense_pair[0]))
        flip()
        assert maps_of(*dense_pair).source_to_target.orientation(read(dense_pair[0]), read(dense_pair[1])) > 0.8

    def test_bent_since(self, dense_pair):
        source, target = dense_pair
        bpy.ops.hiermatch.clear(object="Source")
        bpy.ops.hiermatch.clear(object="Target")
        target.shape_key_add(name="Basis")
        match(use_modifiers=True)
        key = target.shape_key_add(name="Bent")
        for point in key.data:
            point.co.z += 0.2 * point.co.x * point.co.x
        key.value = 1
        bpy.context.view_layer.update()
        maps = maps_of(source, target)
        assert maps.target.vertices != pytest.approx(read(target).vertices, abs=0.05)
        flip()
        assert maps_of(source, target).source_to_target.orientation(maps.source, maps.target) < -0.8


class TestSwap:
    def test_the_maps_are_exchanged(self, dense_pair):
        source, target = dense_pair
        there, back = maps_of(source, target), maps_of(target, source)
        assert same_maps(there.reverse, back)
        assert (back.source.vertices == there.target.vertices).all()

    def test_the_panel_calls_them_the_other_way_round(self, dense_pair, monkeypatch):
        monkeypatch.setattr("hiermatch.hiermatch_addon.jobs.match_job.match_steps", None)  # nothing is computed
        state, before = bpy.context.scene.hiermatch, snapshot()
        arrays = [attributes(obj) for obj in dense_pair]
        assert bpy.ops.hiermatch.swap() == {"FINISHED"}
        assert (state.source, state.target) == dense_pair[::-1]
        assert (summary().source, summary().target) == ("Target", "Source")
        assert summary().swapped
        for obj, expected in zip(dense_pair, arrays, strict=True):
            assert all((attributes(obj)[name] == values).all() for name, values in expected.items())
        assert same_maps(maps_of(state.source, state.target), maps_of(*dense_pair).reverse)
        assert bpy.ops.hiermatch.swap() == {"FINISHED"}
        assert snapshot() == before

    def test_what_is_said_of_one_of_them_is_said_of_the_same_one(self, dense_pair):
        source = dense_pair[0]
        answers = kept(source, "HM")["answers"].to_dict()
        note, missing = (
            "The {} had 2 small holes: they were closed for matching.",
            "parts of one shape seem to be missing on the other.",
        )
        sentence = f"Only 60% of the target is reached: {missing}"
        answers["direct"]["quality"] |= {"coverage": 0.6, "source_coverage": 1.0, "sentence": sentence}
        change_kept(source, "HM", answers=answers, notes=note.format("target"))
        bpy.ops.hiermatch.swap()
        for said, holed in (
            (f"Only 60% of the target is reached: {missing}", "target"),
            (f"Only 60% of the source has a partner: {missing}", "source"),
        ):
            bpy.ops.hiermatch.swap()
            state = bpy.context.scene.hiermatch
            assert (state.summary.verdict, state.summary.notes) == (said, note.format(holed))
            assert find_maps(state.source, state.target).quality.sentence == said

    def test_what_is_picked_the_other_way_round_is_called_so(self, dense_pair):
        source, target = dense_pair
        assert bpy.ops.hiermatch.transfer_uvs(source="Target", target="Source") == {"FINISHED"}
        state = bpy.context.scene.hiermatch
        assert (state.source, state.target) == (target, source)
        assert (summary().source, summary().target, summary().swapped) == ("Target", "Source", True)
        assert summary().seconds > 0
        state.target, state.source = target, source
        assert (summary().source, summary().target, summary().swapped) == ("Source", "Target", False)

    def test_flipping_and_swapping_do_not_disturb_one_another(self, dense_pair):
        bpy.ops.hiermatch.swap()
        flip()
        assert summary().answer == 1
        assert (summary().source, summary().target) == ("Target", "Source")
        flip(object="Source")
        bpy.ops.hiermatch.swap()
        assert summary().answer == 0
        assert (summary().source, summary().target) == ("Source", "Target")
        assert maps_of(*dense_pair)

    def test_the_order_that_was_picked_by_hand_wins(self, dense_pair):
        state = bpy.context.scene.hiermatch
        state.source, state.target = dense_pair[::-1]
        bpy.ops.hiermatch.swap()  # now as they were matched
        assert (summary().source, summary().target) == ("Source", "Target")

    def test_objects_without_a_match_are_only_exchanged(self):
        state = bpy.context.scene.hiermatch
        pair = state.source, state.target = add_pair()
        bpy.ops.hiermatch.swap()
        assert (state.source, state.target) == pair[::-1]
        state.target = None
        bpy.ops.hiermatch.swap()
        assert (state.source, state.target) == (None, pair[1])

    def test_one_undo_takes_it_back(self, dense_pair):
        assert dense_pair
        before = snapshot()
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.hiermatch.swap("EXEC_DEFAULT", True)  # noqa: FBT003
        swapped = snapshot()
        assert swapped != before
        bpy.ops.ed.undo()
        assert snapshot() == before
        bpy.ops.ed.redo()
        assert snapshot() == swapped


class TestFile:
    def test_clear_removes_all_of_it(self):
        pair = add_symmetric_pair()
        for obj in pair:
            obj.data.attributes.new("Mine", "INT", "POINT")
        before = [mesh_snapshot(obj) for obj in pair]
        match()
        flip()
        for obj in pair:
            bpy.ops.hiermatch.clear(object=obj.name)
        assert [mesh_snapshot(obj) for obj in pair] == before

    def test_save_and_open(self, dense_pair, tmp_path):
        before, maps = snapshot(), maps_of(*dense_pair)
        path = str(tmp_path / "again.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=path)
        assert snapshot() == before
        assert same_maps(maps_of(bpy.data.objects["Source"], bpy.data.objects["Target"]), maps)

    def test_undo_and_redo(self, dense_pair):
        assert dense_pair
        before = snapshot()
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.hiermatch.flip("EXEC_DEFAULT", True)  # noqa: FBT003
        flipped = snapshot()
        bpy.ops.ed.undo()
        assert snapshot() == before
        assert maps_of(bpy.data.objects["Source"], bpy.data.objects["Target"])
        bpy.ops.ed.redo()
        assert snapshot() == flipped

    def test_one_undo_takes_a_match_back(self):
        add_pair()
        before = snapshot()
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.hiermatch.match("EXEC_DEFAULT", True, source="Source", target="Target", **DENSE)  # noqa: FBT003
        after = snapshot()
        bpy.ops.ed.undo()
        assert snapshot() == before
        bpy.ops.ed.redo()
        assert snapshot() == after

    def test_in_another_file(self, dense_pair, dense_file):
        maps = maps_of(*dense_pair)
        bpy.ops.wm.read_homefile(use_empty=True)
        with bpy.data.libraries.load(dense_file) as (_, wanted):
            wanted.objects = ["Source", "Target"]
        for obj in wanted.objects:
            bpy.context.collection.objects.link(obj)
        bpy.context.view_layer.update()
        assert same_maps(maps_of(*wanted.objects), maps)

    def test_linked_from_another_file(self, dense_pair, dense_file):
        maps = maps_of(*dense_pair)
        bpy.ops.wm.read_homefile(use_empty=True)
        with bpy.data.libraries.load(dense_file, link=True) as (_, wanted):
            wanted.objects = ["Source", "Target"]
        for obj in wanted.objects:
            bpy.context.collection.objects.link(obj)
        bpy.context.view_layer.update()
        assert same_maps(maps_of(*wanted.objects), maps)
        state = bpy.context.scene.hiermatch
        state.source, state.target = wanted.objects
        assert bpy.ops.hiermatch.swap() == {"FINISHED"}
