# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones: where their joints are, and which hangs on which."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...mesh.connectivity.edge_chains import way_to_root
from ...runtime.arrays import TINY, Bools, Floats, Ints
from ...runtime.errors import RigError

_BEYOND = 1.5
"""Lengths of bones in units of how far others hang on them at most, above which their tails say nothing.

In all rigs tried whose tails mean something it is 1; where they do not, it is 2 to 200 for most bones.
"""

_LAST = 0.5
"""Length of a bone on which nothing hangs, in units of the way to it, if its tail says nothing: about a foot's."""

_LEAST = 0.001
"""Length of a bone on which others hang where it begins, in units of the rig's extent: Blender deletes shorter ones."""


@dataclass(frozen=True, eq=False)
class Skeleton:
    """The bones of a rig at rest.

    Attributes
    ----------
    parents : (b,) array of int
        Parent of each bone, -1 for one without.
    heads, tails : (b, 3) array of float
        Its two ends, in the space and units of the mesh that it moves.  A bone turns around its head.

    Raises
    ------
    RigError
        If the arrays do not fit together, a number is not finite, or bones are their own ancestors.
    """

    parents: Ints
    heads: Floats
    tails: Floats

    def __post_init__(self) -> None:
        parents = np.asarray(self.parents, np.int64)
        heads, tails = np.asarray(self.heads, np.float64), np.asarray(self.tails, np.float64)
        count = len(parents)
        if parents.ndim != 1 or heads.shape != (count, 3) or tails.shape != (count, 3):
            raise RigError(
                f"A skeleton of {count} bones needs {count} heads and tails with three coordinates each, but got "
                f"arrays of the shapes {heads.shape} and {tails.shape}."
            )
        if not (np.isfinite(heads).all() and np.isfinite(tails).all()):
            raise RigError("The skeleton has a joint whose position is not a finite number.")
        if count and not ((parents >= -1) & (parents < count)).all():
            raise RigError(f"Parents of the bones should be numbers from -1 to {count - 1}.")
        for name, value in (("parents", parents), ("heads", heads), ("tails", tails)):
            object.__setattr__(self, name, value)
        if len(self.order) < count:
            raise RigError("Some bones of the skeleton are their own ancestors.")

    def __len__(self) -> int:
        return len(self.parents)

    def __repr__(self) -> str:
        return f"<Skeleton: {len(self.heads)} bones>"

    @property
    def axes(self) -> Floats:
        """The way from head to tail of each bone, (b, 3)."""
        return self.tails - self.heads

    @property
    def joints(self) -> Floats:
        """All heads, and then all tails, (2 b, 3)."""
        return np.concatenate([self.heads, self.tails])

    def points_along(self, parts: Floats) -> Floats:
        """Points at some parts of the way from head to tail, (s,), of each bone: (b, s, 3)."""
        return self.heads[:, None] + parts[:, None] * self.axes[:, None]

    def with_likely_tails(self) -> Skeleton:
        """Shorten all bones to what hangs on them, if most of them reach far beyond that.

        Such tails say nothing.  Blender's importer of FBX makes no bone shorter than a hundredth of its armature's
        unit: where that is scaled by 100, each finger is a metre long.
        """
        ways = np.linalg.norm(self.heads - self.heads[self.parents], axis=1)
        ways[self.parents < 0] = 0.0
        reach = np.zeros(len(self))
        np.maximum.at(reach, self.parents[self.parents >= 0], ways[self.parents >= 0])
        lengths, holds = np.linalg.norm(self.axes, axis=1), reach > 0
        if 2 * np.count_nonzero(lengths[holds] > _BEYOND * reach[holds]) <= np.count_nonzero(holds):
            return self
        reach[~holds] = _LAST * ways[~holds]
        reach = np.maximum(reach, _LEAST * np.ptp(self.heads, axis=0).max())
        parts = np.minimum(1.0, reach / np.maximum(lengths, TINY))
        return replace(self, tails=self.heads + parts[:, None] * self.axes)

    @cached_property
    def order(self) -> Ints:
        """All bones, parents before their children, (b,)."""
        found: list[int] = []
        layer = np.flatnonzero(self.parents < 0)
        while len(layer):
            found.extend(layer.tolist())
            layer = np.flatnonzero(np.isin(self.parents, layer))
        return np.array(found, np.int64)

    def children(self, bone: int) -> Ints:
        """Bones that hang directly on a bone."""
        return np.flatnonzero(self.parents == bone)

    def above(self, bone: int) -> list[int]:
        """All bones that a bone hangs on, the nearest first."""
        return way_to_root(self.parents, bone)[1:]

    @cached_property
    def hanging(self) -> Bools:
        """Which bones hang on each bone, itself as well, (b above, b)."""
        found = np.eye(len(self), dtype=bool)
        for bone in self.order[::-1]:
            if self.parents[bone] >= 0:
                found[self.parents[bone]] |= found[bone]
        return found

    def nearest_above(self, chosen: Bools) -> Ints:
        """For each bone the nearest of some bones that it hangs on, -1 if there is none, (b,)."""
        found = np.full(len(self), -1)
        for bone in self.order:
            parent = self.parents[bone]
            if parent >= 0:
                found[bone] = parent if chosen[parent] else found[parent]
        return found
