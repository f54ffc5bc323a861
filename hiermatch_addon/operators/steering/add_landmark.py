# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Name two corresponding vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ...common.errors import ObjectError
from ...scene.character import vertex_count
from ...storage.landmarks import add_landmarks
from .landmark_operator import LandmarkOperator
from .landmark_picking import selected_empties, selected_pair, vertices_at_empties

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...scene.character import Side


class HIERMATCH_OT_add_landmark(LandmarkOperator, bpy.types.Operator):
    """Name two corresponding vertices."""

    bl_idname = "hiermatch.add_landmark"
    bl_label = "Add Landmark"
    bl_description = (
        "Name two corresponding places, to which matches will keep: in Edit Mode the vertices selected on the two "
        "meshes, one on each; in Object Mode the vertices nearest to two selected empties, or those that you click on"
    )

    source_vertex: bpy.props.IntProperty(
        name="Source Vertex",
        description="Vertex of the source; if negative, the selected one",
        default=-1,
        min=-1,
        options={"SKIP_SAVE"},
    )
    target_vertex: bpy.props.IntProperty(
        name="Target Vertex",
        description="Vertex of the target; if negative, the selected one",
        default=-1,
        min=-1,
        options={"SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Let the user click if nothing tells which places are meant."""
        if self.source_vertex < 0 and context.mode == "OBJECT" and len(selected_empties(context)) != 2:
            cast("Any", bpy.ops).hiermatch.pick_landmarks("INVOKE_DEFAULT")
            return {"FINISHED"}
        return self.execute(context)

    def _edit(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        """Add the landmark."""
        if self.source_vertex >= 0 and self.target_vertex >= 0:
            pair = self.source_vertex, self.target_vertex
        elif context.mode == "EDIT_MESH":
            pair = selected_pair(source, target)
        else:
            pair = vertices_at_empties(context, source, target)
        for obj, vertex in zip((source, target), pair, strict=True):
            count = vertex_count(obj)
            if context.mode == "OBJECT" and vertex >= count:
                raise ObjectError(
                    f'"{obj.name}" has no vertex {vertex}: its vertices are numbered from 0 to {count - 1}.'
                )
        (added,) = add_landmarks(source, target, [pair])
        return (
            f'Landmark {added.number}: vertex {added.source} of "{source.name}" is vertex {added.target} of '
            f'"{target.name}"'
        )
