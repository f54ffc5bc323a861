# SPDX-License-Identifier: GPL-3.0-or-later
import threading
import time

import pytest

import engine
from engine import MatchSettings, Progress, TriangleMesh, run
from engine.matching.refinement import refine_map_steps
from engine.retarget.values.attribute_transfer import carry_values_steps
from engine.runtime import blas_threads
from engine.runtime.background import can_go_beside
from engine.runtime.blas_threads import on_one_thread, one_thread, thread_counts
from tests.shapes import icosphere

ENTRIES = [
    *(getattr(engine, name) for name in engine.__all__ if name.endswith("_steps")),
    carry_values_steps,
    refine_map_steps,
]


@pytest.fixture
def two_threads():
    """Let there be two threads, whatever the environment says."""
    before = thread_counts()
    libraries = blas_threads.libraries()
    for library in libraries:
        library.limit(2)
    yield thread_counts()
    for library, count in zip(libraries, before, strict=True):
        library.limit(count)


def test_wheels_of_numpy_and_scipy_have_a_copy_each(two_threads):
    assert two_threads == [2, 2]


def test_there_is_one_thread_as_long_as_it_is_wanted(two_threads):
    with one_thread():
        assert thread_counts() == [1, 1]
        with one_thread():
            assert thread_counts() == [1, 1]
        assert thread_counts() == [1, 1]
    assert thread_counts() == two_threads


def test_after_an_error_all_is_as_before(two_threads):
    with pytest.raises(ZeroDivisionError), one_thread():
        raise ZeroDivisionError
    assert thread_counts() == two_threads


def test_contexts_may_end_in_any_order(two_threads):
    first, second = one_thread(), one_thread()
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert thread_counts() == [1, 1]
    second.__exit__(None, None, None)
    assert thread_counts() == two_threads


def test_two_that_begin_at_the_same_time_leave_all_threads(monkeypatch):
    counts, begun = [2], threading.Event()

    def limit(count):
        counts[0] = count
        begun.set()
        time.sleep(0.05)  # which is when the other one begins

    monkeypatch.setattr(blas_threads, "libraries", lambda: (blas_threads.Library(lambda: counts[0], limit),))

    def wanting():
        with one_thread():
            assert counts == [1]

    other = threading.Thread(target=wanting)
    other.start()
    begun.wait()
    wanting()
    other.join()
    assert counts == [2]


def test_without_a_copy_nothing_is_changed(monkeypatch):
    monkeypatch.setattr(blas_threads, "libraries", tuple)
    with one_thread():
        assert thread_counts() == []


@on_one_thread
def seen_steps(count):
    for number in range(count):
        assert thread_counts() == [1, 1]
        yield Progress(number / count, "")
    return thread_counts()


def test_each_step_has_one_thread_and_what_is_between_has_all(two_threads):
    for _ in seen_steps(3):
        assert thread_counts() == two_threads
    assert run(seen_steps(3)) == [1, 1]
    assert thread_counts() == two_threads


def test_steps_that_fail_or_are_closed_leave_all_threads(two_threads):
    closed = []

    @on_one_thread
    def failing_steps(*, fails):
        try:
            yield Progress(0.0, "")
            if fails:
                raise ZeroDivisionError
            yield Progress(0.5, "")
        finally:
            closed.append(fails)

    with pytest.raises(ZeroDivisionError):
        run(failing_steps(fails=True))
    steps = failing_steps(fails=False)
    next(steps)
    steps.close()
    assert closed == [True, False]
    assert thread_counts() == two_threads


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.__name__)
def test_every_entry_has_one_thread_in_its_steps_and_can_go_beside(entry):
    assert entry.__code__ is can_go_beside(seen_steps).__code__
    assert entry.__wrapped__


def test_the_threads_of_a_program_are_its_own_while_a_match_waits(two_threads):
    mesh = TriangleMesh(*icosphere(6))
    for steps in (
        engine.match_steps(mesh, mesh, MatchSettings(points=10, samples=60)),
        engine.find_symmetry_steps(mesh, MatchSettings(points=10, samples=60)),
    ):
        for _ in range(5):
            next(steps)
            assert thread_counts() == two_threads
        steps.close()
