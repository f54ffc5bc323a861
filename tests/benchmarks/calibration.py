# SPDX-License-Identifier: GPL-3.0-or-later
"""How often matches are right that say they are: fit the probabilities of `engine.dense.credibility`, and plot them.

    python -m tests.benchmarks.calibration --data FOLDER [--alike 10] [--mixed 4] [--unlike 8] [--seed 5]
    python -m tests.benchmarks.calibration --rows build/calibration/calibration.csv

FOLDER is described in `known_shapes`.  Matched are random pairs of one kind, gorillas with men, and animals with
people.  A match is wrong if more than three hundredths of the places are lost (`known_shapes.LOST`); of an animal and a
person no match is right.  Printed are, with the constants of today beside them,

- the logistic function of the likeness for the probability that a match is right, by Platt's method, whose targets are
  not quite 0 and 1, so that the fit is finite where right and wrong matches do not overlap;
- its Brier score and that of today's, and a table of how often matches are right, by what was promised;
- for the right matches, mean confidence of the places without that of the map as a whole, and the part of them that is
  within three hundredths of sqrt(area) of the truth, from which the closeness is fitted;
- mean confidence of the places as it is, and the same part, of all matches.

Written are calibration.csv, the rows, which --rows reads instead of matching, and calibration.svg.
"""

import argparse
import csv
import time
from dataclasses import dataclass, fields
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit, logit, xlogy

from engine import HierMatchError, MatchSettings, match
from engine.dense import credibility
from tests.benchmarks.common import write_rows
from tests.benchmarks.known_shapes import LOST, KnownShapes

WRONG = 0.03
NEAR = 3.0  # error that confidence promises
BINS = 0.0, 0.05, 0.5, 0.9, 0.99, 1.0
PEOPLE, ANIMALS = ("michael", "tr_reg"), ("cat", "dog", "wolf")
NAN = float("nan")


@dataclass(frozen=True)
class Row:
    """A match: what it says of itself, and how much of it is true."""

    source: str
    target: str
    right: bool
    likeness: float
    margin: float
    orientation: float
    confidence: float  # of the match
    local: float  # mean confidence of the places, without that of the map as a whole
    near: float  # part of the places that is near the truth; NaN if there is none
    lost: float
    seconds: float
    in_place: float

    @property
    def credible(self):
        """What is known of the map as a whole."""
        return credibility.vertex_credibility(
            self.orientation, None if np.isnan(self.margin) else self.margin, self.likeness, self.in_place
        )


def drawn_pairs(shapes, options):
    """Names of source and target, and whether they show one kind."""
    random = np.random.default_rng(options.seed)
    found = [(*pair, True) for pair in shapes.random_pairs(options.alike, options.seed)]
    men, gorillas = ([name for name in shapes.of_kind("8") if kind in name] for kind in ("man", "gorilla"))
    mixed = [pair for man in men for gorilla in gorillas for pair in ((man, gorilla), (gorilla, man))]
    found += [(*mixed[i], True) for i in random.permutation(len(mixed))[: options.mixed]]
    people, animals = ([name for kind in kinds for name in shapes.of_kind(kind)] for kinds in (PEOPLE, ANIMALS))
    for _ in range(options.unlike):
        pair = random.choice(people), random.choice(animals)
        found.append((*random.permutation(pair), False))
    return found


def measured(shapes, first, second, *, one_kind):
    """Match two shapes; None if they cannot be matched."""
    source, target = shapes.read(first), shapes.read(second)
    start = time.perf_counter()
    try:
        result = match(source.mesh, target.mesh, MatchSettings(dense=True))
    except HierMatchError:
        return None
    seconds, quality, there = time.perf_counter() - start, result.quality, result.source_to_target
    near, lost = (NAN, 1.0)
    if one_kind:
        errors = target.vertex_errors(there.nearest_vertices[source.samples])
        near, lost = float((errors < NEAR).mean()), float((errors > LOST).mean())
    whole = credibility.vertex_credibility(quality.orientation, quality.margin, quality.likeness, quality.in_place)
    local = float(there.confidence[source.samples].mean()) / whole
    margin = NAN if quality.margin is None else quality.margin
    said = quality.likeness, margin, quality.orientation, quality.confidence
    return Row(first, second, lost <= WRONG, *said, local, near, lost, seconds, quality.in_place)


def platt(likeness, right):
    """Centre and spread of the logistic function that fits best."""
    count = right.sum(), (~right).sum()
    wanted = np.where(right, (count[0] + 1) / (count[0] + 2), 1 / (count[1] + 2))

    def cost(values):
        promised = expit((likeness - values[0]) / np.exp(values[1]))
        return -(xlogy(wanted, promised + 1e-300) + xlogy(1 - wanted, 1 - promised + 1e-300)).sum()

    best = minimize(cost, (np.median(likeness), 0.0), method="Nelder-Mead").x
    return best[0], np.exp(best[1])


def fitted_closeness(rows):
    """Likeness at which half of what is beyond the least closeness is near, and spread, of right matches."""
    likeness, local, near = np.array([(r.likeness, r.local, r.near) for r in rows]).T
    least = credibility.closeness(-np.inf)

    def cost(values):
        promised = local * (least + (1 - least) * expit((likeness - values[0]) / np.exp(values[1])))
        return np.square(promised - near).sum()

    best = minimize(cost, (15.0, 0.3), method="Nelder-Mead").x
    return best[0], np.exp(best[1])


