# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry shape keys from one mesh to others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.options.shape_keys import ShapeKeyOptions, shape_key_settings
from ...transfers.shape_keys import ShapeKeyTransfer
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_transfer_shape_keys(ShapeKeyOptions, TransferOperator, bpy.types.Operator):
    """Carry shape keys over."""

    bl_idname = "hiermatch.transfer_shape_keys"
    bl_label = "Transfer Shape Keys"
    bl_description = (
        "Carry the source's shape keys to the matched meshes, whatever their pose and topology, with their values, "
        "ranges and drivers"
    )
    bl_options = {"REGISTER", "UNDO"}

    def _transfers(self) -> list[Transfer]:
        return [ShapeKeyTransfer(shape_key_settings(self))]
