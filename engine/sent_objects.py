# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages to another process, in which what it knows already is named by a number."""

from __future__ import annotations

import io
import pickle
import weakref
from typing import IO, Any

from .helper_main import pack

__all__ = ["SentObjects"]


class SentObjects:
    """What another process keeps: objects with an attribute ``is_sent_once`` that is true, as they were when sent."""

    def __init__(self) -> None:
        self._numbers: weakref.WeakKeyDictionary[Any, int] = weakref.WeakKeyDictionary()
        self._sent: set[int] = set()
        self._count = 0
        self._new: list[tuple[int, bytes]] = []

    def messages(self, order: object) -> list[bytes]:
        """Pack an order, and what of it has not been sent yet; see `helper_main.serve`."""
        gone = self._sent - set(self._numbers.values())
        packed = self._packed(order)
        new, self._new = self._new, []
        self._sent = self._sent - gone | {number for number, _ in new}
        return [pack((list(gone), [number for number, _ in new])), *(message for _, message in new), packed]

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


class _Packer(pickle.Pickler):
    """Writes values, and numbers for those among them that a helper keeps."""

    def __init__(self, stream: IO[bytes], known: SentObjects, written: object) -> None:
        super().__init__(stream, pickle.HIGHEST_PROTOCOL)
        self._known, self._written = known, written

    def persistent_id(self, obj: Any) -> int | None:  # noqa: ANN401
        """Return the number of what is kept; None for all else, which is written."""
        if obj is self._written or isinstance(obj, type) or not getattr(obj, "is_sent_once", False):
            return None
        return self._known.number(obj)
