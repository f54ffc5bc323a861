# SPDX-License-Identifier: GPL-3.0-or-later
"""Plates of the source that a map skips: on a body in one piece they get the strip where their neighbors meet."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...mesh.connectivity.welded_parts import WeldedParts
from ...runtime.arrays import Bools, Floats, Ints

_BETWEEN = 0.5
"""A plate lies between two others if its gaps to both are together less than this part of the gap between these: what
is left of it is the plate itself.  In a row of plates of one length with gaps of a tenth of it, that is 0.17."""


def with_skipped_plates(plate: Ints, joint: Bools, parts: WeldedParts, source_parts: WeldedParts, rigid: Bools) -> Ints:
    """Put plates that nothing lies on where those on either side of them meet.

    Parameters
    ----------
    plate : (w,) array of int
        The plate that each welded vertex of a surface lies on.
    joint : (e,) array of bool
        Edges of the surface whose ends different plates move.
    parts : WeldedParts
        The surface.
    source_parts : WeldedParts
        The p plates.
    rigid : (p,) array of bool
        Which of them move as one; others are not put in.

    Returns
    -------
    (w,) array of int
        The plates with those that were skipped, in strips as wide as the gap that each of them fills.
    """
    skipped = np.flatnonzero(rigid & (np.bincount(plate, minlength=source_parts.part_count) == 0))
    pairs = np.unique(np.sort(plate[parts.edges[joint]], axis=1), axis=0)
    growth = np.sqrt(parts.mesh.area / source_parts.mesh.area)
    between, gap = _skipped_between(source_parts, skipped, pairs)
    result = plate.copy()
    for row in np.flatnonzero(between >= 0):
        result[_strip(parts, plate, pairs[row], joint, growth * gap[row])] = between[row]
    return result


def _skipped_between(source_parts: WeldedParts, skipped: Ints, pairs: Ints) -> tuple[Ints, Floats]:
    """Find which of the skipped plates (s,) lies between two, pairs (k, 2), or -1, and the gap of the two: (k,)."""
    mesh, labels = source_parts.mesh, source_parts.vertex_labels
    between, gap = np.full(len(pairs), -1), np.zeros(len(pairs))
    owners = np.flatnonzero(np.isin(labels, skipped))
    if not len(owners) or not len(pairs):
        return between, gap
    plates = {number: mesh.vertices[labels == number] for number in np.unique(pairs).tolist()}
    trees = {number: cKDTree(points) for number, points in plates.items()}
    for row, (one, other) in enumerate(pairs.tolist()):
        gap[row] = trees[one].query(plates[other])[0].min()
        away = np.zeros(source_parts.part_count)
        for number in (one, other):
            nearest = np.full(source_parts.part_count, np.inf)
            np.minimum.at(nearest, labels[owners], trees[number].query(mesh.vertices[owners])[0])
            away += nearest
        best = int(away.argmin())
        if away[best] < _BETWEEN * gap[row]:
            between[row] = best
    return between, gap


def _strip(parts: WeldedParts, plate: Ints, pair: Ints, joint: Bools, width: float) -> Bools:
    """Choose the strip (w,), of a width, in whose middle a pair of plates meets; of either at most the nearer half."""
    own = np.isin(plate, pair)
    within = own[parts.edges].all(axis=1)
    meets = joint & within & (plate[parts.edges[:, 0]] != plate[parts.edges[:, 1]])
    away = parts.distances(np.unique(parts.edges[meets]), usable=within)
    chosen = np.zeros(parts.welded_count, bool)
    for number in pair:
        side = (plate == number) & np.isfinite(away)
        chosen |= side & (away <= min(width, away[side].max(initial=0.0)) / 2)
    return chosen
