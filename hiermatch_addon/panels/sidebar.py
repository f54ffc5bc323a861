# SPDX-License-Identifier: GPL-3.0-or-later
"""The common parts of the panels in the sidebar, 3D Viewport > Sidebar > HierMatch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from .panel_text import draw_label

if TYPE_CHECKING:
    import bpy


class SidebarPanel:
    """Where the panels are; to be inherited from before `bpy.types.Panel`."""

    bl_space_type = cast("Any", "VIEW_3D")
    bl_region_type = cast("Any", "UI")
    bl_category = "HierMatch"


def folded(layout: bpy.types.UILayout, name: str, title: str) -> Any:  # noqa: ANN401 - a layout, of which stubs lack much
    """Draw the title of a part of a panel; return the layout of what is below, or None as long as it is folded."""
    header, body = cast("Any", layout).panel(name, default_closed=True)
    draw_label(header, title)
    return body
