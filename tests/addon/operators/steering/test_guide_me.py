# SPDX-License-Identifier: GPL-3.0-or-later
"""Guide Me asks for places by name, lets any be left out, and matches again."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.operators.steering import guide_me
from hiermatch.hiermatch_addon.operators.steering.landmark_picking import Hit
from hiermatch.hiermatch_addon.storage.landmarks import (
    add_landmarks,
    clear_landmarks,
    find_landmarks,
    remove_landmark,
    rename_landmark,
)


class Guided(guide_me.Guide):
    """The operator without Blender around it."""

    def __init__(self, make_event):
        self.make_event = make_event
        self.reports = []

    def report(self, kind, text):
        self.reports.append((*kind, text))

    def press(self, key, **where):
        return self.modal(bpy.context, self.make_event(key, **where))

    def click(self, obj, vertex):
        self._take(bpy.context, None if obj is None else Hit(obj, vertex))


@pytest.fixture
def started(monkeypatch):
    """What is started after it."""
    calls = []
    monkeypatch.setattr(guide_me, "start_soon", lambda _context, name, **options: calls.append((name, options)))
    return calls


@pytest.fixture
def guide(pair, started, press, over_viewport):
    assert pair
    assert started == []
    assert over_viewport is None
    guide = Guided(press)
    guide._wait_for(*pair)  # noqa: SLF001
    return guide


def test_places_are_asked_for_in_turn_on_the_source_first(guide, pair):
    assert guide._prompt().startswith('Nose (1 of 6): click on it on "Source"')  # noqa: SLF001
    with pytest.raises(ObjectError, match='Click on "Source" first'):
        guide.click(pair[1], 3)
    guide.click(pair[0], 2)
    guide.click(pair[0], 3)  # which corrects it
    assert 'on "Target"' in guide._prompt()  # noqa: SLF001
    guide.click(pair[1], 5)
    assert guide._prompt().startswith("Left Hand (2 of 6)")  # noqa: SLF001
    (landmark,) = find_landmarks(*pair)
    assert (landmark.source, landmark.target, landmark.name) == (3, 5, "Nose")


def test_a_click_beside_the_meshes_is_told(guide):
    with pytest.raises(ObjectError, match='Click on "Source" first, or press S'):
        guide.click(None, 0)


def test_any_place_can_be_left_out(guide, pair, started):
    answers = [guide.press("S") for _ in range(5)]
    assert set(map(tuple, answers)) == {("RUNNING_MODAL",)}
    assert guide._prompt().startswith("Tail (6 of 6)")  # noqa: SLF001
    assert guide.press("S") == {"FINISHED"}
    assert not find_landmarks(*pair)
    assert not started
    assert "nothing new" in guide.reports[-1][1]


@pytest.mark.parametrize(
    ("key", "where"),
    [("S", {"ctrl": True}), ("S", {"shift": True}), ("S", {"x": -5}), ("TAB", {}), ("SPACE", {}), ("RIGHT_ARROW", {})],
)
def test_other_keys_and_those_for_other_editors_are_left_to_blender(guide, key, where):
    assert guide.press(key, **where) == {"PASS_THROUGH"}
    assert guide._prompt().startswith("Nose (1 of 6)")  # noqa: SLF001


def test_enter_matches_again_with_what_there_is(guide, pair, started):
    bpy.context.scene.hiermatch.use_landmarks = False
    bpy.context.scene.hiermatch.points = 33
    guide.click(pair[0], 3)
    guide.click(pair[1], 5)
    assert guide.press("RET") == {"FINISHED"}
    ((name, options),) = started
    assert name == "hiermatch.match"
    assert (options["source"], options["target"], options["points"]) == ("Source", "Target", 33)
    assert options["use_landmarks"]


def test_escape_matches_nothing(guide, pair, started):
    guide.click(pair[0], 3)
    assert guide.press("ESC") == {"RUNNING_MODAL"}  # forgets the first click
    guide.click(pair[0], 3)
    guide.click(pair[1], 5)
    assert guide.press("ESC") == {"FINISHED"}
    assert not started
    assert len(find_landmarks(*pair)) == 1


def test_what_undo_takes_back_is_asked_for_again(guide, pair):
    for vertices in ((3, 5), (7, 9)):
        guide.click(pair[0], vertices[0])
        guide.click(pair[1], vertices[1])
    assert guide._prompt().startswith("Right Hand (3 of 6)")  # noqa: SLF001
    guide.click(pair[0], 11)
    remove_landmark(*pair, 2)  # as Undo does
    guide.press("Z")
    assert guide._prompt().startswith('Left Hand (2 of 6): click on it on "Source"')  # noqa: SLF001
    add_landmarks(*pair, [(7, 9)], "Left Hand")  # as Redo does
    guide.press("Z")
    assert guide._prompt().startswith("Right Hand (3 of 6)")  # noqa: SLF001
    clear_landmarks(*pair)
    assert guide.press("RET") == {"FINISHED"}
    assert "nothing new" in guide.reports[-1][1]


def test_a_second_round_replaces_the_places_of_the_first(guide, pair):
    for vertices in ((3, 5), (7, 9)):
        guide._step = 0  # noqa: SLF001
        guide.click(pair[0], vertices[0])
        guide.click(pair[1], vertices[1])
    (landmark,) = find_landmarks(*pair)
    assert (landmark.source, landmark.target) == (7, 9)


def test_names_are_kept_with_the_landmarks(pair):
    bpy.ops.hiermatch.add_landmark(source_vertex=3, target_vertex=5)
    row = bpy.context.scene.hiermatch_steering.landmarks[0]
    assert row.label == "Landmark 1"
    row.label = "Left knee"
    assert find_landmarks(*pair)[0].name == "Left knee"
    bpy.ops.hiermatch.switch_landmark(number=1, use=False)
    assert bpy.context.scene.hiermatch_steering.landmarks[0].label == "Left knee"
    bpy.ops.hiermatch.remove_landmark(number=1)
    bpy.ops.hiermatch.add_landmark(source_vertex=3, target_vertex=5)
    assert bpy.context.scene.hiermatch_steering.landmarks[0].label == "Landmark 1"
    rename_landmark(*pair, 1, "Nose")
    rename_landmark(*pair, 1, "")
    assert not find_landmarks(*pair)[0].name


def test_names_go_through_files(pair, tmp_path):
    bpy.ops.hiermatch.add_landmark(source_vertex=3, target_vertex=5)
    rename_landmark(*pair, 1, "Nose")
    path = str(tmp_path / "marks.json")
    bpy.ops.hiermatch.save_landmarks(filepath=path)
    bpy.ops.hiermatch.clear_landmarks()
    bpy.ops.hiermatch.load_landmarks(filepath=path)
    assert [landmark.name for landmark in find_landmarks(*pair)] == ["Nose"]
