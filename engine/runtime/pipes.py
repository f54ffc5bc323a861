# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages through the pipes to and from another process, without threads."""

from __future__ import annotations

import os
import select
import time

__all__ = ["has_more", "receive", "send"]

_LENGTH = 8
"""Bytes that say how long a message is."""

_MOST_AT_ONCE = 1 << 20
"""Bytes that are written or asked for at a time."""

_PAUSE = 1e-3
"""Seconds between two looks into a pipe, where the system cannot wait for one."""


def send(pipe: int, message: bytes) -> None:
    """Write a message.

    Raises
    ------
    OSError
        If the other side is gone.
    """
    for part in len(message).to_bytes(_LENGTH, "little"), message:
        view = memoryview(part)
        while view:
            view = view[os.write(pipe, view[:_MOST_AT_ONCE]) :]


def receive(pipe: int) -> bytes:
    """Read the next message, and wait for it.

    Raises
    ------
    EOFError
        If the other side is gone.
    """
    return _read(pipe, int.from_bytes(_read(pipe, _LENGTH), "little"))


def _read(pipe: int, length: int) -> bytes:
    parts, missing = [], length
    while missing:
        part = os.read(pipe, min(missing, _MOST_AT_ONCE))
        if not part:
            raise EOFError
        parts.append(part)
        missing -= len(part)
    return b"".join(parts)


def has_more(pipe: int, seconds: float = 0.0) -> bool:
    """Wait for so long at most until a pipe has something to read, or is closed at the other end; say whether it is."""
    if os.name != "nt":
        return bool(select.select([pipe], [], [], seconds)[0])
    end = time.monotonic() + seconds
    while not (found := _windows_pipe_has_more(pipe)) and time.monotonic() < end:
        time.sleep(_PAUSE)
    return found


def _windows_pipe_has_more(pipe: int) -> bool:
    """Look into a pipe on Windows, which can wait for sockets only."""
    import ctypes  # noqa: PLC0415 - on Windows alone
    import msvcrt  # noqa: PLC0415

    count = ctypes.c_ulong(0)
    handle = ctypes.c_void_p(msvcrt.get_osfhandle(pipe))  # type: ignore[attr-defined, unused-ignore]
    peek = ctypes.windll.kernel32.PeekNamedPipe  # type: ignore[attr-defined, unused-ignore]
    # It fails where the other side is gone; reading says so, too.
    return not peek(handle, None, 0, None, ctypes.byref(count), None) or count.value > 0
