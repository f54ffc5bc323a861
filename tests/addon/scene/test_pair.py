# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects are meant, and which cannot be matched."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene.character import joined, side_of
from hiermatch.hiermatch_addon.scene.pair import check_pair, find_pair, name_of, named_side, selected_targets

from tests.addon.scenes import add_blob, add_pair


@pytest.fixture
def pair():
    return add_pair()


def select(*objects, active=None):
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(state=True)
    bpy.context.view_layer.objects.active = active


def check(pair):
    bpy.context.view_layer.update()
    check_pair(bpy.context.view_layer, *pair)


class TestFind:
    def test_by_name_whatever_is_picked_or_selected(self, pair):
        other = add_blob("Other")
        select(other, pair[0], active=other)
        assert find_pair(bpy.context, ("Source", "Target"), (other, pair[0])) == pair

    def test_as_picked_whatever_is_selected(self, pair):
        other = add_blob("Other")
        select(other, pair[0], active=other)
        assert find_pair(bpy.context, picked=pair) == pair

    def test_as_selected_the_active_one_is_the_source(self, pair):
        source, target = pair
        select(source, target, active=target)
        assert find_pair(bpy.context) == (target, source)
        select(source, target, active=source)
        assert find_pair(bpy.context) == (source, target)

    def test_lights_and_empties_in_the_selection_do_not_matter(self, pair):
        source, target = pair
        empty = bpy.data.objects.new("Empty", None)
        bpy.context.collection.objects.link(empty)
        select(source, target, empty, active=source)
        assert find_pair(bpy.context) == pair

    @pytest.mark.parametrize("active", ["Source", "Target"])
    def test_a_selected_empty_means_what_hangs_on_it(self, pair, active):
        empties = {}
        for part in pair:
            group, root = (bpy.data.objects.new(f"{part.name} {what}", None) for what in ("Group", "Root"))
            for obj in (group, root):
                bpy.context.collection.objects.link(obj)
            part.parent, group.parent = group, root
            empties[part.name] = [root, group]
        bpy.context.view_layer.update()
        select(*empties["Source"], *empties["Target"], active=empties[active][0])
        assert find_pair(bpy.context) == (pair if active == "Source" else pair[::-1])
        select(*empties["Source"], *pair, *empties["Target"], active=empties[active][0])  # as after an import
        assert find_pair(bpy.context) == (pair if active == "Source" else pair[::-1])

    def test_one_picked_and_the_other_selected(self, pair):
        source, target = pair
        select(target, active=target)
        assert find_pair(bpy.context, picked=(source, None)) == pair
        select(source, active=source)
        assert find_pair(bpy.context, picked=(None, target)) == pair
        select(source, target, active=target)
        assert find_pair(bpy.context, picked=(None, target)) == pair

    def test_unknown_name(self, pair):
        with pytest.raises(ObjectError, match='no object called "Sorce"'):
            find_pair(bpy.context, ("Sorce", pair[1].name))

    def test_nothing_selected(self, pair):
        assert pair
        with pytest.raises(ObjectError, match="Source: no other mesh is selected"):
            find_pair(bpy.context)

    def test_only_one_selected(self, pair):
        select(pair[0], active=pair[0])
        with pytest.raises(ObjectError, match="Target: no other mesh is selected"):
            find_pair(bpy.context)

    def test_three_selected(self, pair):
        other = add_blob("Other")
        select(*pair, other, active=other)
        with pytest.raises(ObjectError, match="Target: 2 other meshes are selected"):
            find_pair(bpy.context)


def add_armature():
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(armature)
    return armature


def bind(obj, armature, how):
    """Let an armature move a mesh with a modifier, as its parent, or as the parent of its parent."""
    if how == "modifier":
        obj.modifiers.new("Armature", "ARMATURE").object = armature
        return
    obj.parent = armature
    if how == "ancestor":
        obj.parent = bpy.data.objects.new("Between", None)
        obj.parent.parent = armature


