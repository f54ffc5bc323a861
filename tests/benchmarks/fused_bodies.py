# SPDX-License-Identifier: GPL-3.0-or-later
"""Match bodies whose parts touch and have grown together, at other places in the source than in the target.

    python -m tests.benchmarks.fused_bodies [--first 1] [--last 24] [--voxel 0.02]

People put their hands on their hips, clasp them, fold their arms, cross their legs or close their fingers; animals put
their tails between their legs, stand close or close their mouths.  Both poses are meshed anew by Blender's voxel
remesh, so that what touches is one there and the surface within is gone.  A row holds

    handles            of both new meshes: an arm akimbo is one
    there, back        mean error of each map, and the share of places with an error of more than 15
    margin, conf., s   by how much another map was less credible, confidence, and seconds

Errors are distances x 100 over the square root of the area, from an image to where it belongs: from it straight to the
surface as it was before it was remeshed, and along that.  Places that have vanished in either mesh do not count, nor do
those within a contact beside which only the other part is left: seen from the nearest vertex of the new surface, the
nearest one of the old surface is far from the place along that.  A pair is wrong if the mean error of either map is 8
or more.
"""

import argparse
import time
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from engine import GeodesicSolver, HierMatchError, MatchSettings, Shape, Skeleton, TriangleMesh, match
from engine.geometry.handle_loops import genus
from engine.mesh.connectivity.adjacency import edge_graph
from tests.benchmarks.built_figures import by_blender
from tests.benchmarks.remeshed import FAR, PLACES, said
from tests.people import HANGING, RADII, Person, Rig, moved, person, smooth_weights
from tests.shapes import capsule_surface

WRONG = 8.0
"""Mean error from which on a map is wrong."""

NEAR = 2.0
"""Voxels from which on a place is too far from the new surface to be on it, and from an image to be where it is."""

ALONG = 3.0
"""Voxels along edges of the old surface from which on a place is not what the new surface beside it was before."""

TOUCHING = 0.012
"""How far what touches goes into one another."""

ANIMAL = {
    "hips": (None, (0.0, 0.45, 0.75), (0.0, 0.1, 0.78), (0.17, 0.16)),
    "chest": ("hips", (0.0, 0.1, 0.78), (0.0, -0.4, 0.8), (0.17, 0.2)),
    "neck": ("chest", (0.0, -0.5, 0.9), (0.0, -0.75, 1.15), (0.11, 0.09)),
    "head": ("neck", (0.0, -0.78, 1.18), (0.0, -1.2, 1.16), (0.1, 0.05)),
    "jaw": ("neck", (0.0, -0.82, 1.1), (0.0, -1.14, 0.92), (0.05, 0.035)),
    "tail1": ("hips", (0.0, 0.55, 0.78), (0.0, 0.8, 0.7), (0.06, 0.05)),
    "tail2": ("tail1", (0.0, 0.8, 0.7), (0.0, 1.05, 0.62), (0.05, 0.045)),
    "tail3": ("tail2", (0.0, 1.05, 0.62), (0.0, 1.3, 0.6), (0.045, 0.035)),
    "ear.L": ("head", (0.07, -0.78, 1.24), (0.14, -0.72, 1.4), (0.04, 0.025)),
    "ear.R": ("head", (-0.07, -0.78, 1.24), (-0.14, -0.72, 1.36), (0.04, 0.025)),
}
"""Of each bone its parent, head, tail, and radii; the legs are added for both sides."""


@dataclass(frozen=True, eq=False)
class Body:
    """A person or an animal, and the radii at both ends of its bones (b, 2)."""

    person: Person
    radii: np.ndarray


def somebody(**build):
    """Make a person; see `person`."""
    made = person(**build)
    return Body(made, np.array([RADII.get(name.split(".")[0], (0.024, 0.02)) for name in made.rig.names]))


