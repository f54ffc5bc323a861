# SPDX-License-Identifier: GPL-3.0-or-later
"""Items that were cut open at sharp edges or seams of UVs, as files for games are: fitted as one piece of cloth."""

from __future__ import annotations

from dataclasses import fields, replace

from scipy.sparse import csr_array

from ...mesh.connectivity.welded_parts import WeldedParts
from ...runtime.arrays import Ints
from .worn_item import FittedItem, WornItem


def sewn(item: WornItem) -> tuple[WornItem, Ints | None]:
    """Close the seams of an item.

    Parameters
    ----------
    item : WornItem
        The item, n vertices.

    Returns
    -------
    item : WornItem
        The same of w vertices.
    welded : (n,) array of int or None
        Which of them each vertex is; none if there are no seams.
    """
    parts = WeldedParts.of(item.mesh)
    if not parts.seams:
        return item, None
    mean, first = parts.means, parts.first
    return (
        replace(
            item,
            mesh=parts.closed,
            bones=None if item.bones is None else csr_array(mean @ item.bones),
            rigid=None if item.rigid is None else item.rigid[first],
            pieces=None if item.pieces is None else item.pieces[first],
            tightness=None if item.tightness is None else mean @ item.tightness,
            left=None if item.left is None else item.left[first],
        ),
        parts.welded,
    )


def cut_open(fitted: FittedItem, welded: Ints | None) -> FittedItem:
    """Open the seams of a fitted item again, see `sewn`."""
    if welded is None:
        return fitted
    of_vertices = (one.name for one in fields(fitted) if one.name != "through")
    return replace(fitted, **{name: getattr(fitted, name)[welded] for name in of_vertices})
