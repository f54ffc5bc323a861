# SPDX-License-Identifier: GPL-3.0-or-later
"""A match in slices, with all that may happen between two of them."""

from __future__ import annotations

from itertools import chain, repeat
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from hiermatch.engine import HierMatchError, MatchSettings, Preview, Progress, SettingsError
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.jobs.match_job import JobOptions, MatchJob
from hiermatch.hiermatch_addon.jobs.shown_preview import preview
from hiermatch.hiermatch_addon.operators.match import HIERMATCH_OT_match

from tests.addon.scenes import QUICK, add_blob, add_pair, snapshot, weights_of

pytestmark = pytest.mark.computes_anew


@pytest.fixture
def pair():
    return add_pair()


@pytest.fixture
def job(pair):
    return start(pair)


def start(pair):
    return MatchJob(bpy.context, *pair, JobOptions(settings=MatchSettings(**QUICK)))


def advance(job, seconds=0.0):
    """Advance by so much time; by one step if that is none."""
    return job.advance(seconds)


def drain(job):
    while not advance(job, 0.01):
        pass
    return job.finish()


def test_nothing_is_written_before_the_end(job):
    before = snapshot()
    fractions = []
    while not advance(job):
        fractions.append(job.progress.fraction)
        assert snapshot() == before
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] < fractions[-1] <= 1
    assert job.progress.label
    job.finish()
    assert snapshot() != before


def test_a_job_that_is_not_done_cannot_be_finished(job):
    before = snapshot()
    with pytest.raises(RuntimeError, match="not come to its end"):
        job.finish()
    assert snapshot() == before


def test_closing_changes_nothing(job):
    before = snapshot()
    advance(job)
    job.close()
    assert snapshot() == before


def test_renaming_moving_and_undoing_do_not_matter(pair):
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.object.empty_add()
    bpy.ops.ed.undo_push(message="Empty")
    job = start(pair)
    advance(job)
    bpy.ops.ed.undo()  # every reference to an object is dead now
    bpy.data.objects["Source"].name = "Renamed"
    bpy.data.objects["Target"].location.y = 7
    outcome = drain(job)
    assert outcome.stored.names == ("Renamed", "Target")
    assert len(weights_of(bpy.data.objects["Renamed"])) == QUICK["points"]


def delete(pair):
    bpy.data.objects.remove(pair[1])


def edit(pair):
    bpy.context.view_layer.objects.active = pair[1]
    bpy.ops.object.mode_set(mode="EDIT")


def load(_pair):
    bpy.ops.wm.read_homefile(use_empty=True)


def subdivide(pair):
    edit(pair)
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")


CHANGES = {
    "deleted": (delete, '"Target" was deleted'),
    "file": (load, "was deleted"),
    "subdivided": (subdivide, "another number of vertices"),
}

CHANGES_AT_THE_END = CHANGES | {
    "edited": (edit, '"Target" is in Edit Mode'),
    "shared": (lambda pair: setattr(pair[1], "data", pair[0].data), "share the same mesh data"),
    "unlinked": (lambda pair: bpy.context.collection.objects.unlink(pair[1]), '"Target" is in no scene'),
}


def hide_its_collection(obj):
    collection = bpy.data.collections.new("Apart")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(obj)
    bpy.context.collection.objects.unlink(obj)
    bpy.context.view_layer.layer_collection.children["Apart"].exclude = True


LOOKS_ELSEWHERE = {
    "hidden": lambda pair: pair[1].hide_set(state=True),
    "hidden collection": lambda pair: hide_its_collection(pair[0]),
    "another scene": lambda _pair: setattr(bpy.context.window, "scene", bpy.data.scenes.new("Other")),
}


@pytest.mark.parametrize("change", LOOKS_ELSEWHERE)
def test_looking_at_something_else_loses_nothing(pair, change):
    job = start(pair)
    advance(job)
    LOOKS_ELSEWHERE[change](pair)
    bpy.context.view_layer.update()
    outcome = drain(job)
    assert outcome.stored.names == ("Source", "Target")
    assert all(len(weights_of(obj)) == QUICK["points"] for obj in pair)


@pytest.mark.parametrize(
    ("change", "at_the_end"),
    [*((change, False) for change in CHANGES), *((change, True) for change in CHANGES_AT_THE_END)],
)
def test_changes_end_the_job_with_a_sentence(pair, change, at_the_end):
    alter, message = CHANGES_AT_THE_END[change]
    job = start(pair)
    while not advance(job, 1.0 if at_the_end else 0.0) and at_the_end:
        pass
    alter(pair)
    bpy.context.view_layer.update()
    before = snapshot()
    with pytest.raises(ObjectError, match=message):
        job.finish() if at_the_end else job.advance(0.0)
    assert snapshot() == before
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def test_other_faces_of_the_same_vertices_are_noticed_at_the_end(pair):
    job = start(pair)
    while not advance(job, 1.0):
        pass
    pair[1].data.flip_normals()
    before = snapshot()
    with pytest.raises(ObjectError, match='The faces of "Target" changed'):
        job.finish()
    assert snapshot() == before


def test_an_object_of_the_same_name_is_not_the_same(pair):
    job = start(pair)
    bpy.data.objects.remove(pair[1])
    add_blob("Target")
    with pytest.raises(ObjectError, match='"Target" was deleted'):
        advance(job)


