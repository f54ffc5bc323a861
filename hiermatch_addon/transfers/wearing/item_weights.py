# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of a fitted item: its own, or those of the skin below."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array, diags_array

from ....engine import Columns, put_in, row_sums

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence
    from collections.abc import Set as AbstractSet

    from numpy.typing import NDArray

    from ..options.wear import WearSettings

_ALIKE = 0.5
"""Part of an item's weights that has to be of bones that the other rig has as well, for them to be kept."""

_CLEAN = 0.001
"""Weights below this are dropped where they come from the skin."""

_ROUNDING = 1e-4
"""What a vertex may lack of a whole by rounding."""


@dataclass(frozen=True, eq=False)
class ItemWeights:
    """Weights of an item.

    Attributes
    ----------
    names : tuple of str
        Names of g groups.
    weights : (n, g) csr_array of float
        Their weights.
    locked : frozenset of str
        Which of them are locked.
    lost : tuple of str
        Groups of bones that the other rig lacks, which are to go.
    from_skin : bool
        Whether all of them, or all in bones that the other rig lacks, come from the skin or from paired bones.
    """

    names: tuple[str, ...]
    weights: csr_array
    locked: frozenset[str] = frozenset()
    lost: tuple[str, ...] = ()
    from_skin: bool = False


def chosen_weights(
    own: ItemWeights,
    bones: Sequence[str],
    on_skin: csr_array,
    old_bones: AbstractSet[str],
    settings: WearSettings,
    *,
    handed: bool = False,
) -> ItemWeights:
    """Choose the weights of an item in the bones of another rig.

    Its own are kept in bones that the rig has.  What a vertex has in others, or all of it if most are others, it gets
    from the skin.

    Parameters
    ----------
    own : ItemWeights
        All groups of the item.
    bones : sequence of str
        Names of the b bones of the rig.
    on_skin : (n, b) csr_array of float
        The weights of the skin below.
    old_bones : set of str
        Names of the bones of the rig that the item came with.
    settings : WearSettings
        Which are wanted, limit, and normalising.
    handed : bool
        The weights of the skin stand for its own in other bones, see `handed_weights`, so that those that it has in
        bones of the rig are kept in any case.
    """
    known = set(bones)
    kept = [name for name in own.names if name in known]
    lost = [name for name in own.names if name in old_bones and name not in known]
    mine, gone = in_columns(own, kept), in_columns(own, lost)
    has, lacks = row_sums(mine), row_sums(gone)
    if settings.weights == "OWN":
        return within_limit(ItemWeights(tuple(kept), mine, own.locked), kept, settings)
    whole = has + lacks
    share = has.sum() / whole.sum() if whole.sum() > 0 else 0.0
    from_skin = settings.weights == "SKIN" or (share < _ALIKE and not handed)
    missing = np.ones(len(has)) if from_skin else np.where(whole > 0, lacks / np.where(whole > 0, whole, 1), 1.0)
    if not (missing > _ROUNDING).any() and not settings.limit:
        return ItemWeights(tuple(kept), mine, own.locked)
    names = tuple(dict.fromkeys([*kept, *bones]))
    skin = in_columns(ItemWeights(tuple(bones), on_skin), names)
    before = in_columns(own, names)
    scale = np.zeros(len(has)) if from_skin else 1 / np.where(whole > 0, whole, 1)
    wanted = csr_array(diags_array(scale) @ before + diags_array(missing) @ skin)
    locked = np.array([name in own.locked for name in names])
    every = np.ones(len(names), bool)
    columns = Columns(locked, every, every)
    mixed = put_in(before, wanted, columns, threshold=_CLEAN, limit=settings.limit, normalise=settings.normalise)
    used = [number for number, name in enumerate(names) if name in kept or mixed[:, [number]].nnz]
    gone_names = tuple(name for name in lost if name not in own.locked)
    return ItemWeights(
        tuple(names[number] for number in used), csr_array(mixed[:, used]), own.locked, gone_names, from_skin or handed
    )


def within_limit(weights: ItemWeights, bones: Collection[str], settings: WearSettings) -> ItemWeights:
    """Let no vertex have weights in more of some bones than is wanted, and let them sum to one if that is."""
    if not settings.limit:
        return weights
    locked, shared = (np.array([name in some for name in weights.names], bool) for some in (weights.locked, bones))
    columns = Columns(locked, np.ones(len(weights.names), bool), shared)
    own = weights.weights
    return replace(weights, weights=put_in(own, own, columns, limit=settings.limit, normalise=settings.normalise))


def in_columns(weights: ItemWeights, names: Sequence[str]) -> csr_array:
    """Return the weights in groups of these names, (n, k); those that are not there are zero."""
    found = [(weights.names.index(name), number) for number, name in enumerate(names) if name in weights.names]
    placing = csr_array(
        (np.ones(len(found)), ([one for one, _ in found], [number for _, number in found])),
        shape=(len(weights.names), len(names)),
    )
    return csr_array(weights.weights @ placing)


def replaced(weights: ItemWeights, names: Sequence[str], mended: csr_array, changed: NDArray[np.bool_]) -> ItemWeights:
    """Put mended weights (n, b) of bones of these names in where vertices changed, unless a group is locked."""
    if not changed.any() or any(name in weights.locked for name in weights.names):
        return weights
    both = tuple(dict.fromkeys([*weights.names, *names]))
    old, new = in_columns(weights, both), in_columns(ItemWeights(tuple(names), mended), both)
    keep, take = diags_array((~changed).astype(float)), diags_array(changed.astype(float))
    others = [number for number, name in enumerate(both) if name not in names]
    result = csr_array(keep @ old + take @ new)
    if others:
        rest = np.isin(np.arange(len(both)), others).astype(float)
        result = csr_array(result + take @ (old @ diags_array(rest)))
    used = [number for number, name in enumerate(both) if name in weights.names or result[:, [number]].nnz]
    return replace(weights, names=tuple(both[number] for number in used), weights=csr_array(result[:, used]))
