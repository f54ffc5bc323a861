# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a stored match still fits its meshes: what is noticed, when it is looked at, and what is said."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace

import bpy
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.properties import freshness
from hiermatch.hiermatch_addon.scene import mesh_io

from tests.addon.scenes import QUICK, add_blob, add_pair, edit_twin, maps_of, snapshot


def summary():
    return bpy.context.scene.hiermatch.summary


def stale():
    freshness.refresh(bpy.context.scene)
    return summary().stale


def activate(obj):
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(state=True)
    bpy.context.view_layer.objects.active = obj


def in_edit_mode(obj, change):
    activate(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    change()
    bpy.ops.object.mode_set(mode="OBJECT")


def nothing():
    """Change nothing."""


def bend(obj):
    obj.modifiers.new("Cast", "CAST").factor = 0.5


def paint(obj):
    obj.vertex_groups.new(name="Mine").add([1, 2], 0.5, "REPLACE")
    obj.data.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")


def rename(obj):
    obj.name, obj.data.name = "Renamed", "Mesh"


def turn(obj):
    obj.rotation_euler, obj.scale = (1, 2, 3), (2, 3, 1)
    bpy.context.view_layer.update()


def mirror(obj):
    obj.scale.x = -1
    bpy.context.view_layer.update()


def smooth(obj):
    for polygon in obj.data.polygons:
        polygon.use_smooth = True


HARMLESS = {
    "nothing": lambda _obj: None,
    "a look in Edit Mode": lambda obj: in_edit_mode(obj, nothing),
    "modifier": bend,
    "groups and colours": paint,
    "renamed": rename,
    "moved": turn,
    "shading": smooth,
    "the match shown otherwise": lambda _obj: bpy.ops.hiermatch.flip(),
    "swapped": lambda _obj: bpy.ops.hiermatch.swap(),
}

MOVED, OTHER_FACES = (
    r"was edited since \(its vertices were moved\)",
    r"was edited since \(it has other vertices or faces\)",
)

EDITS = {
    "moved in Edit Mode": (lambda obj: in_edit_mode(obj, lambda: bpy.ops.transform.resize(value=(1, 1, 2))), MOVED),
    "moved by a script": (lambda obj: setattr(obj.data.vertices[3].co, "x", 0.1), MOVED),
    "scale applied": (lambda obj: obj.data.transform(((2, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))), MOVED),
    "subdivided": (lambda obj: in_edit_mode(obj, bpy.ops.mesh.subdivide), OTHER_FACES),
    "mirrored": (mirror, r"was edited since \(it was mirrored\)"),
    "turned": (lambda obj: obj.data.flip_normals(), OTHER_FACES),
    "a vertex more": (lambda obj: obj.data.vertices.add(1), OTHER_FACES),
}


class TestEdits:
    @pytest.mark.parametrize("which", [0, 1])
    @pytest.mark.parametrize("change", HARMLESS)
    def test_what_does_not_matter(self, dense_pair, change, which):
        HARMLESS[change](dense_pair[which])
        assert not stale()
        assert maps_of(*dense_pair)

    @pytest.mark.parametrize("which", [0, 1])
    @pytest.mark.parametrize("change", EDITS)
    def test_what_does(self, dense_pair, change, which):
        alter, message = EDITS[change]
        alter(dense_pair[which])
        name = ("Source", "Target")[which]
        with pytest.raises(ObjectError, match=f'The match is out of date: "{name}" {message}. Match again') as told:
            maps_of(*dense_pair)
        assert stale() == str(told.value)

    def test_taking_an_edit_back_makes_it_fit_again(self, dense_pair):
        vertex = dense_pair[0].data.vertices[3]
        before = vertex.co.x
        vertex.co.x += 1
        assert stale()
        vertex.co.x = before
        assert not stale()

    def test_turning_it_twice_is_no_mirror(self, dense_pair):
        dense_pair[0].scale = -1, -1, 1
        bpy.context.view_layer.update()
        assert not stale()

    def test_undo_does_too(self, dense_pair):
        bpy.ops.ed.undo_push(message="Before")
        dense_pair[0].data.vertices[3].co.x += 1
        bpy.ops.ed.undo_push(message="Edited")
        assert stale()
        bpy.ops.ed.undo()
        assert not stale()
        bpy.ops.ed.redo()
        assert stale()

    def test_matching_again_makes_it_fit_again(self):
        pair = add_pair()
        for _ in range(2):
            bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK)
            assert not summary().stale
            pair[1].data.vertices[0].co.x += 0.01
            assert "Target" in stale()

    def test_flipping_does_not(self, dense_pair):
        dense_pair[1].data.vertices[0].co.x += 0.01
        bpy.ops.hiermatch.flip()
        assert "edited since" in summary().stale

    def test_an_object_that_is_gone_or_carries_it_no_more(self, dense_pair):
        bpy.ops.hiermatch.swap()
        bpy.data.objects.remove(dense_pair[1])
        assert '"Target" was deleted.' in stale()
        assert summary().lost
        assert not summary().hidden  # the source is still picked

    def test_one_that_was_matched_with_another_since(self, dense_pair):
        assert dense_pair
        add_blob("Other")
        bpy.ops.hiermatch.clear(object="Target")
        assert not summary().points
        bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK)
        key = summary().key
        bpy.ops.hiermatch.match(source="Source", target="Other", **QUICK)
        summary().key, summary().target = key, "Target"
        assert '"Source" was cleared or matched anew. Match again' in stale()
        assert summary().lost

    def test_of_copies_the_one_that_kept_its_name(self, dense_pair):
        copy = dense_pair[0].copy()
        copy.data = dense_pair[0].data.copy()
        bpy.context.collection.objects.link(copy)
        copy.data.vertices[0].co.x += 1
        assert not stale()
        dense_pair[0].data.vertices[0].co.x += 1
        assert stale()

    def test_the_faces_of_each_mesh_are_read_once(self, dense_pair, monkeypatch):
        read, counted = mesh_io.corner_vertices, []
        monkeypatch.setattr(mesh_io, "corner_vertices", lambda mesh: (counted.append(mesh), read(mesh))[1])
        assert not stale()
        assert counted == [obj.data for obj in dense_pair]

    def test_a_renamed_object_with_a_linked_duplicate(self, dense_pair):
        """Either carries the match."""
        state = bpy.context.scene.hiermatch
        state.source = state.target = None
        twin = dense_pair[0].copy()
        bpy.context.collection.objects.link(twin)
        dense_pair[0].name = "Hero"
        assert not stale()
        assert summary().source in ("Hero", twin.name)
        assert bpy.ops.hiermatch.show(view="MATCH") == {"FINISHED"}
        assert bpy.ops.hiermatch.flip() == {"FINISHED"}
        assert not stale()

    def test_no_match_no_word(self):
        assert not stale()
        summary().stale = "something"
        assert not stale()


