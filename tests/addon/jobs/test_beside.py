# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs whose work is done in a process beside Blender: the same result, and nothing of it stays behind."""

from __future__ import annotations

import os
import signal
import time

import bpy
import numpy as np
import pytest
from hiermatch.engine import HierMatchError, MatchSettings, close_helpers, use_processes
from hiermatch.engine.mesh.closest_points import ClosestPoints
from hiermatch.engine.runtime.worker import call_background
from hiermatch.hiermatch_addon.jobs.match_job import JobOptions, MatchJob, job_options
from hiermatch.hiermatch_addon.jobs.transfer_job import TransferJob, TransferOptions
from hiermatch.hiermatch_addon.scene.character import read_surface
from hiermatch.hiermatch_addon.transfers.options.retarget import chosen_transfers

from tests.addon.rigs import add_rigged_pair
from tests.addon.scenes import DENSE, MAP_ATTRIBUTES, QUICK, add_pair, mesh_snapshot, snapshot, values_of
from tests.processes import is_gone

pytestmark = pytest.mark.computes_anew

PATIENCE = 60


@pytest.fixture(scope="module", autouse=True)
def two_processes():
    use_processes(2)
    yield
    close_helpers()
    use_processes()


def advance(job, until=lambda: False):
    """Advance as the timer of a window does, to the end or until something holds."""
    end = time.monotonic() + PATIENCE
    while not job.advance(0.05) and not until():
        assert time.monotonic() < end
        time.sleep(0.005)


def begun(pair):
    """A match that is being computed, and the number of the process that does it."""
    job = MatchJob(bpy.context, *pair, JobOptions(settings=MatchSettings(**DENSE)))
    helper = call_background()
    job.work_beside()
    advance(job, lambda: helper.is_busy and job.progress.fraction > 0)
    return job, helper.pid


def test_a_match_writes_the_same(dense_pair):
    source, target = dense_pair
    written = [{name: values_of(obj.data.attributes[name]) for name in MAP_ATTRIBUTES} for obj in dense_pair]
    job = MatchJob(bpy.context, source, target, JobOptions(settings=MatchSettings(**DENSE)))
    job.work_beside()
    seen = []
    advance(job, lambda: seen.append((job.progress.fraction, job.preview)))
    outcome = job.finish()
    assert_previewed([(fraction, found) for fraction, found in seen if found is not None], dense_pair, outcome.result)
    for obj, before in zip(dense_pair, written, strict=True):
        for name in MAP_ATTRIBUTES:
            np.testing.assert_array_equal(values_of(obj.data.attributes[name]), before[name])


def assert_previewed(seen, pair, result):
    """Assert that a coarse map was known well before the end, on both surfaces and near the map that came of it."""
    fraction, preview = seen[0]
    assert fraction < 0.8
    assert len({id(found) for _, found in seen}) <= 3
    surfaces = [read_surface(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=False) for obj in pair]
    size = np.sqrt(surfaces[1].area)
    found = [
        ClosestPoints(mesh).nearest(points)
        for mesh, points in zip(surfaces, (preview.source, preview.target), strict=True)
    ]
    assert max(np.sqrt(one.squared_distances).max() for one in found) < 0.02 * size
    images = found[0].interpolate(surfaces[0].triangles, result.source_to_target.positions)
    assert np.linalg.norm(images - preview.target, axis=1).mean() < 0.1 * size


def test_what_is_carried_is_the_same(tmp_path):
    source, target = add_rigged_pair()
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Swell").data[0].co.z += 0.3
    source.data.uv_layers.new(name="Layout")
    state = bpy.context.scene.hiermatch
    for name, value in DENSE.items():
        setattr(state, name, value)
    bpy.ops.hiermatch.match(source="Source", target="Target", **DENSE)
    path = str(tmp_path / "matched.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    written = []
    for beside in True, False:
        bpy.ops.wm.open_mainfile(filepath=path)
        source, target = bpy.data.objects["Source"], bpy.data.objects["Target"]
        options = bpy.context.scene.hiermatch_retarget
        options.use_attributes = True
        made = TransferOptions(job_options(bpy.context.scene.hiermatch), optional=True)
        job = TransferJob(bpy.context, source, [target], lambda: chosen_transfers(options, "HM"), made)  # noqa: B023
        if beside:
            job.work_beside()
        advance(job)
        (carried,) = job.finish(bpy.context)
        written.append((mesh_snapshot(target), [(report.done, report.notes) for report in carried.reports]))
    assert written[0] == written[1]


@pytest.mark.parametrize("way", ["close", "unregister"])
def test_what_ends_a_job_ends_the_process(extension, way):
    pair = add_pair()
    before = snapshot()
    job, pid = begun(pair)
    if way == "close":
        job.close()
    else:
        extension.unregister()
        extension.register()
    assert is_gone(pid)
    assert snapshot() == before
    job.close()


def test_loading_a_file_ends_the_job_and_then_the_process():
    job, pid = begun(add_pair())
    bpy.ops.wm.read_homefile(use_empty=True)
    with pytest.raises(HierMatchError, match="was deleted"):
        job.advance(0.05)
    job.close()  # as the operator does
    assert is_gone(pid)


def test_undoing_leaves_it_at_work():
    bpy.ops.ed.undo_push(message="Before")
    pair = add_pair()
    bpy.ops.ed.undo_push(message="Pair")
    bpy.ops.object.empty_add()
    bpy.ops.ed.undo_push(message="Empty")
    job = MatchJob(bpy.context, *pair, JobOptions(settings=MatchSettings(**QUICK)))
    job.work_beside()
    job.advance(0.0)
    bpy.ops.ed.undo()
    advance(job)
    assert job.finish().result.source_points.positions.shape == (QUICK["points"], 3)


def test_a_process_that_was_killed_is_said_in_a_sentence():
    pair = add_pair()
    before = snapshot()
    job, pid = begun(pair)
    os.kill(pid, signal.SIGKILL)
    with pytest.raises(HierMatchError, match="The process that did the work ended"):
        advance(job)
    assert snapshot() == before


def test_what_is_wrong_is_said_as_ever():
    source, target = add_pair()
    excluded = source.vertex_groups.new(name="Most")
    excluded.add(range(3, len(source.data.vertices)), 1.0, "REPLACE")
    job = MatchJob(bpy.context, source, target, JobOptions(settings=MatchSettings(**QUICK), exclude_source="Most"))
    job.work_beside()
    with pytest.raises(HierMatchError, match="source"):
        advance(job)
