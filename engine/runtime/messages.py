# SPDX-License-Identifier: GPL-3.0-or-later
"""Values as messages to another process, in which what it knows already is named by a number."""

from __future__ import annotations

import io
import pickle
import weakref
from collections.abc import Mapping
from typing import IO, Any

PACKAGE = __name__.rsplit(".", 2)[0]
"""What the engine is called here: another program may have it inside of a package."""


class SentObjects:
    """What another process keeps: objects with an attribute ``is_sent_once`` that is true, as they were when sent."""

    def __init__(self) -> None:
        self._numbers: weakref.WeakKeyDictionary[Any, int] = weakref.WeakKeyDictionary()
        self._sent: set[int] = set()
        self._count = 0
        self._new: list[tuple[int, bytes]] = []

    def messages(self, order: object, *, is_followed: bool = False) -> list[bytes]:
        """Pack an order, and what of it has not been sent yet; see `worker_main.serve`."""
        gone = self._sent - set(self._numbers.values())
        packed = self._packed(order)
        new, self._new = self._new, []
        self._sent = self._sent - gone | {number for number, _ in new}
        return [
            pack((list(gone), [number for number, _ in new], is_followed)),
            *(message for _, message in new),
            packed,
        ]

    def __contains__(self, value: object) -> bool:
        return value in self._numbers

    def number(self, value: object) -> int:
        """Return the number of what is kept; if that is new, it is sent with the next order."""
        if value not in self._numbers:
            message = self._packed(value, written=value)  # before it: what it refers to itself
            self._count += 1
            self._numbers[value] = self._count
            self._new.append((self._count, message))
        return self._numbers[value]

    def _packed(self, value: object, written: object = None) -> bytes:
        """Pack a value; of what is kept, only one is written itself."""
        stream = io.BytesIO()
        _Packer(stream, self, written).dump(value)
        return stream.getvalue()


def pack(value: object) -> bytes:
    """Make a message of a value, whatever it refers to."""
    return pickle.dumps(value, pickle.HIGHEST_PROTOCOL)


def unpack(message: bytes, package: str, known: Mapping[int, Any] | None = None) -> Any:  # noqa: ANN401
    """Make a value of a message.

    Parameters
    ----------
    message : bytes
        The message, of a process of our own.
    package : str
        What the engine is called where it was packed: another program may have it inside of a package.
    known : mapping of int to object, optional
        What is named by numbers.
    """
    return _Unpacker(message, package, known or {}).load()


class _Packer(pickle.Pickler):
    """Writes values, and numbers for those among them that another process keeps."""

    def __init__(self, stream: IO[bytes], sent: SentObjects, written: object) -> None:
        super().__init__(stream, pickle.HIGHEST_PROTOCOL)
        self._sent, self._written = sent, written

    def persistent_id(self, obj: Any) -> int | None:  # noqa: ANN401
        """Return the number of what is kept; None for all else, which is written."""
        if obj is self._written or isinstance(obj, type) or not getattr(obj, "is_sent_once", False):
            return None
        return self._sent.number(obj)


class _Unpacker(pickle.Unpickler):
    """Reads values, some of which are numbers of what is known, from where the engine may have another name."""

    def __init__(self, message: bytes, package: str, known: Mapping[int, Any]) -> None:
        super().__init__(io.BytesIO(message))
        self._package, self._known = package, known

    def find_class(self, module: str, name: str) -> Any:  # noqa: ANN401
        """Find a class or function of the engine by what that is called here."""
        if module == self._package or module.startswith(f"{self._package}."):
            module = f"{PACKAGE}{module[len(self._package) :]}"
        return super().find_class(module, name)

    def persistent_load(self, pid: int) -> Any:  # noqa: ANN401
        """Return what is known by a number."""
        return self._known[pid]
