# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.flip`: the other answer of a match, without matching again."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.jobs.flipping import FlipJob
from hiermatch.hiermatch_addon.scene.mesh_io import read_mesh
from hiermatch.hiermatch_addon.storage.halves import find_half
from hiermatch.hiermatch_addon.storage.vertex_maps import StoredMaps, map_name

from tests.addon.scenes import (
    DENSE,
    QUICK,
    add_blob,
    add_symmetric_pair,
    mesh_snapshot,
    snapshot,
    values_of,
    weights_of,
    without_mirrored,
)
from tests.bodies import table


@pytest.fixture
def pair():
    return add_symmetric_pair()


def match(**options):
    assert bpy.ops.hiermatch.match(**({"source": "Source", "target": "Target"} | QUICK | options)) == {"FINISHED"}


def flip(**options):
    assert bpy.ops.hiermatch.flip(**options) == {"FINISHED"}


def summary():
    return bpy.context.scene.hiermatch.summary


def summary_values():
    return {name: value for name, value in snapshot()["summary"].items() if name != "seconds"}


def written():
    """All that was written on both meshes, and what is kept of it."""
    return [mesh_snapshot(bpy.data.objects[name]) for name in ("Source", "Target")]


def no_matching(monkeypatch):
    def forbidden(*_arguments, **_names):
        raise AssertionError("matched again")

    monkeypatch.setattr("hiermatch.hiermatch_addon.jobs.match_job.match_steps", forbidden)


def merge_part(obj):
    """Join a small ball to an object, so that its mesh has two parts."""
    island = add_blob("Island", 8, 6)
    island.location, island.scale = (9, 0, 0), (0.2, 0.2, 0.2)
    with bpy.context.temp_override(active_object=obj, selected_editable_objects=[obj, island]):
        bpy.ops.object.join()


def bend(obj):
    """Give an object a shape key that moves it."""
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Bent")
    for point in key.data:
        point.co.z += 0.2 * point.co.x * point.co.x
    key.value = 1


class TestAnswers:
    @pytest.mark.parametrize(
        "options",
        [
            {},
            {"write_colors": False},
            {"write_colors": False, "write_distortion": False},
            {"write_vertex_groups": False, "prefix": "Second"},
            {"use_modifiers": True},
            DENSE,
            DENSE | {"write_distortion": False, "write_confidence": False, "use_modifiers": True},
        ],
        ids=str,
    )
    def test_is_the_same_as_matching_for_the_other(self, pair, options, monkeypatch):
        bend(pair[0])
        match(alternative=1, **options)
        expected, told = written(), summary_values()
        assert summary().answer == 1
        assert bool(summary().verdict) == options.get("dense", False)
        match(**options)
        assert written() != expected
        no_matching(monkeypatch)
        flip()
        assert written() == expected
        assert summary_values() == told

    def test_what_was_left_out_of_the_match_is_left_out_again(self, pair, monkeypatch):
        for obj in pair:
            heights = np.array([vertex.co.z for vertex in obj.data.vertices])
            high = np.flatnonzero(heights > np.quantile(heights, 0.95))
            obj.vertex_groups.new(name="Top").add(high.tolist(), 1.0, "REPLACE")
        left_out = {"exclude_source": "Top", "exclude_target": "Top"}
        self.test_is_the_same_as_matching_for_the_other(pair, DENSE | left_out, monkeypatch)
        bpy.data.objects["Source"].vertex_groups.remove(bpy.data.objects["Source"].vertex_groups["Top"])
        flip()
        assert summary().answer == 0

    @pytest.mark.parametrize("mirrored", [False, True])
    def test_twice_is_as_before(self, pair, mirrored):
        assert pair
        match(alternative=int(mirrored))
        before = snapshot()
        flip()
        assert (summary().answer > 0) != mirrored
        assert snapshot() != before
        flip()
        assert snapshot() == before

    def test_the_points_of_the_source_stay_and_those_of_the_target_move(self, pair):
        match()
        before = [weights_of(obj) for obj in pair]
        flip()
        after = [weights_of(obj) for obj in pair]
        assert after[0] == before[0]
        assert list(after[1]) == list(before[1])
        moved = [name for name, weights in after[1].items() if weights != before[1][name]]
        assert len(moved) > QUICK["points"] / 2

    def test_several_parts(self, pair):
        merge_part(pair[1])
        match(alternative=1)
        expected = written()
        assert (values_of(pair[1].data.attributes["HM Distortion Value"]) == -1).any()
        match()
        flip()
        assert written() == expected

    def test_moving_the_objects_changes_little(self, pair):
        match(alternative=1)
        expected = [values_of(obj.data.attributes["HM Match"]) for obj in pair]
        match()
        for obj in pair:
            obj.rotation_euler, obj.location, obj.scale = (0.3, -1, 2), (4, 5, 6), (3, 3, 3)
        bpy.context.view_layer.update()
        flip()
        for obj, colours in zip(pair, expected, strict=True):
            assert values_of(obj.data.attributes["HM Match"]) == pytest.approx(colours, abs=1e-3)

    def test_what_is_active_stays(self, pair):
        match()
        for obj in pair:
            obj.data.attributes.active_color_name = "HM Distortion"
            obj.vertex_groups.active_index = 4
        flip()
        for obj in pair:
            assert obj.data.attributes.active_color_name == "HM Distortion"
            assert obj.vertex_groups.active.name == "HM.005"


