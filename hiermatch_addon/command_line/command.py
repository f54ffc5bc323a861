# SPDX-License-Identifier: GPL-3.0-or-later
"""Name of the command, and its exit codes."""

from __future__ import annotations

from enum import IntEnum
from typing import Final

from ...engine import HierMatchError

COMMAND: Final = "hiermatch"
"""What follows ``blender --command``."""


class ExitCode(IntEnum):
    """What the command tells the shell."""

    DONE = 0
    FAILED = 1
    USAGE = 2
    DOUBTFUL = 3
    PAIRS_FAILED = 4
    INTERRUPTED = 130


EXIT_CODES = """\
exit codes:
  0    done
  1    bad input, or it failed: one sentence on the error stream says why and what to do
  2    wrong usage
  3    done and written, but the match is doubtful and --strict was given
  4    batch: some pairs failed, the others are done
  130  interrupted
"""
"""The same for `--help`."""


class UsageError(HierMatchError):
    """Arguments that do not make a command.

    Parameters
    ----------
    message : str
        What is wrong.
    usage : str
        How the command is to be used, in a few lines.
    """

    def __init__(self, message: str, usage: str = "") -> None:
        super().__init__(message)
        self.usage = usage
