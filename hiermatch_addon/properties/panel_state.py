# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of the panels, which is attached to scene and window manager, typed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    import bpy

    from .properties import HIERMATCH_PG_progress, HIERMATCH_PG_scene, HIERMATCH_PG_summary


def state_of(context: bpy.types.Context) -> HIERMATCH_PG_scene:
    """Return the panel's state on the scene."""
    return cast("Any", context.scene).hiermatch


def picked(state: HIERMATCH_PG_scene) -> tuple[bpy.types.ID | None, bpy.types.ID | None]:
    """Return what is picked as source and as target: an object or a collection each, or None."""
    return state.source or state.source_collection, state.target or state.target_collection


def pick(state: HIERMATCH_PG_scene, role: str, chosen: bpy.types.ID | None) -> None:
    """Pick an object or a collection as "source" or "target", or nothing."""
    collection = chosen is not None and chosen.id_type == "COLLECTION"
    setattr(state, f"{role}_collection", chosen if collection else None)
    setattr(state, role, None if collection else chosen)


def summary_of(scene: bpy.types.Scene) -> HIERMATCH_PG_summary:
    """Return what a scene's panel remembers of the last match."""
    return cast("Any", scene).hiermatch.summary


def progress_of(context: bpy.types.Context) -> HIERMATCH_PG_progress:
    """Return the progress of the running match."""
    return cast("Any", context.window_manager).hiermatch
