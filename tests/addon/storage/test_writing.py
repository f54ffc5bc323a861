# SPDX-License-Identifier: GPL-3.0-or-later
"""What a match writes, what it leaves alone, and how it is taken away."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from hiermatch.engine import run
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene import attribute_io, mesh_io
from hiermatch.hiermatch_addon.storage import writing
from hiermatch.hiermatch_addon.storage.contents import UNREACHED, Content, contents_steps
from hiermatch.hiermatch_addon.storage.vertex_maps import MapPair
from hiermatch.hiermatch_addon.storage.views import colors
from hiermatch.hiermatch_addon.storage.written_names import written_names

from tests.addon.scenes import add_pair, made_up_maps, made_up_result, mesh_snapshot, values_of, weights_of


@pytest.fixture
def pair():
    return add_pair()


@pytest.fixture
def result(pair):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return made_up_result(*(mesh_io.read_mesh(obj, depsgraph, use_modifiers=False) for obj in pair))


def write(pair, result, prefix="HM", *, vertex_groups=True, match_colors=True, distortion=True):
    kinds = {"vertex_groups": vertex_groups, "match_colors": match_colors, "distortion": distortion}
    prepared = run(contents_steps(result, prefix, SimpleNamespace(**kinds, confidence=True)))
    plan = list(zip(pair, prepared, strict=True))
    for obj, content in plan:
        writing.check_names(obj, content, prefix)
    writing.write(plan, prefix)


def decorate(obj):
    """Give an object things of the user's own, with something active in every list."""
    for name in ("Arm", "Leg", "Tail"):
        obj.vertex_groups.new(name=name).add([1, 2, 3], 0.5, "REPLACE")
    obj.vertex_groups["Leg"].lock_weight = True
    obj.vertex_groups.active_index = 1
    for name in ("Paint", "Dirt"):
        obj.data.color_attributes.new(name, "BYTE_COLOR", "CORNER")
    obj.data.attributes.new("Heat", "FLOAT", "FACE")
    obj.data.attributes.active_color_name = "Dirt"
    obj.data.attributes.default_color_name = "Paint"
    obj.data.attributes.active = obj.data.attributes["Heat"]
    obj.data["note"] = "mine"


def user_part(snapshot):
    """The part of a snapshot that is not HierMatch's."""
    ours = ("HM", "hiermatch")
    return snapshot | {
        "groups": [group for group in snapshot["groups"] if not group[0].startswith(ours)],
        "weights": {name: weights for name, weights in snapshot["weights"].items() if not name.startswith(ours)},
        "attributes": [entry for entry in snapshot["attributes"] if not entry[0].startswith(ours)],
        "properties": {name: value for name, value in snapshot["properties"].items() if name not in ours},
        "active_color": None,
    }


def test_groups_hold_the_barycentric_coordinates(pair, result):
    write(pair, result)
    for obj, points in zip(pair, (result.source_points, result.target_points), strict=True):
        written = weights_of(obj)
        assert list(written) == ["HM.001", "HM.002", "HM.003", "HM.004", "HM.005"]
        for name, corners, weights in zip(written, points.corners, points.barycentric, strict=True):
            expected = {int(c): w for c, w in zip(corners, weights, strict=True) if w > 0}
            assert written[name] == pytest.approx(expected)
            assert sum(written[name].values()) == pytest.approx(1)
    assert len(weights_of(pair[0])["HM.001"]) == 1  # a point at a vertex


def test_positions_come_back_from_the_groups(pair, result):
    write(pair, result)
    for obj, points in zip(pair, (result.source_points, result.target_points), strict=True):
        for weights, position in zip(weights_of(obj).values(), points.positions, strict=True):
            place = sum(w * np.array(obj.matrix_world @ obj.data.vertices[v].co) for v, w in weights.items())
            assert place == pytest.approx(position, abs=1e-5)


def test_names_stay_in_order_beyond_a_thousand(result):
    points = result.source_points
    many = type(points)(*(np.resize(a, (1001, *a.shape[1:])) for a in vars(points).values()))
    result = replace(result, source_points=many, target_points=many, point_distortion=np.zeros(1001))
    kinds = SimpleNamespace(vertex_groups=True, match_colors=False, distortion=False, confidence=False)
    content, _ = run(contents_steps(result, "HM", kinds))
    assert [*content.groups][998:] == ["HM.999", "HM.1000", "HM.1001"]


