# SPDX-License-Identifier: GPL-3.0-or-later
"""What each setting changes: the demo pair, with and without the target's tail, matched with one after the other.

    python -m tests.benchmarks.setting_effects [--only WORD]

Prints the table of docs/settings.md: seconds of processor time, and the mean error of the dense map from target to
source and of the matched points, in percent of the square root of the area, as straight lines in the rest pose.  With
--only, settings whose row contains the word.
"""

import argparse
import sys
import time
from pathlib import Path

import bpy
import numpy as np

from tools.source_extension import registered_extension

registered_extension()

from hiermatch.engine import MatchSettings, TriangleMesh, match  # noqa: E402
from hiermatch.hiermatch_addon.scene.mesh_io import read_mesh  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from manual_scenes import cut_tail, rest_positions  # noqa: E402

CREATURES = {"coarse_points": 12, "coarse_candidates": 28, "hypotheses": 12}

ROWS = (
    ("as it comes", {}),
    ("*Dense Map* off", {"dense": False}),
    ("*Samples* 128", {"samples": 128}),
    ("*Hypotheses* 12", {"hypotheses": 12}),
    ("*Coarse Points* 12, *Coarse Candidates* 28, *Hypotheses* 12", CREATURES),
    ("*Metric*: Diffusion, *Samples* 384", {"metric": "diffusion", "samples": 384}),
    ("*Descriptor*: Wave Kernel Signatures", {"descriptor": "wave_kernel"}),
    ("*Descriptor*: Laplace-Beltrami Eigenfunctions", {"descriptor": "eigenfunctions"}),
    ("*Solver*: Generalized Multidimensional Scaling", {"solver": "gmds"}),
    ("*Samples* 512", {"samples": 512}),
    ("*Points* 256", {"points": 256}),
)


def pair(*, tailless):
    """Return the two meshes, and where their vertices are in the rest pose."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.hiermatch.add_demo_pair()
    state = bpy.context.scene.hiermatch
    cats = (state.source, state.target)
    if tailless:
        cut_tail(cats[1])
    depsgraph = bpy.context.evaluated_depsgraph_get()
    meshes = [read_mesh(cat, depsgraph, use_modifiers=False) for cat in cats]
    return meshes, [rest_positions(cat).astype(float) for cat in cats]


def measure(meshes, rests, settings):
    """Return seconds, and the mean errors of the map, if there is one, and of the points."""
    start = time.process_time()
    result = match(*meshes, MatchSettings(**settings))
    seconds = time.process_time() - start
    source, target = rests
    scale = np.sqrt(TriangleMesh(source, meshes[0].triangles).area)
    ends = [
        np.einsum("kc,kcd->kd", points.barycentric, rest[points.corners])
        for points, rest in ((result.source_points, source), (result.target_points, target))
    ]
    points = 100 * np.linalg.norm(ends[0] - ends[1], axis=1).mean() / scale
    if result.target_to_source is None:
        return seconds, None, points
    error = np.linalg.norm(result.target_to_source.transfer(source) - target, axis=1)
    return seconds, 100 * error.mean() / scale, points


def main():
    parser = argparse.ArgumentParser(description="Print what each setting changes.")
    parser.add_argument("--only", default="", help="a word of the rows to measure")
    only = parser.parse_args().only
    pairs = [pair(tailless=False), pair(tailless=True)]
    print("| | s | map | points | no tail: s | map | points |\n|---|---|---|---|---|---|---|")
    for name, settings in ROWS:
        if only in name:
            cells = []
            for meshes, rests in pairs:
                seconds, dense, points = measure(meshes, rests, settings)
                cells += [f"{seconds:.1f}", "-" if dense is None else f"{dense:.2f}", f"{points:.2f}"]
            print("|", " | ".join([name, *cells]), "|", flush=True)


if __name__ == "__main__":
    main()
