# SPDX-License-Identifier: GPL-3.0-or-later
"""Other processes that take over parts of a computation, so that more than one core is at work.

The engine's work is many short steps on small arrays.  Threads would wait for the interpreter at each of them;
processes do not.  A helper is started while the first work is done, and kept for some time for what comes next.  Where
there is none, because there is no second core or no interpreter that can be started, all is done here, with the same
result to the last bit: helpers are given the same environment, so that sums are made in the same order.
"""

from __future__ import annotations

import atexit
import multiprocessing
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Event, Lock, Thread
from typing import TYPE_CHECKING, Any

from .helper_main import pack, receive, send
from .sent_objects import SentObjects

if TYPE_CHECKING:
    from collections.abc import Callable

    from .progress import Steps

__all__ = ["Helper", "Task", "call_helpers", "close_helpers", "present_helpers", "use_processes"]

_VARIABLE = "HIERMATCH_PROCESSES"
"""Environment variable that says how many processes may be at work, this one counted."""

_MOST = 2
"""Processes by default, if there are as many cores: most work can be parted in two, and not in more."""

_IDLE = 60.0
"""Seconds after which a helper that nothing is asked of ends: it holds some hundred megabytes."""

_START = """\
import importlib.util, os, pickle, sys, types
paths, name, folder = pickle.load(sys.stdin.buffer)
sys.path[:] = paths
replies = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)  # what is printed is no reply
parents = name.split(".")[:-1]
for count in range(len(parents)):
    parent = ".".join(parents[: count + 1])
    sys.modules[parent] = types.ModuleType(parent)
    sys.modules[parent].__path__ = []
start = os.path.join(folder, "__init__.py")
spec = importlib.util.spec_from_file_location(name, start, submodule_search_locations=[folder])
sys.modules[name] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(sys.modules[name])
importlib.import_module(name + ".helper_main").serve(sys.stdin.buffer, replies)
"""


class Task:
    """An order that a helper carries out."""

    def __init__(self) -> None:
        self.over = Event()
        self.reply: bytes | None = None


class Helper:
    """One process, and a thread that waits for what it replies.

    What is sent is not: the thread would wait for this one, which goes on with its own part of the work.
    """

    def __init__(self) -> None:
        self._tasks: SimpleQueue[Task | None] = SimpleQueue()
        self._process: subprocess.Popen[bytes] | None = None
        self._sent = SentObjects()
        self._lock = Lock()
        self.is_ready = self.is_over = False
        Thread(target=self._attend, name="HierMatch helper", daemon=True).start()

    @property
    def pid(self) -> int | None:
        """Number of the process, once it is started."""
        return None if self._process is None else self._process.pid

    @property
    def has_ended(self) -> bool:
        """Whether the process was started, and is no more."""
        return self._process is not None and self._process.returncode is not None

    def has(self, value: object) -> bool:
        """Say whether something is kept there, that is sent only once."""
        return value in self._sent

    def start(self, work: Callable[[Any, Any], Steps[Any]], common: object, item: object) -> Task:
        """Begin with an item, without waiting; only if `is_ready`."""
        task = Task()
        messages = self._sent.messages((work, common, item))
        with self._lock:
            if not self.is_over and self._process is not None and self._process.stdin is not None:
                self.is_ready = False
                with suppress(OSError):  # it is gone
                    for message in messages:
                        send(self._process.stdin, message)
                    self._tasks.put(task)
                    return task
        task.over.set()
        return task

    def end(self) -> None:
        """End the process, whatever it does."""
        with self._lock:
            self.is_ready, self.is_over = False, True
            self._tasks.put(None)
            if self._process is not None:
                self._process.kill()

    def _attend(self) -> None:
        # It cannot be started, it is gone, or nothing was asked of it for long.
        with suppress(OSError, EOFError, Empty):
            self._serve(_started())
        self.end()
        while (task := self._tasks.get()) is not None:
            task.over.set()

    def _serve(self, process: subprocess.Popen[bytes]) -> None:
        """Take replies until nothing is asked any more."""
        self._process = process
        with process:
            orders, replies = process.stdin, process.stdout
            try:
                if orders is None or replies is None:
                    return
                orders.write(pack((sys.path, __package__, str(Path(__file__).resolve().parent))))
                orders.flush()
                receive(replies)
                self.is_ready = not self.is_over
                while (task := self._tasks.get(timeout=_IDLE)) is not None:
                    try:
                        task.reply = receive(replies)
                        self.is_ready = not self.is_over
                    finally:
                        task.over.set()
            finally:
                process.kill()


def _started() -> subprocess.Popen[bytes]:
    """Start an interpreter that waits to be told what to import."""
    environment = os.environ | {_VARIABLE: "1"}
    hidden = getattr(subprocess, "CREATE_NO_WINDOW", 0)  # Windows would open a console
    return subprocess.Popen(  # noqa: S603 - this interpreter
        [sys.executable, "-c", _START],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=environment,
        creationflags=hidden,
        start_new_session=os.name != "nt",  # an interrupt from the keyboard is not meant for it
    )


class _Crew:
    """The helpers of this process."""

    def __init__(self) -> None:
        self.process = os.getpid()
        self.most = _default_processes()
        self.helpers: list[Helper] = []

    def present(self) -> list[Helper]:
        """Return the helpers that are not over."""
        self.helpers = [helper for helper in self.helpers if not helper.is_over]
        return self.helpers


def _default_processes() -> int:
    """How many processes may be at work if nothing else is said."""
    wanted = os.environ.get(_VARIABLE, "")
    if wanted.isdecimal():
        return max(int(wanted), 1)
    if multiprocessing.parent_process() is not None:  # one of several that share the cores as they are
        return 1
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(cores, _MOST)


_crew = _Crew()


def _own_crew() -> _Crew:
    """Return the helpers of this process; one that was forked has none yet, and must leave its parent's alone."""
    global _crew  # noqa: PLW0603
    if _crew.process != os.getpid():
        most = _crew.most
        _crew = _Crew()
        _crew.most = most
    return _crew


def use_processes(count: int | None = None) -> None:
    """Say how many processes may be at work on a match.

    Parameters
    ----------
    count : int, optional
        How many, this one counted; with 1 nothing else is started.  By default what the environment variable
        ``HIERMATCH_PROCESSES`` says, or two if there are two cores; one in a process that was started by
        `multiprocessing`.
    """
    crew = _own_crew()
    crew.most = _default_processes() if count is None else max(count, 1)
    for helper in crew.present()[crew.most - 1 :]:
        helper.end()


def call_helpers() -> None:
    """Start helpers, as many as are allowed, without waiting for them: in half a second they are ready."""
    crew = _own_crew()
    missing = crew.most - 1 - len(crew.present())
    # Where the interpreter is part of another program, that would be started.
    if missing > 0 and Path(sys.executable or "").stem.lower().startswith("python"):
        crew.helpers += [Helper() for _ in range(missing)]


def close_helpers() -> None:
    """End all helpers; they are started again when they are called."""
    crew = _own_crew()
    for helper in crew.present():
        helper.end()


def present_helpers() -> list[Helper]:
    """Return the helpers that there are, ready or not."""
    return _own_crew().present()


atexit.register(close_helpers)
