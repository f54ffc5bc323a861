# SPDX-License-Identifier: GPL-3.0-or-later
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from pickle import PicklingError

import numpy as np
import pytest

from engine import MatchError, Progress, TriangleMesh, match, run
from engine.runtime.messages import SentObjects, unpack
from engine.runtime.parallel_map import beside_steps, here_steps, shared_steps
from engine.runtime.pipes import receive, send
from engine.runtime.worker import call_helpers, close_helpers, present_helpers, search_threads, use_processes
from engine.runtime.worker_main import READY
from tests import shared_work
from tests.processes import is_gone
from tests.shapes import creature
from tests.shared_work import Kept

ROOT = Path(__file__).parents[3]
PATIENCE = 60


def wait_until(holds):
    end = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


@pytest.fixture
def helper():
    use_processes(2)
    call_helpers()
    (found,) = present_helpers()
    wait_until(lambda: found.is_ready)
    yield found
    close_helpers()
    use_processes()


@pytest.fixture
def no_helpers():
    close_helpers()
    use_processes(2)
    yield
    close_helpers()
    use_processes()


@pytest.mark.usefixtures("helper")
def test_results_are_in_the_order_of_the_items():
    assert run(shared_steps(shared_work.squared, 1, range(12))) == [item**2 + 1 for item in range(12)]


@pytest.mark.usefixtures("helper")
def test_nothing_to_do_is_done_at_once():
    assert run(shared_steps(shared_work.squared, 1, [])) == []


@pytest.mark.usefixtures("helper")
def test_progress_grows_to_the_end():
    fractions = [progress.fraction for progress in shared_steps(shared_work.squared, 1, range(7))]
    assert fractions == sorted(fractions)
    assert 0 < fractions[0] < fractions[-1] <= 1


def test_both_processes_work_and_what_they_print_is_no_reply(helper, capfd):
    pids = run(shared_steps(shared_work.process_of, None, range(6)))
    assert set(pids) == {os.getpid(), helper.pid}
    assert capfd.readouterr().out.count("this is no reply") == pids.count(os.getpid())


@pytest.mark.usefixtures("no_helpers")
def test_without_helpers_all_is_done_here():
    assert run(shared_steps(shared_work.process_of, None, range(3))) == [os.getpid()] * 3


@pytest.mark.usefixtures("helper")
def test_in_this_process_alone_no_helper_is_asked():
    assert run(here_steps(shared_work.process_of, None, range(3))) == [os.getpid()] * 3


@pytest.mark.usefixtures("helper")
def test_what_is_kept_is_sent_once():
    kept = Kept(2)
    first = run(shared_steps(shared_work.value_of, kept, [1, 10, 100]))
    assert [value for value, _ in first] == [2, 20, 200]
    kept.value = 3  # against the rules, to see where it is not sent again
    for value, pid in run(shared_steps(shared_work.value_of, kept, [1, 1, 1, 1])):
        assert value == (3 if pid == os.getpid() else 2)


def test_what_is_kept_may_refer_to_more_that_is(helper):
    inner = Kept(np.arange(4))
    outer = Kept(np.ones(4))
    outer.inner, inner.outer = inner, None
    for value, _ in run(shared_steps(shared_work.value_of, outer, [1, 2, 3])):
        assert value[0] in (1, 2, 3)
    assert helper.has(inner)
    assert helper.has(outer)
    assert not helper.has(Kept(1))


def test_what_cannot_be_sent_ends_the_helper_which_is_replaced(helper):
    with pytest.raises((AttributeError, TypeError, PicklingError)):
        helper.start(shared_work.value_of, Kept(1), lambda: None)
    assert not helper.is_busy
    assert helper.is_over


@pytest.mark.usefixtures("helper")
def test_what_is_wrong_with_an_item_is_said_here():
    with pytest.raises(MatchError, match="Item 1 cannot"):
        run(shared_steps(shared_work.refused, None, [0, 1]))


@pytest.mark.parametrize("items", [[0, 5, 6, 7], [5, 6, 7], [0, 0, 0, 5, 6]])
def test_of_several_errors_the_first_is_said(helper, items):
    for processes in 2, 1:
        use_processes(processes)
        with pytest.raises(MatchError, match="Item 5 cannot"):
            run(shared_steps(shared_work.refused, None, items))
    assert helper.is_over


