# SPDX-License-Identifier: GPL-3.0-or-later
"""Other processes: helpers that take over parts of a computation, and one that does whole computations.

The engine's work is many short steps on small arrays.  Threads would wait for the interpreter at each of them;
processes do not.  A helper is started while the first work is done, and kept for some time for what comes next.  The
process that does whole computations (see `background`) is a `Helper` as well, and may have helpers of its own.  Where
none can be started, or there is no second core, all is done here, with the same result to the last bit.
"""

from __future__ import annotations

import atexit
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from .messages import PACKAGE, SentObjects, pack, unpack
from .pipes import Inbox, has_more, send, sent_in_parts
from .progress import Progress, Steps
from .worker_main import LEFT, READY

_VARIABLE = "HIERMATCH_PROCESSES"
"""Environment variable that says how many processes may be at work, this one counted."""

_MOST = 2
"""Processes by default, if there are as many cores: most work can be parted in two, and not in more."""

_IDLE, _LONG_IDLE = 60.0, 600.0
"""Seconds after which a process that nothing is asked of ends: one that does parts of a computation, and one that does
whole ones, as a person asks for them."""

_PATIENCE, _SHORT_PATIENCE = 60.0, 0.02
"""Seconds that are waited at most for the rest of a reply: by one who needs it to go on, and by one who does not."""

_AT_ONCE = 4096
"""Bytes that are read at a time of what an interpreter says before it is ready."""

_ROOT = Path(__file__).resolve().parents[1]
"""Folder of the engine."""

_NAME = "engine"
"""What the engine is called in a helper, whatever it is called here."""

_BEGIN = (
    f"import sys, types; package = sys.modules['{_NAME}'] = types.ModuleType('{_NAME}'); "
    f"package.__path__ = sys.argv[1:]; from {_NAME}.runtime.worker_main import serve; sys.exit(serve({{idle}}))"
)
"""What a helper runs.  To import all of the package would take it several times as long: modules wait until used."""


class Task:
    """An order that a helper carries out.

    Attributes
    ----------
    is_over : bool
        Whether nothing more comes of it.
    done : bool
        Whether it was carried out.
    value : object
        The result then, or the error if the input is at fault.  If it was not carried out, the traceback that says why,
        or None if the helper is gone.  The result of an order that is followed comes in a pair with a list of warnings.
    progress : Progress
        How far it is, if it is followed.
    """

    def __init__(self) -> None:
        self.is_over = self.done = False
        self.value: Any = None
        self.progress = Progress(0.0, "Starting")


