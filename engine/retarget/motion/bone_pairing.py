# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of bones of two rigs, by the surface that they move and the joints around which they turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ...geometry.procrustes import least_turns, nearest_frame, nearest_rotations
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, Ints, unit_vectors
from ...runtime.errors import RigError
from ..limbs.limb_order import in_order
from ..limbs.mirrored_bones import evened_rotations, mirrored_bones
from ..rig.fitted_rig import FittedRig
from ..rig.joint_placement import place_joints, standing
from ..rig.skeleton import Skeleton
from ..weights.skin_weights import carried, row_shares, row_sums
from .segments import Segments
from .tree_alignment import aligned

_SHARES = {"subtree": 0.45, "own": 0.35, "place": 0.2}
"""How much it counts that two bones move the same with all that hangs on them, and by themselves, and turn around the
same point: they sum to one."""

_LEAST_SCORE = 0.3
"""Score from which on two bones may be a pair."""

_LEAST_INSIDE = 0.25
"""Least part of what the smaller of two bones moves that the other moves as well, for them to be a pair."""

_LEAST_WHOLE = 0.5
"""Or what two bones have to move the same of with all that hangs on them: a map may slide a hand along its arm.
Without it, the hands of the Mesh2Motion man go with ring fingers (``python -m tests.benchmarks.maker_rigs --only
cryptovoxels.vrm:m2m-human-male.glb``)."""

_SECOND_INSIDE = 0.75
"""The same for one that shares its partner with a better one, in units of what any bone there moves of it: two
neighbors overlap as well where they meet."""

_LEAST_PLACE = 0.5
"""How near the joints of two bones have to lie that move nothing by themselves."""

_ROOT_REACH = 0.1
"""How far the joints of such bones may be apart, and what hangs on others may be carried astray, in units of the body's
largest extent."""

_FIXED = 10.0
"""What a pair is worth that is given: more than any other choice may gain."""

_STRAY_DIRECTION = np.radians(35.0)
"""A bone whose direction by the joints is further from that by the map keeps the latter: its joint means another
place."""

_DOUBTFUL = 0.2
"""Mean confidence of a map over the target below which it says which limbs belong together, but no more: the knight's
maps have 0.04 to 0.16, a husky's to a cat 0.25, which says where paws are better than joints do.  Chosen by ``python
-m tests.benchmarks.maker_rigs``: with 0.3 that cat's paws walk 13 % of its height below the ground."""

_TRUNK_NEAR_AXES = np.radians(20.0)
"""Bodies whose rotation against each other is no further from one that takes axes to axes are turned by just that."""


@dataclass(frozen=True, eq=False)
class BonePairing:
    """Pairs of bones, k of them: a bone may be in several where one rig has more bones than the other.

    Attributes
    ----------
    sources, targets : (k,) array of int
        Numbers of the bones in the source's and in the target's rig, in the target's order.
    scores : (k,) array of float
        How well they agree, 0 to 1.
    rotations : (k, 3, 3) array of float
        How the target's surface around the bone is turned against the source's, both at rest.
    places : (k, 3) array of float
        Where the head of the source's bone lies in the target.
    upright : (3, 3) array of float
        How the target stands as a whole, turned against the source.
    """

    sources: Ints
    targets: Ints
    scores: Floats
    rotations: Floats
    places: Floats
    upright: Floats

    def __post_init__(self) -> None:
        count = len(self.sources)
        shapes = {"targets": (count,), "scores": (count,), "rotations": (count, 3, 3), "places": (count, 3)}
        for name, shape in shapes.items():
            if np.shape(getattr(self, name)) != shape:
                raise RigError(f"{count} pairs of bones need {name} of the shape {shape}.")

    def __len__(self) -> int:
        return len(self.sources)

    def __repr__(self) -> str:
        return f"<BonePairing: {len(self)} pairs of {len(set(self.targets.tolist()))} bones of the target>"

    def comes_apart(self, source: Skeleton, target: Skeleton) -> bool:
        """Tell whether the target stays together only where it has keys.

        Bones that hang elsewhere than on what holds them, such as feet for a solver or all bones of a flat rig, are
        put where they belong.  Between two keys they would go straight there, and what holds them along an arc.

        Parameters
        ----------
        source, target : Skeleton
            The bones of both rigs.

        Returns
        -------
        bool
            Whether there are such bones.
        """
        return not Segments.of(self.sources, self.targets, source, target).carried.all()


