# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="union-attr"
# ruff: noqa: INP001 - a script that Blender runs, and no module
"""See in a moment which part goes where."""

import bpy

# The dense map takes most of the time of a match. Without it, and with half the points, the demo pair takes 2.5 s
# instead of 6.2 s, and the points are off by 2.6 % of the square root of the area on average instead of 0.6 %.
match = bpy.context.scene.hiermatch
match.points = 32
match.dense = False
match.samples = 128
match.hypotheses = 4
# Retargeting makes a dense map in any case; a first look at it can do without the rig's help.
retarget = bpy.context.scene.hiermatch_retarget
retarget.refine = False
