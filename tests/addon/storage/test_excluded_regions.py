# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions that are left out of a match: groups, faces, materials and face sets."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.storage.excluded_regions import excluded_vertices, region_names

from tests.addon.scenes import QUICK, snapshot, weights_of


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
        for material in (bpy.data.materials.new("Skin"), None, bpy.data.materials.new("Eye")):
            source.data.materials.append(material)
        for face in ring:
            source.data.polygons[face].material_index = 2
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
