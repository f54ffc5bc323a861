# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Remove what matches have written."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ..common.access import mesh_of, view_layer_of
from ..common.errors import ObjectError
from ..common.translated_text import translated
from ..jobs.running import Startable
from ..properties.panel_state import picked, state_of
from ..properties.steering_lists import sync_lists
from ..scene.character import parts_of, side_of
from ..scene.pair import check_writable, named_side, selected_meshes
from ..storage.linked_matches import forget_linked, has_linked, linked_prefixes
from ..storage.writing import clear, is_marked, kept, prefixes
from .reported_errors import reporting_errors

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_clear(Startable, bpy.types.Operator):
    """Remove what matches have written on some objects."""

    bl_idname = "hiermatch.clear"
    bl_label = "Clear"
    bl_description = (
        "Remove what matches have written on Source, Target and the selected meshes; landmarks and what was carried "
        "over stay"
    )

    object: bpy.props.StringProperty(
        name="Object",
        description="Name of the object to clear; if empty, the picked Source and Target and all selected meshes",
        options={"SKIP_SAVE"},
    )
    prefix: bpy.props.StringProperty(
        name="Prefix",
        description="Remove only what was written with this prefix; if empty, everything",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def _lacking(cls, context: bpy.types.Context) -> str:
        meshes = (obj for obj in view_layer_of(context).objects if obj.type == "MESH")
        if any(is_marked(mesh_of(obj)) or has_linked(obj) for obj in meshes):
            return ""
        return translated("There is nothing here that HierMatch has written")

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Remove it."""
        carriers = [obj for obj in self._objects(context) if self._prefixes(obj) or self._linked(obj)]
        objects, reasons = _writable(carriers)
        if not objects:
            self.report({"WARNING"}, translated("None of these objects carries anything that HierMatch has written."))
            return {"CANCELLED"}
        summary, cleared = state_of(context).summary, set()
        for obj in objects:
            for prefix in reversed(self._prefixes(obj)):  # each restores what was active before it
                cleared.add((prefix, kept(obj, prefix).get("key")))
                clear(obj, prefix)
            for prefix in self._linked(obj):
                forget_linked(obj, prefix)
        for reason in reasons:
            self.report({"WARNING"}, translated(reason))
        names = [obj.name for obj in objects]
        if (summary.prefix, summary.key) in cleared:
            state_of(context).property_unset("summary")
        sync_lists(cast("bpy.types.Scene", context.scene))
        self.report({"INFO"}, translated(f"Cleared {', '.join(names)}"))
        return {"FINISHED"}

    def _objects(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        """Find the meshes to clear, each once."""
        if self.object:
            candidates = list(parts_of(named_side(view_layer_of(context), self.object)))
        else:
            layer = view_layer_of(context)
            sides = [side_of(chosen, layer) for chosen in picked(state_of(context)) if chosen is not None]
            candidates = [*(part for side in sides for part in parts_of(side)), *selected_meshes(context)]
        return [obj for obj in dict.fromkeys(candidates) if obj.type == "MESH"]

    def _prefixes(self, obj: bpy.types.Object) -> tuple[str, ...]:
        """Return which of the results on an object are to go, oldest first."""
        return tuple(prefix for prefix in prefixes(obj) if self.prefix in ("", prefix))

    def _linked(self, obj: bpy.types.Object) -> tuple[str, ...]:
        """Return which of the matches with sources of other files are to go."""
        return tuple(prefix for prefix in linked_prefixes(obj) if self.prefix in ("", prefix))


def _writable(carriers: list[bpy.types.Object]) -> tuple[list[bpy.types.Object], list[str]]:
    """Return those objects that can be written to, and why others cannot.

    Raises
    ------
    ObjectError
        If none can.
    """
    objects, reasons = [], []
    for obj in carriers:
        try:
            check_writable(obj)
        except ObjectError as error:
            reasons.append(str(error))
        else:
            objects.append(obj)
    if reasons and not objects:
        raise ObjectError(reasons[0])
    return objects, reasons
