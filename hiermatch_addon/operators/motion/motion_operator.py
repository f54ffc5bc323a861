# SPDX-License-Identifier: GPL-3.0-or-later
"""Common base of the operators between rigs."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from ...jobs.running import can_start
from ..carrying.transfer_operator import TransferOperator

if TYPE_CHECKING:
    import bpy


class MotionOperator(TransferOperator):
    """To be inherited from before `bpy.types.Operator`."""

    doing = "Carrying motion over"
    panel = "HIERMATCH_PT_motion"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it in Object Mode and Pose Mode, when nothing else is running."""
        return can_start(cast("type[bpy.types.Operator]", cls), context, posing=True)
