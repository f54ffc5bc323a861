# SPDX-License-Identifier: GPL-3.0-or-later
"""Match pairs of real shapes with known correspondence at every vertex, and say how good the maps are.

    python -m tests.benchmarks.dense_pairs --data FOLDER [--pairs cat0:cat1,dog0:dog5] [--peer pyfm]
    python -m tests.benchmarks.dense_pairs --data FOLDER --random 150 --seed 1 --jobs 2 --csv rows.csv
    python -m tests.benchmarks.dense_pairs --data FOLDER --variant all

FOLDER and the error of a map are described in `known_shapes`.  A row of the table holds

    direct    mean error of source_to_target, rounded to vertices, against the true correspondence
    symm.     the better of that and the mean error against the mirrored correspondence: far smaller if left is right
    p95       95th percentile of the errors behind `direct`
    inside    mean error of source_to_target as it is, points inside triangles
    reverse   mean error of target_to_source, rounded to vertices
    margin, conf., orient.   what the match says of itself: result.quality.margin, .confidence and .orientation
    trust     rank correlation of the errors behind `inside` with the confidence of the map there; useful if far below 0
    over      mean confidence of the samples, less the part of them that lies within 3: how much is promised too much
    stretch   root mean squared edge stretch of source_to_target; the second such column is of target_to_source
    flipped   share of the source's area whose image is turned over; again the second of target_to_source
    seconds   from two meshes to both maps, with nothing computed before
    FLIP      "whole", "limb" (a connected patch of more than 3 % of the area exchanged with its mirror image) or "lost"
              (such a patch, but elsewhere); the exact conditions are those of `known_shapes.MapScore`

and, with --peer, the same errors and times of pyfmaps on the same pair in the same process (wave kernel signatures,
orientation term and ZoomOut up to 150 functions, as its documentation recommends).  Then follow mean and worst row of
each dataset, and the rank correlation of the confidence with the error over all pairs: towards -1 if what the match
says of itself can be trusted.

With --variant each pair is matched as it is and changed: vertices renumbered, both shapes turned, scaled, coarse (a
quarter of their triangles) or coarsest (a twentieth), or one of them subdivided, decimated to half, or cut into halves
that are moved apart.  The errors are those of the map that follows between the original shapes (see `variants`), so
that all that may change them is the match.
"""

import argparse
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from scipy.stats import spearmanr

from engine import HierMatchError, MatchSettings, match
from tests.benchmarks.common import each_in_its_process, write_rows
from tests.benchmarks.known_shapes import LISTED, KnownShapes, score
from tests.benchmarks.variants import VARIANTS, as_is

AS_IS = "as is"
NAN = float("nan")
NEAR = 3.0  # error that confidence promises


@dataclass
class Row:
    """What is measured on one pair."""

    variant: str
    dataset: str
    source: str
    target: str
    direct: float = NAN
    symmetric: float = NAN
    p95: float = NAN
    inside: float = NAN
    reverse: float = NAN
    reverse_flip: str = ""
    flip: str = "failed"
    swapped: float = NAN
    lost: float = NAN
    margin: float = NAN
    confidence: float = NAN
    orientation: float = NAN
    distortion: float = NAN
    coverage: float = NAN
    disagreement: float = NAN
    trust: float = NAN
    over: float = NAN
    stretch: float = NAN
    flipped: float = NAN
    reverse_stretch: float = NAN
    reverse_flipped: float = NAN
    seconds: float = NAN
    peer_direct: float = NAN
    peer_symmetric: float = NAN
    peer_seconds: float = NAN
    problem: str = ""


COLUMNS = (
    ("direct", "direct", "7.2f"),
    ("symmetric", "symm.", "7.2f"),
    ("p95", "p95", "7.2f"),
    ("inside", "inside", "7.2f"),
    ("reverse", "reverse", "7.2f"),
    ("margin", "margin", "7.3f"),
    ("confidence", "conf.", "6.2f"),
    ("orientation", "orient.", "7.2f"),
    ("trust", "trust", "6.2f"),
    ("over", "over", "6.2f"),
    ("stretch", "stretch", "7.3f"),
    ("flipped", "flipped", "7.2%"),
    ("reverse_stretch", "stretch", "7.3f"),
    ("reverse_flipped", "flipped", "7.2%"),
    ("seconds", "seconds", "7.1f"),
)
PEER_COLUMNS = (
    ("peer_direct", "peer", "7.2f"),
    ("peer_symmetric", "symm.", "7.2f"),
    ("peer_seconds", "seconds", "7.1f"),
)


