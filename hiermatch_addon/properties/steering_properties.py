# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Properties of the panels for steering a match: the rows of their lists, and the options of the overlay."""

from __future__ import annotations

from typing import Any, cast

import bpy

from ..common.redraw import redraw_views
from ..storage.landmarks import find_landmarks, rename_landmark
from .steering_lists import landmark_label, steered_pair


def _redraw(_owner: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Draw the overlay anew, in all viewports."""
    redraw_views(cast("bpy.types.WindowManager", context.window_manager))


def _rename(row: Any, _context: bpy.types.Context) -> None:  # noqa: ANN401 - a row of the list below
    """Let the landmark of a row have its name on both meshes."""
    pair = steered_pair(cast("bpy.types.Scene", row.id_data))
    if pair is None:
        return
    known = {one.number: one.name for one in find_landmarks(*pair)}
    name = "" if row.label == landmark_label(row.number) else row.label
    if known.get(row.number, name) != name:  # else the list was filled
        rename_landmark(*pair, row.number, name)


class HIERMATCH_PG_landmark(bpy.types.PropertyGroup):
    """A row of the list of landmarks."""

    label: bpy.props.StringProperty(
        name="Name", description="What the landmark is called; double-click to change it", update=_rename
    )
    number: bpy.props.IntProperty(name="Number", description="By which the landmark is known on both meshes")
    source: bpy.props.IntProperty(name="Source Vertex", description="Vertex of the source")
    target: bpy.props.IntProperty(name="Target Vertex", description="Vertex of the target that corresponds to it")
    use: bpy.props.BoolProperty(name="Use", description="Whether a match keeps to the landmark", default=True)


class HIERMATCH_PG_pair(bpy.types.PropertyGroup):
    """A row of the list of matched points."""

    number: bpy.props.IntProperty(name="Number", description="Which of the matched points it is, from 1")
    source: bpy.props.IntProperty(name="Source Vertex", description="Vertex of the source that is nearest to the point")
    target: bpy.props.IntProperty(name="Target Vertex", description="Vertex of the target that is nearest to the point")
    source_corners: bpy.props.IntVectorProperty(name="Source Corners", description="Vertices around the point")
    source_weights: bpy.props.FloatVectorProperty(name="Source Weights", description="Where it is between them")
    target_corners: bpy.props.IntVectorProperty(
        name="Target Corners", description="Vertices around the corresponding point"
    )
    target_weights: bpy.props.FloatVectorProperty(name="Target Weights", description="Where it is between them")
    distortion: bpy.props.FloatProperty(
        name="Distortion",
        description="How much the distances from this point to the others differ between the two meshes, in units of "
        "the square root of the surface area",
    )
    locked: bpy.props.BoolProperty(name="Locked", description="Whether the point is a landmark, too")


class HIERMATCH_PG_steering(bpy.types.PropertyGroup):
    """The state of the panels for steering a match on a scene."""

    landmarks: bpy.props.CollectionProperty(
        name="Landmarks", description="Landmarks that source and target have in common", type=HIERMATCH_PG_landmark
    )
    landmark_index: bpy.props.IntProperty(
        name="Landmark", description="The row of the list of landmarks that is active", min=0, update=_redraw
    )
    pairs: bpy.props.CollectionProperty(
        name="Matched Points", description="The matched points, the worst first", type=HIERMATCH_PG_pair
    )
    pair_index: bpy.props.IntProperty(
        name="Matched Point", description="The row of the list of matched points that is active", min=0, update=_redraw
    )
    before: bpy.props.StringProperty(
        name="Before", description="What was shown before, as a JSON text; empty if nothing"
    )
    revision: bpy.props.IntProperty(name="Revision", description="Grows with each change of a list")
    show_overlay: bpy.props.BoolProperty(
        name="Show in Viewport",
        description="Draw matched points and landmarks on both meshes in the 3D viewports",
        update=_redraw,
    )
    show_points: bpy.props.BoolProperty(
        name="Points",
        description="Draw the matched points, from blue to yellow by distortion",
        default=True,
        update=_redraw,
    )
    show_lines: bpy.props.BoolProperty(
        name="Lines", description="Draw a line between the two places of each point", default=True, update=_redraw
    )
    show_labels: bpy.props.BoolProperty(
        name="Numbers", description="Write the numbers of landmarks and of the worst points beside them", update=_redraw
    )


def steering_of(context: bpy.types.Context) -> HIERMATCH_PG_steering:
    """Return the state of the panels for steering a match on the scene."""
    return cast("Any", context.scene).hiermatch_steering
