# SPDX-License-Identifier: GPL-3.0-or-later
"""The job of ours that is running, if any, as Blender itself knows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import window_manager_of
from ..common.translated_text import translated

if TYPE_CHECKING:
    _Operator = bpy.types.Operator
else:
    _Operator = object


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


class Startable(_Operator):
    """An operator that starts only while no job of ours runs; to be inherited from before `bpy.types.Operator`.

    Attributes
    ----------
    modes : tuple of str
        The modes in which it may start; any if there are none.
    """

    bl_options = {"REGISTER", "UNDO"}
    modes: tuple[str, ...] = ("OBJECT",)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Tell whether it may start, and say on the disabled button why not."""
        if is_running(window_manager_of(context)):
            said = translated("HierMatch is at work. Wait for it, or cancel it")
        elif not cls.modes or context.mode in cls.modes:
            said = cls._lacking(context)
        elif "EDIT_MESH" in cls.modes:
            said = translated("Switch to Object Mode or to Edit Mode first")
        else:
            said = translated("Switch to Object Mode first")
        if said:
            cls.poll_message_set(said)
        return not said

    @classmethod
    def _lacking(cls, _context: bpy.types.Context) -> str:
        """Say what else it takes to start, in the language of the interface; empty if nothing is missing."""
        return ""
