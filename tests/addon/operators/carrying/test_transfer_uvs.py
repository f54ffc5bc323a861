# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.transfer_uvs`."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.attribute_io import read_attribute, read_polygons, read_seams
from hiermatch.hiermatch_addon.transfers import uvs

from tests.addon.scenes import mesh_snapshot


@pytest.fixture
def pair(dense_pair):
    """A matched pair; the UVs of the source are its own, those of the target nothing."""
    source, target = dense_pair
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    for layer in list(target.data.uv_layers):
        target.data.uv_layers.remove(layer)
    return source, target


def carry(**options):
    return bpy.ops.hiermatch.transfer_uvs(**({"source": "Source", "target": "Target", "refine": False} | options))


def names(obj):
    return [layer.name for layer in obj.data.uv_layers]


def extents(obj, name):
    """Longest extent of each face in UV space."""
    faces, uvs = read_polygons(obj.data), read_attribute(obj.data, name)
    low, high = (part.reduceat(uvs, faces.starts[:-1], axis=0) for part in (np.minimum, np.maximum))
    return (high - low).max(axis=1)


def test_the_layer_arrives_without_smeared_faces(pair):
    source, target = pair
    assert carry() == {"FINISHED"}
    assert names(target) == ["UVMap"]
    # The meshes have 24 x 16 and 28 x 18 faces; a smeared one would have the width of the layer.  At the poles, where
    # all 24 columns meet, a face reaches over some of them if its corner is next to the pole.
    sizes = extents(target, "UVMap") / extents(source, "UVMap").max()
    at_pole = np.array([len(polygon.vertices) == 3 for polygon in target.data.polygons])
    assert sizes[~at_pole].max() < 1.5
    assert sizes[at_pole].max() < 4
    found = read_attribute(target.data, "UVMap")
    assert np.ptp(found, axis=0).min() > 0.9
    seams = read_seams(target.data)
    assert 10 < seams.sum() < 80


def test_seams_are_left_alone_if_not_wanted(pair):
    target = pair[1]
    target.data.edges[7].use_seam = True
    carry(uv_seams=False)
    assert np.flatnonzero(read_seams(target.data)).tolist() == [7]


def test_what_is_active_comes_along(pair):
    source, target = pair
    second = source.data.uv_layers.new(name="Second")
    third = source.data.uv_layers.new(name="Third")
    source.data.uv_layers.active = second
    third.active_render = True
    carry()
    assert names(target) == ["UVMap", "Second", "Third"]
    assert target.data.uv_layers.active.name == "Second"
    assert [layer.name for layer in target.data.uv_layers if layer.active_render] == ["Third"]


def test_a_vertex_group_that_is_carried_as_well_takes_the_name(pair):
    source, target = pair
    source.vertex_groups.new(name="Mask").add([0, 1, 2], 1.0, "REPLACE")
    source.data.uv_layers.new(name="Mask")
    source.data.attributes.new("Fur", "FLOAT", "FACE")
    source.vertex_groups.new(name="Wool").name = "Fur"
    bpy.ops.hiermatch.retarget(source="Source", target="Target", refine=False, use_attributes=True)
    assert {"Mask", "Fur"} <= set(target.vertex_groups.keys())
    assert names(target) == ["UVMap"]
    assert "Fur" not in target.data.attributes
    notes = bpy.context.scene.hiermatch_retarget.report.notes
    assert 'called "Mask", so that UV map' in notes
    assert 'called "Fur", so that attribute' in notes


def test_layers_with_the_same_trouble_are_told_of_in_one_sentence(pair, monkeypatch):
    def steps(*arguments):
        return replace((yield from real(*arguments)), island_count=5, lost=2, untrusted=1)

    real = uvs.carry_uvs_steps
    monkeypatch.setattr(uvs, "carry_uvs_steps", steps)
    for name in ("Second", "Third", "Fourth"):
        pair[0].data.uv_layers.new(name=name)
    carry()
    lost, doubtful = bpy.context.scene.hiermatch_retarget.report.notes.splitlines()
    assert lost.startswith('8 of 20 islands of "UVMap", "Second", "Third" and 1 more lie where "Target" has no faces')
    assert doubtful.startswith('4 of 20 islands of "UVMap", "Second", "Third" and 1 more lie where the match has no')


def test_some_layers_only(pair):
    source, target = pair
    source.data.uv_layers.active = source.data.uv_layers.new(name="Second")
    source.data.uv_layers.new(name="Third")
    carry(uv_layers="ACTIVE")
    assert names(target) == ["Second"]
    carry(uv_layers="NAMED", uv_names="Third , UVMap")
    assert set(names(target)) == {"Second", "UVMap", "Third"}


def test_a_layer_of_the_same_name_is_replaced(pair):
    target = pair[1]
    target.data.uv_layers.new(name="Mine")
    target.data.uv_layers.new(name="UVMap")
    before = read_attribute(target.data, "UVMap")
    mine = read_attribute(target.data, "Mine")
    carry()
    assert names(target) == ["Mine", "UVMap"]
    assert abs(read_attribute(target.data, "UVMap") - before).max() > 0.01
    np.testing.assert_array_equal(read_attribute(target.data, "Mine"), mine)


def test_a_layer_without_finite_numbers_is_left_out_alone(pair):
    source, target = pair
    broken = names(source)[0]
    source.data.uv_layers.new(name="Whole")
    source.data.uv_layers[broken].data[3].uv.x = float("nan")
    assert carry() == {"FINISHED"}
    assert names(target) == [name for name in names(source) if name != broken]
    assert f'"{broken}" of "Source" was left out' in bpy.context.scene.hiermatch_retarget.report.notes


def test_a_name_that_is_something_else_is_left_out(pair):
    target = pair[1]
    target.data.attributes.new("UVMap", "INT", "POINT")
    assert carry() == {"FINISHED"}
    assert names(target) == []
    assert target.data.attributes["UVMap"].data_type == "INT"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"uv_layers": "NAMED"}, "No UV map is named"),
        ({"uv_layers": "NAMED", "uv_names": "Other"}, 'no UV map "Other"'),
    ],
)
def test_names_that_lead_nowhere(pair, options, message):
    before = mesh_snapshot(pair[1])
    with pytest.raises(RuntimeError, match=message):
        carry(**options)
    assert mesh_snapshot(pair[1]) == before


def test_a_source_without_uvs(pair):
    source, target = pair
    source.data.uv_layers.remove(source.data.uv_layers[0])
    before = mesh_snapshot(target)
    with pytest.raises(RuntimeError, match="has no UV map"):
        carry()
    assert mesh_snapshot(target) == before


def test_too_many_layers(pair):
    for number in range(8):
        pair[1].data.uv_layers.new(name=f"Layer {number}")
    with pytest.raises(RuntimeError, match="would have 9 UV maps"):
        carry()


def test_uvs_that_are_no_numbers_change_nothing(pair):
    source, target = pair
    source.data.uv_layers[0].uv[3].vector = (float("nan"), 0)
    before = mesh_snapshot(target)
    with pytest.raises(RuntimeError, match="not finite"):
        carry()
    assert mesh_snapshot(target) == before
