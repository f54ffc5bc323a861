# SPDX-License-Identifier: GPL-3.0-or-later
"""Fetching wheels: only those recorded, and only once; pip's index is a folder here."""

import hashlib
import json
import subprocess
import zipfile

import pytest

from tools.fetch_wheels import WheelError, fetch_wheels

WHEEL = "example-1.0-cp313-cp313-manylinux_2_17_x86_64.manylinux2014_x86_64.whl"


@pytest.fixture
def index(tmp_path, monkeypatch):
    """A folder with one small wheel for another Python than this one, the only place where pip looks."""
    folder = tmp_path / "index"
    folder.mkdir()
    with zipfile.ZipFile(folder / WHEEL, "w") as archive:
        archive.writestr("example.py", "")
        archive.writestr("example-1.0.dist-info/METADATA", "Metadata-Version: 2.1\nName: example\nVersion: 1.0\n")
        archive.writestr("example-1.0.dist-info/WHEEL", "Wheel-Version: 1.0\nTag: cp313-cp313-manylinux_2_17_x86_64\n")
        archive.writestr("example-1.0.dist-info/RECORD", "")
    monkeypatch.setenv("PIP_CONFIG_FILE", "/dev/null")
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", folder.as_uri())
    return folder


def write_lock(folder, sha256):
    path = folder / "lock.json"
    path.write_text(json.dumps({"project": "example", "version": "1.0", "sha256": {WHEEL: sha256}}), encoding="utf-8")
    return path


@pytest.fixture
def lock(index, tmp_path):
    return write_lock(tmp_path, hashlib.sha256((index / WHEEL).read_bytes()).hexdigest())


def test_recorded_wheel_is_downloaded(index, lock, tmp_path):
    assert fetch_wheels(lock, tmp_path / "wheels") == [tmp_path / "wheels" / WHEEL]
    assert (tmp_path / "wheels" / WHEEL).read_bytes() == (index / WHEEL).read_bytes()
    assert [path.name for path in (tmp_path / "wheels").iterdir()] == [WHEEL]


def test_wrong_hash_is_refused_and_nothing_kept(index, tmp_path):
    wrong = write_lock(tmp_path, "0" * 64)
    with pytest.raises(WheelError, match=WHEEL):
        fetch_wheels(wrong, tmp_path / "wheels")
    assert list((tmp_path / "wheels").iterdir()) == []
    assert (index / WHEEL).exists()


def test_right_wheel_is_not_downloaded_again(lock, tmp_path, monkeypatch):
    fetch_wheels(lock, tmp_path / "wheels")
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: pytest.fail("a download"))
    assert fetch_wheels(lock, tmp_path / "wheels") == []


def test_damaged_wheel_is_replaced(index, lock, tmp_path):
    (tmp_path / "wheels").mkdir()
    (tmp_path / "wheels" / WHEEL).write_bytes(b"half a download")
    assert fetch_wheels(lock, tmp_path / "wheels") == [tmp_path / "wheels" / WHEEL]
    assert (tmp_path / "wheels" / WHEEL).read_bytes() == (index / WHEEL).read_bytes()


def test_missing_wheel_is_named(index, lock, tmp_path):
    (index / WHEEL).unlink()
    with pytest.raises(WheelError, match=WHEEL):
        fetch_wheels(lock, tmp_path / "wheels")
