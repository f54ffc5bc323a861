# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Write the match of two objects into a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy_extras.io_utils import ExportHelper

from ..common.access import view_layer_of
from ..common.translated_text import translated
from ..jobs.running import Startable
from ..properties.panel_state import picked, state_of
from ..scene.pair import find_pair, selected_meshes
from ..storage.halves import find_keyed
from ..storage.match_exchange import collect_match
from ..storage.match_file import save_match
from .reported_errors import reporting_errors

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ..scene.character import Side


class HIERMATCH_OT_export_match(ExportHelper, Startable, bpy.types.Operator):  # type: ignore[misc]  # made to be mixed so
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
        description=(
            "Name of one of the two objects; if empty, the one picked in the panel, or the active object, or one of "
            "the match that the panel shows"
        ),
        options={"SKIP_SAVE"},
    )
    target: bpy.props.StringProperty(
        name="Target",
        description=(
            "Name of the other object; if empty, the one picked in the panel, or the other selected mesh, or the other "
            "one of the match that the panel shows"
        ),
        options={"SKIP_SAVE"},
    )
    prefix: bpy.props.StringProperty(
        name="Prefix",
        description="What the names start with that the match wrote; if empty, the one match that the objects carry",
        options={"SKIP_SAVE"},
    )

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Read the match and write the file."""
        path = Path(bpy.path.abspath(self.filepath))
        source, target, prefix = self._match(context)
        save_match(collect_match(source, target, prefix), path)
        self.report({"INFO"}, translated(f'Exported the match of "{source.name}" and "{target.name}" to "{path.name}"'))
        return {"FINISHED"}

    def _match(self, context: bpy.types.Context) -> tuple[Side, Side, str]:
        """Find the two objects of the match that is meant, and its prefix."""
        state = state_of(context)
        named, chosen, summary = (self.source, self.target), picked(state), state.summary
        shown = summary.key and self.prefix in ("", summary.prefix)
        if shown and not any((*named, *chosen)) and len(selected_meshes(context)) < 2:
            roles = ("target", "source") if summary.swapped else ("source", "target")
            source, target = (
                find_keyed(view_layer_of(context), summary.key, summary.prefix, role, name).obj
                for role, name in zip(roles, (summary.source, summary.target), strict=True)
            )
            return source, target, summary.prefix
        return *find_pair(context, named, chosen), self.prefix
