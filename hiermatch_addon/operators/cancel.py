# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancel the running match."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..access import progress_of, window_manager_of
from ..running import is_running

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

__all__ = ["HIERMATCH_OT_cancel"]


class HIERMATCH_OT_cancel(bpy.types.Operator):
    """End the running match."""

    bl_idname = "hiermatch.cancel"
    bl_label = "Cancel Match"
    bl_description = "End the running match without writing anything"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it while a match runs."""
        if not is_running(window_manager_of(context)):
            cls.poll_message_set("No match is running")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Ask the match to end at its next step."""
        progress_of(context).cancel = True
        return {"FINISHED"}
