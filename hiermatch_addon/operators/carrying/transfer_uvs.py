# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry UV maps from one mesh to others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.options.uvs import UVOptions, uv_settings
from ...transfers.uvs import UVTransfer
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_transfer_uvs(UVOptions, TransferOperator, bpy.types.Operator):
    """Carry UV maps over."""

    bl_idname = "hiermatch.transfer_uvs"
    bl_label = "Transfer UVs"
    bl_description = (
        "Carry the source's UV maps to the matched meshes, whatever their pose and topology, so that its textures fit "
        "them. Islands stay islands: no face is smeared across a seam"
    )
    bl_options = {"REGISTER", "UNDO"}

    def _transfers(self) -> list[Transfer]:
        return [UVTransfer(uv_settings(self))]
