# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry attributes, materials, marked edges and normals from one mesh to others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.attributes import AttributeTransfer
from ...transfers.options.attributes import AttributeOptions, attribute_settings
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_transfer_attributes(AttributeOptions, TransferOperator, bpy.types.Operator):
    """Carry attributes over."""

    bl_idname = "hiermatch.transfer_attributes"
    bl_label = "Transfer Attributes"
    bl_description = (
        "Carry color and other attributes, materials, sharp edges, creases and custom normals of the source to the "
        "matched meshes, whatever their pose and topology"
    )
    bl_options = {"REGISTER", "UNDO"}

    def _transfers(self) -> list[Transfer]:
        return [AttributeTransfer(attribute_settings(self))]
