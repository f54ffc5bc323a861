# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

from engine.runtime.progress import Progress, run, within


def counting(count, log=None):
    try:
        for i in range(count):
            yield Progress(i / count, f"step {i}")
    finally:
        if log is not None:
            log.append("closed")
    return count


def test_run_returns_the_result():
    assert run(counting(3)) == 3


def test_within_rescales_fractions_and_passes_the_result_on():
    fractions = []

    def recording(steps):
        for progress in steps:
            fractions.append(progress.fraction)
            yield progress

    def outer():
        return (yield from within(counting(4), 0.5, 0.7))

    assert run(outer()) == 4
    list(recording(outer()))
    assert fractions == pytest.approx([0.5, 0.55, 0.6, 0.65])


def test_closing_the_outer_generator_closes_the_inner_one():
    log = []

    def outer():
        return (yield from within(counting(4, log), 0.0, 1.0))

    steps = outer()
    next(steps)
    steps.close()
    assert log == ["closed"]
