# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Write the match of two objects into a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy_extras.io_utils import ExportHelper

from ...engine import HierMatchError
from ..access import state_of
from ..match_exchange import collect_match
from ..match_file import save_match
from ..pair import find_pair
from ..translated_text import translated

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

__all__ = ["HIERMATCH_OT_export_match"]


class HIERMATCH_OT_export_match(ExportHelper, bpy.types.Operator):  # type: ignore[misc]  # made to be mixed so
    """Write the match of two objects into a file."""

    bl_idname = "hiermatch.export_match"
    bl_label = "Export Match"
    bl_description = (
        "Write the match that two meshes carry into a file, with its dense maps, for other programs or to import it "
        "again"
    )
    bl_options = {"REGISTER"}

    if TYPE_CHECKING:
        filepath: str

    filename_ext = ".npz"
    check_extension = None  # the name may end with .json as well

    filter_glob: bpy.props.StringProperty(
        name="Filter", description="Which files the browser lists", default="*.npz;*.json", options={"HIDDEN"}
    )
    source: bpy.props.StringProperty(
        name="Source",
        description="Name of one of the two objects; if empty, the one picked in the panel or else the active object",
        options={"SKIP_SAVE"},
    )
    target: bpy.props.StringProperty(
        name="Target",
        description="Name of the other object; if empty, the one picked in the panel or else the other selected mesh",
        options={"SKIP_SAVE"},
    )
    prefix: bpy.props.StringProperty(
        name="Prefix",
        description="What the names start with that the match wrote; if empty, the one match that the objects carry",
        options={"SKIP_SAVE"},
    )

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Read the match and write the file."""
        state = state_of(context)
        path = Path(bpy.path.abspath(self.filepath))
        try:
            source, target = find_pair(context, (self.source, self.target), (state.source, state.target))
            save_match(collect_match(source, target, self.prefix), path)
        except HierMatchError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        self.report({"INFO"}, translated(f'Exported the match of "{source.name}" and "{target.name}" to "{path.name}"'))
        return {"FINISHED"}
