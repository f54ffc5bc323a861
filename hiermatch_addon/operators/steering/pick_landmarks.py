# SPDX-License-Identifier: GPL-3.0-or-later
"""Name corresponding places by clicking on them."""

from __future__ import annotations

import bpy

from .landmark_clicks import LandmarkClicks


class HIERMATCH_OT_pick_landmarks(LandmarkClicks, bpy.types.Operator):
    """Click on corresponding places of two meshes, one after the other."""

    bl_idname = "hiermatch.pick_landmarks"
    bl_label = "Pick Landmarks"
    bl_description = (
        "Click on a place of one mesh and then on the corresponding place of the other, pair by pair; Enter or Esc "
        "ends it"
    )
    bl_options = {"REGISTER"}  # each pair is a step of its own to undo
