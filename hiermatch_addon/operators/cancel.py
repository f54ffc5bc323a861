# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancel what is running."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..common.access import window_manager_of
from ..common.translated_text import translated
from ..jobs.running import is_running
from ..properties.panel_state import progress_of

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_cancel(bpy.types.Operator):
    """End the running match or transfer."""

    bl_idname = "hiermatch.cancel"
    bl_label = "Cancel"
    bl_description = "End the running match or transfer without writing anything"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it while something runs."""
        if not is_running(window_manager_of(context)):
            cls.poll_message_set(translated("Nothing is running"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Ask it to end at its next step."""
        progress_of(context).cancel = True
        return {"FINISHED"}
