# SPDX-License-Identifier: GPL-3.0-or-later
"""The built extension, shared by the tests that look at it."""

import zipfile

import pytest
from filelock import FileLock

from tests.packaging.environments import PLATFORM
from tools.build_package import build_with_wheels


@pytest.fixture(scope="session")
def packages(tmp_path_factory):
    """The zips by platform, built for this run."""
    # Of several processes the first fetches the wheels.
    with FileLock(tmp_path_factory.getbasetemp().parent / "packages.lock"):
        paths = build_with_wheels(tmp_path_factory.mktemp("packages"))
    return {path.stem.split("-")[-1]: path for path in paths}


@pytest.fixture(scope="session")
def package(packages):
    """The zip for this machine."""
    return packages[PLATFORM]


@pytest.fixture(scope="session")
def packed_names(packages):
    """The names of all files in each zip."""
    return {name: set(zipfile.ZipFile(path).namelist()) for name, path in packages.items()}