def pair_bones(
    rig: FittedRig,
    source: TriangleMesh,
    target: TriangleMesh,
    skeleton: Skeleton,
    weights: csr_array,
    *,
    fixed: Sequence[tuple[int, int]] = (),
    alone: Sequence[int] = (),
    frames: Floats | None = None,
) -> BonePairing:
    """Pair the bones of a rig that was fitted into a target with those that the target has itself.

    Of two bones three things are compared: what they move together with all bones that hang on them, what they move by
    themselves, and where their joints are.  Chains are then aligned as chains, from either side, so that three bones
    may stand for five; where the map is doubtful, limbs by the order and lengths of their bones.  Bones beside them
    that move what their parent moves, such as twist bones, and bones that move nothing, stay alone.  Names are not
    known here.

    Parameters
    ----------
    rig : FittedRig
        The source's rig, a bones, fitted into the target.
    source, target : TriangleMesh
        The bodies.
    skeleton : Skeleton
        The target's own bones, b.
    weights : (n_y, b) csr_array of float
        How much each of them moves each vertex of the target.  If no vertex has any, each bone is taken to move what
        is nearest to it.
    fixed : sequence of (int, int)
        Bones of the source and of the target that are a pair whatever the surface says.
    alone : sequence of int
        Bones of the target that get no partner.
    frames : (k, 3, 3) array of float, optional
        Rotations that the whole body may be turned by, beside those that take axes to axes: see `standing`.

    Returns
    -------
    BonePairing
        The pairs.

    Raises
    ------
    RigError
        If the arrays do not fit together, or the rig was fitted across a map to the mirror image.
    """
    if rig.handedness < 0:
        raise RigError(
            "The match exchanges left and right, so bones would turn the wrong way. Use another answer of the match, "
            "or match the bodies again."
        )
    if weights.shape != (target.vertex_count, len(skeleton)):
        raise RigError(
            f"{target.vertex_count} vertices and {len(skeleton)} bones need weights of that shape, but got "
            f"{weights.shape}."
        )
    sources, targets = [own for own, _ in fixed], [*(other for _, other in fixed), *alone]
    for side, bones, count in (("source", sources, len(rig.skeleton)), ("target", targets, len(skeleton))):
        for bone in bones:
            if not 0 <= bone < count:
                raise RigError(f"The {side} has {count} bones, so there is no bone {bone}.")
    if not weights.nnz:
        weights = nearest_bones(target, skeleton)
    placed = place_joints(rig, source, np.zeros_like(rig.skeleton.heads))
    there = carried(rig.weights, rig.target_to_source)
    within_target = Skeleton(rig.skeleton.parents, placed.heads, placed.tails), skeleton
    mirrors = mirrored_bones(rig.skeleton), mirrored_bones(skeleton)
    found = _compared(there, weights, target, within_target, mirrors)
    gains = _gains(found.scores, fixed, alone)
    trees = rig.skeleton, skeleton
    chosen = _chosen(gains, found, trees, {target: source for source, target in fixed})
    given = {(int(a), int(b)) for a, b in fixed}
    chosen = _without_misplaced(chosen, within_target, given, target)
    doubtful = bool(np.average(rig.target_to_source.confidence, weights=target.vertex_areas) < _DOUBTFUL)
    upright = _upright(rig, source, frames, doubtful=doubtful)
    if doubtful:
        ends = _ending(trees[0], source, rig.weights, upright), _ending(skeleton, target, weights, np.eye(3))
        moving = rig.weights.sum(axis=0) > 0, (weights.sum(axis=0) > 0) & ~np.isin(np.arange(len(skeleton)), alone)
        chosen = in_order(chosen, found.scores, ends, moving, mirrors, given=given)
    sources, targets = chosen.T
    worth = found.scores[targets, sources].clip(min=0)
    worth[[pair in given for pair in zip(sources.tolist(), targets.tolist(), strict=True)]] = 1.0
    if doubtful:
        rotations = _by_joints((sources, targets), trees, upright)
    else:
        # Where tails point is left to whoever made the rig: bones that move something turn as their surface does.
        seen = np.where(found.moving[0][:, None, None], rig.rotations, placed.rotations)
        evened = evened_rotations(seen[sources], (sources, targets), trees, mirrors, upright)
        rotations = _swung(evened, (sources, targets), trees)
    return BonePairing(sources, targets, worth, rotations, placed.heads[sources], upright)


