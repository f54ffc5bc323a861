# SPDX-License-Identifier: GPL-3.0-or-later
"""Common base of the operators between rigs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..carrying.transfer_operator import TransferOperator

if TYPE_CHECKING:
    import bpy


class MotionOperator(TransferOperator):
    """To be inherited from before `bpy.types.Operator`."""

    doing = "Carrying motion over"
    panel = "HIERMATCH_PT_motion"
    modes = ("OBJECT", "POSE")

    @classmethod
    def _lacking(cls, _context: bpy.types.Context) -> str:
        return ""  # bones that are paired by hand need no meshes
