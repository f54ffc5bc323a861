# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Show a match in colours, and write its regions."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, cast

import bpy

from ...engine import HierMatchError
from ..common.access import mesh_of, window_manager_of
from ..common.errors import ObjectError
from ..common.redraw import redraw_views
from ..common.translated_text import translated
from ..jobs.running import can_start
from ..properties.steering_lists import common_match, steered_pair
from ..properties.steering_properties import steering_of
from ..scene.character import parts_of
from ..scene.pair import check_mode, check_writable
from ..storage.views.views import VIEW_ITEMS, attribute_of, prepare_view, region_groups, show_attribute

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ..storage.halves import Half

__all__ = ["HIERMATCH_OT_show", "HIERMATCH_OT_write_regions"]


def _match_of(context: bpy.types.Context) -> tuple[Half, Half]:
    """Return the two sides of the match that is shown.

    Raises
    ------
    ObjectError
        If there is none, or its meshes cannot be written to.
    """
    halves = common_match(cast("bpy.types.Scene", context.scene))
    if halves is None:
        raise ObjectError("There is no match to show. Pick two meshes as Source and Target, and match them.")
    for half in halves:
        for part in parts_of(half.obj):
            check_writable(part)
            check_mode(part)
    return halves


class HIERMATCH_OT_show(bpy.types.Operator):
    """Show a match in colours."""

    bl_idname = "hiermatch.show"
    bl_label = "Show"
    bl_description = "Show the match in colors in this viewport, or show the meshes as before"
    bl_options = {"REGISTER", "UNDO"}

    view: bpy.props.EnumProperty(name="Show", description="What to show", items=VIEW_ITEMS, default="MATCH")

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:  # noqa: ANN401 - the operator's own
        """Describe the button by what it shows."""
        return {identifier: text for identifier, _, text in VIEW_ITEMS}[properties.view]

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it in Object Mode, when nothing else is running."""
        return can_start(cls, context)

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Show it, and remember what was shown before."""
        try:
            if self.view == "NONE":
                _go_back(context)
            else:
                _show(context, _match_of(context), self.view)
        except HierMatchError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        redraw_views(window_manager_of(context))
        return {"FINISHED"}


class HIERMATCH_OT_write_regions(bpy.types.Operator):
    """Write regions as vertex groups."""

    bl_idname = "hiermatch.write_regions"
    bl_label = "Write Regions"
    bl_description = (
        "Write a vertex group for each matched point with all vertices that are nearer to it than to any other; groups "
        "of the same name are the same region"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it in Object Mode, when nothing else is running."""
        return can_start(cls, context)

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Write them."""
        try:
            count = region_groups(context, _match_of(context))
        except HierMatchError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        self.report({"INFO"}, translated(f"Wrote {count} regions on both meshes as vertex groups"))
        return {"FINISHED"}


def _show(context: bpy.types.Context, halves: tuple[Half, Half], view: str) -> None:
    prepare_view(context, halves, view)
    steering, shading = steering_of(context), _shading(context)
    objects = [part for half in halves for part in parts_of(half.obj)]
    if not steering.before:
        steering.before = json.dumps(
            {
                "colors": [mesh_of(obj).attributes.active_color_name or "" for obj in objects],
                "shading": [shading.type, shading.color_type] if shading else None,
            }
        )
    name = attribute_of(halves[0].prefix, view)
    show_attribute(objects, [name] * len(objects))
    if shading:
        shading.type = "SOLID"
        shading.color_type = "VERTEX"


def _go_back(context: bpy.types.Context) -> None:
    """Show what was shown before the first view."""
    steering, shading = steering_of(context), _shading(context)
    before: Any = json.loads(steering.before) if steering.before else {"colors": ["", ""], "shading": None}
    if before["shading"] and shading:
        shading.type = "SOLID"  # only there the other is as it was
        shading.color_type = before["shading"][1]
        shading.type = before["shading"][0]
    pair = steered_pair(cast("bpy.types.Scene", context.scene))
    if pair is not None:
        show_attribute([part for side in pair for part in parts_of(side)], before["colors"])
    steering.before = ""


def _shading(context: bpy.types.Context) -> Any:  # noqa: ANN401 - one viewport's shading, or None
    """Return how the viewport is shaded that the operator is called from; None if it is no viewport."""
    space: Any = context.space_data
    return space.shading if space is not None and space.type == "VIEW_3D" else None
