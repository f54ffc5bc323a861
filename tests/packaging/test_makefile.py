# SPDX-License-Identifier: GPL-3.0-or-later
"""The entry for a fresh machine: which Python it takes, and what it says when there is none."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(*command, **environment):
    """Run a command as if these tests were not themselves run by make, whose sub-makes behave and print otherwise."""
    outside = {name: value for name, value in os.environ.items() if name not in {"MAKEFLAGS", "MAKELEVEL", "MFLAGS"}}
    return subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True, env=outside | environment)


def find_python(*arguments, **environment):
    return run("/bin/sh", str(ROOT / "tools" / "find_python.sh"), *arguments, **environment)


def fake_python(folder, name, program):
    path = folder / name
    path.write_text(f"#!/bin/sh\n{program}\n", encoding="utf-8")
    path.chmod(0o755)
    return path


def is_one_clear_sentence(text):
    return "CPython 3.11" in text and "make PYTHON=" in text and text.count("\n") == 1 and ". " not in text


def test_suitable_python_is_taken():
    found = find_python(sys.executable)
    assert (found.returncode, found.stdout.strip()) == (0, sys.executable)


def test_no_python_at_all_is_one_sentence(tmp_path):
    missing = find_python(PATH=str(tmp_path))
    assert missing.returncode != 0
    assert missing.stdout == ""
    assert is_one_clear_sentence(missing.stderr)


def test_python_without_venv_or_of_another_version_is_passed_over(tmp_path):
    """The check is a program that such an interpreter ends with an error."""
    fake_python(tmp_path, "python3.11", "exit 1")
    fake_python(tmp_path, "python3", f'exec "{sys.executable}" "$@"')
    found = find_python(PATH=str(tmp_path))
    assert (found.returncode, found.stdout.strip()) == (0, str(tmp_path / "python3"))


def test_named_python_is_the_only_candidate(tmp_path):
    wrong = fake_python(tmp_path, "python3.9", "exit 1")
    found = find_python(str(wrong))
    assert found.returncode != 0
    assert is_one_clear_sentence(found.stderr)
    assert str(wrong) in found.stderr


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on this machine")
@pytest.mark.parametrize("goal", ["demo", "test", "lint", "types", "package"])
def test_make_stops_at_a_wrong_python(goal, tmp_path):
    wrong = fake_python(tmp_path, "python3.9", "exit 1")
    made = run("make", goal, f"PYTHON={wrong}")
    assert made.returncode != 0
    assert made.stdout == ""
    first, *rest = made.stderr.splitlines()
    assert is_one_clear_sentence(first + "\n")
    assert all(line.startswith("make") for line in rest)


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on this machine")
def test_installs_once_and_again_only_for_changed_requirements(tmp_path):
    stamp, project = tmp_path / ".venv" / "installed", tmp_path / "pyproject.toml"
    stamp.parent.mkdir()
    shutil.copy(ROOT / "Makefile", tmp_path)
    make = ("make", "--directory", str(tmp_path), "--dry-run", "test")

    def installs(stamp_time, project_time):
        for path, time in ((stamp, stamp_time), (project, project_time)):
            path.touch()
            os.utime(path, (time, time))
        planned = run(*make)
        assert planned.returncode == 0
        assert "-m pytest" in planned.stdout
        return "pip install" in planned.stdout

    assert not installs(stamp_time=2000, project_time=1000)
    assert installs(stamp_time=1000, project_time=2000)


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on this machine")
def test_help_names_every_goal():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    goals = makefile.split(".PHONY: ")[1].splitlines()[0].split()
    text = run("make", "help").stdout
    assert all(f"make {goal}" in text for goal in goals if goal not in {"help", "environment", "python-check"})
