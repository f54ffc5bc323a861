# SPDX-License-Identifier: GPL-3.0-or-later
"""Common base of the operators between two armatures, named or picked or selected."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ...common.access import view_layer_of
from ...common.errors import ObjectError
from ...common.translated_text import translated
from ...jobs.job_operator import JobOperator
from ...jobs.running import can_start
from ...properties.freshness import refresh
from ...properties.motion_properties import motion_of
from ...properties.panel_state import state_of
from ...properties.summary import remember
from ...scene.motion.rigged_body import rig_of
from ...scene.pair import named_object

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...jobs.pairing_job import PairedRigs

__all__ = ["MotionOperator", "pick_rigs", "picked_rigs"]

_props: Any = bpy.props  # whose functions Blender's stubs declare to return nothing


class MotionOperator(JobOperator):
    """To be inherited from before `bpy.types.Operator`."""

    __annotations__ = {
        "source": _props.StringProperty(
            name="Source",
            description="Name of the armature that has the motion, or of a mesh that it moves; if empty, the one "
            "picked in the panel or else the active object",
            options={"SKIP_SAVE"},
        ),
        "target": _props.StringProperty(
            name="Target",
            description="Name of the armature that is to have it, or of a mesh that it moves; if empty, the one picked "
            "in the panel or else all other selected armatures",
            options={"SKIP_SAVE"},
        ),
        "targets": _props.CollectionProperty(
            name="Targets",
            description="Names of several of them",
            type=bpy.types.OperatorFileListElement,
            options={"HIDDEN", "SKIP_SAVE"},
        ),
    }

    if TYPE_CHECKING:
        source: str
        target: str
        targets: Any

    doing = "Carrying motion over"
    cancelled = "It was cancelled. Nothing was written"
    panel = "HIERMATCH_PT_motion"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it in Object Mode and Pose Mode, when nothing else is running."""
        operator = cast("type[bpy.types.Operator]", cls)
        return context.mode == "POSE" or can_start(operator, context)

    def _rigs(self, context: bpy.types.Context) -> tuple[bpy.types.Object, list[bpy.types.Object]]:
        """Find source and targets, and remember their names, so that Adjust Last Operation repeats it with them."""
        names = [item.name for item in self.targets] or ([self.target] if self.target else [])
        source, targets = pick_rigs(context, self.source, names)
        self.source = source.name
        self.targets.clear()
        for target in targets:
            self.targets.add().name = target.name
        return source, targets

    def _remember_pairs(self, context: bpy.types.Context, paired: Sequence[PairedRigs]) -> None:
        """Keep what is known of new matches, and say what was paired."""
        state = state_of(context)
        for one in paired:
            if one.outcome is not None:
                names = (one.outcome.source, one.outcome.target)
                remember(state.summary, one.outcome.stored, names, state.prefix, one.outcome.seconds)
            self.report(
                {"INFO"},
                translated(f'Paired {one.bones} bones of "{one.target}" with bones of "{one.source}"'),
            )
        refresh(cast("bpy.types.Scene", context.scene))


def pick_rigs(
    context: bpy.types.Context, source_name: str, target_names: Sequence[str]
) -> tuple[bpy.types.Object, list[bpy.types.Object]]:
    """Find source and targets: by name, else as picked in the panel, else as selected.

    Raises
    ------
    ObjectError
        If a name is unknown, or the selection leaves open what is meant.
    """
    state, layer = motion_of(context), view_layer_of(context)
    targets = [named_object(name) for name in dict.fromkeys(target_names)]
    source = named_object(source_name) if source_name else cast("bpy.types.Object | None", state.source)
    if not targets and state.target is not None and state.target != source:
        targets = [cast("bpy.types.Object", state.target)]
    active = layer.objects.active
    if source is None and active is not None and active.type in {"ARMATURE", "MESH"} and active not in targets:
        source = active
    if source is None:
        raise ObjectError("Which armature is the Source is open: pick it in the panel, or make it the active object.")
    if not targets:
        rig = rig_of(source)
        targets = [obj for obj in layer.objects.selected if obj.type == "ARMATURE" and obj != rig]
    if not targets:
        raise ObjectError(
            "It is open which armature is the Target. Pick it in the panel, or select one or more beside the Source."
        )
    return source, targets


def picked_rigs(context: bpy.types.Context, names: tuple[str, str]) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Find the two armatures that are meant by names, or as in `pick_rigs`; of several targets the first."""
    source, targets = pick_rigs(context, names[0], [names[1]] if names[1] else [])
    return rig_of(source), rig_of(targets[0])
