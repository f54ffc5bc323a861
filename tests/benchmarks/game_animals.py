# SPDX-License-Identifier: GPL-3.0-or-later
"""Match animals of the game 0 A.D. in different poses: the same in two of them, or two of different kinds.

    apt-get download 0ad-data && dpkg-deb -x 0ad-data_*.deb FOLDER
    python -m tests.benchmarks.game_animals --archive FOLDER/usr/share/games/0ad/mods/public/public.zip
        [--pairs 60] [--seed 1] [--jobs 2] [--long]

Each animal takes up to five poses from its animations that differ much.  Its few triangles are split, and each pose is
meshed anew with 5,000 vertices, so that no two surfaces have triangles in common, and turned.

Pairs of the same animal are measured by the true correspondence: the mean distance from there, over the square root of
the area, times 100, at 300 vertices, and the share of them that are more than 15 away. For pairs of different animals
it is said to which end each end of the one goes, from either side: 0 and 1 the fore feet, 2 and 3 the hind feet, 4 the
head; 01234 is right. With --long, sharks, fin whales and crocodiles are matched instead, each in all pairs of its
poses: bodies that may come to lie on their backs. Margin and confidence are what the match says of itself. At last it
is counted how many are wrong, and how many of those have a confidence of one half or more.
"""

import argparse
import itertools
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from engine import HierMatchError, MatchSettings, TriangleMesh, match
from engine.geometry.geodesics import GeodesicSolver
from tests.benchmarks.common import each_in_its_process
from tests.benchmarks.game_models import Archive
from tests.benchmarks.remeshed import Remeshed, compared, remeshed, said, unlike_poses
from tests.shapes import rotation, subdivided

# Model: how the names of its animations start, and its kind.  All look along -z at rest, but the sheep.
ANIMALS = {
    "animal_lion": ("lion", "cat"),
    "animal_lioness": ("lion", "cat"),
    "bear": ("bear", "bear"),
    "bear_polar": ("bear", "bear"),
    "camel": ("camel", "camel"),
    "elephant_african_baby": ("elephant_infant", "elephant"),
    "giraffe_adult": ("giraffe_adult", "giraffe"),
    "horse": ("horse", "horse"),
    "pony": ("horse", "horse"),
    "horse_persian": ("horse", "horse"),
    "rhino": ("rhino", "rhino"),
    "donkey": ("donkey", "donkey"),
    "sheep": ("sheep", "sheep"),
    "deer_mesh": ("deer", "deer"),
    "wolf": ("wolf_", "dog"),
    "zebra": ("zebra", "zebra"),
    "mastiff_no_spikes": ("mastiff", "dog"),
    "wolfhound": ("wolfhound", "dog"),
    "goat": ("goat", "goat"),
    "animal_boar": ("animal_boar", "pig"),
    "fauna_hippopotamus": ("hippopotamus", "hippopotamus"),
    "animal_piglet": ("animal_piglet", "pig"),
    "wildebeest_adult": ("wildebeest", "cow"),
    "zebu": ("zebu", "cow"),
    "sanga_cattle_a": ("sanga", "cow"),
    "cattle_male_a": ("cattle", "cow"),
    "auroch_a": ("auroch", "cow"),
    "tiger": ("tiger", "cat"),
}
LOOKS_BACK = {"sheep"}
# Long bodies: where their animations are.
LONG = {
    "shark": "art/animation/other",
    "whale_fin": "art/animation/other",
    "Croc": "art/animation/quadraped",
}
POSES, FRAMES = 5, 6
DENSE, COARSE = 26_000, 5_000
ENDS = 5
CONFIDENT = 0.5


@dataclass(frozen=True)
class Animal(Remeshed):
    """A pose, and the number of the end that each vertex belongs to, or -1, (n,)."""

    ends: np.ndarray


@cache
def poses(archive, name):
    """Vertices of up to five poses that are unlike."""
    model = archive.model(name)
    animations = archive.animations(name, LONG[name]) if name in LONG else archive.animations(ANIMALS[name][0])
    frames = [archive.frames(a, len(model.bones), FRAMES) for a in animations]
    rest = TriangleMesh(model.vertices, model.triangles)
    found = [model.posed(frame) for each in frames for frame in each]
    found = [
        p for p in found if np.isfinite(p).all() and 0.8 < TriangleMesh(p, model.triangles).area / rest.area < 1.25
    ]
    if not found:
        return [model.vertices]
    return unlike_poses(np.array(found), POSES, 60)


def ends(vertices, *, backwards):
    """Numbers of the end that each vertex at rest belongs to, or -1, (n,)."""
    low, size = vertices.min(axis=0), np.ptp(vertices, axis=0)
    x, y, z = ((vertices - [0, low[1], low[2]]) / [np.abs(vertices[:, 0]).max(), size[1], size[2]]).T
    if backwards:
        x, z = -x, 1 - z
    feet = (y < 0.06) & (np.abs(x) > 0.12)
    middle = (z[feet].min() + z[feet].max()) / 2
    found = np.where(feet, (x > 0) + 2 * (z > middle), -1)
    found[z < 0.05] = 4
    return found


