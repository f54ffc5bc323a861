# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion of one skeleton as motion of another whose bones are paired with it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ...runtime.arrays import Bools, Floats, Ints, marked, unit_vectors
from ...runtime.background import can_go_beside
from ...runtime.errors import RigError
from ...runtime.progress import Progress, Steps, at_once
from ..rig.skeleton import Skeleton
from .bone_pairing import BonePairing
from .chain_fit import fitted_chains
from .contacts import contacts_of, grounded_lifts, held_shifts
from .hand_contacts import BodyLine, hand_shifts
from .limbs import Limb, limbs_of
from .posed_motion import Motion
from .rest_rotations import posed_rotations
from .segments import Segments, ways_up
from .two_bone_ik import bent_limb, needed_drop

_RATIOS = (1e-5, 1e5)
"""Ratios of sizes outside of these come from rigs without extent; units of a thousand and of one are common."""

_SMOOTH = 0.1
"""Seconds over which the body goes down where a leg would be too short."""

_ALIKE = 0.2
"""Part of their length by which two arms differ at most."""


@dataclass(frozen=True)
class MotionSettings:
    """How motion is transferred.

    Attributes
    ----------
    feet : bool
        Whether feet that stand still in the source stand still in the target.
    hands : bool
        Whether hands that touch the body in the source touch it in the target.
    stride : float
        How long steps are, in units of what the legs' lengths make of the source's.
    in_place : bool
        Whether the way that the target covers on the ground is taken out.
    rate : float
        Poses per second.
    """

    feet: bool = False
    hands: bool = False
    stride: float = 1.0
    in_place: bool = False
    rate: float = 24.0


@dataclass(frozen=True, eq=False)
class TransferredMotion:
    """Motion of a target.

    Attributes
    ----------
    motion : Motion
        The poses of all its bones.
    moved : (b,) array of bool
        Which of them turn by themselves: those with partners.
    placed : (b,) array of bool
        Which also have a place of their own: the topmost ones, those that hang elsewhere than on what holds them, and
        those that slide on it.
    rooted : (b,) array of bool
        Which of these hang on nothing that moves: they carry the body.
    fixed : (b,) array of bool
        Which would slide on what they hang on, but are connected with it.
    scale : float
        How many times as long the target's legs are.
    """

    motion: Motion
    moved: Bools
    placed: Bools
    rooted: Bools
    fixed: Bools
    scale: float

    def __repr__(self) -> str:
        return f"<TransferredMotion: {int(self.moved.sum())} of {len(self.moved)} bones turn, scale {self.scale:.3g}>"


