# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of long work, and the generators that report it.

A long computation is a generator that yields `Progress` in short steps and returns its result; whoever drives it
(a modal operator, a script, a test) may stop between two steps.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass, field, replace
from functools import wraps
from typing import ParamSpec, TypeVar

from .arrays import Floats

Given = ParamSpec("Given")
Result = TypeVar("Result")


@dataclass(frozen=True, eq=False)
class Preview:
    """A coarse map that may be the result, known long before it.

    Attributes
    ----------
    source, target : (k, 3) array of float
        Corresponding places of two surfaces, in the space of either.
    """

    source: Floats
    target: Floats

    def __repr__(self) -> str:
        return f"<Preview: {len(self.source)} places>"


@dataclass(frozen=True)
class Progress:
    """How far a computation is.

    Attributes
    ----------
    fraction : float
        Part of the work that is done, 0 to 1; never decreases within one computation.
    label : str
        What is being done, for a person to read.
    preview : Preview or None
        What has just become known of the result.
    """

    fraction: float
    label: str
    preview: Preview | None = field(default=None, compare=False)


Steps = Generator[Progress, None, Result]
"""A computation in steps: yields `Progress`, returns its result."""


def run(steps: Steps[Result]) -> Result:
    """Drive a computation to its end and return its result."""
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            return stop.value


def at_once(function: Callable[Given, Steps[Result]]) -> Callable[Given, Result]:
    """Make of a function in steps one that does all of them: of the same name without `_steps`, and as documented."""

    @wraps(function)
    def done(*args: Given.args, **given: Given.kwargs) -> Result:
        """Do all steps; it takes the documentation of the function in steps."""
        return run(function(*args, **given))

    done.__name__ = done.__qualname__ = function.__name__.removesuffix("_steps")
    return done


def within(steps: Steps[Result], start: float, end: float, label: str | None = None) -> Steps[Result]:
    """Run a computation as the part from `start` to `end` of a longer one.

    Parameters
    ----------
    steps : generator
        The computation, with fractions from 0 to 1.
    start, end : float
        Where its fractions 0 and 1 lie in the longer computation.
    label : str, optional
        Shown instead of the computation's own labels.

    Yields
    ------
    Progress
        The computation's progress, rescaled.

    Returns
    -------
    object
        The computation's result.
    """

    def rescaled(progress: Progress) -> Progress:
        """Say the same of the longer computation."""
        fraction = start + (end - start) * progress.fraction
        return replace(progress, fraction=fraction, label=label or progress.label)

    return told(steps, rescaled)


def part_of(number: int, count: int, start: float = 0.0, end: float = 1.0) -> tuple[float, float]:
    """Tell where one of some equal parts of a computation begins and ends, for `within`."""
    return start + (end - start) * number / count, start + (end - start) * (number + 1) / count


def told(steps: Steps[Result], tell: Callable[[Progress], Progress]) -> Steps[Result]:
    """Run a computation, and tell its progress in another way; what is told is called at each step."""
    try:
        while True:
            try:
                progress = next(steps)
            except StopIteration as stop:
                return stop.value
            yield tell(progress)
    finally:
        steps.close()


def in_turn(parts: Iterable[Steps[Result]]) -> Steps[list[Result]]:
    """Run computations one after the other, each as an equal part of a longer one: the list of their results."""
    parts = list(parts)
    results = []
    for number, steps in enumerate(parts):
        results.append((yield from within(steps, *part_of(number, len(parts)))))
    return results
