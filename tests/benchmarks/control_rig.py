# SPDX-License-Identifier: GPL-3.0-or-later
"""Find the controls of the human that Rigify makes, and pose it by them: how long it takes, and how exactly bones turn.

    python -m tests.benchmarks.control_rig [--poses 100] [--seed 1] [--segments 200]

The rig is that of Blender's *Human (Meta-Rig)*, as it comes from *Generate Rig*, with a ball of half the square of
`--segments` vertices that it moves; none if that is zero.  All limbs, fingers, the spine and the head swing at random,
128 poses at a time as while a window is drawn.  Printed are the bones of the rig, how many of those with partners are
turned by a control, the seconds of one core in which these controls are found, those of a hundred poses, and by how
many degrees bones point elsewhere than they should.
"""

import argparse
import time
from types import SimpleNamespace

import bpy
import numpy as np
from scipy.spatial.transform import Rotation

from engine.runtime.progress import run
from tools.source_extension import registered_extension

FACE = ("lip", "brow", "lid", "cheek", "nose", "jaw", "chin", "temple", "ear", "forehead", "tongue", "eye", "teeth")
BESIDE = ("breast", "pelvis", "palm")
SWING = 0.3
"""Standard deviation of the angles, in radians."""

AT_ONCE = 128


def human():
    """The rig, and the names of its deforming bones but for those of the face."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.preferences.addon_enable(module="rigify")
    bpy.ops.object.armature_human_metarig_add()
    bpy.ops.pose.rigify_generate()
    rig = next(obj for obj in bpy.data.objects if obj.type == "ARMATURE" and "DEF-spine" in obj.data.bones)
    names = [bone.name for bone in rig.data.bones if bone.use_deform]
    return rig, [name for name in names if not any(part in name for part in FACE + BESIDE)]


def ball(rig, names, segments):
    """Let a rig move a ball, each bone some of it."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=segments // 2)
    obj = bpy.context.object
    obj.modifiers.new("Rig", "ARMATURE").object = rig
    for number, name in enumerate(names):
        group = obj.vertex_groups.new(name=name)
        group.add(range(number, len(obj.data.vertices), len(names)), 1.0, "REPLACE")
    bpy.context.view_layer.update()


def swings(rig, names, count, random):
    """Turns (f, k, 3, 3) of bones against their rest, each with those above, and their heads (f, k, 3)."""
    angles, phases = SWING * random.standard_normal((len(names), 3)), random.uniform(0, 6, (len(names), 3))
    turns = np.empty((count, len(names), 3, 3))
    for number in sorted(range(len(names)), key=lambda i: len(rig.data.bones[names[i]].parent_recursive)):
        above = next(
            (names.index(b.name) for b in rig.data.bones[names[number]].parent_recursive if b.name in names), -1
        )
        own = Rotation.from_rotvec(
            angles[number] * np.sin(phases[number] + 0.1 * np.arange(count)[:, None])
        ).as_matrix()
        turns[:, number] = own if above < 0 else turns[:, above] @ own
    heads = np.array([rig.data.bones[name].head_local for name in names])
    return turns, np.tile(heads, (count, 1, 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--poses", type=int, default=100, help="how many (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the swings (default %(default)s)")
    parser.add_argument("--segments", type=int, default=200, help="of a ball that the rig moves (default %(default)s)")
    options = parser.parse_args()
    registered_extension()
    from hiermatch.hiermatch_addon.scene.motion.control_pose_io import posed_controls
    from hiermatch.hiermatch_addon.transfers.motion.steered_rig import steered_steps

    rig, names = human()
    if options.segments:
        ball(rig, names, options.segments)
    every = [bone.name for bone in rig.data.bones]
    moved, rooted = np.isin(every, names), np.isin(every, ["DEF-spine"])
    start = time.process_time()
    steered = run(steered_steps(SimpleNamespace(find=lambda: rig), SimpleNamespace(moved=moved, rooted=rooted)))
    found = time.process_time()
    turning = list(steered.controls.turning)
    turns, heads = swings(rig, turning, options.poses, np.random.default_rng(options.seed))
    begin = time.process_time()
    parts = [slice(first, first + AT_ONCE) for first in range(0, options.poses, AT_ONCE)]
    posed = [posed_controls(rig, steered.controls, turns[part], heads[part]) for part in parts]
    missed = np.degrees(np.concatenate([missed for _, missed, _ in posed]))
    seconds = (time.process_time() - begin) * 100 / options.poses
    print(f"{len(every)} bones, {len(turning)} of {len(names)} turned by controls, found in {found - start:.1f} s")
    print(f"100 poses in {seconds:.1f} s; bones point elsewhere by {missed.max():.4f} degrees at most")


if __name__ == "__main__":
    main()
