# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Change the table of pairs of bones by hand."""

from __future__ import annotations

from typing import cast

import bpy

from ...common.errors import ObjectError
from ...properties.bone_pairs import add_row, bone_pairs_of, clear_rows, remove_rows, rows_of
from ...scene.motion.rigs import rig_of
from ...transfers.retarget_properties import retarget_of
from ..pair_operator import PairOperator, pick_sides


class PairEditor(PairOperator):
    """What operators on the table of two armatures have in common."""

    modes = ()

    def _sides(self, context: bpy.types.Context) -> tuple[bpy.types.Object, bpy.types.Object]:
        source, targets, _ = pick_sides(context, self.source, [self.target] if self.target else [])
        return rig_of(source), rig_of(targets[0])


class HIERMATCH_OT_add_bone_pair(PairEditor, bpy.types.Operator):
    """Add a pair of bones."""

    bl_idname = "hiermatch.add_bone_pair"
    bl_label = "Add Bone Pair"
    bl_description = "Pair two bones by hand, and lock the pair; without a source bone, the target's bone stays alone"

    source_bone: bpy.props.StringProperty(
        name="Source Bone", description="Bone of the source; empty for none", options={"SKIP_SAVE"}
    )
    target_bone: bpy.props.StringProperty(
        name="Target Bone",
        description="Bone of the target; if empty, the active bones of both armatures are paired",
        options={"SKIP_SAVE"},
    )

    def _do(self, context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> str:
        bones = self.source_bone, self.target_bone
        if not bones[1]:
            active = [cast("bpy.types.Armature", rig.data).bones.active for rig in (source, target)]
            if active[0] is None or active[1] is None:
                raise ObjectError("Which bones are meant is open. Make one bone of each armature active, in Pose Mode.")
            bones = active[0].name, active[1].name
        scene = cast("bpy.types.Scene", context.scene)
        add_row(scene, (source, target), bones)
        retarget_of(context).bone_pair = len(bone_pairs_of(scene)) - 1
        return f'Paired "{bones[0]}" with "{bones[1]}"' if bones[0] else f'"{bones[1]}" stays alone'


class HIERMATCH_OT_remove_bone_pair(PairEditor, bpy.types.Operator):
    """Remove a pair of bones."""

    bl_idname = "hiermatch.remove_bone_pair"
    bl_label = "Remove Bone Pair"
    bl_description = "Take a pair of bones out of the table"

    target_bone: bpy.props.StringProperty(
        name="Target Bone", description="Bone of the target whose pairs are removed", options={"SKIP_SAVE"}
    )
    source_bone: bpy.props.StringProperty(
        name="Source Bone", description="Remove its pair with this bone only; if empty, all", options={"SKIP_SAVE"}
    )

    def _do(self, context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> str:
        scene = cast("bpy.types.Scene", context.scene)
        gone = [
            row
            for row in rows_of(scene, source, target)
            if row.target == self.target_bone and self.source_bone in {"", row.source}
        ]
        if not gone:
            raise ObjectError(f'"{self.target_bone}" of "{target.name}" is not in the table of pairs.')
        remove_rows(scene, gone)
        return f'"{self.target_bone}" was taken out of the table'


class HIERMATCH_OT_clear_bone_pairs(PairEditor, bpy.types.Operator):
    """Clear the table of pairs."""

    bl_idname = "hiermatch.clear_bone_pairs"
    bl_label = "Clear Bone Pairs"
    bl_description = "Take the pairs of two armatures out of the table"

    locked: bpy.props.BoolProperty(name="Locked Too", description="Take locked pairs out as well")

    def _do(self, context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> str:
        count = clear_rows(cast("bpy.types.Scene", context.scene), (source, target), locked=self.locked)
        return f"{count} pairs were taken out of the table"
