# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments of a body: bones of two rigs that stand for one another, and which segment hangs on which."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...mesh.connectivity.components import joined_components
from ...mesh.connectivity.edge_chains import way_to_root
from ...runtime.arrays import Bools, Floats, Ints
from ..rig.skeleton import Skeleton
from .posed_motion import Motion

_ELSEWHERE = 0.25
"""How far apart the same joint of two chains may be, in units of the shorter bone there: further ones cut the chains in
other places."""

_FIXED = 0.01
"""How far a joint may move against a bone that holds it, in units of the rig's extent."""

_SLIDING = 1e-3
"""How far a joint slides on what it hangs on to be moved by itself, in units of the rig's extent: two millimetres of a
person, of whose face a lip moves by five and a lid by ten."""


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
        labels = joined_components(len(source_bones) + len(bones), sources, len(source_bones) + targets)
        _, part_of_row = np.unique(labels[sources], return_inverse=True)
        rows = tuple(np.flatnonzero(part_of_row == part) for part in range(part_of_row.max() + 1))
        members = [
            tuple(_in_order(tree, ends[each]) for each in rows)
            for tree, ends in ((source_bones, sources), (bones, targets))
        ]
        above = [_above(tree, parts) for tree, parts in zip((source_bones, bones), members, strict=True)]
        parents, truly = above[1].copy(), np.ones(len(rows), bool)
        for part, wished in enumerate(above[0]):
            if wished >= 0 and wished not in ways_up(above[1], part) and part not in ways_up(parents, int(wished)):
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
        return ways_up(self.parents, part)

    @cached_property
    def hanging(self) -> Bools:
        """Which segments hang on each, however far below, (s above, s)."""
        found = np.zeros((len(self), len(self)), bool)
        for part in range(len(self)):
            found[self.above(part), part] = True
        return found

    def tops(self, part: int, bones: Skeleton) -> list[int]:
        """List the target's bones of a segment that hang on no other of it."""
        return [int(bone) for bone in self.targets[part] if not set(bones.above(int(bone))) & set(self.targets[part])]

    def chains(
        self, sources: Ints, places: Floats, bones: Skeleton, jointed: Collection[int] = ()
    ) -> list[tuple[list[int], Ints]]:
        """Put segments in a row together that are cut in other places in the target.

        Three bones of a spine may each stand for one or two of five, whose joints are not those of the three.

        Parameters
        ----------
        sources : (k,) array of int
            Bones of the source in the pairs.
        places : (k, 3) array of float
            Where their heads lie in the target.
        bones : Skeleton
            The target's bones.
        jointed : collection of int
            Segments that begin at the same joint in both rigs wherever it lies, such as at an elbow.

        Returns
        -------
        list of (list of int, (c,) array of int)
            Numbers of the segments in each chain, and the target's bones in them, parents before children.
        """
        joined = np.arange(len(self))
        for part, above in enumerate(self.parents):
            if above < 0 or part in jointed or len(self.below(int(above))) != 1 or self.single[[part, above]].all():
                continue
            first, last = self.targets[part][0], self.targets[above][-1]
            row = self.rows[part][sources[self.rows[part]] == self.sources[part][0]][0]
            lengths = np.linalg.norm(bones.axes[[first, last]], axis=1)
            if np.linalg.norm(places[row] - bones.heads[first]) > _ELSEWHERE * lengths.min():
                joined[joined == joined[part]] = joined[above]
        chains = []
        for number in np.unique(joined):
            parts = np.flatnonzero(joined == number).tolist()
            chains.append((parts, _in_order(bones, np.concatenate([self.targets[part] for part in parts]))))
        return chains

    def held_in(self, motion: Motion) -> Segments:
        """Find what holds segments that hang on nothing in either rig, such as feet that a solver put at the legs.

        Such a foot moves against the body, but its joint does not against the lower leg.
        """
        tops, parents, carried = np.flatnonzero(self.parents < 0), self.parents.copy(), self.carried.copy()
        if len(tops) < 2 or len(motion) < 2:
            return self
        reach = _FIXED * np.ptp(motion.skeleton.heads, axis=0).max()
        trunk = tops[self.hanging[tops].sum(axis=1).argmax()]
        within = np.flatnonzero(self.parents >= 0)
        bones = [self.sources[part][-1] for part in (*within, trunk)]
        turns, heads = motion.turns[:, bones], motion.heads[:, bones]
        for top in tops if len(within) else ():
            places = np.einsum("fpji,fpj->fpi", turns, motion.heads[:, self.sources[top][:1]] - heads)
            still = np.ptp(places, axis=0).max(axis=1) < reach
            holders = np.flatnonzero(still[:-1] & ~self.hanging[top, within])
            if top != trunk and len(holders) and not still[-1]:
                parents[top] = within[holders[np.linalg.norm(places[0, holders], axis=1).argmin()]]
                carried[top] = False
        return replace(self, parents=parents, carried=carried)

    def freed_in(self, motion: Motion) -> Segments:
        """Let go what carries most of the body and moves against what it hangs on, such as hips above a root.

        Its place is then its own, as that of a top segment is.
        """
        parents = self.parents.copy()
        reach = _FIXED * np.ptp(motion.skeleton.heads, axis=0).max()
        for part in np.flatnonzero(self.parents >= 0):
            if 2 * (int(self.hanging[part].sum()) + 1) <= len(self):
                continue
            joint, bone = self.sources[part][0], self.sources[self.parents[part]][-1]
            offset = motion.skeleton.heads[joint] - motion.skeleton.heads[bone]
            away = motion.heads[:, joint] - motion.heads[:, bone]
            if np.abs(np.einsum("fji,fj->fi", motion.turns[:, bone], away) - offset).max() > reach:
                parents[part] = -1
        return replace(self, parents=parents)

    def sliding_in(self, motion: Motion) -> dict[int, Floats]:
        """Find what is moved on what it hangs on, such as a jaw or an arm that is stretched, and how far, (f, 3) each.

        What moves within a segment moves what hangs on that as well.  A joint that is elsewhere than at rest all the
        time is how the body is built.
        """
        found: dict[int, Floats] = {}
        if motion.slides is None:
            return found
        least = _SLIDING * np.ptp(motion.skeleton.heads, axis=0).max()
        for part in np.flatnonzero((self.parents >= 0) & self.carried).tolist():
            first, above = int(self.sources[part][0]), self.sources[self.parents[part]]
            way = [first, *motion.skeleton.above(first)]
            met = np.flatnonzero(np.isin(way, above))
            if not len(met):
                continue
            slid = motion.slides[:, way[: met[-1]]].sum(axis=1)
            seen = np.einsum("fji,fj->fi", motion.turns[:, way[met[0]]], slid)
            if (np.ptp(seen, axis=0) if len(seen) > 1 else np.abs(seen)).max() > least:
                found[part] = slid
        return found


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
        if part in ways_up(parents, part):
            parents[part] = -1
    return parents


def ways_up(parents: Ints, part: int) -> list[int]:
    """All that one hangs on, the nearest first, until the top or until they repeat."""
    return way_to_root(parents, int(parents[part]))
