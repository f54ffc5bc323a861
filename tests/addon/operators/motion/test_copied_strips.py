# SPDX-License-Identifier: GPL-3.0-or-later
"""Strips of the NLA editor that are copied with the actions that they play."""

import bpy
import numpy as np
import pytest

from tests.addon.characters import add_action, add_person
from tests.addon.motions import worst

carry = bpy.ops.hiermatch.retarget_action


def test_strips_that_meet_between_two_frames_are_copied():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    strips = source.animation_data.nla_tracks.new().strips
    strips.new("First", 1, action).frame_end = 10.5
    strips.new("Second", 11, action).frame_start = 10.5
    assert carry(source="A", target="B", action="Wave", strips=True) == {"FINISHED"}
    (track,) = target.animation_data.nla_tracks
    assert [(one.frame_start, one.frame_end) for one in track.strips] == [
        (one.frame_start, one.frame_end) for one in strips
    ]


def test_strips_whose_influence_is_animated_are_copied_with_that():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    strip = source.animation_data.nla_tracks.new().strips.new("Wave", 1, action)
    strip.use_animated_influence = True
    for frame, influence in ((1, 0.25), (8, 1.0), (15, 0.5)):
        strip.influence = influence
        strip.keyframe_insert("influence", frame=frame)
    assert carry(source="A", target="B", action="Wave", strips=True) == {"FINISHED"}
    (copy,) = target.animation_data.nla_tracks[0].strips
    curves = [one.fcurves.find("influence") for one in (strip, copy)]
    for frame in np.linspace(0, 20, 41):
        assert curves[1].evaluate(frame) == pytest.approx(curves[0].evaluate(frame), abs=1e-5)
    assert curves[0].evaluate(8) == 1


def test_strips_of_meta_strips_are_copied_and_that_is_said():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    track = source.animation_data.nla_tracks.new()
    for start in (1, 41):
        track.strips.new("Wave", start, action).select = True
    (window,) = bpy.context.window_manager.windows
    area = window.screen.areas[0]
    kept, area.type = area.type, "NLA_EDITOR"
    region = next(region for region in area.regions if region.type == "WINDOW")
    source.select_set(state=True)
    bpy.context.view_layer.objects.active = source
    with bpy.context.temp_override(window=window, area=area, region=region):
        assert bpy.ops.nla.meta_add() == {"FINISHED"}
    area.type = kept
    source.animation_data.action = None
    (meta,) = track.strips
    meta.frame_end, meta.mute = 101, True  # which stretches those within
    for new in (True, False):
        assert carry(source="A", target="B", strips=True) == {"FINISHED"}
        notes = bpy.context.scene.hiermatch_retarget.report.notes
        assert ('the strips within them were copied: "Meta"' in notes) == new
        (made,) = target.animation_data.nla_tracks
        ends = [[(one.frame_start, one.frame_end) for one in strips] for strips in (made.strips, meta.strips)]
        assert ends[0] == ends[1]
        assert all(strip.mute for strip in made.strips)


def test_strips_that_are_alone_or_timed_by_a_curve_are_copied_so():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    tracks = [source.animation_data.nla_tracks.new() for _ in range(2)]
    strip, other = (track.strips.new("Wave", start, action) for track, start in zip(tracks, (1, 61), strict=True))
    source.animation_data.action = None
    strip.use_animated_time = True
    for frame, time in ((1, 1), (41, 21)):
        strip.fcurves.find("strip_time").keyframe_points.insert(frame, time)
    strip.frame_end = 41
    other.use_animated_time_cyclic = tracks[0].is_solo = True
    assert carry(source="A", target="B", strips=True) == {"FINISHED"}
    target.animation_data.action = None
    assert [track.is_solo for track in target.animation_data.nla_tracks] == [True, False]
    assert target.animation_data.nla_tracks[1].strips[0].use_animated_time_cyclic
    assert worst(source, target, (1, 12, 25, 41)) < 5e-3
