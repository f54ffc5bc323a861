# SPDX-License-Identifier: GPL-3.0-or-later
"""Clicks on what lies over a viewport are not meant for what it shows."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from hiermatch.hiermatch_addon.operators.steering.viewports import is_in_viewport, viewport_at


def region(kind, x, y, size, alignment="NONE"):
    return SimpleNamespace(type=kind, x=x, y=y, width=size[0], height=size[1], alignment=alignment, data=None)


@pytest.fixture
def context():
    """A viewport of 1000 by 800 with a sidebar of 200 and a header of 30."""
    regions = [
        region("WINDOW", 0, 0, (1000, 800)),
        region("UI", 800, 0, (200, 770), "RIGHT"),
        region("HEADER", 0, 770, (1000, 30), "TOP"),
    ]
    space = SimpleNamespace(region_3d="the view", show_gizmo=True, show_gizmo_navigate=True)
    area = SimpleNamespace(
        type="VIEW_3D", x=0, y=0, width=1000, height=800, regions=regions, spaces=SimpleNamespace(active=space)
    )
    preferences = SimpleNamespace(
        system=SimpleNamespace(ui_scale=1.0), view=SimpleNamespace(gizmo_size_navigate_v3d=80)
    )
    return SimpleNamespace(screen=SimpleNamespace(areas=[area]), preferences=preferences)


@pytest.mark.parametrize(
    ("place", "is_free"),
    [
        ((400, 400), True),
        ((900, 400), False),  # the sidebar
        ((400, 780), False),  # the header
        ((750, 720), False),  # the ball of axes
        ((777, 640), False),  # an icon below it
        ((700, 640), True),
        ((777, 400), True),
    ],
)
def test_what_lies_over_a_viewport(context, place, is_free):
    assert (viewport_at(context, *place) is not None) == is_free
    space = context.screen.areas[0].spaces.active
    space.show_gizmo_navigate = False
    assert (viewport_at(context, *place) is not None) == (place[0] < 800 and place[1] < 770)


@pytest.mark.parametrize(
    ("place", "is_in"), [((400, 400), True), ((900, 400), True), ((1000, 400), False), ((-5, 9), False)]
)
def test_what_belongs_to_a_viewport(context, place, is_in):
    assert is_in_viewport(context, *place) == is_in
    context.screen.areas[0].type = "OUTLINER"
    assert not is_in_viewport(context, *place)
