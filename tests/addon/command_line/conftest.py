# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of the command line share: a pair of meshes in files."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.hiermatch_addon.command_line.outputs import save

from tests.addon.scenes import add_pair


@pytest.fixture(scope="module")
def folder(extension, tmp_path_factory):
    """A folder with a pair as .blend and as .obj."""
    assert extension
    folder = tmp_path_factory.mktemp("command line")
    bpy.ops.wm.read_homefile(use_empty=True)
    source, target = add_pair()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "pair.blend"))
    for obj in (source, target):
        save(folder / f"{obj.name}.obj", obj)
    return folder


@pytest.fixture
def pair(folder):
    return [f"{folder / 'pair.blend'}:Source", f"{folder / 'pair.blend'}:Target"]
