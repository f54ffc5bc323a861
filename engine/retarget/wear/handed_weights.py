# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of clothes for a rig with other bones: the skin's, as far as they were those of the skin before."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array

from ...runtime.arrays import Floats
from ...runtime.errors import RigError
from ..motion.bone_pairing import BonePairing
from ..motion.paired_weights import paired_weights
from ..rig.skeleton import Skeleton
from ..weights.skin_weights import row_shares, row_sums


def handed_weights(
    own: csr_array,
    below: csr_array,
    on_skin: csr_array,
    positions: Floats,
    *,
    pairing: BonePairing,
    bones: tuple[Skeleton, Skeleton],
) -> csr_array:
    """Give an item weights of another rig's bones.

    Where it was weighted as the skin below it, as a jacket is, it gets the weights of the other skin.  Where it was
    not, as a shoe that moves with the foot alone, its own weights go to the bones that are paired with its bones; what
    lies between gets a part of either.

    Parameters
    ----------
    own : (n, a) csr_array of float
        Its weights for the bones that it came with; rows need not sum to one, or are empty.
    below : (n, a) csr_array of float
        Those of the skin that it lay on.
    on_skin : (n, b) csr_array of float
        Those of the skin that it lies on now, for the other bones.
    positions : (n, 3) array of float
        Where it lies now.
    pairing : BonePairing
        The pairs of bones.
    bones : (Skeleton, Skeleton)
        The bones it came with, a, and the others, b.

    Returns
    -------
    (n, b) csr_array of float
        The weights; rows sum to one, or are empty where all are.

    Raises
    ------
    RigError
        If the arrays do not fit together, or nothing is paired.
    """
    if not (own.shape == below.shape and on_skin.shape == (len(positions), len(bones[1]))):
        raise RigError(f"Weights of the shapes {own.shape}, {below.shape} and {on_skin.shape} do not fit together.")
    own, below, on_skin = (row_shares(each) for each in (own, below, on_skin))
    handed = row_shares(paired_weights(own, positions, pairing, *bones))
    different = 0.5 * row_sums(abs(own - below))
    different = np.where(row_sums(below) > 0, different, 1.0)
    share = np.where(row_sums(handed) > 0, different, 0.0)
    share = np.where(row_sums(on_skin) > 0, share, 1.0)
    return csr_array(diags_array(share) @ handed + diags_array(1 - share) @ on_skin)
