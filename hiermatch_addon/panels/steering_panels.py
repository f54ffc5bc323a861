# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels for steering a match, in the sidebar: landmarks, matched points, and what the viewport shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import layout_of, mesh_of, window_manager_of
from ..jobs.job_operator import JobOperator
from ..jobs.running import running_panel
from ..properties.panel_state import state_of
from ..properties.steering_lists import steered_pair
from ..properties.steering_properties import steering_of
from ..scene.character import parts_of
from ..storage.views.views import VIEW_ITEMS, attribute_of
from .panel_text import draw_label
from .progress_bar import draw_progress
from .sidebar import SidebarPanel

if TYPE_CHECKING:
    from ..properties.steering_properties import HIERMATCH_PG_landmark, HIERMATCH_PG_pair


class HIERMATCH_UL_landmarks(bpy.types.UIList):
    """The landmarks of source and target."""

    bl_idname = "HIERMATCH_UL_landmarks"

    def draw_item(  # type: ignore[override]
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _data: Any,  # noqa: ANN401 - Blender's own
        item: HIERMATCH_PG_landmark,
        _icon: int,
        _active_data: Any,  # noqa: ANN401 - Blender's own
        _active_name: str,
    ) -> None:
        """Draw a landmark: on or off, number, vertices, and the buttons for it."""
        row: Any = layout.row(align=True)
        icon = "CHECKBOX_HLT" if item.use else "CHECKBOX_DEHLT"
        switch = row.operator("hiermatch.switch_landmark", text="", icon=icon, emboss=False)
        switch.number, switch.use = item.number, not item.use
        number = row.row()
        number.ui_units_x = 1.2
        number.label(text=str(item.number), translate=False)  # as it stands in the viewport
        name = row.row()
        name.active = item.use
        name.prop(item, "label", text="", emboss=False)
        row.operator("hiermatch.select_landmark", text="", icon="RESTRICT_SELECT_OFF").number = item.number
        row.operator("hiermatch.remove_landmark", text="", icon="X").number = item.number


class HIERMATCH_UL_pairs(bpy.types.UIList):
    """The matched points, the worst first."""

    bl_idname = "HIERMATCH_UL_pairs"

    def draw_item(  # type: ignore[override]
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _data: Any,  # noqa: ANN401 - Blender's own
        item: HIERMATCH_PG_pair,
        _icon: int,
        _active_data: Any,  # noqa: ANN401 - Blender's own
        _active_name: str,
    ) -> None:
        """Draw a matched point: name, distortion, and the buttons for it."""
        row: Any = layout.row(align=True)
        row.label(text=item.name, translate=False)
        row.label(text=f"{item.distortion:.3f}", translate=False)
        icon = "LOCKED" if item.locked else "UNLOCKED"
        row.operator("hiermatch.lock_pair", text="", icon=icon, depress=item.locked).number = item.number
        row.operator("hiermatch.select_pair", text="", icon="RESTRICT_SELECT_OFF").number = item.number
        row.operator("hiermatch.remove_pair", text="", icon="X").number = item.number


class HIERMATCH_PT_landmarks(SidebarPanel, bpy.types.Panel):
    """Correct a match by naming what corresponds."""

    bl_label = "Landmarks"
    bl_idname = "HIERMATCH_PT_landmarks"
    bl_parent_id = "HIERMATCH_PT_match"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list of landmarks, what can be done with all of them, and the button that refines the match."""
        layout: Any = layout_of(self)
        steering = steering_of(context)
        layout.active = state_of(context).use_landmarks
        layout.operator("hiermatch.guide_me", icon="LIGHT_SUN")
        row = layout.row(align=True)
        row.operator("hiermatch.pick_landmarks", icon="EYEDROPPER")
        row.operator("hiermatch.add_landmark", text="", icon="ADD")
        if steered_pair(cast("bpy.types.Scene", context.scene)) is None:
            draw_label(layout, "Pick Source and Target first", "INFO")
            return
        layout.template_list(
            "HIERMATCH_UL_landmarks", "", steering, "landmarks", steering, "landmark_index", rows=3, maxrows=8
        )
        row = layout.row(align=True)
        row.operator("hiermatch.mirror_landmarks", text="Mirror", icon="MOD_MIRROR")
        row.operator("hiermatch.save_landmarks", text="", icon="EXPORT")
        row.operator("hiermatch.load_landmarks", text="", icon="IMPORT")
        row.operator("hiermatch.clear_landmarks", text="", icon="TRASH")
        if len(steering.pairs):
            _draw_refine(layout, context)


class HIERMATCH_PT_overlay(SidebarPanel, bpy.types.Panel):
    """See in the viewport what corresponds."""

    bl_label = "Show"
    bl_idname = "HIERMATCH_PT_overlay"
    bl_parent_id = "HIERMATCH_PT_match"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what the colors of the meshes and the overlay show."""
        layout: Any = layout_of(self)
        steering = steering_of(context)
        shown = _shown_view(context)
        grid = layout.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
        for view, name, _ in VIEW_ITEMS:
            grid.operator("hiermatch.show", text=name, depress=shown == view).view = view
        layout.operator("hiermatch.write_regions", icon="GROUP_VERTEX")
        layout.separator()
        layout.prop(steering, "show_overlay", toggle=True, icon="OVERLAY")
        row = layout.row(align=True)
        row.active = steering.show_overlay
        for name in ("show_points", "show_lines", "show_labels"):
            row.prop(steering, name, toggle=True)


class HIERMATCH_PT_pairs(SidebarPanel, bpy.types.Panel):
    """Judge the matched points one by one, and refine the match."""

    bl_label = "Matched Points"
    bl_idname = "HIERMATCH_PT_pairs"
    bl_parent_id = "HIERMATCH_PT_match"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list of matched points, the worst first, and the button that refines the match."""
        layout: Any = layout_of(self)
        steering = steering_of(context)
        if not len(steering.pairs):
            draw_label(layout, "There is no match yet", "INFO")
            return
        layout.template_list("HIERMATCH_UL_pairs", "", steering, "pairs", steering, "pair_index", rows=4, maxrows=12)
        _draw_refine(layout, context)


def _draw_refine(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the button that refines the match, or how far that is."""
    if running_panel(window_manager_of(context)) == JobOperator.panel:
        draw_progress(layout, context, JobOperator.panel)
    else:
        layout.operator("hiermatch.refine", icon="MOD_SMOOTH")


def _shown_view(context: bpy.types.Context) -> str:
    """Return which view a viewport shows of the match, by the active colors of the source."""
    pair, prefix = steered_pair(cast("bpy.types.Scene", context.scene)), state_of(context).summary.prefix
    shading = cast("bpy.types.SpaceView3D", context.space_data).shading
    if pair is None or shading.type != "SOLID" or shading.color_type != "VERTEX":
        return "NONE"
    color = mesh_of(parts_of(pair[0])[0]).attributes.active_color_name
    views = (view for view, _, _ in VIEW_ITEMS if view != "NONE")
    return next((view for view in views if attribute_of(prefix, view) == color), "NONE")
