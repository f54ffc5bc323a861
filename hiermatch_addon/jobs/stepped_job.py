# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in steps between which Blender may do anything."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

from ...engine import Background, Progress

if TYPE_CHECKING:
    from ...engine import Preview, Steps


class SteppedJob(ABC):
    """What jobs have in common: a generator that is driven for some time again and again.

    What the engine computes in it is computed here, or in another process (`work_beside`).

    A job holds no references to Blender's data, but looks its objects up again in `_check`.

    Attributes
    ----------
    progress : Progress
        How far the work is.
    preview : Preview or None
        The latest coarse map that has become known on the way.
    """

    def __init__(self) -> None:
        self.progress = Progress(0.0, "Starting")
        self.preview: Preview | None = None
        self._steps: Steps[Any] = self._all_steps()
        self._done = False
        self._background: Background | None = None

    def work_beside(self) -> None:
        """Let the engine compute in a process beside Blender, where there can be one: call it before `advance`."""
        self._background = Background()

    def advance(self, seconds: float) -> bool:
        """Work for about so long, but for one step at least; return whether everything is computed.

        While all that is to be done is to wait for another process, this returns at once.

        Raises
        ------
        HierMatchError
            If the engine or a change of the objects ends the work.
        """
        self._check()
        end = time.perf_counter() + seconds
        with nullcontext() if self._background is None else self._background.used():
            while not self._done:
                try:
                    self.progress = next(self._steps)
                except StopIteration:
                    self._done = True
                self.preview = self.progress.preview or self.preview
                if time.perf_counter() >= end or (self._background is not None and self._background.is_waiting):
                    break
        return self._done

    def close(self) -> None:
        """Drop the work; nothing has been written."""
        self._steps.close()

    @abstractmethod
    def _all_steps(self) -> Steps[Any]:
        """Do the work; what comes of it is kept on the job."""

    def _check(self) -> None:  # noqa: B027 - few jobs need no check
        """Make sure that the objects are still what was read."""
