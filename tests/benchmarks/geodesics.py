# SPDX-License-Identifier: GPL-3.0-or-later
"""Error and speed of our geodesic distances beside potpourri3d's fast marching and heat method, in one run.

    python -m tests.benchmarks.geodesics [--data FOLDER] [--sources 64]

Errors are relative to exact answers on planes and spheres, and elsewhere to our own distances on the mesh with each
triangle split into 36 (the first vertices are the same, and so is the surface).  Times are processor time per source,
the best of some runs; the setup of each solver is listed apart, and counted in the ratio of the first run.  FOLDER
holds .off files, in any subfolders.
"""

import argparse
from pathlib import Path

import numpy as np
import potpourri3d

from engine import TriangleMesh
from engine.geometry.geodesics import GeodesicSolver
from tests.benchmarks.common import read_off, timed
from tests.shapes import creature, icosphere, irregular, plane, subdivided

REPEATS = 3
REFERENCE_PARTS = 6
NAMED_FILES = ("cat0", "michael0", "gorilla0", "tr_reg_000")


class FastMarchingPeer:
    def __init__(self, vertices, triangles):
        self.solver = potpourri3d.MeshFastMarchingDistanceSolver(vertices, triangles)

    def distances(self, sources):
        return np.stack([self.solver.compute_distance([[(int(source), [])]]) for source in sources])


class HeatPeer:
    def __init__(self, vertices, triangles):
        self.solver = potpourri3d.MeshHeatMethodDistanceSolver(vertices, triangles)

    def distances(self, sources):
        return np.stack([self.solver.compute_distance(int(source)) for source in sources])


SOLVERS = {
    "ours": lambda vertices, triangles: GeodesicSolver(TriangleMesh(vertices, triangles)),
    "fast marching": FastMarchingPeer,
    "heat": HeatPeer,
}


def straight(vertices, sources):
    return np.linalg.norm(vertices[sources][:, None] - vertices, axis=2)


def great_circle(vertices, sources):
    return np.arccos(np.clip(vertices[sources] @ vertices.T, -1, 1))


def refined(vertices, triangles, sources):
    solver = GeodesicSolver(TriangleMesh(*subdivided(vertices, triangles, REFERENCE_PARTS)))
    return np.concatenate([block[:, : len(vertices)] for _, block in solver.distances_in_blocks(sources)])


def measure(name, vertices, triangles, sources, exact):
    """Print one block of the table; `exact` is (S, k) for the first k vertices, or None to measure speed only."""
    print(f"\n{name}: {len(vertices)} vertices, {len(triangles)} triangles, {len(sources)} sources")
    built = {label: timed(lambda make=make: make(vertices, triangles)) for label, make in SOLVERS.items()}
    seconds, cold, found = dict.fromkeys(SOLVERS, np.inf), {}, {}
    for _ in range(REPEATS):  # in turns, so that a busy moment of the machine meets all of them
        for label, (solver, _) in built.items():
            found[label], elapsed = timed(lambda solver=solver: solver.distances(sources))
            seconds[label] = min(seconds[label], elapsed)
            cold.setdefault(label, built[label][1] + elapsed)
    for label, (_, setup) in built.items():
        line = f"  {label:14s} setup {1e3 * setup:7.1f} ms, {1e3 * seconds[label] / len(sources):7.2f} ms a source"
        line += f", {seconds[label] / seconds['ours']:5.2f} x our time"
        line += f" ({cold[label] / cold['ours']:5.2f} x with setup)"
        if exact is not None:
            wanted = exact > 0
            error = np.abs(found[label][:, : exact.shape[1]] - exact)[wanted] / exact[wanted]
            line += f"; error mean {100 * error.mean():6.3f} %, 99th percentile {100 * np.percentile(error, 99):6.2f} %"
        print(line, flush=True)


def chosen(vertices, count):
    return np.random.default_rng(0).choice(len(vertices), min(count, len(vertices)), replace=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with .off files")
    parser.add_argument("--sources", type=int, default=64)
    arguments = parser.parse_args()

    for name, (vertices, triangles), exact in (
        ("plane, jittered", plane(70, jitter=0.35), straight),
        ("plane, irregular", irregular(*plane(45, jitter=0.35)), straight),
        ("sphere", icosphere(22), great_circle),
    ):
        sources = chosen(vertices, arguments.sources)
        measure(name, vertices, triangles, sources, exact(vertices, sources))

    meshes = [("creature", creature(1.0, 24)[:2]), ("creature, irregular", irregular(*creature(1.0, 15)[:2]))]
    if arguments.data:
        paths = sorted(path for path in arguments.data.rglob("*.off") if path.stem in NAMED_FILES)
        for path in paths or sorted(arguments.data.rglob("*.off"))[:3]:
            mesh = read_off(path)
            meshes += [(path.stem, mesh), (f"{path.stem}, irregular", irregular(*mesh, rounds=1))]
    for name, (vertices, triangles) in meshes:
        sources = chosen(vertices, arguments.sources)
        reference = refined(vertices, triangles, sources[:16])
        measure(name, vertices, triangles, sources[:16], reference)
        measure(f"{name}, speed", vertices, triangles, sources, None)
        if "irregular" not in name:
            fine = subdivided(vertices, triangles, 3)
            measure(f"{name}, each triangle split into 9", *fine, sources[:16], reference)


if __name__ == "__main__":
    main()
