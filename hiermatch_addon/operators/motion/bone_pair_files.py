# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Save the table of pairs of bones to a file, and load it."""

from __future__ import annotations

from typing import cast

import bpy

from ...common.phrases import listed
from ...properties.bone_pairs import load_pairs, save_pairs
from ..pair_operator import FileOperator
from .edit_bone_pairs import PairEditor


class _PairFile(FileOperator, PairEditor):
    """An operator on a file of pairs of bones."""

    file_name = "bone_pairs.json"


class HIERMATCH_OT_export_bone_pairs(_PairFile, bpy.types.Operator):
    """Save pairs of bones to a file."""

    bl_idname = "hiermatch.export_bone_pairs"
    bl_label = "Export Bone Pairs"
    bl_description = "Save the pairs of bones of two armatures to a file, for other files with the same rigs"
    bl_options = {"REGISTER"}

    check_existing: bpy.props.BoolProperty(
        name="Check Existing", description="Warn before a file is overwritten", default=True, options={"HIDDEN"}
    )

    def _do(self, context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> str:
        path = self._path(written=True)
        save_pairs(cast("bpy.types.Scene", context.scene), source, target, path)
        return f'The pairs of bones were saved to "{path}"'


class HIERMATCH_OT_import_bone_pairs(_PairFile, bpy.types.Operator):
    """Load pairs of bones from a file."""

    bl_idname = "hiermatch.import_bone_pairs"
    bl_label = "Import Bone Pairs"
    bl_description = "Load pairs of bones from a file in place of those of two armatures"

    def _do(self, context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> str:
        count, missing = load_pairs(cast("bpy.types.Scene", context.scene), source, target, self._path())
        if missing:
            return f"{count} pairs were loaded. These bones are missing: {listed(missing)}"
        return f"{count} pairs were loaded"
