# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies whose surfaces say little, but whose rigs say where their limbs are."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from hiermatch.engine import MatchError, MatchQuality, Progress, SurfaceMap
from hiermatch.hiermatch_addon.jobs import match_job
from hiermatch.hiermatch_addon.storage.landmarks import find_landmarks

from tests.addon.characters import add_person
from tests.addon.scenes import add_blob, made_up_result

NOTE = "limbs were taken for the same that both rigs have"


@pytest.fixture
def asked(monkeypatch):
    """Matches that were asked for: the first is wrong and as sure as it is said, the next ones are right."""
    asked = []

    def make(confidence=0.1, refusal=None):
        def steps(source, target, _settings, **names):
            asked.append(names)
            yield Progress(0.5, "Matching")
            if refusal and len(asked) > 1:
                raise MatchError(refusal)
            maps = SurfaceMap.identity(target), SurfaceMap.identity(source)
            if len(asked) == 1:  # all goes to one place
                maps = [
                    SurfaceMap.from_barycentric(mesh, 0 * each.points.triangles, each.points.barycentric)
                    for mesh, each in zip((target, source), maps, strict=True)
                ]
            quality = MatchQuality(1.0, 0.05, 1.0, 0.0, None, confidence, "Little in common.", 1.0, None, 0.0)
            dense = {"source_to_target": maps[0], "target_to_source": maps[1]}
            return replace(made_up_result(source, target), quality=quality, **dense)

        monkeypatch.setattr(match_job, "match_steps", steps)
        return asked

    return make


def test_a_doubtful_match_that_takes_limbs_elsewhere_is_made_anew_by_the_rigs(asked, capfd):
    calls = asked()
    add_person("A")
    add_person("B", "renamed")
    bpy.ops.hiermatch.match(source="A", target="B")
    first, second = calls
    assert first.get("landmarks") is None
    assert second["assumed"]
    pairs = second["landmarks"]
    assert len(pairs) == 5
    np.testing.assert_array_equal(pairs[:, 0], pairs[:, 1])  # their vertices are numbered alike
    assert NOTE in capfd.readouterr().out
    bpy.ops.hiermatch.pair_bones(source="A", target="B", accept_doubtful=True)
    assert len(calls) == 2
    assert len(bpy.context.scene.hiermatch_bone_pairs) > 10


def test_what_is_not_doubtful_is_not(asked, capfd):
    calls = asked(0.5)
    add_person("A")
    add_person("B", "renamed")
    bpy.ops.hiermatch.match(source="A Body", target="B Body")
    assert len(calls) == 1
    assert NOTE not in capfd.readouterr().out


@pytest.mark.parametrize("why", ["no rig", "landmarks", "modifiers"])
def test_without_two_rigs_and_where_the_user_says_what_is_the_same_nothing_is(asked, why):
    calls = asked()
    add_person("A")
    add_person("B", "renamed")
    body = bpy.data.objects["B Body"]
    if why == "no rig":
        body.modifiers.clear()
        body.parent = None
    if why == "landmarks":
        bpy.ops.hiermatch.add_landmark(source="A Body", target="B Body", source_vertex=5, target_vertex=5)
        assert find_landmarks(bpy.data.objects["A Body"], body)
    bpy.ops.hiermatch.match(source="A Body", target="B Body", use_modifiers=why == "modifiers")
    assert len(calls) == 1


def test_ends_of_limbs_that_cannot_be_used_leave_what_there_was(asked, capfd):
    calls = asked(refusal="Landmark 1 is not on the main part.")
    add_person("A")
    add_person("B", "renamed")
    bpy.ops.hiermatch.match(source="A Body", target="B Body")
    assert len(calls) == 2
    assert NOTE not in capfd.readouterr().out


def test_what_a_body_holds_is_no_limb_and_is_left_out(asked):
    calls = asked()
    for name in "AB":
        body, _ = add_person(name)
        sword = add_blob(f"Sword {name}", 8, 6)
        sword.parent, sword.parent_type, sword.parent_bone = body, "BONE", "hand.L"
        sword.matrix_parent_inverse.translation = (0, 3, 0)
    bpy.context.view_layer.update()
    bpy.ops.hiermatch.match(source="A", target="B")
    pairs = calls[1]["landmarks"]
    assert len(pairs) == 5
    for held, ends in zip(calls[1]["excluded"], pairs.T, strict=True):
        assert held.sum() == len(sword.data.vertices)
        assert not held[ends].any()
