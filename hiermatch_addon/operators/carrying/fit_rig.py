# SPDX-License-Identifier: GPL-3.0-or-later
"""Give other meshes the rig of one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.options.rig import RigOptions, rig_settings
from ...transfers.rest_like_source import RestLikeSource
from ...transfers.rig import RigTransfer
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_fit_rig(RigOptions, TransferOperator, bpy.types.Operator):
    """Give the target a rig."""

    bl_idname = "hiermatch.fit_rig"
    bl_label = "Fit Rig"
    bl_description = (
        "Give the matched meshes a copy of the source's armature each, with its joints where they belong in their pose "
        "and build, and bind them to it"
    )
    bl_options = {"REGISTER", "UNDO"}

    optional = True  # the rest pose is; without a rig there is none either

    def _transfers(self) -> list[Transfer]:
        rig = RigTransfer(rig_settings(self))
        return [rig, RestLikeSource(rig_settings(self), rig)]
