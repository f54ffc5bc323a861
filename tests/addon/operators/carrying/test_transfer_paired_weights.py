# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights for a rig that the target has already."""

import bpy
import numpy as np
import pytest
from hiermatch.engine import HierMatchError, run
from hiermatch.hiermatch_addon.transfers.motion.paired_weights import PairedWeightTransfer

from tests.addon.characters import add_person, match_at_once
from tests.addon.rigs import true_passage
from tests.addon.scenes import weights_of


def carry(limit=0):
    """Carry the weights of the first person's body to the second's rig."""
    source, target = bpy.data.objects["A Body"], bpy.data.objects["B Body"]
    transfer = PairedWeightTransfer(limit)
    transfer.read(bpy.context, source, target)
    run(transfer.steps(true_passage(source, target)))
    return transfer.write(bpy.context, source, target), weights_of(target)


@pytest.fixture
def made(monkeypatch):
    """Two persons, whose bones are paired; the second's weights are all gone but for one group, which is locked."""
    match_at_once(monkeypatch)
    add_person("A")
    _, made = add_person("B", "fine")
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    return made


@pytest.mark.usefixtures("made")
def test_a_body_of_several_meshes_gets_them_all():
    body, head = bpy.data.objects["B Body"], bpy.data.objects["B Head"]
    before = weights_of(head)
    for part in (body, head):
        part.vertex_groups.clear()
    assert bpy.ops.hiermatch.transfer_paired_weights(source="A", target="B", limit=0) == {"FINISHED"}
    after = {name: weights for name, weights in weights_of(head).items() if not name.startswith("HM")}
    assert "X_head" in after
    assert "X_thigh.L" not in after
    assert max(abs(after["X_head"].get(vertex, 0) - weight) for vertex, weight in before["X_head"].items()) < 0.02
    assert "X_thigh.L" in weights_of(body)


def differences(made, weights):
    """For each bone the mean difference from its true weights, at the vertices of the body."""
    body = bpy.data.objects["B Body"]
    result = {}
    for name in made.names:
        column = np.zeros(len(body.data.vertices))
        for vertex, weight in weights.get(name, {}).items():
            column[vertex] = weight
        result[name] = column
    return result


def test_other_bones_get_the_weights_and_chains_share_them(made):
    body = bpy.data.objects["B Body"]
    before = differences(made, weights_of(body))
    body.vertex_groups.clear()
    report, weights = carry()
    after = differences(made, weights)
    assert report.done.endswith("vertex groups")
    sums = np.sum(list(after.values()), axis=0)
    assert np.allclose(sums, 1, atol=1e-4)
    for name in ("X_thigh.L", "X_shin.R", "X_hand.L", "X_hips"):
        assert np.abs(after[name] - before[name]).max() < 0.02
    arm = [after[f"X_upper_arm.L.{part}"] for part in range(2)]
    assert min(part.max() for part in arm) > 0.7
    assert not after["X_root"].any()


def test_locked_groups_stay_and_the_limit_holds(made):
    body = bpy.data.objects["B Body"]
    group = body.vertex_groups["X_thigh.L"]
    group.lock_weight = True
    before = weights_of(body)["X_thigh.L"]
    report, weights = carry(limit=2)
    assert weights["X_thigh.L"] == before
    assert "X_thigh.L" in report.notes[0]
    counts = np.sum([column > 0 for column in differences(made, weights).values()], axis=0)
    assert counts.max() <= 2 + 1


@pytest.mark.usefixtures("made")
def test_without_pairs_it_is_refused():
    bpy.context.scene.hiermatch_bone_pairs.clear()
    before = weights_of(bpy.data.objects["B Body"])
    with pytest.raises(HierMatchError, match="Pair their bones first"):
        carry()
    assert weights_of(bpy.data.objects["B Body"]) == before


@pytest.mark.usefixtures("made")
def test_the_button_waits_for_pairs_and_says_so():
    assert bpy.ops.hiermatch.transfer_paired_weights.poll()
    bpy.context.scene.hiermatch_bone_pairs.clear()
    with pytest.raises(RuntimeError, match="Pair the bones first"):
        bpy.ops.hiermatch.transfer_paired_weights(source="A", target="B")
