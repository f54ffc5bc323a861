# SPDX-License-Identifier: GPL-3.0-or-later
"""Put clothes of characters for games on the body of another maker, and measure where its skin shows.

    python -m tests.benchmarks.worn_makers --data FOLDER [--only Suit,King] [--remeshed] [--save F] [--pictures F]

FOLDER holds the files of `CASES`.  Characters are taken apart: what is named there are the items, what is left is the
body, which has no skin below most of them.  Everything goes through import and the button *Wear*.

A row holds the confidence of the match in %; what part of the skin below the items shows through them, by area, in %:
at rest, in the mean of three poses, in the worst of them, in the mean of a squat and of a raised thigh, and in a
stride; how far what is worn on the trunk stands off the skin at rest, in % of the body's height (the 99th percentile of
its vertices); how far what is worn on the legs is higher or lower than on the source, in % of either's height (the 95th
percentile); how far it is from even at rest, on the mean: from each vertex to the mirror image of its partner, in % of
the height; and the seconds of one core that it took.
--remeshed leaves the target 6,000 triangles, whose corners are no mirror images of one another.
--save keeps a .blend of each case, to look at; --pictures renders each: the source, the target from four sides, and
in the six poses.
"""

import argparse
import os
import re
import time
from pathlib import Path

os.environ.setdefault("HIERMATCH_PROCESSES", "1")

import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector
from mathutils.bvhtree import BVHTree
from scipy.spatial import cKDTree

from engine import ClosestPoints, TriangleMesh
from tests.benchmarks.action_strip import shown_surface
from tests.benchmarks.maker_rigs import limb
from tools.demo_picture import render, set_stage, sheet
from tools.source_extension import registered_extension

MEN, WOMEN = "quaternius-modular_men", "quaternius-modular_women"
OWN = {
    "Suit": (f"{MEN}-Suit", "m2m-human-male", {"Suit_Body": None, "Suit_Legs": None, "Suit_Feet": None}),
    "King": (
        f"{MEN}-King",
        "m2m-human-male",
        {"King_Head": "Gold", "King_Body": "Blue Metal Beige Metal_Dark", "King_Legs": None, "King_Feet": None},
    ),
    "Witch": (
        f"{WOMEN}-Witch",
        "m2m-human-female",
        {"Witch_Head": "Purple Gold Brown Hair_Black", "Witch_Body": "Purple Gold Brown2", "Witch_Legs": None}
        | {"Witch_Feet": None},
    ),
    "Casual": (
        f"{WOMEN}-Casual",
        "m2m-human-female",
        {"Casual_Head": "Hair_Blond Hair_Brown", "Casual_Body": "White", "Casual_Legs": None, "Casual_Feet": "Grey"},
    ),
    "Formal": (
        f"{WOMEN}-Formal",
        "m2m-human-female",
        {"Formal_Head": "Red", "Formal_Body": "LimeGreen Gold", "Formal_Legs": "LimeGreen", "Formal_Feet": "Red"},
    ),
}
"""What was looked at while *Wear* was made."""

OTHER_SEX = {
    f"{case} on {kind}": (OWN[case][0], f"m2m-human-{kind}", OWN[case][2])
    for kind, cases in (("female", ("Suit", "King")), ("male", ("Witch", "Casual", "Formal")))
    for case in cases
}
CASES = (
    OWN
    | OTHER_SEX
    | {
        f"men-Casual on {kind}": (
            f"{MEN}-Casual",
            f"m2m-human-{kind}",
            {"Casual_Body": None, "Casual_Legs": None, "Casual_Feet": None},
        )
        for kind in ("male", "female")
    }
    | {"Suit on Casual": (OWN["Suit"][0], f"{WOMEN}-Casual", OWN["Suit"][2])}
    | {"Formal on Casual": (OWN["Formal"][0], f"{WOMEN}-Casual", {"Formal_Body": None, "Formal_Legs": None})}
)
"""Of each case the file of the source and of the target, and the items: objects, or their faces of some materials."""

