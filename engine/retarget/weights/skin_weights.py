# SPDX-License-Identifier: GPL-3.0-or-later
"""Skin weights as sparse matrices, a row for each vertex and a column for each bone: carried, mixed, limited, scaled.

Some columns may be locked: they keep what they have, and the others share what is left.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack

from ...mesh.surface_map import SurfaceMap
from ...runtime.arrays import Bools, Floats, Ints, group_largest
from ...runtime.errors import MatchError, RigError

_STEEPNESS = 4
"""How steeply weights fade that come close to the first one that is cut off."""


def carried(weights: csr_array, surface_map: SurfaceMap) -> csr_array:
    """Carry weights across a map, interpolated inside triangles.

    Parameters
    ----------
    weights : (n, g) csr_array of float
        Weights at the vertices of the map's image.
    surface_map : SurfaceMap
        Map of m vertices to that image.

    Returns
    -------
    (m, g) csr_array of float
        Weights at the vertices of the map's domain.

    Raises
    ------
    MatchError
        If there is not one row for each vertex of the image.
    """
    if weights.shape[0] != surface_map.image_vertex_count:
        raise MatchError(
            f"There should be weights for each of the {surface_map.image_vertex_count} vertices that the map leads "
            f"to, but there are {weights.shape[0]} rows."
        )
    return _clean(csr_array(surface_map.interpolation @ weights))


def mixed(
    before: csr_array, new: csr_array, factor: float = 1.0, *, add: bool = False, locked: Bools | None = None
) -> csr_array:
    """Mix new weights into those that were there.

    Parameters
    ----------
    before, new : (m, g) csr_array of float
        The weights.
    factor : float
        How much the new ones count, 0 to 1.
    add : bool
        Whether they are added to those that were there, up to 1, and do not replace them.
    locked : (g,) array of bool, optional
        Columns that stay as they were.

    Returns
    -------
    (m, g) csr_array of float
        The mixture.

    Raises
    ------
    RigError
        If the two are not of the same vertices and bones, or the factor is not from 0 to 1.
    """
    if before.shape != new.shape:
        raise RigError(f"Weights of the shapes {before.shape} and {new.shape} cannot be mixed.")
    if not 0 <= factor <= 1:
        raise RigError("How much new weights count should be a number from 0 to 1.")
    free = _free(locked, before.shape[1])
    added = new @ diags_array(factor * free)
    if add:
        mixture = csr_array(before + added)
        mixture.data = np.minimum(mixture.data, 1)
        return _clean(mixture)
    return _clean(csr_array(before @ diags_array(1 - factor * free) + added))


def limited(weights: csr_array, count: int, *, locked: Bools | None = None) -> csr_array:
    r"""Leave each vertex its largest weights only.

    Parameters
    ----------
    weights : (m, g) csr_array of float
        The weights, not negative.
    count : int
        How many a vertex may have.
    locked : (g,) array of bool, optional
        Columns that stay as they are, but count.

    Returns
    -------
    (m, g) csr_array of float
        The same with at most so many entries in each row, unless more are locked.  Sums of rows stay what they were,
        except where nothing but locked ones is left.

    Notes
    -----
    If t is the largest weight of a vertex that has to go, a weight w that stays becomes
    :math:`w (1 - (t / w)^4)`, and all that stay are scaled to the old sum.  So a weight vanishes steadily as it becomes
    the one to go, and neighbours that differ a little in their weights do so afterwards as well.  Weights that
    are as large as the first that goes are shared out evenly if there are no others.
    """
    result, rows, is_free = _entries(weights, locked)
    room = np.maximum(count - np.bincount(rows[~is_free], minlength=result.shape[0]), 0)
    entries = np.flatnonzero(is_free)
    crowded = np.bincount(rows[entries], minlength=result.shape[0]) > room
    entries = entries[crowded[rows[entries]]]
    if not len(entries):
        return result
    # Largest first in each row; among equal ones the first column, so that the answer is always the same.
    entries = entries[np.lexsort((result.indices[entries], -result.data[entries], rows[entries]))]
    row, value = rows[entries], result.data[entries]
    starts = np.flatnonzero(np.append(True, row[1:] != row[:-1]))
    lengths = np.diff(np.append(starts, len(row)))
    kept = (np.arange(len(row)) - np.repeat(starts, lengths)) < room[row]
    first_out = np.repeat(value[starts + room[row[starts]]], lengths)
    faded = np.where(kept, value * (1 - (first_out / value) ** _STEEPNESS), 0.0)
    flat = np.repeat(np.add.reduceat(faded, starts) <= 0, lengths)
    faded = np.where(flat & kept, value, faded)
    sums_before, sums = (np.repeat(np.add.reduceat(part, starts), lengths) for part in (value, faded))
    result.data[entries] = np.divide(faded * sums_before, sums, out=np.zeros_like(faded), where=sums > 0)
    return _clean(result)


def pruned(weights: csr_array, threshold: float, *, locked: Bools | None = None) -> csr_array:
    """Remove tiny weights.

    Parameters
    ----------
    weights : (m, g) csr_array of float
        The weights.
    threshold : float
        Weights below it go; but the largest of a vertex stays, so that none loses all.
    locked : (g,) array of bool, optional
        Columns that stay as they are.

    Returns
    -------
    (m, g) csr_array of float
        The others, unchanged.
    """
    result, rows, is_free = _entries(weights, locked)
    largest = group_largest(rows, result.data, result.shape[0])
    result.data[(result.data < threshold) & (result.data < largest[rows]) & is_free] = 0
    return _clean(result)


def normalised(weights: csr_array, *, locked: Bools | None = None) -> csr_array:
    """Scale the weights of each vertex so that they sum to one.

    Parameters
    ----------
    weights : (m, g) csr_array of float
        The weights, not negative.
    locked : (g,) array of bool, optional
        Columns that keep their weights; the others share what these leave.

    Returns
    -------
    (m, g) csr_array of float
        The weights.  A vertex that has none, or none but locked ones, stays as it is.
    """
    result, rows, is_free = _entries(weights, locked)
    taken = np.bincount(rows[~is_free], result.data[~is_free], result.shape[0])
    given = np.bincount(rows[is_free], result.data[is_free], result.shape[0])
    room = np.maximum(1 - taken, 0)
    factors = np.divide(room, given, out=np.zeros(len(room)), where=given > 0)
    result.data = np.where(is_free, result.data * factors[rows], result.data)
    return _clean(result)


def row_sums(weights: csr_array) -> Floats:
    """Sum the weights of each vertex, (m,)."""
    sums = np.bincount(_rows(weights), weights.data, weights.shape[0])
    return sums.astype(np.float64)  # without entries there are whole numbers


def row_shares(weights: csr_array) -> csr_array:
    """Divide each row by its sum, where there is one: each then sums to one."""
    sums, shares = row_sums(weights), weights.copy()
    shares.data = shares.data * np.repeat(1 / np.where(sums > 0, sums, 1), np.diff(shares.indptr))
    return shares


def row_differences(one: csr_array, other: csr_array) -> Floats:
    """Sum the differences of the weights of each vertex, (m,): 0 if they are the same, 2 if they share no bone."""
    return row_sums(csr_array(abs(one - other)))


def with_rows(weights: csr_array, rows: Ints, new: csr_array) -> csr_array:
    """Replace rows (k,) of weights (m, g) by new ones (k, g)."""
    if not len(rows):
        return weights
    order = np.arange(weights.shape[0])
    order[rows] = weights.shape[0] + np.arange(len(rows))
    return csr_array(vstack([weights, new], format="csr")[order])


def _rows(weights: csr_array) -> Ints:
    """Row of each entry."""
    return np.repeat(np.arange(weights.shape[0]), np.diff(weights.indptr))


def _entries(weights: csr_array, locked: Bools | None) -> tuple[csr_array, Ints, Bools]:
    """Copy weights (m, g), and say of each entry in which row it is, (k,), and whether it is not locked, (k,)."""
    result = _clean(weights.copy())
    return result, _rows(result), _free(locked, result.shape[1])[result.indices]


def _free(locked: Bools | None, count: int) -> Bools:
    """Say of each column (g,) whether it is not locked."""
    if locked is None:
        return np.ones(count, bool)
    if np.shape(locked) != (count,):
        raise RigError(f"It should be said of each of {count} columns whether it is locked, not of {np.shape(locked)}.")
    return ~np.asarray(locked, bool)


def _clean(weights: csr_array) -> csr_array:
    """Put the entries in order and drop zeros."""
    weights.sum_duplicates()
    weights.eliminate_zeros()
    return weights
