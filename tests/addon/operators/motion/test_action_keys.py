# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys and curves of carried actions: where keys are, how curves go between and beyond them, and what is left out."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Quaternion

from tests.addon.characters import add_action, add_person
from tests.addon.motions import curves_of, snapshot, worst

carry, pose = bpy.ops.hiermatch.retarget_action, bpy.ops.hiermatch.retarget_pose


def test_sparse_keys_stay_sparse_with_their_interpolation():
    source, _ = add_person("A")
    target, made = add_person("B", "renamed", rolls=0.4)
    action = add_action(source)
    for curve in curves_of(action).values():
        curve.keyframe_points[0].interpolation = "LINEAR"
        curve.keyframe_points[1].interpolation = "CONSTANT"
        curve.modifiers.new("CYCLES")
    carry(source="A", target="B")
    curves = curves_of(bpy.data.actions["Wave B"])
    arm = made.names[[origin == frozenset(["forearm.L"]) for origin in made.origins].index(True)]
    curve = curves[f'pose.bones["{arm}"].rotation_quaternion', 1]
    assert [point.co[0] for point in curve.keyframe_points] == [1, 11, 21]
    assert [point.interpolation for point in curve.keyframe_points] == ["LINEAR", "CONSTANT", "BEZIER"]
    assert [modifier.type for modifier in curve.modifiers] == ["CYCLES"]
    still = made.names[[origin == frozenset(["hand.R"]) for origin in made.origins].index(True)]
    assert len(curves[f'pose.bones["{still}"].rotation_quaternion', 0].keyframe_points) == 1
    assert worst(source, target, (1, 6, 15, 21)) < 5e-3


@pytest.mark.parametrize("kind", ["BEZIER", "LINEAR", "SINE"])
def test_in_place_a_body_stays_between_unequal_keys_as_well(kind):
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    add_action(source, frames=(1, 11, 41, 51), way=(0, 0, 0.3))
    by_curve(source, lambda _path: kind)
    hips = target.pose.bones[made.names[made.origins.index(frozenset(["hips"]))]]
    ways = {}
    for keying in ("SOURCE", "ALL"):
        carry(source="A", target="B", keying=keying, in_place=True)
        ways[keying] = []
        for frame in range(1, 52, 2):
            bpy.context.scene.frame_set(frame)
            ways[keying].append(hips.head.copy())
    assert np.abs(np.subtract(ways["SOURCE"], ways["ALL"])).max() < 0.01
    assert np.abs(np.subtract(ways["SOURCE"][0], ways["SOURCE"][-1]))[:2].max() < 1e-4


def repeat(curve, mode, **settings):
    modifier = curve.modifiers.new("CYCLES")
    modifier.mode_before = modifier.mode_after = mode
    for name, value in settings.items():
        setattr(modifier, name, value)


def by_curve(source, how):
    """Key bones of a source, and let `how` change each curve, given with its path."""
    for (path, _), curve in curves_of(source.animation_data.action).items():
        for key in curve.keyframe_points:
            key.interpolation = how(path)


def turned(bone, channel, frames, angle):
    """Key a channel of a bone that turns by an angle and back, the first frame and the last at rest."""
    for number, frame in enumerate(frames):
        bone.rotation_quaternion = Quaternion((1, 0, 0), angle * (number % 2))
        bone.keyframe_insert(channel, frame=frame)


@pytest.mark.parametrize("keying", ["AUTO", "SOURCE"])
@pytest.mark.parametrize("first", ["location", "rotation_quaternion"])
def test_places_may_go_in_steps_while_rotations_do_not(keying, first):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    hips = source.pose.bones["hips"]
    for channel in sorted(("location", "rotation_quaternion"), key=first.__ne__):
        for number, frame in enumerate((1, 21, 41)):
            hips.location = (0, 0, 0.3 * number)
            hips.rotation_quaternion = Quaternion((0, 1, 0), number % 2)
            hips.keyframe_insert(channel, frame=frame)
    by_curve(source, lambda path: "CONSTANT" if "location" in path else "BEZIER")
    assert carry(source="A", target="B", keying=keying) == {"FINISHED"}
    assert worst(source, target, (1, 6, 20, 21, 25, 40, 41)) < 5e-3
    said = bpy.context.scene.hiermatch_retarget.report.notes
    assert ("with keys only where the source has some" in said) == (keying == "SOURCE")