def measure(task):
    """Match one pair in one variant and score it."""
    shapes, names, variant, points, with_peer = task
    source, target = (shapes.read(name) for name in names)
    row = Row(variant, source.dataset, source.name, target.name)
    make = VARIANTS.get(variant, lambda x, y: (as_is(x), as_is(y)))
    x, y = make(source.mesh, target.mesh)
    settings = MatchSettings(dense=True) if points is None else MatchSettings(dense=True, points=points)
    start = time.perf_counter()
    try:
        result = match(x.mesh, y.mesh, settings)
    except HierMatchError as error:
        row.problem = str(error)
        return row
    row.seconds = time.perf_counter() - start
    forth, back, quality = result.source_to_target, result.target_to_source, result.quality
    found = score(source, target, x.images(source.samples, forth, y))
    reverse = score(target, source, y.images(target.samples, back, x))
    row.direct, row.symmetric, row.p95, row.inside = (
        found.direct,
        min(found.direct, found.mirrored),
        found.p95,
        found.inside,
    )
    row.flip, row.swapped, row.lost = found.flip, found.swapped, found.lost
    row.reverse, row.reverse_flip = reverse.direct, reverse.flip
    row.margin = NAN if quality.margin is None else quality.margin
    row.confidence, row.orientation, row.distortion = quality.confidence, quality.orientation, quality.distortion
    row.coverage, row.disagreement = quality.coverage, quality.disagreement
    confidence = forth.confidence[x.there.nearest_vertices[source.samples]]
    row.trust = correlation(confidence, found.inside_errors)
    row.over = float(confidence.mean() - (found.inside_errors < NEAR).mean())
    row.stretch, row.flipped = forth.rms_edge_stretch(x.mesh, y.mesh), forth.flipped_faces(x.mesh, y.mesh)
    row.reverse_stretch, row.reverse_flipped = back.rms_edge_stretch(y.mesh, x.mesh), back.flipped_faces(y.mesh, x.mesh)
    if with_peer:
        start = time.perf_counter()
        images = pyfm(source.mesh, target.mesh)
        row.peer_seconds = time.perf_counter() - start
        direct, mirrored = (target.vertex_errors(images[source.samples], mirrored=m).mean() for m in (False, True))
        row.peer_direct, row.peer_symmetric = direct, min(direct, mirrored)
    return row


def pyfm(source, target):
    """Map each vertex of the source to one of the target with pyfmaps."""
    from pyFM.functional import FunctionalMapping
    from pyFM.mesh import TriMesh

    shapes = (TriMesh(mesh.vertices, mesh.triangles, area_normalize=True, center=True) for mesh in (target, source))
    model = FunctionalMapping(*shapes)
    model.preprocess(n_descr=100, descr_type="WKS", subsample_step=5, k_process=150)
    model.fit(K=(30, 30), w_descr=1e-1, w_lap=1e-3, w_dcomm=1, w_orient=1)
    return model.get_p2p(model.zoomout_refine(nit=24, step=5))


def correlation(first, second):
    """Spearman's rank correlation of the pairs of numbers that are both there; NaN if one of them never changes."""
    both = np.isfinite(first) & np.isfinite(second)
    if both.sum() < 3 or np.ptp(first[both]) == 0 or np.ptp(second[both]) == 0:
        return NAN
    return float(spearmanr(first[both], second[both]).statistic)


def column(rows, name):
    return np.array([getattr(row, name) for row in rows], float)


def line(label, values, columns):
    """One line of the table; what is not known is a dash."""
    cells = []
    for name, _, form in columns:
        width = int(form.split(".")[0])
        cells.append(f"{'-':>{width}s}" if np.isnan(values[name]) else format(values[name], form))
    return f"{label:44s} " + " ".join(cells)


def heading(label, columns):
    return f"{label:44s} " + " ".join(f"{title:>{int(form.split('.')[0])}s}" for _, title, form in columns)


def wrong(row):
    """What is exchanged in either direction, in words."""
    flips = [row.flip.upper(), f"reverse {row.reverse_flip}" if row.reverse_flip else ""]
    return "  ".join(word for word in (*flips, row.problem) if word)


