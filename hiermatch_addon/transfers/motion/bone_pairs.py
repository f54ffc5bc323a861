# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of bones of two rigs, found by the surface that they move."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ....engine import Progress, pair_bones
from ...common.errors import ObjectError
from ...common.phrases import counted
from ...common.side_names import side_of
from ...jobs.transfer import Transfer, TransferReport
from ...jobs.transfer_job import TransferJob, carry_fresh_match
from ...properties.bone_pairs import held_pairs, write_pairing
from ...scene.armatures import armature_of, bone_weights, read_skeleton, without_held
from ...scene.character import parts_of
from ...scene.motion.rigs import in_own_spaces, object_rotation, two_rigs

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray
    from scipy.sparse import csr_array

    from ....engine import BonePairing, Skeleton, Steps
    from ...jobs.transfer import Passage
    from ...jobs.transfer_job import TransferOptions
    from ...scene.character import Side

_EXCHANGED = 0.5
"""Part of the pairs with sides in their names from which on, if they contradict, the match may be mirrored."""


@dataclass(frozen=True, eq=False)
class _Task:
    """What was read: the names of both rigs' bones, the target's bones, both weights, and how both stand."""

    rigs: tuple[str, str]
    names: tuple[tuple[str, ...], tuple[str, ...]]
    skeleton: Skeleton
    weights: tuple[csr_array, csr_array]
    held: tuple[list[tuple[int, int]], list[int]]
    turns: tuple[NDArray[np.float64], NDArray[np.float64]]
    matrix: NDArray[np.float64]


def pairing_job(
    context: bpy.types.Context, source: Side, targets: Sequence[Side], options: TransferOptions
) -> tuple[TransferJob, list[BonePairTransfer]]:
    """Make the job that pairs the bones of a rig with those of others, and what it does for each of them.

    Raises
    ------
    HierMatchError
        If the objects do not allow it.
    """
    for target in targets:
        two_rigs(source, target, written=False)
    if len(targets) == 1:
        source, *targets = _matched_sides(source, targets[0], options.prefix)
    made = [BonePairTransfer() for _ in targets]
    waiting = iter(made)
    return TransferJob(context, source, targets, lambda: [next(waiting)], options, writes=False), made


def _matched_sides(source: Side, target: Side, prefix: str) -> tuple[Side, Side]:
    """Return two sides, or those parts of them that carry a match with one another if they do not as a whole."""
    tried = [(source, target), *product(parts_of(source), parts_of(target))]
    return next((pair for pair in tried if carry_fresh_match(*pair, prefix)), (source, target))


class BonePairTransfer(Transfer):
    """Pairs the bones of the target's rig with the source's; see `Transfer`.

    Attributes
    ----------
    pairing : BonePairing or None
        The pairs, in the armatures' own spaces; None as long as they were not computed.
    """

    label = "Bone Pairs"
    mirrors = False

    def __init__(self) -> None:
        self.pairing: BonePairing | None = None
        self._task: _Task

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read the target's rig, and what is held of the pairs that are there."""
        rigs = two_rigs(source, target, written=False)
        names = tuple(tuple(bone.name for bone in armature_of(rig).bones) for rig in rigs)
        weights = bone_weights(source, rigs[0], names[0])
        if not weights.nnz:
            raise ObjectError(
                f'No vertex of "{source.name}" is in a vertex group of a deforming bone of "{rigs[0].name}", so '
                "it is not known what the bones belong to. Bind the Source to its armature with weights first."
            )
        self._task = _Task(
            (rigs[0].name, rigs[1].name),
            cast("Any", names),
            read_skeleton(rigs[1]),
            (without_held(source, weights), without_held(target, bone_weights(target, rigs[1], names[1]))),
            held_pairs(cast("bpy.types.Scene", context.scene), *rigs),
            (object_rotation(rigs[0]), object_rotation(rigs[1])),
            np.array(rigs[1].matrix_world, np.float64),
        )

    def steps(self, passage: Passage) -> Steps[None]:
        """Compare the bones."""
        task = self._task
        if passage.rig is None:
            raise RuntimeError("The rig was not fitted.")
        yield Progress(0.0, "Pairing bones")
        found = pair_bones(
            replace(passage.rig, weights=task.weights[0]),
            passage.pair.source,
            passage.pair.target,
            task.skeleton,
            task.weights[1],
            fixed=task.held[0],
            alone=task.held[1],
            frames=(task.turns[1] @ task.turns[0].T)[None],
        )
        if not len(found):
            raise ObjectError(
                f'No bone of "{task.rigs[1]}" moves what one of "{task.rigs[0]}" moves. Check the match, and that both '
                "meshes have weights."
            )
        self.pairing = in_own_spaces(found, task.turns, task.matrix)

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write the table of pairs."""
        rigs = two_rigs(source, target, written=False)
        for rig, names in zip(rigs, self._task.names, strict=True):
            if tuple(bone.name for bone in armature_of(rig).bones) != names:
                raise ObjectError(f'The bones of "{rig.name}" were changed meanwhile. Nothing was written.')
        pairing = cast("BonePairing", self.pairing)
        write_pairing(cast("bpy.types.Scene", context.scene), *rigs, pairing)
        count = counted(len(set(pairing.targets.tolist())), "paired bone")
        return TransferReport(count, self._notes(pairing), carries=False)

    def _notes(self, pairing: BonePairing) -> tuple[str, ...]:
        """Say what is to be known: names of sides that contradict."""
        task = self._task
        sides = [
            side_of(task.names[0][source]) * side_of(task.names[1][target])
            for source, target in zip(pairing.sources, pairing.targets, strict=True)
        ]
        if sum(each < 0 for each in sides) <= _EXCHANGED * sum(each != 0 for each in sides):
            return ()
        said = (
            f'By their names, left bones of "{task.rigs[0]}" are paired with right ones of "{task.rigs[1]}". '
            "If that is wrong, one of them looks the other way, or the match is mirrored: use another answer of the "
            "match, and pair the bones again."
        )
        return (said,)