def test_sizes_that_go_in_steps_do_not_make_rotations_do_so():
    """As files of glTF have them."""
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    for channel in ("scale", "rotation_quaternion"):
        turned(source.pose.bones["forearm.L"], channel, (1, 21, 41), 0.8)
    by_curve(source, lambda path: "CONSTANT" if "scale" in path else "LINEAR")
    assert carry(source="A", target="B") == {"FINISHED"}
    counts = {len(curve.keyframe_points) for curve in curves_of(target.animation_data.action).values()}
    assert counts <= {1, 3}
    assert worst(source, target, (1, 6, 20, 21, 31, 41)) < 5e-3


def test_a_bone_that_follows_one_that_goes_in_steps_and_one_that_does_not():
    source, made = add_person("A", "fine")
    target, _ = add_person("B", "coarse")
    collar = made.names[made.origins.index(frozenset(["clavicle.L"]))]
    arm = next(name for name, origin in zip(made.names, made.origins, strict=True) if origin == {"upper_arm.L"})
    for name, angle in ((collar, 0.6), (arm, 0.5)):
        turned(source.pose.bones[name], "rotation_quaternion", (1, 21, 41), angle)
    by_curve(source, lambda path: "CONSTANT" if f'"{collar}"' in path else "BEZIER")
    assert carry(source="A", target="B", keying="ALL") == {"FINISHED"}
    most = worst(source, target, (1, 6, 20, 21, 25, 41))
    assert carry(source="A", target="B") == {"FINISHED"}
    assert worst(source, target, (1, 6, 20, 21, 25, 41)) < most + 1e-3


def spun(source, mode, keys, interpolation="LINEAR"):
    """Let a head spin about an axis by Euler angles, {frame: angle}, and return its curves."""
    head = source.pose.bones["head"]
    head.rotation_mode = mode
    for frame, angle in keys.items():
        head.rotation_euler = (0, angle, 0)
        head.keyframe_insert("rotation_euler", frame=frame)
    by_curve(source, lambda _path: interpolation)
    return curves_of(source.animation_data.action).values()


@pytest.mark.parametrize("mode", ["QUATERNION", "YXZ"])
@pytest.mark.parametrize("angle", [1.5 * np.pi, 2 * np.pi, -5 * np.pi])
def test_what_spins_from_one_key_to_the_next_spins(mode, angle):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed", mode=mode)
    spun(source, "XYZ", {1: 0, 25: angle})
    assert carry(source="A", target="B") == {"FINISHED"}
    assert worst(source, target, (1, 5, 7, 13, 19, 25)) < 5e-3


@pytest.mark.parametrize("keying", ["SOURCE", "REDUCED", "ALL"])
def test_what_turns_on_beyond_its_keys_does_so_or_is_named(keying):
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    head = target.pose.bones[made.names[made.origins.index(frozenset(["head"]))]]
    said = "will stay beyond the last key, where the source turns on"
    for curve in spun(source, "XYZ", {1: 0, 25: np.pi / 2}):
        curve.extrapolation = "LINEAR"
    for mode in ("YXZ", "QUATERNION"):
        head.rotation_mode = mode
        assert carry(source="A", target="B", keying=keying) == {"FINISHED"}
        assert (said in bpy.context.scene.hiermatch_retarget.report.notes) == (mode == "QUATERNION")
        assert (worst(source, target, (1, 13, 25, 49, 73)) < 5e-3) == (mode == "YXZ")
    assert {curve.extrapolation for curve in curves_of(target.animation_data.action).values()} == {"CONSTANT"}


@pytest.mark.parametrize("keying", ["SOURCE", "REDUCED", "ALL"])
@pytest.mark.parametrize("turns", [1, 0.25])
def test_wheels_go_on_by_whole_turns_or_are_named(keying, turns):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    for curve in spun(source, "XYZ", {1: 0, 25: 2 * np.pi * turns}):
        repeat(curve, "REPEAT_OFFSET")
    assert carry(source="A", target="B", keying=keying) == {"FINISHED"}
    said = "will stay beyond the last key, where the source turns on"
    assert (said in bpy.context.scene.hiermatch_retarget.report.notes) == (turns != 1)
    assert worst(source, target, (1, 7, 13, 25, *((31, 49, 68) if turns == 1 else ()))) < 5e-3


