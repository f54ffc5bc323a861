# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel for clothes, in the sidebar: it shows stored state and computes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..common.access import layout_of, view_layer_of
from ..properties.panel_state import state_of
from ..transfers.options.wear import WearOptions
from ..transfers.retarget_properties import copy_named, retarget_of
from .progress_bar import draw_progress
from .retarget_panels import draw_report

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["HIERMATCH_PT_wear"]


class HIERMATCH_PT_wear(bpy.types.Panel):
    """Fit clothes to another body."""

    bl_label = "Wear"
    bl_idname = "HIERMATCH_PT_wear"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "HierMatch"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw how the active item fits, the options, and the button."""
        layout = layout_of(self)
        layout.use_property_split = True
        layout.use_property_decorate = False
        active, state = view_layer_of(context).objects.active, state_of(context)
        if active is not None and active.type == "MESH" and active not in (state.source, state.target):
            box = layout.box().column()
            box.label(text=active.name, icon="MATCLOTH", translate=False)
            item: Any = active
            box.prop(item.hiermatch_wear, "fit")
            box.prop(item.hiermatch_wear, "find_rigid")
        options: Any = retarget_of(context)
        names: Iterable[str] = tuple(WearOptions.__annotations__)
        for name in names:
            layout.prop(options, name)
        if draw_progress(layout, context, self.bl_idname):
            return
        row = layout.row()
        row.scale_y = 1.5
        copy_named(options, row.operator("hiermatch.wear", icon="MATCLOTH"), [*names, "refine"])
        draw_report(layout, context, options.report)
