# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel for clothes, in the sidebar: it shows stored state and computes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import mesh_of, options_layout, view_layer_of
from ..common.errors import ObjectError
from ..common.translated_text import translated
from ..properties.panel_state import picked, state_of
from ..scene.character import parts_of, side_of
from ..scene.worn.fitted_copies import fitted_to, original_of
from ..scene.worn.garments import bound_items, selected_items
from ..transfers.options.wear import WearOptions
from ..transfers.retarget_properties import copy_named, retarget_of
from ..transfers.wearing.fit_colors import FIT_NAMES, carriers_of_fit
from .panel_text import draw_label, draw_text
from .progress_bar import draw_progress
from .retarget_panels import draw_report
from .sidebar import SidebarPanel

if TYPE_CHECKING:
    from collections.abc import Iterable

_OF_COPIES = frozenset(f"wear_{name}" for name in ("weights", "limit", "normalise", "poses", "keys", "fit_rig"))
"""Options that say nothing of a shape key on the original."""

_SHOWN = 6
"""Names of items in the panel, at most."""


class HIERMATCH_PT_wear(SidebarPanel, bpy.types.Panel):
    """Fit clothes to another body."""

    bl_label = "Wear"
    bl_idname = "HIERMATCH_PT_wear"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw how the active item fits, the options, and the button."""
        layout = options_layout(self)
        active, state = view_layer_of(context).objects.active, state_of(context)
        if active is not None:
            active = _item_of(context, active)
        _draw_items(layout, context)
        if active is not None and active.type == "MESH" and active not in (state.source, state.target):
            box = layout.box().column()
            box.label(text=active.name, icon="MATCLOTH", translate=False)
            item: Any = active
            box.prop(item.hiermatch_wear, "fit")
            box.prop(item.hiermatch_wear, "find_rigid")
        options: Any = retarget_of(context)
        names: Iterable[str] = tuple(WearOptions.__annotations__)
        for name in names:
            if options.wear_result == "OBJECT" or name not in _OF_COPIES:
                layout.prop(options, name)
        if draw_progress(layout, context, self.bl_idname):
            return
        row = layout.row()
        row.scale_y = 1.5
        copy_named(options, row.operator("hiermatch.wear", icon="MATCLOTH"), [*names, "refine"])
        draw_report(layout, context, self.bl_idname, has_before=True)
        _draw_fit(layout, context)


def _draw_fit(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the buttons that show how the items fit, once something carries the colors of it."""
    carriers = carriers_of_fit(view_layer_of(context))
    if not carriers:
        return
    shown, shading = mesh_of(carriers[0]).attributes.active_color_name, cast("Any", context.space_data).shading
    is_seen = (shading.type, shading.color_type) == ("SOLID", "VERTEX") and shown in FIT_NAMES.values()
    draw_label(layout, "Show Fit")
    grid = layout.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    grid.operator("hiermatch.show", text="Nothing", depress=not is_seen).view = "NONE"
    for view, name in FIT_NAMES.items():
        grid.operator("hiermatch.show_fit", text=name, depress=is_seen and shown == name).view = view


def _item_of(context: bpy.types.Context, active: bpy.types.Object) -> bpy.types.Object:
    """Return the item that an object is or stands for: how it fits is kept on it."""
    source = picked(state_of(context))[0]
    if source is not None:
        try:
            worn = fitted_to(side_of(source, view_layer_of(context)))
        except ObjectError:
            worn = []
        if active in worn:
            return active
    return original_of(active) or active


def _draw_items(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw which objects will be fitted, once both bodies are picked."""
    source, target = picked(state_of(context))
    if source is None or target is None:
        return
    layer = view_layer_of(context)
    try:
        body, other = side_of(source, layer), side_of(target, layer)
    except ObjectError:  # its sentence stands where the bodies are picked
        return
    names = selected_items(context, body, [other], named=True)
    names = names or [obj.name for obj in bound_items(context, body) if obj not in parts_of(other)]
    column = layout.box().column(align=True)
    if not names:
        draw_text(column, context, "Select the clothes of the source, or bind them to its armature.", "INFO")
        return
    draw_label(column, "Items")
    for name in names[:_SHOWN]:
        column.label(text=name, icon="MATCLOTH", translate=False)
    if len(names) > _SHOWN:
        column.label(text=translated(f"{len(names) - _SHOWN} more"), icon="BLANK1", translate=False)
