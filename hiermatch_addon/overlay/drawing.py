# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay of the 3D viewports: it uploads what `overlay_data` computed, and draws it.

Everything is kept from one frame to the next, without any reference to Blender's data, and made anew when a list, a
matrix, a setting or the shape of a mesh has changed.  Shaders are made when they are needed first: without a window
there are none.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import blf
import bpy
import gpu
import numpy as np
from bpy.app.handlers import persistent
from gpu_extras.batch import batch_for_shader

from ..common.translated_text import translated
from ..jobs.shown_preview import preview
from .hover_data import hovered, pointed_at
from .overlay_data import Drawing, preview_points, project
from .overlay_io import drawn_objects, read_drawing, settings, signature

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...engine import Preview
    from .overlay_data import PointCloud

_gpu: Any = gpu  # whose functions Blender's stubs declare to return nothing

_BIAS = 2e-4
"""By how much, in normalised depth, what is drawn comes before the surface that it lies on."""

_LETTERS = 11
"""Height of the numbers, in points."""

_REACH = 9.0
"""How near the mouse has to come to a point, in pixels at normal interface scale."""

_RINGS = ((15.0, (0.0, 0.0, 0.0, 0.6)), (12.0, (1.0, 1.0, 1.0, 1.0)))
"""Widths and colors of what is drawn below a point that the mouse is on, the largest first."""


