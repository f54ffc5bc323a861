# SPDX-License-Identifier: GPL-3.0-or-later
"""Retarget characters in Blender with the one button, and print the scores beside those of Blender's Data Transfer.

    python -m tests.benchmarks.retarget_scenes --scenes FOLDER --scorer FOLDER/score.py [--only S1,S3] [--save FOLDER]

FOLDER holds scenes as NAME.blend, with a rigged `Source` and a bare `Target`, and the truth as NAME.npz, which only the
scorer and the joint errors read (see `artist_scenes` for what is in it).  The scene is opened as it is, and
`bpy.ops.hiermatch.retarget` and, in a fresh copy, Data Transfer (nearest face, interpolated) carry the weights, the UV
map and, as far as it can, the shape keys.  Printed are

    the scorer's table       rows asis_hiermatch and asis_data_transfer, and those of PEERS.md beside the scorer
    joints                   mean and largest distance of the heads of the new armature's bones from the true ones, and
                             of the tails, in % of the body's height
    stretched                share of the target's faces with an edge that is more than four times as long on the UV map
                             as the density of the source's map makes it
    seconds                  the operator, match included
"""

import json
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

from tests.benchmarks.scored_scenes import chosen_scenes, rows_of, scene_parser, scored
from tools.source_extension import registered_extension

PEERS = ("ref_nearest_vertex", "manual_dt_face", "perfect_dt_face", "manual_rwt")
STRETCHED = 4.0


def opened(path):
    """Open a scene and select its two meshes."""
    bpy.ops.wm.open_mainfile(filepath=str(path))
    source, target = bpy.data.objects["Source"], bpy.data.objects["Target"]
    bpy.ops.object.select_all(action="DESELECT")
    source.select_set(state=True)
    target.select_set(state=True)
    bpy.context.view_layer.objects.active = source
    return source, target


def weights_of(obj, names):
    """Weights (n, b) of the vertex groups of these names."""
    groups = {group.index: names.index(group.name) for group in obj.vertex_groups if group.name in names}
    weights = np.zeros((len(obj.data.vertices), len(names)))
    for vertex in obj.data.vertices:
        for element in vertex.groups:
            if element.group in groups:
                weights[vertex.index, groups[element.group]] = element.weight
    return weights


def keys_of(obj):
    """Names and offsets (k, n, 3), in the axes of the world, of the shape keys but the basis."""
    blocks = obj.data.shape_keys.key_blocks if obj.data.shape_keys else []
    if len(blocks) < 2:
        return [], np.zeros((0, len(obj.data.vertices), 3))
    places = np.empty((len(blocks), 3 * len(obj.data.vertices)))
    for number, block in enumerate(blocks):
        block.data.foreach_get("co", places[number])
    places = places.reshape(len(blocks), -1, 3)
    matrix = np.array(obj.matrix_world)[:3, :3]
    return [block.name for block in blocks[1:]], (places[1:] - places[0]) @ matrix.T


def result_of(target, names):
    """What the scorer reads."""
    found = {"weights": weights_of(target, names), "bones": names}
    if target.data.uv_layers:
        uv = np.empty(2 * len(target.data.loops), np.float32)
        target.data.uv_layers.active.data.foreach_get("uv", uv)
        found["loop_uv"] = uv.reshape(-1, 2)
    key_names, keys = keys_of(target)
    if key_names:
        found |= {"keys": keys, "key_names": key_names}
    return found


def stretched(source, target):
    """Share of the target's faces with an edge that the UV map stretches."""

    def edges(obj):
        mesh, matrix = obj.data, np.array(obj.matrix_world)
        places = np.array([vertex.co for vertex in mesh.vertices]) @ matrix[:3, :3].T
        corners, uv = np.empty(len(mesh.loops), np.int32), np.empty(2 * len(mesh.loops), np.float32)
        mesh.loops.foreach_get("vertex_index", corners)
        mesh.uv_layers.active.data.foreach_get("uv", uv)
        uv = uv.reshape(-1, 2)
        faces = np.repeat(np.arange(len(mesh.polygons)), [polygon.loop_total for polygon in mesh.polygons])
        after = np.arange(len(corners)) + 1
        after[np.append(np.flatnonzero(np.diff(faces)), len(faces) - 1)] = [p.loop_start for p in mesh.polygons]
        lengths = np.linalg.norm(places[corners[after]] - places[corners], axis=1)
        return faces, lengths, np.linalg.norm(uv[after] - uv, axis=1)

    _, lengths, mapped = edges(source)
    density = np.sqrt((mapped**2).sum() / (lengths**2).sum())
    faces, lengths, mapped = edges(target)
    return np.unique(faces[mapped > STRETCHED * density * np.maximum(lengths, 1e-9)]).size / len(target.data.polygons)