class TestStoredMap:
    def test_strangers(self, dense_pair):
        other = add_blob("Other")
        with pytest.raises(ObjectError, match=r'"Source" and "Other" carry no match with one another\. Match them'):
            maps_of(dense_pair[0], other)
        with pytest.raises(ObjectError, match='no match with one another with the Prefix "Mine"'):
            maps_of(*dense_pair, prefix="Mine")
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        with pytest.raises(ObjectError, match="no match with one another"):
            maps_of(camera, dense_pair[1])

    def test_one_matched_with_another_since(self, dense_pair):
        add_blob("Other")
        bpy.ops.hiermatch.match(source="Other", target="Target", **QUICK)
        with pytest.raises(ObjectError, match='"Source" and "Target" carry no match with one another'):
            maps_of(*dense_pair)

    def test_several(self, dense_pair):
        bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK, prefix="Second")
        with pytest.raises(ObjectError, match=r'several matches\. Name the Prefix of one of them: "HM", "Second"'):
            maps_of(*dense_pair)
        assert maps_of(*dense_pair, prefix="HM")
        with pytest.raises(ObjectError, match="has no dense map"):
            maps_of(*dense_pair, prefix="Second")

    def test_reading_changes_nothing(self, dense_pair):
        before = snapshot()
        maps_of(*dense_pair)
        assert snapshot() == before


@pytest.fixture
def quiet(dense_pair):
    """The pair, when nothing is waiting to be looked at."""
    bpy.context.view_layer.update()
    settle()
    return dense_pair


def settle():
    if waiting():
        bpy.app.timers.unregister(freshness._look)  # noqa: SLF001


def waiting():
    return bpy.app.timers.is_registered(freshness._look)  # noqa: SLF001


