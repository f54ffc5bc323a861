# SPDX-License-Identifier: GPL-3.0-or-later
"""Look each shape up among all others: does the most similar one belong to its class?

    python -m tests.benchmarks.retrieval --data FOLDER [--matched 8] [--points 40] [--samples 200] ...
    python -m tests.benchmarks.retrieval                        generated bodies instead

FOLDER holds .off files; the class of a shape is its name without digits and underscores (cat0 and cat10 are cats; all
tr_reg_... of FAUST are one class, people).  Printed are the confusion matrix of the nearest neighbour (row: class of
the query, column: class of its nearest neighbour) by the match and by the bound alone, the part of right ones, the same
with all classes of people taken together, and seconds: per shape for what is done once, and per query.
"""

import argparse
import re
import time
from pathlib import Path

import numpy as np

from engine.matching.retrieval import RetrievalSettings, retrieve
from engine.mesh.triangle_mesh import TriangleMesh
from engine.runtime.progress import run
from engine.shapes.shape import Shape
from tests.benchmarks.common import read_off
from tests.bodies import mirrored_body, relative_of_creature

PEOPLE = {"man", "michael", "person"}
SETTINGS = ("matched", "points", "samples", "signature_samples", "coarse_points")


def class_of(name):
    letters = re.sub(r"[\d_]+", "", name)
    return "person" if letters == "trreg" else letters


def generated():
    """Four species in four poses, each meshed differently."""
    poses = [(0.0, 13, 0.0), (0.4, 12, 0.5), (0.7, 13, 1.1), (1.0, 12, 2.0)]
    species = {"creature": {}, "short": {"legs": 0.5, "tail": 0.5}, "long": {"legs": 1.5, "tail": 2.0}}
    for number, (pose, resolution, turn) in enumerate(poses):
        for name, form in species.items():
            yield (
                f"{name}{number}",
                TriangleMesh(*relative_of_creature(**form, pose=pose, resolution=resolution, turn=turn)),
            )
        yield f"mirrored{number}", TriangleMesh(*mirrored_body(pose, resolution, seed=number)[:2])


def confusion(title, classes, nearest):
    """Print a confusion matrix, and return the part on its diagonal."""
    names, query = np.unique(classes, return_inverse=True)
    counts = np.zeros((len(names), len(names)), int)
    np.add.at(counts, (query, query[nearest]), 1)
    width = max(map(len, names)) + 1
    print(f"{title}\n" + " " * width + "".join(f"{name:>{width}s}" for name in names))
    for name, row in zip(names, counts, strict=True):
        print(f"{name:<{width}s}" + "".join(f"{count or '.':>{width}}" for count in row))
    return np.trace(counts) / len(classes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with the shapes")
    for name in SETTINGS:
        parser.add_argument(f"--{name.replace('_', '-')}", type=int, default=getattr(RetrievalSettings(), name))
    options = parser.parse_args()
    settings = RetrievalSettings(**{name: getattr(options, name) for name in SETTINGS})
    if options.data is None:
        meshes = dict(generated())
    else:
        meshes = {path.stem: TriangleMesh(*read_off(path)) for path in sorted(options.data.rglob("*.off"))}
    names, shapes = list(meshes), [Shape(mesh) for mesh in meshes.values()]
    start = time.perf_counter()
    for shape in shapes:
        run(shape.sample_steps(settings.signature_samples))
    once = (time.perf_counter() - start) / len(shapes)
    start = time.perf_counter()
    for shape in shapes:
        run(shape.sample_steps(settings.samples))
    more = (time.perf_counter() - start) / len(shapes)
    nearest, nearest_bound, start = [], [], time.perf_counter()
    for number, query in enumerate(shapes):
        others = [other for other in range(len(shapes)) if other != number]
        found = retrieve(query, [shapes[other] for other in others], settings)
        nearest.append(others[found.order[0]])
        nearest_bound.append(others[int(found.bounds.argmin())])
    seconds = (time.perf_counter() - start) / len(shapes)
    classes = np.array([class_of(name) for name in names])
    grouped = np.array(["people" if name in PEOPLE else name for name in classes])
    nearest, nearest_bound = np.array(nearest), np.array(nearest_bound)
    by_match = confusion("nearest by the match", classes, nearest)
    by_bound = confusion("nearest by the bound alone", classes, nearest_bound)
    wrong = [f"{names[i]} -> {names[j]}" for i, j in enumerate(nearest) if classes[i] != classes[j]]
    print(f"wrong: {', '.join(wrong) or 'none'}")
    print(
        f"{len(names)} shapes, {settings}\n"
        f"right class: {by_match:.1%} by the match, {by_bound:.1%} by the bound alone; people taken together "
        f"{(grouped == grouped[nearest]).mean():.1%}\n"
        f"seconds: {once:.2f} per shape for its signature, {more:.2f} more per shape that is matched, "
        f"{seconds:.2f} per query after that"
    )


if __name__ == "__main__":
    main()
