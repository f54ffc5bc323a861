# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="union-attr"
# ruff: noqa: INP001 - a script that Blender runs, and no module
"""Two-legged characters with hands and faces, and all that they carry."""

import bpy

# More points, and more samples to find them on, so that hands and feet get some of their own. Some more hypotheses,
# because front and back of a standing body are almost alike. On the demo pair this costs a quarter more time.
match = bpy.context.scene.hiermatch
match.points = 96
match.samples = 320
match.hypotheses = 8
# Clothes and skin are told apart by materials, which are attributes. Faces are the reason for shape keys: a head may be
# large on a small body, so movements are scaled by what is around them.
retarget = bpy.context.scene.hiermatch_retarget
retarget.use_attributes = True
retarget.key_scaling = "LOCAL"
