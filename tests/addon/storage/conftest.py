# SPDX-License-Identifier: GPL-3.0-or-later
"""The two meshes that are matched."""

from __future__ import annotations

import bpy
import pytest

from tests.addon.scenes import add_pair


@pytest.fixture
def pair():
    source, target = add_pair()
    state = bpy.context.scene.hiermatch
    state.source, state.target = source, target
    return source, target
