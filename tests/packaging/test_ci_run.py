# SPDX-License-Identifier: GPL-3.0-or-later
"""What `.ci/run` does around make, with stand-ins for make and for the tool that sets Blender up."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

pytestmark = pytest.mark.skipif(shutil.which("bash") is None, reason="no bash on this machine")


def program(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)


@pytest.fixture
def ci(tmp_path):
    """Run a copy of `.ci/run` whose make tells its goal and the value of BLENDER, and fails for the goals given."""
    checkout = tmp_path / "checkout"
    (checkout / ".ci").mkdir(parents=True)
    shutil.copy(ROOT / ".ci" / "run", checkout / ".ci" / "run")

    def run(*failing, blender=None):
        cases = "".join(f'*" {goal}") exit 2;; ' for goal in failing)
        program(tmp_path / "bin" / "make", f'echo "ran $*"\necho "closing with $BLENDER"\ncase "$*" in {cases}esac')
        environment = {name: value for name, value in os.environ.items() if name != "BLENDER"}
        environment["PATH"] = f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}"
        if blender is not None:
            environment["BLENDER"] = blender
        command = [checkout / ".ci" / "run"]
        return subprocess.run(command, check=False, capture_output=True, text=True, env=environment, cwd="/")

    return run


def goals(run):
    return [line.split()[-1] for line in run.stdout.splitlines() if line.startswith("ran")]


def test_everything_runs_and_the_tests_speak_last(ci):
    passed = ci()
    assert passed.returncode == 0
    assert goals(passed) == ["environment", "lint", "types", "test"]
    assert passed.stdout.splitlines()[-2:] == ["ran --no-print-directory test", "closing with "]


@pytest.mark.parametrize("goal", ["lint", "types", "test"])
def test_any_failure_fails_the_run_but_hides_no_other(ci, goal):
    failed = ci(goal)
    assert failed.returncode != 0
    assert goals(failed) == ["environment", "lint", "types", "test"]
    assert failed.stderr.splitlines()[-1] == f"FAILED: {goal}"
    assert failed.stdout.splitlines()[-1] == "closing with "


def test_nothing_runs_without_an_environment(ci):
    failed = ci("environment")
    assert failed.returncode != 0
    assert goals(failed) == ["environment"]


def test_real_blender_is_set_up_where_its_tool_is(ci, tmp_path):
    tool = tmp_path / "shared" / "tools" / "real-blender"
    program(tool, 'echo "tool: $*"')
    run = ci()
    assert run.stdout.splitlines()[0] == "tool: setup 4.3"
    assert run.stdout.splitlines()[-1] == f"closing with {tool} 4.3"


def test_tests_run_without_real_blender_if_it_cannot_be_set_up(ci, tmp_path):
    program(tmp_path / "shared" / "tools" / "real-blender", "echo no mirror >&2; exit 1")
    run = ci()
    assert run.returncode == 0
    assert "no mirror" in run.stderr
    assert "skipped" in run.stderr
    assert run.stdout.splitlines()[-1] == "closing with "


def test_blender_of_the_environment_is_kept(ci, tmp_path):
    program(tmp_path / "shared" / "tools" / "real-blender", "exit 1")
    run = ci(blender="/opt/blender/blender")
    assert run.returncode == 0
    assert run.stderr == ""
    assert run.stdout.splitlines()[-1] == "closing with /opt/blender/blender"