def constants_of_today():
    """Centre and spread of the logistic function of today, read off it."""
    quarter, half = credibility.EVEN - 1.0, credibility.EVEN
    return half, (half - quarter) / -logit(credibility.probability_right(quarter))


def report(rows):
    """Print what is fitted; centre and spread."""
    likeness, right = np.array([r.likeness for r in rows]), np.array([r.right for r in rows])
    centre, spread = platt(likeness, right)
    today = constants_of_today()
    print(f"{len(rows)} matches, {right.sum()} right")
    print("probability of a right match: centre, spread, Brier score")
    for name, values in (("fitted", (centre, spread)), ("today", today)):
        brier = np.square(expit((likeness - values[0]) / values[1]) - right).mean()
        print(f"  {name:8s} {values[0]:7.2f} {values[1]:6.2f} {brier:8.4f}")
    print("promised by today's      matches    right")
    promised = np.array([credibility.probability_right(value) for value in likeness])
    for low, high in pairwise(BINS):
        inside = (promised >= low) & ((promised < high) | (high == BINS[-1]))
        share = f"{right[inside].mean():8.2f}" if inside.any() else "       -"
        print(f"  {low:4.2f} to {high:4.2f}          {inside.sum():8d} {share}")
    known = [r for r in rows if r.right and np.isfinite(r.near)]
    if known:
        close = fitted_closeness(known)
        print(f"closeness of right matches: centre {close[0]:.2f}, spread {close[1]:.2f} fitted; today 15.00, 1.40")
        local, near = np.mean([(r.local, r.near) for r in known], axis=0)
        promised = np.mean([r.local * credibility.closeness(r.likeness) for r in known])
        print(f"  mean local confidence {local:.3f}, with closeness {promised:.3f}; near {near:.3f}")
    for name, part in (("right", [r for r in rows if r.right]), ("wrong", [r for r in rows if not r.right])):
        if part:
            both = np.mean([(r.local, r.local * r.credible, r.confidence) for r in part], axis=0)
            print(f"{name}: confidence of places {both[0]:.2f} by themselves, {both[1]:.2f}; of the map {both[2]:.2f}")
    return centre, spread


def plot(rows, fitted, path):
    """Draw the matches by likeness, right above and wrong below, and both functions."""
    import matplotlib as mpl

    mpl.use("svg")
    from matplotlib import pyplot as plt

    likeness = np.array([r.likeness for r in rows])
    right = np.array([r.right for r in rows], float)
    low, high = np.floor(likeness.min() - 1), np.ceil(min(likeness.max(), 32) + 1)
    figure, axes = plt.subplots(figsize=(7.2, 4.2), layout="constrained")
    values = np.linspace(low, high, 200)
    for name, colour, (centre, spread) in (("fitted", "#d55e00", fitted), ("today", "#0072b2", constants_of_today())):
        axes.plot(values, expit((values - centre) / spread), color=colour, linewidth=2, label=name)
    beside = (np.arange(len(rows)) % 5 - 2) * 0.008  # so that equal ones are seen
    colours = np.where(right > 0, "#009e73", "#cc3311")
    axes.scatter(np.minimum(likeness, high), right + beside, c=colours, alpha=0.6)
    axes.set(xlabel="likeness", ylabel="right matches", xlim=(low, high))
    axes.grid(axis="y", color="#dddddd")
    axes.legend()
    figure.savefig(path, metadata={"Date": None})


def read(path):
    with path.open(newline="") as file:
        return [
            Row(row["source"], row["target"], row["right"] == "True", *(float(row[f.name]) for f in fields(Row)[3:]))
            for row in csv.DictReader(file)
        ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with the shapes")
    parser.add_argument("--rows", type=Path, help="file of rows that were measured before")
    parser.add_argument("--alike", type=int, default=10, help="random pairs of one kind (default %(default)s)")
    parser.add_argument("--mixed", type=int, default=4, help="pairs of gorilla and man (default %(default)s)")
    parser.add_argument("--unlike", type=int, default=8, help="pairs of animal and person (default %(default)s)")
    parser.add_argument("--seed", type=int, default=5, help="of the random pairs (default %(default)s)")
    parser.add_argument("--output", type=Path, default=Path("build/calibration"), help="folder (default %(default)s)")
    options = parser.parse_args()
    if (options.data is None) == (options.rows is None):
        parser.error("give either --data or --rows")
    options.output.mkdir(parents=True, exist_ok=True)
    rows = [] if options.rows is None else read(options.rows)
    if options.data is not None:
        shapes = KnownShapes(options.data)
        for first, second, one_kind in drawn_pairs(shapes, options):
            row = measured(shapes, str(first), str(second), one_kind=one_kind)
            if row is not None:
                rows.append(row)
                write_rows(options.output / "calibration.csv", rows)
                kind = "right" if row.right else "WRONG"
                print(f"{first} -> {second}: likeness {row.likeness:.1f}, {kind}, {row.seconds:.0f} s", flush=True)
    fitted = report(rows)
    plot(rows, fitted, options.output / "calibration.svg")
    print(f"Written: {options.output / 'calibration.svg'}")


if __name__ == "__main__":
    main()