@can_go_beside
def transfer_motion_steps(
    motion: Motion,
    pairing: BonePairing,
    target: Skeleton,
    settings: MotionSettings | None = None,
    *,
    ups: Floats | None = None,
    connected: Bools | None = None,
    times: Floats | None = None,
) -> Steps[TransferredMotion]:
    r"""Transfer motion from one skeleton to another.

    If the source's bone turns by :math:`D` from rest, the target's surface is turned by :math:`M` against the
    source's around it, both at rest, and the target as a whole by :math:`G`, then the target's bone turns by
    :math:`G D M^T`: its surface then lies as the source's does, turned by :math:`G`, whatever the rest poses and the
    axes of the bones are.  Bones that do together what other bones of the source do are turned so that what they carry
    lies where the source has it (`fitted_chains`).  Bones without a partner go with what they hang on.  The way of the
    topmost bones is scaled by the lengths of the legs, and that of a joint that slides on what it hangs on, such as a
    jaw's or that of an arm that is stretched, by the distances between the joints there.

    Parameters
    ----------
    motion : Motion
        The source's poses, f.
    pairing : BonePairing
        The pairs.
    target : Skeleton
        The target's bones at rest, b.
    settings : MotionSettings, optional
        How.
    ups : (2, 3) array of float, optional
        Directions away from the ground in the source's and the target's space; z if not given.
    connected : (b,) array of bool, optional
        Which of the target's bones stay where the bone that they hang on takes them; none if not given.
    times : (f,) array of float, optional
        When the poses are, in units in which the way that is taken out begins at 0 and ends at 1; evenly if not given.

    Returns
    -------
    TransferredMotion
        The target's poses.

    Raises
    ------
    RigError
        If there is no pair, pairs name bones that there are not, or something does not fit the rigs.
    """
    settings = settings or MotionSettings()
    connected = np.zeros(len(target), bool) if connected is None else np.asarray(connected, bool)
    _check(motion, pairing, target, settings, connected)
    if times is not None and times.shape != (len(motion),):
        raise RigError(f"There should be a time for each of the {len(motion)} poses, not {times.shape}.")
    ups = np.array([[0.0, 0, 1]] * 2) if ups is None else unit_vectors(np.asarray(ups, np.float64))
    if not ups.any(axis=1).all():
        raise RigError("A direction away from the ground has no length.")
    yield Progress(0.0, "Transferring rotations")
    body = _Body(motion, pairing, target, ups)
    fixed = body.fix(connected)
    turns = body.turns(motion.turns)
    yield Progress(0.3, "Posing the bones")
    places = _Places(body.paths(motion.heads, turns, settings.stride), body.slides(turns))
    posed = body.posed(turns, places)
    if body.feet:
        places = places.lifted(_carried_lifts(body, motion, posed), ups[1])
        posed = body.posed(turns, places)
    if settings.feet and body.feet and len(motion) > 1:
        yield Progress(0.5, "Keeping the feet")
        goals, drop = _with_feet(body, motion, posed, settings)
        places = places.lifted(-drop, ups[1])
        turns = body.bent(turns, places, body.feet, goals)
        posed = body.posed(turns, places)
    arms = _arms(body.limbs)
    if settings.hands and arms:
        yield Progress(0.75, "Keeping the hands")
        turns = body.bent(turns, places, arms, _hand_goals(body, motion, posed, arms))
        posed = body.posed(turns, places)
    if settings.in_place and len(motion) > 1:
        times = np.linspace(0, 1, len(motion)) if times is None else times
        posed = _in_place(posed, ups[1], np.flatnonzero(body.rooted), times)
    return TransferredMotion(posed, body.moved, body.placed, body.rooted, fixed, body.scale)


transfer_motion = at_once(transfer_motion_steps)


def _check(motion: Motion, pairing: BonePairing, target: Skeleton, settings: MotionSettings, connected: Bools) -> None:
    if not len(pairing):
        raise RigError("No bones of the two rigs are paired. Pair them first.")
    if pairing.sources.max() >= len(motion.skeleton) or pairing.targets.max() >= len(target):
        raise RigError("The pairs name bones that the rigs do not have. Pair the bones again.")
    if connected.shape != (len(target),):
        raise RigError(f"Which of {len(target)} bones are connected cannot be said by {len(connected)} values.")
    if not settings.rate > 0 or not settings.stride >= 0:
        raise RigError("The frame rate must be larger than zero, and the stride must not be negative.")


class _Places(NamedTuple):
    """Where the first bones of segments that hang on nothing are, (f, t, 3) each, and how far bones slide, (f, 3) each.

    Slides are in the axes that what holds a bone has at rest.
    """

    tops: dict[int, Floats]
    slides: dict[int, Floats]

    def lifted(self, lifts: Floats, up: Floats) -> _Places:
        """Lift the body as a whole by so much, (f,)."""
        return self._replace(tops={part: path + lifts[:, None, None] * up for part, path in self.tops.items()})


