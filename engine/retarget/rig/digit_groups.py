# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones that several digits hang on: hands, feet, paws; and those of a target whose digits are missing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ...mesh.closest_points import FoundPoints
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats, Ints
from .skeleton import Skeleton

_LEAST_CHAINS = 3
"""Digits from which on they can be mistaken."""

_MOST_AREA = 0.15
"""Largest part of the body's area that a hand has: legs around a trunk are no digits."""

_LEAST_COVERED = 0.6
"""Least area that digits of the target have, against that of the palm, both as parts of what the body's have: whole
ones have nine tenths, those of a fist that has grown together seven."""


@dataclass(frozen=True)
class DigitGroup:
    """A bone with several digits, each a chain of bones.

    Attributes
    ----------
    above : int
        The bone that it hangs on.
    hub : int
        The bone of the palm.
    chains : tuple of tuple of int
        The bones of each digit, from the palm outwards.
    """

    above: int
    hub: int
    chains: tuple[tuple[int, ...], ...]

    @property
    def bones(self) -> Ints:
        """The palm and all digits."""
        return np.array([self.hub, *(bone for chain in self.chains for bone in chain)])


def digit_groups(skeleton: Skeleton, mass: Floats) -> list[DigitGroup]:
    """Find the hands of a skeleton.

    Parameters
    ----------
    skeleton : Skeleton
        The bones, b.
    mass : (b,) array of float
        Area that each moves, as a part of the body's.
    """
    groups = []
    for hub in range(len(skeleton)):
        chains = []
        for first in skeleton.children(hub):
            chain = [int(first)]
            while len(skeleton.children(chain[-1])) == 1:
                chain.append(int(skeleton.children(chain[-1])[0]))
            if len(chain) > 1 and not len(skeleton.children(chain[-1])) and all(mass[bone] > 0 for bone in chain):
                chains.append(tuple(chain))
        above = int(skeleton.parents[hub])
        group = DigitGroup(above, hub, tuple(chains))
        alone = above >= 0 and mass[above] > 0 and mass[hub] > 0
        if len(chains) >= _LEAST_CHAINS and alone and mass[group.bones].sum() < _MOST_AREA:
            groups.append(group)
    return groups


def stunted_digits(
    body: TriangleMesh, weights: csr_array, skeleton: Skeleton, target: TriangleMesh, matches: FoundPoints
) -> list[DigitGroup]:
    """Find the hands that the target has no whole digits for: they are missing, or have grown together.

    Parameters
    ----------
    body : TriangleMesh
        The body at rest, n vertices.
    weights : (n, b) csr_array of float
        How the bones move it.
    skeleton : Skeleton
        The bones.
    target : TriangleMesh
        The target, m vertices.
    matches : FoundPoints
        For each vertex of the target the closest point of the body in its pose, m.

    Returns
    -------
    list of DigitGroup
        These hands.
    """
    mass = body.vertex_areas / body.area @ weights
    corners = body.triangles[matches.triangles].ravel()
    shares = (matches.barycentric * (target.vertex_areas / target.area)[:, None]).ravel()
    covered = np.bincount(corners, shares, body.vertex_count) @ weights
    return [group for group in digit_groups(skeleton, mass) if _bare(group, covered, mass)]


def _bare(group: DigitGroup, covered: Floats, mass: Floats) -> bool:
    """Say whether too little of a hand's digits is covered, against how much of its palm is."""
    palm, digits = group.bones[0], group.bones[1:]
    return bool(covered[digits].sum() * mass[palm] < _LEAST_COVERED * covered[palm] * mass[digits].sum())


def with_stiff_digits(weights: csr_array, groups: list[DigitGroup]) -> csr_array:
    """Let the palm move all that the digits of some hands move, so that digits keep to it as at rest.

    Parameters
    ----------
    weights : (n, b) csr_array of float
        How the bones move a body.
    groups : list of DigitGroup
        The hands.

    Returns
    -------
    (n, b) csr_array of float
        Weights in which these digits have none.
    """
    leaders = np.arange(weights.shape[1])
    for group in groups:
        leaders[group.bones] = group.hub
    count = len(leaders)
    return csr_array(weights @ csr_array((np.ones(count), (np.arange(count), leaders)), shape=(count, count)))
