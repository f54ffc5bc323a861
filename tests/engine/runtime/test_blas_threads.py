# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

from engine.runtime import blas_threads
from engine.runtime.blas_threads import one_thread, thread_counts


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


def test_without_a_copy_nothing_is_changed(monkeypatch):
    monkeypatch.setattr(blas_threads, "libraries", tuple)
    with one_thread():
        assert thread_counts() == []
