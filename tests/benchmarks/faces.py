# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry the keys of a face to other heads, and say how near they come to those heads' own, and whether eyes close.

    python -m tests.benchmarks.faces --faces FILE [--heads 0,1,2]

FILE is a face model as .npz: `neutral` (n, 3), polygons (`faces`, `offsets`), `keys` (k, n, 3) with `key_names`, and
`identities` (i, n, 3), what makes other heads of the neutral one; of its vertices, `PARTS` says where each part begins.
The source is the neutral head.  A target is another head, decimated, turned, and in other units; what a key moves it by
is known from the model.  A row holds, for one head:

    skin            error of the keys on face, head and neck: |carried - known| / |known|, the mean of all keys
    sockets, thin, teeth    the same of the eye sockets; of lashes, tears and eye shells; of teeth and gums
    blink           the same of the skin in both blinks
    eye open        how much of the eye's height both lids leave open in a blink at the widest, in %: on the source, on
                    the target by the model's offsets, by those that were carried, and with closings kept, as Retarget
                    does (`closings_kept_steps`); the other columns hold errors with closings kept
    eye seen        the same of how much of the eyeball is seen from the front, also where it comes through a lid
    seconds         of the processor: match, and keys
"""

import argparse
import itertools
import time
from pathlib import Path

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from engine import (
    ClosestPoints,
    MatchSettings,
    TriangleMesh,
    carry_offsets_steps,
    closings_kept_steps,
    evened_frames,
    match,
    run,
    surface_frames,
)
from engine.mesh.closest_points import facing
from tests.shapes import rotation

PARTS = np.array(
    [0, 11248, 13294, 13678, 14062, 17039, 21451, 23021, 24591, 24795, 24999, 25023, 25047, 25199, 25351, 26035, 26719]
)
SKIN, SOCKETS, THIN, TEETH, EYES = (0,), (2, 3), (8, 9, 12, 13, 14, 15), (4, 5), (6, 7)
KEYS = [
    *("jawOpen", "mouthSmile_L", "mouthSmile_R", "eyeBlink_L", "eyeBlink_R", "browInnerUp_L", "browDown_R"),
    *("mouthPucker", "mouthFunnel", "mouthRollLower", "noseSneer_L", "cheekPuff_R", "jawLeft", "mouthUpperUp_L"),
    *("eyeLookUp_R", "mouthClose"),
]
BLINKS = [KEYS.index("eyeBlink_L"), KEYS.index("eyeBlink_R")]
HEADS = (((2.5, 0, 0, 0, 0), 0.5), ((-2, 2, -2, 2, 2), 0.5), ((1.5, -2, 2, -2, -2), 0.25))
"""Of each target, how much of the identities, and the part of the triangles that is left."""

LEAST = 0.02
"""Keys that move less of a part than this, as a part of all they move, are left out of its error."""


class Model:
    """The source, as a mesh, its parts and keys; and other heads."""

    def __init__(self, path):
        with np.load(path) as stored:
            self.neutral, self._identities = stored["neutral"].astype(float), stored["identities"].astype(float)
            names = list(map(str, stored["key_names"]))
            self.keys = stored["keys"][[names.index(key) for key in KEYS]].astype(float)
            flat, offsets = stored["faces"], stored["offsets"]
        self._polygons = [flat[a:b].tolist() for a, b in itertools.pairwise(offsets)]
        self.parts = np.searchsorted(PARTS, np.arange(len(self.neutral)), side="right") - 1
        self.mesh = TriangleMesh(self.neutral, self._decimated(self.neutral, 1.0)[1])

    def _decimated(self, vertices, ratio):
        """Vertices (m, 3), triangles and parts of a head with fewer triangles."""
        data = bpy.data.meshes.new("head")
        data.from_pydata(vertices.tolist(), [], self._polygons)
        head = bpy.data.objects.new("head", data)
        bpy.context.scene.collection.objects.link(head)
        for part in range(len(PARTS) - 1):
            group = head.vertex_groups.new(name=str(part))
            group.add(list(range(PARTS[part], PARTS[part + 1])), 1.0, "REPLACE")
        if ratio < 1:
            head.modifiers.new("decimate", "DECIMATE").ratio = ratio
        graph = bpy.context.evaluated_depsgraph_get()
        made = bpy.data.meshes.new_from_object(
            head.evaluated_get(graph), preserve_all_data_layers=True, depsgraph=graph
        )
        made.calc_loop_triangles()
        parts = [max(v.groups, key=lambda own: own.weight).group if v.groups else 0 for v in made.vertices]
        triangles = np.array([triangle.vertices for triangle in made.loop_triangles])
        positions = np.array([vertex.co for vertex in made.vertices])
        bpy.data.objects.remove(head)
        return positions, triangles, np.array(parts)

    def other(self, weights, ratio):
        """Mesh, parts and keys of another head, decimated."""
        whole = self.neutral + np.tensordot(weights, self._identities[: len(weights)], 1)
        vertices, triangles, parts = self._decimated(whole, ratio)
        keys, head = np.zeros((len(self.keys), len(vertices), 3)), TriangleMesh(vertices, triangles)
        for part in np.unique(parts):
            own = self.mesh.triangles[(self.parts[self.mesh.triangles] == part).all(axis=1)]
            chosen, size = np.flatnonzero(parts == part), float(np.sqrt(head.area))
            # By where they look as well, for the place not to be on the other lip, or on the other side of a lid.
            search = ClosestPoints(TriangleMesh(whole, own))
            found = facing(search, vertices[chosen], head.vertex_normals[chosen], size)
            keys[:, chosen] = np.einsum("pc,kpcd->kpd", found.barycentric, self.keys[:, own[found.triangles]])
        return head, parts, keys


def errors(carried, known, chosen):
    """Relative errors of keys (k,) at chosen vertices; NaN where a key hardly moves these."""
    own, whole = (np.linalg.norm(known[:, which], axis=(1, 2)) for which in (chosen, slice(None)))
    missed = np.linalg.norm((carried - known)[:, chosen], axis=(1, 2))
    return np.where(own > LEAST * whole, missed / np.maximum(own, 1e-12), np.nan)


def opening(vertices, triangles, parts, eye):
    """Seen from the front (along -z): the widest opening between the lids before an eye, and what is seen of its ball.

    The first in steps of the height, the second in rays.
    """
    trees = []
    for shown in (SKIN, (eye,)):
        chosen = triangles[np.isin(parts[triangles], shown).all(axis=1)]
        trees.append(BVHTree.FromPolygons(vertices.tolist(), chosen.tolist()))
    ball = vertices[parts == eye]
    centre, radius = ball.mean(axis=0), np.linalg.norm(ball - ball.mean(axis=0), axis=1).mean()
    heights, seen, step = [], 0, 0.007 * radius
    for x in np.linspace(-radius, radius, 41):
        column = 0
        for y in np.arange(-0.8 * radius, 0.8 * radius, step):
            skin, eyeball = (tree.ray_cast(centre + np.array([x, y, 5 * radius]), (0, 0, -1)) for tree in trees)
            column += skin[0] is None or skin[0][2] < centre[2]
            seen += eyeball[0] is not None and (skin[0] is None or eyeball[3] < skin[3])
        heights.append(column)
    return np.array([max(heights), seen])


def still_open(vertices, triangles, parts, keys):
    """What blinks leave open of the eyes' height, and to be seen of the balls, in %, on the mean."""
    found = []
    for eye, key in zip(EYES, BLINKS, strict=True):
        found.append(opening(vertices + keys[key], triangles, parts, eye) / opening(vertices, triangles, parts, eye))
    return 100 * np.mean(found, axis=0)


