# SPDX-License-Identifier: GPL-3.0-or-later
"""Buttons, keys and clicks as a person gives them, waiting for what they start, and one step after the other."""

from __future__ import annotations

import sys
import time
import traceback
from typing import TYPE_CHECKING, Any

import bpy
from screen import view

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["check", "click", "key", "play", "press", "running", "until"]

_SOON = 0.02
"""Seconds between two looks at something that is waited for."""

_PATIENCE = 600.0
"""Seconds after which a step that still runs has failed."""

_PAUSE = 0.8
"""Seconds between two drawings of the window: enough in software, too."""

_DRAWINGS = 2
"""How often it is drawn between two steps: new sections of panels are measured at first, and seen at last."""


class StepError(Exception):
    """A step did not do what it should; the message says which."""


def check(condition: object, message: str) -> None:
    """Make sure that a step did what it should."""
    if not condition:
        raise StepError(message)


def play(steps: Iterator[float | None]) -> None:
    """Do one step after the other by Blender's own timer, and end Blender: with an error as soon as one fails.

    Parameters
    ----------
    steps : iterator of float or None
        What does a step whenever it is asked for the next pause, in seconds; None lets the window be drawn.
    """
    to_draw = 0

    def advance() -> float | None:
        nonlocal to_draw
        if to_draw:
            to_draw -= 1
            bpy.context.window_manager.windows[0].screen.areas[0].tag_redraw()
            return _PAUSE
        try:
            pause = next(steps)
        except StopIteration:
            bpy.ops.wm.quit_blender()
            return None
        except Exception:  # noqa: BLE001 - whatever it is, nobody sits before this window
            traceback.print_exc()
            sys.stderr.flush()
            sys.exit(1)
        if pause is None:
            to_draw, pause = _DRAWINGS, _PAUSE
        return pause

    bpy.app.timers.register(advance, first_interval=_PAUSE, persistent=True)


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
