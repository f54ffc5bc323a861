# SPDX-License-Identifier: GPL-3.0-or-later
"""Pair the bones of characters of several makers, and let one walk as the other does.

    python -m tests.benchmarks.maker_rigs --data FOLDER [--only SOURCE:TARGET,...] [--feet] [--action NAME]
                                         [--guided] [--save FOLDER] [--strips FOLDER]

FOLDER holds rigged characters as .glb or .vrm files. Without --only these are all pairs of people of different makers,
and of four-legged animals, that are named in `PEOPLE` and `ANIMALS`, each once. Everything goes through the buttons:
import, Pair Bones, Retarget Action. NAME is a part of the name of the action, "walk" if not given; a source without one
gets a walk, by what its limbs are called.

A row holds the confidence of the match in %; how many limb bones of the target are paired right, of those that the
source has as well, told by names; how many are paired with the other side; the mean and the largest angle between
upper and lower limbs of source and target over the action, each as seen from its own front, in degrees (not for
animals, whose legs are built in other pieces); how far the lowest point of the target is below the ground at most, and
how far the source is below its own, both in % of the height; and the seconds of one core that pairing, match included,
and the motion took. --feet is *Feet on Ground*; --guided gives the tips of hands and feet as landmarks. --save keeps a
.blend of each pair, and --strips a strip of frames of both, to look at.
"""

import argparse
import os
import re
import time
from itertools import combinations
from pathlib import Path

os.environ.setdefault("HIERMATCH_PROCESSES", "1")

import bpy
import numpy as np
from mathutils import Quaternion, Vector

from tests.benchmarks.action_strip import draw_strip
from tools.source_extension import registered_extension

PEOPLE = {
    "K": ("kaykit-knight.glb",),
    "C": ("cryptovoxels.vrm",),
    "M": ("m2m-human-male.glb", "m2m-human-female.glb"),
    "Q": ("quaternius-modular_men-Casual.glb", "quaternius-modular_women-Casual.glb"),
}
"""Files of people by maker; those that have an action first."""

ANIMALS = {
    "Q": ("quaternius-animals_pack-Fox.glb", "quaternius-animals_pack-Husky.glb"),
    "M": ("m2m-fox-animations.glb", "m2m-fox-cat.glb", "m2m-fox-dog.glb"),
}

LIMBS = {
    "upper_arm": r"upper_?arm|(left|right) arm",
    "lower_arm": r"lower_?arm|(left|right) elbow",
    "hand": r"hand|(left |right )?wrist",
    "upper_leg": r"thigh|upper_?leg|(left|right) leg",
    "lower_leg": r"calf|lower_?leg|(left|right) knee",
    "foot": r"foot|(left|right) ankle",
}
"""What limbs are called."""

MIXAMO = {"arm": "upper_arm", "forearm": "lower_arm", "hand": "hand", "upleg": "upper_leg", "leg": "lower_leg"}
MIXAMO["foot"] = "foot"
"""And by Mixamo, after the side."""

LEGS = {"front": r"(ik)?front_?(leg|shoulder|upper|lower).*|ff", "back": r"(ik)?back_?(leg|shoulder|upper|lower).*|ffb"}
"""And the legs of animals with their feet, whose bones are only told apart by leg."""

AFTER = {"upper_arm": "lower_arm", "lower_arm": "hand", "upper_leg": "lower_leg", "lower_leg": "foot"}
FRAMES = 9
SHOWN = 8


def limb(name, table=None):
    """What a bone does, and on which side; None if it is no limb."""
    mixamo = re.fullmatch(r"mixamorig\d*:(left|right)(\w+)", name.lower())
    if mixamo is not None and mixamo[2] in MIXAMO and table is not LEGS:
        return MIXAMO[mixamo[2]], mixamo[1][0].upper()
    plain = re.sub(r"^(left|right) ", r"\1 ", name.lower())
    side = "L" if re.search(r"[._]l$|^left ", plain) else "R" if re.search(r"[._]r$|^right ", plain) else ""
    bare = re.sub(r"[._][lr]$", "", plain)
    tables = (LIMBS, LEGS) if table is None else (table,)
    found = [what for each in tables for what, pattern in each.items() if re.fullmatch(pattern, bare)]
    return (found[0], side) if found and side else None


def added(path):
    """Import a file, and return its armature and meshes."""
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=str(path))
    new = [obj for obj in bpy.data.objects if obj not in before]
    rig = next(obj for obj in new if obj.type == "ARMATURE")
    for obj in [obj for obj in new if obj.type == "MESH" and not moved_by(obj, rig)]:
        bpy.data.objects.remove(obj)  # what shows bones in the view, and what is held in hands
    return rig, [obj for obj in bpy.data.objects if obj.type == "MESH" and obj not in before]


