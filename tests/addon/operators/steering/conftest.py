# SPDX-License-Identifier: GPL-3.0-or-later
"""The two meshes that are steered."""

import bpy
import pytest

from tests.addon.scenes import add_pair


@pytest.fixture
def pair():
    state = bpy.context.scene.hiermatch
    state.source, state.target = add_pair()
    return state.source, state.target
