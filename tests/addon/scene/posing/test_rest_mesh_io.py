# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes are brought to rest part by part as they would be all in one."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.engine import RestPose, unposed
from hiermatch.hiermatch_addon.scene.character import joined, read_surface
from hiermatch.hiermatch_addon.scene.posing.rest_mesh_io import bring_to_rest, plays_actions
from hiermatch.hiermatch_addon.storage.halves import moved_by_us
from hiermatch.hiermatch_addon.storage.stored_map import find_maps
from scipy.sparse import csr_array

from tests.addon.rigs import add_armature
from tests.addon.scenes import add_pair
from tests.shapes import rotation


def quarter(count, bones=2):
    """Weights of two bones at random, and a pose in which the second has turned by a quarter."""
    random = np.random.default_rng(3)
    weights = random.dirichlet([1] * bones, count)
    turns = np.stack([np.eye(3), rotation([0.0, 0.0, 1.0], np.pi / 2)])
    return csr_array(weights), RestPose(np.zeros((2, 3)), np.array([[0.0, 0, 0], [0.3, 0, 0]]), turns)


def world(side):
    bpy.context.view_layer.update()
    return read_surface(side, bpy.context.evaluated_depsgraph_get(), use_modifiers=False).vertices


@pytest.mark.parametrize("together", [True, False])
def test_parts_move_as_one_surface(together):
    pair = add_pair()
    side = joined("Both", pair) if together else pair[1]
    before = world(side)
    weights, rest = quarter(len(before))
    bring_to_rest(side, weights, rest)
    np.testing.assert_allclose(world(side), unposed(before, weights, rest), atol=1e-4)


def test_a_match_stays_fresh_if_we_move_a_mesh_and_not_if_others_do(dense_pair):
    target = dense_pair[1]
    weights, rest = quarter(len(target.data.vertices))
    with moved_by_us(target):
        bring_to_rest(target, weights, rest)
    assert not find_maps(*dense_pair).target.staleness()
    bring_to_rest(target, weights, rest)
    with pytest.raises(Exception, match="out of date"):
        find_maps(*dense_pair)


def test_actions_and_strips_are_played():
    armature = add_armature("Rig")
    assert not plays_actions(armature)
    animation = armature.animation_data_create()
    assert not plays_actions(armature)
    action = bpy.data.actions.new("Walk")
    animation.action = action
    assert plays_actions(armature)
    animation.action = None
    animation.nla_tracks.new().strips.new("Walk", 1, action)
    assert plays_actions(armature)
