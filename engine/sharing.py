# SPDX-License-Identifier: GPL-3.0-or-later
"""Do the same with several items, some of them in other processes."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Generic, TypeVar

from .errors import HierMatchError
from .helpers import present_helpers
from .progress import Progress, within

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .helpers import Helper, Task
    from .progress import Steps

__all__ = ["MOST_SENT", "here_steps", "shared_steps"]

Common = TypeVar("Common")
Item = TypeVar("Item")
Result = TypeVar("Result")

MOST_SENT = 200_000
"""Vertices of a mesh up to which it is sent to other processes: beyond, copies would need too much memory."""

_LOOK = 0.02
"""Seconds between two looks at whether a helper is done."""


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
    sharing = _Sharing(work, common, items)
    label = ""
    try:
        while sharing.look(keep=1):
            if sharing.waiting:
                number = sharing.waiting.popleft()
                steps = work(common, items[number])
                try:
                    while True:
                        progress = next(steps)
                        label = progress.label
                        sharing.look()
                        yield Progress(sharing.fraction(progress.fraction), label)
                except StopIteration as stop:
                    sharing.results[number] = stop.value
                except HierMatchError as error:
                    sharing.fail(number, error)
                finally:
                    steps.close()
            elif sharing.running:
                sharing.wait()
                yield Progress(sharing.fraction(), label)
    finally:
        sharing.stop()
    if sharing.error is not None:
        raise sharing.error
    return [sharing.results[number] for number in range(len(items))]


def here_steps(
    work: Callable[[Common, Item], Steps[Result]], common: Common, items: Sequence[Item]
) -> Steps[list[Result]]:
    """Do the same with several items in this process alone; see `shared_steps`."""
    results = []
    for number, item in enumerate(items):
        begin, end = ((number + i) / len(items) for i in (0, 1))
        results.append((yield from within(work(common, item), begin, end)))
    return results


class _Sharing(Generic[Common, Item, Result]):
    """Which of some items are done, are being done by helpers, or wait."""

    def __init__(self, work: Callable[[Common, Item], Steps[Result]], common: Common, items: Sequence[Item]) -> None:
        self._work, self._common, self._items = work, common, items
        self.results: dict[int, Result] = {}
        self.waiting = deque(range(len(items)))
        self.running: dict[int, tuple[Helper, Task]] = {}
        self.error: HierMatchError | None = None
        self._wanted = len(items)

    def look(self, keep: int = 0) -> bool:
        """Take what helpers have done, and give them more, all but so many that wait; say whether anything is left."""
        for number, (helper, task) in list(self.running.items()):
            helper.look()
            if task.is_over:
                del self.running[number]
                self._take(number, task)
        for helper in present_helpers() if len(self.waiting) > keep else ():
            if helper.is_ready and len(self.waiting) > keep:
                number = self.waiting.popleft()
                self.running[number] = helper, helper.start(self._work, self._common, self._items[number])
        return not all(number in self.results for number in range(self._wanted))

    def _take(self, number: int, task: Task) -> None:
        if not task.done:  # then here
            self.waiting.appendleft(number)
        elif isinstance(task.value, HierMatchError):
            self.fail(number, task.value)
        else:
            self.results[number] = task.value

    def fail(self, number: int, error: HierMatchError) -> None:
        """Note an error: what comes after it is not wanted any more, but what comes before it may have one, too."""
        if number < self._wanted:
            self._wanted, self.error = number, error
            self.waiting = deque(other for other in self.waiting if other < number)

    def fraction(self, own: float = 0.0) -> float:
        """Part of the work that is done, with what is done of an item here."""
        return (len(self.results) + own) / len(self._items)

    def wait(self) -> None:
        """Wait a moment for a helper."""
        next(iter(self.running.values()))[0].look(_LOOK)

    def stop(self) -> None:
        """End the helpers that are still at work."""
        for helper, _ in self.running.values():
            helper.end()