def joint_errors(armature, truth, height):
    """Mean and largest error of the heads, and mean of the tails, in % of the height."""
    names = [str(name) for name in truth["bone_names"]]
    used = [number for number, name in enumerate(names) if name != "Root"]
    matrix = armature.matrix_world
    errors = []
    for end, known in (("head_local", "gt_bone_head"), ("tail_local", "gt_bone_tail")):
        places = np.array([matrix @ getattr(armature.data.bones[name], end) for name in names])
        errors.append(np.linalg.norm(places - truth[known], axis=1)[used] / height * 100)
    return errors[0].mean(), errors[0].max(), errors[1].mean()


def data_transfer(source, target):
    """Carry weights and UVs with Blender's own modifier operator."""
    target.data.uv_layers.new(name="UVMap")
    bpy.context.view_layer.objects.active = source
    for kind, mapping in (("VGROUP_WEIGHTS", "vert_mapping"), ("UV", "loop_mapping")):
        nearest = "POLYINTERP_NEAREST"
        options = {mapping: nearest, "layers_select_src": "ALL", "layers_select_dst": "NAME"}
        bpy.ops.object.data_transfer(data_type=kind, use_create=True, **options)


def measure(path, scorer, folder, save):
    print(f"\n{path.stem}")
    with np.load(path.with_suffix(".npz")) as scene:
        truth = {name: scene[name] for name in ("bone_names", "gt_bone_head", "gt_bone_tail", "meta")}
    names = [str(name) for name in truth["bone_names"]]
    height = json.loads(str(truth["meta"]))["target_rest_height"]
    source, target = opened(path)
    before = set(bpy.data.objects)
    start = time.perf_counter()
    bpy.ops.hiermatch.retarget(source=source.name, target=target.name)
    seconds = time.perf_counter() - start
    new = [obj for obj in bpy.data.objects if obj not in before and obj.type == "ARMATURE"]
    rows = []
    for name, run in (("asis_hiermatch", None), ("asis_data_transfer", data_transfer)):
        if run is not None:
            source, target = opened(path)
            run(source, target)
        answer = folder / f"{path.stem}_{name}.npz"
        np.savez(answer, **result_of(target, names))
        heading, row = scored(scorer, path.with_suffix(".npz"), answer, "--name", name)
        rows.append(row)
        if run is None:
            share, errors = stretched(source, target), joint_errors(new[0], truth, height)
            report = bpy.context.scene.hiermatch_retarget.report
            said = [*report.done.splitlines(), *report.notes.splitlines()]
            if save is not None:
                bpy.ops.wm.save_as_mainfile(filepath=str(save / f"{path.stem}.blend"), copy=True)
    print("\n".join([heading, *rows, *rows_of(scorer, "PEERS.md", path.stem, PEERS).values()]))
    print("joints {:.2f} (largest {:.2f}), tails {:.2f}".format(*errors), end="; ")
    print(f"faces stretched {share:.2%}; {seconds:.1f} s")
    print("\n".join(f"  {line}" for line in said))
    sys.stdout.flush()


def main():
    parser = scene_parser(__doc__)
    parser.add_argument("--save", type=Path, help="folder to save the retargeted scenes in")
    options = parser.parse_args()
    registered_extension()
    with tempfile.TemporaryDirectory() as folder:
        for path in chosen_scenes(options, ".blend"):
            measure(path, options.scorer, Path(folder), options.save)


if __name__ == "__main__":
    main()
