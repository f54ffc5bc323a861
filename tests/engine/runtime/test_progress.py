# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine.runtime.progress import Preview, Progress, in_turn, run, told, within


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


def test_within_passes_previews_on():
    preview = Preview(np.zeros((4, 3)), np.ones((4, 3)))
    found = next(within(iter_of(Progress(0.5, "Comparing", preview)), 0.0, 0.4, "Matching"))
    assert (found.fraction, found.label) == (0.2, "Matching")
    assert found.preview is preview
    assert repr(preview) == "<Preview: 4 places>"


def iter_of(*progress):
    yield from progress


def test_closing_the_outer_generator_closes_the_inner_one():
    log = []

    def outer():
        return (yield from within(counting(4, log), 0.0, 1.0))

    steps = outer()
    next(steps)
    steps.close()
    assert log == ["closed"]


def test_in_turn_gives_each_an_equal_part_and_returns_all_results():
    told_of, result = [], []

    def outer():
        result.extend((yield from in_turn(counting(count) for count in (2, 1, 2))))

    told_of = [progress.fraction for progress in outer()]
    assert told_of == pytest.approx([0, 1 / 6, 1 / 3, 2 / 3, 5 / 6])
    assert result == [2, 1, 2]
    assert run(in_turn([])) == []


def test_what_is_told_takes_the_place_of_the_progress():
    log = []
    steps = told(counting(2, log), lambda progress: Progress(progress.fraction / 2, "other"))
    assert next(steps) == Progress(0.0, "other")
    assert next(steps) == Progress(0.25, "other")
    steps.close()
    assert log == ["closed"]
