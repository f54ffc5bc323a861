# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Remove landmarks, switch them on and off, and show where they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...common.errors import ObjectError
from ...common.phrases import counted
from ...properties.steering_properties import steering_of
from ...storage.landmarks import clear_landmarks, find_landmarks, remove_landmark, select_on_side, switch_landmark
from .landmark_operator import LandmarkOperator

if TYPE_CHECKING:
    from ...scene.character import Side


class _OneLandmark(LandmarkOperator):
    """What is done to one landmark."""

    number: bpy.props.IntProperty(
        name="Number",
        description="Which landmark; if zero, the one that is active in the list",
        min=0,
        options={"SKIP_SAVE"},
    )

    def _chosen(self, context: bpy.types.Context) -> int:
        """Return the number, or that of the active row of the list if it is zero."""
        steering = steering_of(context)
        if self.number:
            return int(self.number)
        if not 0 <= steering.landmark_index < len(steering.landmarks):
            raise ObjectError("No landmark is chosen. Choose one in the list, or add one.")
        return int(steering.landmarks[steering.landmark_index].number)


class HIERMATCH_OT_remove_landmark(_OneLandmark, bpy.types.Operator):
    """Remove a landmark."""

    bl_idname = "hiermatch.remove_landmark"
    bl_label = "Remove Landmark"
    bl_description = "Remove a landmark from both meshes"

    def _edit(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        number = self._chosen(context)
        remove_landmark(source, target, number)
        return f"Removed landmark {number}"


class HIERMATCH_OT_clear_landmarks(LandmarkOperator, bpy.types.Operator):
    """Remove all landmarks of two meshes."""

    bl_idname = "hiermatch.clear_landmarks"
    bl_label = "Clear Landmarks"
    bl_description = "Remove all landmarks that source and target have in common"

    def _edit(self, _context: bpy.types.Context, source: Side, target: Side) -> str:
        return f"Removed {counted(clear_landmarks(source, target), 'landmark')}"


class HIERMATCH_OT_switch_landmark(_OneLandmark, bpy.types.Operator):
    """Switch a landmark on or off."""

    bl_idname = "hiermatch.switch_landmark"
    bl_label = "Switch Landmark"
    bl_description = "Switch a landmark on or off; matches keep to those that are on"

    use: bpy.props.BoolProperty(name="Use", description="Whether matches are to keep to it", default=True)

    def _edit(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        number = self._chosen(context)
        switch_landmark(source, target, number, use=self.use)
        return f"Landmark {number} is {'on' if self.use else 'off'}"


class HIERMATCH_OT_select_landmark(_OneLandmark, bpy.types.Operator):
    """Show where a landmark is."""

    bl_idname = "hiermatch.select_landmark"
    bl_label = "Select Landmark"
    bl_description = "Select the two vertices of a landmark, and nothing else of the two meshes"

    def _edit(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        number = self._chosen(context)
        found = {landmark.number: landmark for landmark in find_landmarks(source, target)}
        if number not in found:
            raise ObjectError(f'"{source.name}" and "{target.name}" have no landmark {number} in common.')
        select_on_side(source, [found[number].source])
        select_on_side(target, [found[number].target])
        steering_of(context).landmark_index = list(found).index(number)
        return ""
