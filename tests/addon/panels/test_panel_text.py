# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences and names in panels stay within a sidebar, however narrow it is."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import pytest
from hiermatch.hiermatch_addon.panels import motion_panels
from hiermatch.hiermatch_addon.panels.panel_text import letters_across, shortened

from tests.addon.panels.test_panels import Layout, draw, texts
from tests.addon.panels.test_panels import context as context  # noqa: PLC0414  (a fixture)


def sidebar(width, scale=1.0):
    system = SimpleNamespace(ui_scale=scale)
    return SimpleNamespace(region=SimpleNamespace(width=width), preferences=SimpleNamespace(system=system))


@pytest.mark.parametrize(("width", "most"), [(280, 32), (225, 24), (167, 15), (60, 8)])
def test_a_line_is_as_long_as_the_sidebar_has_room_for(width, most):
    """With tabs, margins, a box and an icon; what fits was seen in a window."""
    assert letters_across(sidebar(width)) <= most
    assert letters_across(sidebar(width)) >= min(8, most)
    assert letters_across(sidebar(width * 1.5, 1.5)) == letters_across(sidebar(width))


@pytest.mark.parametrize("name", ["FrontShoulder.L", "FrontShoulder.R", "mixamorig:LeftForeArm"])
def test_a_long_name_keeps_its_end(name):
    short = shortened(name, 9)
    assert len(short) == 9
    assert short == f"{name[:4]}…{name[-4:]}"
    assert shortened(name, 40) == name


def test_values_are_broken_into_lines(context):
    summary = context.scene.hiermatch.summary
    summary.points, summary.verdict, summary.stretch, summary.gap = 5, "So it is.", 0.23, 0.25
    rows = [entry[1] for entry in draw(context) if entry[0] == "label"]
    assert "23%, much, the builds differ" in texts(draw(context))
    width = 0.6 * (letters_across(context) + 2)
    for word in ("23%,", "differ", "ended", "best"):
        (line,) = (row for row in rows if word in row)
        assert len(line) <= width


def test_the_table_of_bones_tells_left_from_right(context):
    drawn, rows = [], []
    for side in "LR":
        row = bpy.context.scene.hiermatch_bone_pairs.add()
        row.source, row.target = f"FrontShoulder.{side}", f"hip.{side}"
        rows.append(row)
    for row in rows:
        motion_panels.HIERMATCH_UL_bone_pairs.draw_item(None, context, Layout(drawn), None, row, 0, None, "")
    names = [entry[1] for entry in drawn if entry[0] in ("label", "prop") and entry[1] not in ("1.00", "locked")]
    assert names == [names[0], "target", names[2], "target"]
    assert [names[0][-2:], names[2][-2:]] == [".L", ".R"]
    assert "…" in names[0]