POSES = (
    {("upper_arm", "L"): (0, 0.9, 0), ("upper_leg", "L"): (0.8, 0, 0), ("lower_leg", "L"): (-0.8, 0, 0)},
    {("upper_arm", "R"): (0, 1.0, 0), ("upper_arm", "L"): (0, -1.0, 0)},
    {("upper_arm", "L"): (0, 0, -1.2), ("lower_arm", "L"): (0, 0, -0.9), ("upper_leg", "R"): (1.3, 0, 0)},
)
"""By what angles limbs are turned about the axes of the world, in radians."""

RAISED = (
    {(part, side): (turn, 0, 0) for part, turn in (("upper_leg", -1.4), ("lower_leg", 1.6)) for side in "LR"},
    {("upper_leg", "L"): (-1.57, 0, 0), ("lower_leg", "L"): (1.5, 0, 0)},
)
"""The same of a squat, and of one thigh that is raised."""

STRIDE = ({("upper_leg", side): (turn, 0, 0) for side, turn in (("L", 0.6), ("R", -0.6))},)
"""The same of a stride, one leg forward and one back as far as in a walk."""

SHOWS = 0.00002, 0.015
"""How far above an item, in the root of the body's area, skin shows: nearer the two are one, farther away it is beside
it, as at a neckline."""

NEAR = 0.03
"""How far from an item, in the same unit, skin is below it."""


SAME = 1e-3
"""How far a vertex of an item may be from the mirror image of its partner, in units of the body's height."""

REMESHED, SHAKEN = 6000, 3e-4
"""Triangles that are left of a target that is remeshed, and how far its vertices are shaken before, in its size."""

WAIST = 0.58
"""How high what is worn on the legs is worn on the trunk, as a part of the height."""

WIDTH, HEIGHT, SAMPLES = 420, 600, 24
"""Size of each picture in pixels, and how often each pixel is looked at."""

SIDES = (-35, 55, 145, 235)
"""From where the target is seen, in degrees around Z from the front."""

PLACES = np.array(
    [
        np.array([i, j, sides - i - j]) / 4 + (4 - sides) / 12
        for sides in (3, 2)
        for i in range(sides + 1)
        for j in range(sides + 1 - i)
    ]
)
"""Where on a triangle of the skin is looked: the middles of 16 equal parts, in barycentric coordinates."""


def added(path, name):
    """Import a character: its armature, and its meshes by name."""
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=str(path))
    new = [obj for obj in bpy.data.objects if obj not in before]
    rig = next(obj for obj in new if obj.type == "ARMATURE")
    rig.name = name
    rig.animation_data_clear()
    for bone in rig.pose.bones:
        bone.matrix_basis = Matrix()
    parts = {}
    for obj in new:
        if obj.type == "MESH" and obj.vertex_groups:
            parts[obj.name.split(".")[0]] = obj
        elif obj.type == "MESH":  # what shows bones in the view
            bpy.data.objects.remove(obj)
    return rig, parts


def taken_out(obj, materials):
    """Make the faces of some materials an object of their own."""
    import bmesh  # only there once bpy is

    part = obj.copy()
    part.data = obj.data.copy()
    obj.users_collection[0].objects.link(part)
    names = [re.sub(r"\.\d+$", "", material.name) for material in obj.data.materials]
    for one, kept in ((part, True), (obj, False)):
        build = bmesh.new()
        build.from_mesh(one.data)
        others = [face for face in build.faces if (names[face.material_index] in materials) != kept]
        bmesh.ops.delete(build, geom=others, context="FACES")
        build.to_mesh(one.data)
        build.free()
    return part


def remesh(obj):
    """Give a mesh fewer vertices, which are no mirror images of one another, with their weights."""
    import bmesh  # only there once bpy is

    for modifier in obj.modifiers:
        modifier.show_viewport = False
    build = bmesh.new()
    build.from_mesh(obj.data)
    size, random = max(obj.dimensions), np.random.default_rng(0)
    bmesh.ops.remove_doubles(build, verts=build.verts, dist=1e-5 * size)
    for vertex in build.verts:  # which edges are left out should differ between both sides
        vertex.co += Vector(random.normal(scale=SHAKEN * size, size=3))
    build.to_mesh(obj.data)
    build.free()
    obj.data.calc_loop_triangles()
    fewer = obj.modifiers.new("Fewer", "DECIMATE")
    fewer.ratio = REMESHED / len(obj.data.loop_triangles)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown = obj.evaluated_get(depsgraph)
    obj.data = bpy.data.meshes.new_from_object(shown, preserve_all_data_layers=True, depsgraph=depsgraph)
    obj.modifiers.remove(fewer)
    for modifier in obj.modifiers:
        modifier.show_viewport = True