class TestWatching:
    def test_an_edit_is_looked_at_later(self, quiet):
        quiet[1].data.vertices[0].co.x += 1
        quiet[1].data.update()
        bpy.context.view_layer.update()
        assert waiting()
        assert not summary().stale
        assert freshness._look() is None  # noqa: SLF001
        assert '"Target"' in summary().stale

    def test_leaving_edit_mode(self, quiet):
        in_edit_mode(quiet[0], lambda: bpy.ops.transform.resize(value=(1, 1, 2)))
        bpy.context.view_layer.update()
        assert waiting()

    def test_a_mesh_that_is_edited_through_another_object(self, quiet):
        bpy.ops.hiermatch.add_landmark(source="Source", target="Target", source_vertex=3, target_vertex=4)
        edit_twin(quiet[0])
        assert freshness._look() is None  # noqa: SLF001
        assert [row.source for row in bpy.context.scene.hiermatch_steering.landmarks] == [3]

    def test_deleting_an_object(self, quiet):
        activate(quiet[1])
        settle()
        bpy.ops.object.delete()
        assert waiting()
        freshness._look()  # noqa: SLF001
        assert '"Target" was deleted' in summary().stale

    @pytest.mark.parametrize("swapped", [False, True])
    @pytest.mark.parametrize("which", [0, 1])
    def test_renaming_an_object(self, quiet, which, swapped):
        """The panel goes on showing their match, also if they are picked nowhere, and by the new name."""
        if swapped:
            bpy.ops.hiermatch.swap()
        state, steering = bpy.context.scene.hiermatch, bpy.context.scene.hiermatch_steering
        state.source = state.target = None
        activate(quiet[0])
        settle()
        count = len(steering.pairs)
        quiet[which].name = "Renamed"
        assert bpy.ops.hiermatch.show(view="MATCH") == {"FINISHED"}
        bpy.context.view_layer.update()
        assert waiting()
        freshness._look()  # noqa: SLF001
        assert not summary().stale
        names = ["Renamed" if number == which else ("Source", "Target")[number] for number in range(2)]
        assert [summary().source, summary().target] == (names[::-1] if swapped else names)
        assert len(steering.pairs) == count > 0
        settle()
        quiet[which].select_set(state=True)
        bpy.context.view_layer.update()
        assert not waiting()
        # Another object may have the former name.
        add_blob(("Source", "Target")[which])
        freshness._look()  # noqa: SLF001
        assert not summary().stale
        assert bpy.ops.hiermatch.flip() == {"FINISHED"}

    def test_mirroring_an_object_and_back_is_looked_at_and_then_moving_it_is_not(self, quiet):
        mirror(quiet[1])
        assert waiting()
        freshness._look()  # noqa: SLF001
        assert "it was mirrored" in summary().stale
        settle()
        quiet[1].scale.x = 1
        bpy.context.view_layer.update()
        assert waiting()
        freshness._look()  # noqa: SLF001
        assert not summary().stale
        settle()
        quiet[1].location.x = 7
        bpy.context.view_layer.update()
        assert not waiting()

    def test_posing_moving_and_selecting_cost_nothing(self, quiet):
        bpy.ops.object.armature_add()
        rig = bpy.context.object
        quiet[0].modifiers.new("Rig", "ARMATURE").object = rig
        quiet[0].vertex_groups.new(name="Bone").add(range(len(quiet[0].data.vertices)), 1.0, "REPLACE")
        bpy.context.view_layer.update()
        settle()
        rig.pose.bones["Bone"].location.y = 5
        quiet[1].location.x = 7
        quiet[1].select_set(state=True)
        bpy.context.view_layer.update()
        assert not waiting()

    def test_meshes_without_a_match_cost_nothing(self, quiet):
        assert quiet
        other = add_blob("Other")
        bpy.context.view_layer.update()
        settle()
        other.data.vertices[0].co.x += 1
        other.data.update()
        bpy.context.view_layer.update()
        assert not waiting()

    @pytest.mark.parametrize("change", ["undo", "open"])
    def test_undoing_and_opening(self, quiet, dense_file, change):
        assert quiet
        if change == "undo":
            bpy.ops.ed.undo_push(message="One")
            bpy.ops.ed.undo_push(message="Two")
            settle()
            bpy.ops.ed.undo()
        else:
            bpy.ops.wm.open_mainfile(filepath=dense_file)
        assert waiting()

    def test_not_while_an_animation_plays(self, quiet, monkeypatch):
        quiet[1].data.vertices[0].co.x += 1
        drawn = []
        areas = [
            SimpleNamespace(
                type=area,
                regions=[
                    SimpleNamespace(type=region, tag_redraw=partial(drawn.append, (area, region)))
                    for region in ("WINDOW", "UI")
                ],
            )
            for area in ("VIEW_3D", "OUTLINER")
        ]
        playing = SimpleNamespace(screen=SimpleNamespace(is_animation_playing=True, areas=areas))
        context = SimpleNamespace(window_manager=SimpleNamespace(windows=[playing]))
        with monkeypatch.context() as patch:
            patch.setattr(freshness, "bpy", SimpleNamespace(context=context, data=bpy.data))
            assert freshness._look() > 0  # noqa: SLF001
            assert not summary().stale
            assert not drawn
            playing.screen.is_animation_playing = False
            assert freshness._look() is None  # noqa: SLF001
            assert drawn == [("VIEW_3D", "UI")]  # Blender does not draw by itself what a timer changed
            freshness._look()  # noqa: SLF001
            assert drawn == [("VIEW_3D", "UI")]  # nothing new to show
        assert summary().stale
