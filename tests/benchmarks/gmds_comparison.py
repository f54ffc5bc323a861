# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchical matching beside generalised multidimensional scaling (GMDS), against the truth, over many pairs.

    python -m tests.benchmarks.gmds_comparison --data FOLDER [--pairs cat0:cat1,dog0:dog5] [--points 64]
    python -m tests.benchmarks.gmds_comparison                   a generated body in several poses and meshings instead

FOLDER holds .off files and beside them a folder `corres` (see tests/benchmarks/real_pairs.py).

GMDS starts by itself, or from our exact coarse matching.
The error of a point is the geodesic distance on the target from its true image to its match, over the square root of
the target's area.  Where the mirror image is known too, a match is measured against the one that it is closer to, as
distances cannot tell them apart; how often that is the true one is printed beside.  Improvements are of our error
over theirs, of the mean and the maximum averaged over pairs; the paper reports 6.25 % and 26 %.
"""

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from engine import MatchSettings, SurfacePoints, match, run
from engine.hierarchical.compared.gmds import gmds_steps
from engine.shapes.surface_distances import SurfaceDistances
from tests.benchmarks.common import creature_pairs, data_pairs

PAIRS = (
    "cat0:cat1,cat0:cat2,cat0:cat8,cat1:cat5,cat3:cat10,cat7:cat0,dog0:dog1,dog0:dog5,dog2:dog8,dog3:dog0,"
    "michael0:michael1,michael0:michael3,michael0:michael6,michael2:michael14,michael19:michael8,wolf0:wolf1,wolf0:wolf2"
)
OURS, OWN, FROM_OURS = "ours", "GMDS, its own start", "GMDS, our start"


@dataclass(frozen=True)
class Outcome:
    """One method on one pair: its error, and whether it is closer to the truth than to its mirror image."""

    mean: float
    worst: float
    true_mean: float
    is_true: bool
    stress: float
    seconds: float


def outcome(truth, found, stress, seconds):
    errors = truth.errors(found)
    best = errors[errors.mean(axis=1).argmin()]
    return Outcome(best.mean(), best.max(), errors[0].mean(), bool(errors.mean(axis=1).argmin() == 0), stress, seconds)


def compare(pair, points):
    """Outcome of each method on one pair."""
    source, target = pair.shapes
    start = time.process_time()
    ours = match(source, target, MatchSettings(points=points, dense=False))
    seconds = {OURS: time.process_time() - start}
    truth = pair.truth(ours.source_points.nearest_vertices)
    results = {OURS: outcome(truth, ours.target_points, ours.quadratic, seconds[OURS])}
    coarse = SurfacePoints.at_vertices(pair.target, ours.coarse.target_vertices)
    methods = {OWN: {}, FROM_OURS: {"start": coarse}}
    for name, options in methods.items():
        start = time.process_time()
        # Distances are not handed on, so that each method's time is its own, the samples' apart.
        found = run(gmds_steps(source, target, points, distances=SurfaceDistances(target), **options))
        seconds = time.process_time() - start
        results[name] = outcome(truth, found.target_points, found.quadratic, seconds)
    return results


def report(name, results):
    for method, found in results.items():
        side = "true" if found.is_true else "mirrored"
        print(
            f"{name:24s} {method:22s} mean {found.mean:.4f}  max {found.worst:.4f}  {side:8s}  "
            f"stress {found.stress:8.3f}  {found.seconds:5.1f} s",
            flush=True,
        )


def summary(outcomes):
    print(f"\n{len(outcomes[OURS])} pairs; errors x sqrt(area), averaged over pairs")
    means = {
        name: np.array([[o.mean, o.worst, o.true_mean, o.is_true] for o in rows]) for name, rows in outcomes.items()
    }
    ours = means[OURS]
    for name, rows in means.items():
        mean, worst, true_mean, is_true = rows.mean(axis=0)
        line = f"{name:22s} mean {mean:.4f}  max {worst:.4f}  closer to the truth {is_true:4.0%}"
        line += f", mean to it {true_mean:.4f}"
        if name != OURS:
            better = 1 - ours[:, :2].mean(axis=0) / (mean, worst)
            line += f"   ours better by {better[0]:6.1%} (mean), {better[1]:6.1%} (max)"
            line += f", on {(ours[:, 0] < rows[:, 0]).sum()} and {(ours[:, 1] < rows[:, 1]).sum()} pairs"
        print(line)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with the shapes")
    parser.add_argument("--pairs", default=PAIRS, help="source:target, separated by commas (default: %(default)s)")
    parser.add_argument("--points", type=int, default=64)
    options = parser.parse_args()
    outcomes = {}
    for pair in data_pairs(options.data, options.pairs) if options.data else creature_pairs():
        results = compare(pair, options.points)
        report(pair.name, results)
        for name, found in results.items():
            outcomes.setdefault(name, []).append(found)
    summary(outcomes)


if __name__ == "__main__":
    main()
