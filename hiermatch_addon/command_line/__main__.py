# SPDX-License-Identifier: GPL-3.0-or-later
"""The same command with Blender as a Python module: ``python -m hiermatch.hiermatch_addon.command_line``."""

from __future__ import annotations

import os
import sys

import bpy

from ..registration import register
from .program import main

if __name__ == "__main__":
    if not hasattr(bpy.types.Scene, "hiermatch"):  # unless it is installed as an extension as well
        register()
    status = main(sys.argv[1:], own_process=True)
    sys.stdout.flush()
    sys.stderr.flush()
    # Blender 4.5 as a module, once it has opened a file, may wait at exit for ever for a thread of its own.
    os._exit(status)