def measure(model, number):
    weights, ratio = HEADS[number]
    rest, parts, known = model.other(np.array(weights, float), ratio)
    turn = rotation(np.random.default_rng(number).standard_normal(3), 1.0)
    target = TriangleMesh(0.01 * rest.vertices @ turn.T, rest.triangles)
    times = [time.process_time()]
    result = match(model.mesh, target, MatchSettings(dense=True))
    times.append(time.process_time())
    there, back = result.source_to_target, result.target_to_source
    frames = evened_frames(model.mesh, surface_frames(model.mesh, there.positions))
    carried = run(carry_offsets_steps(model.keys, frames, target, back))
    kept = run(closings_kept_steps(model.mesh, model.keys, (there, back), target, carried))
    times.append(time.process_time())
    ours = [100 * keys @ turn for keys in (carried, kept)]
    where = [np.isin(parts, group) for group in (SKIN, SOCKETS, THIN, TEETH)]
    values = [np.nanmean(errors(ours[1], known, chosen)) for chosen in where]
    values.append(np.nanmean(errors(ours[1], known, where[0])[BLINKS]))
    gaps = [still_open(model.neutral, model.mesh.triangles, model.parts, model.keys)]
    gaps += [still_open(rest.vertices, rest.triangles, parts, keys) for keys in (known, *ours)]
    seconds = np.diff(times)
    print(
        f"{number:4d} " + " ".join(f"{value:8.3f}" for value in values),
        " | ".join(" ".join(f"{gap:6.1f}" for gap in one) for one in np.transpose(gaps)),
        f"{seconds[0]:8.1f} {seconds[1]:5.1f}",
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faces", type=Path, required=True, help="the face model")
    parser.add_argument("--heads", default="0,1,2", help="numbers of heads, separated by commas (default all)")
    options = parser.parse_args()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    model = Model(options.faces)
    print("head     skin  sockets     thin    teeth    blink  eye open: source, model, carried, kept | seen  seconds")
    for number in map(int, options.heads.split(",")):
        measure(model, number)


if __name__ == "__main__":
    main()
