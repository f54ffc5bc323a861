# SPDX-License-Identifier: GPL-3.0-or-later
"""Child processes, each with a Blender of its own: what breaks in one breaks nothing else."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

from ..command import COMMAND

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

_LOOK = 0.1
"""Seconds between two looks at the children."""

_GRACE = 5.0
"""Seconds that a child has to end by itself when it is asked to."""


@dataclass(frozen=True)
class Task:
    """What a child is to do.

    Attributes
    ----------
    name : str
        What it is called.
    arguments : sequence of str
        What follows ``blender --command hiermatch``.
    log : Path
        Where all that it prints goes.
    after : frozenset of str
        The names of the tasks that must have ended well before.
    """

    name: str
    arguments: Sequence[str]
    log: Path
    after: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Ended:
    """A child that has ended.

    Attributes
    ----------
    task : Task
        What it was to do.
    code : int
        Its exit code; negative if a signal has ended it.
    seconds : float
        How long it ran.
    timeout : bool
        Whether it was ended because its time was over.
    lacking : str
        If it never began, the name of a task that had to end well before, and did not.
    """

    task: Task
    code: int
    seconds: float
    timeout: bool
    lacking: str = ""


@dataclass
class _Child:
    task: Task
    process: subprocess.Popen[bytes]
    begin: float


def run_tasks(tasks: Sequence[Task], jobs: int, timeout: float | None) -> Iterator[Ended | list[str]]:
    """Run all tasks, a number of them at a time, and none before those that it comes after.

    Whoever stops asking ends the children that still run.

    Parameters
    ----------
    tasks : sequence of Task
        What to do, in this order.
    jobs : int
        How many at a time.
    timeout : float or None
        Seconds after which a child is ended.

    Yields
    ------
    Ended or list of str
        Each child that has ended; and, some times a second, the names of what is running.
    """
    waiting, running, failed = list(tasks), list[_Child](), set[str]()
    try:
        while waiting or running:
            for task in [task for task in waiting if task.after & failed]:
                waiting.remove(task)
                failed.add(task.name)
                yield Ended(task, 1, 0.0, timeout=False, lacking=min(task.after & failed))
            open_names = {task.name for task in (*waiting, *(child.task for child in running))}
            ready = [task for task in waiting if not task.after & open_names]
            for task in ready[: jobs - len(running)]:
                waiting.remove(task)
                running.append(_start(task, jobs))
            for child in list(running):
                seconds = time.perf_counter() - child.begin
                code = child.process.poll()
                late = code is None and timeout is not None and seconds > timeout
                if late:
                    code = _end(child)
                if code is not None:
                    running.remove(child)
                    failed |= {child.task.name} if code else set()
                    yield Ended(child.task, code, seconds, late)
            if running:
                yield [child.task.name for child in running]
                time.sleep(_LOOK)
    finally:
        for child in running:
            child.process.terminate()
        for child in running:
            _end(child)


def _start(task: Task, jobs: int) -> _Child:
    command, environment = _blender()
    if jobs > 1:  # else each child would take all cores for itself
        threads = str(max(1, (os.cpu_count() or 1) // jobs))
        for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "HIERMATCH_PROCESSES"):
            environment.setdefault(name, threads)
    own_group: dict[str, Any] = {} if os.name == "nt" else {"start_new_session": True}
    task.log.parent.mkdir(parents=True, exist_ok=True)
    with task.log.open("wb") as log_file:
        process = subprocess.Popen(  # noqa: S603 - our own command
            [*command, *task.arguments],
            stdin=subprocess.DEVNULL,
            stdout=log_file,
            stderr=subprocess.STDOUT,
            env=environment,
            **own_group,
        )
    return _Child(task, process, time.perf_counter())


def _end(child: _Child) -> int:
    """End a child, politely first."""
    child.process.terminate()
    try:
        return child.process.wait(_GRACE)
    except subprocess.TimeoutExpired:
        child.process.kill()
        return child.process.wait()


def _blender() -> tuple[list[str], dict[str, str]]:
    """Return how this Blender, or Python with Blender as a module, is started once more with this add-on."""
    environment = dict(os.environ)
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--command", COMMAND], environment
    package = Path(__file__).resolve().parents[1]
    root = package.parent.parent
    paths = [str(root.parent), *filter(None, [environment.get("PYTHONPATH")])]
    environment["PYTHONPATH"] = os.pathsep.join(paths)
    module = f"{root.name}.{package.parent.name}.{package.name}"
    return [sys.executable, "-m", module], environment