class _Overlay:
    """What is drawn, and the batches on the graphics card that draw it."""

    def __init__(self) -> None:
        self.handles: list[Any] = []
        self.forget()

    def forget(self) -> None:
        """Keep nothing of what was drawn: batches that are left until Blender ends outlive the graphics system."""
        self.pending: tuple[str, int] | None = None
        self.changed = self.edited = False
        self.drawn: frozenset[int] = frozenset()
        self._settings: tuple[object, ...] | None = None
        self._signature: tuple[object, ...] | None = None
        self._drawing = Drawing()
        self._points: list[tuple[Any, Any, float]] = []
        self._lines: list[tuple[Any, float]] = []
        self._label_places: NDArray[np.float64] = np.empty((0, 3))
        self._previewed: tuple[Preview | None, list[tuple[Any, Any, float]]] = (None, [])
        self._shaders: dict[str, Any] = {}

    def update(self, context: bpy.types.Context) -> bool:
        """Bring what is drawn up to date; return whether there is anything to draw."""
        scene, shown = cast("bpy.types.Scene", context.scene), (self._settings, self._signature)
        self._settings = settings(scene, cast("bpy.types.ViewLayer", context.view_layer), self.pending)
        if self._settings is None:
            return False
        if self.changed or self.edited or self._settings != shown[0]:  # else the objects need not be looked up
            self._signature, self.changed = signature(scene), False
        if self._signature is None:
            return False
        if (self._settings, self._signature) != shown or self.edited:
            depsgraph = cast("Any", context.view_layer).depsgraph
            if depsgraph is None:  # not evaluated yet
                self.edited = True
                return False
            self._drawing, self.drawn = read_drawing(scene, depsgraph, self.pending), drawn_objects(scene)
            self.edited = False
            self._upload()
        return True

    def draw_view(self) -> None:
        """Draw lines and points, in the world."""
        context = bpy.context
        space = cast("bpy.types.SpaceView3D", context.space_data)
        if not space.overlay.show_overlays:
            return
        lines, points = (self._lines, self._points) if self.update(context) else ([], [])
        points = [*points, *self._preview_points()]
        if not lines and not points:
            return
        scale = cast("Any", context.preferences).system.ui_scale
        state, matrices, shader = _gpu.state, _gpu.matrix, self._shader("POLYLINE_FLAT_COLOR")
        state.blend_set("ALPHA")
        state.depth_mask_set(False)  # noqa: FBT003 - Blender's own
        if lines:
            shader.bind()
            shader.uniform_float("viewportSize", state.viewport_get()[2:])
        for batch, width in lines:
            shader.uniform_float("lineWidth", width * scale)
            batch.draw(shader)
        with matrices.push_pop_projection():
            projection = matrices.get_projection_matrix()
            projection[2] = projection[2] - _BIAS * projection[3]
            matrices.load_projection_matrix(projection)
            shader = self._point_shader()
            for behind in (True, False):
                state.depth_test_set("GREATER" if behind else "LESS_EQUAL")
                for faint, bright, width in points:
                    state.point_size_set(width * scale)
                    (faint if behind else bright).draw(shader)
        state.depth_test_set("NONE")
        state.depth_mask_set(True)  # noqa: FBT003 - Blender's own
        state.point_size_set(1.0)
        state.blend_set("NONE")

    def draw_pixels(self) -> None:
        """Write the numbers, on the screen."""
        context = bpy.context
        space = cast("bpy.types.SpaceView3D", context.space_data)
        if not space.overlay.show_overlays or not self.update(context) or not self._drawing.labels:
            return
        places, inside = project(self._label_places, *_eye(context))
        blf.size(0, _LETTERS * cast("Any", context.preferences).system.ui_scale)
        blf.enable(0, blf.SHADOW)
        blf.shadow(0, 0, 0, 0, 0, 1)
        for number in np.flatnonzero(inside).tolist():
            label = self._drawing.labels[number]
            blf.color(0, *label.color)
            blf.position(0, places[number, 0] + 6, places[number, 1] + 4, 0)
            blf.draw(0, label.text)
        blf.disable(0, blf.SHADOW)

    def pair_under_mouse(self, context: bpy.types.Context, mouse: tuple[float, float]) -> int:
        """Find the pair that the mouse points at, in the viewport of the context."""
        space = cast("bpy.types.SpaceView3D", context.space_data)
        if not space.overlay.show_overlays or not self.update(context):
            return -1
        reach = _REACH * cast("Any", context.preferences).system.ui_scale
        return pointed_at(self._drawing, *_eye(context), mouse, reach)

    def draw_hovered(self, context: bpy.types.Context, row: int) -> None:
        """Draw over everything the pair that the mouse points at, with its name and its distortion."""
        found = hovered(self._drawing, row, *_eye(context))
        if found is None:
            return
        scale, state = cast("Any", context.preferences).system.ui_scale, _gpu.state
        state.blend_set("ALPHA")
        lines, points = self._shader("POLYLINE_UNIFORM_COLOR"), self._point_shader()
        for width, color in _RINGS:
            if len(found.ends) > 1:
                lines.bind()
                lines.uniform_float("viewportSize", state.viewport_get()[2:])
                lines.uniform_float("lineWidth", width / 4 * scale)
                lines.uniform_float("color", color)
                batch_for_shader(lines, "LINES", {"pos": found.ends}).draw(lines)
            state.point_size_set(width * scale)
            batch_for_shader(points, "POINTS", {"pos": found.ends, "color": [color] * len(found.ends)}).draw(points)
        state.point_size_set(1.0)
        state.blend_set("NONE")
        if found.distortion is None:
            text = translated("Landmark {number}").format(number=found.number)
        else:
            said = translated("Point {number}, distortion {distortion}")
            text = said.format(number=found.number, distortion=f"{found.distortion:.3f}")
        blf.size(0, (_LETTERS + 1) * scale)
        blf.enable(0, blf.SHADOW)
        blf.shadow(0, 3, 0, 0, 0, 1)
        blf.color(0, 1, 1, 1, 1)
        for x, y, _ in found.ends.tolist():
            blf.position(0, x + 12 * scale, y + 8 * scale, 0)
            blf.draw(0, text)
        blf.disable(0, blf.SHADOW)

    def _upload(self) -> None:
        """Make the batches."""
        lines = self._shader("POLYLINE_FLAT_COLOR")
        self._points = [self._point_batches(cloud) for cloud in self._drawing.points]
        self._lines = [
            (batch_for_shader(lines, "LINES", {"pos": group.positions, "color": group.colors}), group.width)
            for group in self._drawing.lines
        ]
        self._label_places = np.array([label.place for label in self._drawing.labels], np.float64).reshape(-1, 3)

    def _point_batches(self, cloud: PointCloud) -> tuple[Any, Any, float]:
        """Make what draws points where a surface hides them, and where they are seen, and their width."""
        shader = self._point_shader()
        faint, bright = (
            batch_for_shader(shader, "POINTS", {"pos": cloud.positions, "color": colors})
            for colors in (cloud.faint, cloud.colors)
        )
        return faint, bright, cloud.width

    def _preview_points(self) -> list[tuple[Any, Any, float]]:
        """Return what draws the coarse map of the job that runs, if there is any."""
        found = preview()
        if found is not self._previewed[0]:
            self._previewed = found, [] if found is None else [self._point_batches(preview_points(found))]
        return self._previewed[1]

    def _shader(self, name: str) -> Any:  # noqa: ANN401 - Blender's stubs leave it open
        if name not in self._shaders:
            self._shaders[name] = _gpu.shader.from_builtin(name)
        return self._shaders[name]

    def _point_shader(self) -> Any:  # noqa: ANN401 - Blender's stubs leave it open
        """Return the shader for points: from 4.5 on there is one of their own, which some graphics systems need."""
        return self._shader("POINT_FLAT_COLOR" if bpy.app.version >= (4, 5, 0) else "FLAT_COLOR")


