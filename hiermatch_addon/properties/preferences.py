# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Preferences of the extension, set once for all files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

_PACKAGE = __name__.rsplit(".", 3)[0]
"""What the extension is called where it is installed."""

_MEGABYTES = 500
"""Memory for prepared shapes: some ten bodies of 5,000 vertices."""


class HIERMATCH_AP_preferences(bpy.types.AddonPreferences):
    """The preferences of the extension."""

    bl_idname = _PACKAGE

    shape_memory: bpy.props.IntProperty(
        name="Prepared Shapes (MB)",
        description="Memory for what is computed of a mesh alone, kept until Blender is closed, so that matching it "
        "again, or with another mesh, takes less time. With 0 nothing is kept",
        default=_MEGABYTES,
        min=0,
        soft_max=8000,
    )

    if TYPE_CHECKING:
        layout: bpy.types.UILayout

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the setting, and the button that clears."""
        row = self.layout.row()
        row.prop(self, "shape_memory")
        row.operator("hiermatch.forget_shapes")


def shape_memory(context: bpy.types.Context) -> int:
    """Return how much memory prepared shapes may take, in megabytes."""
    addons: Any = context.preferences.addons if context.preferences else {}
    found = addons.get(_PACKAGE)
    return cast("int", found.preferences.shape_memory) if found and found.preferences else _MEGABYTES
