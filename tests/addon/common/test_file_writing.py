# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are written whole or not at all."""

from __future__ import annotations

import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.common.file_writing import beside, write_whole


def test_a_link_stays_one(tmp_path):
    real, link = tmp_path / "folder" / "real.npz", tmp_path / "link.npz"
    real.parent.mkdir()
    real.write_bytes(b"old")
    link.symlink_to(real)
    write_whole(link, b"new")
    assert link.is_symlink()
    assert real.read_bytes() == b"new"
    assert sorted(tmp_path.rglob("*")) == sorted([real.parent, real, link])


def test_a_name_may_be_as_long_as_the_disk_takes(tmp_path):
    path = tmp_path / f"{'x' * 251}.npz"
    write_whole(path, b"new")
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(ObjectError, match="cannot be written"):
        write_whole(tmp_path / f"{'x' * 252}.npz", b"new")
    assert list(tmp_path.iterdir()) == [path]


def test_of_a_failure_nothing_stays(tmp_path):
    path = tmp_path / "file.npz"
    path.write_bytes(b"old")

    def fail():
        with beside(path) as temporary:
            temporary.write_bytes(b"half")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == b"old"
