# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine.runtime.progress import Preview, Progress, run, within


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
