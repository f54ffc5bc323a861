# SPDX-License-Identifier: GPL-3.0-or-later
"""Common base of the operators that wait for clicks on corresponding places of two meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy
from bpy_extras import view3d_utils

from ....engine import HierMatchError
from ...common.access import window_manager_of
from ...common.errors import ObjectError
from ...common.redraw import redraw_views
from ...common.translated_text import translated
from ...jobs.running import can_start
from ...overlay.drawing import show_pending
from ...properties.steering_lists import sync_lists
from ...properties.steering_properties import steering_of
from ...scene.character import SideReference, parts_of, vertex_ranges
from ...storage.landmarks import add_landmarks
from .landmark_operator import pick_pair, steerable_pair
from .landmark_picking import cast_ray

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...scene.character import Side
    from .landmark_picking import Hit

    _Operator = bpy.types.Operator
else:
    _Operator = object

__all__ = ["LandmarkClicks"]


class LandmarkClicks(_Operator):
    """To be inherited from before `bpy.types.Operator`; each pair of clicks is a step of its own to undo."""

    _sides: tuple[SideReference, SideReference]
    _pending: tuple[str, int] | None
    _workspace: str
    _added: int

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it in Object Mode, when nothing else is running."""
        return can_start(cast("type[bpy.types.Operator]", cls), context)

    def execute(self, _context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Say what scripts are to use."""
        self.report(
            {"ERROR"}, translated("There is nothing to click on. Use hiermatch.add_landmark with two vertices.")
        )
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Wait for clicks."""
        try:
            source, target = steerable_pair(context)
        except HierMatchError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        pick_pair(context, source, target)
        self._sides, self._pending, self._added = (SideReference.of(source), SideReference.of(target)), None, 0
        self._workspace = context.workspace.name if context.workspace else ""
        steering_of(context).show_overlay = True
        window_manager_of(context).modal_handler_add(self)
        self._show_status(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Take a click in a viewport; leave everything else to Blender."""
        if event.type in ("ESC", "RET", "NUMPAD_ENTER", "RIGHTMOUSE") and event.value == "PRESS":
            back = event.type in ("ESC", "RIGHTMOUSE")
            if self._pending is not None and back:
                self._pending = None
                self._show_status(context)
                return {"RUNNING_MODAL"}
            self.cancel(context)
            if not back:
                self._done(context)
            return {"FINISHED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS" or event.alt:
            return {"PASS_THROUGH"}
        viewport = _viewport_at(context, event.mouse_x, event.mouse_y)
        if viewport is None:
            return {"PASS_THROUGH"}
        try:
            self._take(context, self._hit(context, *viewport, event))
        except HierMatchError as error:
            self.report({"WARNING"}, translated(str(error)))
        self._show_status(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Leave the viewport as it was; Blender itself calls this when it loads a file or closes the window."""
        show_pending(None)
        workspace = bpy.data.workspaces.get(self._workspace)
        if workspace is not None:
            workspace.status_text_set(None)
        _say_in_viewports(context, None)
        redraw_views(window_manager_of(context))

    def _hit(
        self,
        context: bpy.types.Context,
        region: bpy.types.Region,
        view: Any,  # noqa: ANN401 - Blender's stubs leave it open
        event: bpy.types.Event,
    ) -> Hit | None:
        """Find what was clicked on."""
        mouse = (event.mouse_x - region.x, event.mouse_y - region.y)
        origin = view3d_utils.region_2d_to_origin_3d(region, view, mouse)
        direction = view3d_utils.region_2d_to_vector_3d(region, view, mouse)
        return cast_ray(context, [part for side in self._found() for part in parts_of(side)], origin, direction)

    @property
    def _names(self) -> tuple[str, str]:
        return self._sides[0].name, self._sides[1].name

    def _found(self) -> tuple[Side, Side]:
        """Look the two sides up again."""
        source, target = (reference.find() for reference in self._sides)
        if source is None or target is None:
            raise ObjectError("One of the two meshes was deleted. Press Esc and start again.")
        return source, target

    def _clicked(self, hit: Hit) -> tuple[str, int]:
        """Return which side was hit, and the number of the vertex there, counted through all its parts."""
        source, target = self._found()
        side = source if hit.obj in parts_of(source) else target
        return side.name, vertex_ranges(side)[parts_of(side).index(hit.obj)].start + hit.vertex

    def _take(self, context: bpy.types.Context, hit: Hit | None) -> None:
        """Keep the first place of a pair, or make a landmark of both."""
        if hit is None:
            raise ObjectError(f'Click on "{self._names[0]}" or on "{self._names[1]}".')
        clicked = self._clicked(hit)
        if self._pending is None or self._pending[0] == clicked[0]:
            self._pending = clicked
            return
        source, target = self._found()
        vertices = dict([self._pending, clicked])
        pair = (vertices[source.name], vertices[target.name])
        (added,) = add_landmarks(source, target, [pair], self._place_name())
        self._pending = None
        self._added += 1
        sync_lists(cast("bpy.types.Scene", context.scene))
        steering = steering_of(context)
        numbers = [item.number for item in steering.landmarks]
        steering.landmark_index = numbers.index(added.number)
        bpy.ops.ed.undo_push(message=f"Landmark {added.number}")

    def _show_status(self, context: bpy.types.Context) -> None:
        """Say what to click on next, and show what was clicked on."""
        show_pending(self._pending)
        workspace = bpy.data.workspaces.get(self._workspace)
        if workspace is not None:
            said = f"{self._prompt()}    Landmarks added: {self._added}    Enter: done    Esc: back"
            workspace.status_text_set(translated(said))
            _say_in_viewports(context, translated(said))
        redraw_views(window_manager_of(context))

    def _prompt(self) -> str:
        """Say what to click on next."""
        if self._pending is None:
            return f'Click on a place of "{self._names[0]}" or "{self._names[1]}"'
        return f'Click on the corresponding place of "{self._other}"'

    @property
    def _other(self) -> str:
        """The mesh whose place is still to be clicked on."""
        pending = cast("tuple[str, int]", self._pending)
        return next(name for name in self._names if name != pending[0])

    def _place_name(self) -> str:
        """Return what the landmark is called that is added next; empty for no name of its own."""
        return ""

    def _done(self, context: bpy.types.Context) -> None:
        """Go on after Enter."""


def _say_in_viewports(context: bpy.types.Context, text: str | None) -> None:
    """Write something into the headers of all 3D viewports, where the eyes are; None takes it away."""
    for area in context.screen.areas if context.screen else ():
        if area.type == "VIEW_3D":
            area.header_text_set(cast("str", text))


def _viewport_at(context: bpy.types.Context, x: int, y: int) -> tuple[bpy.types.Region, Any] | None:
    """Find the 3D viewport at a place of the window, unless something lies over it there."""
    screen = context.screen
    for area in screen.areas if screen else ():
        inside = [region for region in area.regions if _covers(region, x, y)]
        if area.type == "VIEW_3D" and inside and all(region.type == "WINDOW" for region in inside):
            space: Any = area.spaces.active
            view = space.region_3d if len(inside) == 1 else None
            return None if view is None else (inside[0], inside[0].data or view)
    return None


def _covers(region: bpy.types.Region, x: int, y: int) -> bool:
    return region.x <= x < region.x + region.width and region.y <= y < region.y + region.height and region.width > 1
