# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar, 3D Viewport > Sidebar > HierMatch: it shows stored state and computes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import layout_of, view_layer_of
from ..common.phrases import counted
from ..common.translated_text import translated
from ..properties.panel_state import picked, state_of
from ..properties.properties import copy_options
from ..properties.setting_groups import APART, shown_groups
from ..properties.setups import current_setup
from .panel_text import draw_text
from .preset_menu import HIERMATCH_PT_presets
from .progress_bar import draw_progress, draw_starter

if TYPE_CHECKING:
    from ..properties.properties import HIERMATCH_PG_scene, HIERMATCH_PG_summary

__all__ = ["HIERMATCH_PT_match"]

_NAME_WIDTH = 3.0
"""Width of the names at the top, narrower than a property split makes them: what they stand before is long."""

_WIDE_LETTER = 0.8
"""Width that such a name needs for each letter, if it is Japanese or Chinese."""

_LABEL_SHARE = 0.4
"""Part of the width for the names in the summary, as in a property split."""

_CLEAR_ORIENTATION = 0.3
"""From which agreement on a match is called to keep or to mirror the orientation."""


class HIERMATCH_PT_match(bpy.types.Panel):
    """Choose two meshes, match them, and read how it went."""

    bl_label = "HierMatch"
    bl_idname = "HIERMATCH_PT_match"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "HierMatch"

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the button of the presets."""
        HIERMATCH_PT_presets.draw_panel_header(layout_of(self))

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the panel from top to bottom in the order of work."""
        layout = layout_of(self)
        layout.use_property_split = True
        layout.use_property_decorate = False
        state = state_of(context)
        _draw_pair(layout, context, state)
        _draw_setup(layout, state)
        layout.prop(state, "points")
        switches = layout.column()
        for name in (*(name for name in APART if name != "points"), "use_modifiers", "use_landmarks"):
            switches.prop(state, name)
        _draw_regions(layout, state)
        _draw_output(layout, state)
        _draw_advanced(layout, state)
        _draw_run(layout, context, state)
        if state.summary.points:
            _draw_summary(layout, context, state.summary)
        column = layout.column()
        column.operator("hiermatch.clear", icon="TRASH")
        column.operator("hiermatch.add_demo_pair", icon="ADD")
        row = column.row(align=True)
        row.operator("hiermatch.export_match", icon="EXPORT")
        row.operator("hiermatch.import_match", icon="IMPORT")


def _draw_pair(layout: bpy.types.UILayout, context: bpy.types.Context, state: HIERMATCH_PG_scene) -> None:
    """Draw the pickers, and say what an empty one stands for."""
    row = layout.row(align=True)
    names, pickers, swap = row.column(), row.column(), row.column()
    names.ui_units_x = _name_width()
    for name in ("source", "target"):
        names.label(text=name.title())
        _draw_picker(pickers.row(align=True), state, name)
    swap.scale_y = 2.0
    swap.operator("hiermatch.swap", text="", icon="UV_SYNC_SELECT")
    chosen = sum(one is not None for one in picked(state))
    if chosen < 2:
        selected = sum(obj.type in ("MESH", "ARMATURE") for obj in view_layer_of(context).objects.selected)
        if selected + chosen < 2:
            draw_text(layout, context, "Pick two meshes, or select them: the active one is the source", "INFO")


def _draw_picker(row: bpy.types.UILayout, state: HIERMATCH_PG_scene, role: str) -> None:
    """Draw what picks an object, and what picks a collection; once one is picked, that alone."""
    collection = f"{role}_collection"
    if getattr(state, collection) is None or getattr(state, role) is not None:
        row.prop(state, role, text="")
    if getattr(state, role) is None:
        row.prop(state, collection, text="")


def _name_width() -> float:
    """Return the width of the names at the top."""
    name = translated("Target")
    return _NAME_WIDTH if name.isascii() else max(_NAME_WIDTH, _WIDE_LETTER * len(name))


def _draw_setup(layout: bpy.types.UILayout, state: HIERMATCH_PG_scene) -> None:
    """Draw the menu of setups, with the one that the settings make."""
    row = layout.row(align=True)
    name = row.column()
    name.ui_units_x = _name_width()
    name.label(text="Setup")
    row.operator_menu_enum("hiermatch.use_setup", "setup", text=current_setup(state) or "Custom")


def _draw_regions(layout: bpy.types.UILayout, state: HIERMATCH_PG_scene) -> None:
    """Draw what is left out."""
    header, body = cast("Any", layout).panel("hiermatch_regions", default_closed=True)
    header.label(text="Leave Out")
    if body is not None:
        body.prop(state, "exclude_source", text="Of Source")
        body.prop(state, "exclude_target", text="Of Target")


