# SPDX-License-Identifier: GPL-3.0-or-later
"""Load the extension from this source tree, as Blender loads it from its extensions folder."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import ModuleType

__all__ = ["PACKAGE", "ROOT", "load_extension", "registered_extension"]

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "hiermatch"


def load_extension() -> ModuleType:
    """Import the source tree as the package `hiermatch`, whatever its folder is called; it still has to be registered.

    The engine is then reached as ``hiermatch.engine``.  Do not import ``engine`` beside it: that makes two copies of
    every class.
    """
    if PACKAGE not in sys.modules:
        spec = importlib.util.spec_from_file_location(
            PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
        )
        if spec is None or spec.loader is None:
            raise ImportError(f"{ROOT / '__init__.py'} cannot be loaded.")
        package = importlib.util.module_from_spec(spec)
        sys.modules[PACKAGE] = package
        spec.loader.exec_module(package)
    return sys.modules[PACKAGE]


def registered_extension() -> ModuleType:
    """Import the source tree as the package `hiermatch` and register it, once for all who ask."""
    import bpy  # noqa: PLC0415 - what only imports the engine needs no Blender

    package = load_extension()
    if not hasattr(bpy.types, "HIERMATCH_PT_match"):
        package.register()
    return package
