# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar, 3D Viewport > Sidebar > HierMatch: it shows stored state and computes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import bpy

from ...engine import DOUBTFUL
from ..common.access import layout_of, options_layout, view_layer_of
from ..common.translated_text import translated
from ..jobs.verdict import GOOD
from ..properties.panel_state import picked, state_of
from ..properties.properties import copy_options
from ..properties.setting_groups import APART, shown_groups
from ..properties.setups import current_setup
from ..scene.character import is_of
from .answer_menu import draw_answers
from .panel_text import draw_label, draw_notes, draw_text, letters_across, wrap_text
from .preset_menu import HIERMATCH_PT_presets
from .progress_bar import draw_progress
from .sidebar import SidebarPanel, folded

if TYPE_CHECKING:
    from ..properties.properties import HIERMATCH_PG_scene, HIERMATCH_PG_summary

_NAME_WIDTH = 3.0
"""Width of the names at the top, narrower than a property split makes them: what they stand before is long."""

_WIDE_LETTER = 0.8
"""Width that such a name needs for each letter, if it is Japanese or Chinese."""

_LABEL_SHARE = 0.4
"""Part of the width for the names in the summary, as in a property split."""

_LETTERS_OF_ICON = 2
"""For how many letters there is room where no icon stands before a text."""

_CLEAR_ORIENTATION = 0.3
"""From which agreement on a match is called to keep or to mirror the orientation."""

_EXPLAINED_WIDTH = 40
"""Letters in a line of a sentence under Advanced: about what a usual sidebar holds."""

_CONFIDENCE: Final = ((GOOD, "good"), (0.5, "fair"), (DOUBTFUL, "look closely"), (0.0, "do not trust it"))
"""From which confidence on it is called so."""

_STRETCH: Final = ((0.5, "very much"), (0.2, "much, the builds differ"), (0.1, "some"), (0.0, "little"))
"""From which mean stretch on it is called so."""

_SENTENCES: Final = {
    "Metric and Descriptor": "How distances are measured, and by what a place is recognised in another pose",
    "Coarse Match": "The first step: a few points, for which all combinations are looked through",
    "Refinement": "The steps after: more points, each sought near where those around it lie",
}
"""What the groups under Advanced are about, by their titles."""


class HIERMATCH_PT_match(SidebarPanel, bpy.types.Panel):
    """Choose two meshes, match them, and read how it went."""

    bl_label = "HierMatch"
    bl_idname = "HIERMATCH_PT_match"

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the button of the presets."""
        HIERMATCH_PT_presets.draw_panel_header(layout_of(self))

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the two meshes, the button and the result; all else is folded below, in the order of work."""
        layout = options_layout(self)
        state = state_of(context)
        _draw_pair(layout, context, state)
        _draw_run(layout, context, state)
        if state.summary.points and not state.summary.hidden:
            _draw_summary(layout, context, state)
        _draw_options(layout, state)
        _draw_regions(layout, state)
        _draw_output(layout, state)
        _draw_advanced(layout, state)
        _draw_more(layout)


def _draw_pair(layout: bpy.types.UILayout, context: bpy.types.Context, state: HIERMATCH_PG_scene) -> None:
    """Draw the pickers, and say what an empty one stands for."""
    row = layout.row(align=True)
    names, pickers, swap = row.column(), row.column(), row.column()
    names.ui_units_x = _name_width()
    for name in ("source", "target"):
        draw_label(names, name.title())
        _draw_picker(pickers.row(align=True), state, name)
    swap.scale_y = 2.0
    swap.operator("hiermatch.swap", text="", icon="UV_SYNC_SELECT")
    chosen = [one for one in picked(state) if one is not None]
    if len(chosen) < 2 and len(chosen) + _selected_beside(context, chosen) < 2:
        draw_text(layout, context, "Pick two meshes, or select them: the active one is the source", "INFO")
        if not state.summary.points:
            layout.operator("hiermatch.add_demo_pair", icon="ADD")


def _selected_beside(context: bpy.types.Context, chosen: list[bpy.types.ID]) -> int:
    """Count what is selected and may be matched, but for what is picked already with all of the same character."""
    selected = [obj for obj in view_layer_of(context).objects.selected if obj.type in ("MESH", "ARMATURE", "EMPTY")]
    return sum(not any(is_of(obj, one) for one in chosen) for obj in selected)


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


def _draw_options(layout: bpy.types.UILayout, state: HIERMATCH_PG_scene) -> None:
    """Draw the options that are changed now and then."""
    if (body := folded(layout, "hiermatch_options", "Options")) is not None:
        for name in (*APART, "use_modifiers", "use_landmarks"):
            body.prop(state, name)


def _draw_regions(layout: bpy.types.UILayout, state: HIERMATCH_PG_scene) -> None:
    """Draw what is left out."""
    if (body := folded(layout, "hiermatch_regions", "Leave Out")) is not None:
        body.prop(state, "exclude_source", text="Of Source")
        body.prop(state, "exclude_target", text="Of Target")


def _draw_output(layout: bpy.types.UILayout, state: HIERMATCH_PG_scene) -> None:
    """Draw what is written."""
    if (body := folded(layout, "hiermatch_output", "Output")) is not None:
        body.prop(state, "prefix")
        column = body.column(heading="Write")
        column.prop(state, "write_vertex_groups")
        column.prop(state, "write_colors")
        column.prop(state, "write_distortion")
        confidence = column.column()
        confidence.active = state.dense
        confidence.prop(state, "write_confidence")
        body.prop(state, "alternative")


