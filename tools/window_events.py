# SPDX-License-Identifier: GPL-3.0-or-later
"""Buttons, keys and clicks as a person gives them, and waiting for what they start."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import bpy
from screen import view

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["click", "key", "press", "running", "until"]

_SOON = 0.02
"""Seconds between two looks at something that is waited for."""

_PATIENCE = 600.0
"""Seconds after which a step that still runs has failed."""


def running() -> bool:
    """Tell whether one of our operators runs in the window."""
    operators = bpy.context.window_manager.windows[0].modal_operators
    return any(operator.bl_idname.startswith("HIERMATCH_OT_") for operator in operators)


def press(operator: Callable[..., Any], **options: object) -> None:
    """Start an operator as its button does."""
    with bpy.context.temp_override(**view()):
        operator("INVOKE_DEFAULT", True, **options)  # noqa: FBT003 - True: it is an undo step, as if by a button


def click(x: int, y: int) -> None:
    """Click at a place of the window."""
    for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
        view()["window"].event_simulate(type=kind, value=value, x=x, y=y)


def key(name: str) -> None:
    """Press a key over the viewport."""
    place = view()
    region = place["region"]
    middle = (region.x + region.width // 3, region.y + region.height // 2)
    for value in ("PRESS", "RELEASE"):
        place["window"].event_simulate(type=name, value=value, x=middle[0], y=middle[1])


def until(condition: Callable[[], bool], what: str) -> Iterator[float | None]:
    """Wait, while the window goes on, until something holds.

    Raises
    ------
    TimeoutError
        If it takes too long.
    """
    end = time.monotonic() + _PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(f"{what} takes too long.")
        yield _SOON
    yield None