class TestWhichMatch:
    def test_by_either_object(self, pair):
        match()
        first = snapshot()
        for obj in pair:
            flip(object=obj.name)
            assert summary().answer == 1
            flip(object=obj.name)
            assert snapshot() == first

    def test_the_active_object_when_there_is_no_summary(self, pair):
        match()
        bpy.context.scene.hiermatch.property_unset("summary")
        with pytest.raises(RuntimeError, match="There is no match to flip"):
            flip()
        bpy.context.view_layer.objects.active = pair[1]
        flip()
        assert summary().answer == 1
        assert (summary().source, summary().target) == ("Source", "Target")
        assert summary().seconds == 0

    def test_the_last_match_keeps_its_time(self, pair):
        assert pair
        match()
        seconds = summary().seconds
        flip()
        assert summary().seconds == seconds > 0

    def test_one_of_several_prefixes(self, pair):
        match()
        match(prefix="Second")
        second = [weights for name, weights in weights_of(pair[1]).items() if name.startswith("Second")]
        with pytest.raises(RuntimeError, match=r'several matches\. Name the Prefix of one of them: "HM", "Second"'):
            flip(object="Target")
        flip(object="Target", prefix="HM")
        groups = weights_of(pair[1])
        assert [weights for name, weights in groups.items() if name.startswith("Second")] == second
        assert [weights for name, weights in groups.items() if name.startswith("HM")] != second

    def test_renamed_objects(self, pair):
        match()
        pair[0].name, pair[1].name, pair[1].data.name = "One", "Two", "Mesh"
        flip()
        assert summary().answer == 1
        assert (summary().source, summary().target) == ("One", "Two")
        flip(object="Two")
        assert summary().answer == 0

    def test_of_copies_the_ones_that_kept_their_names(self, pair):
        match()
        for obj in pair:
            copy = obj.copy()
            copy.data = obj.data.copy()
            bpy.context.collection.objects.link(copy)
        copies = [mesh_snapshot(bpy.data.objects[f"{name}.001"]) for name in ("Source", "Target")]
        before = written()
        flip()
        assert written() != before
        assert [mesh_snapshot(bpy.data.objects[f"{name}.001"]) for name in ("Source", "Target")] == copies
        pair[0].name = "Renamed"
        with pytest.raises(RuntimeError, match=r'copies of the source of this match: "Renamed", "Source\.001"'):
            flip(object="Target")


