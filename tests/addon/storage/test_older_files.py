# SPDX-License-Identifier: GPL-3.0-or-later
"""What an older version wrote is read: a match in a .blend, exported matches, and a preset.

The files in `files_0_1` were written by commit 0ea9595, the last one before engine and add-on had rooms: two symmetric
blobs (`add_symmetric_pair`) matched with `DENSE`, exported, and the settings kept as a preset.
"""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.properties import freshness
from hiermatch.hiermatch_addon.storage.match_exchange import apply_match, collect_match
from hiermatch.hiermatch_addon.storage.match_file import load_match

from tests.addon.scenes import maps_of

FILES = Path(__file__).parent / "files_0_1"


@pytest.fixture
def pair(empty_file):
    """Source and target as they come out of the older .blend."""
    assert empty_file
    bpy.ops.wm.open_mainfile(filepath=str(FILES / "matched.blend"))
    return bpy.data.objects["Source"], bpy.data.objects["Target"]


def test_a_stored_match_is_up_to_date_and_can_be_used(pair):
    freshness.refresh(bpy.context.scene)
    summary = bpy.context.scene.hiermatch.summary
    assert not summary.stale
    found = maps_of(*pair)
    assert found.target_to_source.confidence.max() > 0.5
    images = found.source_to_target.points.positions
    expected = np.array([pair[1].matrix_world @ vertex.co for vertex in pair[1].data.vertices])
    assert np.linalg.norm(images[:, None] - expected, axis=2).min(axis=1).max() < 0.5
    assert bpy.context.scene.hiermatch.samples == 77
    assert bpy.context.scene.hiermatch_retarget.weight_clean == pytest.approx(0.02)


def test_a_stored_match_carries_weights(pair):
    source, target = pair
    group = source.vertex_groups.new(name="Half")
    half = [vertex.index for vertex in source.data.vertices if vertex.co.z > 0]
    group.add(half, 1.0, "REPLACE")
    assert bpy.ops.hiermatch.transfer_weights(source="Source", target="Target") == {"FINISHED"}
    number = target.vertex_groups["Half"].index
    weights = [sum(g.weight for g in vertex.groups if g.group == number) for vertex in target.data.vertices]
    assert len(half) / len(source.data.vertices) == pytest.approx(np.mean(weights), abs=0.1)


def test_the_other_answer_is_there_still(pair):
    before = maps_of(*pair).source_to_target.triangles
    assert bpy.ops.hiermatch.flip(object="Source") == {"FINISHED"}
    assert (maps_of(*pair).source_to_target.triangles != before).mean() > 0.5


@pytest.mark.parametrize("suffix", ["npz", "json"])
def test_an_exported_match_is_read(pair, suffix):
    kept = collect_match(*pair)
    bpy.ops.hiermatch.clear(object="Source")
    apply_match(bpy.context, *pair, load_match(FILES / f"match.{suffix}"), "HM")
    again = collect_match(*pair)
    assert again.stored.names == kept.stored.names
    assert again.stored.answer.quality == kept.stored.answer.quality


def test_every_setting_of_a_preset_exists(empty_file):
    assert empty_file
    groups = {"hiermatch": bpy.context.scene.hiermatch, "hiermatch_retarget": bpy.context.scene.hiermatch_retarget}
    lines = [line for line in (FILES / "preset.txt").read_text(encoding="utf8").splitlines() if line.startswith("bpy.")]
    assert len(lines) > 40
    for line in lines:
        path, _, value = line.partition(" = ")
        _, _, _, group, name = path.split(".")
        setattr(groups[group], name, eval(value, {}))  # noqa: S307 - plain values of our own file
    assert groups["hiermatch"].samples == 77
