# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether one of our jobs is running, as Blender itself knows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..common.access import window_manager_of
from ..common.translated_text import translated

if TYPE_CHECKING:
    import bpy

__all__ = ["can_start", "is_running", "running_panel"]


def is_running(window_manager: bpy.types.WindowManager) -> bool:
    """Return whether one of our operators runs modally in a window."""
    return bool(running_panel(window_manager))


def running_panel(window_manager: bpy.types.WindowManager) -> str:
    """Return the identifier of the panel that shows the job that runs; empty if none does.

    Operators that wait for clicks, or for a name in the file browser, run modally, too, but do no work.
    """
    operators: Any = (operator for window in window_manager.windows for operator in window.modal_operators)
    ours = (operator for operator in operators if operator.bl_idname.startswith("HIERMATCH_OT_"))
    return next((panel for operator in ours if (panel := getattr(operator, "panel", ""))), "")


def can_start(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Tell, and say on the disabled button, whether an operator that writes on objects may start."""
    if is_running(window_manager_of(context)):
        cls.poll_message_set(translated("HierMatch is at work. Wait for it, or cancel it"))
        return False
    if context.mode != "OBJECT":
        cls.poll_message_set(translated("Switch to Object Mode first"))
        return False
    return True