def through(body, items):
    """Which places of the skin (m, 16) have an item near, and which of these are above it, with no other above."""
    unit = np.sqrt(body.area)
    places = np.einsum("pc,mci->mpi", PLACES, body.vertices[body.triangles])
    shape, places = places.shape[:2], places.reshape(-1, 3)
    normals = body.triangle_normals.repeat(len(PLACES), axis=0)
    found = ClosestPoints(items).nearest(places)
    away = found.interpolate(items.triangles, items.vertices) - places
    heights = np.einsum("ki,ki->k", away, normals)
    aside = np.linalg.norm(away - heights[:, None] * normals, axis=1)
    close = (np.abs(heights) < NEAR * unit) & (aside < np.abs(heights) + SHOWS[0] * unit)
    tree = BVHTree.FromPolygons(items.vertices.tolist(), items.triangles.tolist())
    hits = (tree.ray_cast(*ray, NEAR * unit)[0] for ray in zip(places.tolist(), normals.tolist(), strict=True))
    above = np.array([hit is not None for hit in hits])
    showing = close & (heights < -SHOWS[0] * unit) & (heights > -SHOWS[1] * unit) & ~above
    return (close | above).reshape(shape), showing.reshape(shape)


def bend(rig, turns):
    """Turn limbs about the axes of the world by some angles, and have the others at rest."""
    for bone in rig.pose.bones:
        bone.matrix_basis = Matrix()
        turn = turns.get(limb(bone.name))
        if turn is not None:
            axes = (rig.matrix_world @ bone.bone.matrix_local).to_3x3()
            bone.rotation_mode = "QUATERNION"
            bone.rotation_quaternion = (axes.inverted() @ Euler(turn).to_matrix() @ axes).to_quaternion()
    bpy.context.view_layer.update()


def shown(rig, bodies, items):
    """What part of the skin below items shows, by area: at rest, and in each pose."""
    parts, below = [], None
    for turns in ({}, *POSES, *RAISED, *STRIDE):
        bend(rig, turns)
        body = TriangleMesh(*shown_surface(bodies))
        near, shows = through(body, TriangleMesh(*shown_surface(items)))
        if below is None:
            below = body.triangle_areas[:, None] * near
        parts.append(below[shows].sum() / below.sum())
    return parts


def stands_off(bodies, items):
    """How far above the skin what is worn on the trunk is at the 99th percentile, as a part of the height."""
    body = TriangleMesh(*shown_surface(bodies))
    upper, lower = ([item for item in items if name in item["hiermatch_item"]] for name in ("Body", "Legs"))
    points, below = shown_surface(upper)[0], shown_surface(lower)[0]
    points = np.concatenate([points, below[below[:, 2] > WAIST * body.vertices[:, 2].max()]])
    found = ClosestPoints(body).nearest(points)
    away = points - found.interpolate(body.triangles, body.vertices)
    above = np.einsum("ki,ki->k", away, body.triangle_normals[found.triangles])
    return np.quantile(above, 0.99) / np.ptp(body.vertices[:, 2])


def shifted(skin, bodies, items):
    """How far what is worn on the legs is shifted up or down, at the 95th percentile, as a part of either's height."""
    originals = [bpy.data.objects[item["hiermatch_item"]] for item in items]
    chosen = [number for number, item in enumerate(originals) if "Legs" in item.name]
    top, ground = shown_surface(skin)[0][:, 2].max(), shown_surface([*skin, *originals])[0][:, 2].min()
    before = (shown_surface([originals[number] for number in chosen])[0][:, 2] - ground) / (top - ground)
    heights = shown_surface(bodies)[0][:, 2]
    after = (shown_surface([items[number] for number in chosen])[0][:, 2] - heights.min()) / np.ptp(heights)
    return np.quantile(np.abs(after - before), 0.95)


