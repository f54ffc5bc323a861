# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Lock matched points, show where they are, and take them away."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ...common.access import view_layer_of
from ...common.errors import ObjectError
from ...properties.steering_lists import common_match, pair_rows, point_name, steered_pair
from ...properties.steering_properties import steering_of
from ...scene.pair import check_pair
from ...storage.halves import in_order
from ...storage.landmarks import add_landmarks, find_landmarks, remove_landmark, select_on_side
from ...storage.stored_match import StoredMatch
from ...storage.writing import change_kept, take_away
from .landmark_operator import LandmarkOperator

if TYPE_CHECKING:
    from ...scene.character import Side
    from ...storage.halves import Half


class _PairOperator(LandmarkOperator):
    """An operator on one of the matched points."""

    number: bpy.props.IntProperty(
        name="Number",
        description="Which matched point; if zero, the one that is active in the list",
        min=0,
        options={"SKIP_SAVE"},
    )

    def _row(self, context: bpy.types.Context, source: Side, target: Side) -> dict[str, Any]:
        """Find what the row of the list holds that is meant; the list may show another pair than the named one.

        Raises
        ------
        ObjectError
            If there is none.
        """
        scene, steering = cast("bpy.types.Scene", context.scene), steering_of(context)
        rows, listed = pair_rows(scene, (source, target)), steered_pair(scene) in (None, (source, target))
        if self.number:
            chosen = [row for row in rows if row["number"] == self.number]
        else:
            chosen = rows[steering.pair_index : steering.pair_index + 1] if listed else []
        if not chosen:
            raise ObjectError(
                "There is no such matched point. Match Source and Target first, or choose a point in the list."
            )
        if listed:
            steering.pair_index = rows.index(chosen[0])
        return chosen[0]


class HIERMATCH_OT_select_pair(_PairOperator, bpy.types.Operator):
    """Show where a matched point is."""

    bl_idname = "hiermatch.select_pair"
    bl_label = "Select Matched Point"
    bl_description = "Select the vertices nearest to a matched point, and nothing else of the two meshes"

    def _edit(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        row = self._row(context, source, target)
        select_on_side(source, [row["source"]])
        select_on_side(target, [row["target"]])
        return ""


class HIERMATCH_OT_lock_pair(_PairOperator, bpy.types.Operator):
    """Make a landmark of a matched point."""

    bl_idname = "hiermatch.lock_pair"
    bl_label = "Lock Matched Point"
    bl_description = (
        "Make a landmark of a matched point that is right, so that it stays where it is when the match is refined or "
        "made anew; once more lets it go"
    )

    def _edit(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        row = self._row(context, source, target)
        pair = (row["source"], row["target"])
        for landmark in find_landmarks(source, target):
            if landmark.use and (landmark.source, landmark.target) == pair:
                remove_landmark(source, target, landmark.number)
                return f"Unlocked {row['name']}"
        (added,) = add_landmarks(source, target, [pair])
        return f"Locked {row['name']} as landmark {added.number}"


class HIERMATCH_OT_remove_pair(_PairOperator, bpy.types.Operator):
    """Take a matched point away."""

    bl_idname = "hiermatch.remove_pair"
    bl_label = "Remove Matched Point"
    bl_description = "Remove the vertex groups of a matched point from both meshes; the dense map stays as it is"

    def _edit(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        check_pair(view_layer_of(context), source, target)
        row = self._row(context, source, target)
        number, name = row["number"], row["name"]
        halves = common_match(cast("bpy.types.Scene", context.scene), (source, target))
        if halves is None:
            raise ObjectError(f'"{source.name}" and "{target.name}" carry no match with one another.')
        leave_out(halves, number - 1)
        return f"Removed {name}"


def leave_out(halves: tuple[Half, Half], number: int) -> None:
    """Remove the vertex groups of a point, numbered from 0, and keep in mind that it has none."""
    first, second = in_order(*halves)
    left_out = {*StoredMatch.from_plain(first.kept, second.kept).left_out, number}
    change_kept(first.obj, first.prefix, left_out=" ".join(map(str, sorted(left_out))))
    for half in halves:
        take_away(half.obj, [point_name(half.prefix, number + 1)], half.prefix)
