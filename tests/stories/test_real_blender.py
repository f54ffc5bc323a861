# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension as a user gets it: the zip, installed and run by a real Blender named in the environment.

BLENDER is the command that runs it, such as ``blender`` or ``/opt/blender/blender``; words are split as in a shell.
"""

import os
import shlex
import subprocess

import pytest

from tests.packaging.environments import PLATFORM
from tests.packaging.report import SCRIPT, assert_matched
from tools.build_package import build_with_wheels, build_without_wheels
from tools.fetch_wheels import read_lock

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not os.environ.get("BLENDER"), reason="BLENDER names no command that runs Blender"),
]


class Blender:
    """A real Blender with user settings of its own, in the folder `resources`."""

    def __init__(self, resources):
        self.resources = resources
        self.environment = os.environ | {"BLENDER_USER_RESOURCES": str(resources)}
        said = self("--background", "--python-expr", "import sys; print('TAG cp%d%d' % sys.version_info[:2])")
        tag = said.partition("TAG ")[2].split()[0]
        # Another Python than the wheels', as in some distributions' Blenders, must bring its own SciPy.
        self.has_wheels = tag in {wheel.filename.split("-")[2] for wheel in read_lock()}

    def __call__(self, *arguments):
        command = [*shlex.split(os.environ["BLENDER"]), *map(str, arguments)]
        run = subprocess.run(command, check=False, capture_output=True, text=True, env=self.environment)
        assert run.returncode == 0, run.stdout + run.stderr
        return run.stdout


@pytest.fixture(scope="module")
def blender(tmp_path_factory):
    return Blender(tmp_path_factory.mktemp("resources"))


@pytest.fixture(scope="module")
def installed(blender, tmp_path_factory):
    """The Blender, after the zip that suits its Python was installed by its own command."""
    output = tmp_path_factory.mktemp("packages")
    if blender.has_wheels:
        (package,) = (path for path in build_with_wheels(output) if PLATFORM in path.name)
    else:
        (package,) = build_without_wheels(output)
    said = blender("--command", "extension", "install-file", "-r", "user_default", "-e", package)
    assert "hiermatch" in said
    return blender


def test_installed_extension_is_listed_and_enabled(installed):
    listing = installed("--command", "extension", "list")
    assert "hiermatch" in listing
    assert "HierMatch" in listing


def test_all_operators_and_panels_are_there(installed):
    """Blender tells what it cannot register, but enables the extension all the same."""
    missing = """
import bpy, sys
registration = sys.modules["bl_ext.user_default.hiermatch.hiermatch_addon.registration"]
print("MISSING", [cls.__name__ for cls in registration.CLASSES if not getattr(cls, "is_registered", True)])
"""
    assert "MISSING []" in installed("--background", "--python-expr", missing)


def test_operator_runs_in_the_background(installed, tmp_path):
    report = tmp_path / "report.json"
    installed("--background", "--python-exit-code", "1", "--python", SCRIPT, "--", report)
    assert_matched(report, scipy_below=installed.resources if installed.has_wheels else None)
