# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters of several objects: matched and retargeted as one surface, and written object by object."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene.armatures import find_armature
from hiermatch.hiermatch_addon.scene.character import parts_of, positions_of, read_surface, topology_of
from hiermatch.hiermatch_addon.scene.deform_layer import read_weights
from hiermatch.hiermatch_addon.scene.pair import named_side
from hiermatch.hiermatch_addon.scene.posing.before_after import is_before
from hiermatch.hiermatch_addon.storage.halves import find_common, find_half
from hiermatch.hiermatch_addon.storage.landmarks import add_landmarks, find_landmarks
from hiermatch.hiermatch_addon.storage.match_exchange import apply_match, collect_match
from hiermatch.hiermatch_addon.storage.stored_map import find_maps

from tests.addon.rigs import POSE, add_rigged, add_target, pose, split_up
from tests.addon.scenes import DENSE, MAP_ATTRIBUTES, maps_of, mesh_snapshot
from tests.skeletons import CONTROLS, CREATURE_BONES

SOURCE, TARGET = "Source Rig", "Figure"
"""The source is named by its armature, the target by its collection."""


def number_vertices(obj):
    """Keep on the vertices which one of the whole body each is."""
    attribute = obj.data.attributes.new("number", "INT", "POINT")
    attribute.data.foreach_set("value", np.arange(len(obj.data.vertices), dtype=np.int32))


def numbers_of(obj):
    return np.array([item.value for item in obj.data.attributes["number"].data])


def side(name):
    bpy.context.view_layer.update()
    return named_side(bpy.context.view_layer, name)


def own_groups(obj):
    return [group.name for group in obj.vertex_groups if not group.name.startswith("HM")]


def untouched(obj):
    """Everything on a part of the source but what a match writes there."""
    found = mesh_snapshot(obj)
    kept = {name: weights for name, weights in found["weights"].items() if not name.startswith("HM")}
    attributes = [attribute for attribute in found["attributes"] if not attribute[0].startswith("HM")]
    keys = [key.name for key in obj.data.shape_keys.key_blocks]
    return kept, attributes, found["vertices"], keys, obj.parent, [(m.type, m.object) for m in obj.modifiers]


