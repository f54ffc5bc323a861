# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Save landmarks to a file, and load them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import bpy

from ...common.access import window_manager_of
from ...common.errors import ObjectError
from ...common.translated_text import translated
from ...jobs.running import can_start
from ...storage.landmark_files import landmarks_from_text, landmarks_to_text
from ...storage.landmarks import add_landmarks, clear_landmarks, find_landmarks, rename_landmark, switch_landmark
from .landmark_operator import LandmarkOperator

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...scene.character import Side

__all__ = ["HIERMATCH_OT_load_landmarks", "HIERMATCH_OT_save_landmarks"]

_props: Any = bpy.props  # whose functions Blender's stubs declare to return nothing


class _FileOperator(LandmarkOperator):
    """An operator that asks for a file."""

    __annotations__ = {
        **LandmarkOperator.__annotations__,
        "filepath": _props.StringProperty(
            name="File", description="Path of the file of landmarks, a JSON text", subtype="FILE_PATH"
        ),
        "filter_glob": _props.StringProperty(
            name="Filter", description="Which files are listed", default="*.json", options={"HIDDEN"}
        ),
    }

    if TYPE_CHECKING:
        filepath: str

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it in Object Mode, when nothing else is running."""
        return can_start(cast("type[bpy.types.Operator]", cls), context)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Let the user choose a file."""
        if not self.filepath:
            self.filepath = "landmarks.json"
        window_manager_of(context).fileselect_add(cast("Any", self))
        return {"RUNNING_MODAL"}

    def _path(self) -> Path:
        if not self.filepath:
            raise ObjectError("No file is named. Choose where the landmarks are kept.")
        return Path(bpy.path.abspath(self.filepath))


class HIERMATCH_OT_save_landmarks(_FileOperator, bpy.types.Operator):
    """Save landmarks to a file."""

    bl_idname = "hiermatch.save_landmarks"
    bl_label = "Save Landmarks"
    bl_description = "Save the landmarks that source and target have in common to a file"
    bl_options = {"REGISTER"}

    check_existing: bpy.props.BoolProperty(
        name="Check Existing", description="Warn before a file is overwritten", default=True, options={"HIDDEN"}
    )

    def _do(self, _context: bpy.types.Context, source: Side, target: Side) -> str:
        path, landmarks = self._path(), find_landmarks(source, target)
        if not landmarks:
            raise ObjectError(f'"{source.name}" and "{target.name}" have no landmarks in common. Add some first.')
        path = path if path.suffix else path.with_suffix(".json")
        try:
            path.write_text(landmarks_to_text(source, target, landmarks), encoding="utf8")
        except OSError as error:
            raise ObjectError(f'"{path}" cannot be written: {error.strerror}. Choose another place.') from error
        return f'Saved {len(landmarks)} landmarks to "{path.name}"'


class HIERMATCH_OT_load_landmarks(_FileOperator, bpy.types.Operator):
    """Load landmarks from a file."""

    bl_idname = "hiermatch.load_landmarks"
    bl_label = "Load Landmarks"
    bl_description = "Load landmarks of source and target from a file"
    bl_options = {"REGISTER", "UNDO"}

    replace: bpy.props.BoolProperty(
        name="Replace",
        description="Remove the landmarks that the two meshes have in common before those of the file are added",
        default=True,
        options={"SKIP_SAVE"},
    )

    def _do(self, _context: bpy.types.Context, source: Side, target: Side) -> str:
        path = self._path()
        try:
            text = path.read_text(encoding="utf8")
        except OSError as error:
            raise ObjectError(f'"{path}" cannot be read: {error.strerror}. Choose another file.') from error
        except UnicodeDecodeError as error:
            raise ObjectError(f'"{path}" is no text. Choose a file that Save Landmarks has written.') from error
        landmarks, notes = landmarks_from_text(text, source, target)
        if self.replace:
            clear_landmarks(source, target)
        pairs = [(landmark.source, landmark.target) for landmark in landmarks]
        for read, added in zip(landmarks, add_landmarks(source, target, pairs), strict=True):
            if not read.use:
                switch_landmark(source, target, added.number, use=False)
            rename_landmark(source, target, added.number, read.name)
        for note in notes:
            self.report({"WARNING"}, translated(note))
        return f'Loaded {len(landmarks)} landmarks from "{path.name}"'
