# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Show in colors how fitted clothes lie on a body."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ...common.access import mesh_of, view_layer_of, window_manager_of
from ...common.errors import ObjectError
from ...common.redraw import redraw_views
from ...jobs.running import Startable
from ...scene.pair import check_writable
from ...transfers.wearing.fit_colors import FIT_ITEMS, FIT_NAMES, carriers_of_fit
from ..reported_errors import reporting_errors
from ..show import show_colors

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_show_fit(Startable, bpy.types.Operator):
    """Show in colors how fitted clothes lie on a body."""

    bl_idname = "hiermatch.show_fit"
    bl_label = "Show Fit"
    bl_description = "Show in this viewport what Wear has written with Show Fit on"
    modes = ("OBJECT", "POSE")

    view: bpy.props.EnumProperty(name="Show", description="What to show", items=FIT_ITEMS, default="DISTANCE")

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:  # noqa: ANN401 - the operator's own
        """Describe the button by what it shows."""
        return {identifier: text for identifier, _, text in FIT_ITEMS}[properties.view]

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Show it on all that carries it; Nothing of Show brings back what was shown before."""
        items = carriers_of_fit(view_layer_of(context))
        if not items:
            raise ObjectError("Nothing here carries the colors of a fit. Press Wear with Show Fit on.")
        for item in items:
            check_writable(item)
        show_colors(context, dict.fromkeys(map(mesh_of, items), FIT_NAMES[self.view]))
        redraw_views(window_manager_of(context))
        return {"FINISHED"}
