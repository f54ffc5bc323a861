# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Show a match in colours, and write its regions."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import mesh_of, window_manager_of
from ..common.errors import ObjectError
from ..common.redraw import redraw_views
from ..common.translated_text import translated
from ..jobs.running import Startable
from ..properties.steering_lists import check_steered, common_match
from ..properties.steering_properties import steering_of
from ..properties.viewport_shading import shade_as_before, shade_by_colors
from ..scene.character import parts_of
from ..scene.pair import check_mode, check_writable
from ..storage.views.views import VIEW_ITEMS, attribute_of, prepare_view, region_groups, show_attribute
from .reported_errors import reporting_errors

if TYPE_CHECKING:
    from collections.abc import Mapping

    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ..properties.steering_properties import HIERMATCH_PG_steering
    from ..storage.halves import Half


def _match_of(context: bpy.types.Context) -> tuple[Half, Half]:
    """Return the two sides of the match that is shown.

    Raises
    ------
    ObjectError
        If there is none, or its meshes cannot be written to.
    """
    scene = cast("bpy.types.Scene", context.scene)
    halves = common_match(scene)
    if halves is None:
        check_steered(scene)
        raise ObjectError("There is no match to show. Pick two meshes as Source and Target, and match them.")
    for half in halves:
        for part in parts_of(half.obj):
            check_writable(part)
            check_mode(part)
    return halves


class HIERMATCH_OT_show(Startable, bpy.types.Operator):
    """Show a match in colours."""

    bl_idname = "hiermatch.show"
    bl_label = "Show"
    bl_description = "Show the match in colors in this viewport, or show the meshes as before"
    modes = ("OBJECT", "POSE")

    view: bpy.props.EnumProperty(name="Show", description="What to show", items=VIEW_ITEMS, default="MATCH")

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:  # noqa: ANN401 - the operator's own
        """Describe the button by what it shows."""
        return {identifier: text for identifier, _, text in VIEW_ITEMS}[properties.view]

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Show it, and remember what was shown before."""
        if self.view == "NONE":
            if not _go_back(context):
                return {"CANCELLED"}  # else it would be a step to undo, and what was undone could not be redone
        else:
            _show(context, _match_of(context), self.view)
        redraw_views(window_manager_of(context))
        return {"FINISHED"}


class HIERMATCH_OT_write_regions(Startable, bpy.types.Operator):
    """Write regions as vertex groups."""

    bl_idname = "hiermatch.write_regions"
    bl_label = "Write Regions"
    bl_description = (
        "Write a vertex group for each matched point with all vertices that are nearer to it than to any other; groups "
        "of the same name are the same region"
    )

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Write them."""
        count = region_groups(context, _match_of(context))
        self.report({"INFO"}, translated(f"Wrote {count} regions on both meshes as vertex groups"))
        return {"FINISHED"}


def _show(context: bpy.types.Context, halves: tuple[Half, Half], view: str) -> None:
    prepare_view(context, halves, view)
    meshes = (mesh_of(part) for half in halves for part in parts_of(half.obj))
    show_colors(context, dict.fromkeys(meshes, attribute_of(halves[0].prefix, view)))


def show_colors(context: bpy.types.Context, shown: Mapping[bpy.types.Mesh, str]) -> None:
    """Show color attributes of meshes in the viewport of the context, and remember what they showed before."""
    steering = steering_of(context)
    before = _before(steering)
    for mesh, name in shown.items():
        before.setdefault(mesh.name, mesh.attributes.active_color_name or "")
        show_attribute(mesh, name)
    steering.before = json.dumps(before)
    shade_by_colors(context.space_data)


def _go_back(context: bpy.types.Context) -> bool:
    """Show what was shown before the first view, of all meshes and in all viewports that show one since.

    Returns
    -------
    bool
        Whether anything else was shown.
    """
    steering = steering_of(context)
    changed = bool(steering.before)
    for name, color in _before(steering).items():
        mesh = bpy.data.meshes.get(name)
        if mesh is not None and mesh.library is None:
            show_attribute(mesh, color)
    if changed:
        steering.before = ""
    return shade_as_before() or changed


def _before(steering: HIERMATCH_PG_steering) -> dict[str, str]:
    """Return which color attributes meshes showed before, by their names."""
    found: dict[str, str] = json.loads(steering.before or "{}")
    return found
