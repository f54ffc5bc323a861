# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether actions were edited since they were carried over."""

import bpy
import pytest
from hiermatch.hiermatch_addon.scene.motion.action_curves import MADE_FOR
from hiermatch.hiermatch_addon.scene.motion.carried_action_io import (
    carried_before,
    mark_carried,
    put_aside,
    was_carried,
    was_edited,
)

from tests.addon.characters import add_action, add_person
from tests.addon.motions import curves_of


@pytest.fixture
def carried():
    """A rig, the action of another one, and its own that stands for that."""
    rig, _ = add_person("B")
    model, action = bpy.data.actions.new("Wave"), add_action(rig, "Wave B")
    action[MADE_FOR] = "B"
    mark_carried(action, model)
    return rig, model, action


def test_it_is_found_as_long_as_it_has_its_name(carried):
    rig, model, action = carried
    assert was_carried(action)
    assert not was_carried(model)
    assert carried_before(rig, model) == action
    assert carried_before(rig, action) is None
    action.name = "Mine"
    assert carried_before(rig, model) is None


def test_what_was_put_aside_is_not_found(carried):
    rig, model, action = carried
    assert put_aside(action) == "Wave B (edited)"
    assert carried_before(rig, model) is None
    assert was_carried(action)


@pytest.mark.parametrize("letter", ["x", "Ä"])
def test_a_name_that_is_too_long_is_cut_before_what_is_said_of_it(carried, letter):
    _, _, action = carried
    action.name = 300 * letter
    long = action.name
    aside = put_aside(action)
    assert aside == action.name
    assert aside.endswith(" (edited)")
    assert aside.startswith(long[:100])


class OldAction(dict):
    """An action as Blender 4.3 has it: with curves, but neither slots nor layers."""

    def __init__(self, action):
        super().__init__()
        self.fcurves = list(curves_of(action).values())
        for name in ("name", "pose_markers", "use_frame_range", "frame_start", "frame_end", "use_cyclic"):
            setattr(self, name, getattr(action, name))


def test_one_that_an_older_blender_wrote_is_as_it_was(carried):
    _, model, action = carried
    old = OldAction(action)
    mark_carried(old, model)
    for name, said in old.items():
        action[name] = said
    assert not was_edited(action)
    action.slots.new("OBJECT", "Other")
    assert was_edited(action)


def test_edits_are_seen_and_what_is_none_is_not(carried):
    rig, _model, action = carried
    curve = next(iter(curves_of(action).values()))
    curve.select = not curve.select
    curve.keyframe_points[0].select_control_point = True
    bpy.context.scene.frame_set(7)
    rig.animation_data.action = None
    assert not was_edited(action)
    curve.keyframe_points[1].handle_left[1] += 0.01
    assert was_edited(action)
    curve.keyframe_points[1].handle_left[1] -= 0.01
    curve.mute = True
    assert was_edited(action)
