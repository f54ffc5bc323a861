# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that tests share with helpers: it has to be found by them, in a module of its own."""

import os
import sys
import time
import warnings

from engine.runtime.background import can_go_beside
from engine.runtime.errors import MatchError
from engine.runtime.progress import Progress
from engine.runtime.worker import search_threads


class Kept:
    """What is sent only once to a helper."""

    is_sent_once = True

    def __init__(self, value):
        self.value = value


def squared(offset, item):
    """Square an item, slowly enough for helpers to have their turn."""
    for step in range(4):
        time.sleep(0.005)
        yield Progress((step + 1) / 4, "Squaring")
    return item**2 + offset


def process_of(_, __):
    """Say by which process it is done, and print something."""
    sys.stdout.write("this is no reply\n")
    sys.stdout.flush()
    yield from squared(0, 0)
    return os.getpid()


def threads_of(_, __):
    """Say how many threads a search may take, and in which process."""
    yield from squared(0, 0)
    return search_threads(), os.getpid()


def value_of(kept, factor):
    """Return what is kept, and by which process."""
    yield from squared(0, 0)
    return kept.value * factor, os.getpid()


def refused(_, item):
    """Refuse all items but the first."""
    yield from squared(0, 0)
    if item:
        raise MatchError(f"Item {item} cannot be used.")
    return item


def failing_elsewhere(home, item):
    """Work in one process alone."""
    yield from squared(0, 0)
    if os.getpid() != home:
        raise OSError("Not here")
    return item


def dying_elsewhere(home, item):
    """End any process but one."""
    yield from squared(0, 0)
    if os.getpid() != home:
        os._exit(1)
    return item


def long_elsewhere(home, item):
    """Take hours in any process but one."""
    yield from squared(0, 0)
    if os.getpid() != home:
        time.sleep(10_000)
    return item


@can_go_beside
def told_slowly_steps(count, *, fails=None):
    """Tell each of some steps, and whether it is done beside; fail in the middle if that is wanted."""
    for number in range(count):
        time.sleep(0.06)
        yield Progress(number / count, f"Step {number}")
    if fails is not None:
        raise fails
    warnings.warn("This was noticed.", RuntimeWarning, stacklevel=1)
    return os.getpid()


@can_go_beside
def endless_steps():
    """Do not come to an end."""
    while True:
        time.sleep(0.01)
        yield Progress(0.5, "Going on")


@can_go_beside
def ended_steps():
    """End the process."""
    yield Progress(0.5, "Ending")
    os._exit(1)


@can_go_beside
def echoed_steps(value):
    """Return what is given."""
    yield Progress(0.5, "Echoing")
    return value
