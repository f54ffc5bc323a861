# SPDX-License-Identifier: GPL-3.0-or-later
"""Pair the bones of people with unlike rigs, and let them move alike: how much is right, beside going by names.

    python -m tests.benchmarks.motion [--only NAME,...] [--resolution 40]

All bodies are made here; each has a plain rig, which moves the source and tells the truth, and targets get one with
other names, another number of bones, other axes and another rest pose. Bodies are meshed anew, and matched as any.

A row holds the share of the target's bones with a counterpart that are paired right, how many are paired with one of
the other side, and the share that is right by the likeness of names; on the same body the mean distance of the vertices
from the truth in random poses, % of the height, the same if each of the target's bones is turned as is best for the
mesh, and if local rotations are copied by true names; the mean and the largest angle between upper and lower arms and
legs of source and target, in degrees; how far feet slide at most while they stand in a walk, % of the height, without
and with keeping them; and seconds of processor time for the motion of a minute at 30 poses per second.
"""

import argparse
import difflib
import time

import numpy as np
from scipy.spatial.transform import Rotation

from engine import (
    Motion,
    MotionSettings,
    fit_rig,
    local_transforms,
    match,
    pair_bones,
    posed_motion,
    reduced_keys,
    rotation_channels,
    transfer_motion,
)
from engine.geometry.procrustes import nearest_rotations
from tests.people import HANGING, at_rest_in, coarse_rig, fine_rig, moved, person, renamed, skinned, walk

LIMBS = [f"{bone}.{side}" for bone in ("upper_arm", "forearm", "thigh", "shin") for side in "LR"]
CHILD, GIANT = {"legs": 0.75, "arms": 0.85, "girth": 1.15}, {"legs": 1.3, "arms": 1.1, "girth": 1.2}
CASES = {
    "same, renamed": ({}, {}, lambda body: renamed(body.rig)),
    "same, renamed, hanging": ({}, HANGING, lambda body: renamed(body.rig)),
    "same, more bones, hanging": ({}, HANGING, fine_rig),
    "same, fewer bones": ({}, {}, coarse_rig),
    "child, renamed, hanging": (CHILD, HANGING, lambda body: renamed(body.rig)),
    "giant, more bones": (GIANT, {}, fine_rig),
}


def side(origins):
    """Return the side of the work that a bone does: -1, 0 or 1."""
    ends = {name[-2:] for name in origins}
    return 1 if ends == {".L"} else -1 if ends == {".R"} else 0


def by_names(source, target):
    """Pairs of bones by the likeness of their names, without prefixes."""
    plain = [name.split("_", 1)[-1] if name[:2] in {"X_", "Y_"} else name for name in target.names]
    found = ((difflib.get_close_matches(name, source.names, 1, 0.6), number) for number, name in enumerate(plain))
    return {number: source.names.index(names[0]) for names, number in found if names}


def right_share(source, target, pairs):
    """Share of the working bones whose partners do the same work, and number of those that do it on the other side."""
    working = [bone for bone, origins in enumerate(target.origins) if origins]
    right = [
        bone
        for bone in working
        if pairs.get(bone) and all(source.origins[a] & target.origins[bone] for a in pairs[bone])
    ]
    crossed = [b for b, found in pairs.items() for a in found if side(source.origins[a]) * side(target.origins[b]) < 0]
    return len(right) / len(working), len(crossed)


def copied(motion, target, pairs):
    """Motion of a target whose bones copy the local rotations of their partners, in axes of any roll."""
    axes = [
        Rotation.random(len(tree), random_state=seed).as_matrix()
        for seed, tree in enumerate((motion.skeleton, target.skeleton))
    ]
    local = local_transforms(motion, axes[0])
    rest = np.tile(np.eye(4), (len(target.names), 1, 1))
    rest[:, :3, :3], rest[:, :3, 3] = axes[1], target.skeleton.heads
    basis = np.tile(np.eye(4), (len(motion), len(target.names), 1, 1))
    for bone, found in pairs.items():
        basis[:, bone, :3, :3] = local.rotations[:, found[0]]
        if target.skeleton.parents[bone] < 0:
            basis[:, bone, :3, 3] = local.locations[:, found[0]]
    return posed_motion(target.skeleton, rest, basis)


def turned_best(motion, target, vertices, truth, rounds=6):
    """Motion of a target whose bones are turned so that its vertices come as near to the true ones as they can."""
    turns, heads, weights = motion.turns.copy(), motion.heads.copy(), target.weights.toarray()
    tree = target.skeleton
    below = np.eye(len(tree), dtype=bool)
    for bone in tree.order[::-1]:
        if tree.parents[bone] >= 0:
            below[tree.parents[bone]] |= below[bone]
    for frame, goal in enumerate(truth):
        for bone in np.tile(tree.order, rounds):
            joint, hung = heads[frame, bone], below[bone]
            places = np.einsum("bij,nbj->nbi", turns[frame], vertices[:, None] - tree.heads) + heads[frame]
            held = np.einsum("nb,nbi->ni", weights[:, ~hung], places[:, ~hung])
            share = weights[:, hung].sum(axis=1)[:, None]
            swung = np.einsum("nb,nbi->ni", weights[:, hung], places[:, hung]) - share * joint
            turn = nearest_rotations(((goal - held - share * joint).T @ swung)[None])[0]
            turns[frame, hung] = turn @ turns[frame, hung]
            heads[frame, hung] = joint + (heads[frame, hung] - joint) @ turn.T
    return Motion(tree, turns, heads)