@pytest.mark.parametrize("keying", ["AUTO", "SOURCE", "REDUCED", "ALL"])
def test_what_is_repeated_between_two_frames_stays_in_time(keying):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    turned(source.pose.bones["forearm.L"], "rotation_quaternion", (1, 5.5, 10.4), 0.8)
    for curve in curves_of(source.animation_data.action).values():
        repeat(curve, "REPEAT")
    assert carry(source="A", target="B", keying=keying) == {"FINISHED"}
    assert worst(source, target, (1, 5, 9, 20, 50, 60, 100)) < 5e-3


@pytest.mark.parametrize("animated", [False, True])
def test_constraints_of_no_influence_need_no_frames_but_their_own(animated):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    for bone, subtarget in (
        (source.pose.bones["forearm.R"], "head"),
        (target.pose.bones[3], target.pose.bones[0].name),
    ):
        copied = bone.constraints.new("COPY_ROTATION")
        copied.target, copied.subtarget, copied.influence = bone.id_data, subtarget, 0
    constraint = source.pose.bones["forearm.R"].constraints[0]
    for frame in (1, 21) if animated else ():
        constraint.influence = frame > 1
        constraint.keyframe_insert("influence", frame=frame)
    constraint.influence = 0
    source.animation_data.action = None
    bpy.context.view_layer.update()
    assert carry(source="A", target="B", action=action.name) == {"FINISHED"}
    assert "Constraints hold" not in bpy.context.scene.hiermatch_retarget.report.notes
    counts = {len(curve.keyframe_points) for curve in curves_of(target.animation_data.action).values()}
    assert (counts <= {1, 3}) == (not animated)
    source.animation_data.action = action
    assert worst(source, target, (1, 6, 11, 21)) < 5e-3


def test_a_cycle_is_not_lent_to_what_goes_on_otherwise():
    """The hips turn in cycles of ten frames, and go their way in forty."""
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    hips = source.pose.bones["hips"]
    turned(hips, "rotation_quaternion", (1, 6, 11), 0.4)
    for curve in curves_of(source.animation_data.action).values():
        repeat(curve, "REPEAT")
    for frame, way in ((1, 0.0), (41, -0.5)):
        hips.location.z = way
        hips.keyframe_insert("location", frame=frame)
    assert carry(source="A", target="B") == {"FINISHED"}
    assert worst(source, target, (1, 6, 9, 16, 23, 41)) < 5e-3


@pytest.mark.parametrize("kind", ["BACK", "ELASTIC", "BOUNCE", "SINE"])
def test_overshoots_are_those_of_the_source(kind):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    for frame, way in ((1, 0.0), (21, 0.5)):
        source.pose.bones["hips"].location.x = way
        source.pose.bones["hips"].keyframe_insert("location", frame=frame)
    for curve in curves_of(source.animation_data.action).values():
        for key in curve.keyframe_points:
            key.interpolation, key.back = kind, 2.5
    assert carry(source="A", target="B") == {"FINISHED"}
    assert worst(source, target, (1, 3, 5, 9, 13, 17, 21)) < 5e-3
    counts = {len(curve.keyframe_points) for curve in curves_of(target.animation_data.action).values()}
    assert (counts <= {1, 2}) == (kind != "ELASTIC")


def test_bones_that_hang_elsewhere_do_not_come_off_between_keys():
    """Hands of headsets have flat rigs, and feet for solvers hang on the root: they are moved along arcs."""
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    add_action(source)
    carry(source="A", target="B")
    bpy.context.view_layer.objects.active = target
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in target.data.edit_bones:
        bone.parent = None
    bpy.ops.object.mode_set(mode="OBJECT")
    carry(source="A", target="B")
    forearm = made.names[made.origins.index(frozenset(["forearm.L"]))]
    upper = target.pose.bones[made.names[made.origins.index(frozenset(["upper_arm.L"]))]]
    gaps = []
    for frame in (1, 6, 11, 15, 21):
        bpy.context.scene.frame_set(frame)
        gaps.append((target.pose.bones[forearm].head - upper.tail).length)
    assert max(gaps) < 5e-3
    assert worst(source, target, (1, 6, 15, 21)) < 5e-3


def test_baked_keys_are_few_and_true():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    counts = {}
    for keys in ("REDUCED", "ALL"):
        carry(source="A", target="B", keying=keys)
        counts[keys] = sum(len(curve.keyframe_points) for curve in curves_of(target.animation_data.action).values())
        assert worst(source, target, (1, 4, 9, 17, 21)) < 4e-3
    assert counts["REDUCED"] < 0.6 * counts["ALL"]


