# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry a rig between characters of one maker, joined to one mesh, and as the several objects that they are.

    python -m tests.benchmarks.several_objects --data FOLDER [--only SOURCE:TARGET,...] [--ways joined,separate]

FOLDER holds rigged characters as .glb files; without --only these are all pairs of a family in `FAMILIES` that have as
many bones of the same names. The target's own rig and weights are taken away and kept as the truth, and *Retarget*
gives it others: of separate objects from the source's armature to a collection.

A row holds the way; how many objects either has; the share of the target's surface whose strongest bone is the true
one, or its parent or child; the mean sum of the errors of the weights (0 to 2); the mean and the largest distance of
the bones' heads from the true ones; how far vertices are from the truth on the mean in three random poses of its true
rig; the widest crack at a seam, where vertices coincide at rest, then, and with the true weights; all these in % of the
height. Then whether the source's objects are as they were, the confidence in %, and the seconds: of this
process, and by the clock (HIERMATCH_PROCESSES=2 shares the work with a second process).
"""

import argparse
import os
import time
from itertools import permutations
from pathlib import Path

os.environ.setdefault("HIERMATCH_PROCESSES", "1")

import bpy
import numpy as np
from mathutils import Matrix
from scipy.spatial.transform import Rotation

from tests.benchmarks.maker_rigs import added
from tests.benchmarks.retarget_scenes import weights_of
from tools.source_extension import registered_extension

FAMILIES = (
    tuple(f"quaternius-modular_men-{name}.glb" for name in ("Casual", "Suit", "King")),
    tuple(f"quaternius-modular_women-{name}.glb" for name in ("Casual", "Formal", "Witch")),
    tuple(f"quaternius-animals_pack-{name}.glb" for name in ("Cow", "Fox", "Horse", "Husky")),
    ("m2m-human-male.glb", "m2m-human-female.glb"),
    ("m2m-fox-animations.glb", "m2m-fox-cat.glb", "m2m-fox-dog.glb"),
)
CLOCKS = (time.process_time, time.perf_counter)
"""Clocks: of the processor's time of this process, and of the wall."""

POSES, BENT = 3, 0.5
"""Number of random poses, and by how many radians bones are turned in them at most."""

COINCIDENT = 1e-6
"""How far vertices are apart that lie on one another, in units of the body's diagonal."""


def character(path, name, *, joined):
    """Import a character at rest, and return its rig and meshes."""
    rig, meshes = added(path)
    rig.name = name
    rig.animation_data_clear()
    for bone in rig.pose.bones:
        bone.matrix_basis = Matrix()
    for mesh in meshes:
        if mesh.data.shape_keys:
            mesh.shape_key_clear()
    meshes = sorted(meshes, key=lambda mesh: mesh.name)
    if joined and len(meshes) > 1:
        with bpy.context.temp_override(active_object=meshes[0], selected_editable_objects=meshes):
            bpy.ops.object.join()
        meshes = meshes[:1]
    return rig, meshes


def bared(meshes):
    """Meshes as they are shown, without rig and weights, in a collection of their own."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    collection = bpy.data.collections.new("Bare")
    bpy.context.scene.collection.children.link(collection)
    made = []
    for mesh in meshes:
        data = bpy.data.meshes.new_from_object(mesh.evaluated_get(depsgraph))
        data.transform(mesh.matrix_world)
        made.append(bpy.data.objects.new(f"Bare {mesh.name}", data))
        made[-1].vertex_groups.clear()
        collection.objects.link(made[-1])
    return collection, made


def state(meshes):
    """Everything of a character's meshes that must not change."""
    found = []
    for mesh in meshes:
        places = np.empty(3 * len(mesh.data.vertices), np.float32)
        mesh.data.vertices.foreach_get("co", places)
        groups = tuple(group.name for group in mesh.vertex_groups if not group.name.startswith("HM"))
        stack = tuple((one.type, getattr(one, "object", None)) for one in mesh.modifiers)
        slots = tuple(slot.name for slot in mesh.material_slots)
        layers = tuple(layer.name for layer in mesh.data.uv_layers)
        weights = weights_of(mesh, list(groups)).tobytes()
        found.append((places.tobytes(), groups, weights, stack, mesh.parent, mesh.matrix_world.copy(), slots, layers))
    return found


def surface(meshes):
    """Vertices (n, 3) of meshes, and the share of the area that belongs to each (n,)."""
    places, areas = [], []
    for mesh in meshes:
        places.append(np.array([vertex.co for vertex in mesh.data.vertices]))
        areas.append(np.zeros(len(places[-1])))
        for polygon in mesh.data.polygons:
            np.add.at(areas[-1], list(polygon.vertices), polygon.area / len(polygon.vertices))
    together = np.concatenate(areas)
    return np.concatenate(places), together / together.sum()


