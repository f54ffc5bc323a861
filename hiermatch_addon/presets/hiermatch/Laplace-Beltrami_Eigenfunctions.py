# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="union-attr"
# ruff: noqa: INP001 - a script that Blender runs, and no module
"""Figure 2 (d) of the paper; all else as it comes."""

import bpy

match = bpy.context.scene.hiermatch
match.metric = "GEODESIC"
match.descriptor = "EIGENFUNCTIONS"
