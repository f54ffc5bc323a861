# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Show a target with and without what it got."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...common.access import view_layer_of
from ...common.errors import ObjectError
from ...common.translated_text import translated
from ...jobs.running import Startable
from ...properties.panel_state import picked, state_of
from ...scene.character import parts_of, side_of
from ...scene.pair import check_writable, named_side
from ...scene.posing.before_after import is_before, show_after, show_before
from ...transfers.retarget_properties import retarget_of
from ..reported_errors import reporting_errors
from .rig_operator import meant_target

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...scene.character import Side


class HIERMATCH_OT_before_after(Startable, bpy.types.Operator):
    """Show a target without its new rig, shape keys and clothes, and again with them."""

    bl_idname = "hiermatch.before_after"
    bl_label = "Before and After"
    bl_description = (
        "Show the target as it stood before it got rig, shape keys and clothes; pressed again, as it is now, with the "
        "pose that it was in"
    )
    modes = ("OBJECT", "POSE", "PAINT_WEIGHT")

    target: bpy.props.StringProperty(
        name="Target",
        description="Name of the mesh; if empty, the one picked in the panel, that of the last retarget, or else the "
        "active object",
        options={"SKIP_SAVE"},
    )

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Go from one to the other."""
        target = meant_target(context, self.target)
        for part in parts_of(target):
            check_writable(part)
        if is_before(target):
            show_after(target)
            self.report({"INFO"}, translated(f'"{target.name}" is shown as it is'))
            return {"FINISHED"}
        if not show_before(target, _source_of(context)):
            raise ObjectError(
                f'"{target.name}" has no rig, shape keys or clothes that came from a source, so it is as it was before.'
            )
        self.report({"INFO"}, translated(f'"{target.name}" is shown as it was before'))
        return {"FINISHED"}


def _source_of(context: bpy.types.Context) -> Side | None:
    """Find what the target got its keys from, if it is still there."""
    chosen, layer = picked(state_of(context))[0], view_layer_of(context)
    last = retarget_of(context).report.source
    try:
        if chosen is not None:
            return side_of(chosen, layer)
        return named_side(layer, last) if last else None
    except ObjectError:
        return None
