# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments of a body: bones of two rigs that stand for one another, and which segment hangs on which."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...mesh.connectivity.components import joined_components
from ...runtime.arrays import Bools, Ints
from ..rig.skeleton import Skeleton
from .posed_motion import Motion

_FIXED = 0.01
"""How far a joint may move against a bone that holds it, in units of the rig's extent."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Bones that are connected by pairs, s groups of them: one bone each, or a spine of three and its five.

    Attributes
    ----------
    rows : tuple of (r,) arrays of int
        Pairs of each segment.
    sources, targets : tuple of arrays of int
        Its bones in either rig, parents before children.
    parents : (s,) array of int
        The segment on which it hangs in the target, or, where the target's bones hang elsewhere, such as feet that
        only constraints hold at the legs, in the source; -1 for none.
    carried : (s,) array of bool
        Whether its bones in the target hang there in truth.
    """

    rows: tuple[Ints, ...]
    sources: tuple[Ints, ...]
    targets: tuple[Ints, ...]
    parents: Ints
    carried: Bools

    @classmethod
    def of(cls, sources: Ints, targets: Ints, source_bones: Skeleton, bones: Skeleton) -> Segments:
        """Find the segments of pairs of bones (k,)."""
        if not len(sources):
            return cls((), (), (), np.zeros(0, np.int64), np.zeros(0, bool))
        size = len(source_bones) + len(bones)
        labels = joined_components(size, sources, len(source_bones) + targets)
        _, part_of_row = np.unique(labels[sources], return_inverse=True)
        rows = tuple(np.flatnonzero(part_of_row == part) for part in range(part_of_row.max() + 1))
        members = [
            tuple(_in_order(tree, ends[each]) for each in rows)
            for tree, ends in ((source_bones, sources), (bones, targets))
        ]
        above = [_above(tree, parts) for tree, parts in zip((source_bones, bones), members, strict=True)]
        parents, truly = above[1].copy(), np.ones(len(rows), bool)
        for part, wished in enumerate(above[0]):
            if wished >= 0 and wished not in _chain(above[1], part) and part not in _chain(parents, int(wished)):
                parents[part], truly[part] = wished, False
        return cls(rows, members[0], members[1], parents, truly)

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        return f"<Segments: {len(self)} of {sum(len(part) for part in self.targets)} bones>"

    @property
    def single(self) -> Bools:
        """Whether a segment is one bone in either rig, (s,)."""
        return np.array([len(part) == 1 for part in self.rows], bool)

    def below(self, part: int) -> Ints:
        """Segments that hang directly on one."""
        return np.flatnonzero(self.parents == part)

    def above(self, part: int) -> list[int]:
        """Segments that one hangs on, the nearest first."""
        return _chain(self.parents, part)

    def held_in(self, motion: Motion) -> Segments:
        """Find what holds segments that hang on nothing in either rig, such as feet that a solver put at the legs.

        Such a foot moves against the body, but its joint does not against the lower leg.
        """
        tops, parents, carried = np.flatnonzero(self.parents < 0), self.parents.copy(), self.carried.copy()
        if len(tops) < 2 or len(motion) < 2:
            return self
        reach = _FIXED * np.ptp(motion.skeleton.heads, axis=0).max()
        trunk = max(tops, key=lambda top: sum(int(top) in self.above(part) for part in range(len(self))))
        for top in tops:
            joint = motion.heads[:, self.sources[top][0]]
            places = {}
            for part in range(len(self)):
                bone = self.sources[part][-1]
                places[part] = np.einsum("fji,fj->fi", motion.turns[:, bone], joint - motion.heads[:, bone])
            holders = [
                part
                for part, place in places.items()
                if part not in tops and int(top) not in self.above(part) and np.ptp(place, axis=0).max() < reach
            ]
            if top != trunk and holders and np.ptp(places[int(trunk)], axis=0).max() > reach:
                parents[top] = min(holders, key=lambda part: np.linalg.norm(places[part][0]))
                carried[top] = False
        return replace(self, parents=parents, carried=carried)

    def freed_in(self, motion: Motion) -> Segments:
        """Let go what carries most of the body and moves against what it hangs on, such as hips above a root.

        Its place is then its own, as that of a top segment is.
        """
        parents = self.parents.copy()
        reach = _FIXED * np.ptp(motion.skeleton.heads, axis=0).max()
        for part in np.flatnonzero(self.parents >= 0):
            below = sum(int(part) in self.above(other) for other in range(len(self)))
            if 2 * (below + 1) <= len(self):
                continue
            joint, bone = self.sources[part][0], self.sources[self.parents[part]][-1]
            offset = motion.skeleton.heads[joint] - motion.skeleton.heads[bone]
            away = motion.heads[:, joint] - motion.heads[:, bone]
            if np.abs(np.einsum("fji,fj->fi", motion.turns[:, bone], away) - offset).max() > reach:
                parents[part] = -1
        return replace(self, parents=parents)


def _in_order(tree: Skeleton, bones: Ints) -> Ints:
    """Bones, each once, parents before children."""
    return tree.order[np.isin(tree.order, bones)]


def _above(tree: Skeleton, parts: tuple[Ints, ...]) -> Ints:
    """For each part of a tree the nearest other part that its first bone hangs on, -1 for none."""
    owner = np.full(len(tree), -1)
    for part, bones in enumerate(parts):
        owner[bones] = part
    result = np.full(len(parts), -1)
    for part, bones in enumerate(parts):
        bone = int(tree.parents[bones[0]])
        while bone >= 0 and owner[bone] in (-1, part):
            bone = int(tree.parents[bone])
        result[part] = owner[bone] if bone >= 0 else -1
    return _without_loops(result)


def _without_loops(parents: Ints) -> Ints:
    """Cut parents that lead back to where one came from: parts may cross one another."""
    for part in range(len(parents)):
        if part in _chain(parents, part):
            parents[part] = -1
    return parents


def _chain(parents: Ints, part: int) -> list[int]:
    """Parts above one, until the top or until they repeat."""
    found: list[int] = []
    above = int(parents[part])
    while above >= 0 and above not in found:
        found.append(above)
        above = int(parents[above])
    return found
