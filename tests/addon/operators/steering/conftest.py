# SPDX-License-Identifier: GPL-3.0-or-later
"""The two meshes that are steered."""

from types import SimpleNamespace

import pytest
from hiermatch.hiermatch_addon.operators.steering import landmark_clicks
from hiermatch.hiermatch_addon.operators.steering.viewports import Viewport

from tests.addon.scenes import add_picked_pair


@pytest.fixture
def pair():
    return add_picked_pair()


@pytest.fixture
def over_viewport(monkeypatch):
    """Let places from zero on be in a viewport, but those from 800 on under its sidebar."""
    found = Viewport(None, None, None)
    monkeypatch.setattr(landmark_clicks, "viewport_at", lambda _context, x, _y: found if 0 <= x < 800 else None)
    monkeypatch.setattr(landmark_clicks, "is_in_viewport", lambda _context, x, _y: x >= 0)


@pytest.fixture
def press():
    """What makes the event of a key or a button of the mouse."""

    def make(kind, x=5, **modifiers):
        held = dict.fromkeys(("alt", "ctrl", "oskey", "shift"), False) | modifiers
        return SimpleNamespace(type=kind, value="PRESS", mouse_x=x, mouse_y=5, **held)

    return make
