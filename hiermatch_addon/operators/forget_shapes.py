# SPDX-License-Identifier: GPL-3.0-or-later
"""Forget what meshes were prepared to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..common.translated_text import translated
from ..jobs.prepared_shapes import forget_shapes
from ..jobs.running import Startable

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_forget_shapes(Startable, bpy.types.Operator):
    """Forget the shapes that were prepared in this session."""

    bl_idname = "hiermatch.forget_shapes"
    bl_label = "Forget Prepared Shapes"
    bl_description = (
        "Free the memory of the meshes that were matched in this session; matching one again prepares it anew"
    )
    bl_options = {"INTERNAL"}
    modes = ()

    def execute(self, _context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Forget them."""
        forget_shapes()
        self.report({"INFO"}, translated("The prepared shapes were forgotten"))
        return {"FINISHED"}
