# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 4 of the paper: time against the number of matched points, flat and hierarchical.

    python -m tests.benchmarks.figure4 [--data FOLDER --pair cat0:cat1] [--limit 240] [--output build/figure4]

Without a data folder a generated body in two poses and meshings is matched.  Flat matching gets twice as many
candidates as points, and searches until it has proven the optimum or the limit (in seconds) is over; after the first
size that it cannot prove, it is not asked for larger ones.  The hierarchical method runs with its default settings.
Times are those on the clock, without the precomputation of each shape (samples and their distances), which is a column
of its own.  Written are figure4.csv and figure4.svg.
"""

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

from engine import MatchSettings, Shape, match, run
from engine.hierarchical.compared.flat import flat_candidates
from engine.hierarchical.exact.branch_and_bound import branch_and_bound_steps
from engine.hierarchical.sampled_pair import Pair
from tests.benchmarks.common import creature_pairs, data_pairs, write_rows

SIZES = "6,8,10,12,14,16,18,20,22,24,26,28,30,32,36,40,48,64,96,128,192,256,384,512"
PAIR = "cat0:cat1"
SAMPLES = 512  # for the flat method, whose descriptors are measured by them
TICKS = 6, 10, 22, 32, 64, 128, 256, 512
COLOURS = {"flat": "#c0392b", "hierarchical": "#1f5fa8"}


@dataclass(frozen=True)
class Run:
    """One point of the plot.  Of a search that was stopped, no cost is known."""

    method: str
    points: int
    candidates: int
    seconds: float
    precomputation: float
    proven: bool
    distortion: float


def flat(pair, precomputation, points, limit):
    """Match by the flat method, to the end or to the limit."""
    start = time.perf_counter()
    candidates = flat_candidates(points, SAMPLES)
    steps = branch_and_bound_steps(pair.problem(points, candidates), node_limit=10**12)
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            found, seconds = stop.value, time.perf_counter() - start
            return Run("flat", points, candidates, seconds, precomputation, found.proven, found.cost)
        if time.perf_counter() - start > limit:
            steps.close()
            seconds = time.perf_counter() - start
            return Run("flat", points, candidates, seconds, precomputation, proven=False, distortion=float("nan"))


def hierarchical(known, points):
    start = time.perf_counter()
    result = match(Shape(known.source), Shape(known.target), MatchSettings(points=points, dense=False))
    precomputation = result.seconds["geodesics"]
    seconds = time.perf_counter() - start - precomputation
    candidates = max(MatchSettings().samples, 2 * points)
    return Run("hierarchical", points, candidates, seconds, precomputation, result.coarse.proven, result.distortion)


def measured(known, sizes, limit):
    """Yield the runs, each as soon as it is done."""
    start = time.perf_counter()
    for shape in known.shapes:
        run(shape.sample_steps(SAMPLES))
    precomputation = time.perf_counter() - start
    pair = Pair(*known.shapes, MatchSettings())
    open_end = True
    for points in sizes:
        yield hierarchical(known, points)
        if open_end:
            found = flat(pair, precomputation, points, limit)
            open_end = found.proven
            yield found


def plot(runs, limit, title, path):
    """Draw the runs on logarithmic axes."""
    import matplotlib as mpl

    mpl.use("svg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
    for method, colour in COLOURS.items():
        own = [r for r in runs if r.method == method]
        label = f"{method} (hollow: optimum not proven)" if method == "flat" else method
        axes.loglog([r.points for r in own], [r.seconds for r in own], color=colour, label=label)
        filled = [colour if r.proven or method == "hierarchical" else "white" for r in own]
        axes.scatter([r.points for r in own], [r.seconds for r in own], c=filled, edgecolors=colour, zorder=3)
    axes.axhline(limit, color="#888888", linestyle="--", label=f"limit {limit:g} s")
    points = [r.points for r in runs]
    ticks = [tick for tick in TICKS if min(points) <= tick <= max(points)]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.set(title=title, xlabel="matched points", ylabel="seconds")
    axes.grid(color="#dddddd")
    axes.legend()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with .off files and their correspondence")
    parser.add_argument("--pair", default=PAIR, help="source:target (default: %(default)s)")
    parser.add_argument("--sizes", default=SIZES, help="numbers of points (default: %(default)s)")
    parser.add_argument("--limit", type=float, default=240.0, help="seconds for one flat search (default: %(default)s)")
    parser.add_argument("--output", type=Path, default=Path("build/figure4"), help="folder (default: %(default)s)")
    options = parser.parse_args()
    known = next(iter(data_pairs(options.data, options.pair) if options.data else creature_pairs()))
    runs = []
    for found in measured(known, [int(size) for size in options.sizes.split(",")], options.limit):
        runs.append(found)
        proof = "" if found.method == "hierarchical" else ", proven" if found.proven else ", NOT PROVEN"
        print(
            f"{found.method:12s} {found.points:4d} points, {found.candidates:5d} candidates: {found.seconds:7.2f} s "
            f"(and {found.precomputation:5.2f} s before), distortion {found.distortion:9.4f}{proof}",
            flush=True,
        )
    write_rows(options.output / "figure4.csv", runs)
    title = f"Time to match points of {known.name.replace(':', ' to ')}"
    plot(runs, options.limit, title, options.output / "figure4.svg")
    print(f"Written: {options.output / 'figure4.csv'} and figure4.svg")


if __name__ == "__main__":
    main()
