# SPDX-License-Identifier: GPL-3.0-or-later
"""Several objects as one surface: which belong together, and what they are joined to."""

from __future__ import annotations

from itertools import permutations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene.armatures import bone_of, find_armature, read_rig
from hiermatch.hiermatch_addon.scene.character import (
    Character,
    SideReference,
    is_of,
    joined,
    parts_of,
    positions_of,
    read_faces,
    read_surface,
    side_of,
    topology_of,
    vertex_count,
    vertex_ranges,
)
from hiermatch.hiermatch_addon.scene.pair import (
    check_object,
    check_pair,
    find_pair,
    name_of,
    named_side,
    selected_targets,
)

from tests.addon.rigs import add_rigged, pose, split_up
from tests.addon.scenes import add_blob


def by_height(centers):
    """Cut in three: legs, trunk, neck and head."""
    return np.digitize(centers[:, 2], [-0.4, 0.25])


@pytest.fixture
def cut():
    """A creature in three objects on its armature, and the armature."""
    obj, armature = add_rigged(resolution=5)
    return split_up(obj, by_height), armature


def layer():
    bpy.context.view_layer.update()
    return bpy.context.view_layer


def surface(side):
    return read_surface(side, bpy.context.evaluated_depsgraph_get(), use_modifiers=False)


def select(*objects, active=None):
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(state=True)
    bpy.context.view_layer.objects.active = active


class TestWhatIsMeant:
    def test_an_armature_means_all_meshes_that_it_moves(self, cut):
        parts, armature = cut
        bare = add_blob("Bare")
        assert side_of(armature, layer()) == Character(armature.name, tuple(parts))
        assert named_side(layer(), armature.name) == side_of(armature, layer())
        assert side_of(bare, layer()) == bare

    def test_a_collection_means_its_meshes_also_in_collections_below(self, cut):
        parts, _ = cut
        above, below = (bpy.data.collections.new(name) for name in ("Hero", "Clothes"))
        bpy.context.scene.collection.children.link(above)
        above.children.link(below)
        above.objects.link(parts[0])
        below.objects.link(parts[1])
        assert named_side(layer(), "Hero") == Character("Hero", tuple(parts[:2]))
        assert named_side(layer(), "Clothes") == parts[1]

    def test_what_is_of_a_character_however_that_is_picked(self, cut):
        parts, armature = cut
        hero, bare = bpy.data.collections.new("Hero"), add_blob("Bare")
        bpy.context.scene.collection.children.link(hero)
        for part in parts[:2]:
            hero.objects.link(part)
        assert [is_of(part, hero) for part in (*parts, bare)] == [True, True, False, False]
        for chosen in (armature, parts[2]):
            assert [is_of(part, chosen) for part in (*parts, bare)] == [True, True, True, False]
        assert [is_of(part, bare) for part in (*parts, bare)] == [False, False, False, True]

    def test_an_empty_means_the_meshes_below_it(self):
        root = bpy.data.objects.new("Root", None)
        bpy.context.scene.collection.objects.link(root)
        blobs = [add_blob(name) for name in ("B", "A")]
        for blob in blobs:
            blob.parent = root
        assert side_of(root, layer()) == Character("Root", tuple(blobs[::-1]))

    def test_several_objects_can_be_named_and_found_by_their_name(self, cut):
        parts, armature = cut
        side = joined(armature.name, parts[:2])
        assert name_of(layer(), side) == f"{parts[0].name} + {parts[1].name}"
        assert parts_of(named_side(layer(), name_of(layer(), side))) == side.parts
        assert name_of(layer(), side_of(armature, layer())) == armature.name

    @pytest.mark.parametrize(
        "names", [("Body + Hair", "Eyes"), ("Body", "Eyes + Hair"), ("Body + Hair", "Eyes + Ears")]
    )
    def test_also_if_their_names_look_like_several(self, names):
        side = joined("Hero", [add_blob(name) for name in names])
        assert parts_of(named_side(layer(), name_of(layer(), side))) == side.parts
        with pytest.raises(ObjectError, match='no object called "Nobody"'):
            named_side(layer(), f"{names[0]} + Nobody")

    def test_what_is_hidden_or_has_no_faces_is_no_part(self, cut):
        parts, armature = cut
        parts[0].hide_set(state=True)
        parts[1].data.clear_geometry()
        assert side_of(armature, layer()) == parts[2]

    def test_one_without_meshes_is_told(self, cut):
        parts, armature = cut
        for part in parts:
            part.hide_set(state=True)
        assert side_of(armature, layer()) == armature
        with pytest.raises(ObjectError, match=f'The armature "{armature.name}" moves no mesh'):
            check_object(layer(), armature)
        bpy.context.scene.collection.children.link(bpy.data.collections.new("Empty"))
        with pytest.raises(ObjectError, match='The collection "Empty" holds no mesh'):
            named_side(layer(), "Empty")
        with pytest.raises(ObjectError, match='no object called "Nobody"'):
            named_side(layer(), "Nobody")


