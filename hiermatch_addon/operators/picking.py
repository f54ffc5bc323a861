# SPDX-License-Identifier: GPL-3.0-or-later
"""Which source, and which targets, an operator is about."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..properties.panel_state import picked, state_of
from ..scene.character import side_of
from ..scene.pair import active_side, left_out_note, named_side, selected_targets

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy

    from ..scene.character import Side

__all__ = ["pick_sides"]


def pick_sides(
    context: bpy.types.Context, source_name: str, target_names: Sequence[str]
) -> tuple[Side, list[Side], str]:
    """Find the source and the targets: by name, else as picked in the panel, else as selected.

    Returns
    -------
    source : bpy.types.Object or Character
        The source.
    targets : list of bpy.types.Object or Character
        One or more.
    left_out : str
        Which selected parts of the source's own character are no targets, as a sentence; empty for none.

    Raises
    ------
    ObjectError
        If a name is unknown, or the selection leaves open what is meant.
    """
    layer, (picked_source, picked_target) = view_layer_of(context), picked(state_of(context))
    targets = [named_side(layer, name) for name in dict.fromkeys(target_names)]
    source = named_side(layer, source_name) if source_name else None
    if source is None and picked_source is not None:
        source = side_of(picked_source, layer)
    if not targets and picked_target is not None:
        targets = [side for side in [side_of(picked_target, layer)] if side != source]
    if source is None:
        source = active_side(context, without=targets[0] if len(targets) == 1 else None)
        source = None if source in targets else source
    if source is None:
        raise ObjectError("Which mesh is the Source is open: pick it in the panel, or make it the active object.")
    left_out = ""
    if not targets:
        targets, parts = selected_targets(context, source)
        left_out = left_out_note(source, parts) if parts else ""
    if not targets:
        raise ObjectError(
            "It is open which mesh is the Target. Pick it in the panel, or select one or more beside the Source."
        )
    return source, targets, left_out
