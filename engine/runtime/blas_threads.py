# SPDX-License-Identifier: GPL-3.0-or-later
"""Threads of the OpenBLAS libraries of NumPy and SciPy: kept to the one that calls them."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, wraps
from pathlib import Path
from typing import NamedTuple, ParamSpec, TypeVar

import numpy as np
import scipy

from .progress import Steps

Given = ParamSpec("Given")
Result = TypeVar("Result")

_FOLDERS = "{}.libs", "{}/.dylibs"
"""Where wheels of a package have libraries of others: on Linux and Windows, and on macOS."""

_PREFIXES, _SUFFIXES = ("scipy_openblas", "openblas"), ("64_", "")
"""What the names of its functions begin and end with, as it was built."""


class Library(NamedTuple):
    """Says how many threads a copy of OpenBLAS may use, and how many it may from now on."""

    threads: Callable[[], int]
    limit: Callable[[int], None]


@cache
def libraries() -> tuple[Library, ...]:
    """Find the copies of OpenBLAS that are in use; none where these packages were built without."""
    found = []
    for package in np, scipy:
        folder = Path(str(package.__file__)).parent
        for path in (p for name in _FOLDERS for p in folder.parent.glob(name.format(folder.name) + "/*openblas*")):
            try:
                library = ctypes.CDLL(str(path))  # which is loaded already
            except OSError:
                continue
            names = [(f"{p}_get_num_threads{s}", f"{p}_set_num_threads{s}") for p in _PREFIXES for s in _SUFFIXES]
            has = [(get, put) for get, put in names if hasattr(library, get) and hasattr(library, put)]
            found += [Library(getattr(library, get), getattr(library, put)) for get, put in has[:1]]
    return tuple(found)


def thread_counts() -> list[int]:
    """Return how many threads each copy of OpenBLAS may use."""
    return [library.threads() for library in libraries()]


class _State:
    """How often one thread is wanted at the moment, and how many there were before; the lock guards both."""

    lock = threading.Lock()
    depth = 0
    before: tuple[int, ...] = ()


@contextmanager
def one_thread() -> Iterator[None]:
    """Let products and factorisations be computed by this thread alone, as long as the context lasts.

    The engine's are small: more threads spin while they wait for the next one, at the cost of other processes, and
    hardly make it faster.  And as the order of sums depends on their number, two processes would not come to the same
    result to the last bit, nor two machines.
    """
    with _State.lock:
        if _State.depth == 0:
            _State.before = tuple(thread_counts())
            for library in libraries():
                library.limit(1)
        _State.depth += 1
    try:
        yield
    finally:
        with _State.lock:
            _State.depth -= 1
            if _State.depth == 0:
                for library, count in zip(libraries(), _State.before, strict=True):
                    library.limit(count)


def on_one_thread(function: Callable[Given, Steps[Result]]) -> Callable[Given, Steps[Result]]:
    """Compute each step of a generator function under `one_thread`, and nothing between them.

    Between two steps the program around goes on with work of its own, which may want all threads.
    """

    @wraps(function)
    def begun(*args: Given.args, **kwargs: Given.kwargs) -> Steps[Result]:
        """Go through its steps, each on one thread."""
        steps = function(*args, **kwargs)
        try:
            while True:
                with one_thread():
                    try:
                        progress = next(steps)
                    except StopIteration as stop:
                        return stop.value
                yield progress
        finally:
            steps.close()

    return begun