@cache
def animal(archive, name, pose):
    """Mesh a pose anew, turned at random; without the ends if the body is long."""
    model = archive.model(name)
    parts = max(3, int(np.ceil(np.sqrt(DENSE / len(model.vertices)))))
    random = np.random.default_rng(pose)
    turn = rotation(random.standard_normal(3), random.uniform(0, 2 * np.pi))
    vertices, triangles = subdivided(poses(archive, name)[pose] @ turn.T, model.triangles, parts)
    found = remeshed(vertices, triangles, name, COARSE)
    if name in LONG:
        return found
    rest, _ = subdivided(model.vertices, model.triangles, parts)
    all_ends = ends(rest, backwards=name in LOOKS_BACK)
    return Animal(found.mesh, found.model, found.places, all_ends[found.model])


def reached(source, target, found):
    """Number of the end that most of each end of the source goes to, or is nearest to, as a word."""
    solver = GeodesicSolver(target.mesh)
    away = np.array([solver.distances(np.flatnonzero(target.ends == end)).min(axis=0) for end in range(ENDS)])
    nearest = away.argmin(axis=0)[found.nearest_vertices]
    return "".join(str(np.bincount(nearest[source.ends == end], minlength=ENDS).argmax()) for end in range(ENDS))


def measure(task):
    """Match two animals; return how they are called, what is printed of the match, if it is wrong, and confidence."""
    archive, (first, second) = task
    source, target = animal(archive, *first), animal(archive, *second)
    label = f"{f'{first[0]} {first[1]} -> {second[0]} {second[1]}':48s}"
    if first[0] == second[0]:
        line, wrong, row = compared(label, source, target)
        return line, wrong, row[2] if row else 0.0
    start = time.perf_counter()
    try:
        result = match(source.mesh, target.mesh, MatchSettings(dense=True))
    except HierMatchError as error:
        return f"{label} {error}", True, 0.0
    seconds = time.perf_counter() - start
    words = [reached(source, target, result.source_to_target), reached(target, source, result.target_to_source)]
    wrong = any(word != "01234" for word in words)
    return said(label, " ".join(words), result.quality, seconds, wrong), wrong, result.quality.confidence


def long_pairs(archive):
    """All pairs of poses of each long body, ((name, pose), (name, pose))."""
    pairs = [
        ((name, i), (name, j)) for name in LONG for i, j in itertools.combinations(range(len(poses(archive, name))), 2)
    ]
    return {"one long body in two poses": pairs}


def drawn_pairs(archive, count, seed):
    """Random pairs of one animal in two poses, and of two animals of different kinds, ((name, pose), (name, pose))."""
    random = np.random.default_rng(seed)
    counts = {name: len(poses(archive, name)) for name in ANIMALS}
    several = [name for name in ANIMALS if counts[name] > 1]
    same, unlike = [], []
    while len(same) < count:
        name = several[random.integers(len(several))]
        same.append(tuple((name, int(pose)) for pose in random.permutation(counts[name])[:2]))
    names = list(ANIMALS)
    while len(unlike) < count:
        pair = [names[i] for i in random.permutation(len(names))[:2]]
        if ANIMALS[pair[0]][1] != ANIMALS[pair[1]][1]:
            unlike.append(tuple((name, int(random.integers(counts[name]))) for name in pair))
    return {"one animal in two poses": same, "two kinds of animals": unlike}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--archive", type=Path, required=True, help="the game's public.zip")
    parser.add_argument("--pairs", type=int, default=60, help="of one animal, and of two (default 60 each)")
    parser.add_argument("--seed", type=int, default=1, help="of the random pairs (default 1)")
    parser.add_argument("--long", action="store_true", help="match long bodies, all pairs of their poses")
    parser.add_argument("--jobs", type=int, default=1, help="pairs matched at the same time (default 1)")
    options = parser.parse_args()
    archive = Archive(options.archive)
    drawn = long_pairs(archive) if options.long else drawn_pairs(archive, options.pairs, options.seed)
    for title, pairs in drawn.items():
        print(f"{title:48s} {'':30s} margin conf. seconds")
        wrong, sure = 0, 0
        tasks = [(archive, pair) for pair in pairs]
        for line, failed, confidence in each_in_its_process(measure, tasks, options.jobs):
            print(line, flush=True)
            wrong += failed
            sure += failed and confidence >= CONFIDENT
        print(f"{wrong} of {len(pairs)} wrong, {sure} of them with a confidence of {CONFIDENT} or more\n", flush=True)


if __name__ == "__main__":
    main()
