# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Carry weights to meshes that have a rig of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ...common.translated_text import translated
from ...properties.bone_pairs import bone_pairs_of
from ...transfers.motion.paired_weights import PairedWeightTransfer
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_transfer_paired_weights(TransferOperator, bpy.types.Operator):
    """Carry weights to another rig."""

    bl_idname = "hiermatch.transfer_paired_weights"
    bl_label = "Weights to Own Rig"
    bl_description = (
        "Carry the source's weights to the bones that the target has already, through the pairs of bones: they are "
        "shared out where it has more bones, and added up where it has fewer"
    )

    limit: bpy.props.IntProperty(
        name="Limit Bones", description="How many bones may move a vertex at most; 0 for any number", min=0, default=4
    )

    panel = "HIERMATCH_PT_motion"

    @classmethod
    def _lacking(cls, context: bpy.types.Context) -> str:
        is_paired = len(bone_pairs_of(cast("bpy.types.Scene", context.scene)))
        return super()._lacking(context) or ("" if is_paired else translated("Pair the bones first"))

    def _transfers(self) -> list[Transfer]:
        return [PairedWeightTransfer(self.limit)]
