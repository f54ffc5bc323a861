# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Common base of the operators on a source and a target, which of the two are meant, and files about them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import view_layer_of, window_manager_of
from ..common.errors import ObjectError
from ..common.translated_text import translated
from ..jobs.running import Startable
from ..properties.panel_state import picked, state_of
from ..scene.character import side_of
from ..scene.pair import active_side, left_out_note, named_side, selected_targets
from .reported_errors import reporting_errors

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ..scene.character import Side


_BESIDE_BLEND: Any = (
    {"PATH_SUPPORTS_BLEND_RELATIVE"}
    if "is_path_supports_blend_relative" in bpy.types.Property.bl_rna.properties
    else set()
)
"""Option of a path that may begin with `//`; Blender 4.3 has no such option, and allows that of all paths."""


class NamedPair(Startable):
    """An operator on a source and a target; to be inherited from before `bpy.types.Operator`."""

    source: bpy.props.StringProperty(
        name="Source",
        description="Name of the object that is the source; if empty, the one picked in the panel or else the "
        "active object",
        options={"SKIP_SAVE"},
    )
    target: bpy.props.StringProperty(
        name="Target",
        description="Name of the object that is the target; if empty, the one picked in the panel or else the "
        "other selected one",
        options={"SKIP_SAVE"},
    )


class PairOperator(NamedPair):
    """An operator that does something at once with two sides; to be inherited from before `bpy.types.Operator`."""

    if TYPE_CHECKING:
        # With the context and what `_sides` has found: does it, and returns what to report.
        _do: Callable[..., str]

    def _sides(self, context: bpy.types.Context) -> tuple[Any, Any]:
        """Find the two sides, or the armatures that they mean, and make sure that it can be done with them."""
        raise NotImplementedError

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Do it, and report."""
        done = self._do(context, *self._sides(context))
        if done:
            self.report({"INFO"}, translated(done))
        return {"FINISHED"}


class FileOperator(Startable):
    """An operator that asks for a JSON file first; to be inherited from before what does the rest.

    Attributes
    ----------
    file_name : str
        What is proposed.
    """

    filepath: bpy.props.StringProperty(
        name="File",
        description="Path of the file, a JSON text",
        subtype="FILE_PATH",
        options=_BESIDE_BLEND,
    )
    filter_glob: bpy.props.StringProperty(
        name="Filter", description="Which files are listed", default="*.json", options={"HIDDEN"}
    )

    file_name: str

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Let the user choose a file."""
        if not self.filepath:
            self.filepath = self.file_name
        window_manager_of(context).fileselect_add(cast("Any", self))
        return {"RUNNING_MODAL"}

    def _path(self, *, written: bool = False) -> Path:
        """Return the file that was chosen; one to be `written` ends with .json, unless it ends otherwise.

        Raises
        ------
        ObjectError
            If none was.
        """
        if not self.filepath:
            raise ObjectError("No file is named. Choose one.")
        path = Path(bpy.path.abspath(self.filepath))
        return path if path.suffix or not written else path.with_suffix(".json")


def pick_sides(
    context: bpy.types.Context, source_name: str, target_names: Sequence[str]
) -> tuple[Side, list[Side], str]:
    """Find the source and the targets: by name, else as picked in the panel, else as selected.

    Returns
    -------
    source : bpy.types.Object or Character
        The source.
    targets : list of bpy.types.Object or Character
        One or more.
    left_out : str
        Which selected parts of the source's own character are no targets, as a sentence; empty for none.

    Raises
    ------
    ObjectError
        If a name is unknown, or the selection leaves open what is meant.
    """
    layer, (picked_source, picked_target) = view_layer_of(context), picked(state_of(context))
    targets = [named_side(layer, name) for name in dict.fromkeys(target_names)]
    source = named_side(layer, source_name) if source_name else None
    if source is None and picked_source is not None:
        source = side_of(picked_source, layer)
    if not targets and picked_target is not None:
        targets = [side for side in [side_of(picked_target, layer)] if side != source]
    if source is None:
        source = active_side(context, without=targets[0] if len(targets) == 1 else None)
        source = None if source in targets else source
    if source is None:
        raise ObjectError("Which mesh is the Source is open: pick it in the panel, or make it the active object.")
    left_out = ""
    if not targets:
        targets, parts = selected_targets(context, source)
        left_out = left_out_note(source, parts) if parts else ""
    if not targets:
        raise ObjectError(
            "It is open which mesh is the Target. Pick it in the panel, or select one or more beside the Source."
        )
    return source, targets, left_out
