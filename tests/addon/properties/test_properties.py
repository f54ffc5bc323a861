# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pickers of the panel offer."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import pytest
from hiermatch.engine import match_steps
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


def test_what_will_match_starts_once_both_are_picked_in_a_window(monkeypatch):
    started = []
    monkeypatch.setattr(properties, "call_background", started.append)
    state = bpy.context.scene.hiermatch
    one, other = (bpy.data.objects.new(name, bpy.data.meshes.new(name)) for name in ("One", "Other"))
    state.source, state.target = one, other
    assert not started  # there is no window
    monkeypatch.setattr(properties, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    state.source = state.target = None
    state.source = one
    assert not started
    state.target = other
    assert started == [match_steps]
