# SPDX-License-Identifier: GPL-3.0-or-later
"""Freshness of the match that the panel shows: whether it is still one of the meshes as they are.

To find that out takes a look at every vertex.  So nothing is looked at while the panel is drawn, but a moment after a
mesh that carries a match was edited, after objects came or went, after undo and redo, and after a file was opened.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy
from bpy.app.handlers import persistent

from ..common.access import mesh_of
from ..common.redraw import redraw_sidebars
from ..scene.mesh_io import unedited
from ..storage.halves import MIRRORED, find_carriers, is_mirrored, meant
from ..storage.landmark_layer import has_landmarks
from ..storage.writing import is_marked
from .panel_state import state_of, summary_of
from .steering_lists import sync_lists
from .summary import is_of_picked, remember

if TYPE_CHECKING:
    from ..storage.halves import Half
    from ..storage.stored_match import StoredMatch
    from .properties import HIERMATCH_PG_summary

_DELAY = 0.3
"""Seconds from an edit to the look at it, so that many edits in a row cost one look."""

_PLAYING_DELAY = 1.0
"""Seconds until the next try while an animation plays, which must not stutter."""


@unedited()
def refresh(scene: bpy.types.Scene) -> None:
    """Find out whether the match that a scene's panel shows is out of date, and what its lists are to show.

    If one of its meshes was renamed, the panel calls it by its new name.
    """
    summary = summary_of(scene)
    before, stale, lost, hidden = _shown(summary), "", False, False
    if summary.key:
        for role, name in _sides(summary):
            carriers = find_carriers(scene.objects, summary.key, summary.prefix, role)
            stale, lost = stale or _staleness(scene, carriers, name), lost or not carriers
            half = meant(carriers, name)
            if half is not None and half.obj.name != name:
                setattr(summary, "source" if summary.source == name else "target", half.obj.name)
        hidden = not is_of_picked(scene)
    for field, value in (("stale", stale), ("lost", lost), ("hidden", hidden)):
        if getattr(summary, field) != value:
            setattr(summary, field, value)
    if before != _shown(summary):
        # Blender draws again what an operator changed, but not what a timer did.
        redraw_sidebars(cast("bpy.types.WindowManager", bpy.context.window_manager))
    sync_lists(scene)


def show_match(
    context: bpy.types.Context, stored: StoredMatch, names: tuple[str, str], prefix: str, seconds: float = 0.0
) -> None:
    """Let the panel tell of a match that was just written between objects of these names.

    Seconds are how long it took; zero if that is not known.
    """
    remember(state_of(context).summary, stored, names, prefix, seconds)
    refresh(cast("bpy.types.Scene", context.scene))


def _shown(summary: HIERMATCH_PG_summary) -> tuple[Any, ...]:
    """Return that of a summary which `refresh` may change."""
    return summary.stale, summary.lost, summary.hidden, summary.source, summary.target


def _sides(summary: HIERMATCH_PG_summary) -> tuple[tuple[str, str], tuple[str, str]]:
    """Role and name of what was matched as the source, and of what as the target."""
    names = (summary.target, summary.source) if summary.swapped else (summary.source, summary.target)
    return ("source", names[0]), ("target", names[1])


def _staleness(scene: bpy.types.Scene, carriers: list[Half], name: str) -> str:
    """Say why a match is out of date on one side: of copies, the one that still has the name counts."""
    is_there = name in scene.objects or name in bpy.data.collections or " + " in name
    if not carriers and not is_there:  # what a picker still holds is in the file, but not in the scene
        return f'The match is out of date: "{name}" was deleted.'
    if not carriers:
        return f'The match is out of date: "{name}" was cleared or matched anew. Match again.'
    return (meant(carriers, name) or carriers[0]).staleness()


def start_watching() -> None:
    """Let Blender tell when there is something to look at."""
    for handlers, function in _handlers():
        handlers.append(function)


def stop_watching() -> None:
    """Undo `start_watching`."""
    for handlers, function in _handlers():
        if function in handlers:  # another add-on may have cleared the list
            handlers.remove(function)
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)


def _handlers() -> tuple[tuple[list[Any], Any], ...]:
    handlers: Any = bpy.app.handlers
    return (
        (handlers.depsgraph_update_post, _on_update),
        (handlers.undo_post, _on_change),
        (handlers.redo_post, _on_change),
        (handlers.load_post, _on_change),
    )


@persistent  # type: ignore[untyped-decorator]
def _on_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Look soon if a mesh with a match was edited, mirrored or renamed, or objects came or went.

    Posing, moving and selecting objects edits no mesh and no collection, and turns no object over.
    """
    if depsgraph.id_type_updated("COLLECTION") or _is_noticed(depsgraph):
        _look_soon()


def _is_noticed(depsgraph: bpy.types.Depsgraph) -> bool:
    """Return whether something has happened to meshes that carry a match or landmarks, or to their objects."""
    updates = [(update, update.id) for update in depsgraph.updates]
    if any(
        update.is_updated_geometry and (is_marked(changed) or has_landmarks(changed))
        for update, changed in updates
        if isinstance(changed, bpy.types.Mesh)
    ):
        return True
    ours = [(update, obj) for update, obj in updates if isinstance(obj, bpy.types.Object) and _is_matched(obj)]
    moved = [obj for update, obj in ours if update.is_updated_transform]
    return _is_renamed([obj for _, obj in ours]) or _is_turned_over(moved)


def _is_matched(obj: bpy.types.Object) -> bool:
    return obj.type == "MESH" and is_marked(mesh_of(obj))


def _is_renamed(objects: list[bpy.types.Object]) -> bool:
    """Return whether one of these may be one that a panel still calls by a name that nothing has any more."""
    summaries = [summary for scene in bpy.data.scenes if (summary := summary_of(scene)).key and not summary.stale]
    names = {name for summary in summaries for _, name in _sides(summary)}
    if all(obj.name in names for obj in objects):
        return False
    parts = {part for name in names for part in name.split(" + ")}  # of a side of several objects
    return any(part not in bpy.data.objects and part not in bpy.data.collections for part in parts)


def _is_turned_over(objects: list[bpy.types.Object]) -> bool:
    """Return whether one of these was mirrored since it was matched, or may have been turned back."""
    if not objects:
        return False
    return any(MIRRORED in summary_of(scene).stale for scene in bpy.data.scenes) or any(map(is_mirrored, objects))


@persistent  # type: ignore[untyped-decorator]
def _on_change(*_arguments: object) -> None:
    """Look soon, whatever has changed."""
    _look_soon()


def _look_soon() -> None:
    if not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=_DELAY)


def _look() -> float | None:
    """Look at every scene; return when to try again, if this was no good time."""
    manager: Any = bpy.context.window_manager
    if any(window.screen.is_animation_playing for window in manager.windows):
        return _PLAYING_DELAY
    for scene in bpy.data.scenes:
        if scene.library is None:
            refresh(scene)
    return None
