# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Write the other answer of a match."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ...engine import HierMatchError
from ..access import state_of, view_layer_of, window_manager_of
from ..errors import ObjectError
from ..flipping import flip
from ..freshness import refresh
from ..halves import Half, find_half, find_keyed
from ..pair import named_object
from ..running import can_start
from ..summary import remember

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

__all__ = ["HIERMATCH_OT_flip"]


class HIERMATCH_OT_flip(bpy.types.Operator):
    """Exchange the two answers of a match."""

    bl_idname = "hiermatch.flip"
    bl_label = "Use Mirrored Match"
    bl_description = (
        "Write the other of the two answers of the match, in which left and right are exchanged, without matching "
        "again. Once more brings the first answer back"
    )
    bl_options = {"REGISTER", "UNDO"}

    object: bpy.props.StringProperty(
        name="Object",
        description="Name of one of the two matched objects; if empty, the match that the panel shows is meant, or "
        "else that of the active object",
    )
    prefix: bpy.props.StringProperty(
        name="Prefix",
        description="What the names that the match wrote start with; needed only for a named or active object that "
        "carries several matches",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it in Object Mode."""
        return can_start(cls, context)

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Write the other answer."""
        manager = window_manager_of(context)
        manager.progress_begin(0, 100)
        try:
            half = self._half(context)
            stored, names = flip(
                context, half, lambda done: manager.progress_update(min(99, int(100 * done)))
            )  # 100 breaks the cursor
        except HierMatchError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            manager.progress_end()
        summary = state_of(context).summary
        same = (summary.prefix, summary.key) == (half.prefix, stored.key)
        remember(summary, stored, names, half.prefix, summary.seconds if same else 0.0)
        refresh(cast("bpy.types.Scene", context.scene))
        which = "mirrored" if stored.mirrored else "direct"
        self.report({"INFO"}, f'Wrote the {which} match of "{names[0]}" and "{names[1]}"')
        return {"FINISHED"}

    def _half(self, context: bpy.types.Context) -> Half:
        """Find one side of the match that is meant."""
        summary, view_layer = state_of(context).summary, view_layer_of(context)
        if self.object:
            return find_half(named_object(self.object), self.prefix)
        if summary.key and self.prefix in ("", summary.prefix):
            role = "target" if summary.swapped else "source"
            return find_keyed(view_layer, summary.key, summary.prefix, role, summary.source)
        if view_layer.objects.active is None:
            raise ObjectError("There is no match to flip. Match two meshes first, or name one that carries a match.")
        return find_half(view_layer.objects.active, self.prefix)
