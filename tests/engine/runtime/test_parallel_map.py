# SPDX-License-Identifier: GPL-3.0-or-later
"""The same work with several items, in this process alone; with helpers it is tested in `test_worker`."""

import pytest

from engine.runtime.errors import MatchError
from engine.runtime.parallel_map import beside_steps, here_steps, shared_steps
from engine.runtime.progress import Progress, run
from engine.runtime.worker import use_processes


@pytest.fixture(autouse=True)
def _alone():
    use_processes(1)
    yield
    use_processes()


def counted(log, item):
    """Note when it begins and ends, and square the item in two steps."""
    log.append(f"begin {item}")
    try:
        yield Progress(0.0, f"first half of {item}")
        yield Progress(0.5, f"second half of {item}")
    finally:
        log.append(f"end {item}")
    return item**2


def refusing(refused, item):
    yield Progress(0.5, "Looking")
    if item in refused:
        raise MatchError(f"Item {item} cannot be used.")
    return item


@pytest.mark.parametrize("map_steps", [shared_steps, here_steps])
def test_items_are_done_one_after_the_other(map_steps):
    log = []
    assert run(map_steps(counted, log, [3, 1, 2])) == [9, 1, 4]
    assert log == ["begin 3", "end 3", "begin 1", "end 1", "begin 2", "end 2"]


@pytest.mark.parametrize("map_steps", [shared_steps, here_steps])
def test_progress_is_that_of_equal_parts(map_steps):
    steps = list(map_steps(counted, [], [1, 2, 3, 4]))
    assert [step.fraction for step in steps] == pytest.approx([number / 8 for number in range(8)])
    assert steps[5].label == "second half of 3"


@pytest.mark.parametrize("map_steps", [shared_steps, here_steps])
def test_of_nothing_comes_nothing(map_steps):
    assert run(map_steps(counted, [], [])) == []


@pytest.mark.parametrize("map_steps", [shared_steps, here_steps])
def test_the_first_item_that_cannot_be_used_is_named(map_steps):
    with pytest.raises(MatchError, match="Item 2 cannot"):
        run(map_steps(refusing, {2, 3}, [1, 2, 3]))


@pytest.mark.parametrize("map_steps", [shared_steps, here_steps])
def test_whoever_stops_asking_ends_the_item_at_work(map_steps):
    log = []
    steps = map_steps(counted, log, [1, 2])
    next(steps)
    assert log == ["begin 1"]
    steps.close()
    assert log == ["begin 1", "end 1"]


def test_beside_something_else_items_come_after_it():
    log = []
    result, squares = run(beside_steps(counted(log, 7), counted, log, [2, 3]))
    assert result == 49
    assert squares == [4, 9]
    assert log == ["begin 7", "end 7", "begin 2", "end 2", "begin 3", "end 3"]


def test_each_takes_half_of_the_progress():
    steps = list(beside_steps(counted([], 7), counted, [], [2, 3]))
    assert [step.fraction for step in steps] == pytest.approx([0, 1 / 4, 1 / 2, 5 / 8, 3 / 4, 7 / 8])


def test_if_that_fails_no_item_is_begun():
    log = []
    with pytest.raises(MatchError, match="Item 5 cannot"):
        run(beside_steps(refusing({5}, 5), counted, log, [1, 2]))
    assert log == []


def test_without_items_only_that_is_done():
    assert run(beside_steps(counted([], 5), counted, [], [])) == (25, [])