class _Body:
    """The target's bones, and what moves them."""

    def __init__(self, motion: Motion, pairing: BonePairing, target: Skeleton, ups: Floats) -> None:
        self.source, self.pairing, self.target, self.ups = motion.skeleton, pairing, target, ups
        self.segments = (
            Segments.of(pairing.sources, pairing.targets, self.source, target).held_in(motion).freed_in(motion)
        )
        self.moved = marked(pairing.targets, len(target))
        # Of each segment the bones that hang on no other of it.
        self.tops = [self.segments.tops(part, target) for part in range(len(self.segments))]
        self.placed, self.rooted = np.zeros((2, len(target)), bool)
        self._holders = target.parents.copy()
        for part, above in enumerate(self.segments.parents):
            if above < 0 or not self.segments.carried[part]:
                self.placed[self.tops[part]] = True
                self.rooted[self.tops[part]] = above < 0
                self._holders[self.tops[part]] = self.segments.targets[above][-1] if above >= 0 else -1
        self._order = self._in_order()
        self.limbs = limbs_of(self.segments, self.source, target, ups)
        self.feet = [limb for limb in self.limbs if limb.foot]
        trees = self.source, target
        rests = posed_rotations(pairing, self.segments, self.limbs, trees, ups[1])
        self._chains = fitted_chains(pairing, rests, self.segments, trees, self._holders, arms=_arms(self.limbs))
        self.scale = self._scale()
        # How far bones slide on what they hang on, (f, 3) each.
        self._slid = {
            bone: self._unit(part) * slid @ pairing.upright.T
            for part, slid in self.segments.sliding_in(motion).items()
            for bone in self.tops[part]
        }
        self.placed[list(self._slid)] = True
        self._rise = 0.0
        # In the pose in which the source rests the target's feet are to be as high as they are in its own.
        if self.feet:
            resting = self.rest_pose()
            rises = [(limb.target_points(resting)[0] - limb.target_points(target))[0] @ ups[1] for limb in self.feet]
            self._rise = float(np.mean(rises))

    def fix(self, connected: Bools) -> Bools:
        """Let bones (b,) not slide on what they hang on; and tell which of them would."""
        would = marked(np.array([bone for bone in self._slid if connected[bone]], np.int64), len(self.target))
        self._slid = {bone: way for bone, way in self._slid.items() if not would[bone]}
        self.placed[would] = False
        return would

    def rest_pose(self) -> Motion:
        """Pose the target as the source rests."""
        heads = self.source.heads[None]
        turns = self.turns(np.tile(np.eye(3), (1, len(self.source), 1, 1)))
        return self.posed(turns, _Places(self.paths(heads, turns, 1.0), {}))

    def turns(self, source_turns: Floats) -> Floats:
        """How the target's bones with partners turn, (f, b, 3, 3); the others are left at rest."""
        result = np.tile(np.eye(3), (len(source_turns), len(self.target), 1, 1))
        upright = self.pairing.upright @ source_turns
        for chain in self._chains:
            result[:, chain.bones] = chain.turns(upright)
        return result

    def _scale(self) -> float:
        """How many times as long the target's legs are; without legs, how many times as large the skeleton is."""
        if self.feet:
            before, after = (sum(getattr(limb, of) for limb in self.feet) for of in ("source_length", "target_length"))
        else:
            pairs = (self.source, self.pairing.sources), (self.target, self.pairing.targets)
            before, after = (_spread(tree.heads[bones]) for tree, bones in pairs)
            if not before:  # a single bone has a length all the same
                before, after = (
                    _spread(np.concatenate([tree.heads[bones], tree.tails[bones]])) for tree, bones in pairs
                )
        return _ratio(before, after) or 1.0

    def paths(self, source_heads: Floats, turns: Floats, stride: float) -> dict[int, Floats]:
        """Where the first bones of the segments are that hang on nothing, (f, t, 3) each."""
        up, pairing, segments = self.ups[1], self.pairing, self.segments
        paths = {}
        for part in np.flatnonzero(segments.parents < 0):
            first, rows = segments.sources[part][0], segments.rows[part]
            way = self.scale * (source_heads[:, first] - self.source.heads[first]) @ pairing.upright.T
            way = stride * way + (1 - stride) * (way @ up)[:, None] * up - self._rise * up
            # The source's joint goes that way, and the target's bones turn around it.
            joint = pairing.places[rows[np.flatnonzero(pairing.sources[rows] == first)[0]]]
            offsets = self.target.heads[self.tops[part]] - joint
            paths[int(part)] = (joint + way)[:, None] + np.einsum("ftij,tj->fti", turns[:, self.tops[part]], offsets)
        return paths

    def _unit(self, part: int) -> float:
        """How many times as far joints are apart in the target that hang where a segment does."""
        above = int(self.segments.parents[part])
        bones = [int(self.segments.sources[each][0]) for each in (above, *self.segments.below(above))]
        rows = [int(np.flatnonzero(self.pairing.sources == bone)[0]) for bone in bones]
        return _ratio(_spread(self.source.heads[bones]), _spread(self.pairing.places[rows])) or self.scale

    def slides(self, turns: Floats) -> dict[int, Floats]:
        """How far bones slide, (f, 3) each, in the axes that what holds them has at rest."""
        found = {}
        for bone, slid in self._slid.items():
            held = next((up for up in ways_up(self._holders, bone) if self.moved[up]), -1)
            found[bone] = slid if held < 0 else np.einsum("fji,fj->fi", turns[:, held], slid)
        return found

    def posed(self, turns: Floats, places: _Places) -> Motion:
        """Pose all bones: those without partners go with their parents."""
        target = self.target
        full, heads = turns.copy(), np.tile(target.heads, (len(turns), 1, 1))
        own = {
            bone: path[:, number] for part, path in places.tops.items() for number, bone in enumerate(self.tops[part])
        }
        for bone in self._order:
            parent, holder = target.parents[bone], self._holders[bone]
            if not self.moved[bone] and parent >= 0:
                full[:, bone] = full[:, parent]
            if bone in own:
                heads[:, bone] = own[bone]
            elif holder >= 0:
                offsets = target.heads[bone] - target.heads[holder] + places.slides.get(bone, 0.0)
                heads[:, bone] = heads[:, holder] + (full[:, holder] @ offsets[..., None])[..., 0]
        return Motion(target, full, heads)

    def bent(self, turns: Floats, places: _Places, limbs: list[Limb], goals: list[Floats]) -> Floats:
        """Bend limbs so that they end at goals (f, 3); what is beyond stays turned as it was."""
        posed, result = self.posed(turns, places), turns.copy()
        for limb, goal in zip(limbs, goals, strict=True):
            upper, lower = bent_limb(limb.joints(posed), goal)
            result[:, limb.upper] = upper[:, None] @ turns[:, limb.upper]
            result[:, limb.lower] = lower[:, None] @ turns[:, limb.lower]
        return result

    def _in_order(self) -> Ints:
        """Order the bones, each after its parent and what holds it."""
        found: list[int] = []
        left, known = self.target.order.tolist(), {-1}
        while left:
            ready = [bone for bone in left if self._holders[bone] in known and self.target.parents[bone] in known]
            ready = ready or left  # what holds one another in a ring stays in the order of the rig
            found += ready
            known.update(ready)
            left = [bone for bone in left if bone not in known]
        return np.array(found, np.int64)


