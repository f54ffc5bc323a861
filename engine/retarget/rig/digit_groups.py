# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones that several digits hang on: hands, feet, paws."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...runtime.arrays import Floats, Ints
from .skeleton import Skeleton

_LEAST_CHAINS = 3
"""Digits from which on they can be mistaken."""

_MOST_AREA = 0.15
"""Largest part of the body's area that a hand has: legs around a trunk are no digits."""


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