def test_after_an_error_nothing_more_is_begun():
    close_helpers()
    begun = []

    def work(_, item):
        begun.append(item)
        yield from shared_work.refused(_, item)

    with pytest.raises(MatchError, match="Item 5 cannot"):
        run(shared_steps(work, None, [0, 5, 6]))
    assert begun == [0, 5]


def test_what_fails_elsewhere_is_done_here_and_said(helper):
    with pytest.warns(RuntimeWarning, match=r"(?s)failed in a helper.*in failing_elsewhere.*OSError: Not here") as said:
        assert run(shared_steps(shared_work.failing_elsewhere, os.getpid(), range(4))) == [0, 1, 2, 3]
    assert {Path(warning.filename).name for warning in said} == {"parallel_map.py"}
    assert present_helpers() == [helper]


@pytest.mark.usefixtures("helper")
def test_what_fails_elsewhere_fails_in_tests():
    with pytest.raises(RuntimeWarning, match="failing_elsewhere"):
        run(shared_steps(shared_work.failing_elsewhere, os.getpid(), range(4)))


@pytest.mark.usefixtures("helper")
def test_what_a_dying_helper_leaves_is_done_here():
    assert run(shared_steps(shared_work.dying_elsewhere, os.getpid(), range(4))) == [0, 1, 2, 3]
    assert present_helpers() == []
    call_helpers()
    assert len(present_helpers()) == 1


def test_whoever_stops_asking_ends_what_helpers_do(helper):
    steps = shared_steps(shared_work.long_elsewhere, os.getpid(), range(2))
    for _ in range(10):
        next(steps)
    pid = helper.pid
    assert not is_gone(pid)
    steps.close()
    assert present_helpers() == []
    wait_until(lambda: is_gone(pid))


@pytest.mark.filterwarnings("ignore:Part of the work failed")  # where the helper is the first to fail
@pytest.mark.usefixtures("helper")
def test_an_error_here_ends_what_helpers_do():
    with pytest.raises(TypeError):
        run(shared_steps(shared_work.squared, None, ["x", "y", "z"]))
    assert present_helpers() == [] or present_helpers()[0].is_ready
    assert run(shared_steps(shared_work.squared, 0, [2, 3])) == [4, 9]


def test_idle_helpers_end():
    script = "from engine.runtime.worker_main import serve; serve(0.1)"
    streams = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", script], cwd=ROOT, bufsize=0, **streams) as process:
        for message in (b"engine", b""):
            send(process.stdin.fileno(), message)
        assert process.stdout.read(len(READY)) == READY
        assert process.wait(PATIENCE) == 0


def test_what_is_asked_at_once_does_not_wait_for_what_may_be_asked_later():
    script = "from engine.runtime.worker_main import serve; serve(0.1)"
    streams = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", script], cwd=ROOT, bufsize=0, **streams) as process:
        for message in (b"engine", b"no function", *SentObjects().messages((shared_work.process_of, 0, 0))):
            send(process.stdin.fileno(), message)
        assert process.stdout.read(len(READY)) == READY
        assert unpack(receive(process.stdout.fileno()), "engine") == (True, process.pid)


