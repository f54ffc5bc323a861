# SPDX-License-Identifier: GPL-3.0-or-later
"""Match bodies of the game MegaGlest in two poses: people in clothes, animals, a snake, birds, a dragon, machines.

    apt-get download megaglest-data && dpkg-deb -x megaglest-data_*.deb FOLDER
    python -m tests.benchmarks.game_units --data FOLDER/usr/share/games/megaglest [--jobs 2] [--only snake]

The largest part of each body that is most of it takes three poses from its animations that differ much.  Its few
triangles are split, and each pose is meshed anew with 5,000 vertices, so that no two surfaces have triangles in common,
and turned.  The first two and the last two are matched.

A row says which body and poses, then for either direction the mean distance of 300 vertices from where they belong,
over the square root of the area, times 100, and the share of them that are more than 15 away; margin and confidence,
and the seconds.  At last it is counted how many are wrong, and how many of those have a confidence of one half or more.
Of pyramids and towers several maps are right, of which one is asked for.
"""

import argparse
import itertools
from pathlib import Path

import numpy as np

from tests.benchmarks.common import each_in_its_process
from tests.benchmarks.g3d_models import areas, largest_part, read_unit
from tests.benchmarks.remeshed import compared, remeshed, unlike_poses
from tests.shapes import rotation, subdivided

POSES, LEAST_POSES, MOST = 3, 5, 0.7
DENSE, COARSE = 26_000, 5_000
CONFIDENT = 0.5


def bodies(data, only):
    """Read the bodies of all units, by name: places of the vertices in all frames (f, n, 3) and triangles (m, 3)."""
    found, known = {}, set()
    for folder in sorted(data.glob("**/factions/*/units/*")):
        name = f"{folder.parts[-3]}/{folder.name}"
        unit = read_unit(folder) if only in name else None
        if unit is None or len(unit[0]) < LEAST_POSES or (size := (unit[0].shape[1], len(unit[1]))) in known:
            continue
        known.add(size)  # many have one body with other tools
        places, triangles, share = largest_part(*unit)
        if share >= MOST:
            found[name] = places, triangles
    return found


def poses(places, triangles):
    """Take three poses (n, 3) that are unlike, of about the same size."""
    sizes = np.array([areas(frame, triangles).sum() for frame in places])
    return unlike_poses(places[np.abs(sizes / np.median(sizes) - 1) < 0.15], POSES, 50)


def meshed_anew(vertices, triangles, name, number):
    """Mesh a pose anew, turned at random."""
    random = np.random.default_rng(number)
    turn = rotation(random.standard_normal(3), random.uniform(0, 6))
    parts = max(3, int(np.ceil(np.sqrt(DENSE / len(vertices)))))
    return remeshed(*subdivided(vertices @ turn.T, triangles, parts), name, COARSE)


def measure(task):
    """Match a body's poses; for each pair return what is printed, if it is wrong, and if it is confident."""
    name, (places, triangles) = task
    meshes = [meshed_anew(pose, triangles, name, number) for number, pose in enumerate(poses(places, triangles))]
    rows = []
    for number, (source, target) in enumerate(itertools.pairwise(meshes)):
        line, wrong, row = compared(f"{name + f' {number} -> {number + 1}':36s}", source, target)
        rows.append((line, wrong, row is not None and row[2] >= CONFIDENT))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="the game's folder")
    parser.add_argument("--only", default="", help="part of the names of the bodies to match")
    parser.add_argument("--jobs", type=int, default=1, help="bodies at the same time (default 1)")
    options = parser.parse_args()
    print(f"{'':36s} {'mean far, there and back':30s} margin conf. seconds")
    count = wrong = sure = 0
    for rows in each_in_its_process(measure, bodies(options.data, options.only).items(), options.jobs):
        for line, failed, confident in rows:
            print(line, flush=True)
            count += 1
            wrong += failed
            sure += failed and confident
    print(f"{wrong} of {count} wrong, {sure} of them with a confidence of {CONFIDENT} or more")


if __name__ == "__main__":
    main()
