# SPDX-License-Identifier: GPL-3.0-or-later
"""Lay one mesh onto another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.options.wrap import WrapOptions, wrap_settings
from ...transfers.wrap import WrapTransfer
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_wrap(WrapOptions, TransferOperator, bpy.types.Operator):
    """Lay one mesh onto another."""

    bl_idname = "hiermatch.wrap"
    bl_label = "Wrap"
    bl_description = (
        "Lay the source onto the matched mesh, as a shape key whose slider morphs one into the other. Parts that the "
        "other mesh lacks follow their surroundings"
    )
    bl_options = {"REGISTER", "UNDO"}

    def _transfers(self) -> list[Transfer]:
        return [WrapTransfer(wrap_settings(self))]
