# SPDX-License-Identifier: GPL-3.0-or-later
"""A match shown in colours."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.attribute_io import add_values
from hiermatch.hiermatch_addon.storage.views.view_colors import check_size, checked, region_colors
from hiermatch.hiermatch_addon.storage.views.views import VIEW_ITEMS, attribute_of

from tests.addon.scenes import QUICK, add_pair, edit_twin, mesh_snapshot, snapshot, values_of, weights_of
from tests.addon.test_rules import BLENDER, imported
from tools.source_extension import ROOT

VIEWS = [view for view, *_ in VIEW_ITEMS if view != "NONE"]


def show(view):
    assert bpy.ops.hiermatch.show(view=view) == {"FINISHED"}


def active(pair):
    return [obj.data.attributes.active_color_name for obj in pair]


class TestColors:
    def test_they_know_no_blender(self):
        assert not BLENDER & set(imported(ROOT / "hiermatch_addon" / "storage" / "views" / "view_colors.py"))

    def test_regions_differ(self):
        found = region_colors(np.array([0, 1, 2, 3, 511, -1]))
        assert found.min() >= 0
        assert found.max() <= 1
        assert found[-1].tolist() == [0.5, 0.5, 0.5]
        apart = np.linalg.norm(found[:4, None] - found[None, :4], axis=2)
        assert apart[~np.eye(4, dtype=bool)].min() > 0.2
        assert len(np.unique(region_colors(np.arange(512)).round(4), axis=0)) == 512

    def test_no_region_at_all(self):
        assert region_colors(np.full(3, -1)).tolist() == [[0.5] * 3] * 3

    def test_checks_alternate(self):
        line = np.column_stack([np.arange(8.0) + 0.13, np.full(8, 0.13), np.full(8, 0.13)])
        found = checked(np.ones((8, 3)), line, 1.0)[:, 0]
        assert (found[::2] < 0.5).all() or (found[1::2] < 0.5).all()
        assert np.unique(found.round(6)).size == 2

    def test_checks_scale_with_the_shape(self):
        places = np.random.default_rng(1).normal(size=(50, 3))
        one = checked(np.ones((50, 3)), places, check_size(places, 0.01))
        other = checked(np.ones((50, 3)), 1000 * places, check_size(1000 * places, 10))
        assert other == pytest.approx(one)
        assert check_size(places, 1.0) == pytest.approx(3)


class TestViews:
    @pytest.mark.parametrize("view", VIEWS)
    def test_there_and_back(self, dense_pair, view):
        for obj in dense_pair:
            obj.data.attributes.new("Own", "FLOAT_COLOR", "POINT")
            obj.data.attributes.active_color_name = "Own"
        show(view)
        assert active(dense_pair) == [attribute_of("HM", view)] * 2
        show("NONE")
        assert active(dense_pair) == ["Own"] * 2

    def test_one_after_the_other(self, dense_pair):
        before = active(dense_pair)
        for view in VIEWS:
            show(view)
        show("NONE")
        assert active(dense_pair) == before

    def test_back_after_another_pair_was_picked(self, dense_pair):
        others = [obj.copy() for obj in dense_pair]
        for obj, other in zip(dense_pair, others, strict=True):
            other.data = obj.data.copy()
            bpy.context.collection.objects.link(other)
            for one, name in ((obj, "Own"), (other, "Other")):
                for each in ("Own", "Other"):
                    one.data.attributes.new(each, "FLOAT_COLOR", "POINT")
                one.data.attributes.active_color_name = name
        show("CHECKER")
        state = bpy.context.scene.hiermatch
        state.source, state.target = others
        dense_pair[0].name = "Renamed"
        show("NONE")
        assert active(dense_pair) == ["Own"] * 2
        assert active(others) == ["Other"] * 2

    @pytest.mark.usefixtures("dense_pair")
    def test_each_viewport_goes_back_to_what_it_was(self):
        areas = bpy.context.screen.areas[:2]
        for area in areas:
            area.type = "VIEW_3D"
        spaces = [area.spaces.active for area in areas]
        for space, (kind, color) in zip(spaces, (("MATERIAL", "OBJECT"), ("WIREFRAME", "RANDOM")), strict=True):
            space.shading.type = "SOLID"
            space.shading.color_type = color
            space.shading.type = kind
        with bpy.context.temp_override(area=areas[0], space_data=spaces[0]):
            show("MATCH")
        assert (spaces[0].shading.type, spaces[0].shading.color_type) == ("SOLID", "VERTEX")
        with bpy.context.temp_override(area=areas[1], space_data=spaces[1]):
            show("NONE")
        assert [space.shading.type for space in spaces] == ["MATERIAL", "WIREFRAME"]
        for space in spaces:
            space.shading.type = "SOLID"
        assert [space.shading.color_type for space in spaces] == ["OBJECT", "RANDOM"]

    def test_undo_brings_the_viewport_back_too(self, dense_pair):
        area = bpy.context.screen.areas[0]
        area.type = "VIEW_3D"
        shading = area.spaces.active.shading
        shading.type, shading.color_type = "SOLID", "OBJECT"
        before = active(dense_pair)
        bpy.ops.ed.undo_push(message="Before")
        with bpy.context.temp_override(area=area, space_data=area.spaces.active):
            for view in ("MATCH", "CHECKER"):
                show(view)
                bpy.ops.ed.undo_push(message=view)
            shading = area.spaces.active.shading
            bpy.ops.ed.undo()
            assert (shading.type, shading.color_type) == ("SOLID", "VERTEX")
            bpy.ops.ed.undo()
            assert (shading.type, shading.color_type) == ("SOLID", "OBJECT")
            assert active([bpy.data.objects[name] for name in ("Source", "Target")]) == before
            assert bpy.ops.hiermatch.show(view="NONE") == {"CANCELLED"}  # so that there is still something to redo
            bpy.ops.ed.redo()
            assert bpy.context.scene.hiermatch_steering.before

    def test_nothing_brings_back_a_viewport_whose_meshes_were_taken_back_already(self, dense_pair):
        area = bpy.context.screen.areas[0]
        area.type = "VIEW_3D"
        shading = area.spaces.active.shading
        shading.type = "MATERIAL"
        with bpy.context.temp_override(area=area, space_data=area.spaces.active):
            show("MATCH")
            bpy.context.scene.hiermatch_steering.before = ""  # as in a file in which the scene is another one
            show("NONE")
        assert shading.type == "MATERIAL"
        assert dense_pair

    def test_the_viewport(self, dense_pair):
        assert dense_pair
        area = next((area for area in bpy.context.screen.areas if area.type == "VIEW_3D"), None)
        if area is None:
            pytest.skip("this Blender has no viewport without a window")
        shading = area.spaces.active.shading
        shading.type, shading.color_type = "WIREFRAME", "OBJECT"
        with bpy.context.temp_override(area=area, space_data=area.spaces.active):
            show("MATCH")
            assert (shading.type, shading.color_type) == ("SOLID", "VERTEX")
            show("REGIONS")
            show("NONE")
        assert shading.type == "WIREFRAME"

    def test_regions_go_where_the_map_takes_them(self, dense_pair):
        show("REGIONS")
        source, target = (values_of(obj.data.attributes["HM Regions"]).reshape(-1, 4) for obj in dense_pair)
        colors = {tuple(color) for color in source.tolist()}
        assert len(colors) == 24
        assert {tuple(color) for color in target.tolist()} <= colors

    def test_the_overlap_is_blue_where_there_is_a_partner(self, dense_pair):
        data = dense_pair[0].data
        alone = np.arange(len(data.vertices)) < 40
        add_values(data, "HM Map Partner", (~alone).astype(np.int32))
        show("OVERLAP")
        source, target = (values_of(obj.data.attributes["HM Overlap Colors"]).reshape(-1, 4) for obj in dense_pair)
        assert (source[alone, 0] == source[alone, 2]).all()
        assert (source[~alone, 2] > 2 * source[~alone, 0]).all()
        assert (target[:, 2] > 2 * target[:, 0]).all()

    def test_checks_are_light_and_dark_on_both(self, dense_pair):
        show("CHECKER")
        for obj in dense_pair:
            brightest = values_of(obj.data.attributes["HM Checker"]).reshape(-1, 4)[:, :3].max(axis=1)
            assert (brightest > 0.5).any()
            assert (brightest < 0.2).any()

    def test_what_was_made_goes_with_the_match(self, dense_pair):
        show("REGIONS")
        show("CHECKER")
        bpy.ops.hiermatch.write_regions()
        bpy.ops.hiermatch.clear()
        for obj in dense_pair:
            assert not [name for name in obj.data.attributes.keys() if name.startswith("HM")]  # noqa: SIM118
            assert not len(obj.vertex_groups)

    def test_showing_twice_writes_once(self, dense_pair):
        show("REGIONS")
        before = [mesh_snapshot(obj) for obj in dense_pair]
        show("REGIONS")
        after = [mesh_snapshot(obj) for obj in dense_pair]
        assert [sorted(one["attributes"]) for one in after] == [sorted(one["attributes"]) for one in before]

    def test_without_a_dense_map(self, sparse_pair):
        show("REGIONS")
        for obj in sparse_pair:
            regions = values_of(obj.data.attributes["HM Regions"]).reshape(-1, 4)
            assert len(np.unique(regions, axis=0)) == QUICK["points"]
        before = snapshot()
        for view, message in (("CHECKER", "no dense map"), ("CONFIDENCE", 'carries no colors called "HM Confidence"')):
            with pytest.raises(RuntimeError, match=message):
                bpy.ops.hiermatch.show(view=view)
        assert snapshot() == before

    def test_without_a_match(self):
        bpy.context.scene.hiermatch.source, bpy.context.scene.hiermatch.target = add_pair()
        with pytest.raises(RuntimeError, match="no match to show"):
            bpy.ops.hiermatch.show(view="MATCH")
        with pytest.raises(RuntimeError, match="no match to show"):
            bpy.ops.hiermatch.write_regions()
        assert bpy.ops.hiermatch.show(view="NONE") == {"CANCELLED"}

    def test_of_a_mesh_that_was_edited(self, dense_pair):
        dense_pair[1].data.vertices[3].co.x += 1
        with pytest.raises(RuntimeError, match="out of date"):
            bpy.ops.hiermatch.show(view="CHECKER")
        with pytest.raises(RuntimeError, match="out of date"):
            bpy.ops.hiermatch.write_regions()

    def test_of_a_mesh_that_is_edited_through_another_object(self, dense_pair):
        edit_twin(dense_pair[0])
        bpy.context.view_layer.objects.active = dense_pair[1]
        for operator in (partial(bpy.ops.hiermatch.show, view="CHECKER"), bpy.ops.hiermatch.write_regions):
            with pytest.raises(RuntimeError, match='"Source" shares its mesh with an object in Edit Mode'):
                operator()

    def test_a_group_in_the_way(self, sparse_pair):
        sparse_pair[1].vertex_groups.new(name="HM Region.003")
        before = snapshot()
        with pytest.raises(RuntimeError, match=r'already has a vertex group called "HM Region\.003"'):
            bpy.ops.hiermatch.write_regions()
        assert snapshot() == before


def test_regions_as_groups(dense_pair):
    bpy.ops.hiermatch.write_regions()
    for obj in dense_pair:
        groups = {name: found for name, found in weights_of(obj).items() if name.startswith("HM Region.")}
        assert len(groups) == 24
        members = [vertex for found in groups.values() for vertex in found]
        assert sorted(members) == list(range(len(obj.data.vertices)))
        assert {weight for found in groups.values() for weight in found.values()} == {1.0}


def test_buttons_are_described_by_what_they_show():
    operator = bpy.types.HIERMATCH_OT_show
    for view, _, text in VIEW_ITEMS:
        assert operator.description(bpy.context, SimpleNamespace(view=view)) == text
