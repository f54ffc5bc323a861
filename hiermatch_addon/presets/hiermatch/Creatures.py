# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="union-attr"
# ruff: noqa: INP001 - a script that Blender runs, and no module
"""Four-legged and other creatures, whose limbs are like each other."""

import bpy

# Four similar legs make many coarse matchings almost equally good: twice as many are followed up, and two more exact
# points leave less to chance. On the demo pair, two cats, the map is as exact as by default, and costs a quarter more.
match = bpy.context.scene.hiermatch
match.coarse_points = 12
match.coarse_candidates = 28
match.hypotheses = 12