_overlay = _Overlay()
"""Blender calls functions to draw without telling them for whom; so there is one for all viewports."""


def show_pending(pending: tuple[str, int] | None) -> None:
    """Show a vertex of the object of that name as one that waits for its partner, or none."""
    _overlay.pending = pending


def pair_under_mouse(context: bpy.types.Context, mouse: tuple[float, float]) -> int:
    """Return the row of the pair that the mouse points at, matched points before landmarks; -1 if there is none."""
    return _overlay.pair_under_mouse(context, mouse)


def draw_hovered(context: bpy.types.Context, row: int) -> None:
    """Draw that pair over everything."""
    _overlay.draw_hovered(context, row)


def start_overlay() -> None:
    """Let the viewports be drawn over."""
    for draw, when in ((_overlay.draw_view, "POST_VIEW"), (_overlay.draw_pixels, "POST_PIXEL")):
        _overlay.handles.append(bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", when))
    for handlers, function in _handlers():
        handlers.append(function)


def stop_overlay() -> None:
    """Undo `start_overlay`."""
    for handlers, function in _handlers():
        if function in handlers:  # another add-on may have cleared the list
            handlers.remove(function)
    while _overlay.handles:
        bpy.types.SpaceView3D.draw_handler_remove(_overlay.handles.pop(), "WINDOW")
    _overlay.forget()


def _handlers() -> tuple[tuple[list[Any], Any], ...]:
    handlers: Any = bpy.app.handlers
    return (handlers.depsgraph_update_post, _on_update), (handlers.frame_change_post, _on_frame)


def _eye(context: bpy.types.Context) -> tuple[NDArray[np.float64], tuple[int, int]]:
    """Return the perspective matrix of the viewport that is drawn, and its size in pixels."""
    region, view = cast("Any", context).region, cast("Any", context).region_data
    return np.array(view.perspective_matrix, np.float64), (region.width, region.height)


@persistent  # type: ignore[untyped-decorator]
def _on_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Look the objects up again, and where their vertices are if the shape of what is drawn has changed."""
    _overlay.changed = True
    updates: Any = depsgraph.updates
    if any(update.is_updated_geometry and update.id.original.session_uid in _overlay.drawn for update in updates):
        _overlay.edited = True


@persistent  # type: ignore[untyped-decorator]
def _on_frame(*_arguments: object) -> None:
    """Look again where the vertices are: what a new frame moves is told as no update."""
    _overlay.edited = True
