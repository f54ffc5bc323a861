# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of a rig that are mirror images of each other: left and right, told by the joints."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...runtime.arrays import Floats, Ints
from ..rig.skeleton import Skeleton

_NEAR = 0.03
"""How far a joint may be from the mirror image of its partner, in units of the rig's largest extent."""

_MOST = 0.4
"""Part of the bones that must have a partner for a rig to be taken for a symmetric one: of an avatar whose fingers are
built unlike on both sides 53 % have one, arms and legs among them."""


def mirrored_bones(tree: Skeleton) -> Ints:
    """Find for each bone the one on the other side.

    Parameters
    ----------
    tree : Skeleton
        The bones at rest, b.

    Returns
    -------
    (b,) array of int
        The partner: the bone itself in the middle, -1 where there is none, and everywhere if the rig is not symmetric.
    """
    none = np.full(len(tree), -1)
    if len(tree) < 2:
        return none
    centered = tree.heads - tree.heads.mean(axis=0)
    extent = np.ptp(tree.heads, axis=0).max()
    below = np.array([tree.heads[hanging].mean(axis=0) for hanging in tree.hanging])
    best = none
    for normal in np.concatenate([np.eye(3), np.linalg.svd(centered, full_matrices=False)[2]]):
        found = _images(np.stack([tree.heads, below]), normal, _NEAR * extent)
        above = np.where(tree.parents >= 0, found[tree.parents], -1)
        found = np.where(tree.parents[found] == above, found, -1)  # and hang on what is on the other side as well
        pairs = (found >= 0) & (found != np.arange(len(tree)))
        if pairs.any() and (found >= 0).sum() > max(_MOST * len(tree), (best >= 0).sum()):
            best = found
    return best


def _images(places: Floats, normal: Floats, reach: float) -> Ints:
    """Find the bones, of two places each (2, b, 3), that lie where others are in a mirror: the middle is in it."""
    levels = places @ normal
    flipped = places - 2 * (levels - np.median(levels[0]))[..., None] * normal
    own, image = (np.concatenate(list(each), axis=1) for each in (places, flipped))
    away, nearest = cKDTree(own).query(image)
    known = (away < reach) & (nearest[nearest] == np.arange(len(nearest)))
    return np.where(known, nearest, -1)
