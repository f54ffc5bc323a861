# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of a person's rig by what they are: hips, upper arms, thumbs, from where joints are and what hangs on what."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...runtime.arrays import TINY, Bools, Floats, lengths_along
from ...runtime.errors import RigError
from .skeleton import Skeleton

_ON_GROUND = 0.1
"""How high the end of a leg is at most, in units of the height of the rig.  With these numbers the bones of MakeHuman's
four standard rigs are all found, by names that are known (`humanoid_bones`)."""

_HIGH = 0.7
"""How high a bone with a trunk above it reaches at least, in units of the height of the rig."""

_ANKLE = 0.3
"""How high an ankle is at most, in units of the height of the hip."""

_DOWN = 0.05
"""Part of its height by which a bone of a leg goes down at least: less is one of the pelvis, to the side."""

_INWARD = 0.5
"""A bone begins inward of another, in the trunk, if it is less than this part as far from the middle."""

_ROOT = 0.5
"""Bones of the trunk begin higher than this part of where the legs do: below is a root on the ground."""

_UPRIGHT = 45.0
"""How far the trunk of a person leans at most, from the hips to the shoulders, in degrees.  Those of
four makers lean by 8 at most, a kaiju and a bird, which have arms and legs as well, by 58 and 61."""

_SHORT = 0.75
"""A bone of a shoulder is shorter than this part of the next one: of an arm in two pieces both are about as long."""

_BALANCED = 0.5
"""How long the shorter one of upper and lower arm is at least, in units of the other.  It is 0.8 and more in those of
four makers; 0.3 if the forearm and the wrist of a wide knight are taken for them."""

_PALM = 0.5
"""Bones of the palm begin nearer to the wrist than this part of where the next ones do."""

_SPINE = ("spine", "chest", "upper_chest")
_LEG = ("upper_leg", "lower_leg", "foot", "toes")
_ARM = ("shoulder", "upper_arm", "lower_arm", "hand")
_FINGERS = ("index", "middle", "ring", "little")

_NO_LEGS = "The rig does not stand on two legs to which the feet belong, so its bones cannot be identified."
_NO_ARMS = "The rig has no two arms, so its bones cannot be identified."


def humanoid_bones(skeleton: Skeleton, deforming: Bools, up: Floats) -> dict[str, int]:
    """Find out what the bones of a person's rig are, whatever they are called.

    Legs are what reaches the ground, arms what reaches furthest to the sides, the head is what is highest between them,
    and left is told by where the feet point.

    Parameters
    ----------
    skeleton : Skeleton
        The bones at rest, standing.
    deforming : (b,) array of bool
        Which of them move something; others count only if such bones hang on them.
    up : (3,) array of float
        Direction away from the ground, of length one.

    Returns
    -------
    dict
        Numbers of bones by what they are: "hips", "spine", "chest", "upper_chest", "neck", "head", and for both sides,
        such as "left_hand", "shoulder", "upper_arm", "lower_arm", "hand", "upper_leg", "lower_leg", "foot", "toes", and
        "thumb_1" to "little_3".  What the rig lacks is not there.

    Raises
    ------
    RigError
        If the rig is not that of a person who stands upright.
    """
    tree = _Tree(skeleton, deforming, up)
    hips, legs = tree.legs()
    trunk, arms, chest = tree.arms(hips, legs)
    _check_upright(tree, legs, arms)
    forward = sum((tree.bones.tails[way[-1]] - skeleton.heads[_leg(tree, way)[2]] for way in legs), np.zeros(3))
    forward -= (forward @ up) * up
    left = np.cross(up, forward)
    found = {"hips": trunk, **dict(zip(_SPINE, _spine(tree, trunk, chest), strict=False))}
    found |= _head(tree, chest, arms)
    for ways, part, names in ((legs, _leg, _LEG), (arms, _arm, _ARM)):
        places = [tree.bones.tails[way[-1]] @ left for way in ways]
        for side, way in zip(("right", "left"), (ways[number] for number in np.argsort(places)), strict=True):
            bones = dict(zip(names, part(tree, way), strict=True))
            bones |= _fingers(tree, bones.get("hand", -1))
            found |= {f"{side}_{name}": bone for name, bone in bones.items() if bone >= 0}
    return found


