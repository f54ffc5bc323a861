# SPDX-License-Identifier: GPL-3.0-or-later
"""The built zip, installed into Blenders (as modules) that have no SciPy but the one in the zip."""

import os
import subprocess

import pytest

from tests.packaging.environments import python_with_bpy
from tests.packaging.report import SCRIPT, assert_matched


@pytest.mark.parametrize(
    "version",
    ["5.0.1", pytest.param("4.5.15", marks=pytest.mark.slow), pytest.param("4.2.23", marks=pytest.mark.slow)],
)
def test_installed_extension_matches(version, package, tmp_path):
    python = python_with_bpy(version)
    without = subprocess.run([python, "-c", "import scipy"], check=False, capture_output=True, text=True)
    assert "No module named 'scipy'" in without.stderr

    resources = tmp_path / "resources"
    command = [python, str(SCRIPT), "--", str(tmp_path / "report.json"), "--install", str(package)]
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(resources), "PYTHONPATH": ""}
    run = subprocess.run(command, check=False, capture_output=True, text=True, env=environment, cwd=tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr

    report = assert_matched(tmp_path / "report.json", scipy_below=resources)
    assert ".".join(map(str, report["blender"])) == version
