# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones that clothes, hair and accessories have for themselves, added to the rig of the body that they are put on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ....engine import bones_of_items, moved_with_items, row_sums
from ...scene.armature_copy import NewBone, add_bones
from ...scene.armatures import SourceRig, armature_of, find_armature
from ...scene.pair import is_own
from ...scene.worn.fitted_copies import ITEM
from .item_weights import in_columns

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import bpy
    from numpy.typing import NDArray
    from scipy.sparse import csr_array

    from ....engine import BonePairing, FittedItem
    from ...scene.character import Side
    from .item_weights import ItemWeights


@dataclass(frozen=True, eq=False)
class ItemBones:
    """Bones that move items, but not the body that wears them.

    Attributes
    ----------
    rig : SourceRig
        The rig that they belong to, a bones.
    numbers : tuple of int
        Which of its bones they are, parents first.
    normals : (a, 3) array of float
        The directions of the local z axes of all its bones, in world space.
    connected : tuple of bool
        Which of its bones hang on the tails of their parents.
    """

    rig: SourceRig
    numbers: tuple[int, ...]
    normals: NDArray[np.float64]
    connected: tuple[bool, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """What they are called."""
        return tuple(self.rig.names[number] for number in self.numbers)

    def placed(
        self,
        items: Sequence[tuple[ItemWeights, NDArray[np.float64], FittedItem]],
        skins: Sequence[csr_array],
        other: SourceRig,
        pairing: BonePairing | None,
    ) -> list[NewBone]:
        """Place them on the other body, each on the bone there that stands for its parent.

        Parameters
        ----------
        items : sequence of tuple
            Weights of each item, its vertices before, and how it was fitted.
        skins : sequence of (n, b) csr_array of float
            For each item the weights of the other body's skin below it.
        other : SourceRig
            The other body's rig, b bones.
        pairing : BonePairing, optional
            Pairs of bones of the two.
        """
        moving = [row_sums(in_columns(weights, self.names)) for weights, _, _ in items]
        held = [number for number, amount in enumerate(moving) if amount.any()]
        skeleton = self.rig.skeleton
        chosen = np.array(self.numbers)
        around = [items[number][1:] for number in held]
        heads, rotations = moved_with_items(skeleton.heads[chosen], around)
        tails, _ = moved_with_items(skeleton.tails[chosen], around)
        below = sum(moving[number] @ skins[number] for number in held)
        partners = self._partners(other, pairing)
        made = []
        for place, bone in enumerate(self.numbers):
            parent = int(skeleton.parents[bone])
            hangs = parent in self.numbers
            made.append(
                NewBone(
                    self.rig.names[bone],
                    self.rig.names[parent] if hangs else self._parent(bone, partners, other.names, np.asarray(below)),
                    heads[place],
                    tails[place],
                    rotations[place] @ self.normals[bone],
                    connected=hangs and self.connected[bone],
                    marks={ITEM: self.rig.armature_name},
                )
            )
        return made

    def _partners(self, other: SourceRig, pairing: BonePairing | None) -> dict[int, str]:
        """For bones of the rig those of the other that stand for them: of the same name, or paired."""
        same = {number: name for number, name in enumerate(self.rig.names) if name in other.names}
        if pairing is None:
            return same
        order = np.argsort(pairing.scores, kind="stable")
        paired = {int(pairing.sources[one]): other.names[int(pairing.targets[one])] for one in order}
        return paired | same

    def _parent(self, bone: int, partners: Mapping[int, str], names: Sequence[str], below: NDArray[np.float64]) -> str:
        """Find the bone on which one of them hangs: its next parent's partner, or what moves the skin below most."""
        parent = int(self.rig.skeleton.parents[bone])
        while parent >= 0:
            if parent in partners:
                return partners[parent]
            parent = int(self.rig.skeleton.parents[parent])
        return names[int(below.argmax())] if below.any() else ""

    @staticmethod
    def write(context: bpy.types.Context, body: Side, bones: Sequence[NewBone]) -> None:
        """Add them to the armature of the other body."""
        armature = find_armature(body)
        if armature is not None and bones:
            add_bones(context, armature, bones)


def read_item_bones(
    source: Side, target: Side, rig: SourceRig | None, items: Sequence[ItemWeights]
) -> tuple[ItemBones | None, str]:
    """Find the bones that only items have, and which the target's armature lacks, or has from a run before.

    Returns
    -------
    bones : ItemBones or None
        None if there are none, or no armature of the target's that could get them.
    note : str
        What is to be known; may be empty.
    """
    armature, other = find_armature(source), find_armature(target)
    if rig is None or armature is None or other is None:
        return None, ""
    on_items = sum(in_columns(one, rig.names).sum(axis=0) for one in items)
    on_body = rig.weights.sum(axis=0)
    found = bones_of_items(rig.skeleton.parents, on_body > 0, np.asarray(on_items) > 0)
    theirs = armature_of(other).bones
    lacking = [
        number for number in found if rig.names[number] not in theirs or ITEM in cast("Any", theirs[rig.names[number]])
    ]
    if not lacking:
        return None, ""
    if not is_own(other):
        return None, (
            f'The armature "{other.name}" is linked from another file, so bones of the items were not added to it. '
            "Make it local first."
        )
    bones = armature_of(armature).bones
    matrix = np.array(armature.matrix_world, np.float64)[:3, :3]
    axes = np.array([bone.matrix_local.col[2][:3] for bone in bones], np.float64).reshape(-1, 3)
    connected = tuple(bone.use_connect for bone in bones)
    return ItemBones(rig, tuple(lacking), axes @ matrix.T, connected), ""
