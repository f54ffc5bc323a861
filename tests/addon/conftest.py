# SPDX-License-Identifier: GPL-3.0-or-later
"""Load the extension from its source folder, as Blender loads it, and give each test an empty file."""

from __future__ import annotations

import importlib.util

import pytest

from tools.source_extension import load_extension

HAS_BLENDER = importlib.util.find_spec("bpy") is not None

if not HAS_BLENDER:
    collect_ignore_glob = ["*test_*.py"]


if HAS_BLENDER:
    importlib.import_module("bpy")  # bmesh and its like can be imported only afterwards
    load_extension()


@pytest.fixture(scope="session")
def extension():
    """The extension, registered."""
    from hiermatch.engine.runtime import background

    from tests.addon.remembered import Remembered

    package = load_extension()
    package.register()
    background._used.set(Remembered())  # noqa: SLF001
    yield package
    package.unregister()


@pytest.fixture(autouse=True)
def _computed_anew(request, extension):
    """Let nothing be remembered where it matters how something is computed."""
    from hiermatch.engine.runtime import background

    assert extension
    if request.node.get_closest_marker("computes_anew") is None:
        yield
        return
    remembered = background._used.get()  # noqa: SLF001
    background._used.set(None)  # noqa: SLF001
    yield
    background._used.set(remembered)  # noqa: SLF001


@pytest.fixture(autouse=True)
def empty_file(request, extension):
    """A new, empty file for each test, but for those of modules that say that they only read the code."""
    import bpy

    if getattr(request.module, "READS_CODE_ONLY", False):
        return extension
    bpy.ops.wm.read_homefile(use_empty=True)
    assert not bpy.data.objects
    return extension


@pytest.fixture(scope="session")
def dense_file(extension, tmp_path_factory):
    """A file with a symmetric pair that was matched densely: matching it again for each test would take long."""
    import bpy

    from tests.addon.scenes import DENSE, add_symmetric_pair

    assert extension
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.context.scene.hiermatch.source, bpy.context.scene.hiermatch.target = add_symmetric_pair()
    bpy.ops.hiermatch.match(source="Source", target="Target", **DENSE)
    path = str(tmp_path_factory.mktemp("dense") / "dense.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    return path


@pytest.fixture
def dense_pair(dense_file, empty_file):
    """Source and target of such a match."""
    import bpy

    assert empty_file
    bpy.ops.wm.open_mainfile(filepath=dense_file)
    return bpy.data.objects["Source"], bpy.data.objects["Target"]


@pytest.fixture
def sparse_pair(empty_file):
    """Source and target of a match without a dense map."""
    import bpy

    from tests.addon.scenes import QUICK, add_picked_pair

    assert empty_file
    source, target = add_picked_pair()
    bpy.ops.hiermatch.match(**QUICK)
    return source, target
