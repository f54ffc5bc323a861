# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole computations in another process, for a program that must not wait for them, such as one with a window."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from .blas_threads import on_one_thread
from .errors import HierMatchError
from .progress import Progress, Steps
from .worker import Helper, Task, call_background

Given = ParamSpec("Given")
Result = TypeVar("Result")

_START = 10.0
"""Seconds in which the process should be ready; if it is not, all is done here."""


class Background:
    """A process beside this one that does whole computations, where there can be one.

    Within `used`, generator functions marked by `can_go_beside` are carried out there, with the same result to the last
    bit: what is left of them here asks how far they are.  Closing such a generator ends the process at once.

    Attributes
    ----------
    is_waiting : bool
        Whether nothing is to be done here but to wait for the process.
    """

    def __init__(self) -> None:
        self.is_waiting = False
        self._label = "Starting"
        self._helper: Helper | None = call_background()
        self._end = time.monotonic() + _START

    @contextmanager
    def used(self) -> Iterator[None]:
        """Let what is computed within the context be computed there."""
        before = _used.set(self)
        try:
            yield
        finally:
            _used.reset(before)

    def steps(
        self,
        function: Callable[..., Steps[Result]],
        here: Callable[..., Steps[Result]],
        args: tuple[Any, ...],
        given: dict[str, Any],
    ) -> Steps[Result]:
        """Carry out a generator function there, or where there is no process, another here that does the same.

        Yields
        ------
        Progress
            What is known of it: the latest that was told.

        Raises
        ------
        HierMatchError
            What the computation raises, or if the process ends before it is done.
        RuntimeError
            If it fails otherwise.
        """
        helper = yield from self._ready_steps()
        if helper is None:
            return (yield from here(*args, **given))
        task = Task()
        task.progress = Progress(0.0, self._label)
        try:
            for _ in helper.start_followed(task, _called, (function, args, given)):
                yield task.progress
            while not task.is_over:
                helper.look()
                self.is_waiting = not task.is_over
                if self.is_waiting:
                    self._label = task.progress.label or self._label
                    yield task.progress
        finally:
            self.is_waiting = False
            if not task.is_over:
                helper.end()
        if not task.done and helper.has_left:  # in the very moment in which it was asked
            return (yield from self.steps(function, here, args, given))
        return _result(task)

    def _ready_steps(self) -> Steps[Helper | None]:
        """Wait for the process; it is started anew if it has ended while nothing was asked of it."""
        if self._helper is not None and self._helper.is_over:
            self._helper, self._end = call_background(), time.monotonic() + _START
        helper = self._helper
        try:
            while helper is not None and not helper.is_ready:
                if helper.is_over or helper.is_busy or time.monotonic() > self._end:
                    self._helper = helper = None
                    break
                self.is_waiting = True
                yield Progress(0.0, self._label)
        finally:
            self.is_waiting = False
        return helper


_used: ContextVar[Background | None] = ContextVar("used", default=None)


def can_go_beside(function: Callable[Given, Steps[Result]]) -> Callable[Given, Steps[Result]]:
    """Let a generator function of a module be carried out by the `Background` where one is used, and on one thread.

    Its arguments and its result must be such that they can be sent; what it changes of the arguments is lost then.
    """
    here = on_one_thread(function)

    @wraps(function)
    def begun(*args: Given.args, **kwargs: Given.kwargs) -> Steps[Result]:
        """Carry it out in the `Background` that is used, or here."""
        background = _used.get()
        if background is None:
            return (yield from here(*args, **kwargs))
        return (yield from background.steps(begun, here, args, kwargs))

    return begun


@can_go_beside
def called_steps(function: Callable[..., Result], *args: object, **kwargs: object) -> Steps[Result]:
    """Call an ordinary function of a module of the engine in one step, in the `Background` where that is used."""
    return function(*args, **kwargs)
    yield


def _called(_: None, call: tuple[Callable[..., Steps[Result]], tuple[Any, ...], dict[str, Any]]) -> Steps[Result]:
    """Begin a computation in the process."""
    function, args, given = call
    return function(*args, **given)


def _result(task: Task) -> Any:  # noqa: ANN401 - whatever the computation returns
    """Return what came of a task, and warn of what it warned of."""
    if not task.done and task.value is None:
        raise HierMatchError(
            "The process that did the work ended before it was done, maybe for want of memory. Nothing was changed. "
            "Close other programs or use smaller meshes, and try again."
        )
    if not task.done:
        raise RuntimeError(f"The work failed in the process that did it:\n{task.value}")
    if isinstance(task.value, HierMatchError):
        raise task.value
    value, said = task.value
    for text in said:
        warnings.warn(text, RuntimeWarning, stacklevel=2)
    return value
