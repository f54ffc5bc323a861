# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel for motion between two rigs: it shows the table of pairs and computes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import options_layout
from ..properties.bone_pairs import bone_pairs_of
from ..properties.panel_state import picked, state_of
from ..scene.character import armatures_above
from ..transfers.options.motion import MotionOptions
from ..transfers.options.retarget import option_names
from ..transfers.retarget_properties import retarget_of
from .panel_text import letters_across, shortened
from .progress_bar import draw_progress, draw_starter
from .retarget_panels import draw_report
from .sidebar import SidebarPanel

if TYPE_CHECKING:
    from ..properties.bone_pairs import HIERMATCH_PG_bone_pair

_SCORE_WIDTH = 1.7
"""Of the column of scores, in Blender's units of the interface."""

_LETTERS_OF_BUTTONS = 7
"""For how many letters of a name score, lock, cross and the scroll bar leave no room in either half of a row."""

_LETTERS_OF_MARGINS = 2
"""For how many letters less there is room in a label than in a field, as seen in a window of Blender 5.2."""


class HIERMATCH_UL_bone_pairs(bpy.types.UIList):
    """The list of pairs of bones."""

    bl_idname = "HIERMATCH_UL_bone_pairs"

    def draw_item(  # type: ignore[override]
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _data: Any,  # noqa: ANN401 - Blender's own
        item: HIERMATCH_PG_bone_pair,
        _icon: int,
        _active_data: Any,  # noqa: ANN401 - Blender's own
        _active_name: str,
    ) -> None:
        """Draw a pair: the names of both bones, the score, and the lock."""
        row: Any = layout.row(align=True)
        letters = max(4, letters_across(context) // 2 - _LETTERS_OF_BUTTONS)
        for name in ("source", "target"):
            bone = getattr(item, name)
            if len(bone) <= letters:
                row.prop(item, name, text="", emboss=False)
            else:  # Blender would leave its end out; below the list it can be chosen anew
                row.label(text=shortened(bone, max(4, letters - _LETTERS_OF_MARGINS)), translate=False)
        score = row.row()
        score.ui_units_x = _SCORE_WIDTH  # else it takes as much room as a name
        score.label(text=f"{item.score:.2f}", translate=False)
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
        rigs = _rigs_picked(context)
        wanted = self.filter_name.lower()
        flags = [
            self.bitflag_filter_item if _is_shown(row, rigs) and wanted in f"{row.source} {row.target}".lower() else 0
            for row in rows
        ]
        return flags, []


class HIERMATCH_PT_motion(SidebarPanel, bpy.types.Panel):
    """Bring motion from one rig to another."""

    bl_label = "Motion"
    bl_idname = "HIERMATCH_PT_motion"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the table of bones, and what is carried over."""
        layout: Any = options_layout(self)
        options: Any = retarget_of(context)
        if draw_progress(layout, context, self.bl_idname):
            return
        draw_starter(layout, context, "hiermatch.pair_bones", "Pair Bones", "LINKED", options=["refine"])
        _draw_table(layout, context, options)
        layout.prop_search(options, "action", bpy.data, "actions", results_are_suggestions=True)
        names = option_names(MotionOptions)
        for name in names:
            hidden = (name == "tolerance" and options.keying not in {"AUTO", "REDUCED"}) or name == "action"
            if not hidden and not (name == "actions" and options.action):
                layout.prop(options, name)
        row = layout.row()
        row.scale_y = 1.5
        taken = [*names, "refine"]
        draw_starter(row, context, "hiermatch.retarget_action", "Retarget Action", "ACTION", options=taken)
        taken = ["keep_hands", "refine"]
        draw_starter(layout, context, "hiermatch.retarget_pose", "Retarget Pose", "POSE_HLT", options=taken)
        draw_report(layout, context, self.bl_idname, has_before=False)


def _draw_table(layout: Any, context: bpy.types.Context, options: Any) -> None:  # noqa: ANN401 - Blender's own
    """Draw the pairs, and what can be done with all of them."""
    scene, rigs = cast("bpy.types.Scene", context.scene), _rigs_picked(context)
    if any(_is_shown(row, rigs) for row in bone_pairs_of(scene)):
        layout.template_list(
            "HIERMATCH_UL_bone_pairs", "", scene, "hiermatch_bone_pairs", options, "bone_pair", rows=5, maxrows=14
        )
        active = bone_pairs_of(scene)[min(options.bone_pair, len(bone_pairs_of(scene)) - 1)]
        if _is_shown(active, rigs) and active.source_rig is not None and active.target_rig is not None:
            layout.prop_search(active, "source", active.source_rig.data, "bones", text="Source")
            layout.prop_search(active, "target", active.target_rig.data, "bones", text="Target")
    row = layout.row(align=True)
    row.operator("hiermatch.add_bone_pair", text="", icon="ADD")
    row.operator("hiermatch.export_bone_pairs", text="", icon="EXPORT")
    row.operator("hiermatch.import_bone_pairs", text="", icon="IMPORT")
    row.operator("hiermatch.clear_bone_pairs", text="", icon="TRASH")
    row.separator()
    row.operator("hiermatch.rename_bones", icon="SORTALPHA")
    operator, text = "hiermatch.transfer_paired_weights", "Weights to Own Rig"
    draw_starter(layout, context, operator, text, "MOD_VERTEX_WEIGHT", options=["refine"])


def _rigs_picked(context: bpy.types.Context) -> list[set[Any] | None]:
    """Return the armatures of what is picked as source and as target; None for all if nothing is."""
    found: list[set[Any] | None] = []
    for chosen in cast("tuple[Any, Any]", picked(state_of(context))):
        if chosen is None:
            found.append(None)
            continue
        objects = chosen.all_objects if chosen.id_type == "COLLECTION" else [chosen, *chosen.children_recursive]
        own = armatures_above(chosen) if chosen.id_type == "OBJECT" else set()
        found.append(own or {rig for obj in objects for rig in armatures_above(obj)})
    return found


def _is_shown(row: Any, rigs: list[set[Any] | None]) -> bool:  # noqa: ANN401 - a row of the table
    """Tell whether a row is one of certain armatures."""
    return all(
        wanted is None or rig in wanted for rig, wanted in zip((row.source_rig, row.target_rig), rigs, strict=True)
    )
