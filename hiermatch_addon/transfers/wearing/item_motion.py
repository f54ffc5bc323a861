# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion of fitted items with the body: their weights in its rig, room for it, and the shape keys that they follow."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array, diags_array

from ....engine import (
    Skeleton,
    TriangleMesh,
    WeightedItem,
    carry_weights,
    follow_keys_steps,
    handed_weights,
    lift_for_poses_steps,
    mend_weights_steps,
    pair_bones,
    shares_below_steps,
    within,
)
from ...common.phrases import counted
from ...scene.armatures import SourceRig
from .item_weights import ItemWeights, chosen_weights, in_columns, replaced, within_limit

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from numpy.typing import NDArray

    from ....engine import BonePairing, FittedItem, Steps, WornItem
    from ...jobs.transfer import Passage
    from ...scene.armature_copy import NewBone
    from ..options.wear import WearSettings
    from .followed_keys import BodyKeys
    from .item_bones import ItemBones
    from .item_reading import ReadItem


class ItemMotion:
    """What moves fitted items.

    Parameters
    ----------
    settings : WearSettings
        How they get their weights, and whether they are tried in poses.
    rig : SourceRig or None
        What moves the source.
    other : SourceRig or None
        What moves the target; none if it has nothing, or the source's rig is fitted to it.
    fits_rig : bool
        Whether the source's rig is fitted to the target.
    old_bones : set of str
        The bones of the source's armature that move anything.
    item_bones : ItemBones, optional
        Bones of the items themselves, which come along.
    keys : BodyKeys, optional
        Shape keys of the target that the items follow.

    Attributes
    ----------
    weights : list of ItemWeights or None
        Of each item, if there is a rig.
    mended : dict of str to int
        At how many vertices of each item, by its name, they were mended for poses.
    lifted : dict of str to int
        How many vertices of each were lifted off the skin for that.
    fitted : list of FittedItem
        The items, lifted.
    new_bones : list of NewBone
        Bones of the items, placed on the target.
    handed : bool
        Whether weights went to bones that are paired with the items' own.
    followed : list of (k, n, 3) array of float
        For each item what the keys do to it.
    """

    def __init__(
        self,
        settings: WearSettings,
        rig: SourceRig | None,
        other: SourceRig | None,
        *,
        fits_rig: bool,
        old_bones: AbstractSet[str],
        item_bones: ItemBones | None,
        keys: BodyKeys | None,
    ) -> None:
        self._settings, self._rig, self._other, self._fits_rig = settings, rig, other, fits_rig
        self._bone_names = () if rig is None else rig.names
        self._old_bones, self._item_bones, self._keys = old_bones, item_bones, keys
        self._items: Sequence[ReadItem] = ()
        self.fitted: list[FittedItem] = []
        self.weights: list[ItemWeights | None] = []
        self.mended: dict[str, int] = {}
        self.lifted: dict[str, int] = {}
        self.new_bones: list[NewBone] = []
        self.handed = False
        self.followed: list[NDArray[np.float64]] = []

    def remarks(self, target: str, made: Mapping[str, str]) -> list[str]:
        """Say where the weights on a target of such a name come from, of what was made of the items, by their names."""
        said = []
        if any(weights is not None and weights.from_skin and weights.lost for weights in self.weights):
            said.append(
                f'The rig of "{target}" has other bones, so the weights were taken from its skin and from the '
                "bones that are paired with the items' own."
                if self.handed
                else f'The rig of "{target}" has other bones, so the weights were taken from its skin.'
            )
        said.extend(
            f'Weights of {counted(count, "vertex")} of "{made[name]}" were mended for poses.'
            for name, count in self.mended.items()
            if count
        )
        said.extend(
            f'{counted(count, "vertex")} of "{made[name]}" were lifted off the skin for poses.'
            for name, count in self.lifted.items()
            if count
        )
        return said

    def steps(self, passage: Passage, items: Sequence[ReadItem], fitted: Sequence[FittedItem]) -> Steps[None]:
        """Find how all items are moved with the body: their weights and keys."""
        self._items, self.fitted = items, list(fitted)
        self.weights = [None] * len(items)
        other = self._other
        if other is None and self._fits_rig and passage.rig is not None:
            weights = carry_weights(passage.rig.weights, passage.pair.target_to_source)
            skeleton = Skeleton(passage.rig.skeleton.parents, passage.rig.heads, passage.rig.tails)
            other = SourceRig("", passage.bone_names, skeleton, weights)
        if other is not None:
            yield from within(self._weight_steps(passage, other), 0.0, 0.4)
        if self._keys is not None and len(self._keys.settings):
            yield from within(self._key_steps(passage.pair.target, self._keys, other), 0.4, 1.0)

    def _key_steps(self, body: TriangleMesh, keys: BodyKeys, rig: SourceRig | None) -> Steps[None]:
        """Find how the items follow the body's keys."""
        worn = []
        for item, fitted, weights in zip(self._items, self.fitted, self.weights, strict=True):
            bones = None if rig is None or weights is None else in_columns(weights, rig.names)
            mesh = TriangleMesh(fitted.positions, item.worn.mesh.triangles)
            worn.append(replace(item.worn, mesh=mesh, bones=bones, pieces=fitted.pieces, margin=0.0))
        on_skin = None if rig is None else rig.weights
        self.followed = yield from follow_keys_steps(body, keys.offsets, worn, bones=on_skin)

    def _weight_steps(self, passage: Passage, rig: SourceRig) -> Steps[None]:
        """Find the weights of all items."""
        spread = passage.pair.source_to_target.interpolation
        lying = [(fitted.positions, csr_array(fitted.places @ spread)) for fitted in self.fitted]
        shares = yield from within(shares_below_steps(lying, passage.pair.target), 0.0, 0.1)
        skins = [csr_array(each @ rig.weights) for each in shares]
        brought = () if self._item_bones is None else self._item_bones.names
        lost = [name for name in self._bone_names if name in self._old_bones and name not in (*rig.names, *brought)]
        pairing = self._pairing(passage, rig, lost)
        self.handed = pairing is not None
        if self._item_bones is not None:
            placed = [
                (item.weights, item.worn.mesh.vertices, fitted)
                for item, fitted in zip(self._items, self.fitted, strict=True)
            ]
            self.new_bones = self._item_bones.placed(placed, skins, rig, pairing)
        every = tuple(dict.fromkeys([*rig.names, *brought]))
        found = []
        for item, fitted, carried in zip(self._items, self.fitted, skins, strict=True):
            if pairing is not None and passage.rig is not None and self._rig is not None:
                columns = in_columns(item.weights, self._bone_names)
                own = csr_array(columns @ diags_array(np.isin(self._bone_names, lost).astype(float)))
                below, bones = csr_array(fitted.places @ self._rig.weights), (passage.rig.skeleton, rig.skeleton)
                carried = handed_weights(own, below, carried, fitted.positions, pairing=pairing, bones=bones)  # noqa: PLW2901
            spread_out = in_columns(ItemWeights(rig.names, carried), every)
            old = self._old_bones - set(brought)
            handed = pairing is not None
            found.append(chosen_weights(item.weights, every, spread_out, old, self._settings, handed=handed))
        if self._settings.poses:
            yield from within(self._pose_steps(passage.pair.target, rig, found), 0.1, 1.0)
        self.weights = list(found)

    def _pose_steps(self, body: TriangleMesh, rig: SourceRig, found: list[ItemWeights]) -> Steps[None]:
        """Mend the weights that were found, and lift the items, where the skin comes through them in poses."""
        weighted = [
            WeightedItem(
                fitted.positions,
                item.worn.mesh.triangles,
                in_columns(weights, rig.names),
                pieces=fitted.pieces,
                left=_left(item.worn),
            )
            for item, fitted, weights in zip(self._items, self.fitted, found, strict=True)
        ]
        on_skin, skeleton = rig.weights, rig.skeleton
        steps = mend_weights_steps(weighted, body=body, skin_weights=on_skin, skeleton=skeleton)
        mended = yield from within(steps, 0.0, 0.6)
        for number, one in enumerate(mended):
            if self._items[number].held:  # it moves as one
                continue
            mixed = replaced(found[number], rig.names, one.weights, one.changed)
            found[number] = within_limit(mixed, rig.names, self._settings)
            self.mended[self._items[number].name] = int(one.changed.sum())
        weighted = [
            replace(item, weights=in_columns(weights, rig.names)) for item, weights in zip(weighted, found, strict=True)
        ]
        lifting = lift_for_poses_steps(weighted, body=body, skin_weights=on_skin, skeleton=skeleton)
        moves = yield from within(lifting, 0.6, 1.0)
        for number, (fitted, move) in enumerate(zip(self.fitted, moves, strict=True)):
            lengths = np.linalg.norm(move, axis=1)  # nearly along the normals of the skin
            self.fitted[number] = replace(
                fitted, positions=fitted.positions + move, clearance=fitted.clearance + lengths
            )
            self.lifted[self._items[number].name] = int((lengths > 0).sum())

    def _pairing(self, passage: Passage, rig: SourceRig, lost: Sequence[str]) -> BonePairing | None:
        """Pair the bones of both rigs, if items have weights in bones (of names that are lost) that the other lacks."""
        if self._settings.weights != "AUTO" or passage.rig is None or passage.bone_names != self._bone_names:
            return None
        if not any(in_columns(item.weights, lost).nnz for item in self._items):
            return None
        pairing = pair_bones(passage.rig, passage.pair.source, passage.pair.target, rig.skeleton, rig.weights)
        return pairing if len(pairing) else None


def _left(worn: WornItem) -> NDArray[np.bool_]:
    """Which vertices of an item are neither pushed nor lifted, (n,)."""
    if worn.left is None or worn.fit == "LEAVE":
        return np.full(worn.mesh.vertex_count, worn.fit == "LEAVE")
    return worn.left