@pytest.mark.usefixtures("no_helpers")
def test_what_lies_in_the_working_directory_is_not_taken_for_the_engine(monkeypatch, tmp_path):
    for name in ("engine", "numpy", "scipy", "pickle"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit\n")
    monkeypatch.chdir(tmp_path)
    call_helpers()
    (helper,) = present_helpers()
    wait_until(lambda: helper.is_ready)
    assert helper.pid in run(shared_steps(shared_work.process_of, None, range(6)))


def test_a_helper_that_has_ended_is_replaced(helper):
    os.kill(helper.pid, signal.SIGKILL)
    wait_until(lambda: present_helpers() == [])
    assert run(shared_steps(shared_work.squared, 0, [2, 3])) == [4, 9]
    call_helpers()
    (other,) = present_helpers()
    assert other.pid != helper.pid


@pytest.mark.parametrize("name", ["/nowhere/python", "/usr/bin/blender", "", None])
@pytest.mark.usefixtures("no_helpers")
def test_where_no_interpreter_can_be_started_all_is_done_here(monkeypatch, name):
    monkeypatch.setattr(sys, "executable", name)
    call_helpers()
    assert run(shared_steps(shared_work.process_of, None, range(2))) == [os.getpid()] * 2
    wait_until(lambda: not present_helpers())


@pytest.mark.skipif(os.name == "nt", reason="needs a script that can be started")
@pytest.mark.parametrize("line", ["exit 1", "echo this is no Python", "cat"])
@pytest.mark.usefixtures("no_helpers")
def test_what_is_no_interpreter_does_no_harm(monkeypatch, tmp_path, line):
    script = tmp_path / "python"
    script.write_text(f"#!/bin/sh\n{line}\n")
    script.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(script))
    call_helpers()
    for _ in range(3):
        assert run(shared_steps(shared_work.process_of, None, range(2))) == [os.getpid()] * 2


@pytest.mark.skipif(os.name == "nt", reason="needs a script that can be started")
@pytest.mark.usefixtures("no_helpers")
def test_an_interpreter_may_say_something_first(monkeypatch, tmp_path):
    script = tmp_path / "python"
    script.write_text(f'#!/bin/sh\necho hi\nexec {sys.executable} "$@"\n')
    script.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(script))
    call_helpers()
    (helper,) = present_helpers()
    wait_until(lambda: helper.is_ready)
    assert len(set(run(shared_steps(shared_work.process_of, None, range(4))))) == 2


@pytest.mark.usefixtures("no_helpers")
def test_the_number_of_processes_is_limited(monkeypatch):
    use_processes(3)
    call_helpers()
    call_helpers()
    assert len(present_helpers()) == 2
    use_processes(2)
    assert len(present_helpers()) == 1
    use_processes(1)
    call_helpers()
    assert present_helpers() == []
    monkeypatch.setenv("HIERMATCH_PROCESSES", "3")
    use_processes()
    call_helpers()
    assert len(present_helpers()) == 2


@pytest.mark.usefixtures("no_helpers")
def test_by_default_two_cores_are_used(monkeypatch):
    monkeypatch.delenv("HIERMATCH_PROCESSES", raising=False)
    for cores, processes in (1, 1), (2, 2), (64, 2):
        monkeypatch.setattr(os, "sched_getaffinity", lambda _, n=cores: set(range(n)), raising=False)
        use_processes()
        call_helpers()
        assert len(present_helpers()) == processes - 1


@pytest.mark.usefixtures("no_helpers")
def test_searches_take_the_cores_that_are_left(monkeypatch):
    monkeypatch.delenv("HIERMATCH_PROCESSES", raising=False)
    for cores in 1, 2, 64:
        monkeypatch.setattr(os, "sched_getaffinity", lambda _, n=cores: set(range(n)), raising=False)
        use_processes()
        assert search_threads() == cores
    for said, threads in (1, 1), (3, 3), (100, 64):
        use_processes(said)
        assert search_threads() == threads
        monkeypatch.setenv("HIERMATCH_PROCESSES", str(said))
        use_processes()
        assert search_threads() == threads


def test_searches_leave_a_core_to_a_helper_at_work_which_has_one(helper, monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(4)), raising=False)
    use_processes(2)
    assert search_threads() == 2
    seen = run(shared_steps(shared_work.threads_of, None, range(6)))
    assert {threads for threads, pid in seen if pid == helper.pid} == {1}
    assert {threads for threads, pid in seen if pid == os.getpid()} <= {1, 2}
    task = helper.start(shared_work.process_of, None, 0)
    assert search_threads() == 1
    wait_until(lambda: helper.look() or task.is_over)
    assert search_threads() == 2


@pytest.mark.parametrize("module", ["engine.mesh.closest_points", "engine.registration.axial_twists"])
def test_no_search_takes_all_cores_by_itself(module):
    path = ROOT.joinpath(*module.split(".")).with_suffix(".py")
    assert "workers=-1" not in path.read_text(encoding="utf8")


