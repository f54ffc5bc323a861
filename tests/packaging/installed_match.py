# SPDX-License-Identifier: GPL-3.0-or-later
"""Match two meshes with the installed extension, and write what came of it as JSON.

Runs inside Blender or beside its module, never in pytest's own process:
    python installed_match.py -- REPORT.json --install ZIP
    blender --background --python-exit-code 1 --python installed_match.py -- REPORT.json

Source and target are one creature, star-shaped about its own origin, on an ico sphere and on a UV sphere of quads; the
target lies elsewhere, turned and ten times larger.  A matched point's direction from the origin says where it belongs.
"""

import argparse
import importlib
import json
import os
import sys
from pathlib import Path

import bpy
import numpy as np

POINTS = 24

# Direction, length and sharpness of each limb; no symmetry maps the creature to itself.
LIMBS = [
    ((1.0, 0.2, 0.1), 2.0, 14.0),
    ((-0.3, 1.0, -0.2), 1.4, 10.0),
    ((-0.5, -0.8, 0.3), 1.7, 18.0),
    ((0.1, -0.3, 1.0), 1.0, 8.0),
    ((0.3, 0.2, -1.0), 0.7, 9.0),
]


def on_creature(points):
    """Move points, away from or towards the origin, onto the surface."""
    directions = points / np.linalg.norm(points, axis=1, keepdims=True)
    radius = np.ones(len(points))
    for axis, length, sharpness in LIMBS:
        towards = directions @ (np.array(axis) / np.linalg.norm(axis))
        radius += length * np.exp(sharpness * (towards - 1.0))
    return directions * radius[:, None]


def coordinates(mesh):
    flat = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", flat)
    return flat.reshape(-1, 3).astype(np.float64)


def add_creature(name, add_sphere, **options):
    """Add an object of this name, whose vertices are those of a sphere that Blender adds."""
    add_sphere(radius=1.0, **options)
    creature = bpy.context.object
    creature.name = name
    creature.data.vertices.foreach_set("co", on_creature(coordinates(creature.data)).astype(np.float32).ravel())
    creature.data.update()
    return creature


def matched_points(target):
    """Return the positions of the points that the vertex groups name, and the groups' sizes and sums of weights."""
    xyz = coordinates(target.data)
    members = [[] for _ in target.vertex_groups]
    for vertex in target.data.vertices:
        for element in vertex.groups:
            members[element.group].append((vertex.index, element.weight))
    positions = [sum(weight * xyz[index] for index, weight in corners) for corners in members]
    groups = {
        group.name: {"vertices": len(corners), "weight": sum(weight for _, weight in corners)}
        for group, corners in zip(target.vertex_groups, members, strict=True)
    }
    return np.array(positions), groups


def mapped_points(mesh, image):
    """Return where the dense map brings every vertex of a mesh, and its confidence."""
    corners = np.empty((3, len(mesh.vertices)), dtype=np.int32)
    for number, row in enumerate(corners, start=1):
        mesh.attributes[f"HM Map Vertex {number}"].data.foreach_get("value", row)
    weights = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["HM Map Weights"].data.foreach_get("vector", weights)
    confidence = np.empty(len(mesh.vertices), dtype=np.float32)
    mesh.attributes["HM Map Confidence"].data.foreach_get("value", confidence)
    return np.einsum("nc,cnd->nd", weights.reshape(-1, 3), coordinates(image)[corners]), confidence


def dense_map(source, target):
    """Return how well the map between two creatures, each way, hits the places where their vertices belong."""
    ways = []
    for mesh, image in ((source, target), (target, source)):
        places, confidence = mapped_points(mesh, image)
        errors = np.linalg.norm(on_creature(places) - on_creature(coordinates(mesh)), axis=1)
        ways.append(
            {
                "mean_error": float(errors.mean() / np.linalg.norm(np.ptp(coordinates(mesh), axis=0))),
                "confidence": [float(confidence.min()), float(confidence.max())],
            }
        )
    return ways


def staleness():
    """Return what the panel says of the match now; in the background nothing looks by itself."""
    addon = bpy.types.HIERMATCH_PT_match.__module__.rsplit(".", 2)[0]
    importlib.import_module(f"{addon}.properties.freshness").refresh(bpy.context.scene)
    return bpy.context.scene.hiermatch.summary.stale


def run_reopened(file):
    """Save the match, open the file again, and edit the target."""
    summary = bpy.context.scene.hiermatch.summary
    said = {"verdict": summary.verdict, "confidence": summary.confidence}
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    bpy.ops.wm.open_mainfile(filepath=str(file))
    source, target = bpy.data.objects["Source"], bpy.data.objects["Target"]
    ways, untouched = dense_map(source.data, target.data), staleness()
    target.data.vertices[0].co *= 1.1
    return said | {"ways": ways, "stale": [untouched, staleness()]}


