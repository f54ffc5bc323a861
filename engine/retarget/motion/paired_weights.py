# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of one skeleton as weights of another whose bones are paired with it."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array

from ...runtime.arrays import TINY, Floats, Ints, distances_from_segments, eased, lengths_along, shares_along
from ...runtime.errors import RigError
from ..rig.skeleton import Skeleton
from ..weights.skin_weights import row_shares, row_sums
from .bone_pairing import BonePairing
from .segments import Segments

_WIDTH = 1.0
"""Over what part of the shorter of two bones weights go over from one to the other at the joint between them."""


def paired_weights(
    weights: csr_array,
    vertices: Floats,
    pairing: BonePairing,
    source_bones: Skeleton,
    bones: Skeleton,
) -> csr_array:
    """Hand the weights of a source's bones to those of a target's that stand for them.

    Where several bones of the target stand for one or more of the source, the vertices are shared out along the chain
    by where they lie; where one stands for several, it gets their sum.  What a bone without a partner moves goes to
    the nearest one above it that has one, or else to the nearest below.

    Parameters
    ----------
    weights : (n, a) csr_array of float
        Weights of the source's bones at the target's vertices, carried across the map.
    vertices : (n, 3) array of float
        Where these are, at rest.
    pairing : BonePairing
        The pairs.
    source_bones, bones : Skeleton
        The bones, a and b, either in its own space.

    Returns
    -------
    (n, b) csr_array of float
        Weights of the target's bones; vertices keep the sum of their weights.

    Raises
    ------
    RigError
        If nothing is paired, or the arrays do not fit together.
    """
    if weights.shape != (len(vertices), len(source_bones)):
        raise RigError(
            f"Weights of {len(vertices)} vertices and {len(source_bones)} bones are needed, but got {weights.shape}."
        )
    if not len(pairing):
        raise RigError("No bones of the two rigs are paired. Pair them first.")
    segments = Segments.of(pairing.sources, pairing.targets, source_bones, bones)
    owners = _owners(segments, source_bones)
    parts: list[tuple[Ints, Ints, Floats]] = []
    columns = weights.tocsc()
    for members, chain in segments.chains(pairing.sources, pairing.places, bones):
        own = np.flatnonzero(np.isin(owners, members))
        moved = columns[:, own].sum(axis=1)
        rows = np.flatnonzero(moved > 0)
        shares = _along(vertices[rows], chain, bones) if len(chain) > 1 else np.ones((len(rows), 1))
        for number, bone in enumerate(chain):
            parts.append((rows, np.full(len(rows), bone), moved[rows] * shares[:, number]))
    rows, places, values = (np.concatenate(each) for each in zip(*parts, strict=True))
    handed = csr_array((values, (rows, places)), shape=(len(vertices), len(bones)))
    handed.eliminate_zeros()
    return csr_array(diags_array(row_sums(weights)) @ row_shares(handed))


def _owners(segments: Segments, tree: Skeleton) -> Ints:
    """For each bone of the source (a,) the segment that gets what it moves; -1 if there is none above nor below."""
    owners = np.full(len(tree), -1)
    for part, members in enumerate(segments.sources):
        owners[members] = part
    for bone in tree.order:
        if owners[bone] < 0 and tree.parents[bone] >= 0:
            owners[bone] = owners[tree.parents[bone]]
    for bone in tree.order[::-1]:  # a root without a partner: its first child has the next best one
        parent = tree.parents[bone]
        if parent >= 0 and owners[parent] < 0:
            owners[parent] = owners[bone]
    return owners


def _along(points: Floats, chain: Ints, bones: Skeleton) -> Floats:
    """Share points (n, 3) out along a chain of bones (c,): they go over smoothly from one to the next, (n, c)."""
    joints = np.concatenate([bones.heads[chain], bones.tails[chain[-1]][None]])
    steps, starts = np.diff(joints, axis=0), lengths_along(joints)
    lengths = np.diff(starts)
    closest = distances_from_segments(points[:, None], joints[:-1], steps).argmin(axis=1)
    # The place along the whole chain, measured from its start; beyond its ends nothing goes over.
    place = starts[closest] + shares_along(points, joints[closest], steps[closest]) * lengths[closest]
    result = np.ones((len(points), len(chain)))
    for joint in range(1, len(chain)):
        width = max(_WIDTH * min(lengths[joint - 1], lengths[joint]), TINY)
        gone = eased((place - starts[joint]) / width + 0.5)
        result[:, :joint] *= (1 - gone)[:, None]
        result[:, joint:] *= gone[:, None]
    return result / result.sum(axis=1, keepdims=True)