def direction_errors(motion, source, found, target):
    """Angles between the limbs of source and target, (f, limbs), in degrees."""
    angles = []
    for limb in LIMBS:
        bone = source.names.index(limb)
        chain = [number for number, origins in enumerate(target.origins) if origins == frozenset([limb])]
        chain = [number for number in target.skeleton.order if number in chain and "twist" not in target.names[number]]
        ways = motion.tails[:, bone] - motion.heads[:, bone], found.tails[:, chain[-1]] - found.heads[:, chain[0]]
        cosine = (ways[0] * ways[1]).sum(axis=1) / np.linalg.norm(ways[0], axis=1) / np.linalg.norm(ways[1], axis=1)
        angles.append(np.degrees(np.arccos(cosine.clip(-1, 1))))
    return np.array(angles).T


def slide(found, target, standing):
    """How far feet move at most while they stand."""
    toes = {}
    for letter in "LR":
        (toes[letter],) = [b for b, origins in enumerate(target.origins) if f"toe.{letter}" in origins]
    ends = found.tails if len(target.origins[toes["L"]]) > 1 else found.heads
    most = 0.0
    for letter, bone in toes.items():
        on = np.concatenate([[0], (standing == letter).astype(int), [0]])
        for begin, end in zip(np.flatnonzero(np.diff(on) > 0), np.flatnonzero(np.diff(on) < 0), strict=True):
            if end - begin > 3:
                most = max(most, np.linalg.norm(np.ptp(ends[begin:end, bone], axis=0)))
    return most


def minute(pairing, source, target):
    """Seconds of processor time for the motion of a minute."""
    motion, _ = walk(source, 1800, 30)
    begin = time.process_time()
    found = transfer_motion(motion, pairing, target.skeleton, MotionSettings(feet=True, rate=30))
    local = local_transforms(found.motion, np.tile(np.eye(3), (len(target.names), 1, 1)))
    for bone in np.flatnonzero(found.moved):
        reduced_keys(np.arange(1800.0), rotation_channels(local.rotations[:, bone], "QUATERNION"), 0.002)
    return time.process_time() - begin


def row(name, resolution):
    """Return the numbers of one case."""
    build, rest, make = CASES[name]
    source = person(resolution)
    upright = person(resolution - 3, turn=0.4, **build)
    body = at_rest_in(upright, rest)
    target = make(body)
    result = match(source.mesh, body.mesh)
    maps = result.source_to_target, result.target_to_source
    fitted = fit_rig(source.mesh, body.mesh, *maps, weights=source.rig.weights, skeleton=source.rig.skeleton)
    pairing = pair_bones(fitted, source.mesh, body.mesh, target.skeleton, target.weights)
    pairs = {int(b): pairing.sources[pairing.targets == b].tolist() for b in np.unique(pairing.targets)}
    share, crossed = right_share(source.rig, target, pairs)
    named, _ = right_share(source.rig, target, {b: [a] for b, a in by_names(source.rig, target).items()})
    random = np.random.default_rng(3)
    angles = {bone: 0.35 * random.normal(size=(10, 3)) for bone in source.rig.names}
    motion = moved(source.rig, angles, 0.3 * random.normal(size=(10, 3)))
    found = transfer_motion(motion, pairing, target.skeleton)
    vertices = least = wrong = np.nan
    if not build:
        true = upright.posed(Motion(upright.rig.skeleton, motion.turns, motion.heads))
        truly = {
            b: [next(a for a, o in enumerate(source.rig.origins) if o & origins)]
            for b, origins in enumerate(target.origins)
            if origins
        }
        best = turned_best(found.motion, target, body.mesh.vertices, true)
        vertices, least, wrong = (
            100 * np.linalg.norm(skinned(body.mesh.vertices, target, each) - true, axis=2).mean() / upright.height
            for each in (found.motion, best, copied(motion, target, truly))
        )
    bends = direction_errors(motion, source.rig, found.motion, target)
    walking, standing = walk(source)
    slides = [
        100
        * slide(transfer_motion(walking, pairing, target.skeleton, MotionSettings(feet=feet)).motion, target, standing)
        / upright.height
        for feet in (False, True)
    ]
    took = minute(pairing, source, target)
    return (
        f"{name:28} {100 * share:6.1f} {crossed:3d} {100 * named:6.1f}  {vertices:6.2f} {least:6.2f} {wrong:6.2f}  "
        f"{bends.mean():5.1f} {bends.max():5.1f}  {slides[0]:5.2f} {slides[1]:5.2f}  {took:5.1f}"
    )


def main():
    """Print a row for each case."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="names of cases, separated by semicolons")
    parser.add_argument("--resolution", type=int, default=40, help="cells of the meshing grid per meter")
    arguments = parser.parse_args()
    print("case                          right  LR  names  vertex  least copied   bend   max  slide  held  seconds")
    for name in arguments.only.split(";") if arguments.only else CASES:
        print(row(name, arguments.resolution), flush=True)


if __name__ == "__main__":
    main()
