# SPDX-License-Identifier: GPL-3.0-or-later
"""The console of the command: results on the standard output, all else on the error stream.

Blender and its importers print on the standard output as they like.  The process that the command has for itself
therefore turns that output over to the error stream, or to nothing if it is to be quiet, and keeps the real one for
results.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..common.errors import ObjectError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType

    from ..jobs.job_operator import Job

_OUTPUT, _ERRORS = 1, 2
"""Numbers of the standard streams."""

_SLICE = 0.25
"""Seconds of work between two looks at the progress."""

_WIDTH = 79
"""Of the line that is written over and over on a terminal."""


class Console:
    """Where the command writes.

    Parameters
    ----------
    quiet : bool
        Whether to say errors and results only.
    own_process : bool
        Whether the process ends with the command, so that its standard output may be turned over for good.

    Attributes
    ----------
    is_terminal : bool
        Whether somebody looks on.
    """

    def __init__(self, *, quiet: bool, own_process: bool) -> None:
        self._quiet = quiet
        self.is_terminal = os.isatty(_ERRORS)
        self._shown = ""
        self._result: int | None = None
        if own_process:
            sys.stdout.flush()
            self._result = os.dup(_OUTPUT)
            os.dup2(os.open(os.devnull, os.O_WRONLY) if quiet else _ERRORS, _OUTPUT)

    def result(self, text: str) -> None:
        """Write a result.

        Raises
        ------
        ObjectError
            If nobody takes it, or the disk is full that it goes to.
        """
        try:
            if self._result is None:
                sys.stdout.write(text)
            else:
                _write(self._result, text)
        except OSError as error:
            raise ObjectError(f"The standard output cannot be written: {error.strerror or error}.") from error

    def error(self, sentence: str) -> None:
        """Say what went wrong."""
        self._end_line()
        self._say(f"hiermatch: {sentence}\n")

    def say(self, line: str) -> None:
        """Say something that stays."""
        if not self._quiet:
            self._end_line()
            self._say(f"{line}\n")

    def progress(self, fraction: float, label: str) -> None:
        """Say how far the work is: in one line on a terminal, else in a line for each new label and tenth."""
        if self._quiet:
            return
        if self.is_terminal:
            line = f"[{min(fraction, 1.0):4.0%}] {label}"[:_WIDTH]
            if line != self._shown:
                self._say(f"\r{line:<{_WIDTH}}")
        else:
            line = f"[{int(10 * min(fraction, 1.0)) * 10:3d}%] {label}"
            if line != self._shown:
                self._say(f"{line}\n")
        self._shown = line

    def _end_line(self) -> None:
        if self.is_terminal and self._shown:
            self._say(f"\r{'':{_WIDTH}}\r")
        self._shown = ""

    def _say(self, text: str) -> None:
        if self._result is None:
            sys.stderr.write(text)
        else:
            with suppress(OSError):  # of a terminal that was closed
                _write(_ERRORS, text)


def drive(job: Job, console: Console) -> None:
    """Drive a job until everything is computed."""
    try:
        while not job.advance(_SLICE):
            console.progress(job.progress.fraction, job.progress.label)
    except BaseException:
        job.close()
        raise


@dataclass
class Interruption:
    """Whether somebody has interrupted the work.

    Attributes
    ----------
    happened : bool
        Whether it was so; Blender's operators make another error of the exception that says it.
    """

    happened: bool = False


@contextmanager
def interruptible() -> Iterator[Interruption]:
    """Let Ctrl-C, a polite end of the process and a terminal that is closed raise KeyboardInterrupt.

    In the background Blender does not.  What was started to outlive its terminal goes on.
    """
    state = Interruption()

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        state.happened = True
        raise KeyboardInterrupt

    numbers = [signal.SIGINT, signal.SIGTERM]
    if (hangup := getattr(signal, "SIGHUP", None)) and signal.getsignal(hangup) != signal.SIG_IGN:  # as of nohup
        numbers.append(hangup)
    before = {number: signal.signal(number, interrupt) for number in numbers}
    try:
        yield state
    finally:
        for number, handler in before.items():
            if handler is not None:  # None: it was not Python's, and cannot be put back
                signal.signal(number, handler)


def _write(stream: int, text: str) -> None:
    """Write all of a text on a stream by its number, whatever its encoding was thought to be."""
    content = text.encode(errors="replace")
    while content:
        content = content[os.write(stream, content) :]
