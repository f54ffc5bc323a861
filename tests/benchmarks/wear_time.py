# SPDX-License-Identifier: GPL-3.0-or-later
"""Time that an outfit takes to be fitted to another body, beside the match.

    python -m tests.benchmarks.wear_time [--vertices 20000] [--resolution 40] [--profile 25]

A person with a rig wears five items: shirt, trousers, coat, gloves and socks, made of its skin, with about so many
vertices in all; another, of other proportions and in another rest pose, has a rig of its own with other names.  The
bodies are matched and the rig is fitted to sharpen the map, once; then everything goes through the button *Wear*.  Told
are seconds of one core.  --profile lists so many functions by their own time.
"""

import argparse
import cProfile
import os
import pstats
import time

os.environ.setdefault("HIERMATCH_PROCESSES", "1")

import bpy
import numpy as np

from tools.source_extension import registered_extension

registered_extension()

from tests.addon.characters import add_skeleton  # noqa: E402
from tests.addon.rigs import add_mesh, add_weights  # noqa: E402
from tests.people import HANGING, at_rest_in, person, renamed  # noqa: E402

ITEMS = {
    "Shirt": (0.01, lambda x, z: (z > 0.95) & (z < 1.5) & (np.abs(x) < 0.6)),
    "Trousers": (0.01, lambda x, z: (z > 0.15) & (z < 1.05) & (np.abs(x) < 0.35)),
    "Coat": (0.03, lambda x, z: (z > 0.7) & (z < 1.5) & (np.abs(x) < 0.65)),
    "Gloves": (0.006, lambda x, z: (z > 1.2) & (np.abs(x) > 0.62)),
    "Socks": (0.005, lambda x, z: (z < 0.3) & (np.abs(x) < 0.35)),
}
"""How far items are from the skin, in metres, and where they are."""


def add_body(name, mesh, rig):
    """Add a person with its rig, and return its armature."""
    armature = add_skeleton(f"{name} Rig", rig)
    add_part(name, (mesh.vertices, mesh.triangles), armature, rig.names, rig.weights)
    return armature


def add_part(name, surface, armature, names, weights):
    """Add a mesh that an armature moves."""
    obj = add_mesh(name, *surface)
    add_weights(obj, weights, names)
    obj.modifiers.new("Armature", "ARMATURE").object = armature
    return obj


def add_item(name, resolution, armature, wanted):
    """Add an item with about so many vertices."""
    away, where = ITEMS[name]
    for _ in range(2):  # the finer the body, the more vertices the item has
        body = person(resolution)
        x, _, z = body.mesh.vertices.T
        chosen = where(x, z)[body.mesh.triangles].all(axis=1)
        used, triangles = np.unique(body.mesh.triangles[chosen], return_inverse=True)
        resolution *= np.sqrt(wanted / len(used))
    places = (body.mesh.vertices + away * body.mesh.vertex_normals)[used]
    return add_part(name, (places, triangles.reshape(-1, 3)), armature, body.rig.names, body.rig.weights[used])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vertices", type=int, default=20000, help="of all items (default %(default)s)")
    parser.add_argument("--resolution", type=int, default=40, help="of the bodies (default %(default)s)")
    parser.add_argument("--profile", type=int, default=0, help="functions to list")
    options = parser.parse_args()
    bpy.ops.wm.read_homefile(use_empty=True)
    source = person(options.resolution)
    target = at_rest_in(person(options.resolution, turn=0.3, legs=1.1, arms=0.9, girth=1.2), HANGING)
    armature = add_body("Source", source.mesh, source.rig)
    add_body("Target", target.mesh, renamed(target.rig))
    each = options.vertices / len(ITEMS)
    made = [add_item(name, options.resolution, armature, each) for name in ITEMS]
    print("vertices:", ", ".join(f"{obj.name} {len(obj.data.vertices)}" for obj in made), flush=True)
    start = time.process_time()
    bpy.ops.hiermatch.transfer_weights(source="Source", target="Target")
    print(f"match, rig and weights of the body: {time.process_time() - start:.1f} s", flush=True)
    profile = cProfile.Profile()
    start = time.process_time()
    if options.profile:
        profile.enable()
    bpy.ops.hiermatch.wear(source="Source", target="Target", items=[{"name": obj.name} for obj in made])
    profile.disable()
    print(f"wear: {time.process_time() - start:.1f} s", flush=True)
    if options.profile:
        pstats.Stats(profile).sort_stats("tottime").print_stats(options.profile)


if __name__ == "__main__":
    main()
