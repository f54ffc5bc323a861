# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights for the rig that the target has already: the source's, handed to the bones paired with its own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np
from scipy.sparse import csr_array

from ....engine import Columns, carry_weights_steps, paired_weights, put_in
from ...common.errors import ObjectError
from ...common.phrases import counted, listed
from ...jobs.transfer import Transfer, TransferReport
from ...properties.bone_pairs import pairing_notes, pairing_of
from ...scene.armatures import armature_of, find_armature, read_rig, read_skeleton
from ...scene.character import parts_of
from ...scene.deform_layer import check_weights_writable
from ...scene.motion.rigs import rig_of
from ..weight_groups import group_columns, locked_groups, write_groups

if TYPE_CHECKING:
    import bpy

    from ....engine import BonePairing, Skeleton, Steps
    from ...jobs.transfer import Passage
    from ...scene.armatures import SourceRig
    from ...scene.character import Side


@dataclass(frozen=True, eq=False)
class _Task:
    """What was read: the source's rig, the pairs, and bones and weights of the target."""

    rig: SourceRig
    pairing: BonePairing
    skeleton: Skeleton
    names: tuple[str, ...]
    before: csr_array
    columns: Columns


class PairedWeightTransfer(Transfer):
    """Carries weights to other bones; see `Transfer`.

    Parameters
    ----------
    limit : int
        How many bones may move a vertex; 0 for any number.
    """

    label = "Weights"

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._task: _Task
        self._result: csr_array = csr_array((0, 0))

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read the weights, and the pairs of the two rigs."""
        for part in parts_of(target):
            check_weights_writable(part)
        rig, armature = read_rig(source), find_armature(source)
        if rig is None or armature is None:
            raise ObjectError(f'"{source.name}" has no weights for the bones of an armature. Choose a rigged Source.')
        own = rig_of(target)
        pairing = pairing_of(cast("bpy.types.Scene", context.scene), armature, own)
        names = tuple(bone.name for bone in armature_of(own).bones)
        if pairing.sources.max() >= len(rig.names):
            raise ObjectError(f'The bones of "{armature.name}" were changed. Pair the bones again.')
        matrix = np.array(own.matrix_world, np.float64)
        placed = pairing.places @ matrix[:3, :3].T + matrix[:3, 3]
        worldly = replace(pairing, places=placed)
        locked = locked_groups(target)
        deforming = np.array([bone.use_deform for bone in armature_of(own).bones], bool)
        held = np.array([name in locked for name in names], bool)
        if not (deforming & ~held)[pairing.targets].any():
            raise ObjectError(
                f'The vertex groups of all paired bones of "{own.name}" are locked on "{target.name}", or the bones do '
                "not deform. Unlock some of them."
            )
        columns = Columns(held, deforming, deforming, yielding=True)
        self._task = _Task(rig, worldly, read_skeleton(own), names, group_columns(target, names), columns)

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute the weights of the target."""
        task = self._task
        carried = yield from carry_weights_steps(
            task.rig.weights, passage.pair.source, passage.pair.target, passage.pair.target_to_source
        )
        vertices = passage.pair.target.vertices
        handed = paired_weights(carried.weights, vertices, task.pairing, task.rig.skeleton, task.skeleton)
        self._result = put_in(task.before, handed, task.columns, limit=self._limit)

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write the groups of the target's bones."""
        task = self._task
        written = task.columns.new & ~task.columns.locked
        used = (self._result != 0).sum(axis=0) > 0
        present = {group.name for part in parts_of(target) for group in part.vertex_groups}
        numbers = [number for number in np.flatnonzero(written) if used[number] or task.names[number] in present]
        wanted = [task.names[number] for number in numbers]
        write_groups(target, wanted, self._result.tocsr()[:, numbers])
        held = [task.names[number] for number in np.flatnonzero(task.columns.locked)]
        notes = [f'Locked vertex groups of "{target.name}" were left alone: {listed(held)}.'] if held else []
        notes += pairing_notes(cast("bpy.types.Scene", context.scene), rig_of(source), rig_of(target))
        return TransferReport(counted(len(numbers), "vertex group"), tuple(notes))
