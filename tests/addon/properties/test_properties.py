# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pickers of the panel offer."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.hiermatch_addon.properties import properties


@pytest.mark.parametrize(
    ("kind", "offered"), [("MESH", True), ("ARMATURE", True), ("EMPTY", True), ("CAMERA", False), ("LIGHT", False)]
)
def test_what_has_meshes_can_be_picked(kind, offered):
    make = {
        "MESH": lambda: bpy.data.meshes.new("New"),
        "ARMATURE": lambda: bpy.data.armatures.new("New"),
        "EMPTY": lambda: None,
        "CAMERA": lambda: bpy.data.cameras.new("New"),
        "LIGHT": lambda: bpy.data.lights.new("New", "POINT"),
    }
    obj = bpy.data.objects.new("New", make[kind]())
    assert obj.type == kind
    assert properties._is_pickable(bpy.context.scene.hiermatch, obj) == offered  # noqa: SLF001
