# SPDX-License-Identifier: GPL-3.0-or-later
"""Exchange source and target."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..common.access import mesh_of
from ..common.translated_text import translated
from ..properties.panel_state import state_of
from ..storage.halves import find_common
from ..storage.writing import change_kept

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ..properties.properties import HIERMATCH_PG_summary
    from ..storage.halves import Half

__all__ = ["HIERMATCH_OT_swap"]


class HIERMATCH_OT_swap(bpy.types.Operator):
    """Exchange the picked source and target."""

    bl_idname = "hiermatch.swap"
    bl_label = "Swap Source and Target"
    bl_description = (
        "Exchange Source and Target; the match that the two carry, with its dense map, then serves the other way round"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it when there is something to exchange."""
        state = state_of(context)
        if state.source is None and state.target is None:
            cls.poll_message_set(translated("Pick a Source or a Target first"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Exchange them, and with them what the panel calls source and target of a match that they carry."""
        state = state_of(context)
        state.source, state.target = state.target, state.source
        state.exclude_source, state.exclude_target = state.exclude_target, state.exclude_source
        if state.source is not None and state.target is not None:
            for half, partner in find_common(state.source, state.target):
                _set_swapped(state.summary, half, partner)
        return {"FINISHED"}


def _set_swapped(summary: HIERMATCH_PG_summary, half: Half, partner: Half) -> None:
    """Call the first of the two sides of a match the source from now on."""
    swapped = half.role == "target"
    for side in (half, partner):
        if mesh_of(side.obj).library is None:
            change_kept(side.obj, side.prefix, swapped=swapped)
    if (summary.prefix, summary.key) == (half.prefix, half.key):
        summary.swapped = swapped
        summary.source, summary.target = half.obj.name, partner.obj.name