def animal(legs=1.0, resolution=32):
    """Make a quadruped with a jaw and a tail, which looks to -y."""
    bones = dict(ANIMAL)
    for side, x in (("L", 0.14), ("R", -0.14)):
        for name, y, above in (("fore", -0.36, "chest"), ("hind", 0.38, "hips")):
            middle, low = 0.7 - 0.32 * legs, 0.7 - 0.62 * legs
            bones[f"{name}1.{side}"] = (above, (x, y, 0.7), (x, y, middle), (0.1, 0.065))
            bones[f"{name}2.{side}"] = (f"{name}1.{side}", (x, y, middle), (x, y, low), (0.06, 0.05))
            bones[f"{name}3.{side}"] = (f"{name}2.{side}", (x, y, low), (x, y - 0.09, low - 0.02), (0.05, 0.045))
    names = tuple(bones)
    parents = np.array([-1 if above is None else names.index(above) for above, *_ in bones.values()])
    heads, tails = (np.array([bone[end] for bone in bones.values()], float) for end in (1, 2))
    radii = np.array([bone[3] for bone in bones.values()])
    capsules = [(tuple(a), tuple(b), *ends) for a, b, ends in zip(heads, tails, radii, strict=True)]
    points = np.concatenate([heads, tails])
    mesh = TriangleMesh(*capsule_surface(capsules, [points.min(axis=0) - 0.3, points.max(axis=0) + 0.3], resolution))
    skeleton = Skeleton(parents, heads, tails)
    weights = smooth_weights(mesh.vertices, skeleton, radii)
    rig = Rig(names, skeleton, weights, tuple(frozenset([name]) for name in names))
    return Body(Person(mesh, rig), radii)


@dataclass(frozen=True)
class Pose:
    """What is turned, by rotation vectors, and what bones then reach for.

    Attributes
    ----------
    turned : dict
        Rotation vectors by bone.
    reaching : tuple of (bones, bone, offset)
        Chains whose last bone's tail comes to a place: that of another bone's middle, and so far from there.
    """

    turned: dict
    reaching: tuple = ()


def angles_of(body, pose):
    """Rotation vectors by bone that make a pose."""
    angles = {name: np.array(vector, float) for name, vector in pose.turned.items()}
    for chain, goal, offset in pose.reaching:
        angles |= reaching(body, angles, chain, goal, offset)
    return angles


def reaching(body, angles, chain, goal, offset):
    """Rotation vectors of a chain whose last bone's tail comes to a place beside the middle of another bone.

    It touches what is in its way, but hardly goes into it.
    """
    rig = body.person.rig
    end, other = (rig.names.index(name) for name in (chain[-1], goal))
    start = np.concatenate([angles.get(name, np.zeros(3)) for name in chain])
    moving = np.array([bool(set(above(rig, bone)) & set(chain[-2:])) for bone in range(len(rig.names))])
    near = {*chain, *(rig.names[bone] for name in chain for bone in [rig.skeleton.parents[rig.names.index(name)]])}
    fixed = ~moving & ~np.isin(rig.names, list(near))

    def tried(values):
        return angles | dict(zip(chain, values.reshape(-1, 3), strict=True))

    def cost(values):
        motion = moved(rig, {name: [vector] for name, vector in tried(values).items()})
        place = (motion.heads[0, other] + motion.tails[0, other]) / 2 + offset
        away = motion.tails[0, end] - place
        along = np.linspace(0, 1, 6)[:, None]
        points = motion.heads[0][:, None] * (1 - along) + motion.tails[0][:, None] * along
        radii = body.radii @ np.stack([1 - along[:, 0], along[:, 0]])
        gaps = np.linalg.norm(points[moving].reshape(-1, 1, 3) - points[fixed].reshape(1, -1, 3), axis=2)
        depths = radii[moving].reshape(-1, 1) + radii[fixed].reshape(1, -1) - gaps
        within = np.square((depths - TOUCHING).clip(0)).sum()
        return 100 * away @ away + 300 * within + 0.05 * np.square(values - start).sum()

    return tried(minimize(cost, start + 0.01, method="L-BFGS-B").x)


def above(rig, bone):
    """Names of a bone and those that it hangs on."""
    names = []
    while bone >= 0:
        names.append(rig.names[bone])
        bone = rig.skeleton.parents[bone]
    return names