@pytest.mark.parametrize("some_alone", [True, False])
def test_a_group_holds_what_has_a_partner_if_not_all_has(pair, result, some_alone):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    meshes = [mesh_io.read_mesh(obj, depsgraph, use_modifiers=False) for obj in pair]
    there, back = made_up_maps(*meshes)
    alone = (np.arange(len(there)) < 5) & some_alone
    maps = MapPair(*meshes, replace(there, has_partner=~alone), back)
    kinds = SimpleNamespace(vertex_groups=True, match_colors=False, distortion=False, confidence=False)
    source, target = run(contents_steps(result, "HM", kinds, maps))
    assert ("HM Overlap" in source.groups) == ("HM Overlap" in target.groups) == some_alone
    if some_alone:
        vertices, weights = source.groups["HM Overlap"]
        np.testing.assert_array_equal(vertices, np.arange(5, len(there)))
        assert (weights == 1).all()
        assert len(target.groups["HM Overlap"][0]) == len(back)


def test_colours_and_values(pair, result):
    write(pair, result)
    for obj in pair:
        attributes = obj.data.attributes
        kinds = {
            attribute.name: (attribute.data_type, attribute.domain)
            for attribute in attributes
            if "HM" in attribute.name
        }
        assert kinds == {
            "HM Match": ("FLOAT_COLOR", "POINT"),
            "HM Distortion": ("FLOAT_COLOR", "POINT"),
            "HM Distortion Value": ("FLOAT", "POINT"),
        }
        assert obj.data.attributes.active_color_name == "HM Match"
        rgba = values_of(attributes["HM Match"]).reshape(-1, 4)
        assert rgba.min() >= 0
        assert rgba.max() <= 1
        assert (rgba[:, 3] == 1).all()
        raw = values_of(attributes["HM Distortion Value"])
        assert raw.min() >= result.point_distortion.min() - 1e-7
        assert raw.max() <= result.point_distortion.max() + 1e-7
        shown = values_of(attributes["HM Distortion"]).reshape(-1, 4)[:, :3]
        expected = colors.to_linear(colors.distortion_colors(raw.astype(float), result.point_distortion.max()))
        assert shown == pytest.approx(expected, abs=1e-4)


def test_a_scaled_copy_gets_the_same_colours(pair, result):
    same = replace(result, target_points=result.source_points, target_distances=1000 * result.source_distances)
    write(pair, same)
    for name in ("HM Match", "HM Distortion", "HM Distortion Value"):
        one, other = (values_of(obj.data.attributes[name]) for obj in pair)
        assert one == pytest.approx(other, abs=1e-5)


def test_unreachable_vertices_are_grey(pair, result):
    cut = result.source_distances.copy()
    cut[:, :7] = np.inf
    cut[:, result.source_points.nearest_vertices] = result.source_distances[:, result.source_points.nearest_vertices]
    write(pair, replace(result, source_distances=cut))
    lost = np.flatnonzero(np.isinf(cut).all(axis=0))
    assert len(lost)
    attributes = pair[0].data.attributes
    grey = colors.to_linear(np.full(3, colors.NEUTRAL))[0]
    for name in ("HM Match", "HM Distortion"):
        assert values_of(attributes[name]).reshape(-1, 4)[lost, :3] == pytest.approx(grey)
    assert (values_of(attributes["HM Distortion Value"])[lost] == UNREACHED).all()


@pytest.mark.parametrize("kind", ["vertex_groups", "match_colors", "distortion"])
def test_each_kind_can_be_left_out(pair, result, kind):
    write(pair, result, **{kind: False})
    names = [*weights_of(pair[0]), *pair[0].data.attributes.keys()]
    found = {
        "vertex_groups": "HM.001" in names,
        "match_colors": "HM Match" in names,
        "distortion": "HM Distortion" in names or "HM Distortion Value" in names,
    }
    assert found == {name: name != kind for name in found}


def test_only_the_distortion_is_shown_then(pair, result):
    write(pair, result, match_colors=False)
    assert pair[0].data.attributes.active_color_name == "HM Distortion"


def test_what_is_the_users_stays_as_it_is(pair, result):
    for obj in pair:
        decorate(obj)
    before = [user_part(mesh_snapshot(obj)) for obj in pair]
    write(pair, result)
    assert [user_part(mesh_snapshot(obj)) for obj in pair] == before
    assert all(obj.data.attributes.active_color_name == "HM Match" for obj in pair)