def delete(pair):
    bpy.data.objects.remove(pair[1])


def delete_as_a_user_does(pair):
    pair[1].select_set(state=True)
    bpy.ops.object.delete()


def clear_target(_pair):
    bpy.ops.hiermatch.clear(object="Target")


def match_target_anew(_pair):
    add_blob("Other")
    bpy.ops.hiermatch.match(source="Other", target="Target", **QUICK)


def subdivide(pair):
    bpy.context.view_layer.objects.active = pair[1]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")


def rename_and_clear_target(pair):
    pair[1].name = "Renamed"
    bpy.ops.hiermatch.clear(object="Renamed")


def take_its_name(pair):
    rename_and_clear_target(pair)
    pair[0].name = "Target"


STALE = {
    "deleted": (delete, 'The target of this match, "Target", was deleted'),
    "deleted by a user": (delete_as_a_user_does, 'The target of this match, "Target", was deleted'),
    "cleared": (clear_target, '"Target" does not carry this match any more'),
    "renamed and cleared": (
        rename_and_clear_target,
        'The target of this match, "Target", was deleted, or renamed and cleared, or is not in',
    ),
    "cleared, and the other has its name": (
        take_its_name,
        'The target of this match, "Target", was deleted, or renamed',
    ),
    "matched anew": (match_target_anew, '"Target" does not carry this match any more'),
    "subdivided": (subdivide, '"Target" has other vertices or faces than when it was matched'),
    "turned": (lambda pair: pair[1].data.flip_normals(), '"Target" has other vertices or faces'),
    "hidden": (lambda pair: pair[1].hide_set(state=True), '"Target" is hidden'),
    "scaled to nothing": (lambda pair: setattr(pair[1], "scale", (0, 1, 1)), "scale of zero"),
    "shared": (lambda pair: setattr(pair[1], "data", pair[0].data), "does not carry this match"),
    "subdivision": (lambda pair: pair[1].modifiers.new("Finer", "SUBSURF"), '"Finer"'),
}


class TestErrors:
    @pytest.mark.parametrize("change", STALE)
    def test_a_stale_match_is_told_and_nothing_changes(self, pair, change):
        alter, message = STALE[change]
        match(use_modifiers=True)
        alter(pair)
        bpy.context.view_layer.update()
        before = snapshot()
        with pytest.raises(RuntimeError, match=message) as caught:
            flip(object=pair[0].name)
        assert "Traceback" not in str(caught.value)
        assert snapshot() == before

    def test_no_mirrored_answer(self, pair, monkeypatch):
        assert pair
        without_mirrored(monkeypatch)
        match()
        before = snapshot()
        with pytest.raises(RuntimeError, match="has no mirrored answer"):
            flip()
        assert snapshot() == before

    def test_objects_without_a_match(self, pair):
        assert pair
        light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
        bpy.context.collection.objects.link(light)
        for name in ("Source", "Light"):
            with pytest.raises(RuntimeError, match=f'"{name}" carries no match'):
                flip(object=name)
        match()
        with pytest.raises(RuntimeError, match='"Source" carries no match with the Prefix "Other"'):
            flip(object="Source", prefix="Other")
        with pytest.raises(RuntimeError, match='no object called "Nobody"'):
            flip(object="Nobody")

    def test_names_of_the_user_are_not_taken(self, pair):
        match(write_distortion=False)
        for name in ("HM.003 ~", "HM Match ~"):
            pair[1].vertex_groups.new(name=name)
            before = snapshot()
            with pytest.raises(RuntimeError, match=f'"Target" already has a vertex group called "{name}"'):
                flip()
            assert snapshot() == before
            pair[1].vertex_groups.remove(pair[1].vertex_groups[name])

    def test_edit_mode_is_refused_by_the_button(self, pair):
        match()
        bpy.context.view_layer.objects.active = pair[0]
        bpy.ops.object.mode_set(mode="EDIT")
        with pytest.raises(RuntimeError, match="Switch to Object Mode first"):
            flip()
        bpy.ops.object.mode_set(mode="OBJECT")

    def test_a_bug_changes_nothing_and_is_not_swallowed(self, pair, monkeypatch):
        assert pair
        match()

        def broken(*_arguments):
            raise ZeroDivisionError("a bug")

        monkeypatch.setattr("hiermatch.hiermatch_addon.scene.attribute_io.add_values", broken)
        before = snapshot()
        with pytest.raises(RuntimeError, match=r"(?s)Traceback.*ZeroDivisionError: a bug"):
            flip()
        assert snapshot() == before


