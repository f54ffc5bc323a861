# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact coarse search: cost, bound, proof, nodes and time, beside SciPy's solvers in the same run.

    python -m tests.benchmarks.branch_and_bound [--data FOLDER] [--pairs cat0:cat1,cat0:cat8] [--sizes 10x20,22x44]

The problems are those that the engine makes of two surfaces: a generated body in two poses, and, where FOLDER with
.off files (in any subfolders) is given, the named pairs.  Times are processor time from the distances on, building all
tables included: for the best matching, for the best two distinct ones, and, at the engine's own number of points, for
as many as it asks for.

The peers are SciPy's `milp` (HiGHS), on the linearised problem and for small sizes only, and SciPy's
`quadratic_assignment` (FAQ, and 2-opt from its result), which does not know descriptors: it gets square problems
without a linear term, and ours is run on these once more.
"""

import argparse
from pathlib import Path

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp, quadratic_assignment
from scipy.sparse import coo_array

from engine import MatchSettings, TriangleMesh, run
from engine.hierarchical.exact.branch_and_bound import distinct_matchings_steps
from engine.hierarchical.problem import MatchingProblem
from engine.hierarchical.sampled_pair import Pair
from engine.shapes.shape import Shape
from tests.benchmarks.common import read_off, timed
from tests.problems import branch_and_bound
from tests.shapes import creature

PAIRS = "cat0:cat1,cat0:cat8,michael0:michael3,tr_reg_000:tr_reg_001"
SIZES = "10x20,10x24,22x22,22x44,30x60"
RADIUS = 0.2  # of two matchings that count as distinct, in units of sqrt(area)
HYPOTHESES = MatchSettings().hypotheses
SAMPLES = 256  # that the descriptors are measured by
HIGHS_SIZES = ((6, 12), (8, 16), (10, 20))
HIGHS_SECONDS = 120
FAQ_SIZES = (10, 15, 20)


def sampled(mesh):
    shape = Shape(mesh)
    run(shape.sample_steps(SAMPLES))
    return shape


def instances(data, names):
    """Name and `Pair` of each pair of surfaces."""
    poses = [TriangleMesh(*creature(pose, resolution, turn)[:2]) for pose, resolution, turn in [(0, 18, 0), (1, 16, 1)]]
    yield "creature in two poses", Pair(*map(sampled, poses), MatchSettings())
    if data is not None:
        for name in names.split(","):
            paths = [next(data.rglob(f"{stem}.off")) for stem in name.split(":")]
            yield name, Pair(*(sampled(TriangleMesh(*read_off(path))) for path in paths), MatchSettings())


def report(name, problem):
    """Solve a problem for one, two and all matchings that the engine asks for."""
    found, seconds = timed(lambda: branch_and_bound(problem))
    two, two_seconds = timed(lambda: run(distinct_matchings_steps(problem, 2, RADIUS)))
    n, m = problem.size
    all_proven = "-"
    if n <= MatchSettings().coarse_points:
        several, seconds_for_all = timed(lambda: run(distinct_matchings_steps(problem, HYPOTHESES, RADIUS)))
        all_proven = f"{sum(matching.proven for matching in several)}/{len(several)} proven {seconds_for_all:7.2f}"
    second = (
        f"{two[1].cost:8.4f} {'proven' if two[1].proven else f'>= {two[1].lower_bound:.4f}'}" if two[1:] else "none"
    )
    print(
        f"{name:24} {n:2}x{m:<3} {found.cost:8.4f} {found.lower_bound:8.4f} {'yes' if found.proven else 'NO':3} "
        f"{found.nodes:8} {seconds:7.2f}   {second:>17} {two_seconds:7.2f}   {all_proven}",
        flush=True,
    )


def highs(problem):
    """Solve the linearised problem: one variable per choice, and one per pair of choices of each two points."""
    n, m = problem.size
    choice = np.arange(n * m).reshape(n, m)
    first, second = np.triu_indices(n, 1)
    pairs = len(first)
    pair = n * m + np.arange(pairs * m * m).reshape(pairs, m, m)
    difference = problem.source_distances[first, second][:, None, None] - problem.target_distances
    cost = np.concatenate([problem.linear.ravel(), (2 * problem.quadratic_weight * np.square(difference)).ravel()])
    upper = np.ones(len(cost))
    upper[pair[:, np.arange(m), np.arange(m)]] = 0

    def sums(groups, minus=None):
        """Rows: the sum of each group (r, s) of variables, less one variable each."""
        rows = np.repeat(np.arange(len(groups)), groups.shape[1])
        columns, values = groups.ravel(), np.ones(groups.size)
        if minus is not None:
            rows = np.append(rows, np.arange(len(groups)))
            columns, values = np.append(columns, minus.ravel()), np.append(values, -np.ones(minus.size))
        return coo_array((values, (rows, columns)), shape=(len(groups), len(cost))).tocsr()

    constraints = [
        LinearConstraint(sums(choice), 1, 1),
        LinearConstraint(sums(choice.T), 0, 1),
        LinearConstraint(sums(pair.reshape(-1, m), choice[first]), 0, 0),
        LinearConstraint(sums(pair.transpose(0, 2, 1).reshape(-1, m), choice[second]), 0, 0),
    ]
    integral = np.arange(len(cost)) < n * m
    return milp(
        cost,
        integrality=integral,
        bounds=Bounds(0, upper),
        constraints=constraints,
        options={"time_limit": HIGHS_SECONDS, "mip_rel_gap": 1e-7},
    )


def compare_with_highs(name, pair):
    for n, m in HIGHS_SIZES:
        problem = pair.problem(n, m)
        ours, seconds = timed(lambda problem=problem: branch_and_bound(problem))
        theirs, their_seconds = timed(lambda problem=problem: highs(problem))
        agree = theirs.status != 0 or abs(theirs.fun - ours.cost) < 1e-5 * ours.cost
        print(
            f"{name:24} {n:2}x{m:<3} ours {ours.cost:.4f} in {seconds:.3f} s, HiGHS {theirs.fun:.4f} in "
            f"{their_seconds:.2f} s ({theirs.message.split('.')[0]}): {their_seconds / seconds:.0f}x"
            f"{'' if agree else '  DISAGREE'}",
            flush=True,
        )


def compare_with_faq(name, pair):
    for n in FAQ_SIZES:
        given = pair.problem(n, n)
        problem = MatchingProblem(np.zeros((n, n)), given.source_distances, given.target_distances)
        x, y = problem.source_distances, problem.target_distances
        ours, seconds = timed(lambda problem=problem: branch_and_bound(problem))
        faq, faq_seconds = timed(lambda x=x, y=y: quadratic_assignment(x, y, options={"maximize": True}))
        start = np.stack([np.arange(n), faq.col_ind], axis=1)
        verdict = "proven" if ours.proven else "NOT proven"
        options = {"maximize": True, "partial_guess": start, "rng": np.random.default_rng(0)}
        swaps, swap_seconds = timed(
            lambda x=x, y=y, options=options: quadratic_assignment(x, y, method="2opt", options=options)
        )
        print(
            f"{name:24} {n:2}x{n:<3} ours {ours.cost:.4f} {verdict} in {seconds:.3f} s, "
            f"FAQ {problem.cost(faq.col_ind):.4f} in {faq_seconds:.3f} s, "
            f"then 2-opt {problem.cost(swaps.col_ind):.4f} in {swap_seconds:.3f} s more",
            flush=True,
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with .off files")
    parser.add_argument("--pairs", default=PAIRS, help=f"names of files, default {PAIRS}")
    parser.add_argument("--sizes", default=SIZES, help=f"points x candidates, default {SIZES}")
    arguments = parser.parse_args()
    sizes = [tuple(map(int, size.split("x"))) for size in arguments.sizes.split(",")]
    pairs = list(instances(arguments.data, arguments.pairs))
    print(
        f"{'pair':24} {'size':5} {'cost':>9} {'bound':>8} {'proven'} {'nodes':>6} {'seconds':>7}   "
        f"{'second answer':>17} {'seconds':>7}   best {HYPOTHESES}, seconds"
    )
    for n, m in sizes:
        for name, pair in pairs:
            report(name, pair.problem(n, m))
    print("\nHiGHS (scipy.optimize.milp)")
    for name, pair in pairs:
        compare_with_highs(name, pair)
    print("\nFAQ and 2-opt (scipy.optimize.quadratic_assignment), without descriptors")
    for name, pair in pairs:
        compare_with_faq(name, pair)


if __name__ == "__main__":
    main()
