# SPDX-License-Identifier: GPL-3.0-or-later
"""The mouse over the drawn pairs: the one that it points at is highlighted, and a click makes it the active one.

Blender tells a gizmo where the mouse is and draws it anew when what lies under the mouse has changed; so nothing is
drawn or computed while the mouse rests, and nothing is left when the class is unregistered.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from .drawing import draw_hovered, pair_under_mouse

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_GT_hover(bpy.types.Gizmo):
    """The pair of places under the mouse."""

    bl_idname = "HIERMATCH_GT_hover"

    __slots__ = ("row",)

    def setup(self) -> None:
        """Begin with nothing under the mouse."""
        self.row = -1

    def test_select(self, context: bpy.types.Context, location: Any) -> int:  # noqa: ANN401 - two numbers
        """Return the row of the pair under the mouse, so that another row counts as another part of the gizmo."""
        self.row = pair_under_mouse(context, (location[0], location[1]))
        return self.row

    def draw(self, context: bpy.types.Context) -> None:
        """Draw it, while the mouse is on it."""
        if self.is_highlight:
            draw_hovered(context, self.row)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Make it the active one in its list, and let the click go on to whatever else it means."""
        steering = cast("Any", context.scene).hiermatch_steering
        points = len(steering.pairs) if steering.show_points else 0
        if self.row >= points:
            steering.landmark_index = self.row - points
        elif self.row >= 0:
            steering.pair_index = self.row
        return {"FINISHED"}

    def modal(
        self,
        _context: bpy.types.Context,
        _event: bpy.types.Event,
        _tweak: Any,  # noqa: ANN401 - Blender's own
    ) -> set[OperatorReturnItems]:
        """Never run: Blender asks `invoke` only of gizmos that have this, too."""
        return {"FINISHED"}


class HIERMATCH_GGT_hover(bpy.types.GizmoGroup):
    """Wherever the overlay is drawn."""

    bl_idname = "HIERMATCH_GGT_hover"
    bl_label = "HierMatch Pairs"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"PERSISTENT"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Only while the pairs are drawn."""
        return bool(cast("Any", context.scene).hiermatch_steering.show_overlay)

    def setup(self, _context: bpy.types.Context) -> None:
        """Add the gizmo."""
        self.gizmos.new(HIERMATCH_GT_hover.bl_idname)
