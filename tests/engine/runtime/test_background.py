# SPDX-License-Identifier: GPL-3.0-or-later
import os
import sys
import time

import numpy as np
import pytest

from engine import MatchError, MatchSettings, TriangleMesh, match_steps, run
from engine.runtime import worker
from engine.runtime.background import Background, called_steps
from engine.runtime.errors import HierMatchError
from engine.runtime.worker import Helper, call_background, close_helpers, use_processes
from tests import shared_work
from tests.processes import is_gone
from tests.shapes import creature, icosphere

PATIENCE = 60


@pytest.fixture(scope="module", autouse=True)
def two_processes():
    close_helpers()
    use_processes(2)
    yield
    close_helpers()
    use_processes()


def driven(steps, background):
    """Drive a computation as a window does: the progress that was seen, and the result."""
    seen, end = [], time.monotonic() + PATIENCE
    while True:
        assert time.monotonic() < end
        with background.used():
            try:
                seen.append(next(steps))
            except StopIteration as stop:
                return seen, stop.value
        if background.is_waiting:
            time.sleep(0.005)


def test_it_is_done_by_another_process_which_tells_how_far_it_is_and_what_it_warns_of():
    with pytest.warns(RuntimeWarning, match="This was noticed"):
        seen, pid = driven(shared_work.told_slowly_steps(8), Background())
    assert pid == call_background().pid != os.getpid()
    labels = [progress.label for progress in seen]
    assert len({label for label in labels if label.startswith("Step")}) >= 4
    fractions = [progress.fraction for progress in seen]
    assert fractions == sorted(fractions)


def test_outside_of_its_context_all_is_done_here():
    background = Background()
    with pytest.warns(RuntimeWarning, match="This was noticed"):
        assert run(shared_work.told_slowly_steps(1)) == os.getpid()
    assert not background.is_waiting


def test_an_error_of_the_input_comes_back_as_it_is():
    with pytest.raises(MatchError, match="That cannot be used"):
        driven(shared_work.told_slowly_steps(1, fails=MatchError("That cannot be used.")), Background())
    assert call_background() is not None


def test_any_other_error_comes_back_with_its_traceback():
    with pytest.raises(RuntimeError, match=r"(?s)in told_slowly_steps.*ZeroDivisionError"):
        driven(shared_work.told_slowly_steps(1, fails=ZeroDivisionError()), Background())


def test_a_process_that_ends_is_said_in_a_sentence_and_replaced():
    before = call_background().pid
    with pytest.raises(HierMatchError, match="ended before it was done"):
        driven(shared_work.ended_steps(), Background())
    assert driven(shared_work.echoed_steps(3), Background())[1] == 3
    assert call_background().pid != before


def test_a_process_that_leaves_as_it_is_asked_is_replaced_at_once(monkeypatch):
    close_helpers()
    monkeypatch.setattr(worker, "_LONG_IDLE", 0.5)
    asked, waited = Helper.start_followed, []

    def asked_late(helper, *order):
        end = time.monotonic() + PATIENCE
        while not waited and not is_gone(helper.pid):
            assert time.monotonic() < end
            time.sleep(0.005)
        waited.append(helper.pid)
        return asked(helper, *order)

    monkeypatch.setattr(Helper, "start_followed", asked_late)
    assert driven(shared_work.echoed_steps(3), Background())[1] == 3
    assert len(set(waited)) == 2
    close_helpers()


def test_closing_ends_the_process_at_once():
    background, steps = Background(), shared_work.endless_steps()
    end = time.monotonic() + PATIENCE
    while True:
        with background.used():
            progress = next(steps)
        if progress.label == "Going on":
            break
        assert time.monotonic() < end
        time.sleep(0.005)
    assert background.is_waiting
    assert call_background() is None  # it is at work
    pid = background._helper.pid  # noqa: SLF001
    steps.close()
    assert is_gone(pid)
    assert not background.is_waiting