@pytest.mark.parametrize("decorated", [True, False])
def test_clear_restores_everything(pair, result, decorated):
    if decorated:
        for obj in pair:
            decorate(obj)
    before = [mesh_snapshot(obj) for obj in pair]
    write(pair, result)
    assert [mesh_snapshot(obj) for obj in pair] != before
    assert [writing.clear(obj, "HM") for obj in pair] == [True, True]
    assert [mesh_snapshot(obj) for obj in pair] == before
    assert not writing.clear(pair[0], "HM")


def test_clear_restores_everything_after_several_runs(pair, result):
    for obj in pair:
        decorate(obj)
    before = [mesh_snapshot(obj) for obj in pair]
    write(pair, result)
    write(pair, result, distortion=False)
    write(pair, result)
    for obj in pair:
        writing.clear(obj, "HM")
    assert [mesh_snapshot(obj) for obj in pair] == before


def test_clear_keeps_the_colour_that_the_user_chose_since(pair, result):
    decorate(pair[0])
    write(pair, result)
    pair[0].data.attributes.active_color_name = "Paint"
    writing.clear(pair[0], "HM")
    assert pair[0].data.attributes.active_color_name == "Paint"


def test_clear_when_the_former_colour_is_gone(pair, result):
    decorate(pair[0])
    write(pair, result)
    pair[0].data.attributes.remove(pair[0].data.attributes["Dirt"])
    writing.clear(pair[0], "HM")
    assert pair[0].data.attributes.active_color_name == "Paint"


def test_running_again_is_the_same_as_running_once(pair, result):
    for obj in pair:
        decorate(obj)
    write(pair, result)
    once = [mesh_snapshot(obj) for obj in pair]
    write(pair, result)
    assert [mesh_snapshot(obj) for obj in pair] == once


def test_running_again_with_fewer_points_leaves_no_stale_ones(pair, result):
    write(pair, result)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    meshes = [mesh_io.read_mesh(obj, depsgraph, use_modifiers=False) for obj in pair]
    fewer = made_up_result(*meshes, points=3, seed=9)
    write(pair, fewer, match_colors=False)
    for obj, points in zip(pair, (fewer.source_points, fewer.target_points), strict=True):
        assert list(weights_of(obj)) == ["HM.001", "HM.002", "HM.003"]
        assert set(weights_of(obj)["HM.002"]) == set(points.corners[1].tolist())
        assert "HM Match" not in obj.data.attributes  # it would show another match than the groups


def test_another_prefix_keeps_the_other_match(pair, result):
    before = [mesh_snapshot(obj) for obj in pair]
    write(pair, result)
    first = [mesh_snapshot(obj) for obj in pair]
    write(pair, result, "Second")
    assert {"HM.001", "Second.001"} <= set(weights_of(pair[0]))
    assert writing.prefixes(pair[0]) == ("HM", "Second")
    for obj in pair:
        writing.clear(obj, "Second")
    assert [mesh_snapshot(obj) for obj in pair] == first
    for obj in pair:
        writing.clear(obj, "HM")
    assert [mesh_snapshot(obj) for obj in pair] == before


@pytest.mark.parametrize("name", ["HM.002", "HM Match", "HM Distortion Value", "HM.003 ~"])
@pytest.mark.parametrize("kind", ["group", "attribute"])
def test_names_of_the_user_are_not_taken(pair, result, name, kind):
    if kind == "group":
        pair[1].vertex_groups.new(name=name).add([0], 1.0, "REPLACE")
    else:
        pair[1].data.attributes.new(name, "INT", "FACE")
    before = [mesh_snapshot(obj) for obj in pair]
    with pytest.raises(ObjectError, match=f'"Target" already has .*"{name}"'):
        write(pair, result)
    assert [mesh_snapshot(obj) for obj in pair] == before


def test_names_of_a_match_with_another_prefix_are_not_taken(pair, result):
    write(pair, result)
    before = [mesh_snapshot(obj) for obj in pair]
    for content in (
        Content(values={"HM Distortion Value": np.zeros(3)}),
        Content(groups={"HM.003": (np.empty(0),) * 2}),
    ):
        with pytest.raises(ObjectError, match=r'belongs to the match with the Prefix "HM"\. Choose another Prefix'):
            writing.check_names(pair[1], content, "HM Distortion")
        writing.check_names(pair[1], content, "HM")
    assert [mesh_snapshot(obj) for obj in pair] == before


