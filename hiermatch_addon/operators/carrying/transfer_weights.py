# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry weights from one mesh to others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.options.weights import WeightOptions, weight_settings
from ...transfers.weights import WeightTransfer
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_transfer_weights(WeightOptions, TransferOperator, bpy.types.Operator):
    """Carry weights over."""

    bl_idname = "hiermatch.transfer_weights"
    bl_label = "Transfer Weights"
    bl_description = "Carry the source's vertex groups to the matched meshes, whatever their pose and topology"
    bl_options = {"REGISTER", "UNDO"}

    def _transfers(self) -> list[Transfer]:
        return [WeightTransfer(weight_settings(self, self.prefix))]
