# SPDX-License-Identifier: GPL-3.0-or-later
"""Growth of time and memory with vertices, points, targets and jobs of a batch.

    python -m tests.benchmarks.cost_growth [--only vertices,points,targets,jobs] [--vertices 1000,...,1000000]
                                           [--output build/cost_growth]

The shapes are a body in two poses, each meshed on its own, with edges split until it has enough vertices.  A row holds

    seconds   of the whole work, on the clock, in a process of its own
    peak      the largest resident memory of that process and of its helpers, in megabytes; of jobs, of the largest

What is measured: one match with growing vertices; one with growing numbers of matched points; one source, prepared
once, with growing numbers of targets; and eight pairs by growing numbers of processes with one core each, as
`blender --command hiermatch batch --jobs` matches them; all but the first with 5,000 vertices.  Written are
cost_growth.csv and cost_growth.svg.
"""

import argparse
import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from engine import KnownShapes, MatchSettings, TriangleMesh, match, use_processes
from tests.benchmarks.common import write_rows
from tests.benchmarks.dense_scale import peak, peak_of_helpers
from tests.shapes import creature, subdivided

VERTICES = "1000,2000,5000,10000,20000,50000,100000,200000,500000,1000000"
GROWING = {"points": (16, 32, 64, 128, 256), "targets": (1, 2, 4, 8), "jobs": (1, 2, 4)}
USUAL, PAIRS = 5000, 8
SPAWN = multiprocessing.get_context("spawn")
PER_UNIT = 3000 / 18**2
"""Vertices of the body, by the square of the cells of its grid per unit of length."""
FINEST = 30
"""Cells per unit of length up to which it is meshed anew; beyond, edges are split."""


@dataclass(frozen=True)
class Cost:
    """One point of a plot."""

    of: str
    size: int
    seconds: float
    peak: float


def body(count, pose, turn):
    """The body in a pose, with about so many vertices."""
    resolution = (count / PER_UNIT) ** 0.5
    parts = max(1, round(resolution / FINEST))
    vertices, triangles, _ = creature(pose, resolution / parts, turn)
    return TriangleMesh(*subdivided(vertices, triangles, parts) if parts > 1 else (vertices, triangles))


def one_pair(number):
    """Match a pair with one core, as a job of a batch."""
    use_processes(1)
    match(body(USUAL, 0.0, 0.0), body(USUAL, 0.5 + number / 100, 0.7))
    return peak()


def measured(of, size):
    """Measure one row, alone in this process."""
    if of == "jobs":
        start = time.perf_counter()
        with ProcessPoolExecutor(size, SPAWN) as pool:
            peaks = list(pool.map(one_pair, range(PAIRS)))
        return Cost(of, size, time.perf_counter() - start, max(peaks))
    count = size if of == "vertices" else USUAL
    source = body(count, 0.0, 0.0)
    targets = [body(count, 0.5 + number / 100, 0.7) for number in range(size if of == "targets" else 1)]
    settings = MatchSettings(points=size) if of == "points" else MatchSettings()
    start = time.perf_counter()
    known = KnownShapes()
    for target in targets:
        match(source, target, settings, known=known)
    seconds = time.perf_counter() - start
    return Cost(of, size, seconds, max(peak(), peak_of_helpers()))


def plot(costs, path):
    """Draw seconds and megabytes against what grows, one plot each, on logarithmic axes."""
    import matplotlib as mpl

    mpl.use("svg")
    from matplotlib import pyplot as plt

    kinds = list(dict.fromkeys(cost.of for cost in costs))
    powers = np.log10([cost.seconds for cost in costs])
    decades = 10 ** np.floor(powers.min()), 10 ** np.ceil(powers.max())
    figure, plots = plt.subplots(1, len(kinds), figsize=(4 * len(kinds), 3.5), layout="constrained", squeeze=False)
    for kind, axes in zip(kinds, plots[0], strict=True):
        own = [cost for cost in costs if cost.of == kind]
        sizes = [cost.size for cost in own]
        memory = axes.twinx()
        axes.loglog(sizes, [cost.seconds for cost in own], "o-", color="#0072b2")
        memory.loglog(sizes, [cost.peak for cost in own], "s--", color="#d55e00")
        axes.set_ylim(*decades)
        axes.set_xlabel(kind)
        axes.set_ylabel("seconds", color="#0072b2")
        memory.set_ylabel("peak memory in MB", color="#d55e00")
        memory.set_ylim(100, 10_000)
        axes.grid(color="#dddddd")
        if len(sizes) < 6:
            axes.set_xticks(sizes, [str(size) for size in sizes])
            axes.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="vertices,points,targets,jobs", help="what grows (default: %(default)s)")
    parser.add_argument("--vertices", default=VERTICES, help="numbers of vertices (default: %(default)s)")
    parser.add_argument("--output", type=Path, default=Path("build/cost_growth"), help="folder (default: %(default)s)")
    options = parser.parse_args()
    growing = {"vertices": [int(count) for count in options.vertices.split(",")], **GROWING}
    costs = []
    for of in options.only.split(","):
        for size in growing[of]:
            # A new process for each: its peak is of this work alone.
            with ProcessPoolExecutor(1, SPAWN) as pool:
                cost = pool.submit(measured, of, size).result()
            costs.append(cost)
            print(f"{of:9s} {cost.size:8d} {cost.seconds:8.1f} s {cost.peak:7.0f} MB", flush=True)
    write_rows(options.output / "cost_growth.csv", costs)
    plot(costs, options.output / "cost_growth.svg")
    print(f"Written: {options.output / 'cost_growth.csv'} and cost_growth.svg")


if __name__ == "__main__":
    main()