def both(left):
    """What a side does, for both: rotation vectors or chains with their goals."""
    if isinstance(left, dict):
        right = {name.replace(".L", ".R"): (x, -y, -z) for name, (x, y, z) in left.items()}
        return left | right
    chain, goal, (x, y, z) = left
    other = tuple(name.replace(".L", ".R") for name in chain), goal.replace(".L", ".R"), (-x, y, z)
    return left, other


ARM = ("upper_arm.L", "forearm.L", "hand.L")
DOWN = both({"upper_arm.L": (0, 0.9, 0), "forearm.L": (0, 0, -0.4)})
SEATED = both({"thigh.L": (-1.4, 0, 0), "shin.L": (1.4, 0, 0)})

PEOPLE = {
    "apart": Pose(HANGING),
    "hips": Pose(DOWN, both((ARM, "hips", (0.2, -0.02, 0.02)))),
    "one-hip": Pose(DOWN, (both((ARM, "hips", (0.2, -0.02, 0.02)))[0],)),
    "clasped": Pose(DOWN, both((ARM, "hips", (0.03, -0.3, 0.1)))),
    "behind": Pose(DOWN, both((ARM, "spine1", (0.04, 0.2, 0.0)))),
    "folded": Pose(DOWN, (*both((ARM, "spine3", (-0.06, -0.2, -0.1))),)),
    "face": Pose(DOWN, both((ARM, "head", (0.09, -0.14, -0.02)))),
    "thighs": Pose(DOWN, both((ARM, "thigh.L", (0.13, -0.02, 0.1)))),
    "crossed": Pose(both({"upper_arm.L": (0, 0.6, 0)}) | {"thigh.L": (-0.12, 0.2, 0), "thigh.R": (0.08, -0.2, 0)}),
    "heels": Pose(both({"upper_arm.L": (0, 0.5, 0), "thigh.L": (0, 0.09, 0)})),
    "seated": Pose(SEATED | DOWN, both((ARM, "shin.L", (0.0, -0.05, 0.2)))),
    "fingers": Pose(
        both(
            {
                "upper_arm.L": (0, 0.4, 0),
                "index1.L": (0, 0, 0.45),
                "middle1.L": (0, 0, -0.45),
                "thumb1.L": (0, 0, 0.6),
            }
        )
    ),
}
"""Poses of people, by name."""

ANIMALS = {
    "apart": Pose({}),
    "tail": Pose({"tail1": (-1.3, 0, 0), "tail2": (-1.2, 0, 0), "tail3": (-0.5, 0, 0)}),
    "tail-side": Pose({"tail1": (0.3, 0, 0)}, ((("tail1", "tail2", "tail3"), "hind2.L", (0.03, 0.06, 0.0)),)),
    "mouth": Pose({"jaw": (-0.5, 0, 0)}),
    "legs": Pose(both({"fore1.L": (0, 0.17, 0), "hind1.L": (0, 0.17, 0)})),
    "biting": Pose({"jaw": (-0.4, 0, 0)}, ((("chest", "neck", "head"), "fore2.L", (0.02, -0.08, 0.1)),)),
    "lying": Pose(
        both({"fore1.L": (-0.9, 0, 0), "fore2.L": (2.3, 0, 0), "hind1.L": (-1.0, 0, 0), "hind2.L": (2.3, 0, 0)})
    ),
}
"""Poses of animals, by name."""

PAIRS = (
    ("hips", "apart"),
    ("apart", "clasped"),
    ("hips", "clasped"),
    ("hips", "crossed"),
    ("clasped", "crossed"),
    ("behind", "hips"),
    ("folded", "apart"),
    ("folded", "heels"),
    ("face", "thighs"),
    ("one-hip", "face"),
    ("thighs", "apart"),
    ("crossed", "apart"),
    ("heels", "hips"),
    ("seated", "apart"),
    ("seated", "clasped"),
    ("fingers", "hips"),
    ("apart", "tail"),
    ("tail", "mouth"),
    ("tail-side", "legs"),
    ("mouth", "apart"),
    ("legs", "tail"),
    ("biting", "apart"),
    ("lying", "apart"),
    ("lying", "biting"),
)
"""Poses of source and target; people first."""

