# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels for what follows a match, in the sidebar: they show stored state and compute nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, cast

import bpy

from ..common.access import options_layout
from ..scene.armatures import find_armature
from ..scene.character import successor
from ..scene.posing.before_after import is_before
from ..scene.posing.exercise import is_exercising
from ..transfers.options.my_rig import MyRigOptions
from ..transfers.options.retarget import KINDS, option_names
from ..transfers.options.symmetrise import SymmetriseOptions
from ..transfers.options.wrap import WrapOptions
from ..transfers.retarget_properties import copy_named, retarget_of, shown_report, shown_target
from .panel_text import draw_notes, draw_text
from .progress_bar import draw_progress, draw_starter
from .sidebar import SidebarPanel, folded

if TYPE_CHECKING:
    from ..transfers.retarget_properties import HIERMATCH_PG_retarget

_ALONE: Final = {
    "use_rig": "hiermatch.fit_rig",
    "use_weights": "hiermatch.transfer_weights",
    "use_shape_keys": "hiermatch.transfer_shape_keys",
    "use_uvs": "hiermatch.transfer_uvs",
    "use_attributes": "hiermatch.transfer_attributes",
}
"""For each switch the operator that carries this kind alone."""


class HIERMATCH_PT_retarget(SidebarPanel, bpy.types.Panel):
    """Carry over what the source has."""

    bl_label = "Retarget"
    bl_idname = "HIERMATCH_PT_retarget"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the kinds with their options, the button, and what became of it."""
        layout = options_layout(self)
        state: Any = retarget_of(context)
        if draw_progress(layout, context, self.bl_idname):
            return
        row = layout.row()
        row.scale_y = 1.5
        button = row.operator("hiermatch.retarget", icon="OUTLINER_OB_ARMATURE")
        names = [name for kind in KINDS.values() for name in option_names(kind)]
        copy_named(state, button, [*KINDS, *names, "refine"])
        draw_report(layout, context, self.bl_idname, has_before=True)
        for switch in KINDS:
            _draw_kind(layout, context, state, switch)
        layout.prop(state, "refine")
        _draw_my_rig(layout, context, state)
        _draw_wrap(layout, context, state)


class HIERMATCH_PT_symmetry(SidebarPanel, bpy.types.Panel):
    """Make what a mesh carries symmetric."""

    bl_label = "Symmetry"
    bl_idname = "HIERMATCH_PT_symmetry"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the options and the button."""
        layout = options_layout(self)
        state = retarget_of(context)
        names = option_names(SymmetriseOptions)
        for name in names:
            layout.prop(state, name)
        if not draw_progress(layout, context, self.bl_idname):
            copy_named(state, layout.operator("hiermatch.symmetrise", icon="MOD_MIRROR"), names)


def _draw_kind(
    layout: bpy.types.UILayout, context: bpy.types.Context, state: HIERMATCH_PG_retarget, switch: str
) -> None:
    """Draw the switch of a kind, a button that carries it alone, and its options to unfold."""
    names = option_names(KINDS[switch])
    header, body = cast("Any", layout).panel(f"hiermatch_{switch}", default_closed=True)
    header.use_property_split = False
    header.prop(state, switch)
    draw_starter(header, context, _ALONE[switch], "", "PLAY", options=[*names, "refine"])
    if body is not None:
        body.active = getattr(state, switch)
        for name in names:
            body.prop(state, name)


def _draw_my_rig(layout: bpy.types.UILayout, context: bpy.types.Context, state: HIERMATCH_PG_retarget) -> None:
    """Draw the options of fitting another armature and its button."""
    if (body := folded(layout, "hiermatch_my_rig", "My Rig")) is not None:
        names = option_names(MyRigOptions)
        for name in names:
            if name != "my_rig_limit" or state.my_rig_bind:
                body.prop(state, name)
        options, icon = [*names, "refine"], "OUTLINER_OB_ARMATURE"
        draw_starter(body, context, "hiermatch.fit_my_rig", "Fit My Rig", icon, options=options)


def _draw_wrap(layout: bpy.types.UILayout, context: bpy.types.Context, state: HIERMATCH_PG_retarget) -> None:
    """Draw the options of a wrap and its button."""
    if (body := folded(layout, "hiermatch_wrap", "Wrap and Morph")) is not None:
        names = option_names(WrapOptions)
        for name in names:
            body.prop(state, name)
        draw_starter(body, context, "hiermatch.wrap", "Wrap", "MOD_SHRINKWRAP", options=[*names, "refine"])


def draw_report(layout: bpy.types.UILayout, context: bpy.types.Context, panel: str, *, has_before: bool) -> None:
    """Draw what became of the last transfer of a panel: the verdict, the way to see for oneself, and what to check.

    If what was carried can be hidden for a while, the button for that is there, too (`has_before`).
    """
    report = shown_report(context, panel)
    if report is None:
        return
    box = layout.box().column()
    for line in report.done.splitlines():
        draw_text(box, context, line, "ERROR" if report.doubtful else "CHECKMARK")
    for line in report.verdict.splitlines():
        draw_text(box, context, line, "ERROR" if report.doubtful else "INFO")
    box.label(text=f"{report.seconds:.1f} s", icon="TIME", translate=False)
    target: Any = shown_target(context, report)
    if target is not None and getattr(target, "type", "") == "ARMATURE":
        armature: bpy.types.Object | None = successor(target)
    else:
        armature = target if target is None else find_armature(target)
    row = layout.row(align=True)
    pressed = armature is not None and is_exercising(armature)
    poses = row.operator("hiermatch.test_poses", icon="ARMATURE_DATA", depress=pressed)
    poses.target = "" if target is None else report.target
    if has_before:
        hidden = target is not None and is_before(target)
        before = row.operator("hiermatch.before_after", icon="ARROW_LEFTRIGHT", depress=hidden)
        before.target = poses.target
    if report.notes:
        box = layout.box().column()
        for line in report.notes.splitlines():
            draw_text(box, context, line, "ERROR")
    draw_notes(layout, context, "hiermatch_remarks", report.remarks.splitlines())
