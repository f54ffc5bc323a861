# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry rigs that stand in a body, and move nothing of it, into other bodies: how far the joints are off.

    python -m tests.benchmarks.standing_rigs [--only NAME,...] [--resolution 40]

All bodies are made here, meshed anew, and matched as any.  A row holds the mean and the largest distance of the joints
from the true ones, in % of the height, by the way for rigs that move nothing (*Fit My Rig*), and beside it by that for
rigs that move the source (*Retarget*), which has its weights to go by; and the seconds of one core that either takes
beside the match.
"""

import argparse
import time

import numpy as np

from engine import carry_standing_rig, fit_rig, match, place_joints
from tests.people import HANGING, at_rest_in, person

CHILD, GIANT = {"legs": 0.75, "arms": 0.85, "girth": 1.15}, {"legs": 1.3, "arms": 1.1, "girth": 1.2}
CASES = {
    "same body": ({}, {}),
    "same body with hanging arms": ({}, HANGING),
    "child": (CHILD, {}),
    "child with hanging arms": (CHILD, HANGING),
    "giant": (GIANT, {}),
    "giant with hanging arms": (GIANT, HANGING),
}


def across(skeleton):
    """Some direction across each bone."""
    axes = skeleton.tails - skeleton.heads
    found = np.cross(axes, np.eye(3)[np.abs(axes).argmin(axis=1)])
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default=",".join(CASES), help="cases (default: all)")
    parser.add_argument("--resolution", type=int, default=40, help="of the bodies (default %(default)s)")
    options = parser.parse_args()
    source = person(options.resolution)
    skeleton, normals = source.rig.skeleton, across(source.rig.skeleton)
    print(f"{'':28s}" + "".join(f"{f'{way}: mean':>14s} {'worst':>6s} {'seconds':>8s}" for way in ("stands", "moves")))
    for name in options.only.split(","):
        build, pose = CASES[name]
        target = at_rest_in(person(options.resolution, turn=0.3, **build), pose)
        found = match(source.mesh, target.mesh)
        maps = found.source_to_target, found.target_to_source
        start = time.process_time()
        standing = carry_standing_rig(source.mesh, target.mesh, *maps, skeleton=skeleton, normals=normals)
        between = time.process_time()
        rig = fit_rig(source.mesh, target.mesh, *maps, weights=source.rig.weights, skeleton=skeleton)
        moving = place_joints(rig, source.mesh, normals)
        seconds = between - start, time.process_time() - between
        height = np.ptp(target.mesh.vertices, axis=0).max() / 100
        said = f"{name:28s}"
        for placed, spent in zip((standing, moving), seconds, strict=True):
            missed = np.linalg.norm(placed.heads - target.rig.skeleton.heads, axis=1) / height
            said += f"{missed.mean():14.2f} {missed.max():6.2f} {spent:8.1f}"
        print(said, flush=True)


if __name__ == "__main__":
    main()