class _Tree:
    """The bones that move something, and what they hang on."""

    def __init__(self, skeleton: Skeleton, deforming: Bools, up: Floats) -> None:
        self.bones, self.up = skeleton, up
        self.used = deforming.copy() if deforming.any() else np.ones(len(skeleton), bool)
        for bone in skeleton.order[::-1]:
            if self.used[bone] and skeleton.parents[bone] >= 0:
                self.used[skeleton.parents[bone]] = True
        self.children = [[int(c) for c in skeleton.children(b) if self.used[c]] for b in range(len(skeleton))]
        self.leaves = [int(b) for b in np.flatnonzero(self.used) if not self.children[b]]
        self.heights = skeleton.heads @ up
        ends = np.concatenate([self.heights[deforming], (skeleton.tails @ up)[self.leaves]])
        self.low, self.height = float(ends.min()), float(np.maximum(np.ptp(ends), TINY))

    def above(self, bone: int) -> list[int]:
        """Return a bone and all that it hangs on."""
        return [bone, *self.bones.above(bone)]

    def below(self, bone: int) -> list[int]:
        """Return a bone and all that hangs on it."""
        found = [bone]
        for each in found:
            found += self.children[each]
        return found

    def tips(self, bone: int) -> list[int]:
        """Return the last bones of all that hangs on a bone."""
        return [each for each in self.below(bone) if not self.children[each]]

    def way(self, bone: int, tip: int) -> list[int]:
        """Return the bones from the one below a bone to a tip."""
        above = self.above(tip)
        return above[: above.index(bone)][::-1] if bone in above else above[::-1]

    def level(self, bone: int) -> float:
        """Tell how low a bone reaches, in units of the height."""
        ends = min(self.bones.heads[bone] @ self.up, self.bones.tails[bone] @ self.up)
        return float((ends - self.low) / self.height)

    def legs(self) -> tuple[int, list[list[int]]]:
        """Find the bone on which both legs hang, and the bones of each."""
        low = [tip for tip in self.leaves if self.level(tip) < _ON_GROUND]
        best = -1
        found: list[list[int]] = []
        for bone in np.flatnonzero(self.used):
            branches = [child for child in self.children[bone] if set(self.tips(child)) & set(low)]
            ways = [[self.way(int(bone), tip) for tip in self.tips(child) if tip in low] for child in branches]
            long = sorted((max(each, key=self.reach) for each in ways), key=lambda way: -self.reach(way))[:2]
            if len(long) == 2 and (best < 0 or self.heights[bone] > self.heights[best]):
                best, found = int(bone), long
        if best < 0 or min(self.heights[way].max() - self.low for way in found) < _ANKLE * self.height:
            raise RigError(_NO_LEGS)
        return best, found

    def arms(self, hips: int, legs: list[list[int]]) -> tuple[int, list[list[int]], int]:
        """Find the bone of legs and spine, the bones of both arms, and the one on which they hang."""
        trunk = next(
            (b for b in self.above(hips) if self.heights[self.below(b)].max() > self.low + _HIGH * self.height), hips
        )
        taken = {each for way in legs for each in self.below(way[0])}
        side = self.bones.heads[_leg(self, legs[0])[0]] - self.bones.heads[_leg(self, legs[1])[0]]
        tips = [tip for tip in self.tips(trunk) if tip not in taken]
        if len(tips) < 2:
            raise RigError(_NO_ARMS)
        out = [float(self.bones.heads[tip] @ side) for tip in tips]
        ends = tips[int(np.argmax(out))], tips[int(np.argmin(out))]
        chest = next(bone for bone in self.above(ends[0]) if bone in self.above(ends[1]))
        ways = [self.way(chest, end) for end in ends]
        if min(len(way) for way in ways) < 2 or chest in taken:
            raise RigError(_NO_ARMS)
        high = self.low + _ROOT * (min(self.heights[way].max() for way in legs) - self.low)
        trunk = next((b for b in (trunk, *self.way(trunk, chest)) if self.heights[b] > high), trunk)
        return trunk, ways, chest

    def reach(self, way: Sequence[int]) -> float:
        """Tell how long a chain is."""
        return float(lengths_along(np.concatenate([self.bones.heads[list(way)], self.bones.tails[way[-1:]]]))[-1])

    def middle(self, way: Sequence[int], end: int) -> int:
        """Find the place in a chain of the joint that is nearest to its middle; `end` begins where the chain ends."""
        lengths = lengths_along(self.bones.heads[[*way, end]])
        return 1 + int(np.abs(lengths[1:-1] - lengths[-1] / 2).argmin())

    def balance(self, way: Sequence[int], end: int) -> float:
        """Return how long the shorter half of a chain is in units of the longer one, parted at its `middle`."""
        lengths = lengths_along(self.bones.heads[[*way, end]])
        halves = np.diff(lengths[[0, self.middle(way, end), -1]])
        return float(halves.min() / np.maximum(halves.max(), TINY))


def _check_upright(tree: _Tree, legs: list[list[int]], arms: list[list[int]]) -> None:
    """Make sure that the shoulders are above the hips."""
    begins = [_leg(tree, way)[0] for way in legs], [_arm(tree, way)[1] for way in arms]
    hips, shoulders = (tree.bones.heads[bones].mean(axis=0) for bones in begins)
    trunk = shoulders - hips
    high = float(trunk @ tree.up)
    lean = np.degrees(np.arctan2(np.linalg.norm(trunk - high * tree.up), high))
    if lean > _UPRIGHT:
        raise RigError(
            f"From the hips to the shoulders the rig leans by {lean:.0f} degrees. No person stands like that, so its "
            "bones cannot be identified."
        )