@pytest.mark.parametrize("own", [1, "mine", {"HM": 1}, {"HM": {"else": 1}}])
def test_a_property_of_the_users_is_none_of_ours(pair, result, own):
    pair[1].data["hiermatch"] = own
    before = [mesh_snapshot(obj) for obj in pair]
    assert not writing.is_marked(pair[1].data)
    assert writing.prefixes(pair[1]) == ()
    assert writing.kept(pair[1], "HM") == {}
    assert not writing.clear(pair[1], "HM")
    assert "HM" not in written_names(pair[1])
    with pytest.raises(ObjectError, match='a custom property called "hiermatch" that HierMatch did not write'):
        write(pair, result)
    assert [mesh_snapshot(obj) for obj in pair] == before


def test_what_the_user_renamed_is_the_users(pair, result):
    write(pair, result)
    pair[0].vertex_groups["HM.002"].name = "Nose"
    writing.clear(pair[0], "HM")
    assert list(weights_of(pair[0])) == ["Nose"]


@pytest.mark.parametrize(
    "step",
    [(mesh_io, "add_vertex_group"), (mesh_io, "add_colors"), (attribute_io, "add_values")],
    ids=lambda one: one[1],
)
@pytest.mark.parametrize("earlier", [False, True])
def test_a_failure_half_way_changes_nothing(pair, result, monkeypatch, step, earlier):
    for obj in pair:
        decorate(obj)
    if earlier:
        write(pair, made_up_result(*(result_mesh(obj) for obj in pair), points=7, seed=3))
    before = [mesh_snapshot(obj) for obj in pair]
    real = getattr(*step)

    def failing(owner, name, *arrays):
        real(owner, name, *arrays)
        if owner.name == "Target":
            raise MemoryError(name)

    monkeypatch.setattr(*step, failing)
    with pytest.raises(MemoryError):
        write(pair, result)
    assert [mesh_snapshot(obj) for obj in pair] == before


@pytest.mark.parametrize("kept", [{"n" * 64: 1}, {"count": 1 << 40}, {"note": "half a character: \ud800"}])
def test_what_cannot_be_kept_changes_nothing(pair, result, kept):
    before = [mesh_snapshot(obj) for obj in pair]
    kinds = SimpleNamespace(vertex_groups=True, match_colors=True, distortion=True, confidence=True)
    prepared = run(contents_steps(result, "HM", kinds))
    prepared[1].keep.update(kept)
    with pytest.raises((KeyError, OverflowError, ValueError)):
        writing.write(list(zip(pair, prepared, strict=True)), "HM")
    assert [mesh_snapshot(obj) for obj in pair] == before


def result_mesh(obj):
    return mesh_io.read_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=False)


def test_the_longest_prefix_fits(pair, result):
    state = bpy.context.scene.hiermatch
    state.prefix = "x" * 200
    write(pair, result, state.prefix)
    for name in ("Match", "Distortion", "Distortion Value"):
        assert f"{state.prefix} {name}" in pair[0].data.attributes
    assert f"{state.prefix}.005" in pair[0].vertex_groups
    assert not [attribute for attribute in pair[0].data.attributes if attribute.name.endswith("~")]


def test_written_data_survives_saving(pair, result, tmp_path):
    for obj in pair:
        decorate(obj)
    before = {obj.name: mesh_snapshot(obj) for obj in pair}
    write(pair, result)
    written = {obj.name: mesh_snapshot(obj) for obj in pair}
    path = str(tmp_path / "pair.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    objects = [bpy.data.objects[name] for name in written]
    assert {obj.name: mesh_snapshot(obj) for obj in objects} == written
    for obj in objects:
        writing.clear(obj, "HM")
    assert {obj.name: mesh_snapshot(obj) for obj in objects} == before


def test_a_copied_object_can_be_cleared_by_itself(pair, result):
    write(pair, result)
    copy = pair[0].copy()
    copy.data = pair[0].data.copy()
    bpy.context.collection.objects.link(copy)
    written = mesh_snapshot(pair[0])
    assert writing.clear(copy, "HM")
    assert not copy.vertex_groups
    assert mesh_snapshot(pair[0]) == written