class TestFile:
    def test_clearing_removes_what_was_kept(self, pair):
        before = snapshot()
        match()
        flip()
        for obj in pair:
            bpy.ops.hiermatch.clear(object=obj.name)
        assert snapshot() == before

    def test_match_flip_save_load_flip_back_and_undo(self, pair, tmp_path):
        assert pair
        match()
        first = snapshot()
        flip()
        flipped = snapshot()
        path = str(tmp_path / "pair.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=path)
        assert snapshot() == flipped
        assert summary().answer == 1
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.hiermatch.flip("EXEC_DEFAULT", True)  # noqa: FBT003
        assert snapshot() == first
        assert summary().answer == 0
        bpy.ops.ed.undo()
        assert snapshot() == flipped
        assert summary().answer == 1
        bpy.ops.ed.redo()
        assert snapshot() == first
        for name in ("Source", "Target"):
            bpy.ops.hiermatch.clear(object=name)
        assert not any("hiermatch" in mesh for mesh in bpy.data.meshes)

    def test_another_file_gets_the_match_with_both_objects(self, pair, tmp_path):
        assert pair
        match(alternative=1)
        expected = written()
        flip()
        path = str(tmp_path / "pair.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True)
        with bpy.data.libraries.load(path) as (_, wanted):
            wanted.objects = ["Source", "Target"]
        for obj in wanted.objects:
            bpy.context.collection.objects.link(obj)
        flip(object="Source")
        assert written() == expected


@pytest.fixture
def tables():
    """Two tables in different meshings, matched densely: the same if they are turned by half."""
    for name, resolution, turn in (("Source", 6, 0.0), ("Target", 6, 0.4)):
        vertices, triangles = table(resolution, turn)
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(vertices, [], triangles)
        bpy.context.collection.objects.link(bpy.data.objects.new(name, mesh))
    bpy.context.view_layer.update()
    match(**DENSE)
    return bpy.data.objects["Source"], bpy.data.objects["Target"]


def is_turned(source, target):
    """Whether the map that is written turns the source by half, and how far it is from that or from leaving it."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    meshes = [read_mesh(obj, depsgraph, use_modifiers=False) for obj in (source, target)]
    found = StoredMaps.read(source, target, map_name("HM")).between(*meshes).source_to_target.positions
    places = meshes[0].vertices
    away = [np.linalg.norm(places * (sign, sign, 1) - found, axis=1).mean() for sign in (1, -1)]
    return away[1] < away[0], min(away)


class TestSeveralAnswers:
    """Of a body that looks the same from several sides."""

    def test_each_is_written_right_and_the_first_comes_back(self, tables, monkeypatch):
        names = summary().answers.splitlines()
        assert names[0] == "direct"
        assert names[-1] == "turned 1"
        assert "maps are about as likely" in summary().verdict
        first, before, told = is_turned(*tables), written(), summary_values()
        no_matching(monkeypatch)
        last = len(names) - 1
        flip(alternative=last)
        assert summary().answer == last
        assert "maps are about as likely" in summary().verdict
        turned, away = is_turned(*tables)
        assert turned != first[0]
        assert max(away, first[1]) < 0.2
        assert "HM Other Map Weights" in tables[0].data.attributes
        flip(alternative=0)
        assert summary_values() == told
        # What was made of the other answer is kept.
        place = last  # among the others, as the direct one is written
        assert f"HM Other Map{'' if place == 1 else f' {place}'} Weights" in tables[0].data.attributes
        kept = written()
        assert kept != before
        flip(alternative=last)
        flip(alternative=0)
        assert written() == kept

    def test_they_travel_in_files(self, tables, tmp_path):
        last = len(summary().answers.splitlines()) - 1
        flip(alternative=last)
        names, expected = summary().answers, is_turned(*tables)
        path = str(tmp_path / "match.json")
        bpy.ops.hiermatch.export_match(filepath=path)
        flip(alternative=0)
        bpy.ops.hiermatch.import_match(filepath=path, source="Source", target="Target")
        assert (summary().answers, summary().answer) == (names, last)
        assert is_turned(*tables) == expected
        flip(alternative=0)
        assert is_turned(*tables)[0] != expected[0]

    def test_a_match_can_write_one_at_once(self, tables):
        last = len(summary().answers.splitlines()) - 1
        flip(alternative=last)
        expected = is_turned(*tables)
        match(alternative=last, **DENSE)
        assert summary().answer == last
        assert is_turned(*tables) == expected

    def test_one_that_does_not_exist_is_told_and_nothing_changes(self, tables):
        assert tables
        before = snapshot()
        count = len(summary().answers.splitlines()) - 1
        with pytest.raises(RuntimeError, match=f"has the alternatives 1 to {count} only"):
            flip(alternative=9)
        assert snapshot() == before


@pytest.mark.computes_anew
class TestInSteps:
    """What happens between two steps."""

    @pytest.fixture
    def job(self, dense_pair):
        return FlipJob(bpy.context, find_half(dense_pair[0]))

    def advance(self, job, seconds=0.0):
        return job.advance(seconds)

    def test_nothing_is_written_before_the_end(self, job):
        before = snapshot()
        fractions = []
        while not self.advance(job):
            fractions.append(job.progress.fraction)
        assert fractions == sorted(fractions)
        assert len(fractions) > 20
        assert snapshot() == before
        assert job.finish().chosen == 1
        assert snapshot() != before

    def test_the_points_lie_on_the_map(self, job, dense_pair):
        while not self.advance(job):
            pass
        stored = job.finish()
        maps = StoredMaps.read(*dense_pair, map_name("HM"))
        depsgraph = bpy.context.evaluated_depsgraph_get()
        source, target = (read_mesh(obj, depsgraph, use_modifiers=False) for obj in dense_pair)
        images = maps.between(source, target).source_to_target.positions[stored.source_points.nearest_vertices]
        points = stored.answer.target_points
        placed = np.einsum("kc,kcd->kd", points.barycentric, target.vertices[points.corners])
        np.testing.assert_allclose(placed, images, atol=1e-5)

    def test_closing_changes_nothing(self, job):
        before = snapshot()
        self.advance(job)
        job.close()
        with pytest.raises(RuntimeError, match="not come to its end"):
            job.finish()
        assert snapshot() == before

    def test_looking_at_something_else_does_not(self, job, dense_pair):
        self.advance(job)
        dense_pair[0].hide_set(state=True)
        while not self.advance(job, 1.0):
            pass
        assert job.finish().chosen == 1

    def test_clearing_meanwhile_ends_it(self, job):
        self.advance(job)
        bpy.ops.hiermatch.clear(object="Source")
        with pytest.raises(ObjectError, match="cleared or matched anew meanwhile"):
            self.advance(job)

    def test_renaming_does_not_matter_and_other_faces_do(self, job, dense_pair):
        self.advance(job)
        dense_pair[0].name = "Renamed"
        while not self.advance(job, 1.0):
            pass
        bpy.context.view_layer.objects.active = dense_pair[1]
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide()
        bpy.ops.object.mode_set(mode="OBJECT")
        with pytest.raises(ObjectError, match="other vertices or faces"):
            job.finish()
