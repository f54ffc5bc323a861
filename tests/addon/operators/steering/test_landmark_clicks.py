# SPDX-License-Identifier: GPL-3.0-or-later
"""What waits for clicks lives with all that is done between two clicks."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.operators.steering import landmark_clicks
from hiermatch.hiermatch_addon.operators.steering.landmark_picking import Hit, places_around
from hiermatch.hiermatch_addon.operators.steering.viewports import Viewport
from hiermatch.hiermatch_addon.overlay import overlay_io
from hiermatch.hiermatch_addon.storage.landmarks import add_landmarks, clear_landmarks, find_landmarks


class Clicks(landmark_clicks.LandmarkClicks):
    """The operator without Blender around it."""

    def __init__(self, make_event):
        self.make_event = make_event
        self.reports = []

    def report(self, _kind, text):
        self.reports.append(text)

    def event(self, kind, **where):
        return self.modal(bpy.context, self.make_event(kind, **where))

    def click(self, obj, vertex):
        self._take(bpy.context, Hit(obj, vertex))


@pytest.fixture
def clicks(pair, press, over_viewport):
    assert over_viewport is None
    clicks = Clicks(press)
    clicks._wait_for(*pair)  # noqa: SLF001
    return clicks


def ends_of(landmarks):
    return [(landmark.source, landmark.target) for landmark in landmarks]


def test_a_mesh_that_was_edited_since_its_click_is_asked_for_again(clicks, pair):
    add_landmarks(*pair, [(1, 2)])
    last = len(pair[0].data.vertices) - 1
    clicks.click(pair[0], last)
    pair[0].data.clear_geometry()
    pair[0].data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    with pytest.raises(ObjectError, match='"Source" was edited since'):
        clicks.click(pair[1], 7)
    clicks.click(pair[0], 2)
    clicks.click(pair[1], 7)
    assert (2, 7) in ends_of(find_landmarks(*pair))


def test_a_mesh_may_be_renamed_between_two_clicks(clicks, pair):
    clicks.click(pair[0], 3)
    pair[0].name = "Renamed"
    assert clicks._prompt() == 'Click on the corresponding place of "Target"'  # noqa: SLF001
    clicks.click(pair[1], 7)
    assert ends_of(find_landmarks(*pair)) == [(3, 7)]
    assert '"Renamed"' in clicks._prompt()  # noqa: SLF001


@pytest.mark.parametrize(("pending", "count"), [(("Source", 3), 1), (("Renamed", 3), 0), (("Source", 10**6), 0)])
def test_a_place_is_drawn_unless_it_is_gone(pair, pending, count):
    assert pair[0].name == "Source"
    bpy.context.scene.hiermatch_steering.show_overlay = True
    drawn = overlay_io.read_drawing(bpy.context.scene, bpy.context.evaluated_depsgraph_get(), pending)
    assert len(drawn.points) == count


def test_undo_and_redo_are_counted(clicks, pair):
    clicks.click(pair[0], 3)
    clicks.click(pair[1], 7)
    clear_landmarks(*pair)
    clicks.event("Z")
    assert not clicks._made  # noqa: SLF001
    add_landmarks(*pair, [(3, 7)])
    clicks.event("Z")
    assert len(clicks._made) == 1  # noqa: SLF001


def test_a_landmark_that_is_moved_by_a_click_is_counted_once(clicks, pair):
    for vertex in (7, 9):
        clicks.click(pair[0], 3)
        clicks.click(pair[1], vertex)
    clicks.event("A")
    assert ends_of(find_landmarks(*pair)) == ends_of(clicks._made) == [(3, 9)]  # noqa: SLF001


def test_a_landmark_that_is_moved_by_a_click_for_third_meshes_is_told(clicks, pair):
    third = pair[1].copy()
    third.data = pair[1].data.copy()
    bpy.context.collection.objects.link(third)
    for target in (pair[1], third):
        add_landmarks(pair[0], target, [(3, 7)])
    clicks.click(pair[0], 3)
    clicks.click(pair[1], 9)
    assert clicks.reports == ['"Target" had that in common with "Target.001" as well']


def test_only_one_waits_for_clicks_at_a_time(clicks, pair, press, monkeypatch):
    timers, steering = [], bpy.context.scene.hiermatch_steering
    manager = SimpleNamespace(
        windows=[SimpleNamespace(modal_operators=[clicks], screen=SimpleNamespace(areas=[]))],
        modal_handler_add=lambda _operator: None,
        event_timer_add=lambda _seconds, window: object(),  # noqa: ARG005
        event_timer_remove=timers.append,
    )
    clicks.bl_idname = "HIERMATCH_OT_pick_landmarks"
    monkeypatch.setattr(landmark_clicks, "window_manager_of", lambda _context: manager)
    newer = Clicks(press)
    assert newer.invoke(bpy.context, None) == {"RUNNING_MODAL"}
    assert clicks.event("MOUSEMOVE") == {"FINISHED", "PASS_THROUGH"}
    assert newer.event("MOUSEMOVE") == {"PASS_THROUGH"}
    assert pair
    assert steering.show_overlay
    assert not timers
    assert newer.event("ESC") == {"FINISHED"}
    assert len(timers) == 1
    assert not steering.show_overlay  # as before the first of them


def test_an_overlay_that_was_shown_stays(clicks):
    steering = bpy.context.scene.hiermatch_steering
    for shown in (True, False):
        steering.show_overlay, clicks.had_overlay = True, shown
        assert clicks.event("ESC") == {"FINISHED"}
        assert steering.show_overlay == shown


def test_nothing_waits_for_clicks_while_a_match_runs(clicks, monkeypatch):
    running = SimpleNamespace(bl_idname="HIERMATCH_OT_match", panel="HIERMATCH_PT_match")
    manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[running], screen=SimpleNamespace(areas=[]))])
    monkeypatch.setattr(landmark_clicks, "window_manager_of", lambda _context: manager)
    assert clicks.event("TIMER") == {"FINISHED", "PASS_THROUGH"}


@pytest.mark.parametrize(
    ("kind", "where"), [("RIGHTMOUSE", {"x": -5}), ("RIGHTMOUSE", {"x": 900}), ("ESC", {"x": -5}), ("RET", {"x": -5})]
)
def test_what_is_meant_for_another_editor_or_a_sidebar_is_left_to_it(clicks, kind, where):
    assert clicks.event(kind, **where) == {"PASS_THROUGH"}
    assert clicks.event(kind) == {"FINISHED"}


@pytest.mark.parametrize("kind", ["ESC", "RET"])
def test_keys_are_taken_over_a_sidebar_too(clicks, kind):
    """There the mouse is when it begins."""
    assert clicks.event(kind, x=900) == {"FINISHED"}


def test_a_click_in_another_mode_is_left_to_that_mode(clicks, pair):
    bpy.context.view_layer.objects.active = pair[0]
    bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
    try:
        assert clicks.event("LEFTMOUSE") == {"PASS_THROUGH"}
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
    assert clicks.reports == ['"Source" is in Weight Paint Mode. Leave it first.']


def test_a_click_just_beside_a_mesh_counts(clicks, pair, monkeypatch):
    asked = []

    def cast_ray(_context, _parts, origin, *_):
        asked.append(origin)
        return Hit(pair[0], 3) if origin[0] > 7 else None

    view3d = SimpleNamespace(
        region_2d_to_origin_3d=lambda _region, _view, place: place, region_2d_to_vector_3d=lambda *_: None
    )
    monkeypatch.setattr(landmark_clicks, "view3d_utils", view3d)
    monkeypatch.setattr(landmark_clicks, "cast_ray", cast_ray)
    region = SimpleNamespace(x=0, y=0)
    context = SimpleNamespace(preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)))
    assert clicks._hit(context, Viewport(region, None, None), (5, 5)) == Hit(pair[0], 3)  # noqa: SLF001
    assert asked[0] == (5, 5)
    assert clicks._hit(context, Viewport(region, None, None), (-50, 5)) is None  # noqa: SLF001


def test_of_meshes_that_overlap_the_one_that_is_asked_for_is_meant(clicks, pair, monkeypatch):
    """As those do that were imported to the origin."""

    def cast_ray(_context, parts, *_):
        return Hit(min(parts, key=lambda part: part.name), 3)  # the source is in front

    view3d = SimpleNamespace(region_2d_to_origin_3d=lambda *_: None, region_2d_to_vector_3d=lambda *_: None)
    monkeypatch.setattr(landmark_clicks, "view3d_utils", view3d)
    monkeypatch.setattr(landmark_clicks, "cast_ray", cast_ray)
    context = SimpleNamespace(preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)))
    viewport = Viewport(SimpleNamespace(x=0, y=0), None, None)
    for obj in pair:
        hit = clicks._hit(context, viewport, (5, 5))  # noqa: SLF001
        assert hit.obj == obj
        clicks._take(bpy.context, hit)  # noqa: SLF001


def test_what_is_nearer_to_a_click_is_looked_at_first():
    distances = [(x**2 + y**2) ** 0.5 for x, y in places_around(12)]
    assert distances == pytest.approx(sorted(distances))
    assert max(distances) == pytest.approx(12)