def run_match():
    source = add_creature("Source", bpy.ops.mesh.primitive_ico_sphere_add, subdivisions=5)
    target = add_creature("Target", bpy.ops.mesh.primitive_uv_sphere_add, segments=72, ring_count=36)
    target.location, target.rotation_euler, target.scale = (30.0, -5.0, 2.0), (0.4, 1.1, -2.0), (10.0, 10.0, 10.0)
    bpy.context.view_layer.update()
    status = bpy.ops.hiermatch.match(source="Source", target="Target", points=POINTS)

    import scipy  # only now: it must be the extension's own doing that there is one

    source_points, source_groups = matched_points(source)
    target_points, target_groups = matched_points(target)
    errors = np.linalg.norm(on_creature(source_points) - on_creature(target_points), axis=1)
    return {
        "status": sorted(status),
        "groups": [source_groups, target_groups],
        "attributes": [sorted(matched.data.attributes.keys()) for matched in (source, target)],
        "mean_error": float(errors.mean() / np.linalg.norm(np.ptp(coordinates(source.data), axis=0))),
        "scipy": {"file": scipy.__file__, "version": scipy.__version__},
        "leaked_modules": sorted({"engine", "hiermatch_addon"} & set(sys.modules)),
        "blender": list(bpy.app.version),
        "python": list(sys.version_info[:2]),
        "numpy": np.__version__,
    }


def group_values(creature, name):
    """Return the weights of all vertices in a group."""
    number = creature.vertex_groups[name].index
    return np.array([sum(e.weight for e in vertex.groups if e.group == number) for vertex in creature.data.vertices])


def run_retarget():
    """Carry a rig, weights, a shape key and UVs from the standing demo cat to the walking one, and bend a leg."""
    status = bpy.ops.hiermatch.retarget(source="Demo Cat Standing", target="Demo Cat Walking")
    source, target = bpy.data.objects["Demo Cat Standing"], bpy.data.objects["Demo Cat Walking"]

    def rest(cat):
        flat = np.empty(3 * len(cat.data.vertices), dtype=np.float32)
        cat.data.attributes["hm_rest"].data.foreach_get("vector", flat)
        return flat.reshape(-1, 3)

    def shown():
        bpy.context.view_layer.update()
        evaluated = target.evaluated_get(bpy.context.evaluated_depsgraph_get())
        places = coordinates(evaluated.to_mesh())
        evaluated.to_mesh_clear()
        return places

    armature = next(modifier.object for modifier in target.modifiers if modifier.type == "ARMATURE")
    bones = [bone.name for bone in armature.data.bones]
    nearest = np.array([np.square(rest(source) - place).sum(axis=1).argmin() for place in rest(target)])
    errors = sum(np.abs(group_values(target, name) - group_values(source, name)[nearest]) for name in bones)
    before = shown()
    bone = armature.pose.bones["upper_arm.L"]
    bone.rotation_mode = "XYZ"
    bone.rotation_euler = (-0.7, 0.0, 0.0)
    moved = np.linalg.norm(shown() - before, axis=1) / np.linalg.norm(np.ptp(before, axis=0))
    return {
        "status": sorted(status),
        "bones": len(bones),
        "bound": float(np.abs(before - coordinates(target.data)).max() / np.ptp(before)),
        "weight_error": float(errors.mean()),
        "moved": [float(moved.max()), float(moved[group_values(target, "head") > 0.5].max())],
        "keys": list(target.data.shape_keys.key_blocks.keys()),
        "uvs": list(target.data.uv_layers.keys()),
        "notes": bpy.context.scene.hiermatch_retarget.report.notes,
    }


def run_demo():
    """Add the demo pair and match it; what is written is looked at elsewhere."""
    before = set(bpy.data.objects)
    status = [bpy.ops.hiermatch.add_demo_pair(source_vertices=2000, target_vertices=1000, rigged=True)]
    source, target = sorted(
        (added for added in set(bpy.data.objects) - before if added.type == "MESH"), key=lambda added: added.name
    )
    status.append(bpy.ops.hiermatch.match(source=source.name, target=target.name, points=16))
    written = len(source.vertex_groups)
    status.append(bpy.ops.hiermatch.clear(object=source.name))
    return {"status": [sorted(step) for step in status], "groups": [written, len(source.vertex_groups)]}


def main(arguments):
    parser = argparse.ArgumentParser(prog="installed_match.py")
    parser.add_argument("report", type=Path)
    parser.add_argument("--install", type=Path)
    options = parser.parse_args(arguments)
    if options.install is not None:
        bpy.ops.extensions.package_install_files(
            filepath=str(options.install), repo="user_default", enable_on_install=True, overwrite=True
        )
    report = run_match() | {"dense": run_reopened(options.report.with_suffix(".blend"))} | {"demo": run_demo()}
    report["retarget"] = run_retarget()
    options.report.write_text(json.dumps(report, indent=1), encoding="utf-8")


main(sys.argv[sys.argv.index("--") + 1 :])
# Blender 4.5 as a module, once it has opened a file, may wait at exit for ever for a thread of its own.
sys.stdout.flush()
sys.stderr.flush()
os._exit(0)
