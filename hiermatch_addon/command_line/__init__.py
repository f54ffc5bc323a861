# SPDX-License-Identifier: GPL-3.0-or-later
"""``blender --command hiermatch``: matching, retargeting and whole batches without a window."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import bpy

from .command import COMMAND

if TYPE_CHECKING:
    from collections.abc import Sequence

_handles: Final[list[Any]] = []
"""The one thing that Blender hands out and nobody else keeps: without it the command cannot be unregistered."""


def run_command(arguments: Sequence[str]) -> int:
    """Run what stands behind ``blender --command hiermatch`` and return the exit code."""
    from .program import main  # only now: Blender starts faster without all this

    return main(arguments, own_process=True)


def register_command() -> None:
    """Make the command known to Blender."""
    utils: Any = bpy.utils
    _handles.append(utils.register_cli_command(COMMAND, run_command))


def unregister_command() -> None:
    """Undo `register_command`."""
    utils: Any = bpy.utils
    while _handles:
        utils.unregister_cli_command(_handles.pop())