def test_helpers_begin_while_something_else_is_done_here(helper):
    def own():
        for _ in range(20):
            time.sleep(0.01)
            yield Progress(0.5, "Something else")
        return "done"

    result, pids = run(beside_steps(own(), shared_work.process_of, None, range(3)))
    assert result == "done"
    assert helper.pid in pids


def test_if_that_cannot_be_done_what_helpers_do_is_ended(helper):
    def own():
        yield Progress(0.0, "Something else")
        yield Progress(0.5, "Something else")
        raise MatchError("It cannot be done.")

    with pytest.raises(MatchError, match="It cannot be done"):
        run(beside_steps(own(), shared_work.long_elsewhere, os.getpid(), range(3)))
    assert helper.is_over


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not forked here")
def test_a_forked_process_has_helpers_of_its_own(helper):
    pid = os.fork()
    if pid == 0:
        os._exit(0 if not present_helpers() and run(shared_steps(shared_work.squared, 0, [3, 4])) == [9, 16] else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0
    assert present_helpers() == [helper]


def python(script, **environment):
    found = subprocess.run(
        [sys.executable, "-c", script],
        env=os.environ | {"PYTHONPATH": str(ROOT)} | environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=True,
    )
    return found.stdout.split()


@pytest.mark.skipif(not Path("/proc").exists(), reason="processes are looked up in /proc")
def test_helpers_end_with_the_process_that_called_them():
    script = """
import time
from engine.runtime import worker as helpers
helpers.use_processes(2); helpers.call_helpers(); (helper,) = helpers.present_helpers()
while not helper.is_ready: time.sleep(0.01)
print(helper.pid)
"""
    (pid,) = python(script)
    wait_until(lambda: is_gone(int(pid)))
    assert is_gone(int(pid))


def test_helpers_find_an_engine_inside_of_another_package(tmp_path):
    """As Blender has it: bl_ext.user_default.hiermatch.engine."""
    package = tmp_path / "outer" / "inner"
    package.mkdir(parents=True)
    for folder in (package.parent, package):
        (folder / "__init__.py").write_text("raise_if_twice = 1")
    (package / "engine").symlink_to(ROOT / "engine")
    script = """
import time
from outer.inner.engine import TriangleMesh, Shape, run
from outer.inner.engine.runtime import worker as helpers
from outer.inner.engine.runtime.parallel_map import shared_steps
from outer.inner.engine.shapes.shape_preparation import Wanted, _prepared_steps
from tests.shapes import creature
helpers.use_processes(2); helpers.call_helpers(); (helper,) = helpers.present_helpers()
while not helper.is_ready: time.sleep(0.01)
shapes = [Shape(TriangleMesh(*creature()[:2])).sampler for _ in range(2)]
tasks = []
start = helper.start
helper.start = lambda *order: tasks.append(start(*order)) or tasks[-1]
first, second = run(shared_steps(_prepared_steps, Wanted(40), shapes))
print(len(tasks), tasks[0].done, (first.taken.rows == second.taken.rows).all())
"""
    assert python(script, PYTHONPATH=os.pathsep.join([str(tmp_path), str(ROOT)])) == ["1", "True", "True"]


@pytest.mark.slow
def test_a_match_is_the_same_to_the_last_bit_with_helpers(helper):
    meshes = [TriangleMesh(*creature(pose)[:2]) for pose in (0.0, 0.5)]
    orders = []
    start = helper.start
    helper.start = lambda *order: orders.append(order) or start(*order)
    shared = match(*meshes)
    assert len(orders) > 20
    assert present_helpers() == [helper]
    use_processes(1)
    alone = match(*meshes)
    for name in "source_to_target", "target_to_source":
        first, second = getattr(shared, name), getattr(alone, name)
        np.testing.assert_array_equal(first.triangles, second.triangles)
        np.testing.assert_array_equal(first.barycentric, second.barycentric)
        np.testing.assert_array_equal(first.confidence, second.confidence)
    np.testing.assert_array_equal(shared.target_points.positions, alone.target_points.positions)
    assert shared.quality == alone.quality
