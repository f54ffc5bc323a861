# SPDX-License-Identifier: GPL-3.0-or-later
"""Exchange source and target."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..access import state_of

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

__all__ = ["HIERMATCH_OT_swap"]


class HIERMATCH_OT_swap(bpy.types.Operator):
    """Exchange the picked source and target."""

    bl_idname = "hiermatch.swap"
    bl_label = "Swap Source and Target"
    bl_description = "Exchange Source and Target"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it when there is something to exchange."""
        state = state_of(context)
        if state.source is None and state.target is None:
            cls.poll_message_set("Pick a Source or a Target first")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Exchange them."""
        state = state_of(context)
        state.source, state.target = state.target, state.source
        return {"FINISHED"}