def _ending(tree: Skeleton, mesh: TriangleMesh, weights: csr_array, turn: Floats) -> Skeleton:
    """Turn bones, and let each end where what it moves does, with all that hangs on it: twice as far as its middle."""
    moved = csr_array((weights @ csr_array(tree.hanging.T, dtype=float)).T.multiply(mesh.vertex_areas))
    middles = (moved @ mesh.vertices) / np.maximum(row_sums(moved), TINY)[:, None]
    return Skeleton(tree.parents, tree.heads @ turn.T, (2 * middles - tree.heads) @ turn.T)


def nearest_bones(mesh: TriangleMesh, skeleton: Skeleton) -> csr_array:
    """Let each bone move the vertices (n) that are nearest to it: weights (n, b) where there are none."""
    steps = np.linspace(0.05, 0.95, 12)
    _, found = cKDTree(skeleton.points_along(steps).reshape(-1, 3)).query(mesh.vertices)
    rows = np.arange(mesh.vertex_count)
    return csr_array((np.ones(len(rows)), (rows, found // len(steps))), shape=(len(rows), len(skeleton)))


class _Comparison(NamedTuple):
    """All bones of two rigs compared.

    `scores` (b, a), minus infinity for what is no pair; `inside` (b, a), what part of the smaller one both move; and
    whether the source's (a,) and the target's bones (b,) move anything by themselves.
    """

    scores: Floats
    inside: Floats
    moving: tuple[Bools, Bools]


def _compared(
    there: csr_array,
    weights: csr_array,
    target: TriangleMesh,
    trees: tuple[Skeleton, Skeleton],
    mirrors: tuple[Ints, Ints],
) -> _Comparison:
    """Compare all bones: source and target, both as they lie in the target, and what is on the other side of each."""
    sums = [row_sums(each) for each in (there, weights)]
    areas = np.where((sums[0] > 0) & (sums[1] > 0), target.vertex_areas, 0.0)
    shares = [row_shares(each) for each in (there, weights)]
    hanging = [csr_array(tree.hanging.T, dtype=float) for tree in trees]
    subtrees = [csr_array(each @ ends) for each, ends in zip(shares, hanging, strict=True)]
    masses, totals = ([areas @ each for each in pair] for pair in (shares, subtrees))
    common = _common(shares[1], shares[0], areas)
    own = _even(_part(common, masses[1][:, None] + masses[0] - common), mirrors)
    inside = _even(_part(common, np.minimum(masses[1][:, None], masses[0])), mirrors)
    shared = (subtrees[1].T @ (diags_array(areas) @ subtrees[0])).toarray()
    squares = [areas @ each.power(2) for each in subtrees]
    whole = _even(_part(shared, squares[1][:, None] + squares[0] - shared), mirrors)
    extent = np.ptp(target.vertices, axis=0).max()
    lengths = [np.linalg.norm(tree.axes, axis=1) for tree in trees]
    reach = np.maximum((lengths[1][:, None] + lengths[0]) / 2, 0.01 * extent)
    apart = np.linalg.norm(trees[1].heads[:, None] - trees[0].heads, axis=2)
    place = _even(np.exp(-((apart / reach) ** 2)), mirrors)
    scores = _SHARES["subtree"] * whole + _SHARES["own"] * own + _SHARES["place"] * place
    scores[(inside < _LEAST_INSIDE) & (whole < _LEAST_WHOLE)] = -np.inf
    # Two bones that move nothing by themselves, but something hangs on them: roots.
    near = np.exp(-((apart / (_ROOT_REACH * extent)) ** 2))
    roots = _SHARES["subtree"] * whole + (1 - _SHARES["subtree"]) * near
    moving = masses[0] > 0, masses[1] > 0
    idle = [~mover & (total > 0) for mover, total in zip(moving, totals, strict=True)]
    both_idle = idle[1][:, None] & idle[0] & (near >= _LEAST_PLACE)
    return _Comparison(np.where(both_idle, roots, scores), inside, moving)


def _even(values: Floats, mirrors: tuple[Ints, Ints]) -> Floats:
    """Average values of pairs (b, a) with those of the same pairs on the other side: a map is not as sure of both."""
    result = values.copy()
    mine, other = (np.flatnonzero(each >= 0) for each in mirrors)
    images = values[np.ix_(mirrors[1][other], mirrors[0][mine])]
    result[np.ix_(other, mine)] = (values[np.ix_(other, mine)] + images) / 2
    return result


def _part(some: Floats, of: Floats) -> Floats:
    """Divide, and make it zero where there is nothing."""
    return np.divide(some, of, out=np.zeros_like(some), where=of > 0)


def _common(one: csr_array, other: csr_array, areas: Floats) -> Floats:
    """Area that columns of weights (n, b) and (n, a) have in common, as soft sets: the lesser of both, (b, a)."""
    result = np.zeros(one.shape[1] * other.shape[1])
    (first, mine), (second, theirs) = _entries(one), _entries(other)
    for left in range(first.shape[1]):
        for right in range(second.shape[1]):
            values = areas * np.minimum(mine[:, left], theirs[:, right])
            result += np.bincount(first[:, left] * other.shape[1] + second[:, right], values, len(result))
    return result.reshape(one.shape[1], -1)


def _entries(weights: csr_array) -> tuple[Ints, Floats]:
    """Columns and values (n, k) of the entries of each row, filled up with zeros in the first column."""
    counts = np.diff(weights.indptr)
    rows = np.repeat(np.arange(len(counts)), counts)
    places = np.arange(weights.nnz) - np.repeat(weights.indptr[:-1], counts)
    shape = len(counts), counts.max(initial=0)
    columns, values = np.zeros(shape, np.int64), np.zeros(shape)
    columns[rows, places], values[rows, places] = weights.indices, weights.data
    return columns, values


def _gains(scores: Floats, fixed: Sequence[tuple[int, int]], alone: Sequence[int]) -> Floats:
    """Find what each pair is worth, (b, a), with those that are given and those that are forbidden."""
    gains = scores - _LEAST_SCORE
    for source, target in fixed:
        gains[target] = -np.inf
        gains[target, source] = _FIXED
    gains[list(alone)] = -np.inf
    return gains


def _chosen(gains: Floats, found: _Comparison, trees: tuple[Skeleton, Skeleton], given: dict[int, int]) -> Ints:
    """Choose the pairs, (k, 2): the target's bones look for partners, and then those of the source that have none."""
    source_bones, bones = trees
    forth = aligned(gains, bones, source_bones, found.moving[0])
    back = aligned(gains.T, source_bones, bones, found.moving[1])
    pairs = {(int(source), target) for target, source in enumerate(forth) if source >= 0}
    pairs |= {
        (source, int(target))
        for source, target in enumerate(back)
        if target >= 0 and source not in forth and int(target) not in given
    }
    kept = _without_offshoots(pairs, trees, gains, found.inside)
    kept |= {(source, target) for target, source in given.items()}
    kept = {(source, target) for source, target in kept if given.get(target, source) == source}
    return np.array(sorted(kept, key=lambda pair: (pair[1], pair[0])), np.int64).reshape(-1, 2)


def _without_offshoots(
    pairs: set[tuple[int, int]], trees: tuple[Skeleton, Skeleton], gains: Floats, inside: Floats
) -> set[tuple[int, int]]:
    """Leave out bones that share the partner of a better one, unless the chain goes on below them."""
    for side, tree in enumerate(trees):
        usual = inside / np.maximum(inside.max(axis=side, keepdims=True), TINY)
        for partner in {pair[1 - side] for pair in pairs}:
            rivals = [pair for pair in pairs if pair[1 - side] == partner]
            best = max(rivals, key=lambda pair: gains[pair[1], pair[0]])
            for pair in rivals:
                within = usual[pair[1], pair[0]] >= _SECOND_INSIDE and _in_chain(pair, best, pairs, side, tree)
                if pair != best and not within:
                    pairs = pairs - {pair}
    return pairs


def _in_chain(
    pair: tuple[int, int], best: tuple[int, int], pairs: set[tuple[int, int]], side: int, tree: Skeleton
) -> bool:
    """Tell whether a bone lies in one chain with a better one, and the chain goes on to bones of other partners."""
    one, other = pair[side], best[side]
    lower = one if other in tree.above(one) else other if one in tree.above(other) else -1
    if lower < 0:
        return False
    return any(lower in tree.above(each[side]) and each[1 - side] != pair[1 - side] for each in pairs)


def _without_misplaced(
    chosen: Ints, trees: tuple[Skeleton, Skeleton], given: set[tuple[int, int]], target: TriangleMesh
) -> Ints:
    """Leave out bones, all in the target, that would carry what hangs on them astray.

    A bone that turns around a joint at the hip is no partner for one that reaches from the back to there, though both
    carry the same leg: it would swing the hip itself.  Where that is more than what is lost without the pair, the leg
    alone turns, which turns as much.
    """
    least = _ROOT_REACH * np.ptp(target.vertices, axis=0).max()
    while len(chosen):
        parts = Segments.of(chosen[:, 0], chosen[:, 1], *trees)
        worst, excess = -1, 1.0
        for part in np.flatnonzero(parts.parents >= 0):
            below = parts.below(part)
            rows = np.concatenate([parts.rows[part], *(parts.rows[each] for each in below)])
            if len(below) != 1 or given & {(int(a), int(b)) for a, b in chosen[rows]}:
                continue
            starts, nexts = _begins(parts, part, trees), _begins(parts, below[0], trees)
            mine, other = nexts - starts
            astray, lost = float(np.linalg.norm(other - mine)), float(np.linalg.norm(mine))
            if np.linalg.norm(starts[1] - starts[0]) <= least:
                continue
            if astray > max(least, excess * lost):
                worst, excess = int(part), astray / max(lost, TINY)
        if worst < 0:
            break
        chosen = np.delete(chosen, parts.rows[worst], axis=0)
    return chosen


def _upright(rig: FittedRig, source: TriangleMesh, frames: Floats | None, *, doubtful: bool) -> Floats:
    """Find how the target stands: turned by what takes axes to axes, or by one of the frames, if that is near.

    What a doubtful map says of how it leans is not known well enough.
    """
    middle = standing(rig, source)
    known = Rotation.create_group("O").as_matrix().round()  # of a cube
    if frames is not None and len(frames):
        known = np.concatenate([known, (np.asarray(frames)[:, None] @ known).reshape(-1, 3, 3)])
    return nearest_frame(middle, known, np.pi if doubtful else _TRUNK_NEAR_AXES)


def _swung(rotations: Floats, ends: tuple[Ints, Ints], trees: tuple[Skeleton, Skeleton]) -> Floats:
    """Swing rotations (k, 3, 3) of the pairs: about the bones as the surface is turned, along them as the joints lie.

    Where both rigs have the same two joints in a row, these tell the direction better than the map of a thin limb.
    """
    turned = rotations.copy()
    parts = Segments.of(*ends, *trees)
    for part in np.flatnonzero(parts.single):
        below = parts.below(part)
        if len(below) != 1 or not parts.single[below[0]]:
            continue
        row = parts.rows[part][0]
        ways = _begins(parts, below[0], trees) - _begins(parts, part, trees)
        start, goal = unit_vectors(np.stack([turned[row] @ ways[0], ways[1]]))
        if start @ goal > np.cos(_STRAY_DIRECTION):
            turned[row] = least_turns(start, goal) @ turned[row]
    return nearest_rotations(turned) if len(turned) else turned


def _by_joints(ends: tuple[Ints, Ints], trees: tuple[Skeleton, Skeleton], upright: Floats) -> Floats:
    """Rotations (k, 3, 3) of the pairs by their joints alone: limbs are bent against the body, but not twisted.

    Where several joints follow, a bone rests against the body as its partner does; where none follows, it does so
    against what it hangs on.
    """
    parts = Segments.of(*ends, *trees)
    turned = np.tile(upright, (len(ends[0]), 1, 1))
    for part in sorted(range(len(parts)), key=lambda part: len(parts.above(part))):
        below, above = parts.below(part), parts.parents[part]
        if len(below) == 1:
            start, goal = unit_vectors(_begins(parts, below[0], trees) - _begins(parts, part, trees))
            turned[parts.rows[part]] = least_turns(upright @ start, goal) @ upright
        elif not len(below) and above >= 0:
            turned[parts.rows[part]] = turned[parts.rows[above][0]]
    return turned


def _begins(parts: Segments, part: int, trees: tuple[Skeleton, Skeleton]) -> Floats:
    """Find where a segment begins in either rig, (2, 3)."""
    ends = zip(trees, (parts.sources, parts.targets), strict=True)
    return np.array([tree.heads[bones[part][0]] for tree, bones in ends])
