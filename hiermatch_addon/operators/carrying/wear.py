# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Fit clothes, hair and accessories of one body to others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ...properties.panel_state import picked, state_of
from ...scene.worn.garments import meshes_of, selected_items, undressed
from ...transfers.options.wear import WearOptions, wear_settings
from ...transfers.wearing.wear_transfer import WearTransfer
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer
    from ...jobs.transfer_job import TransferJob
    from ...scene.character import Side
    from ...transfers.motion.motion_job import MotionJob


class HIERMATCH_OT_wear(WearOptions, TransferOperator, bpy.types.Operator):
    """Fit clothes to another body."""

    bl_idname = "hiermatch.wear"
    bl_label = "Wear"
    bl_description = (
        "Fit clothes, hair and accessories of the source, which are objects of their own, to the matched bodies. "
        "Without named items it takes the selected ones, or else, if the source is one mesh, all others that its "
        "armature moves"
    )

    items: bpy.props.CollectionProperty(
        name="Items",
        description="Names of the objects to fit; if empty, those in the collection, or else the selected ones, or "
        "else, if the source is one mesh, all others that its armature moves",
        type=bpy.types.OperatorFileListElement,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    collection: bpy.props.StringProperty(
        name="Collection",
        description="Name of a collection whose meshes are fitted",
        options={"SKIP_SAVE"},
    )

    doing = "Fitting clothes"
    panel = "HIERMATCH_PT_wear"

    _chosen: tuple[str, ...] = ()

    def _start(self, context: bpy.types.Context) -> TransferJob | MotionJob:
        """Find bodies and items, and read them."""
        self._chosen = tuple(item.name for item in self.items)
        if not self._chosen and self.collection:
            bodies = [self.source, self.target, *(item.name for item in self.targets)]
            self._chosen = meshes_of(
                self.collection, *(bpy.data.objects[name] for name in bodies if name in bpy.data.objects)
            )
        options: Any = self
        self._writes = options.wear_hide != "NONE"  # else the body may be another file's
        job = super()._start(context)
        self.items.clear()
        for name in self._chosen:
            self.items.add().name = name
        return job

    def _pick(self, context: bpy.types.Context) -> tuple[Side, list[Side]]:
        """Find the bodies; what else is selected are items."""
        source, targets = super()._pick(context)
        if not self._chosen:
            self._left_out = ""
            named = bool(self.source) or picked(state_of(context))[0] is not None
            self._chosen = tuple(selected_items(context, source, targets, named=named))
        return undressed(source, self._chosen, context.evaluated_depsgraph_get()), targets

    def _transfers(self) -> list[Transfer]:
        options: Any = self
        return [WearTransfer(wear_settings(options, self._chosen))]