def moved_by(obj, rig):
    return any(getattr(one, "object", None) == rig for one in obj.modifiers)


def action_of(rig, name):
    """An action with such a name among what was imported for a rig, or a walk that is made."""
    data = rig.animation_data
    strips = [strip.action for track in data.nla_tracks for strip in track.strips] if data else []
    found = [one for one in [data and data.action, *strips] if one is not None and name in one.name.lower()]
    return found[0] if found else walk(rig)


def walk(rig):
    """Let arms and legs swing as in a walk, by the names of their bones."""
    swings = {"upper_arm": (-0.5, 0.0), "lower_arm": (0.0, -0.5), "upper_leg": (0.5, 0.0), "lower_leg": (0.0, 0.45)}
    turn = facing(rig)
    across = rig.matrix_world.to_3x3().inverted() @ Vector((np.cos(turn), np.sin(turn), 0))
    for bone in rig.pose.bones:
        what = limb(bone.name, LIMBS)
        if what is None or what[0] not in swings:
            continue
        swing, bend = swings[what[0]]
        axis = bone.bone.matrix_local.to_3x3().inverted() @ across
        bone.rotation_mode = "QUATERNION"
        for frame in range(1, 26, 4):
            phase = 2 * np.pi * (frame - 1) / 24 + (np.pi if what[1] == "R" else 0)
            angle = swing * np.sin(phase) + bend * (1 + np.sin(phase + 1.5)) / 2
            bone.rotation_quaternion = Quaternion(axis.normalized(), angle)
            bone.keyframe_insert("rotation_quaternion", frame=frame)
    rig.animation_data.action.name = "Walk"
    return rig.animation_data.action


def played(rig, action):
    data = rig.animation_data or rig.animation_data_create()
    for track in data.nla_tracks:
        track.mute = True
    data.action = action
    if getattr(data, "action_slot", True) is None:
        data.action_slot = data.action_suitable_slots[0]


def still(rig):
    """Let a rig stand at rest."""
    rig.animation_data_clear()
    for bone in rig.pose.bones:
        bone.matrix_basis.identity()


def ways(rig):
    """Directions of upper and lower limbs, by what they are."""
    bones = {}
    for bone in rig.pose.bones:
        what = limb(bone.name, LIMBS)
        if what is not None:
            bones.setdefault(what, bone)
    return {
        what: (rig.matrix_world @ bones[AFTER[what[0]], what[1]].head - rig.matrix_world @ bone.head).normalized()
        for what, bone in bones.items()
        if (AFTER.get(what[0]), what[1]) in bones
    }


def facing(rig):
    """Angle on the ground of the way from the right leg to the left one, by what they are called; zero without any."""
    heads = {limb(bone.name): rig.matrix_world @ bone.head_local for bone in rig.data.bones}
    ends = [heads.get(("upper_leg", side)) for side in "LR"]
    return 0.0 if None in ends else float(np.arctan2(ends[0].y - ends[1].y, ends[0].x - ends[1].x))