def test_while_it_is_at_work_another_computation_is_done_here():
    background, steps = Background(), shared_work.endless_steps()
    while not background.is_waiting:
        with background.used():
            next(steps)
    while background._helper is None or not background._helper.is_busy:  # noqa: SLF001
        with background.used():
            next(steps)
        time.sleep(0.005)
    with pytest.warns(RuntimeWarning, match="This was noticed"):
        assert driven(shared_work.told_slowly_steps(1), Background())[1] == os.getpid()
    steps.close()


@pytest.mark.parametrize("way", ["no interpreter", "one process"])
def test_where_there_can_be_no_process_all_is_done_here(monkeypatch, way):
    close_helpers()
    if way == "one process":
        use_processes(1)
    else:
        monkeypatch.setattr(sys, "executable", "/usr/bin/blender")
    try:
        with pytest.warns(RuntimeWarning, match="This was noticed"):
            seen, pid = driven(shared_work.told_slowly_steps(2), Background())
    finally:
        use_processes(2)
    assert pid == os.getpid()
    assert [progress.label for progress in seen] == ["Step 0", "Step 1"]


def test_an_interpreter_that_never_becomes_ready_is_not_waited_for(monkeypatch, tmp_path):
    script = tmp_path / "python"
    script.write_text("#!/bin/sh\ncat >/dev/null\n")
    script.chmod(0o755)
    close_helpers()
    monkeypatch.setattr(sys, "executable", str(script))
    monkeypatch.setattr("engine.runtime.background._START", 0.05)
    assert driven(shared_work.echoed_steps(7), Background())[1] == 7
    close_helpers()


def test_large_values_come_back_as_they_were():
    values = np.random.default_rng(0).normal(size=(3, 1_000_000))
    _, back = driven(shared_work.echoed_steps(values), Background())
    np.testing.assert_array_equal(back, values)


def test_an_ordinary_function_can_be_called_there():
    mesh = TriangleMesh(*creature()[:2])
    _, area = driven(called_steps(np.sum, mesh.vertex_areas), Background())
    assert area == pytest.approx(mesh.area)


def test_the_process_ends_with_the_program_that_called_it():
    background, steps = Background(), shared_work.endless_steps()
    while not background.is_waiting or not background._helper.is_busy:  # noqa: SLF001
        with background.used():
            next(steps)
        time.sleep(0.005)
    pid = background._helper.pid  # noqa: SLF001
    background._helper._process.stdin.close()  # as if this process were gone  # noqa: SLF001
    end = time.monotonic() + PATIENCE
    while not is_gone(pid):
        assert time.monotonic() < end
        time.sleep(0.01)
    with pytest.raises(HierMatchError, match="ended before it was done"):
        driven(steps, background)


def test_a_match_is_the_same_to_the_last_bit():
    """Dense ones are compared in `tests/addon/jobs/test_beside.py`."""
    vertices, triangles = icosphere(5)
    meshes = [
        TriangleMesh(vertices * scales + 0.3 * vertices[:, :1] * vertices, triangles)
        for scales in ((1, 2, 3), (1, 2, 4))
    ]
    settings = MatchSettings(points=12, coarse_points=4, coarse_candidates=8, samples=48, hypotheses=2, dense=False)
    _, beside = driven(match_steps(*meshes, settings), Background())
    here = run(match_steps(*meshes, settings))
    for name in "source_points", "target_points":
        first, second = getattr(beside, name), getattr(here, name)
        np.testing.assert_array_equal(first.positions, second.positions)
    np.testing.assert_array_equal(beside.target_distances, here.target_distances)
    assert beside.distortion == here.distortion
    assert beside.notes == here.notes


def test_what_is_started_before_it_is_needed_has_imported_what_it_needs():
    close_helpers()
    helper, end = call_background(match_steps), time.monotonic() + PATIENCE
    while not helper.is_ready:
        assert time.monotonic() < end
        time.sleep(0.01)
    time.sleep(1)  # it begins with that, where nothing is asked of it
    _, known = driven(called_steps(eval, "set(__import__('sys').modules)"), Background())
    assert helper is call_background()
    assert match_steps.__module__ in known
