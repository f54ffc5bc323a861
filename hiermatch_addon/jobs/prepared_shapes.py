# SPDX-License-Identifier: GPL-3.0-or-later
"""Prepared shapes of this session, so that matching a mesh again takes less time."""

from __future__ import annotations

from ...engine import KnownShapes, close_helpers


class _Session:
    """What is known; another process has shapes of its own by it."""

    known = KnownShapes()


def known_shapes(megabytes: float) -> KnownShapes:
    """Return what is known, which may take so much memory from now on."""
    if _Session.known.megabytes != megabytes:
        _Session.known = KnownShapes(megabytes)
    return _Session.known


def forget_shapes() -> None:
    """Forget all of it, also what other processes know; call it while nothing runs."""
    _Session.known = KnownShapes(_Session.known.megabytes)
    close_helpers()