def test_what_is_muted_is_not_carried():
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    action = add_action(source)
    for (path, _), curve in curves_of(action).items():
        curve.mute = "forearm.L" in path
    for bone in source.pose.bones:
        bone.matrix_basis = Matrix()
    carry(source="A", target="B")
    forearm, upper = (made.names[made.origins.index(frozenset([name]))] for name in ("forearm.L", "upper_arm.L"))
    bpy.context.scene.frame_set(11)
    assert target.pose.bones[forearm].matrix_basis.to_quaternion().angle < 0.01
    assert target.pose.bones[upper].matrix_basis.to_quaternion().angle > 0.1


@pytest.mark.skipif(bpy.app.version < (4, 4), reason="actions have slots since Blender 4.4")
@pytest.mark.parametrize("keying", ["AUTO", "ALL"])
def test_an_action_that_moves_something_else_as_well_gets_no_more_frames(keying):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    slot = action.slots.new("OBJECT", "Camera")
    curve = action.layers[0].strips[0].channelbag(slot, ensure=True).fcurves.new("location", index=0)
    for frame in (-100, 400):
        curve.keyframe_points.insert(frame, 0)
    carry(source="A", target="B", keying=keying)
    assert tuple(target.animation_data.action.frame_range) == (1, 21)


def test_curves_without_keys_move_nothing():
    source, _ = add_person("A")
    add_person("B", "renamed")
    action = add_action(source)
    for curve in curves_of(action).values():
        while len(curve.keyframe_points):
            curve.keyframe_points.remove(curve.keyframe_points[0])
    with pytest.raises(RuntimeError, match='The action "Wave" moves no bone of "A"'):
        carry(source="A", target="B", action="Wave")
    next(iter(curves_of(action).values())).modifiers.new("FNGENERATOR")
    assert carry(source="A", target="B", action="Wave", keying="SOURCE") == {"FINISHED"}


def only(action, channel):
    """Take all curves from an action but those of a channel of bones."""
    for (path, _), curve in curves_of(action).items():
        curve.mute = not path.endswith(f".{channel}")


def test_bones_whose_sizes_an_action_changes_are_named(capfd):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    said = 'The sizes that bones of "A" get were left out: "head".'
    head, neck = source.pose.bones["head"], source.pose.bones["neck"]
    for bone in (head, neck):
        for frame in (1, 11):
            bone.keyframe_insert("scale", frame=frame)
    assert carry(source="A", target="B") == {"FINISHED"}
    assert said not in capfd.readouterr().out
    head.scale.y = 1.3
    head.keyframe_insert("scale", frame=11)
    assert carry(source="A", target="B") == {"FINISHED"}
    assert said in capfd.readouterr().out
    only(action, "scale")
    before = snapshot(target)
    with pytest.raises(RuntimeError, match='The action "Wave" moves no bone of "A"'):
        carry(source="A", target="B", action="Wave")
    assert snapshot(target) == before


def test_what_modifiers_do_between_keys_is_carried_too():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    for (path, index), curve in curves_of(action).items():
        if "thigh.R" in path and index == 1:
            noise = curve.modifiers.new("NOISE")
            noise.strength, noise.scale = 0.5, 3
    assert carry(source="A", target="B") == {"FINISHED"}
    assert worst(source, target, range(1, 22, 2)) < 2e-3


@pytest.mark.parametrize("keying", ["SOURCE", "REDUCED", "ALL"])
@pytest.mark.parametrize(
    "go_on",
    [
        lambda path, curve: repeat(curve, "REPEAT_OFFSET" if path.endswith("location") else "REPEAT"),
        lambda path, curve: repeat(curve, "REPEAT") if "thigh" in path else None,
        lambda _path, curve: repeat(curve, "REPEAT", use_restricted_range=True, frame_start=1, frame_end=40),
        lambda path, curve: setattr(curve, "extrapolation", "LINEAR" if path.endswith("location") else "CONSTANT"),
    ],
    ids=["walk", "one", "range", "linear"],
)
def test_beyond_its_keys_each_channel_goes_on_as_what_moves_it(keying, go_on):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    hips = source.pose.bones["hips"]
    for frame, turn in ((1, (1, 0, 0, 0)), (11, (0.98, 0.2, 0, 0)), (21, (1, 0, 0, 0))):
        hips.rotation_quaternion = turn
        hips.keyframe_insert("rotation_quaternion", frame=frame)
    for (path, _index), curve in curves_of(action).items():
        go_on(path, curve)
    assert carry(source="A", target="B", keying=keying) == {"FINISHED"}
    assert worst(source, target, [-30, 5, 30, 55]) < 2e-3