def heights(meshes):
    """Lowest and highest point of meshes as they are shown."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    ends = []
    for obj in meshes:
        shown = obj.evaluated_get(depsgraph)
        places = np.empty(3 * len(shown.data.vertices), np.float32)
        shown.data.vertices.foreach_get("co", places)
        matrix = np.array(shown.matrix_world)
        ends.append(places.reshape(-1, 3) @ matrix[2, :3] + matrix[2, 3])
    together = np.concatenate(ends)
    return float(together.min()), float(together.max())


def tips(rig, meshes):
    """Numbers of the vertices at the ends of hands and feet, as a person clicks on them."""
    ends = {}
    for bone in rig.data.bones:
        above = [one for one in (bone, *bone.parent_recursive) if (limb(one.name, LIMBS) or "-")[0] in ("hand", "foot")]
        if above:
            ends[bone.name] = limb(above[-1].name, LIMBS), rig.matrix_world @ above[-1].head_local
    farthest, first = {}, 0
    for obj in sorted(meshes, key=lambda obj: obj.name):
        names = {group.index: group.name for group in obj.vertex_groups}
        for vertex in obj.data.vertices:
            most = max(vertex.groups, key=lambda group: group.weight, default=None)
            if most is not None and names[most.group] in ends:
                what, joint = ends[names[most.group]]
                far = (obj.matrix_world @ vertex.co - joint).length
                farthest[what] = max(farthest.get(what, (0.0, -1)), (far, first + vertex.index))
        first += len(obj.data.vertices)
    return {what: number for what, (_, number) in farthest.items()}


def paired(rows, source, target):
    """How many limb bones of the target are paired right, of how many, and how many with the other side."""
    known = {limb(bone.name) for bone in source.data.bones} - {None}
    right = wrong = crossed = 0
    said = []
    for bone in target.data.bones:
        what = limb(bone.name)
        if what not in known:
            continue
        mine = sorted((row for row in rows if row.target == bone.name and row.source), key=lambda row: -row.score)
        found = [limb(row.source) for row in mine]
        crossed += any(each is not None and each[1] != what[1] for each in found)
        # A leg of an animal is built in other pieces: what has no piece of its own goes with the one above it.  What
        # stands for several, as a foot for another foot and its toes, has the one of its kind among them.
        good = what in found or (not found and what[0] in LEGS)
        right, wrong = right + good, wrong + (not good)
        if not good:
            said.append(f"{bone.name}: {', '.join(row.source for row in mine) or '-'}")
    return right, right + wrong, crossed, said


def row(folder, names, options):
    """Return the numbers of one pair, and what was paired wrong."""
    bpy.ops.wm.read_homefile(use_empty=True)
    (source, its), (target, others) = (added(folder / name) for name in names)
    action = action_of(source, options.action.lower())
    played(source, action)
    still(target)
    bpy.context.scene.frame_set(0)
    source.data.pose_position = "REST"
    bpy.context.view_layer.update()
    rests = [heights(meshes) for meshes in (its, others)]
    source.data.pose_position = "POSE"
    if options.guided:
        here, there = tips(source, its), tips(target, others)
        for what in sorted(here.keys() & there.keys()):
            bpy.ops.hiermatch.add_landmark(
                source=source.name, target=target.name, source_vertex=here[what], target_vertex=there[what]
            )
    begin = time.process_time()
    bpy.ops.hiermatch.pair_bones(source=source.name, target=target.name, accept_doubtful=True)
    between = time.process_time()
    bpy.ops.hiermatch.retarget_action(
        source=source.name, target=target.name, action=action.name, keep_feet=options.feet
    )
    end = time.process_time()
    confidence = 100 * bpy.context.scene.hiermatch.summary.confidence
    right, count, crossed, said = paired(bpy.context.scene.hiermatch_bone_pairs, source, target)
    angles, depths = [], [0.0, 0.0]
    turn = Quaternion((0, 0, 1), facing(target) - facing(source))
    for frame in np.linspace(*action.frame_range, FRAMES):
        bpy.context.scene.frame_set(round(frame))
        mine, other = ways(source), ways(target)
        angles += [np.degrees((turn @ way).angle(other[what])) for what, way in mine.items() if what in other]
        for number, (meshes, (low, high)) in enumerate(zip((others, its), rests[::-1], strict=True)):
            depths[number] = max(depths[number], 100 * (low - heights(meshes)[0]) / (high - low))
    stem = "-".join(Path(name).stem for name in names)
    if options.save is not None:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.save / f"{stem}.blend"))
    if options.strips is not None:
        shown = np.linspace(*action.frame_range, SHOWN)
        grounds, turns = [low for low, _ in rests], [facing(rig) for rig in (source, target)]
        draw_strip(options.strips / f"{stem}.png", [its, others], turns, grounds, shown)
    bends = f"{np.mean(angles):5.1f} {np.max(angles):5.1f}" if angles else f"{'':5} {'':5}"
    title = " -> ".join(Path(name).stem for name in names)
    return (
        f"{title:64} {confidence:4.0f}  {right:3d}/{count:<3d} {crossed:3d}  {bends}  "
        f"{depths[0]:5.1f} {depths[1]:5.1f}  {between - begin:6.1f} {end - between:5.1f}"
    ), said


def pairs():
    """All pairs of different makers, the one with an action first."""
    for kind in (PEOPLE, ANIMALS):
        for first, second in combinations(kind, 2):
            yield from ((one, other) for one in kind[first] for other in kind[second])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the characters")
    parser.add_argument("--only", help="pairs of files, SOURCE:TARGET,... (default: all of other makers)")
    parser.add_argument("--feet", action="store_true", help="keep feet on the ground")
    parser.add_argument("--action", default="walk", help="part of the name of the action")
    parser.add_argument("--guided", action="store_true", help="give the tips of hands and feet as landmarks")
    parser.add_argument("--save", type=Path, help="folder for a .blend of each pair")
    parser.add_argument("--strips", type=Path, help="folder for a picture of each pair")
    options = parser.parse_args()
    registered_extension()
    for folder in filter(None, (options.save, options.strips)):
        folder.mkdir(parents=True, exist_ok=True)
    wanted = [tuple(pair.split(":")) for pair in options.only.split(",")] if options.only else pairs()
    for names in wanted:
        try:
            line, said = row(options.data, names, options)
        except RuntimeError as refused:  # what a button says where no bones belong together
            line, said = " -> ".join(Path(name).stem for name in names), str(refused).strip().splitlines()
        print("ROW", line, *said, sep="\n    " if said else " ", flush=True)


if __name__ == "__main__":
    main()
