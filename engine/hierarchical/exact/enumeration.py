# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth-first enumeration of the matchings of a pair model, in batches."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...runtime.arrays import Bools, Floats, Ints
from .dual_ascent import PairModel
from .exclusion import exclusion_surcharge

_BATCH = 200_000  # numbers in the tables of a batch of nodes: some milliseconds of work


class _Block(NamedTuple):
    """Nodes of equal depth, w of them: partial matchings."""

    bound: Floats  # (w,) no matching below the node costs less
    spent: Floats  # (w,) cost of the points matched
    unary: Floats  # (w, k, K) cost of each label beside the points matched; meaningless in matched rows
    lowest: Floats  # (w, k) its minimum over labels; zero in matched rows
    matched: Bools  # (w, k)
    chosen: Ints  # (w, k) label, where matched
    needed: Ints  # (w, e) points that each exclusion still needs

    def take(self, nodes: NDArray[np.intp] | slice) -> _Block:
        """Return some of the nodes."""
        return _Block._make(array[nodes] for array in self)


class Enumeration:
    """Visits all matchings of a pair model that cost less than a limit.

    Each node is bounded by its cost plus the cheapest label of each open point, beside the points already matched;
    the point with the fewest labels below the limit is matched next.

    Parameters
    ----------
    model : PairModel
        The model, of at least one point, best after dual ascent and `PairModel.compact`.

    Attributes
    ----------
    nodes : int
        Nodes made so far.
    """

    def __init__(self, model: PairModel) -> None:
        self.nodes = 0
        self._model = model
        k, width = model.unary.shape
        self._beside = model.pair.reshape(k * width, k, width)
        self._batch = max(8, _BATCH // (k * width * 4))
        lowest = model.unary.min(axis=1)
        root = _Block(
            bound=np.array([model.constant + lowest.sum()]),
            spent=np.array([model.constant]),
            unary=model.unary[None],
            lowest=lowest[None],
            matched=np.zeros((1, k), dtype=bool),
            chosen=np.zeros((1, k), dtype=np.int64),
            needed=model.needed[None],
        )
        self._stack = [root]

    @property
    def bound(self) -> float:
        """No matching that has not been visited costs less; inf when all have been."""
        return min((float(block.bound.min()) for block in self._stack), default=np.inf)

    @property
    def finished(self) -> bool:
        """Whether nothing is left to visit."""
        return not self._stack

    def step(self, limit: float) -> tuple[Floats, Ints]:
        """Branch the most promising nodes of the deepest block.

        Returns
        -------
        bounds : (w,) array of float
            Lower bounds, below `limit`, of the cost of the matchings that were completed, ascending.
        matchings : (w, k) array of int
            Their candidates.
        """
        block = self._stack.pop()
        if len(block.bound) > self._batch:
            self._stack.append(block.take(slice(self._batch, None)))
            block = block.take(slice(self._batch))
        open_nodes = np.flatnonzero(block.bound < limit)
        if len(open_nodes) < len(block.bound):
            block = block.take(open_nodes)
        children = self._branch(block, limit)
        if not len(children.bound):
            return children.bound, children.chosen
        if children.matched[0].all():
            return children.bound, self._model.labels[np.arange(children.chosen.shape[1]), children.chosen]
        self._stack.append(children)
        return np.zeros(0), np.zeros((0, children.chosen.shape[1]), dtype=np.int64)

    def _branch(self, block: _Block, limit: float) -> _Block:
        """Match one more point in each node; the children below the limit, most promising first."""
        slack = limit - block.spent - block.lowest.sum(axis=1)
        live = block.unary - block.lowest[:, :, None] < slack[:, None, None]
        choices = np.where(block.matched, live.shape[2] + 1, live.sum(axis=2))
        row = choices.argmin(axis=1)
        parent, label = np.nonzero(live[np.arange(len(row)), row])
        row = row[parent]
        self.nodes += len(parent)
        child = np.arange(len(parent))
        spent = block.spent[parent] + block.unary[parent, row, label]
        matched = block.matched[parent]
        matched[child, row] = True
        # Rows already matched take the charge too, but are never read again: each pair is charged exactly once.
        unary = block.unary[parent]
        unary += self._beside[row * live.shape[2] + label]
        lowest = unary.min(axis=2)
        lowest[matched] = 0
        bound = spent + lowest.sum(axis=1)
        needed = block.needed[parent] - self._model.moved[:, row, label].T
        for e, moved in enumerate(self._model.moved):
            multiplier = float(self._model.multipliers[e])
            extra = exclusion_surcharge(
                unary, ~matched, moved, needed[:, e], multiplier=multiplier, cap=self._model.cap
            )
            bound = np.maximum(bound, spent + lowest.sum(axis=1) + extra)
        kept = np.flatnonzero(bound < limit)
        kept = kept[np.argsort(bound[kept], kind="stable")]
        chosen = block.chosen[parent[kept]]
        chosen[np.arange(len(kept)), row[kept]] = label[kept]
        return _Block(bound[kept], spent[kept], unary[kept], lowest[kept], matched[kept], chosen, needed[kept])
