# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions of shape keys, which those of another object can play as well if they have the same names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from .motion.action_curves import slot_curves
from .shape_key_io import keys_of

if TYPE_CHECKING:
    from collections.abc import Collection

    import bpy


def share_key_action(source: bpy.types.Object, target: bpy.types.Object, paths: Collection[str]) -> tuple[str, str]:
    """Let an object's shape keys play the action of another's, if it moves some of those that both have.

    Parameters
    ----------
    source, target : bpy.types.Object
        The objects; both have shape keys.
    paths : collection of str
        What both have, see `key_paths`.

    Returns
    -------
    shared : str
        Name of the action; empty if there is none to share.
    note : str
        What is to be known of it; may be empty.
    """
    keys = cast("bpy.types.Key", keys_of(target))
    mine: Any = cast("bpy.types.Key", keys_of(source)).animation_data
    if mine is None:
        return "", ""
    note = f'The NLA tracks of the shape keys of "{source.name}" were left out.' if mine.nla_tracks else ""
    slot = getattr(mine, "action_slot", None)
    if mine.action is None or not any(curve.data_path in paths for curve in slot_curves(mine.action, slot)):
        return "", note
    theirs: Any = keys.animation_data or keys.animation_data_create()
    if theirs.action not in (None, mine.action):
        return "", f'The shape keys of "{target.name}" keep their own action "{theirs.action.name}".'
    theirs.action = mine.action
    if hasattr(mine, "action_slot"):
        theirs.action_slot = mine.action_slot
    return mine.action.name, note