def gaps(objects):
    """How far apart vertices of the same number are as they are shown, on several objects."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    surface = read_surface(named_side(bpy.context.view_layer, TARGET), depsgraph, use_modifiers=True).vertices
    numbers = np.concatenate([numbers_of(obj) for obj in objects])
    order = np.argsort(numbers, kind="stable")
    same = np.flatnonzero(np.diff(numbers[order]) == 0)
    assert len(same) > 10
    return np.linalg.norm(surface[order[same]] - surface[order[same + 1]], axis=1)


@pytest.fixture(scope="module")
def retargeted(extension, tmp_path_factory):
    """A file in which a creature of three objects was retargeted to one of two, in another pose."""
    assert extension
    bpy.ops.wm.read_homefile(use_empty=True)
    source, _ = add_rigged(resolution=6)
    target, _ = add_target(source)
    for obj in (source, target):
        number_vertices(obj)
    source.data.uv_layers.new(name="Layout")
    source.shape_key_add(name="Basis")
    for point in source.shape_key_add(name="Swell", from_mix=False).data:
        point.co.z += 0.1 * max(0.0, point.co.x - 0.8)  # the head alone
    material = bpy.data.materials.new("Skin")
    target.data.materials.append(material)
    parts = split_up(source, lambda centers: np.digitize(centers[:, 2], [-0.4, 0.25]))
    held = bpy.data.collections.new(TARGET)
    bpy.context.scene.collection.children.link(held)
    for obj in split_up(target, lambda centers: centers[:, 0] > 0):
        held.objects.link(obj)
        bpy.context.scene.collection.objects.unlink(obj)
    for name, value in DENSE.items():
        setattr(bpy.context.scene.hiermatch, name, value)
    before = [untouched(part) for part in parts]
    kinds = {"use_attributes": False}
    assert bpy.ops.hiermatch.retarget(source=SOURCE, target=TARGET, **kinds) == {"FINISHED"}
    assert [untouched(part) for part in parts] == before
    path = str(tmp_path_factory.mktemp("characters") / "retargeted.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return path


@pytest.fixture
def targets(retargeted, empty_file):
    """The parts of the target."""
    assert empty_file
    bpy.ops.wm.open_mainfile(filepath=retargeted)
    return parts_of(side(TARGET))


class TestRetarget:
    def test_all_parts_of_the_target_follow_one_new_armature(self, targets):
        armatures = {find_armature(obj) for obj in targets}
        assert len(armatures) == 1
        assert armatures != {bpy.data.objects[SOURCE]}
        assert sum(obj.type == "ARMATURE" for obj in bpy.data.objects) == 2
        for obj in targets:
            assert [modifier.type for modifier in obj.modifiers] == ["ARMATURE"]
            assert obj.parent in armatures
            assert [slot.material.name for slot in obj.material_slots] == ["Skin"]

    def test_weights_are_those_of_the_same_places_and_groups_are_where_they_have_weight(self, targets):
        names = [name for name in CREATURE_BONES if name not in CONTROLS]
        true = np.zeros((sum(len(obj.data.vertices) for obj in targets) + 1, len(names)))
        for obj in parts_of(side(SOURCE)):
            weights = read_weights(obj).toarray()
            for column, name in enumerate(names):
                true[numbers_of(obj), column] = weights[:, obj.vertex_groups[name].index]
        for obj in targets:
            weights = read_weights(obj).toarray()
            held = {name: weights[:, obj.vertex_groups[name].index] for name in own_groups(obj)}
            assert all(weights.any() for weights in held.values())
            assert len(held) < len(names)
            got = np.column_stack([held.get(name, np.zeros(len(weights))) for name in names])
            assert np.abs(got - true[numbers_of(obj)]).sum(axis=1).mean() < 0.2

    def test_no_seam_opens_when_it_is_posed(self, targets):
        assert gaps(targets).max() < 1e-5
        pose(find_armature(targets[0]), angles=POSE)
        assert gaps(targets).max() < 1e-5

    def test_a_shape_key_is_on_the_parts_that_it_moves(self, targets):
        keys = {obj.name: obj.data.shape_keys for obj in targets}
        moved = [name for name, own in keys.items() if own is not None]
        assert moved == ["Target True"]  # where the head is
        assert [key.name for key in keys["Target True"].key_blocks] == ["Basis", "Swell"]
        assert all(list(obj.data.uv_layers.keys()) == ["Layout"] for obj in targets)

    def test_again_it_uses_the_match_and_the_armature_that_are_there(self, targets):
        armature = find_armature(targets[0])
        key = find_common(side(SOURCE), side(TARGET))[0][0].key
        assert bpy.ops.hiermatch.fit_rig(source=SOURCE, target=TARGET, refine=False) == {"FINISHED"}
        assert {find_armature(obj) for obj in targets} == {armature}
        assert find_common(side(SOURCE), side(TARGET))[0][0].key == key
        assert bpy.context.scene.hiermatch_retarget.report.done.startswith(f'Carried to "{TARGET}"')

    def test_named_part_by_part_it_is_shown_as_it_was_as_a_whole(self, targets):
        name = " + ".join(obj.name for obj in targets)
        assert bpy.ops.hiermatch.fit_rig(source=SOURCE, target=name, refine=False) == {"FINISHED"}
        assert bpy.context.scene.hiermatch_retarget.report.target == name
        assert bpy.ops.hiermatch.before_after(target=name) == {"FINISHED"}
        assert [is_before(obj) for obj in targets] == [True, True]


class TestStoredMatch:
    def test_each_part_keeps_its_own_and_finds_the_others(self, targets):
        for obj in (*parts_of(side(SOURCE)), *targets):
            assert set(MAP_ATTRIBUTES) <= set(obj.data.attributes.keys())
            half = find_half(obj)
            assert obj in parts_of(half.obj)
            assert not half.staleness()
        assert find_half(targets[1]).obj.parts == targets
        maps = maps_of(side(SOURCE), side(TARGET))
        assert maps.target.vertex_count == sum(len(obj.data.vertices) for obj in targets)

    def test_an_edit_of_any_part_makes_it_stale(self, targets):
        targets[1].data.vertices[0].co.x += 0.1
        targets[1].data.update()
        with pytest.raises(ObjectError, match=f'"{TARGET}" was edited since'):
            find_maps(side(SOURCE), side(TARGET))

    def test_a_part_that_comes_or_goes_makes_another_character(self, targets):
        bpy.data.objects.remove(targets[1])
        assert not find_common(side(SOURCE), side(TARGET))
        with pytest.raises(ObjectError, match="carries no match"):
            find_half(side(TARGET))

    def test_renaming_and_copying_parts_is_no_matter(self, targets):
        copy = targets[0].copy()
        copy.data = targets[0].data.copy()
        bpy.context.scene.collection.objects.link(copy)
        assert find_half(targets[1]).obj.parts == targets
        targets[1].name = "Z"
        assert find_half(targets[0]).obj.parts == targets

    def test_it_goes_through_a_file(self, targets):
        kept = collect_match(side(SOURCE), side(TARGET))
        bpy.ops.hiermatch.clear(object=TARGET)
        assert not any(own_groups(obj) != list(obj.vertex_groups.keys()) for obj in targets)
        apply_match(bpy.context, side(SOURCE), side(TARGET), kept, "HM")
        assert find_maps(side(SOURCE), side(TARGET)).maps.of_target.corners.shape[1] == 3

    def test_colors_regions_and_the_other_answer(self, targets):
        state = bpy.context.scene.hiermatch
        state.source, state.target_collection = bpy.data.objects[SOURCE], bpy.data.collections[TARGET]
        assert bpy.ops.hiermatch.show(view="REGIONS") == {"FINISHED"}
        assert all(obj.data.attributes.active_color_name == "HM Regions" for obj in targets)
        assert bpy.ops.hiermatch.show(view="NONE") == {"FINISHED"}
        assert bpy.ops.hiermatch.swap() == {"FINISHED"}
        assert (state.source_collection, state.target) == (bpy.data.collections[TARGET], bpy.data.objects[SOURCE])
        assert state.summary.source == TARGET

    def test_landmarks_lie_on_parts_and_refine_the_match(self, targets):
        state = bpy.context.scene.hiermatch
        state.source, state.target_collection = bpy.data.objects[SOURCE], bpy.data.collections[TARGET]
        first, second = side(SOURCE), side(TARGET)
        last = sum(len(obj.data.vertices) for obj in targets) - 1
        numbers = np.concatenate([numbers_of(obj) for obj in first.parts])
        there = int(np.flatnonzero(numbers == numbers_of(targets[1])[-1])[0])
        add_landmarks(first, second, [(there, last)])
        assert [(one.source, one.target) for one in find_landmarks(first, second)] == [(there, last)]
        assert "HM Landmark" in targets[1].data.attributes
        assert "HM Landmark" not in targets[0].data.attributes
        digests = topology_of(second), positions_of(second)
        assert bpy.ops.hiermatch.refine() == {"FINISHED"}
        assert digests == (topology_of(second), positions_of(second))
        assert find_maps(first, second).maps.of_source.corners[there].max() <= last


def test_wrapping_writes_a_key_on_each_part_and_keeps_seams(targets):
    assert bpy.ops.hiermatch.wrap(source=TARGET, target=SOURCE, prefix="HM") == {"FINISHED"}
    assert all(f"Wrap to {SOURCE}" in obj.data.shape_keys.key_blocks for obj in targets)
    assert gaps(targets).max() < 1e-4
