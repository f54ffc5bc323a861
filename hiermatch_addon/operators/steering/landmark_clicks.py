# SPDX-License-Identifier: GPL-3.0-or-later
"""Common base of the operators that wait for clicks on corresponding places of two meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, cast

import bpy
from bpy_extras import view3d_utils

from ....engine import HierMatchError
from ...common.access import window_manager_of
from ...common.errors import ObjectError
from ...common.redraw import redraw_views
from ...common.translated_text import translated
from ...jobs.running import Startable, is_running, modal_operators
from ...overlay.drawing import show_pending
from ...properties.steering_lists import sync_lists
from ...properties.steering_properties import steering_of
from ...scene.character import SideReference, parts_of, vertex_count, vertex_ranges
from ...storage.landmarks import add_landmarks, find_landmarks, read_marks
from .landmark_operator import pick_pair, steerable_pair, told_of_others
from .landmark_picking import cast_ray, places_around
from .viewports import is_in_viewport, viewport_at

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...scene.character import Side
    from ...storage.landmarks import Landmark
    from .landmark_picking import Hit
    from .viewports import Viewport

_MOVES: Final = ("MOUSEMOVE", "INBETWEEN_MOUSEMOVE")
"""Events of which there are many, and that change nothing."""

_LOOKS: Final = 0.2
"""Seconds from one look at what Undo has done to the next: soon enough for who reads what to click on next."""

_REACH: Final = 12
"""How far beside a mesh a click still counts as one on it, in pixels."""


@dataclass(frozen=True)
class _Click:
    """The first place of a pair: the vertex of the source (0) or the target (1), and how many this had then."""

    side: int
    vertex: int
    count: int


class LandmarkClicks(Startable):
    """To be inherited from before `bpy.types.Operator`; each pair of clicks is a step of its own to undo."""

    _sides: tuple[SideReference, SideReference]
    _pending: _Click | None
    replaced = False  # whether another one waits for clicks now
    had_overlay = False  # whether the overlay was shown before
    _timer: bpy.types.Timer | None = None  # without it an Undo would be noticed with the next event only

    def execute(self, _context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Say what scripts are to use."""
        self.report(
            {"ERROR"}, translated("There is nothing to click on. Use hiermatch.add_landmark with two vertices.")
        )
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Wait for clicks, in the place of who does so already."""
        try:
            source, target = steerable_pair(context)
        except HierMatchError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        pick_pair(context, source, target)
        self._wait_for(source, target)
        manager: Any = window_manager_of(context)
        self.had_overlay = steering_of(context).show_overlay
        for _, other in modal_operators(manager):
            if isinstance(other, LandmarkClicks) and not other.replaced:
                other.replaced, self.had_overlay = True, other.had_overlay
        steering_of(context).show_overlay = True
        self._timer = manager.event_timer_add(_LOOKS, window=context.window)
        manager.modal_handler_add(self)
        self._show_status(context)
        return {"RUNNING_MODAL"}

    def _wait_for(self, source: Side, target: Side) -> None:
        """Begin with nothing clicked on yet."""
        self._sides, self._pending = (SideReference.of(source), SideReference.of(target)), None
        self._made: list[Landmark] = []  # as far as Undo has not taken them back
        self._undone: list[Landmark] = []

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Wait on, unless another one waits instead, or other work of ours has begun."""
        working = is_running(window_manager_of(context))
        if self.replaced or working:
            if self.replaced:
                self._stop_timer(context)
            else:
                self.cancel(context)
            return {"FINISHED", "PASS_THROUGH"}
        if event.type not in _MOVES and self._follow_undo():
            steering_of(context).show_overlay = True  # Undo may have brought back that it was off
            self._show_status(context)
        return self._handle(context, event)

    def _handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Take a click in a viewport, or a key over one; leave everything else to Blender."""
        viewport = viewport_at(context, event.mouse_x, event.mouse_y) if event.value == "PRESS" else None
        back = is_key(context, event, "ESC") or (event.type == "RIGHTMOUSE" and viewport is not None)
        if back or is_key(context, event, "RET", "NUMPAD_ENTER"):
            if self._pending is not None and back:
                self._pending = None
                self._show_status(context)
                return {"RUNNING_MODAL"}
            self.cancel(context)
            if not back:
                self._done(context)
            return {"FINISHED"}
        if viewport is None or event.type != "LEFTMOUSE" or event.alt:
            return {"PASS_THROUGH"}
        meant_for_us = context.mode == "OBJECT"  # in another mode the click does there what it always does
        try:
            self._check_modes()
            if meant_for_us:
                self._take(context, self._hit(context, viewport, (event.mouse_x, event.mouse_y)))
        except HierMatchError as error:
            self.report({"WARNING"}, translated(str(error)))
        self._show_status(context)
        return {"RUNNING_MODAL"} if meant_for_us else {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Leave the viewport as it was; Blender itself calls this when it loads a file or closes the window."""
        show_pending(None)
        self._stop_timer(context)
        if context.scene is not None:
            steering_of(context).show_overlay = self.had_overlay
        for workspace in bpy.data.workspaces:
            workspace.status_text_set(None)
        for screen in bpy.data.screens:  # also of workspaces that were shown meanwhile
            _say_in_viewports(screen, None)
        redraw_views(window_manager_of(context))

    def _stop_timer(self, context: bpy.types.Context) -> None:
        if self._timer is not None:
            window_manager_of(context).event_timer_remove(self._timer)
            self._timer = None

    def _hit(self, context: bpy.types.Context, viewport: Viewport, mouse: tuple[int, int]) -> Hit | None:
        """Find what was clicked on, or just beside."""
        region, view = viewport.region, viewport.view
        sides = self._found()
        asked = [[part for number in numbers for part in parts_of(sides[number])] for numbers in self._asked()]
        for x, y in places_around(_REACH * cast("Any", context.preferences).system.ui_scale):
            place = (mouse[0] - region.x + x, mouse[1] - region.y + y)
            origin = view3d_utils.region_2d_to_origin_3d(region, view, place)
            direction = view3d_utils.region_2d_to_vector_3d(region, view, place)
            hits = (cast_ray(context, parts, origin, direction, viewport.space) for parts in asked)
            hit = next(filter(None, hits), None)
            if hit is not None:
                return hit
        return None

    def _asked(self) -> list[tuple[int, ...]]:
        """Return which sides a click may be meant for, those first that are asked for: the two may overlap."""
        first = self._pending
        return [(0, 1)] if first is None else [(1 - first.side,), (first.side,)]

    @property
    def _names(self) -> tuple[str, str]:
        """What the two sides are called now, or were called if one is gone."""
        found = [reference.find() for reference in self._sides]
        names = [
            reference.name if side is None else side.name for side, reference in zip(found, self._sides, strict=True)
        ]
        return names[0], names[1]

    def _found(self) -> tuple[Side, Side]:
        """Look the two sides up again."""
        source, target = (reference.find() for reference in self._sides)
        if source is None or target is None:
            raise ObjectError("One of the two meshes was deleted. Press Esc and start again.")
        return source, target

    def _check_modes(self) -> None:
        for side in self._found():
            for part in parts_of(side):
                if part.mode != "OBJECT":
                    raise ObjectError(
                        f'"{part.name}" is in {part.mode.replace("_", " ").title()} Mode. Leave it first.'
                    )

    def _clicked(self, hit: Hit) -> _Click:
        """Return which side was hit, and the number of the vertex there, counted through all its parts."""
        sides = self._found()
        number = 0 if hit.obj in parts_of(sides[0]) else 1
        side = sides[number]
        start = vertex_ranges(side)[parts_of(side).index(hit.obj)].start
        return _Click(number, start + hit.vertex, vertex_count(side))

    def _take(self, context: bpy.types.Context, hit: Hit | None) -> None:
        """Keep the first place of a pair, or make a landmark of both."""
        if hit is None:
            raise ObjectError(f'Click on "{self._names[0]}" or on "{self._names[1]}".')
        clicked = self._clicked(hit)
        first = self._pending
        if first is None or first.side == clicked.side:
            self._pending = clicked
            return
        source, target = self._found()
        edited = (source, target)[first.side]
        if vertex_count(edited) != first.count:
            self._pending = None
            raise ObjectError(f'"{edited.name}" was edited since the click on it. Click on its place again.')
        pair = (first.vertex, clicked.vertex) if first.side == 0 else (clicked.vertex, first.vertex)
        before = [read_marks(side) for side in (source, target)]
        (added,) = add_landmarks(source, target, [pair], self._place_name())
        if others := told_of_others((source, target), before):
            self.report({"INFO"}, translated(others))
        self._made = [*(mark for mark in self._made if mark.number != added.number), added]  # one may have moved
        self._pending, self._undone = None, []
        sync_lists(cast("bpy.types.Scene", context.scene))
        steering = steering_of(context)
        numbers = [item.number for item in steering.landmarks]
        steering.landmark_index = numbers.index(added.number)
        bpy.ops.ed.undo_push(message=f"Landmark {added.number}")

    def _follow_undo(self) -> bool:
        """Count what Undo has taken back no longer, and what Redo has brought again; tell whether there was any."""
        if not self._made and not self._undone:
            return False
        source, target = (reference.find() for reference in self._sides)
        there = set() if source is None or target is None else {_key(mark) for mark in find_landmarks(source, target)}
        every, count = [*self._made, *self._undone], len(self._made)
        kept = next((number for number, mark in enumerate(every) if _key(mark) not in there), len(every))
        self._made, self._undone = every[:kept], every[kept:]
        return kept != count

    def _show_status(self, context: bpy.types.Context) -> None:
        """Say what to click on next, and show what was clicked on."""
        first = self._pending
        show_pending(None if first is None else (self._names[first.side], first.vertex))
        said = translated(f"{self._prompt()}    Landmarks added: {len(self._made)}    Enter: done    Esc: back")
        if context.workspace is not None:
            context.workspace.status_text_set(said)
        if context.screen is not None:
            _say_in_viewports(context.screen, said)
        redraw_views(window_manager_of(context))

    def _prompt(self) -> str:
        """Say what to click on next."""
        if self._pending is None:
            return f'Click on a place of "{self._names[0]}" or "{self._names[1]}"'
        return f'Click on the corresponding place of "{self._other}"'

    @property
    def _other(self) -> str:
        """The mesh whose place is still to be clicked on."""
        return self._names[1 - cast("_Click", self._pending).side]

    def _place_name(self) -> str:
        """Return what the landmark is called that is added next; empty for no name of its own."""
        return ""

    def _done(self, context: bpy.types.Context) -> None:
        """Go on after Enter."""


def is_key(context: bpy.types.Context, event: bpy.types.Event, *names: str) -> bool:
    """Tell whether one of some keys is pressed alone, while the mouse is in a 3D viewport or on what lies over one."""
    held = event.alt or event.ctrl or event.oskey or event.shift
    pressed = event.type in names and event.value == "PRESS" and not held
    return pressed and is_in_viewport(context, event.mouse_x, event.mouse_y)


def _key(landmark: Landmark) -> tuple[int, int, int]:
    return landmark.number, landmark.source, landmark.target


def _say_in_viewports(screen: bpy.types.Screen, text: str | None) -> None:
    """Write something into the headers of all 3D viewports, where the eyes are; None takes it away."""
    for area in screen.areas:
        if area.type == "VIEW_3D":
            area.header_text_set(cast("str", text))
