# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of faces, such as their materials, carried from one mesh to another."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...mesh.polygons import Polygons
from ...runtime.arrays import Floats, Ints, group_sums
from ...runtime.errors import MatchError
from .face_correspondence import FacePlaces, FaceSamples


def carry_face_values(values: ArrayLike, source: Polygons, places: FacePlaces) -> NDArray[Any]:
    """Carry a value of each face of the source to the faces of the target.

    Parameters
    ----------
    values : (f_x, ...) array_like
        For each face of the source, a number, a vector, or anything else.
    source : Polygons
        Faces of the source, cut as the image of `places` is.
    places : FacePlaces
        Where the faces of the target lie on the source.

    Returns
    -------
    (f_y, ...) array
        For each face of the target: the mean over its samples if the values are real numbers; else, because they
        number or name something, that which most of its samples have.

    Raises
    ------
    MatchError
        If there is not one value for each face.
    """
    array = np.asarray(values)
    if array.ndim == 0 or len(array) != source.face_count:
        raise MatchError(f"There should be one value for each of {source.face_count} faces, not {array.shape}.")
    samples = places.samples
    under = source.triangle_faces[samples.triangles]
    if np.issubdtype(array.dtype, np.inexact):
        return _means(array[under].astype(np.float64), samples, places.polygons.face_count)
    _, first, code = np.unique(array.reshape(len(array), -1), axis=0, return_index=True, return_inverse=True)
    chosen = majority(code.ravel()[under], samples.faces, samples.weights, places.polygons.face_count)
    return array[first[chosen]]


def majority(codes: Ints, owners: Ints, weights: Floats, count: int) -> Ints:
    """Find the code that weighs most among those of each owner.

    Parameters
    ----------
    codes, owners : (s,) array of int
        A code, from zero up, and whose it is.
    weights : (s,) array of float
        How much it counts.
    count : int
        Number of owners; each should have a code.

    Returns
    -------
    (count,) array of int
        For each owner its code; of several with the same weight the smallest.
    """
    span = int(codes.max(initial=0)) + 1
    pairs, inverse = np.unique(owners * span + codes, return_inverse=True)
    total = np.bincount(inverse.ravel(), weights, len(pairs))
    owner, code = np.divmod(pairs, span)
    order = np.lexsort((code, -total, owner))
    chosen = np.zeros(count, np.int64)
    chosen[owner[order][::-1]] = code[order][::-1]
    return chosen


def _means(values: Floats, samples: FaceSamples, count: int) -> Floats:
    """Mean of values (s, ...) at samples over each face, (count, ...)."""
    total = np.bincount(samples.faces, samples.weights, count)
    sums = group_sums(samples.faces, samples.weights[:, None] * values.reshape(len(values), -1), count)
    return (sums / total[:, None]).reshape(count, *values.shape[1:])