def _draw_advanced(layout: bpy.types.UILayout, state: HIERMATCH_PG_scene) -> None:
    """Draw the settings that usually stay as they are, as far as they matter, with a sentence for each group."""
    body = folded(layout, "hiermatch_advanced", "Advanced")
    if body is None:
        return
    row = body.row(align=True)
    name = row.column()
    name.ui_units_x = _name_width()
    draw_label(name, "Setup")
    row.operator_menu_enum("hiermatch.use_setup", "setup", text=current_setup(state) or "Custom")
    for title, names in shown_groups(state):
        column = body.column()
        if title:
            draw_label(column, title)
            _draw_faint(column, _SENTENCES[title])
        for name in names:
            # Beside a number, a usual sidebar has no room for names as long as these; inside its field it has.
            column.use_property_split = state.bl_rna.properties[name].type not in ("INT", "FLOAT")
            column.prop(state, name)


def _draw_faint(layout: bpy.types.UILayout, sentence: str) -> None:
    """Draw what explains the rows below."""
    column: Any = layout.column()
    column.active, column.scale_y = False, 0.8
    for line in wrap_text(translated(sentence), _EXPLAINED_WIDTH):
        column.label(text=line, translate=False)


def _draw_more(layout: bpy.types.UILayout) -> None:
    """Draw what is done before and after the work: the demo pair, files, and taking away what was written."""
    if (body := folded(layout, "hiermatch_more", "Demo and Files")) is not None:
        column = body.column()
        column.operator("hiermatch.clear", icon="TRASH")
        column.operator("hiermatch.add_demo_pair", icon="ADD")
        row = column.row(align=True)
        row.operator("hiermatch.export_match", icon="EXPORT")
        row.operator("hiermatch.import_match", icon="IMPORT")


def _draw_run(layout: bpy.types.UILayout, context: bpy.types.Context, state: HIERMATCH_PG_scene) -> None:
    """Draw the button, or how far the running match is."""
    if draw_progress(layout, context, HIERMATCH_PT_match.bl_idname):
        return
    row = layout.row()
    row.scale_y = 1.5
    match: Any = row.operator("hiermatch.match", icon="PLAY")
    copy_options(state, match)


def _draw_summary(layout: bpy.types.UILayout, context: bpy.types.Context, state: HIERMATCH_PG_scene) -> None:
    """Draw how far the match of what is picked can be trusted, or else the last match, and its numbers to unfold.

    Of a match that one of its meshes carries no more, no number means anything.
    """
    box, summary = layout.box().column(), state.summary
    doubtful = bool(summary.verdict) and summary.confidence < DOUBTFUL
    if summary.stale:
        draw_text(box, context, summary.stale, "ERROR")
    if summary.lost:
        return
    names = (("Source", summary.source), ("Target", summary.target))
    of_picked = all(picked(state))
    if not of_picked:
        _draw_rows(box, context, *names)
    if summary.verdict:
        draw_text(box, context, summary.verdict, "ERROR" if doubtful else "CHECKMARK")
    else:
        box.label(
            text=translated("{count} points matched").format(count=summary.points), icon="CHECKMARK", translate=False
        )
    _draw_rows(
        box,
        context,
        ("Confidence", _judged(summary.confidence, _CONFIDENCE) if summary.verdict else ""),
        ("Left and Right", _orientation_text(summary)),
        ("Other Answers", "" if "\n" in summary.answers else translated("none")),
    )
    if doubtful:
        box.operator("hiermatch.guide_me", icon="EYEDROPPER")
    draw_answers(box, context, summary)
    if (body := folded(layout, "hiermatch_details", "Details")) is not None:
        _draw_rows(
            body,
            context,
            *(names if of_picked else ()),
            ("Matched Points", str(summary.points)),
            ("Distortion", _judged(summary.stretch, _STRETCH) if summary.verdict else f"{summary.distortion:.4g}"),
            ("Worst Point", "" if summary.verdict else f"{summary.worst_distortion:.3f}"),
            ("Search", _search_text(summary)),
            ("Time", f"{summary.seconds:.1f} s" if summary.seconds else ""),
        )
    draw_notes(layout, context, "hiermatch_notes", summary.notes.splitlines())


def _draw_rows(layout: bpy.types.UILayout, context: bpy.types.Context, *rows: tuple[str, str]) -> None:
    """Draw names and values beside each other; those without a value are left out."""
    width = int((1.0 - _LABEL_SHARE) * (letters_across(context) + _LETTERS_OF_ICON))
    for name, text in rows:
        if text:
            split = layout.split(factor=_LABEL_SHARE)
            draw_label(split, name)
            column: Any = split.column()
            lines = wrap_text(text, width)
            column.scale_y = 1.0 if len(lines) == 1 else 0.8
            for line in lines:
                column.label(text=line, translate=False)  # a name such as "Source" stays as it is


def _judged(number: float, scale: tuple[tuple[float, str], ...]) -> str:
    """Write a share with a word for whether that is good: that of the first limit that it reaches."""
    word = next(word for least, word in scale if number >= least)
    return f"{number:.0%}, {translated(word)}"


def _search_text(summary: HIERMATCH_PG_summary) -> str:
    """Say whether the exact first step looked at everything; nothing once the match was refined since."""
    if summary.proven:
        return translated("finished")
    if not summary.gap:
        return ""
    return translated("ended early, at most {gap} from the best").format(gap=f"{summary.gap:.0%}")


def _orientation_text(summary: HIERMATCH_PG_summary) -> str:
    """Say whether the match keeps left and right."""
    if abs(summary.orientation) < _CLEAR_ORIENTATION:
        return translated("unclear, see colors")
    return translated("kept") if summary.orientation > 0 else translated("exchanged")
