# SPDX-License-Identifier: GPL-3.0-or-later
"""What is prepared in a session is kept for the next match, as far as there is memory, and can be forgotten."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.engine import MatchSettings
from hiermatch.engine.matching import matching
from hiermatch.hiermatch_addon.jobs.match_job import JobOptions, MatchJob
from hiermatch.hiermatch_addon.jobs.prepared_shapes import forget_shapes, known_shapes
from hiermatch.hiermatch_addon.properties.preferences import HIERMATCH_AP_preferences, shape_memory

from tests.addon.scenes import QUICK, add_blob, add_pair

pytestmark = pytest.mark.computes_anew


@pytest.fixture
def prepared(monkeypatch):
    """Names of what is prepared from now on."""
    forget_shapes()
    made, prepare = [], matching.prepared_steps

    def noted_steps(mesh, name, **options):
        made.append(name)
        return prepare(mesh, name, **options)

    monkeypatch.setattr(matching, "prepared_steps", noted_steps)
    yield made
    forget_shapes()


def matched(source, target):
    job = MatchJob(bpy.context, source, target, JobOptions(settings=MatchSettings(**QUICK)))
    while not job.advance(1.0):
        pass
    return job.finish()


def test_one_source_is_prepared_once_for_several_targets(prepared):
    source, target = add_pair()
    other = add_blob("Other", segments=18)
    matched(source, target)
    matched(source, other)
    matched(source, target)
    assert prepared == ["source", "target", "target"]


def test_what_was_edited_or_forgotten_is_prepared_anew(prepared):
    source, target = add_pair()
    matched(source, target)
    source.data.vertices[0].co.x += 0.01
    matched(source, target)
    assert prepared == ["source", "target", "source"]
    assert bpy.ops.hiermatch.forget_shapes() == {"FINISHED"}
    matched(source, target)
    assert prepared == ["source", "target", "source", "source", "target"]


def test_the_memory_is_what_the_preferences_say():
    default = HIERMATCH_AP_preferences.bl_rna.properties["shape_memory"].default
    assert shape_memory(bpy.context) == default  # the tests' extension is not installed
    assert known_shapes(default) is known_shapes(default)
    assert known_shapes(0).megabytes == 0
    assert known_shapes(default).megabytes == default
