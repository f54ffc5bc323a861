# SPDX-License-Identifier: GPL-3.0-or-later
"""Exchange source and target."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ..common.access import mesh_of
from ..common.translated_text import translated
from ..properties.panel_state import pick, picked, state_of
from ..properties.steering_lists import steered_pair
from ..scene.character import parts_of
from ..storage.halves import find_common
from ..storage.writing import change_kept

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ..storage.halves import Half


class HIERMATCH_OT_swap(bpy.types.Operator):
    """Exchange the picked source and target."""

    bl_idname = "hiermatch.swap"
    bl_label = "Swap Source and Target"
    bl_description = (
        "Exchange Source and Target; the match that the two carry, with its dense map, then serves the other way round"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it when there is something to exchange."""
        state = state_of(context)
        if not any(picked(state)):
            cls.poll_message_set(translated("Pick a Source or a Target first"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Exchange them, and with them what the panel calls source and target of a match that they carry."""
        state = state_of(context)
        for role, chosen in zip(("target", "source"), picked(state), strict=True):
            pick(state, role, chosen)
        state.exclude_source, state.exclude_target = state.exclude_target, state.exclude_source
        pair = steered_pair(cast("bpy.types.Scene", context.scene)) if all(picked(state)) else None
        for half, partner in find_common(*pair) if pair else ():
            _keep_swapped(half, partner)
        return {"FINISHED"}


def _keep_swapped(half: Half, partner: Half) -> None:
    """Call the first of the two sides of a match the source from now on, also when another answer is written."""
    for side in (half, partner):
        if all(mesh_of(part).library is None for part in parts_of(side.obj)):
            change_kept(side.obj, side.prefix, swapped=half.role == "target")
