# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit an armature that stands in the source, such as a metarig, into other meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.my_rig import MyRigTransfer, check_has_body
from ...transfers.options.my_rig import MyRigOptions, my_rig_settings
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer
    from ...scene.character import Side


class HIERMATCH_OT_fit_my_rig(MyRigOptions, TransferOperator, bpy.types.Operator):
    """Fit an armature of one's own choice."""

    bl_idname = "hiermatch.fit_my_rig"
    bl_label = "Fit My Rig"
    bl_description = (
        "Give the matched meshes a copy each of an armature that stands in the source, such as a metarig of Rigify or "
        "a standard skeleton, with its joints where they belong in them. It need not move the source"
    )

    doing = "Fitting the rig"

    def _pick(self, context: bpy.types.Context) -> tuple[Side, list[Side]]:
        source, targets = super()._pick(context)
        check_has_body(source)
        return source, targets

    def _transfers(self) -> list[Transfer]:
        return [MyRigTransfer(my_rig_settings(self))]
