# SPDX-License-Identifier: GPL-3.0-or-later
"""The job of ours that is running, if any, as Blender itself knows it."""

from __future__ import annotations

from typing import Any, cast

import bpy

from ..common.access import window_manager_of
from ..common.translated_text import translated


def is_running(window_manager: bpy.types.WindowManager) -> bool:
    """Return whether one of our operators runs modally in a window."""
    return bool(running_panel(window_manager))


def running_panel(window_manager: bpy.types.WindowManager) -> str:
    """Return the identifier of the panel that shows the job that runs; empty if none does.

    Operators that wait for clicks, or for a name in the file browser, run modally, too, but do no work.
    """
    operators = (operator for _, operator in modal_operators(window_manager))
    return next((panel for operator in operators if (panel := getattr(operator, "panel", ""))), "")


def modal_operators(window_manager: bpy.types.WindowManager) -> list[tuple[bpy.types.Window, Any]]:
    """Return our operators that run modally, each with its window."""
    windows: Any = window_manager.windows
    return [
        (window, operator)
        for window in windows
        for operator in window.modal_operators
        if operator.bl_idname.startswith("HIERMATCH_OT_")
    ]


def start_soon(context: bpy.types.Context, operator: str, **options: Any) -> None:  # noqa: ANN401 - the operator's own
    """Start an operator, such as "hiermatch.guide_me", in this window once the one that runs has ended."""
    window: Any = context.window

    def start() -> None:
        manager: Any = bpy.context.window_manager
        if window is None or window not in list(manager.windows):
            return  # closed meanwhile
        area = next((area for area in window.screen.areas if area.type == "VIEW_3D"), None)
        region = next((region for region in area.regions if region.type == "WINDOW"), None) if area else None
        started: Any = bpy.ops
        for name in operator.split("."):
            started = getattr(started, name)
        with cast("Any", bpy.context).temp_override(window=window, area=area, region=region):
            if started.poll():
                started("INVOKE_DEFAULT", **options)

    bpy.app.timers.register(start, first_interval=0.0)


def is_idle(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Tell, and say on the disabled button, whether no job of ours is running."""
    if is_running(window_manager_of(context)):
        cls.poll_message_set(translated("HierMatch is at work. Wait for it, or cancel it"))
        return False
    return True


def can_start(
    cls: type[bpy.types.Operator], context: bpy.types.Context, *, posing: bool = False, painting: bool = False
) -> bool:
    """Tell, and say on the disabled button, whether an operator that writes on objects may start.

    One that is about armatures may do so while they are posed, too, and one that leaves meshes alone while weights are
    painted.
    """
    if not is_idle(cls, context):
        return False
    modes = ("OBJECT", *(["POSE"] if posing else []), *(["PAINT_WEIGHT"] if painting else []))
    if context.mode not in modes:
        cls.poll_message_set(translated("Switch to Object Mode first"))
        return False
    return True
