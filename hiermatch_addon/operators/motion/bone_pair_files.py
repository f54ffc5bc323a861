# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Save the table of pairs of bones to a file, and load it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import bpy

from ...common.access import window_manager_of
from ...common.errors import ObjectError
from ...common.phrases import listed
from ...properties.bone_pairs import load_pairs, save_pairs
from .edit_bone_pairs import PairEditor

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

__all__ = ["HIERMATCH_OT_export_bone_pairs", "HIERMATCH_OT_import_bone_pairs"]

_props: Any = bpy.props  # whose functions Blender's stubs declare to return nothing


class _FileOperator(PairEditor):
    """An operator that asks for a file."""

    __annotations__ = {
        **PairEditor.__annotations__,
        "filepath": _props.StringProperty(
            name="File", description="Path of the file of pairs, a JSON text", subtype="FILE_PATH"
        ),
        "filter_glob": _props.StringProperty(
            name="Filter", description="Which files are listed", default="*.json", options={"HIDDEN"}
        ),
    }

    if TYPE_CHECKING:
        filepath: str

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Let the user choose a file."""
        if not self.filepath:
            self.filepath = "bone_pairs.json"
        window_manager_of(context).fileselect_add(cast("Any", self))
        return {"RUNNING_MODAL"}

    def _path(self) -> Path:
        if not self.filepath:
            raise ObjectError("No file is named. Choose where the pairs of bones are kept.")
        return Path(bpy.path.abspath(self.filepath))


class HIERMATCH_OT_export_bone_pairs(_FileOperator, bpy.types.Operator):
    """Save pairs of bones to a file."""

    bl_idname = "hiermatch.export_bone_pairs"
    bl_label = "Export Bone Pairs"
    bl_description = "Save the pairs of bones of two armatures to a file, for other files with the same rigs"
    bl_options = {"REGISTER"}

    check_existing: bpy.props.BoolProperty(
        name="Check Existing", description="Warn before a file is overwritten", default=True, options={"HIDDEN"}
    )

    def _do(self, context: bpy.types.Context, rigs: tuple[bpy.types.Object, bpy.types.Object]) -> str:
        path = self._path()
        path = path if path.suffix else path.with_suffix(".json")
        save_pairs(cast("bpy.types.Scene", context.scene), *rigs, path)
        return f'The pairs of bones were saved to "{path}"'


class HIERMATCH_OT_import_bone_pairs(_FileOperator, bpy.types.Operator):
    """Load pairs of bones from a file."""

    bl_idname = "hiermatch.import_bone_pairs"
    bl_label = "Import Bone Pairs"
    bl_description = "Load pairs of bones from a file in place of those of two armatures"
    bl_options = {"REGISTER", "UNDO"}

    def _do(self, context: bpy.types.Context, rigs: tuple[bpy.types.Object, bpy.types.Object]) -> str:
        count, missing = load_pairs(cast("bpy.types.Scene", context.scene), *rigs, self._path())
        if missing:
            return f"{count} pairs were loaded. These bones are missing: {listed(missing)}"
        return f"{count} pairs were loaded"
