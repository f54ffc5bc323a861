# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Set the settings that make one of the paper's setups."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..common.translated_text import translated
from ..properties.panel_state import state_of
from ..properties.setups import SETUP_ITEMS, use_setup

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_use_setup(bpy.types.Operator):
    """Choose one of the paper's setups."""

    bl_idname = "hiermatch.use_setup"
    bl_label = "Use Setup"
    bl_description = "Set metric and descriptor as in one of the setups that the paper compares"
    bl_options = {"REGISTER", "UNDO"}

    setup: bpy.props.EnumProperty(
        name="Setup", description="Which of the paper's setups to use", items=SETUP_ITEMS, default=SETUP_ITEMS[0][0]
    )

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Set the panel's options."""
        self.report({"INFO"}, translated(f"Setup: {use_setup(state_of(context), self.setup)}"))
        return {"FINISHED"}
