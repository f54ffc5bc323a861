# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Answer what a running job asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..common.translated_text import translated
from ..jobs.verdict import ANSWERS
from ..properties.panel_state import progress_of

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_answer(bpy.types.Operator):
    """Say what is to become of a match that is not to be trusted."""

    bl_idname = "hiermatch.answer"
    bl_label = "Answer"
    bl_description = "Say what is to become of a match that is not to be trusted"
    bl_options = {"INTERNAL"}

    answer: bpy.props.EnumProperty(name="Answer", description="What is to be done", items=ANSWERS, default="CANCEL")

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:  # noqa: ANN401 - the operator's own
        """Describe the button by what it does."""
        return {identifier: text for identifier, _, text in ANSWERS}[properties.answer]

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it while something is asked."""
        if not progress_of(context).question:
            cls.poll_message_set(translated("Nothing is asked"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Hand the answer to the job, which looks for it."""
        if self.answer == "CANCEL":
            progress_of(context).cancel = True
        else:
            progress_of(context).answer = self.answer
        return {"FINISHED"}
