# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender with the extension from this checkout, for stories that run within one process."""

from __future__ import annotations

import importlib
from contextlib import contextmanager


@contextmanager
def blender_session():
    """Lend Blender with the extension registered and an empty file."""
    module = importlib.import_module("bpy")
    from tools.source_extension import load_extension

    package = load_extension()
    ours = not hasattr(module.types.Scene, "hiermatch")  # unless another test of the session has registered it
    if ours:
        package.register()
    module.ops.wm.read_homefile(use_empty=True)
    try:
        yield module
    finally:
        if ours:
            package.unregister()
