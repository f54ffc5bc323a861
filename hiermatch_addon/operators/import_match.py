# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Write the match that a file holds on two objects."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy_extras.io_utils import ImportHelper

from ..common.translated_text import translated
from ..properties.freshness import show_match
from ..properties.panel_state import picked, state_of
from ..scene.pair import find_pair
from ..storage.match_exchange import apply_match
from ..storage.match_file import load_match
from ..storage.writing import LONGEST_PREFIX
from .pair_operator import NamedPair
from .reported_errors import reporting_errors

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_import_match(ImportHelper, NamedPair, bpy.types.Operator):  # type: ignore[misc]  # made to be mixed so
    """Write the match that a file holds on two objects."""

    bl_idname = "hiermatch.import_match"
    bl_label = "Import Match"
    bl_description = (
        "Write a match that was exported to a file on two meshes with the same vertices and faces, in whatever pose, "
        "as if they had just been matched"
    )

    if TYPE_CHECKING:
        filepath: str

    filename_ext = ".npz"

    filter_glob: bpy.props.StringProperty(
        name="Filter", description="Which files the browser lists", default="*.npz;*.json", options={"HIDDEN"}
    )
    prefix: bpy.props.StringProperty(
        name="Prefix",
        description="What the names of everything that is written start with",
        default="HM",
        maxlen=LONGEST_PREFIX,
        options={"SKIP_SAVE"},
    )

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Read the file and write on both objects."""
        state = state_of(context)
        path = Path(bpy.path.abspath(self.filepath))
        source, target = find_pair(context, (self.source, self.target), picked(state))
        stored = apply_match(context, source, target, load_match(path), self.prefix)
        show_match(context, stored, stored.names, self.prefix)
        self.report(
            {"INFO"}, translated(f'Imported the match of "{source.name}" and "{target.name}" from "{path.name}"')
        )
        return {"FINISHED"}
