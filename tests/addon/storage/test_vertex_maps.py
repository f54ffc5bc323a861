# SPDX-License-Identifier: GPL-3.0-or-later
"""Dense maps in the attributes of meshes."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
import pytest
from hiermatch.engine import MeshError, SurfacePoints, TriangleMesh
from hiermatch.hiermatch_addon.scene.attribute_io import add_values
from hiermatch.hiermatch_addon.scene.mesh_io import read_mesh
from hiermatch.hiermatch_addon.storage.contents import Content
from hiermatch.hiermatch_addon.storage.stored_match import CornerPoints
from hiermatch.hiermatch_addon.storage.vertex_maps import StoredMaps, VertexMap, add_maps, map_name, place_points

from tests.addon.scenes import MAP_ATTRIBUTES, add_pair, made_up_maps


@pytest.fixture
def pair():
    return add_pair()


@pytest.fixture
def meshes(pair):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return [read_mesh(obj, depsgraph, use_modifiers=False) for obj in pair]


@pytest.fixture
def maps(meshes):
    return made_up_maps(*meshes)


@pytest.fixture
def kept(maps):
    return StoredMaps.of(*maps)


def write(pair, kept, name="HM Map"):
    for obj, vertex_map in zip(pair, (kept.of_source, kept.of_target), strict=True):
        for attribute, values in vertex_map.attributes(name).items():
            add_values(obj.data, attribute, values)


def same(one, other):
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in vars(one))


def test_attributes_keep_the_map_in_single_precision(pair, meshes, maps, kept):
    write(pair, kept)
    assert set(MAP_ATTRIBUTES) <= set(pair[0].data.attributes.keys())
    back = StoredMaps.read(*pair, "HM Map")
    assert same(back.of_source, kept.of_source)
    assert same(back.of_target, kept.of_target)
    between = back.between(*meshes)
    for found, expected in zip((between.source_to_target, between.target_to_source), maps, strict=True):
        assert (found.triangles == expected.triangles).all()
        assert (found.corners == expected.corners).all()
        assert found.positions == pytest.approx(expected.positions, abs=1e-5)
        assert found.barycentric.sum(axis=1) == pytest.approx(1, abs=1e-12)
        assert found.confidence == pytest.approx(expected.confidence, abs=1e-6)


def test_what_has_no_partner_is_kept_and_of_older_matches_all_have_one(pair, meshes, maps):
    alone = np.arange(meshes[0].vertex_count) % 3 == 0
    kept = StoredMaps.of(replace(maps[0], has_partner=~alone), maps[1])
    write(pair, kept)
    assert "HM Map Partner" not in pair[1].data.attributes
    back = StoredMaps.read(*pair, "HM Map")
    assert same(back.of_source, kept.of_source)
    assert (back.between(*meshes).source_to_target.has_partner == ~alone).all()
    assert back.of_target.has_partner.all()


def test_the_way_back_is_the_other_map(meshes, kept):
    between = kept.between(*meshes)
    assert between.reverse.source is meshes[1]
    assert between.reverse.source_to_target is between.target_to_source
    assert between.reverse.reverse.target_to_source is between.target_to_source


@pytest.mark.parametrize("name", MAP_ATTRIBUTES)
def test_an_incomplete_map_is_none(pair, kept, name):
    write(pair, kept)
    data = pair[1].data
    data.attributes.remove(data.attributes[name])
    assert StoredMaps.read(*pair, "HM Map") is None
    assert VertexMap.read(pair[0], "HM Map") is not None
    data.attributes.new(name, "BOOLEAN", "FACE")  # something else of that name
    assert StoredMaps.read(*pair, "HM Map") is None


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("corners", -1),
        ("corners", 10**6),
        ("weights", np.nan),
        ("weights", -0.5),
        ("weights", 0),
        ("weights", np.inf),
        ("confidence", np.nan),
        ("confidence", 1.5),
    ],
)
def test_numbers_of_somebody_else_are_an_error(meshes, kept, field, value):
    getattr(kept.of_target, field)[3] = value
    with pytest.raises(MeshError, match="numbers that no match has written"):
        kept.between(*meshes)


def test_other_meshes_are_an_error(meshes, kept):
    fewer, _, _ = meshes[0].submesh(np.arange(meshes[0].vertex_count) > 4)
    with pytest.raises(MeshError, match="other vertices"):
        kept.between(fewer, meshes[1])


def test_the_answer_that_is_not_shown_has_names_of_its_own(kept):
    prepared = (Content(), Content())
    add_maps(prepared, "HM", (kept, kept, None, kept))
    assert map_name("HM") == "HM Map"
    names = ["Map", "Other Map", "Other Map 3"]
    assert [*prepared[0].values] == [name.replace("Map", kind) for kind in names for name in MAP_ATTRIBUTES]
    alone = (Content(), Content())
    add_maps(alone, "HM", (kept, None))
    assert [*alone[1].values] == MAP_ATTRIBUTES


class TestPlacePoints:
    def test_as_they_are(self, meshes):
        points = SurfacePoints.from_barycentric(meshes[0], np.array([3, 1, 4]), np.eye(3) * 0.7 + 0.1)
        placed = place_points(meshes[0], CornerPoints.of(points))
        assert same(placed, points)

    def test_a_face_that_is_cut_otherwise_now(self):
        corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0.0]])
        mesh = TriangleMesh(corners, [(0, 1, 2), (0, 2, 3), (1, 4, 2)])
        weights = np.array([[0.25, 0.25, 0.5], [0.2, 0.3, 0.5]])
        placed = place_points(mesh, CornerPoints(np.array([[0, 1, 3], [1, 4, 2]]), weights))
        assert placed.positions == pytest.approx(np.array([[0.25, 0.5, 0], [1.3, 0.5, 0]]))
        assert placed.triangles.tolist() == [1, 2]