def _spread(points: Floats) -> float:
    """How far points (k, 3) are from their middle."""
    return float(np.linalg.norm(points - points.mean(axis=0)))


def _ratio(before: float, after: float) -> float | None:
    """How many times as large a size is; None if that comes from rigs without extent."""
    ratio = after / before if before > 0 else 0.0
    return float(ratio) if _RATIOS[0] < ratio < _RATIOS[1] else None


def _with_feet(body: _Body, motion: Motion, posed: Motion, settings: MotionSettings) -> tuple[list[Floats], Floats]:
    """Find where legs are to end so that feet stay where they stand, (f, 3) each, and how much lower the body is."""
    up, length = body.ups[0], float(np.mean([limb.source_length for limb in body.feet]))
    goals, levels = [], body.rest_pose()
    for limb in body.feet:
        points = limb.source_points(motion)
        touching = contacts_of(points, up, length, settings.rate)
        level, places = limb.target_points(levels)[0] @ body.ups[1], limb.target_points(posed)
        # Each foot stands as high as at rest, also where a trunk that slopes otherwise takes fore feet up.
        level += limb.target_points(body.target)[0] @ body.ups[1] - level[0]
        heights = body.scale * (points - limb.source_points(body.source)) @ up + level
        shifts = held_shifts(places, touching, heights, body.ups[1], settings.rate)
        lifts = grounded_lifts((places + shifts[:, None]) @ body.ups[1], heights, level, body.scale * length)
        goals.append(limb.joints(posed)[:, 2] + shifts + lifts[:, None] * body.ups[1])
    drops = [needed_drop(limb.joints(posed), goal, body.ups[1]) for limb, goal in zip(body.feet, goals, strict=True)]
    return goals, _smoothed(np.max(drops, axis=0), settings.rate)


