# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel for motion between two rigs: it shows the table of pairs and computes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import layout_of
from ..properties.motion_properties import MotionOptions, bone_pairs_of, motion_of
from ..transfers.retarget_properties import copy_named
from .panel_text import draw_text
from .progress_bar import draw_progress, draw_starter

if TYPE_CHECKING:
    from ..properties.motion_properties import HIERMATCH_PG_bone_pair

__all__ = ["HIERMATCH_PT_motion", "HIERMATCH_UL_bone_pairs"]


class HIERMATCH_UL_bone_pairs(bpy.types.UIList):
    """The list of pairs of bones."""

    bl_idname = "HIERMATCH_UL_bone_pairs"

    def draw_item(  # type: ignore[override]
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _data: Any,  # noqa: ANN401 - Blender's own
        item: HIERMATCH_PG_bone_pair,
        _icon: int,
        _active_data: Any,  # noqa: ANN401 - Blender's own
        _active_name: str,
    ) -> None:
        """Draw a pair: both bones to pick, the score, and the lock."""
        row: Any = layout.row(align=True)
        if item.source_rig is not None and item.target_rig is not None:
            row.prop_search(item, "source", item.source_rig.data, "bones", text="", icon="BLANK1")
            row.prop_search(item, "target", item.target_rig.data, "bones", text="", icon="BLANK1")
        row.label(text=f"{item.score:.2f}")
        row.prop(item, "locked", text="", icon="LOCKED" if item.locked else "UNLOCKED")
        button = row.operator("hiermatch.remove_bone_pair", text="", icon="X")
        button.source_bone, button.target_bone = item.source, item.target
        if item.source_rig is not None and item.target_rig is not None:
            button.source, button.target = item.source_rig.name, item.target_rig.name

    def filter_items(  # type: ignore[override]
        self,
        context: bpy.types.Context,
        data: Any,  # noqa: ANN401 - Blender's own
        name: str,
    ) -> tuple[list[int], list[int]]:
        """Show the pairs of the armatures that are picked, and of these what was searched for."""
        rows = getattr(data, name)
        state = motion_of(context)
        wanted = self.filter_name.lower()
        flags = [
            self.bitflag_filter_item
            if _is_shown(row, state.source, state.target) and wanted in f"{row.source} {row.target}".lower()
            else 0
            for row in rows
        ]
        return flags, []


class HIERMATCH_PT_motion(bpy.types.Panel):
    """Bring motion from one rig to another."""

    bl_label = "Motion"
    bl_idname = "HIERMATCH_PT_motion"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "HierMatch"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the two rigs, the table of their bones, and what is carried over."""
        layout: Any = layout_of(self)
        state: Any = motion_of(context)
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(state, "source")
        column.prop(state, "target")
        if draw_progress(layout, context, self.bl_idname):
            return
        draw_starter(layout, context, "hiermatch.pair_bones", "Pair Bones", "LINKED")
        _draw_table(layout, context, state)
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(state, "actions")
        names = list(MotionOptions.__annotations__)
        for name in names:
            if name != "tolerance" or state.keying in {"AUTO", "REDUCED"}:
                column.prop(state, name)
        row = layout.row()
        row.scale_y = 1.5
        button = draw_starter(row, context, "hiermatch.retarget_action", "Retarget Action", "ACTION")
        if button is not None:
            copy_named(state, button, [*names, "actions"])
        row = layout.row(align=True)
        button = draw_starter(row, context, "hiermatch.retarget_pose", "Retarget Pose", "POSE_HLT")
        if button is not None:
            button.keep_hands = state.keep_hands
        for line in state.report.splitlines():
            draw_text(layout, context, line, "INFO")


def _draw_table(layout: Any, context: bpy.types.Context, state: Any) -> None:  # noqa: ANN401 - Blender's own
    """Draw the pairs, and what can be done with all of them."""
    scene = cast("bpy.types.Scene", context.scene)
    if any(_is_shown(row, state.source, state.target) for row in bone_pairs_of(scene)):
        layout.template_list(
            "HIERMATCH_UL_bone_pairs", "", scene, "hiermatch_bone_pairs", state, "index", rows=5, maxrows=14
        )
    row = layout.row(align=True)
    row.operator("hiermatch.add_bone_pair", text="", icon="ADD")
    row.operator("hiermatch.export_bone_pairs", text="", icon="EXPORT")
    row.operator("hiermatch.import_bone_pairs", text="", icon="IMPORT")
    row.operator("hiermatch.clear_bone_pairs", text="", icon="TRASH")


def _is_shown(row: Any, source: Any, target: Any) -> bool:  # noqa: ANN401 - a row, and objects or none
    """Tell whether a row is one of the armatures that are picked; all are if none is."""
    return all(
        picked is None or rig in {picked, picked.find_armature() if picked.type == "MESH" else picked}
        for rig, picked in ((row.source_rig, source), (row.target_rig, target))
    )
