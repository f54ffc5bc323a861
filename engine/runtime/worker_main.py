# SPDX-License-Identifier: GPL-3.0-or-later
"""The main loop of a helper process, which takes over parts of the work of another; see `worker`."""

from __future__ import annotations

import os
import pickle
import time
import traceback
import warnings
from dataclasses import replace
from typing import Any, TypeVar

from .blas_threads import one_thread
from .errors import HierMatchError
from .messages import pack, unpack
from .pipes import can_take, has_more, receive, send
from .progress import Preview, Progress, Steps, run, told

READY = b"A helper of HierMatch is ready.\n"
"""What is written before the first reply."""

LEFT = 75
"""Exit code of a process of which nothing was asked for long: none of those (1, 2, 3) with which Python or its C
library end when something is wrong."""

_TOLD = 0.05
"""Least time in seconds between two messages that say how far the work is."""

Result = TypeVar("Result")


def serve(idle: float) -> int:
    """Carry out one order after the other until the other side is gone, or wants nothing for long, and return the code.

    An order is a message with two lists of numbers, what to forget and what comes new, and whether it is followed: then
    its progress is told on the way.  There follow one message for each that is new, and one with a function, what all
    items have in common, and an item.  A reply is a pair: None and the progress on the way; True and the result, or
    the error if the input is at fault; False and the traceback if it could not be carried out.  With the result of what
    is followed come the warnings.  The first message of all names the package that is called ``engine`` here; the
    second, if it is not empty, has a function to call if nothing is asked yet.  When all is ready, `READY` says that.
    """
    orders, replies = 0, os.dup(1)
    os.dup2(2, 1)  # what is printed is no reply
    try:
        package, ahead = receive(orders).decode(), receive(orders)
        os.write(replies, READY)
        if ahead and not has_more(orders):
            unpack(ahead, package)()
        known: dict[int, Any] = {}
        while has_more(orders, idle):
            gone, new, is_followed = pickle.loads(receive(orders))  # noqa: S301 - of the process that started this one
            messages = [receive(orders) for _ in range(len(new) + 1)]
            for number in gone:
                known.pop(number, None)
            fresh = dict(zip(new, messages, strict=False))
            send(replies, _reply(package, known, fresh, messages[-1], _Work(orders, replies if is_followed else None)))
    except (EOFError, OSError):
        return 0
    return LEFT


class _Work:
    """The work on an order: it ends with the process that gave it, which may be told how far it is."""

    def __init__(self, orders: int, told: int | None) -> None:
        self._orders, self._told, self._last = orders, told, 0.0
        self._preview: Preview | None = None  # what has not been told yet

    def result(self, steps: Steps[Result]) -> Result | tuple[Result, list[str]]:
        """Do it; with what was warned of if it is followed."""
        if self._told is None:
            return run(told(steps, self._watch))
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("default")
            result = run(told(steps, self._watch))
        return result, [str(warning.message) for warning in said]

    def _watch(self, progress: Progress) -> Progress:
        """Look at a step whether the result is still wanted, and tell how far it is."""
        if has_more(self._orders):  # no order comes before a reply: the other side is gone
            raise SystemExit
        self._preview = progress.preview or self._preview
        if self._told is not None and time.monotonic() - self._last >= _TOLD and can_take(self._told):
            send(self._told, pack((None, replace(progress, preview=self._preview))))
            self._last, self._preview = time.monotonic(), None
        return progress


def _reply(package: str, known: dict[int, Any], new: dict[int, bytes], order: bytes, doing: _Work) -> bytes:
    """Carry out one order."""
    try:
        for number, message in new.items():
            known[number] = unpack(message, package, known)
        work, common, item = unpack(order, package, known)
        with one_thread():
            return pack((True, doing.result(work(common, item))))
    except HierMatchError as error:
        return pack((True, error))
    except Exception:  # noqa: BLE001 - what fails here is done again, and said, where it can be seen
        return pack((False, traceback.format_exc()))
