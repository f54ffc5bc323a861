# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Add something to try the matching on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..demo.demo_pair import add_demo_pair
from ..jobs.running import Startable

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_add_demo_pair(Startable, bpy.types.Operator):
    """Add a standing and a walking cat to match, with different meshes."""

    bl_idname = "hiermatch.add_demo_pair"
    bl_label = "Add Demo Pair"
    bl_description = "Add the same cat twice, in two poses and with two different meshes, to try the matching on"

    source_vertices: bpy.props.IntProperty(
        name="Source Vertices",
        description="About how many vertices the standing cat gets; its faces are mostly quads",
        default=5500,
        min=1000,
        max=15_000,
    )
    target_vertices: bpy.props.IntProperty(
        name="Target Vertices",
        description="About how many vertices the walking cat gets; its faces are triangles",
        default=4000,
        min=1000,
        max=15_000,
    )

    rigged: bpy.props.BoolProperty(
        name="Rigged",
        description="Give the standing cat an armature, weights, shape keys and a UV map, to try Retarget on",
    )

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Build the cats."""
        add_demo_pair(
            context,
            source_vertices=self.source_vertices,
            target_vertices=self.target_vertices,
            rigged=self.rigged,
        )
        _frame_selected(context)
        return {"FINISHED"}


def _frame_selected(context: bpy.types.Context) -> None:
    """Turn the 3D viewport that the operator was called from, if any, to what is selected."""
    if bpy.app.background or context.area is None or context.area.type != "VIEW_3D":
        return
    region = next((region for region in context.area.regions if region.type == "WINDOW"), None)
    if region is not None:
        with context.temp_override(area=context.area, region=region):
            bpy.ops.view3d.view_selected()
