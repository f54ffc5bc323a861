# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Make what a mesh carries symmetric."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...common.access import view_layer_of
from ...common.errors import ObjectError
from ...common.translated_text import translated
from ...jobs.job_operator import JobOperator
from ...scene.pair import named_object
from ...transfers.options.symmetrise import SymmetriseOptions, symmetrise_settings
from ...transfers.symmetrise import SymmetriseJob

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_symmetrise(SymmetriseOptions, JobOperator, bpy.types.Operator):
    """Make what a mesh carries symmetric."""

    bl_idname = "hiermatch.symmetrise"
    bl_label = "Symmetrise"
    bl_description = (
        "Take weights, shape keys and colors of one side of a mesh to its other side, also if its pose or its topology "
        "is not symmetric"
    )

    object: bpy.props.StringProperty(
        name="Object",
        description="Name of the object to make symmetric; if empty, the active object",
        options={"SKIP_SAVE"},
    )

    doing = "Symmetrising"
    panel = "HIERMATCH_PT_symmetry"
    cancelled = "It was cancelled. Nothing was written"

    def _start(self, context: bpy.types.Context) -> SymmetriseJob:
        """Read the object."""
        obj = named_object(self.object) if self.object else view_layer_of(context).objects.active
        if obj is None:
            raise ObjectError("It is open which mesh is to be made symmetric. Make it the active object.")
        self.object = obj.name
        return SymmetriseJob(context, obj, symmetrise_settings(self))

    def _finish(self, _context: bpy.types.Context, job: SymmetriseJob) -> set[OperatorReturnItems]:
        """Write and report."""
        report = job.finish()
        for note in report.notes:
            self.report({"WARNING"}, translated(note))
        self.report({"INFO"}, translated(f'Made "{self.object}" symmetric in {job.seconds:.1f} s: {report.done}'))
        return {"FINISHED"}