BUILDS = ({}, {"girth": 1.25, "legs": 0.9}, {"arms": 1.1, "girth": 0.9})
"""How the people are built, in turn."""

LEGS = (1.0, 0.8)
"""How long the legs of the animals are, in turn."""


def bodies_of(number):
    """Body of a pair and its poses: the same person, or animal, twice."""
    poses, people = PAIRS[number], sum(name in PEOPLE and other in PEOPLE for name, other in PAIRS[:16])
    if number < people:
        return somebody(**BUILDS[number % len(BUILDS)]), [PEOPLE[name] for name in poses]
    return animal(LEGS[number % len(LEGS)]), [ANIMALS[name] for name in poses]


class Fused:
    """A pose of a body before it was remeshed, and after."""

    def __init__(self, body, pose, voxel):
        angles, made = angles_of(body, pose), body.person
        motion = moved(made.rig, {name: [vector] for name, vector in angles.items()})
        self.before = TriangleMesh(made.posed(motion)[0], made.mesh.triangles)
        self.after = by_blender(self.before.vertices, self.before.triangles, "REMESH", mode="VOXEL", voxel_size=voxel)
        self.near = NEAR * voxel
        away, self.places = cKDTree(self.after.vertices).query(self.before.vertices)
        before = cKDTree(self.before.vertices).query(self.after.vertices[self.places])[1]
        along = dijkstra(edge_graph(self.before), directed=False, limit=ALONG * voxel)[np.arange(len(before)), before]
        self.is_left = (away < self.near) & (along < ALONG * voxel)

    def errors(self, vertices, positions):
        """Distances x 100 over sqrt(area) from places (k, 3) on the new surface to vertices (k,) of the old one."""
        rows = GeodesicSolver(self.before).distances(vertices)
        tree, result = cKDTree(self.before.vertices), []
        for row, position in zip(rows, positions, strict=True):
            around = tree.query_ball_point(position, self.near) or [tree.query(position)[1]]
            straight = np.linalg.norm(self.before.vertices[around] - position, axis=1)
            result.append((straight + row[around]).min())
        return 100 * np.array(result) / np.sqrt(self.before.area)


def compared(label, source, target):
    """Match two fused poses of a body: a row to be printed, and whether either map is wrong."""
    start = time.perf_counter()
    try:
        result = match(source.after, target.after, MatchSettings(dense=True))
    except HierMatchError as error:
        return f"{label} {error}", True
    seconds = time.perf_counter() - start
    common = np.flatnonzero(source.is_left & target.is_left)
    chosen = np.random.default_rng(0).permutation(common)[:PLACES]
    maps = (source, target, result.source_to_target), (target, source, result.target_to_source)
    away = [there.errors(chosen, found.positions[here.places[chosen]]) for here, there, found in maps]
    wrong = any(e.mean() >= WRONG for e in away)
    what = "  ".join(f"{e.mean():6.2f} {(e > FAR).mean():6.1%}" for e in away)
    return said(label, what, result.quality, seconds, wrong), wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--first", type=int, default=1, help="number of the first pair (default %(default)s)")
    parser.add_argument("--last", type=int, default=len(PAIRS), help="and of the last one (default %(default)s)")
    parser.add_argument("--voxel", type=float, default=0.02, help="size; a person is 1.8 tall (default %(default)s)")
    options = parser.parse_args()
    wrong = 0
    print("pair                     handles   there         back          margin conf.      s")
    for number in range(options.first - 1, options.last):
        body, poses = bodies_of(number)
        source, target = (Fused(body, pose, options.voxel) for pose in poses)
        handles = "/".join(str(genus(Shape(fused.after).mesh)) for fused in (source, target))
        row, failed = compared(f"{number + 1:2d} {' '.join(PAIRS[number]):21s} {handles:>7s}", source, target)
        print(row, flush=True)
        wrong += failed
    print(f"{wrong} of {options.last - options.first + 1} wrong")


if __name__ == "__main__":
    main()