class TestPartsOfTheSource:
    @pytest.mark.parametrize("mine", ["modifier", "parent"])
    @pytest.mark.parametrize("its", ["modifier", "parent", "ancestor"])
    def test_are_no_targets_by_selection(self, pair, mine, its):
        source, target = pair
        coat, armature = add_blob("Coat"), add_armature()
        bind(source, armature, mine)
        bind(coat, armature, its)
        bind(target, add_armature(), "modifier")  # another character's
        select(source, target, coat, active=source)
        assert selected_targets(bpy.context, source) == ([target], [coat])
        assert find_pair(bpy.context, (source.name, "")) == pair

    def test_are_if_named_or_picked(self, pair):
        source, target = pair
        armature = add_armature()
        for obj in pair:
            bind(obj, armature, "modifier")
        select(source, target, active=source)
        assert find_pair(bpy.context, ("", "Target")) == pair
        assert find_pair(bpy.context, picked=(None, target)) == pair
        with pytest.raises(ObjectError, match='moved by the same rig as "Source": "Source", "Target"'):
            find_pair(bpy.context)


class TestCheck:
    def test_a_good_pair(self, pair):
        assert check(pair) is None

    def test_the_same_object_twice(self, pair):
        with pytest.raises(ObjectError, match='both "Source"'):
            check((pair[0], pair[0]))

    @pytest.mark.parametrize("kind", ["light", "empty", "camera"])
    def test_not_a_mesh(self, pair, kind):
        data = {"light": lambda: bpy.data.lights.new("x", "POINT"), "camera": lambda: bpy.data.cameras.new("x")}
        other = bpy.data.objects.new("Other", data.get(kind, lambda: None)())
        bpy.context.collection.objects.link(other)
        with pytest.raises(ObjectError, match='"Other" is not a mesh'):
            check((pair[0], other))

    def test_shared_mesh_data(self, pair):
        twin = pair[0].copy()
        bpy.context.collection.objects.link(twin)
        with pytest.raises(ObjectError, match=r"share the same mesh data.*Make Single User"):
            check((pair[0], twin))

    def test_hidden(self, pair):
        pair[1].hide_set(state=True)
        with pytest.raises(ObjectError, match='"Target" is hidden'):
            check(pair)

    def test_one_in_a_collection_that_is_not_shown(self, pair):
        aside = bpy.data.collections.new("Aside")
        bpy.context.scene.collection.children.link(aside)
        bpy.context.scene.collection.objects.unlink(pair[1])
        aside.objects.link(pair[1])
        aside.hide_viewport = True
        with pytest.raises(ObjectError, match='"Target" is not shown: its collection is hidden'):
            check_pair(bpy.context.view_layer, *pair)

    def test_disabled_in_viewports(self, pair):
        pair[1].hide_viewport = True
        with pytest.raises(ObjectError, match='"Target" is disabled in viewports'):
            check(pair)

    def test_not_in_the_view_layer(self, pair):
        bpy.context.collection.objects.unlink(pair[1])
        with pytest.raises(ObjectError, match='"Target" is not in the view layer'):
            check(pair)

    def test_in_an_excluded_collection(self, pair):
        collection = bpy.data.collections.new("Away")
        bpy.context.scene.collection.children.link(collection)
        bpy.context.collection.objects.unlink(pair[1])
        collection.objects.link(pair[1])
        bpy.context.view_layer.layer_collection.children["Away"].exclude = True
        with pytest.raises(ObjectError, match='"Target" is not in the view layer'):
            check(pair)

    @pytest.mark.parametrize("mode", ["EDIT", "WEIGHT_PAINT", "VERTEX_PAINT"])
    def test_another_mode(self, pair, mode):
        select(pair[1], active=pair[1])
        bpy.ops.object.mode_set(mode=mode)
        with pytest.raises(ObjectError, match=r'"Target" is in .*Mode. Switch to Object Mode'):
            check(pair)
        bpy.ops.object.mode_set(mode="OBJECT")

    def test_a_mesh_that_is_edited_through_another_object(self, pair):
        twin = pair[0].copy()
        bpy.context.collection.objects.link(twin)
        select(twin, active=twin)
        bpy.ops.object.mode_set(mode="EDIT")
        with pytest.raises(ObjectError, match='"Source" shares its mesh with an object in Edit Mode'):
            check(pair)
        bpy.ops.object.mode_set(mode="OBJECT")
        check(pair)

    def test_no_faces(self, pair):
        data = bpy.data.meshes.new("Wire")
        data.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
        wire = bpy.data.objects.new("Wire", data)
        bpy.context.collection.objects.link(wire)
        with pytest.raises(ObjectError, match='"Wire" has no faces'):
            check((pair[0], wire))

    def test_no_size(self, pair):
        pair[1].scale = (1, 0, 1)
        with pytest.raises(ObjectError, match='"Target" has a scale of zero on Y'):
            check(pair)

    @pytest.mark.usefixtures("pair")
    def test_linked_and_overridden(self, tmp_path):
        path = str(tmp_path / "library.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True)
        own = add_blob("Own")
        with bpy.data.libraries.load(path, link=True) as (_, into):
            into.objects = ["Target"]
        linked = bpy.data.objects["Target"]
        bpy.context.collection.objects.link(linked)
        with pytest.raises(ObjectError, match=r'"Target" is linked from "library.blend".*Make Local'):
            check((own, linked))
        overridden = linked.override_create(remap_local_usages=True)
        with pytest.raises(ObjectError, match=r'"Target" is (linked|a library override)'):
            check((own, overridden))
        borrowed = bpy.data.objects.new("Borrowed", linked.data)
        bpy.context.collection.objects.link(borrowed)
        with pytest.raises(ObjectError, match='"Borrowed" is linked'):
            check((own, borrowed))


class TestSameNames:
    """A character that was linked, and a local one that has the same name."""

    @pytest.fixture
    def both(self, pair, tmp_path):
        path = str(tmp_path / "library.blend")
        bpy.data.libraries.write(path, {pair[0]})
        with bpy.data.libraries.load(path, link=True) as (_, into):
            into.objects = ["Source"]
        linked = into.objects[0]
        bpy.context.collection.objects.link(linked)
        bpy.context.view_layer.update()
        return pair[0], linked

    def test_each_is_in_the_view_layer(self, both, pair):
        check(pair)
        check_pair(bpy.context.view_layer, both[1], pair[1], writes=(False, True))
        bpy.context.collection.objects.unlink(both[1])
        check(pair)
        with pytest.raises(ObjectError, match="not in the view layer"):
            check_pair(bpy.context.view_layer, both[1], pair[1], writes=(False, True))

    def test_each_is_found_again_by_its_name(self, both):
        layer = bpy.context.view_layer
        names = [name_of(layer, obj) for obj in both]
        assert names == ["Source", "Source [library.blend]"]
        assert [named_side(layer, name) for name in names] == list(both)
        side = joined("Both", both)
        assert named_side(layer, name_of(layer, side)).parts == side.parts

    def test_a_collection_may_hold_both(self, both):
        collection = bpy.data.collections.new("Both")
        bpy.context.scene.collection.children.link(collection)
        for obj in both:
            collection.objects.link(obj)
        bpy.context.view_layer.update()
        assert set(side_of(collection, bpy.context.view_layer).parts) == set(both)


def test_what_shows_a_collection_is_to_be_made_editable(pair):
    """As characters are that were linked from another file."""
    shown = bpy.data.objects.new("Hero", None)
    shown.instance_type, shown.instance_collection = "COLLECTION", bpy.data.collections.new("Heroes")
    bpy.context.scene.collection.objects.link(shown)
    with pytest.raises(ObjectError, match='shows the collection "Heroes"'):
        check((pair[0], shown))
