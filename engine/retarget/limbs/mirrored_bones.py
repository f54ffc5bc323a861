# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of a rig that are mirror images of each other, by their joints, and rotations evened out between them."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.procrustes import nearest_rotations
from ...runtime.arrays import Floats, Ints
from ..rig.skeleton import Skeleton

_NEAR = 0.03
"""How far a joint may be from the mirror image of its partner, in units of the rig's largest extent."""

_SURE = 1e-4
"""Squared angle below which a rotation is as good as none: 0.6 degrees."""

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


def evened_rotations(
    rotations: Floats,
    pairs: tuple[Ints, Ints],
    trees: tuple[Skeleton, Skeleton],
    mirrors: tuple[Ints, Ints],
    whole: Floats,
) -> Floats:
    """Make rotations of pairs of bones mirror images of those of the same pairs on the other side.

    The map of a foot may be turned halfway round, and hardly ever that of the other as well.  So each side counts by
    the inverse square of how far it is turned against the body as a whole.

    Parameters
    ----------
    rotations : (k, 3, 3) array of float
        How the target's surface around the bones is turned against the source's.
    pairs : pair of (k,) arrays of int
        Bones of the source and of the target.
    trees : pair of Skeleton
        Their rigs at rest.
    mirrors : pair of arrays of int
        What is on the other side of each bone, in either rig: see `mirrored_bones`.
    whole : (3, 3) array of float
        How the body as a whole is turned.

    Returns
    -------
    (k, 3, 3) array of float
        Those of pairs that have one on the other side, in two symmetric rigs, are images of each other.
    """
    rows = {(int(a), int(b)): row for row, (a, b) in enumerate(zip(*pairs, strict=True))}
    images = np.array([rows.get((mirrors[0][a], mirrors[1][b]), -1) for a, b in rows], np.int64)
    known = np.flatnonzero(images >= 0)
    flips = [_flip(tree, mirror) for tree, mirror in zip(trees, mirrors, strict=True)]
    both = np.stack([rotations[known], flips[1] @ rotations[images[known]] @ flips[0]])
    away = 3 - np.einsum("skij,ij->sk", both, whole) + _SURE
    result = rotations.copy()
    result[known] = nearest_rotations((both / away[:, :, None, None]).sum(axis=0))
    return result


def _flip(tree: Skeleton, mirror: Ints) -> Floats:
    """Find the reflection (3, 3) that takes bones to those on the other side."""
    known = mirror >= 0
    between = tree.heads[known] - tree.heads[mirror[known]]
    normal = np.linalg.svd(between, full_matrices=False)[2][0] if known.any() else np.zeros(3)
    return np.eye(3) - 2 * np.outer(normal, normal)


def _images(places: Floats, normal: Floats, reach: float) -> Ints:
    """Find the bones, of two places each (2, b, 3), that lie where others are in a mirror: the middle is in it."""
    levels = places @ normal
    flipped = places - 2 * (levels - np.median(levels[0]))[..., None] * normal
    own, image = (np.concatenate(list(each), axis=1) for each in (places, flipped))
    away, nearest = cKDTree(own).query(image)
    known = (away < reach) & (nearest[nearest] == np.arange(len(nearest)))
    return np.where(known, nearest, -1)