class Helper:
    """A process that carries out one order at a time.

    Parameters
    ----------
    *functions : callable
        What it will be asked for: it imports their modules, and starts helpers of its own, while nothing is asked yet.
    processes : int
        How many processes may be at work on its orders, itself counted.  Only a process that does whole computations
        has some of its own; whoever asks for those is not kept waiting by the reading of long replies.

    Raises
    ------
    OSError
        If it cannot be started.
    """

    def __init__(self, *functions: Callable[..., Steps[Any]], processes: int = 1) -> None:
        hidden = getattr(subprocess, "CREATE_NO_WINDOW", 0)  # Windows would open a console
        self._process = subprocess.Popen(  # noqa: S603 - this interpreter
            [sys.executable, "-c", _BEGIN.format(idle=_IDLE if processes == 1 else _LONG_IDLE), str(_ROOT)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            bufsize=0,
            env=_environment(processes),
            creationflags=hidden,
            start_new_session=os.name != "nt",  # an interrupt from the keyboard is not meant for it
        )
        if self._process.stdin is None or self._process.stdout is None:
            raise OSError
        self._orders, self._replies = self._process.stdin.fileno(), self._process.stdout.fileno()
        self._inbox = Inbox(self._replies, _PATIENCE if processes == 1 else _SHORT_PATIENCE)
        self._sent = SentObjects()
        self._task: Task | None = None
        self._begun, self._heard = False, b""
        with suppress(OSError):
            send(self._orders, PACKAGE.encode())
            send(self._orders, pack(partial(call_helpers, *functions)) if functions else b"")

    @property
    def pid(self) -> int:
        """Number of the process."""
        return self._process.pid

    @property
    def is_over(self) -> bool:
        """Whether the process has ended."""
        return self._process.poll() is not None

    @property
    def has_left(self) -> bool:
        """Whether the process has ended by itself, as one does of which nothing is asked for long."""
        return self._process.poll() == LEFT

    @property
    def is_ready(self) -> bool:
        """Whether it can be given an order."""
        self.look()
        return self._begun and self._task is None and not self.is_over

    @property
    def is_busy(self) -> bool:
        """Whether it was given an order to which there is no reply yet."""
        return self._task is not None

    def has(self, value: object) -> bool:
        """Say whether something is kept there, that is sent only once."""
        return value in self._sent

    def start(self, work: Callable[[Any, Any], Steps[Any]], common: object, item: object) -> Task:
        """Begin with an item, without waiting; only if `is_ready`."""
        task = self._task = Task()
        for _ in self._sent_in_parts((work, common, item)):
            pass
        return task

    def start_followed(self, task: Task, work: Callable[[Any, Any], Steps[Any]], item: object) -> Iterator[None]:
        """Begin with a task that is followed, and yield while the order is sent; only if `is_ready`."""
        self._task = task
        yield from self._sent_in_parts((work, None, item), is_followed=True)

    def _sent_in_parts(self, order: object, *, is_followed: bool = False) -> Iterator[None]:
        """Send an order; if the helper is gone, the task is over."""
        try:
            for message in self._sent.messages(order, is_followed=is_followed):
                yield from sent_in_parts(self._orders, message)
        except OSError:
            self.end()
        except BaseException:  # it waits for the rest of what cannot be packed, or is not sent any more
            self.end()
            raise

    def look(self, seconds: float = 0.0) -> None:
        """Wait for so long at most until there is a reply, and take it."""
        if self._begun and self._task is None:
            return
        try:
            if self._task is not None:
                message = self._inbox.message(seconds)
                if message is not None:
                    self._take(self._task, *unpack(message, _NAME))
            elif has_more(self._replies, seconds):
                self._listen()
        except (OSError, EOFError):  # it is gone
            self.end()

    def _take(self, task: Task, done: bool | None, value: Any) -> None:  # noqa: ANN401, FBT001 - as they are sent
        """Take a reply: how far it is, or what came of it."""
        if done is None:
            task.progress = value
        else:
            task.done, task.value, task.is_over, self._task = done, value, True, None

    def _listen(self) -> None:
        """Hear whether it is ready, whatever it says before: an interpreter may greet its users."""
        heard = os.read(self._replies, _AT_ONCE)
        if not heard:
            raise EOFError
        self._heard = (self._heard + heard)[-len(READY) :]
        self._begun = self._heard == READY

    def end(self) -> None:
        """End the process, whatever it does."""
        self._process.kill()
        self._process.wait()
        for stream in self._process.stdin, self._process.stdout:
            if stream is not None:
                with suppress(OSError):
                    stream.close()
        if self._task is not None:
            self._task.is_over, self._task = True, None
        self._begun = True


def _environment(processes: int) -> dict[str, str]:
    """Tell a helper where the engine is, and what that needs, and not to look for it in the working directory."""
    packages = [_ROOT, *(Path(str(file)).resolve().parent for file in (np.__file__, scipy.__file__))]
    paths = [str(package.parent) for package in packages] + [os.environ.get("PYTHONPATH", "")]
    found = os.pathsep.join(path for path in paths if path)
    said = {_VARIABLE: str(processes)} if processes == 1 or processes != _defaults()[0] else {}
    return os.environ | said | {"PYTHONPATH": found, "PYTHONSAFEPATH": "1"}


class _Crew:
    """The helpers of this process."""

    def __init__(self) -> None:
        self.process = os.getpid()
        self.most, self.cores = _defaults()
        self.helpers: list[Helper] = []
        self.background: Helper | None = None

    def present(self) -> list[Helper]:
        """Return the helpers that are not over."""
        for helper in self.helpers:
            if helper.is_over:
                helper.end()
        self.helpers = [helper for helper in self.helpers if not helper.is_over]
        return self.helpers


def _cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _defaults() -> tuple[int, int]:
    """How many processes may be at work, and how many cores be used, if nothing else is said."""
    wanted = os.environ.get(_VARIABLE, "")
    if wanted.isdecimal():
        return max(int(wanted), 1), max(int(wanted), 1)
    return min(_cores(), _MOST), _cores()


_crew = _Crew()


def _own_crew() -> _Crew:
    """Return the helpers of this process; one that was forked has none yet, and must leave its parent's alone."""
    global _crew  # noqa: PLW0603
    if _crew.process != os.getpid():
        most, cores = _crew.most, _crew.cores
        _crew = _Crew()
        _crew.most, _crew.cores = most, cores
    return _crew


def use_processes(count: int | None = None) -> None:
    """Say how many processes may be at work on a match.

    Parameters
    ----------
    count : int, optional
        How many, this one counted; with 1 nothing else is started.  By default what the environment variable
        ``HIERMATCH_PROCESSES`` says, or two if there are two cores.
    """
    crew = _own_crew()
    crew.most, crew.cores = _defaults() if count is None else (max(count, 1), max(count, 1))
    for helper in crew.present()[crew.most - 1 :]:
        helper.end()
    if crew.background is not None and crew.most == 1:
        crew.background.end()


def search_threads() -> int:
    """Count the threads that a search for many points may take here: the cores that no helper is at work on.

    If it was said how many processes may be at work, it is that many cores: a helper, or one of several matches at
    once, has one.
    """
    crew = _own_crew()
    return max(min(crew.cores, _cores()) - sum(helper.is_busy for helper in crew.helpers), 1)


def call_helpers(*functions: Callable[..., Steps[Any]]) -> None:
    """Start helpers, as many as are allowed, without waiting for them: they are ready soon; see `Helper`."""
    crew = _own_crew()
    missing = crew.most - 1 - len(crew.present())
    if missing > 0 and _can_start():
        with suppress(OSError):
            crew.helpers += [Helper(*functions) for _ in range(missing)]


def call_background(*functions: Callable[..., Steps[Any]]) -> Helper | None:
    """Start the process that does whole computations, if it does not wait for one already, without waiting for it.

    Parameters
    ----------
    *functions : callable
        What it will be asked for, if it is started, see `Helper`.

    Returns
    -------
    Helper or None
        None if it is at work, cannot be started, or one process alone may be at work.
    """
    crew = _own_crew()
    if crew.background is not None and crew.background.is_over:
        crew.background.end()
        crew.background = None
    if crew.background is None and crew.most > 1 and _can_start():
        with suppress(OSError):
            crew.background = Helper(*functions, processes=crew.most)
    return None if crew.background is None or crew.background.is_busy or crew.background.is_over else crew.background


def _can_start() -> bool:
    """Say whether there is an interpreter to start: where it is part of another program, that would be started."""
    return Path(sys.executable or "").stem.lower().startswith("python")


def close_helpers() -> None:
    """End all other processes; they are started again when they are called."""
    crew = _own_crew()
    for helper in [*crew.present(), *([crew.background] if crew.background is not None else [])]:
        helper.end()
    crew.background = None


def present_helpers() -> list[Helper]:
    """Return the helpers that there are, ready or not."""
    return _own_crew().present()


atexit.register(close_helpers)