def random_pose(rests, parents, random):
    """Transforms of bones from rest, (4, 4) each, each turned against its parent; parents come first."""
    posed = {}
    for name, rest in rests.items():
        above = parents[name]
        axis = random.standard_normal(3)
        turn = np.eye(4)
        turn[:3, :3] = Rotation.from_rotvec(random.uniform(-BENT, BENT) * axis / np.linalg.norm(axis)).as_matrix()
        posed[name] = rest if above is None else posed[above] @ np.linalg.inv(rests[above]) @ rest @ turn
    return {name: posed[name] @ np.linalg.inv(rest) for name, rest in rests.items()}


def row(folder, names, *, joined):
    """Return the numbers of one pair, carried over in one way."""
    bpy.ops.wm.read_homefile(use_empty=True)
    source, its = character(folder / names[0], "Source", joined=joined)
    target, others = character(folder / names[1], "Target", joined=joined)
    bones = [bone.name for bone in target.data.bones if any(bone.name in mesh.vertex_groups for mesh in its)]
    true = normalized(others, bones)
    rests = {bone.name: np.array(target.matrix_world @ bone.matrix_local) for bone in target.data.bones}
    parents = {bone.name: bone.parent.name if bone.parent else None for bone in target.data.bones}
    collection, bare = bared(others)
    for obj in (*others, target):
        bpy.data.objects.remove(obj)
    places, areas = surface(bare)
    height = np.ptp(places, axis=0).max()
    bpy.ops.object.select_all(action="DESELECT")
    before, begins = state(its), [clock() for clock in CLOCKS]
    sides = (its[0].name, bare[0].name) if joined else (source.name, collection.name)
    bpy.ops.hiermatch.retarget(
        source=sides[0],
        target=sides[1],
        use_uvs=False,
        use_shape_keys=False,
        accept_doubtful=True,
        rest_pose_like_source="OFF",
    )
    seconds = [clock() - begin for clock, begin in zip(CLOCKS, begins, strict=True)]
    got = normalized(bare, bones)
    near = np.array([[a == b or parents.get(a) == b or parents.get(b) == a for b in bones] for a in bones])
    right = near[true.argmax(axis=1), got.argmax(axis=1)] & (got.sum(axis=1) > 0)
    rig = next(one.object for mesh in bare for one in mesh.modifiers if one.type == "ARMATURE")
    used = [name for name, weight in zip(bones, true.sum(axis=0), strict=True) if weight > 0 and name in rig.data.bones]
    apart = [
        np.linalg.norm(np.array(rig.matrix_world @ rig.data.bones[name].head_local) - rests[name][:3, 3])
        for name in used
    ]
    grid = np.round(places / (COINCIDENT * np.linalg.norm(np.ptp(places, axis=0))))
    seam = np.unique(grid, axis=0, return_inverse=True)[1].ravel()
    errors, cracks, random = [], [[], []], np.random.default_rng(0)
    for _ in range(POSES):
        turned = random_pose(rests, parents, random)
        points = np.stack([places @ turned[name][:3, :3].T + turned[name][:3, 3] for name in bones], axis=1)
        posed = [np.einsum("nb,nbi->ni", weights, points) for weights in (got, true)]
        errors.append(areas @ np.linalg.norm(posed[0] - posed[1], axis=1))
        for widths, each in zip(cracks, posed, strict=True):
            widths.append(gaps(each, seam).max())
    numbers = [np.mean(apart), np.max(apart), np.mean(errors), np.max(cracks[0]), np.max(cracks[1])]
    titles = " -> ".join(Path(name).stem for name in names)
    said = "  ".join(f"{100 * number / height:6.3f}" for number in numbers)
    same = "same" if state(its) == before else "CHANGED"
    confidence = 100 * bpy.context.scene.hiermatch.summary.confidence
    return (
        f"{titles:62} {'joined' if joined else 'separate':9} {len(its)}:{len(bare)}  {areas @ right:.3f}  "
        f"{areas @ np.abs(got - true).sum(axis=1):.3f}  {said}  {same:8} {confidence:3.0f}  "
        + "  ".join(f"{each:6.1f}" for each in seconds)
    )


def normalized(meshes, bones):
    """Weights (n, b) of all vertices of meshes, whose sums are one, or zero."""
    weights = np.concatenate([weights_of(mesh, bones) for mesh in meshes])
    sums = weights.sum(axis=1, keepdims=True)
    return weights / np.where(sums > 0, sums, 1)


def gaps(places, seam):
    """How far vertices (n, 3) of the same number (n,) are apart at most, for each number."""
    ends = [np.full((seam.max() + 1, 3), sign * np.inf) for sign in (1, -1)]
    np.minimum.at(ends[0], seam, places)
    np.maximum.at(ends[1], seam, places)
    return np.linalg.norm(ends[1] - ends[0], axis=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the characters")
    parser.add_argument("--only", help="pairs of files, SOURCE:TARGET,... (default: all of one family)")
    parser.add_argument("--ways", default="joined,separate", help="which ways (default: joined,separate)")
    options = parser.parse_args()
    registered_extension()
    every = [pair for family in FAMILIES for pair in permutations(family, 2)]
    for names in [tuple(pair.split(":")) for pair in options.only.split(",")] if options.only else every:
        for way in options.ways.split(","):
            print("ROW", row(options.data, names, joined=way == "joined"), flush=True)


if __name__ == "__main__":
    main()