def _draw_output(layout: bpy.types.UILayout, state: HIERMATCH_PG_scene) -> None:
    """Draw what is written."""
    header, body = cast("Any", layout).panel("hiermatch_output", default_closed=True)
    header.label(text="Output")
    if body is not None:
        body.prop(state, "prefix")
        column = body.column(heading="Write")
        column.prop(state, "write_vertex_groups")
        column.prop(state, "write_colors")
        column.prop(state, "write_distortion")
        confidence = column.column()
        confidence.active = state.dense
        confidence.prop(state, "write_confidence")
        body.prop(state, "use_mirrored")


def _draw_advanced(layout: bpy.types.UILayout, state: HIERMATCH_PG_scene) -> None:
    """Draw the settings that usually stay as they are, as far as they matter."""
    header, body = cast("Any", layout).panel("hiermatch_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is not None:
        for title, names in shown_groups(state):
            column = body.column()
            if title:
                column.label(text=title)
            for name in names:
                # Beside a number, a usual sidebar has no room for names as long as these; inside its field it has.
                column.use_property_split = state.bl_rna.properties[name].type not in ("INT", "FLOAT")
                column.prop(state, name)


def _draw_run(layout: bpy.types.UILayout, context: bpy.types.Context, state: HIERMATCH_PG_scene) -> None:
    """Draw the button, or how far the running match is."""
    if draw_progress(layout, context, HIERMATCH_PT_match.bl_idname):
        return
    row = layout.row()
    row.scale_y = 1.5
    match: Any = row.operator("hiermatch.match", icon="PLAY")
    copy_options(state, match)


def _draw_summary(layout: bpy.types.UILayout, context: bpy.types.Context, summary: HIERMATCH_PG_summary) -> None:
    """Draw how the last match went."""
    box = layout.box().column()
    if summary.stale:
        draw_text(box, context, summary.stale, "ERROR")
    box.label(text=translated("{count} points matched").format(count=summary.points), icon="CHECKMARK")
    if summary.verdict:
        draw_text(box, context, summary.verdict, "INFO")
    rows = (
        ("Source", summary.source),
        ("Target", summary.target),
        ("Confidence", f"{summary.confidence:.0%}" if summary.verdict else ""),
        ("Distortion", f"{summary.stretch:.0%}" if summary.verdict else f"{summary.distortion:.4g}"),
        ("Worst Point", "" if summary.verdict else f"{summary.worst_distortion:.3f}"),
        ("Coarse Match", _coarse_text(summary)),
        ("Left and Right", _orientation_text(summary)),
        ("Mirrored Match", "" if summary.has_mirrored else translated("none")),
        ("Time", f"{summary.seconds:.1f} s" if summary.seconds else ""),
    )
    for name, text in rows:
        if not text:
            continue
        split = box.split(factor=_LABEL_SHARE)
        split.label(text=name)
        split.label(text=text, translate=False)  # a name such as "Source" stays as it is
    if summary.has_mirrored:
        draw_starter(box, context, "hiermatch.flip", "Use Mirrored Match", "MOD_MIRROR", depress=summary.mirrored)
    _draw_notes(layout, context, summary.notes.splitlines())


def _draw_notes(layout: bpy.types.UILayout, context: bpy.types.Context, notes: list[str]) -> None:
    """Draw what should be known about the match, to unfold: of a messy scan that is much, and few need it."""
    if not notes:
        return
    header, body = cast("Any", layout).panel("hiermatch_notes", default_closed=True)
    header.label(text=translated(counted(len(notes), "note")), translate=False)
    if body is not None:
        column = body.column()
        for note in notes:
            draw_text(column, context, note, "INFO")


def _coarse_text(summary: HIERMATCH_PG_summary) -> str:
    """Say how good the coarse match is; nothing once it was refined, since then it is not what was proven of."""
    if summary.proven:
        return translated("optimum proven")
    return translated("within {gap} of the best").format(gap=f"{summary.gap:.0%}") if summary.gap else ""


def _orientation_text(summary: HIERMATCH_PG_summary) -> str:
    """Say whether the match keeps left and right."""
    if abs(summary.orientation) < _CLEAR_ORIENTATION:
        verdict = translated("unclear")
    else:
        verdict = translated("kept") if summary.orientation > 0 else translated("exchanged")
    return f"{verdict} ({summary.orientation:+.2f})"
