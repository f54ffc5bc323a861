# SPDX-License-Identifier: GPL-3.0-or-later
"""Match the meshes of character retargeting scenes, and print the scores beside those of today's tools.

    python -m tests.benchmarks.artist_scenes --scenes FOLDER --scorer FOLDER/score.py [--only S1,S3]

FOLDER holds scenes as .npz files: a source mesh with its triangles (`src_verts`, `src_tris`), the polygons of a target
mesh (`tgt_verts`, in the space of the world, `tgt_faces` and `tgt_face_offsets`), and the truth, which only the scorer
reads; and beside the scorer PEERS.md, the table of the scores of others.

The target is cut into triangles that fan out from the first corner of each polygon, and otherwise matched as it is:
with its loose parts, holes, doubled vertices and whatever else is wrong with it.  What is scored is target_to_source:
for each vertex of the target a triangle of the source and the coordinates there.  The columns are those of the scorer
(see its --help); `geo` is the mean distance from the true point, in % of the body's height, and `swap` and `limb` are
the shares of vertices that got the weights of the wrong side or limb.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from engine import HierMatchError, MatchSettings, TriangleMesh, match
from tests.benchmarks.scored_scenes import chosen_scenes, rows_of, scene_parser, scored

OURS = "asis_hiermatch"
PEERS = ("ref_nearest_vertex", "asis_dt_face", "manual_dt_face", "perfect_dt_face")


def fans(corners, offsets):
    """Cut polygons into triangles (m, 3): polygon i has the vertices corners[offsets[i]:offsets[i + 1]].

    Triangles that name a vertex twice are left out.
    """
    sizes = np.diff(offsets)
    polygon = np.repeat(np.arange(len(sizes)), np.maximum(sizes - 2, 0))
    first = np.cumsum(np.maximum(sizes - 2, 0)) - np.maximum(sizes - 2, 0)
    step = np.arange(len(polygon)) - first[polygon]
    start = offsets[:-1][polygon]
    triangles = np.stack([corners[start], corners[start + step + 1], corners[start + step + 2]], axis=1)
    return triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)].astype(np.int64)


def meshes(path):
    """Source and target of a scene."""
    with np.load(path) as scene:
        source = TriangleMesh(scene["src_verts"], scene["src_tris"])
        return source, TriangleMesh(scene["tgt_verts"], fans(scene["tgt_faces"], scene["tgt_face_offsets"]))


def measure(path, scorer, folder):
    print(f"\n{path.stem}")
    source, target = meshes(path)
    start = time.perf_counter()
    try:
        result = match(source, target, MatchSettings(dense=True))
    except HierMatchError as error:
        print(f"refused: {error}")
        return
    seconds = time.perf_counter() - start
    answer = folder / path.name
    np.savez(answer, tri=result.target_to_source.triangles, bary=result.target_to_source.barycentric)
    own = scored(scorer, path, answer, "--name", OURS)
    print("\n".join([*own, *rows_of(scorer, "PEERS.md", path.stem, PEERS).values()]))
    quality = result.quality
    margin = "none" if quality.margin is None else f"{quality.margin:.3f}"
    print(
        f"{source.vertex_count} and {target.vertex_count} vertices, {seconds:.1f} s; "
        f"orientation {quality.orientation:.2f}, distortion {quality.distortion:.3f}, "
        f"coverage {quality.coverage:.1%}, disagreement {quality.disagreement:.4f}, margin {margin}, "
        f"confidence {quality.confidence:.2f}: {quality.sentence}",
    )
    for note in result.notes:
        print(f"  {note}")
    sys.stdout.flush()


def main():
    options = scene_parser(__doc__).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for path in chosen_scenes(options, ".npz"):
            measure(path, options.scorer, Path(folder))


if __name__ == "__main__":
    main()
