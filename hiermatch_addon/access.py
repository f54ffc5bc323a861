# SPDX-License-Identifier: GPL-3.0-or-later
"""What an operator or panel always finds in its context, typed.

Blender's own types call these optional, because a context may lack them in places where no operator runs, and know
nothing of the properties that the add-on attaches.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    import bpy

    from .properties import HIERMATCH_PG_progress, HIERMATCH_PG_scene, HIERMATCH_PG_summary

__all__ = ["layout_of", "mesh_of", "progress_of", "state_of", "summary_of", "view_layer_of", "window_manager_of"]


def state_of(context: bpy.types.Context) -> HIERMATCH_PG_scene:
    """Return the panel's state on the scene."""
    return cast("Any", context.scene).hiermatch


def summary_of(scene: bpy.types.Scene) -> HIERMATCH_PG_summary:
    """Return what a scene's panel remembers of the last match."""
    return cast("Any", scene).hiermatch.summary


def progress_of(context: bpy.types.Context) -> HIERMATCH_PG_progress:
    """Return the progress of the running match."""
    return cast("Any", context.window_manager).hiermatch


def view_layer_of(context: bpy.types.Context) -> bpy.types.ViewLayer:
    """Return the view layer."""
    return cast("bpy.types.ViewLayer", context.view_layer)


def window_manager_of(context: bpy.types.Context) -> bpy.types.WindowManager:
    """Return the window manager."""
    return cast("bpy.types.WindowManager", context.window_manager)


def layout_of(owner: bpy.types.Panel | bpy.types.Operator) -> bpy.types.UILayout:
    """Return the layout of something that is being drawn."""
    return cast("bpy.types.UILayout", owner.layout)


def mesh_of(obj: bpy.types.Object) -> bpy.types.Mesh:
    """Return the mesh data of a mesh object."""
    return cast("bpy.types.Mesh", obj.data)
