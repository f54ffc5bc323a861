# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Save landmarks to a file, and load them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...common.errors import ObjectError
from ...common.file_reading import read_text
from ...common.file_writing import write_whole
from ...common.phrases import counted
from ...common.translated_text import translated
from ...storage.landmark_files import landmarks_from_text, landmarks_to_text
from ...storage.landmarks import add_landmarks, find_landmarks, remove_landmark, rename_landmark, switch_landmark
from ..pair_operator import FileOperator
from .landmark_operator import LandmarkOperator

if TYPE_CHECKING:
    from ...scene.character import Side


class _LandmarkFile(FileOperator, LandmarkOperator):
    """An operator on a file of landmarks."""

    file_name = "landmarks.json"
    modes = ("OBJECT",)


class HIERMATCH_OT_save_landmarks(_LandmarkFile, bpy.types.Operator):
    """Save landmarks to a file."""

    bl_idname = "hiermatch.save_landmarks"
    bl_label = "Save Landmarks"
    bl_description = "Save the landmarks that source and target have in common to a file"
    bl_options = {"REGISTER"}

    check_existing: bpy.props.BoolProperty(
        name="Check Existing", description="Warn before a file is overwritten", default=True, options={"HIDDEN"}
    )

    def _edit(self, _context: bpy.types.Context, source: Side, target: Side) -> str:
        path, landmarks = self._path(written=True), find_landmarks(source, target)
        if not landmarks:
            raise ObjectError(f'"{source.name}" and "{target.name}" have no landmarks in common. Add some first.')
        write_whole(path, landmarks_to_text(source, target, landmarks).encode("utf8"))
        return f'Saved {counted(len(landmarks), "landmark")} to "{path.name}"'


class HIERMATCH_OT_load_landmarks(_LandmarkFile, bpy.types.Operator):
    """Load landmarks from a file."""

    bl_idname = "hiermatch.load_landmarks"
    bl_label = "Load Landmarks"
    bl_description = "Load landmarks of source and target from a file"

    replace: bpy.props.BoolProperty(
        name="Replace",
        description="Remove the landmarks that the two meshes have in common before those of the file are added",
        default=True,
        options={"SKIP_SAVE"},
    )

    def _edit(self, _context: bpy.types.Context, source: Side, target: Side) -> str:
        path = self._path()
        landmarks, notes = landmarks_from_text(read_text(path), source, target)
        pairs = [(landmark.source, landmark.target) for landmark in landmarks]
        for old in find_landmarks(source, target) if self.replace else ():
            if (old.source, old.target) not in pairs:  # else it keeps its number, by which third meshes know it
                remove_landmark(source, target, old.number)
        for read, added in zip(landmarks, add_landmarks(source, target, pairs), strict=True):
            if not read.use:
                switch_landmark(source, target, added.number, use=False)
            rename_landmark(source, target, added.number, read.name)
        for note in notes:
            self.report({"WARNING"}, translated(note))
        return f'Loaded {counted(len(landmarks), "landmark")} from "{path.name}"'
