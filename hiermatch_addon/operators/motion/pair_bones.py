# SPDX-License-Identifier: GPL-3.0-or-later
"""Pair the bones of rigs by the surface that they move."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.motion.bone_pairs import pairing_job
from .motion_operator import MotionOperator

if TYPE_CHECKING:
    from ...jobs.transfer_job import TransferJob, TransferOptions
    from ...scene.character import Side


class HIERMATCH_OT_pair_bones(MotionOperator, bpy.types.Operator):
    """Pair bones."""

    bl_idname = "hiermatch.pair_bones"
    bl_label = "Pair Bones"
    bl_description = (
        "Find out which bones of two rigs belong together by the surface that they move, whatever they are called. "
        "The bodies are matched first if that has not been done"
    )

    doing = "Pairing bones"

    def _make_job(
        self, context: bpy.types.Context, source: Side, targets: list[Side], options: TransferOptions
    ) -> TransferJob:
        return pairing_job(context, source, targets, options)[0]
