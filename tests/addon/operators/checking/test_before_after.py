# SPDX-License-Identifier: GPL-3.0-or-later
"""A target is shown as it was, and then again as it is."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.posing.before_after import is_before
from hiermatch.hiermatch_addon.scene.posing.exercise import is_exercising

from tests.addon.garments import add_item, fitted, wear
from tests.addon.operators.carrying.test_fit_rig import add_weights, shown
from tests.addon.operators.carrying.test_fit_rig import fit as fit_rig
from tests.addon.operators.carrying.test_rest_like_source import fit
from tests.addon.rigs import add_rigged, add_target, pose


@pytest.mark.parametrize("like_source", ["OFF", "ON"])
def test_there_and_back(like_source):
    source, _ = add_rigged()
    target, _ = add_target(source)
    add_weights(source, target)
    for obj in (source, target):
        obj.shape_key_add(name="Basis")
        key = obj.shape_key_add(name="Swell")
        key.data[0].co.z += 0.5
        key.value = 0.0
    own = target.shape_key_add(name="My own")
    stood = shown(target)
    made, _ = (fit_rig if like_source == "OFF" else fit)(source, target, like_source=like_source)
    pose(made, 0.5, {"neck": (0.0, 0.0, 0.5)})
    target.data.shape_keys.key_blocks["Swell"].value = 1.0
    now = shown(target)
    assert np.linalg.norm(now - stood, axis=1).max() > 0.15
    state = bpy.context.scene.hiermatch
    state.source, state.target = source, target
    assert bpy.ops.hiermatch.before_after() == {"FINISHED"}
    bpy.context.scene.frame_set(1)
    np.testing.assert_allclose(shown(target), stood, atol=1e-3)
    assert not own.mute
    assert bpy.ops.hiermatch.before_after() == {"FINISHED"}
    bpy.context.scene.frame_set(1)
    np.testing.assert_allclose(shown(target), now, atol=1e-5)
    assert not [name for name in (*target.keys(), *made.keys()) if name.startswith("hiermatch_before")]


def test_what_is_carried_again_is_shown_as_it_is(dense_pair):
    source, target = dense_pair
    for name in ("Basis", "Swell"):
        source.shape_key_add(name=name).data[0].co.z += 0.5
    for _ in range(2):
        assert bpy.ops.hiermatch.transfer_shape_keys(source="Source", target="Target") == {"FINISHED"}
        key = target.data.shape_keys.key_blocks["Swell"]
        assert not is_before(target)
        assert not key.mute
        assert bpy.ops.hiermatch.before_after() == {"FINISHED"}
        assert is_before(target)
        assert key.mute


def test_what_got_nothing_has_no_before():
    add_rigged()
    with pytest.raises(RuntimeError, match="so it is as it was before"):
        bpy.ops.hiermatch.before_after(target="Source")


@pytest.mark.parametrize("below", ["NONE", "KEY", "MASK"])
def test_clothes_are_taken_off_for_a_while(dense_pair, below):
    source, target = dense_pair
    add_item(source, "Shirt", 0.02)
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    assert wear("Shirt", wear_hide=below) == {"FINISHED"}
    copy = fitted("Shirt")

    def covered():
        keys = target.data.shape_keys
        key = None if keys is None else keys.key_blocks.get("Below Clothes")
        mask = target.modifiers.get("Below Clothes")
        return [not copy.hide_viewport, key is not None and not key.mute, mask is not None and mask.show_viewport]

    now = covered()
    assert now == [True, below == "KEY", below == "MASK"]
    assert bpy.ops.hiermatch.before_after(target="Target") == {"FINISHED"}
    assert is_before(target)
    assert covered() == [False, False, False]
    assert bpy.ops.hiermatch.before_after(target="Target") == {"FINISHED"}
    assert not is_before(target)
    assert covered() == now
    assert not [name for name in copy.keys() if name.startswith("hiermatch_before")]  # noqa: SIM118
    assert bpy.ops.hiermatch.before_after(target="Target") == {"FINISHED"}
    assert wear("Shirt", wear_hide=below) == {"FINISHED"}
    copy = fitted("Shirt")
    assert covered() == now
    assert not is_before(target)


@pytest.mark.parametrize("mode", ["POSE", "WEIGHT_PAINT"])
def test_it_and_test_poses_start_and_end_while_posing_and_painting(mode):
    source, _ = add_rigged()
    target, _ = add_target(source)
    add_weights(source, target)
    made, _ = fit_rig(source, target)
    bpy.context.view_layer.objects.active = made if mode == "POSE" else target
    bpy.ops.object.mode_set(mode=mode)
    try:
        for operator in (bpy.ops.hiermatch.before_after, bpy.ops.hiermatch.test_poses):
            for shown in (True, False):
                assert operator(target=target.name) == {"FINISHED"}
                assert (is_before(target) or is_exercising(made)) == shown
        assert bpy.context.object.mode == mode
        assert bpy.ops.hiermatch.show.poll() == (mode == "POSE")
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
