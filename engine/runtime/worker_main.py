# SPDX-License-Identifier: GPL-3.0-or-later
"""What a helper does, a process beside this one that takes over parts of its work; see `worker`."""

from __future__ import annotations

import os
import pickle
import traceback
from typing import Any

from .blas_threads import one_thread
from .errors import HierMatchError
from .messages import pack, unpack
from .pipes import has_more, receive, send
from .progress import run

__all__ = ["READY", "serve"]

READY = b"A helper of HierMatch is ready.\n"
"""What is written before the first reply."""

_IDLE = 60.0
"""Seconds after which a helper that nothing is asked of ends: it holds some hundred megabytes."""


def serve(idle: float = _IDLE) -> None:
    """Carry out one order after the other until the other side is gone, or wants nothing for long.

    An order is a message with two lists of numbers, what to forget and what comes new; one message for each of the
    latter; and one with a function, what all items have in common, and an item.  The reply to it says whether it was
    carried out, and with what result or error; if not, it brings the traceback.  The first message of all names the
    package that is called ``engine`` here; when all is ready, that is said by `READY`.
    """
    orders, replies = 0, os.dup(1)
    os.dup2(2, 1)  # what is printed is no reply
    try:
        package = receive(orders).decode()
        os.write(replies, READY)
        known: dict[int, Any] = {}
        while has_more(orders, idle):
            gone, new = pickle.loads(receive(orders))  # noqa: S301 - of the process that started this one
            messages = [receive(orders) for _ in range(len(new) + 1)]
            send(replies, _reply(package, known, gone, dict(zip(new, messages, strict=False)), messages[-1]))
    except (EOFError, OSError):
        return


def _reply(package: str, known: dict[int, Any], gone: list[int], new: dict[int, bytes], order: bytes) -> bytes:
    """Carry out one order."""
    try:
        for number in gone:
            known.pop(number, None)
        for number, message in new.items():
            known[number] = unpack(message, package, known)
        work, common, item = unpack(order, package, known)
        with one_thread():
            return pack((True, run(work(common, item))))
    except HierMatchError as error:
        return pack((True, error))
    except Exception:  # noqa: BLE001 - what fails here is done again, and said, where it can be seen
        return pack((False, traceback.format_exc()))