def _spine(tree: _Tree, hips: int, chest: int) -> list[int]:
    """Bones of the spine above the hips, three at most: the first, the one in the middle, and the last."""
    way = [] if chest == hips else tree.way(hips, chest)
    return way if len(way) <= 3 else [way[0], way[len(way) // 2], way[-1]]


def _head(tree: _Tree, chest: int, arms: list[list[int]]) -> dict[str, int]:
    """Find neck and head."""
    branches = [child for child in tree.children[chest] if child not in {way[0] for way in arms}]
    if not branches:
        return {}
    start = max(branches, key=lambda child: max((tree.bones.tails @ tree.up)[tree.below(child)]))
    way = [start]
    while len(tree.children[way[-1]]) == 1:
        way.append(tree.children[way[-1]][0])
    if not tree.children[way[-1]] and len(way) > 1:  # a chain alone: its end is made up if there are three
        way = way[:2]
    return {"head": way[0]} if len(way) == 1 else {"neck": way[0], "head": way[-1]}


def _leg(tree: _Tree, way: list[int]) -> list[int]:
    """Upper and lower leg, foot and toes."""
    heights = [tree.heights[bone] - tree.low for bone in way]
    first = next((n for n in range(len(way) - 1) if heights[n] - heights[n + 1] > _DOWN * heights[n]), 0)
    first = min(first, max(len(way) - 3, 0))
    low = [n for n in range(first + 1, len(way)) if heights[n] < _ANKLE * heights[first]]
    ankle = low[0] if low and low[0] > first + 1 else min(first + 2, len(way) - 1)
    if ankle < first + 2:
        raise RigError(_NO_LEGS)
    knee = first + tree.middle(way[first:ankle], way[ankle])
    toes = way[ankle + 1] if ankle + 1 < len(way) else -1
    return [way[first], way[knee], way[ankle], toes]


def _arm(tree: _Tree, way: list[int]) -> list[int]:
    """Shoulder, upper and lower arm, and hand; -1 for what there is not."""
    branching = [n for n, bone in enumerate(way) if len(tree.tips(bone)) > 1 and n > 1]
    wrist = branching[-1] if branching else min(len(way) - 1, 3)
    if wrist < 2:
        return [-1, way[0], way[1], -1]
    heads = tree.bones.heads
    middle, first = heads[tree.bones.parents[way[0]]], 0
    while wrist - first > 2 and first < 2:
        joints = heads[way[first : first + 3]]
        steps = np.linalg.norm(np.diff(joints, axis=0), axis=1)
        away = (joints[:2] - middle) @ (heads[way[wrist]] - middle)
        if steps[0] >= _SHORT * steps[1] and away[0] >= _INWARD * away[1]:
            break
        if tree.balance(way[first + 1 : wrist], way[wrist]) < _BALANCED:
            break  # wide shoulders without a bone of their own
        first += 1
    elbow = first + tree.middle(way[first:wrist], way[wrist])
    return [way[0] if first else -1, way[first], way[elbow], way[wrist]]


def _fingers(tree: _Tree, hand: int) -> dict[str, int]:
    """Fingers by their places: the thumb begins nearest to the wrist."""
    if hand < 0:
        return {}
    heads, digits = tree.bones.heads, []
    for tip in tree.tips(hand):
        way = tree.way(hand, tip)
        # What several fingers hang on is none.
        free = [bone for bone in way if len(tree.tips(bone)) == 1]
        if len(free) >= 2:
            digits.append(free)
    if len(digits) < 2:
        return {}
    size = max(tree.reach(way) for way in digits)
    digits = [way for way in digits if tree.reach(way) > size / 3]
    if len(digits) < 2:
        return {}
    begins = [np.linalg.norm(heads[way[:2]] - heads[hand], axis=1) for way in digits]
    digits = [
        way[1:] if len(way) > 3 and near < _PALM * far else way for way, (near, far) in zip(digits, begins, strict=True)
    ]
    axis = np.mean([heads[way[0]] for way in digits], axis=0) - heads[hand]
    thumb = min(digits, key=lambda way: (heads[way[0]] - heads[hand]) @ axis)
    others = [way for way in digits if way is not thumb]
    away = np.mean([heads[way[0]] for way in others], axis=0) - heads[thumb[0]]
    away -= (away @ axis) / (axis @ axis) * axis
    others.sort(key=lambda way: heads[way[0]] @ away)
    found = {f"thumb_{number}": bone for number, bone in enumerate(thumb[:3], 1)}
    for name, way in zip(_FINGERS, others, strict=False):
        found |= {f"{name}_{number}": bone for number, bone in enumerate(way[:3], 1)}
    return found
