# SPDX-License-Identifier: GPL-3.0-or-later
"""What a helper does, a process beside this one that takes over parts of its work; see `helpers`."""

from __future__ import annotations

import io
import pickle
from dataclasses import dataclass
from typing import IO, Any

from .errors import HierMatchError
from .progress import run

__all__ = ["Reply", "pack", "receive", "send", "serve", "unpack"]

_LENGTH = 8
"""Bytes that say how long a message is."""


@dataclass(frozen=True)
class Reply:
    """What came of an order.

    Attributes
    ----------
    done : bool
        Whether it was carried out.  What fails for the helper's own reasons is to be done by others.
    value : object
        The result, or the error if the input is at fault.
    """

    done: bool
    value: Any = None


def pack(value: object) -> bytes:
    """Turn a value into bytes."""
    return pickle.dumps(value, pickle.HIGHEST_PROTOCOL)


def unpack(message: bytes) -> Reply:
    """Turn the bytes of a reply back into it."""
    reply: Reply = pickle.loads(message)  # noqa: S301 - of a process of our own
    return reply


def send(stream: IO[bytes], message: bytes) -> None:
    """Write a message."""
    stream.write(len(message).to_bytes(_LENGTH, "little"))
    stream.write(message)
    stream.flush()


def receive(stream: IO[bytes]) -> bytes:
    """Read the next message.

    Raises
    ------
    EOFError
        If the other side is gone.
    """
    head = stream.read(_LENGTH)
    length = int.from_bytes(head, "little")
    message = stream.read(length)
    if len(head) < _LENGTH or len(message) < length:
        raise EOFError
    return message


class _Unpacker(pickle.Unpickler):
    """Reads values that refer to others that were sent before, by number."""

    def __init__(self, message: bytes, known: dict[int, Any]) -> None:
        super().__init__(io.BytesIO(message))
        self._known = known

    def persistent_load(self, pid: int) -> Any:  # noqa: ANN401
        """Return what was sent under a number."""
        return self._known[pid]


def serve(orders: IO[bytes], replies: IO[bytes]) -> None:
    """Carry out one order after the other until the other side is gone.

    An order is a message with two lists of numbers, what to forget and what comes new; one message for each of the
    latter; and one with a function, what all items have in common, and an item.  An empty message says, before the
    first of them, that all is ready.
    """
    send(replies, b"")
    known: dict[int, Any] = {}
    while True:
        try:
            gone, new = pickle.loads(receive(orders))  # noqa: S301 - of the process that started this one
            messages = [receive(orders) for _ in range(len(new) + 1)]
        except EOFError:
            return
        try:
            for number in gone:
                known.pop(number, None)
            for number, message in zip(new, messages[:-1], strict=True):
                known[number] = _Unpacker(message, known).load()
            work, common, item = _Unpacker(messages[-1], known).load()
            reply = Reply(done=True, value=run(work(common, item)))
        except HierMatchError as error:
            reply = Reply(done=True, value=error)
        except Exception:  # noqa: BLE001 - what fails here is done again where it can be seen
            reply = Reply(done=False)
        send(replies, pack(reply))