class Modal:
    """The operator without Blender around it: its own methods on a plain object."""

    _worked, _drawn, _left_out, _named = 0.0, 0.0, "", False
    doing, cancelled = HIERMATCH_OT_match.doing, HIERMATCH_OT_match.cancelled
    invoke, modal, cancel = HIERMATCH_OT_match.invoke, HIERMATCH_OT_match.modal, HIERMATCH_OT_match.cancel
    _finish, _show_progress = HIERMATCH_OT_match._finish, HIERMATCH_OT_match._show_progress  # noqa: SLF001

    def __init__(self, job):
        manager = bpy.context.window_manager
        self._job, self._workspace, self.prefix = job, bpy.context.workspace.name, "HM"
        self._scene = bpy.context.scene.name
        self._timer = manager.event_timer_add(0.01, window=bpy.context.window)
        manager.hiermatch.cancel = False
        self.reports = []

    def report(self, kind, text):
        self.reports.append((*kind, text))

    def send(self, kind, value="PRESS", *, repeat=False):
        return self.modal(bpy.context, SimpleNamespace(type=kind, value=value, is_repeat=repeat))


@pytest.fixture
def operator(job):
    return Modal(job)


def test_the_timer_drives_it_to_the_end(operator):
    answers = [operator.send("TIMER")]
    while answers[-1] == {"PASS_THROUGH"}:
        answers.append(operator.send("TIMER"))
    assert answers[-1] == {"FINISHED"}
    assert operator.reports[-1][0] == "INFO"
    assert "Matched 12 points" in operator.reports[-1][1]
    assert bpy.context.scene.hiermatch.summary.points == QUICK["points"]


def test_the_scene_in_which_it_began_tells_of_it_though_another_is_shown(operator):
    began, other = bpy.context.scene, bpy.data.scenes.new("Other")
    bpy.context.window.scene = other
    try:
        while operator.send("TIMER") == {"PASS_THROUGH"}:
            pass
        assert began.hiermatch.summary.points == QUICK["points"]
        assert not other.hiermatch.summary.points
    finally:
        bpy.context.window.scene = began
        bpy.data.scenes.remove(other)


def test_it_shows_how_far_it_is(operator):
    operator._job._steps = (Progress(share, "Weighing") for share in (0.25, 0.5))  # noqa: SLF001
    operator._job.advance = lambda _seconds: setattr(operator._job, "progress", next(operator._job._steps))  # noqa: SLF001
    for share in (0.25, 0.5):
        assert operator.send("TIMER") == {"PASS_THROUGH"}
        shown = bpy.context.window_manager.hiermatch
        assert (shown.fraction, shown.label) == (pytest.approx(share), "Weighing")
    operator.send("ESC")


def test_a_coarse_map_is_shown_until_it_ends(operator):
    before, found = snapshot(), Preview(np.zeros((2, 3)), np.ones((2, 3)))
    told = [Progress(0.4, "Comparing maps", found), Progress(0.6, "Fitting the surfaces")]
    operator._job._steps = (progress for progress in chain(told, repeat(told[-1])))  # noqa: SLF001
    while operator._job.progress.fraction < 0.6:  # noqa: SLF001
        operator.send("TIMER")
        assert preview() is found
    operator.send("ESC")
    assert preview() is None
    assert snapshot() == before


@pytest.mark.parametrize("event", ["MOUSEMOVE", "MIDDLEMOUSE", "Z"])
def test_other_events_pass(operator, event):
    assert operator.send(event) == {"PASS_THROUGH"}
    operator.send("ESC")


@pytest.mark.parametrize(("value", "repeat"), [("RELEASE", False), ("CLICK", False), ("PRESS", True)])
def test_what_is_left_of_an_escape_that_something_else_took_passes(operator, value, repeat):
    """A grab or a menu that lies in front takes the press only."""
    assert operator.send("ESC", value, repeat=repeat) == {"PASS_THROUGH"}
    assert operator.send("ESC") == {"CANCELLED"}


@pytest.mark.parametrize("way", ["escape", "button"])
def test_cancelling_changes_nothing(operator, way):
    before = snapshot()
    operator._job.advance = lambda _seconds: False  # a long match  # noqa: SLF001
    operator.send("TIMER")
    if way == "button":
        bpy.context.window_manager.hiermatch.cancel = True
    assert operator.send("ESC" if way == "escape" else "MOUSEMOVE") == {"CANCELLED"}
    assert operator.reports == [("INFO", "The match was cancelled. Nothing was written")]
    assert snapshot() == before


def test_a_change_ends_the_run_with_a_message(operator, pair):
    delete(pair)
    assert operator.send("TIMER") == {"CANCELLED"}
    assert operator.reports == [("ERROR", '"Target" was deleted meanwhile. Nothing was written.')]


def test_a_bug_ends_the_run_and_is_raised(operator):
    def broken(_seconds):
        raise ZeroDivisionError

    operator._job.advance = broken  # noqa: SLF001
    with pytest.raises(ZeroDivisionError):
        operator.send("TIMER")
    with pytest.raises(StopIteration):
        next(operator._job._steps)  # noqa: SLF001


def test_the_cancel_button_says_that_nothing_runs():
    with pytest.raises(RuntimeError, match="Nothing is running"):
        bpy.ops.hiermatch.cancel()


def test_errors_of_objects_are_errors_for_the_user():
    assert issubclass(ObjectError, HierMatchError)


@pytest.mark.parametrize(
    ("prefix", "said"), [("  ", "empty"), ("x" * 33, "too long"), ("日本語の長い接頭辞を付ける", "too long")]
)
def test_a_prefix_that_names_cannot_start_with_is_refused(prefix, said):
    with pytest.raises(SettingsError, match=said):
        JobOptions(MatchSettings(), prefix=prefix)
    assert JobOptions(MatchSettings(), prefix="日本語の長い接頭辞").prefix
