# SPDX-License-Identifier: GPL-3.0-or-later
"""The best few of many candidates that all differ from one another."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from itertools import chain
from typing import TypeVar

Item = TypeVar("Item")


def best_distinct(
    ranked: Iterable[Item],
    differ: Callable[[Item, Item], bool],
    most: int | None = None,
    *,
    beside: Collection[Item] = (),
) -> list[Item]:
    """Choose greedily the best candidates each of which differs from all better ones that were chosen.

    Parameters
    ----------
    ranked : iterable
        The candidates, the best first; no more of it is read than is needed.
    differ : callable
        Tells of two of them, the later one first, whether they differ.
    most : int, optional
        How many are chosen at most.
    beside : collection
        What they must differ from as well.

    Returns
    -------
    list
        In the same order.
    """
    chosen: list[Item] = []
    for item in ranked:
        if len(chosen) == most:
            break
        if all(differ(item, other) for other in chain(beside, chosen)):
            chosen.append(item)
    return chosen
