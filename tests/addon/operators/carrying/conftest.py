# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes for what carries something from one body to another."""

from __future__ import annotations

import bpy
import pytest

from tests.addon.garments import add_item


@pytest.fixture
def dressed_pair(dense_pair):
    """A matched pair, and a shirt and a coat on the source."""
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    source, target = dense_pair
    shirt, coat = add_item(source, "Shirt", 0.02), add_item(source, "Coat", 0.05)
    bpy.ops.object.select_all(action="DESELECT")
    return source, target, shirt, coat
