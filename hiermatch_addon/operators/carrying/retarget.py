# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Everything at once: match, fit the rig, and carry over what the source has."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.options.retarget import RetargetOptions, chosen_transfers
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_retarget(RetargetOptions, TransferOperator, bpy.types.Operator):
    """Match two meshes and make the one work like the other."""

    bl_idname = "hiermatch.retarget"
    bl_label = "Retarget"
    bl_description = (
        "Match the source with the target if that has not been done, and carry its rig, weights, shape keys and UV "
        "maps over, whatever the pose, build and topology of the target"
    )
    bl_options = {"REGISTER", "UNDO"}

    doing = "Retargeting"
    optional = True

    def _transfers(self) -> list[Transfer]:
        return chosen_transfers(self, self.prefix)