class TestSelection:
    def test_what_hangs_on_the_active_ones_rig_is_the_source_and_each_other_rig_a_target(self, cut):
        parts, armature = cut
        others = []
        for name in ("Other", "Third"):
            obj, rig = add_rigged(name, resolution=4)
            others.append((split_up(obj, lambda centers: centers[:, 0] > 0), rig))
        bare = add_blob("Bare")
        select(*parts, *others[0][0], *others[1][0], bare, active=parts[1])
        source, targets = parts_of(find_pair(bpy.context, ("", "Bare"))[0]), None
        assert source == tuple(parts)
        targets, left_out = selected_targets(bpy.context, joined("", parts))
        assert {frozenset(parts_of(one)) for one in targets} == {
            frozenset(others[0][0]),
            frozenset(others[1][0]),
            frozenset([bare]),
        }
        assert {one.name for one in targets} == {"Other Rig", "Third Rig", "Bare"}
        assert not left_out
        assert armature not in source

    @pytest.mark.parametrize("order", list(permutations(("One", "Two", "Linking"))))
    def test_what_shares_armatures_by_way_of_another_is_one_target(self, order):
        """Whichever is met first: the meshes are gone through by name."""
        rigs = [bpy.data.objects.new(name, bpy.data.armatures.new(name)) for name in ("Body Rig", "Face Rig")]
        moved_by = {"One": rigs[:1], "Two": rigs[1:], "Linking": rigs}
        for rig in rigs:
            bpy.context.collection.objects.link(rig)
        blobs = [add_blob(f"{number} {name}") for number, name in enumerate(order)]
        for blob, name in zip(blobs, order, strict=True):
            for rig in moved_by[name]:
                blob.modifiers.new("Armature", "ARMATURE").object = rig
        source = add_blob("Source")
        select(source, *blobs, active=source)
        assert [parts_of(target) for target in selected_targets(bpy.context, source)[0]] == [tuple(blobs)]

    def test_armatures_alone_mean_all_that_they_move(self, cut):
        parts, armature = cut
        obj, rig = add_rigged("Other", resolution=4)
        others = split_up(obj, lambda centers: centers[:, 0] > 0)
        select(armature, rig, active=armature)
        source, target = find_pair(bpy.context)
        assert (source, target) == (Character(armature.name, tuple(parts)), Character(rig.name, tuple(others)))

    def test_bare_meshes_are_one_target_if_they_fill_a_collection_without_the_source(self, cut):
        parts, _ = cut
        blobs = [add_blob(name) for name in ("One", "Two")]
        select(*parts, *blobs, active=parts[0])
        assert selected_targets(bpy.context, joined("", parts))[0] == blobs
        held = bpy.data.collections.new("Held")
        bpy.context.scene.collection.children.link(held)
        for blob in blobs:
            bpy.context.scene.collection.objects.unlink(blob)
            held.objects.link(blob)
        select(*parts, *blobs, active=parts[0])
        assert selected_targets(bpy.context, joined("", parts))[0] == [Character("Held", tuple(blobs))]
        select(*parts, blobs[0], active=parts[0])
        assert selected_targets(bpy.context, joined("", parts))[0] == [blobs[0]]

    def test_a_part_of_both_sides_is_refused(self, cut):
        parts, armature = cut
        with pytest.raises(ObjectError, match=f'"{parts[1].name}" belongs to both'):
            check_pair(layer(), side_of(armature, layer()), parts[1])


class TestSurface:
    def test_it_is_that_of_the_joined_object(self, cut):
        parts, armature = cut
        side = side_of(armature, layer())
        mine, faces = surface(side), read_faces(side)
        rig, digest = read_rig(side), (topology_of(side), positions_of(side))
        assert vertex_count(side) == mine.vertex_count == vertex_ranges(side)[-1].stop
        select(*parts, active=parts[0])
        bpy.ops.object.join()
        whole = surface(parts[0])
        assert sorted(map(tuple, mine.vertices.round(5))) == sorted(map(tuple, whole.vertices.round(5)))
        np.testing.assert_allclose(mine.area, whole.area, rtol=1e-6)
        np.testing.assert_array_equal(faces.triangle_corners, read_faces(parts[0]).triangle_corners)
        np.testing.assert_array_equal(faces.corner_vertices, read_faces(parts[0]).corner_vertices)
        after = np.concatenate([np.roll(own, -1) for own in np.split(faces.corner_vertices, faces.starts[1:-1])])
        ends = np.sort(np.stack([faces.corner_vertices, after], axis=1), axis=1)
        np.testing.assert_array_equal(np.sort(faces.edges[faces.corner_edges], axis=1), ends)
        np.testing.assert_allclose(rig.weights.toarray(), read_rig(parts[0]).weights.toarray(), atol=1e-6)
        assert digest != (topology_of(parts[0]), positions_of(parts[0]))

    def test_digests_tell_of_a_change_in_any_part(self, cut):
        parts, armature = cut
        side = side_of(armature, layer())
        before = topology_of(side), positions_of(side)
        parts[2].data.vertices[0].co.x += 1
        assert topology_of(side) == before[0]
        assert positions_of(side) != before[1]

    def test_it_is_found_again_until_a_part_is_gone(self, cut):
        parts, armature = cut
        side = side_of(armature, layer())
        reference = SideReference.of(side)
        assert reference.find() == side
        bpy.data.objects.remove(parts[1])
        assert reference.find() is None

    def test_what_hangs_on_a_bone_is_read_at_rest_and_moved_by_it_alone(self, cut):
        _, armature = cut
        eye = add_blob("Eye", 6, 4)
        eye.parent, eye.parent_type, eye.parent_bone = armature, "BONE", "head"
        side = side_of(armature, layer())
        assert eye in parts_of(side)
        assert find_armature(eye) == armature
        assert bone_of(eye) == "head"
        rest, own = surface(side).vertices, vertex_ranges(side)[parts_of(side).index(eye)]
        pose(armature)
        np.testing.assert_allclose(surface(side).vertices, rest, atol=1e-6)
        rig = read_rig(side)
        np.testing.assert_array_equal(rig.weights.toarray()[own, rig.names.index("head")], 1)
        assert rig.weights[own].sum() == own.stop - own.start


def test_a_side_is_found_again_though_others_take_its_names():
    first, second = add_blob("First"), add_blob("Second")
    reference = SideReference.of(first)
    first.name, second.name = "Elsewhere", "First"
    assert reference.find() is first
    bpy.data.objects.remove(first)
    assert reference.find() is None
