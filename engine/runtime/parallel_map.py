# SPDX-License-Identifier: GPL-3.0-or-later
"""The same work on several items, some of it in other processes."""

from __future__ import annotations

import warnings
from collections import deque
from collections.abc import Callable, Sequence
from typing import Generic, Self, TypeVar

from .blas_threads import on_one_thread
from .errors import HierMatchError
from .progress import Progress, Steps, in_turn, told, within
from .worker import Helper, Task, present_helpers

Common = TypeVar("Common")
Item = TypeVar("Item")
Result = TypeVar("Result")
Own = TypeVar("Own")

MOST_SENT = 200_000
"""Vertices of a mesh up to which it is sent to other processes: beyond, copies would need too much memory."""

_LOOK = 0.02
"""Seconds between two looks at whether a helper is done."""


@on_one_thread
def shared_steps(
    work: Callable[[Common, Item], Steps[Result]], common: Common, items: Sequence[Item]
) -> Steps[list[Result]]:
    """Do the same with several items, some of them in other processes.

    Parameters
    ----------
    work : callable
        A function of a module that makes a computation in steps of what all items have in common, and one item.  What
        it changes is lost if it is done elsewhere: only its result counts.
    common : object
        What they have in common.  Objects in it, and in the items, with an attribute ``is_sent_once`` that is true are
        kept by other processes as they are when they are first sent.
    items : sequence
        What differs.

    Yields
    ------
    Progress
        Of the items done here; some times a second while others are waited for.

    Returns
    -------
    list
        The results, in the order of the items.

    Raises
    ------
    HierMatchError
        What the first of them raises.
    """
    with _Sharing(work, common, items) as sharing:
        return (yield from sharing.steps())


@on_one_thread
def beside_steps(
    own: Steps[Own], work: Callable[[Common, Item], Steps[Result]], common: Common, items: Sequence[Item]
) -> Steps[tuple[Own, list[Result]]]:
    """Do one thing in this process while others begin with several items; then go on with these, see `shared_steps`.

    Parameters
    ----------
    own : generator
        What is done here.
    work, common, items
        As in `shared_steps`.

    Returns
    -------
    pair
        The result of the former, and the list of results of the latter.
    """
    with _Sharing(work, common, items) as sharing:
        result = yield from within(sharing.meanwhile_steps(own), 0.0, 0.5)
        return result, (yield from within(sharing.steps(), 0.5, 1.0))


def here_steps(
    work: Callable[[Common, Item], Steps[Result]], common: Common, items: Sequence[Item]
) -> Steps[list[Result]]:
    """Do the same with several items in this process alone; see `shared_steps`."""
    return in_turn(work(common, item) for item in items)


class _Sharing(Generic[Common, Item, Result]):
    """Which of some items are done, are being done by helpers, or wait."""

    def __init__(self, work: Callable[[Common, Item], Steps[Result]], common: Common, items: Sequence[Item]) -> None:
        self._work, self._common, self._items = work, common, items
        self._results: dict[int, Result] = {}
        self._waiting = deque(range(len(items)))
        self._running: dict[int, tuple[Helper, Task]] = {}
        self._error: HierMatchError | None = None
        self._wanted = len(items)
        self._label = ""

    def steps(self) -> Steps[list[Result]]:
        """Do all items; see `shared_steps`."""
        while self._look(keep=1):
            if self._waiting:
                number = self._waiting.popleft()
                try:
                    work = self.meanwhile_steps(self._work(self._common, self._items[number]), is_item=True)
                    self._results[number] = yield from work
                except HierMatchError as error:
                    self._fail(number, error)
            elif self._running:
                next(iter(self._running.values()))[0].look(_LOOK)
                yield Progress(self._fraction(), self._label)
        if self._error is not None:
            raise self._error
        return [self._results[number] for number in range(len(self._items))]

    def meanwhile_steps(self, own: Steps[Own], *, is_item: bool = False) -> Steps[Own]:
        """Do something here, and look after the helpers at each step."""

        def looking(progress: Progress) -> Progress:
            """Look after the helpers."""
            self._look()
            self._label = progress.label
            return Progress(self._fraction(progress.fraction), self._label) if is_item else progress

        return told(own, looking)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *of_error: object) -> None:
        # What helpers are still doing is not wanted any more.
        for helper, _ in self._running.values():
            helper.end()

    def _look(self, keep: int = 0) -> bool:
        """Take what helpers have done, and give them more, all but so many that wait; say whether anything is left."""
        for number, (helper, task) in list(self._running.items()):
            helper.look()
            if task.is_over:
                del self._running[number]
                self._take(number, task)
        for helper in present_helpers() if len(self._waiting) > keep else ():
            if helper.is_ready and len(self._waiting) > keep:
                number = self._waiting.popleft()
                self._running[number] = helper, helper.start(self._work, self._common, self._items[number])
        return not all(number in self._results for number in range(self._wanted))

    def _take(self, number: int, task: Task) -> None:
        if not task.done:  # then here
            self._waiting.appendleft(number)
            if task.value is not None:
                warnings.warn(
                    "Part of the work failed in a helper and is done again here. This is a bug of HierMatch, please "
                    f"report it:\n{task.value}",
                    RuntimeWarning,
                    stacklevel=1,
                )
        elif isinstance(task.value, HierMatchError):
            self._fail(number, task.value)
        else:
            self._results[number] = task.value

    def _fail(self, number: int, error: HierMatchError) -> None:
        """Note an error: what comes after it is not wanted any more, but what comes before it may have one, too."""
        if number < self._wanted:
            self._wanted, self._error = number, error
            self._waiting = deque(other for other in self._waiting if other < number)

    def _fraction(self, own: float = 0.0) -> float:
        """Part of the work that is done, with what is done of an item here."""
        return (len(self._results) + own) / len(self._items)