def uneven(bodies, items):
    """How far items are from the mirror images of their partners in the plane x = 0, as a part of the height."""
    apart = []
    for item in items:
        before = shown_surface([bpy.data.objects[item["hiermatch_item"]]])[0]
        distances, partners = cKDTree(before).query(before * [-1, 1, 1])
        after = shown_surface([item])[0]
        paired = distances < SAME * np.ptp(before[:, 2])
        apart.append(np.linalg.norm(after[paired] - after[partners[paired]] * [-1, 1, 1], axis=1))
    return np.concatenate(apart).mean() / np.ptp(shown_surface(bodies)[0][:, 2])


def picture(rig, source, target, path):
    """Render the meshes of the source, those of the target from four sides, and in each pose, on one sheet."""
    views = [
        (source, {}, SIDES[0]),
        *((target, {}, side) for side in SIDES),
        *((target, one, SIDES[0]) for one in (*POSES, *RAISED, *STRIDE)),
    ]
    meshes = [obj for obj in bpy.data.objects if obj.type == "MESH"]
    paths = [path.with_name(f"{path.stem}-{number}.png") for number in range(len(views))]
    for (seen, turns, side), one in zip(views, paths, strict=True):
        bend(rig, turns)
        for obj in meshes:
            obj.hide_render = obj not in seen
        known = set(bpy.data.objects)
        set_stage(seen, (side, 8), WIDTH, HEIGHT)
        if turns:  # limbs that are bent reach further
            camera = bpy.context.scene.camera
            camera.location += 0.25 * (camera.location - rig.matrix_world.translation)
        render(one, SAMPLES)
        for obj in set(bpy.data.objects) - known:
            bpy.data.objects.remove(obj)
    sheet([paths[:5], paths[5:]], path)
    for one in paths:
        one.unlink()


def wear(case, data, *, remeshed=False):
    """Put the items of a case on the other body: its armature, its meshes, the fitted items, and the source's skin."""
    source, target, chosen = CASES[case]
    rig, parts = added(data / f"{source}.glb", "Source")
    other, bodies = added(data / f"{target}.glb", "Target")
    for body in bodies.values() if remeshed else ():
        remesh(body)
    items = [taken_out(parts[name], kinds.split()) if kinds else parts[name] for name, kinds in chosen.items()]
    bpy.context.view_layer.update()
    bpy.ops.hiermatch.wear(source=rig.name, target=other.name, items=[{"name": item.name} for item in items])
    fitted = [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.get("hiermatch_body")]
    return other, list(bodies.values()), fitted, [part for part in parts.values() if part not in items]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the characters")
    parser.add_argument("--only", default=",".join(OWN), help="names of cases, separated by commas, or all")
    parser.add_argument("--remeshed", action="store_true", help="give the target other vertices")
    parser.add_argument("--save", type=Path, help="folder for the .blend files")
    parser.add_argument("--pictures", type=Path, help="folder for the pictures")
    options = parser.parse_args()
    registered_extension()
    print(
        f"{'case':18s} confidence   at rest  in poses     worst    raised    stride       off"
        "   shifted    uneven  seconds"
    )
    for case in CASES if options.only == "all" else options.only.split(","):
        bpy.ops.wm.read_homefile(use_empty=True)
        start = time.process_time()
        rig, bodies, items, skin = wear(case, options.data, remeshed=options.remeshed)
        seconds = time.process_time() - start
        off = stands_off(bodies, items), shifted(skin, bodies, items), uneven(bodies, items)
        rest, *poses = shown(rig, bodies, items)
        poses, raised, stride = poses[: len(POSES)], poses[len(POSES) : -1], poses[-1]
        said = re.search(r"Confidence (\d+)", bpy.context.scene.hiermatch_retarget.report.verdict)
        numbers = "".join(
            f"{100 * part:10.2f}" for part in (rest, np.mean(poses), max(poses), np.mean(raised), stride, *off)
        )
        print(f"{case:18s} {said[1] if said else '-':>10s}{numbers}{seconds:9.1f}", flush=True)
        if options.save:
            options.save.mkdir(parents=True, exist_ok=True)
            bpy.ops.wm.save_as_mainfile(filepath=str(options.save / f"{case}.blend"))
        if options.pictures:
            options.pictures.mkdir(parents=True, exist_ok=True)
            worn = [bpy.data.objects[item["hiermatch_item"]] for item in items]
            picture(rig, [*skin, *worn], [*bodies, *items], options.pictures / f"{case}.png")


if __name__ == "__main__":
    main()
