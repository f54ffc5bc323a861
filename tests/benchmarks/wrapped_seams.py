# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrap characters onto others, and measure how far their seams open.

    python -m tests.benchmarks.wrapped_seams --data FOLDER [--only SOURCE:TARGET,...]

FOLDER holds characters as .glb files, with or without rigs. Without --only each one is laid onto the next by name, and
the last onto the first: many are unlike, as seams must stay closed however bad the map is. Source and target are
collections of all meshes of a character.

A row holds the number of objects; how many places of the source have several vertices, of one object or of several; how
many of these places are open after *Wrap*, and the widest gap there, in % of the height; the same for the objects that
*New Object* makes; the confidence in %, and the seconds of one core.
"""

import argparse
import os
import time
from pathlib import Path

os.environ.setdefault("HIERMATCH_PROCESSES", "1")

import bpy
import numpy as np
from mathutils import Matrix

from tests.benchmarks.maker_rigs import moved_by
from tests.benchmarks.several_objects import COINCIDENT, gaps
from tools.source_extension import registered_extension


def character(path, name):
    """Import a character at rest, and return a collection of its meshes, and these by name."""
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=str(path))
    new = set(bpy.data.objects) - before
    rigs = [obj for obj in new if obj.type == "ARMATURE"]
    for rig in rigs:
        rig.animation_data_clear()
        for bone in rig.pose.bones:
            bone.matrix_basis = Matrix()
    meshes = [obj for obj in new if obj.type == "MESH" and (not rigs or any(moved_by(obj, rig) for rig in rigs))]
    collection = bpy.data.collections.new(name)
    bpy.context.scene.collection.children.link(collection)
    for mesh in meshes:
        if mesh.data.shape_keys:
            mesh.shape_key_clear()
        collection.objects.link(mesh)
    return collection, sorted(meshes, key=lambda mesh: mesh.name)


def shown(meshes):
    """Vertices (n, 3) in the world as their shape keys make them, without modifiers."""
    places = []
    for mesh in meshes:
        keys = mesh.data.shape_keys
        blocks = [keys.key_blocks[0], *(key for key in keys.key_blocks[1:] if key.value)] if keys else [mesh.data]
        read = [np.array([point.co for point in (block.data if keys else block.vertices)]) for block in blocks]
        whole = read[0] + sum(key.value * (one - read[0]) for key, one in zip(blocks[1:], read[1:], strict=True))
        matrix = np.array(mesh.matrix_world)
        places.append(whole @ matrix[:3, :3].T + matrix[:3, 3])
    return np.concatenate(places)


def row(folder, names):
    """Return the numbers of one pair."""
    bpy.ops.wm.read_homefile(use_empty=True)
    source, its = character(folder / names[0], "Source")
    target, others = character(folder / names[1], "Target")
    rest = shown(its)
    size = np.linalg.norm(np.ptp(rest, axis=0))
    seam = np.unique(np.round(rest / (COINCIDENT * size)), axis=0, return_inverse=True)[1].ravel()
    several = np.bincount(seam) > 1
    begin = time.process_time()
    said = []
    for result in ("KEY", "OBJECT"):
        before = set(bpy.data.objects)
        bpy.ops.hiermatch.wrap(source=source.name, target=target.name, wrap_result=result, accept_doubtful=True)
        new = set(bpy.data.objects) - before
        places = shown([next((obj for obj in new if obj.name.startswith(f"{mesh.name} to ")), mesh) for mesh in its])
        widths = gaps(places, seam)[several]
        wide = widths > COINCIDENT * size
        said.append(f"{wide.sum():5}  {100 * widths.max(initial=0) / np.ptp(places, axis=0).max():7.4f}")
    titles = " -> ".join(Path(name).stem for name in names)
    confidence = 100 * bpy.context.scene.hiermatch.summary.confidence
    seconds = time.process_time() - begin
    return (
        f"{titles:62} {len(its)}:{len(others)}  {several.sum():6}  {'  '.join(said)}  {confidence:3.0f}  {seconds:6.1f}"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the characters")
    parser.add_argument("--only", help="pairs of files, SOURCE:TARGET,... (default: each onto the next)")
    options = parser.parse_args()
    registered_extension()
    files = sorted(path.name for path in options.data.glob("*.glb"))
    every = zip(files, files[1:] + files[:1], strict=True)
    for names in [tuple(pair.split(":")) for pair in options.only.split(",")] if options.only else every:
        try:
            print("ROW", row(options.data, names), flush=True)
        except RuntimeError as refusal:
            print("ROW", " -> ".join(Path(name).stem for name in names), str(refusal).strip(), flush=True)


if __name__ == "__main__":
    main()