def summary(rows, columns):
    """Print mean and worst of each dataset, and what holds for all pairs."""

    def averaged(part, combine):
        with np.errstate(all="ignore"):
            return {name: combine(column(part, name)) for name, _, _ in columns}

    def mean(values):
        return np.nanmean(values) if np.isfinite(values).any() else NAN

    print(heading("", columns))
    for dataset in [*dict.fromkeys(row.dataset for row in rows), "all"]:
        part = [row for row in rows if dataset in (row.dataset, "all")]
        print(line(f"MEAN {dataset} ({len(part)} pairs)", averaged(part, mean), columns))
        worst = max(part, key=lambda row: np.inf if np.isnan(row.direct) else row.direct)
        print(line(f"worst: {worst.source} -> {worst.target}", asdict(worst), columns))
    kinds = ("whole", "limb", "lost", "failed")
    counts = ", ".join(f"{sum(row.flip == kind for row in rows)} {kind}" for kind in kinds)
    backwards = ", ".join(f"{sum(row.reverse_flip == kind for row in rows)} {kind}" for kind in kinds[:3])
    print(f"of {len(rows)} pairs: {counts}; reverse map: {backwards}")
    error = column(rows, "direct")
    for name in ("confidence", "margin", "disagreement", "distortion"):
        found = correlation(column(rows, name), error)
        print(f"rank correlation of {name} with the error: {'-' if np.isnan(found) else f'{found:+.2f}'}")


def changes(rows, base):
    """Print by how much each variant changes the errors of the same pairs."""
    known = {(row.source, row.target): row for row in base}
    print("\nchange of the mean error by variant: direct, inside; largest change of direct; flips, new ones")
    for variant in dict.fromkeys(row.variant for row in rows):
        part = [row for row in rows if row.variant == variant]
        before = [known[row.source, row.target] for row in part]
        direct, inside = (column(part, name) - column(before, name) for name in ("direct", "inside"))
        new = sum(bool(row.flip) and not old.flip for row, old in zip(part, before, strict=True))
        flips = f"{sum(bool(row.flip) for row in part)}, {new} of {len(part)}"
        largest = np.nanmax(np.abs(direct))
        print(f"  {variant:18s} {np.nanmean(direct):+6.3f} {np.nanmean(inside):+6.3f}   {largest:6.3f}   {flips}")


def run(tasks, jobs, columns, csv_path):
    """Measure all, printing rows as they come; the rows."""
    rows = []
    for row in each_in_its_process(measure, tasks, jobs):
        rows.append(row)
        name = f"{row.source} -> {row.target}" + (f" ({row.variant})" if row.variant != AS_IS else "")
        print(line(name, asdict(row), columns), wrong(row), flush=True)
        if csv_path:
            write_rows(csv_path, rows)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    parser.add_argument("--pairs", default=LISTED, help="source:target, separated by commas (default: 17 listed pairs)")
    parser.add_argument("--random", type=int, metavar="N", help="N random pairs instead")
    parser.add_argument("--seed", type=int, default=1, help="of the random pairs (default 1)")
    parser.add_argument("--peer", choices=["pyfm"], help="measure pyfmaps on the same pairs")
    parser.add_argument(
        "--variant", choices=[*VARIANTS, "subdivide", "decimate", "all"], help="match changed shapes too"
    )
    parser.add_argument("--points", type=int, help="points of the sparse match (default: that of the settings)")
    parser.add_argument("--jobs", type=int, default=1, help="pairs matched at the same time (default 1)")
    parser.add_argument("--csv", type=Path, help="write the rows to this file, with more columns than are printed")
    options = parser.parse_args()
    shapes = KnownShapes(options.data)
    if options.random:
        pairs = shapes.random_pairs(options.random, options.seed)
    else:
        pairs = [tuple(pair.split(":")) for pair in options.pairs.split(",")]
    chosen = [name for name in VARIANTS if options.variant == "all" or name.startswith(options.variant or "-")]
    columns = COLUMNS + PEER_COLUMNS if options.peer else COLUMNS
    tasks = [
        (shapes, pair, variant, options.points, bool(options.peer) and variant == AS_IS)
        for pair in pairs
        for variant in (AS_IS, *chosen)
    ]
    print(heading("errors x 100 / sqrt(area)", columns))
    rows = run(tasks, options.jobs, columns, options.csv)
    base = [row for row in rows if row.variant == AS_IS]
    print()
    summary(base, columns)
    if chosen:
        changes([row for row in rows if row.variant != AS_IS], base)


if __name__ == "__main__":
    main()
