# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of clothes for another rig: those of the skin below, or where they had others before, the paired bones'."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array, diags_array

from ...mesh.surface_points import interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats
from ...runtime.background import can_go_beside
from ...runtime.errors import RigError
from ...runtime.progress import Progress, Steps
from ..motion.bone_pairing import BonePairing
from ..motion.paired_weights import paired_weights
from ..rig.skeleton import Skeleton
from ..weights.skin_weights import row_shares, row_sums
from .contact import Surface

_TIGHT = 0.012
"""Distance from the skin, in sqrt(area) of the body, up to which cloth moves as the skin just below it: 16 mm on a
human, up to which it is lifted for poses as well.  From twice as far on it moves as the skin that it hung over."""


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


@can_go_beside
def shares_below_steps(items: Sequence[tuple[Floats, csr_array]], body: TriangleMesh) -> Steps[list[csr_array]]:
    """Find the skin that moves items: what is just below where they are tight, what carried them where they hang.

    An item that holds its shape, or is pushed out, does not stay above the skin that a map says.  What lies on other
    skin has to move with that, or it comes through.

    Parameters
    ----------
    items : sequence of ((n, 3) array of float, (n, m) csr_array of float)
        Where the vertices of each lie, and the shares of the body's m vertices that carried them.
    body : TriangleMesh
        The body.

    Yields
    ------
    Progress
        Before each item.

    Returns
    -------
    list of (n, m) csr_array of float
        The shares of its vertices that move those of each item.
    """
    skin, reach = Surface(body), _TIGHT * float(np.sqrt(body.area))
    moving = []
    for number, (positions, carried) in enumerate(items):
        yield Progress(number / len(items), "Moving items along")
        below = skin.clearance(positions, np.asarray(carried.argmax(axis=1)).ravel())
        found = skin.search.nearest(below.feet)
        just_below = interpolation_matrix(found.barycentric, body.triangles[found.triangles], body.vertex_count)
        tight = (2 - np.abs(below.distances) / reach).clip(0, 1) * below.known
        moving.append(csr_array(diags_array(tight) @ just_below + diags_array(1 - tight) @ carried))
    return moving