def _carried_lifts(body: _Body, motion: Motion, posed: Motion) -> Floats:
    """Find how far the body has to be lifted in each pose, (f,), for the feet that carry it to be on the ground."""
    up, length = body.ups[0], float(np.mean([limb.source_length for limb in body.feet]))
    levels = np.concatenate([limb.target_points(body.target) for limb in body.feet]) @ body.ups[1]
    rises = [(limb.source_points(motion) - limb.source_points(body.source)) @ up for limb in body.feet]
    wanted = levels + body.scale * np.concatenate(rises, axis=1)
    heights = np.concatenate([limb.target_points(posed) for limb in body.feet], axis=1) @ body.ups[1]
    return grounded_lifts(heights, wanted, levels, body.scale * length)


def _smoothed(drops: Floats, rate: float) -> Floats:
    """Make values (f,) smooth, and nowhere less than they were."""
    span = max(1, round(_SMOOTH * rate))
    highest = maximum_filter1d(drops, 2 * span + 1, mode="nearest")
    return np.asarray(uniform_filter1d(highest, 2 * span + 1, mode="nearest"))


def _hand_goals(body: _Body, motion: Motion, posed: Motion, arms: list[Limb]) -> list[Floats]:
    """Find where arms are to end so that hands are to the body as they are in the source, (f, 3) each."""
    lines = []
    segments = body.segments
    for part in range(len(segments)):
        ends = []
        for bones, each in ((segments.sources, motion), (segments.targets, posed)):
            below = segments.below(part)
            last = each.heads[:, bones[below[0]][0]] if len(below) else each.tails[:, bones[part][-1]]
            ends.append(np.stack([each.heads[:, bones[part][0]], last], axis=1))
        lines.append(BodyLine(*ends))
    goals = []
    whole = {limb.parts: {*limb.parts, *np.flatnonzero(segments.hanging[limb.parts[1]]).tolist()} for limb in arms}
    for limb in arms:
        own = whole[limb.parts]
        others = set().union(*(parts for parts in whole.values() if parts is not own))
        used = [
            replace(line, share=0.5 if part in others else 1.0)
            for part, line in enumerate(lines)
            if part not in own and part != segments.parents[limb.parts[0]]
        ]
        palms = limb.source_points(motion).mean(axis=1), limb.target_points(posed).mean(axis=1)
        shift = hand_shifts(*palms, used, limb.source_length, body.scale * body.pairing.upright)
        goals.append(limb.joints(posed)[:, 2] + shift)
    return goals


def _arms(limbs: list[Limb]) -> list[Limb]:
    """Choose the limbs that come in pairs and are no legs: a neck with a head is none."""
    free = [limb for limb in limbs if not limb.foot]

    def alike(one: Limb, other: Limb) -> bool:
        """Say whether two limbs could be a pair."""
        return other is not one and abs(other.source_length - one.source_length) < _ALIKE * one.source_length

    return [limb for limb in free if any(alike(limb, other) for other in free)]


def _in_place(posed: Motion, up: Floats, roots: Ints, times: Floats) -> Motion:
    """Take out the way along the ground from the pose nearest to time 0 to that nearest to 1, evenly in time."""
    first, last = (int(np.abs(times - end).argmin()) for end in (0, 1))
    way = (posed.heads[last, roots] - posed.heads[first, roots]).mean(axis=0)
    way = way - (way @ up) * up
    gone = ((times - times[first]) / ((times[last] - times[first]) or 1.0))[:, None, None] * way
    return Motion(posed.skeleton, posed.turns, posed.heads - gone)
