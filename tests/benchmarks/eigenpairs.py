# SPDX-License-Identifier: GPL-3.0-or-later
"""Speed and error of our Laplace-Beltrami eigenpairs beside pyFM's (pyfmaps), in one run.

    python -m tests.benchmarks.eigenpairs [--data FOLDER] [--counts 50 100 200] [--large]

Both start from vertices and triangles: ours is the intrinsic Delaunay operator and its eigenpairs, pyFM's is
`TriMesh.process`.  Times are processor time, the best of some runs taken in turns.  Errors are the largest of all
eigenvalues but zero, relative to ARPACK run to the last digit on the same operator.  pyFM is left out where it is not
installed; it is no dependency of ours, so an environment of its own is best.  FOLDER holds .off files, in any
subfolders.
"""

import argparse
import resource
import time
from pathlib import Path

import numpy as np
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import eigsh

from engine import TriangleMesh
from engine.geometry.eigenpairs import eigenpairs, eigenpairs_steps
from engine.geometry.intrinsic_delaunay import intrinsic_delaunay
from engine.geometry.laplacian import laplace_beltrami
from tests.benchmarks.common import read_off, timed
from tests.shapes import creature, icosphere, irregular, subdivided

try:
    from pyFM.mesh import TriMesh
except ImportError:
    TriMesh = None

REPEATS = 3
NAMED_FILES = ("cat0", "michael0")


def reference(stiffness, mass, count):
    """Eigenvalues by ARPACK to the last digit, with a shift below the spectrum."""
    inverse = diags_array(1 / np.sqrt(mass))
    shift = -0.01 * 4 * np.pi * count / mass.sum()
    matrix = csc_array(inverse @ stiffness @ inverse)
    return np.sort(eigsh(matrix, count, sigma=shift, tol=0, return_eigenvectors=False))


def worst_error(values, exact):
    return (np.abs(values[1:] - exact[1:]) / exact[1:]).max()


def measure(name, vertices, triangles, counts):
    """Print one block of the table."""
    mesh = TriangleMesh(vertices / np.sqrt(TriangleMesh(vertices, triangles).area), triangles)
    triangulation, elapsed = timed(lambda: intrinsic_delaunay(mesh))
    operator, whole = timed(lambda: laplace_beltrami(mesh))
    print(
        f"\n{name}: {mesh.vertex_count} vertices, {triangulation.flips} flips in {1e3 * elapsed:.0f} ms, "
        f"operator in {1e3 * whole:.0f} ms"
    )
    for count in counts:
        calls = {"ours": lambda count=count: eigenpairs(mesh, count)}
        if TriMesh is not None:
            calls["pyFM"] = lambda count=count: TriMesh(mesh.vertices, mesh.triangles).process(k=count)
        seconds, found = dict.fromkeys(calls, np.inf), {}
        for _ in range(REPEATS):
            for label, call in calls.items():
                found[label], elapsed = timed(call)
                seconds[label] = min(seconds[label], elapsed)
        spectrum = found["ours"]
        error = worst_error(spectrum.values, reference(operator.stiffness, operator.mass, count))
        line = f"  k = {count:3d}: ours {seconds['ours']:6.3f} s, error {error:.1e}, complete {spectrum.complete}"
        if TriMesh is not None:
            peer = found["pyFM"]
            error = worst_error(peer.eigenvalues, reference(peer.W, peer.A.diagonal(), count))
            ratio = seconds["pyFM"] / seconds["ours"]
            line += f"; pyFM {seconds['pyFM']:6.3f} s, error {error:.1e}: {ratio:.2f} x our time"
        print(line, flush=True)


def measure_large(name, vertices, triangles, count):
    """Print time, longest step and peak memory for one large mesh."""
    mesh = TriangleMesh(vertices, triangles)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = last = time.process_time()
    longest, steps = 0.0, eigenpairs_steps(mesh, count)
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            spectrum = stop.value
            break
        longest, last = max(longest, time.process_time() - last), time.process_time()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    print(
        f"\n{name}: {mesh.vertex_count} vertices, k = {count}: {last - start:.1f} s, longest step {longest:.2f} s, "
        f"{memory / 1024:.0f} MB more memory, complete {spectrum.complete}",
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with .off files")
    parser.add_argument("--counts", type=int, nargs="+", default=[50, 100, 200])
    parser.add_argument("--large", action="store_true", help="also a sphere of 100,000 vertices")
    arguments = parser.parse_args()

    meshes = [
        ("creature", *creature(1.0, 24)[:2]),
        ("creature, irregular", *irregular(*creature(1.0, 24)[:2], rounds=1)),
        ("sphere", *icosphere(22)),
    ]
    if arguments.data:
        paths = sorted(path for path in arguments.data.rglob("*.off") if path.stem in NAMED_FILES)
        meshes += [(path.stem, *read_off(path)) for path in paths or sorted(arguments.data.rglob("*.off"))[:2]]
    if arguments.large:  # first, as peak memory is that of all before
        measure_large("sphere", *icosphere(100), max(arguments.counts))
    for name, vertices, triangles in meshes:
        measure(name, vertices, triangles, arguments.counts)
    name, vertices, triangles = meshes[-1] if arguments.data else meshes[0]
    for parts in (2, 3):
        measure(
            f"{name}, each triangle split into {parts**2}", *subdivided(vertices, triangles, parts), arguments.counts
        )


if __name__ == "__main__":
    main()
