# SPDX-License-Identifier: GPL-3.0-or-later
"""The one button, and what all transfers have in common: matching where needed, several targets, errors, undo."""

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.jobs import match_job
from hiermatch.hiermatch_addon.jobs.match_job import job_options
from hiermatch.hiermatch_addon.jobs.transfer_job import TransferJob, TransferOptions
from hiermatch.hiermatch_addon.operators.carrying import transfer_operator
from hiermatch.hiermatch_addon.scene.armatures import find_armature
from hiermatch.hiermatch_addon.scene.deform_layer import read_weights
from hiermatch.hiermatch_addon.storage.linked_matches import kept_linked
from hiermatch.hiermatch_addon.storage.stored_map import find_maps
from hiermatch.hiermatch_addon.transfers.options.weights import WeightSettings
from hiermatch.hiermatch_addon.transfers.weights import WeightTransfer

from tests.addon.rigs import add_rigged, add_rigged_pair, add_target
from tests.addon.scenes import DENSE, mesh_snapshot, snapshot


def quick():
    """Let matches on the way be quick."""
    state = bpy.context.scene.hiermatch
    for name, value in DENSE.items():
        setattr(state, name, value)


def add_key(obj, name="Swell"):
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name=name)
    key.value = 0
    for point in key.data:
        point.co.z += 0.1 * max(0.0, point.co.x)


def add_uvs(obj):
    layer = obj.data.uv_layers.new(name="Layout")
    for loop in obj.data.loops:
        x, _, z = obj.data.vertices[loop.vertex_index].co
        layer.data[loop.index].uv = (0.2 * x + 0.5, 0.2 * z + 0.5)


def weight_error(source, target):
    """Mean absolute difference of the weights, summed over bones; the vertices are numbered alike."""
    names = [group.name for group in source.vertex_groups if not group.name.startswith("HM")]

    def columns(obj):
        return read_weights(obj).toarray()[:, [obj.vertex_groups[name].index for name in names]]

    return np.abs(columns(source) - columns(target)).sum(axis=1).mean()


@pytest.fixture(scope="module")
def retargeted(extension, tmp_path_factory):
    """A file in which the button was pressed, for a rigged creature with a shape key and a UV map."""
    assert extension
    bpy.ops.wm.read_homefile(use_empty=True)
    source, target = add_rigged_pair()
    add_key(source)
    add_uvs(source)
    quick()
    assert bpy.ops.hiermatch.retarget(source=source.name, target=target.name) == {"FINISHED"}
    path = str(tmp_path_factory.mktemp("retarget") / "retargeted.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return path


@pytest.fixture
def pair(retargeted, empty_file):
    assert empty_file
    bpy.ops.wm.open_mainfile(filepath=retargeted)
    state = bpy.context.scene.hiermatch
    assert (state.source, state.target) == (bpy.data.objects["Source"], bpy.data.objects["Target"])
    state.source = state.target = None
    return bpy.data.objects["Source"], bpy.data.objects["Target"]


def test_everything_is_carried_over(pair):
    source, target = pair
    assert weight_error(source, target) < 0.15
    armature = find_armature(target)
    assert armature is not None
    assert armature != find_armature(source)
    assert [key.name for key in target.data.shape_keys.key_blocks] == ["Basis", "Swell"]
    assert "Layout" in target.data.uv_layers
    assert not find_maps(source, target).source.staleness()


def test_the_target_follows_its_own_bones(pair):
    """A leg that is turned takes its foot with it, and leaves the head where it is."""
    _, target = pair
    armature = find_armature(target)

    def posed():
        bpy.context.view_layer.update()
        mesh = target.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        return np.array([vertex.co for vertex in mesh.vertices])

    before = posed()
    rest = np.array([vertex.co for vertex in target.data.vertices])
    np.testing.assert_allclose(before, rest, atol=1e-5)
    bone = armature.pose.bones["upper front.L"]
    bone.rotation_mode = "XYZ"
    bone.rotation_euler = (0.6, 0, 0)
    moved = np.linalg.norm(posed() - before, axis=1)
    weights = read_weights(target).toarray()
    own = weights[:, [target.vertex_groups[name].index for name in ("upper front.L", "lower front.L")]].sum(axis=1)
    assert moved[own > 0.9].min() > 0.0
    assert moved[own > 0.9].max() > 0.2
    assert moved[own == 0].max() < 1e-5


@pytest.mark.usefixtures("pair")
def test_the_report_is_remembered():
    report = bpy.context.scene.hiermatch_retarget.report
    assert report.done.startswith('Carried to "Target": ')
    for word in ("vertex groups", "rig", "shape key", "UV map"):
        assert word in report.done
    assert report.seconds > 0


def test_the_map_is_refined_once(pair):
    source, target = pair
    found = find_maps(source, target)
    assert found.refined
    before = found.maps.of_target.weights.copy()
    assert bpy.ops.hiermatch.transfer_weights(source=source.name, target=target.name) == {"FINISHED"}
    np.testing.assert_array_equal(find_maps(source, target).maps.of_target.weights, before)


def test_the_other_way_round_goes_too(pair):
    """What was the target gives its UVs back to what was the source."""
    source, target = pair
    target.data.uv_layers["Layout"].name = "Back"
    assert bpy.ops.hiermatch.transfer_uvs(source=target.name, target=source.name) == {"FINISHED"}
    assert "Back" in source.data.uv_layers


def test_kinds_that_the_source_lacks_are_noted(pair):
    source, target = pair
    source.shape_key_clear()
    for layer in list(source.data.uv_layers):
        source.data.uv_layers.remove(layer)
    assert bpy.ops.hiermatch.retarget(source=source.name, target=target.name) == {"FINISHED"}
    report = bpy.context.scene.hiermatch_retarget.report
    assert "left out" not in report.notes
    assert "Shape Keys left out" in report.remarks
    assert "UV Maps left out" in report.remarks
    assert "vertex groups" in bpy.context.scene.hiermatch_retarget.report.done


def test_a_target_that_shares_its_mesh_gets_all_or_nothing(pair):
    source, target = pair
    sharer = bpy.data.objects.new("Sharer", target.data)
    before = snapshot()
    with pytest.raises(RuntimeError, match=r"shares its mesh.*Make Single User"):
        bpy.ops.hiermatch.retarget(source="Source", target="Target")
    assert snapshot() == before
    bpy.data.objects.remove(sharer)
    sharer = bpy.data.objects.new("Sharer", target.data)
    source.vertex_groups.clear()
    source.shape_key_clear()
    assert bpy.ops.hiermatch.retarget(source="Source", target="Target", use_rig=False) == {"FINISHED"}
    assert target.data.uv_layers.keys() == ["Layout"]


def test_nothing_to_carry_at_all_is_an_error():
    source, target = add_rigged_pair()
    source.modifiers.clear()
    source.parent = None
    source.vertex_groups.clear()
    quick()
    before = snapshot()
    with pytest.raises(RuntimeError, match="no "):
        bpy.ops.hiermatch.retarget(source=source.name, target=target.name)
    assert snapshot() == before


def test_all_kinds_switched_off_are_an_error_and_nothing_is_matched():
    source, target = add_rigged_pair()
    before = snapshot()
    off = dict.fromkeys(("use_rig", "use_weights", "use_shape_keys", "use_uvs", "use_attributes"), False)
    with pytest.raises(RuntimeError, match="All kinds are switched off"):
        bpy.ops.hiermatch.retarget(source=source.name, target=target.name, **off)
    assert snapshot() == before


def test_a_match_is_made_on_the_way_if_it_is_out_of_date(pair):
    source, target = pair
    target.data.vertices[0].co.x += 0.001
    target.data.update()
    quick()
    assert bpy.ops.hiermatch.transfer_weights(source=source.name, target=target.name, refine=False) == {"FINISHED"}
    found = find_maps(source, target)
    assert not found.target.staleness()
    assert not found.refined


def test_a_match_of_a_new_prefix_leaves_the_others_alone(pair):
    source, target = pair
    before = find_maps(source, target, "HM").source.kept
    kinds = {"use_rig": False, "use_shape_keys": False, "use_uvs": False}
    bpy.ops.hiermatch.retarget(source=source.name, target=target.name, prefix="New", refine=False, **kinds)
    assert find_maps(source, target, "HM").source.kept == before
    assert find_maps(source, target, "New")
    assert bpy.context.scene.hiermatch.summary.prefix == "New"


def test_several_targets_get_theirs_and_no_match_is_kept():
    source, _ = add_rigged(resolution=5)
    targets = [add_target(source, name, part)[0] for name, part in (("One", 0.3), ("Two", -0.3))]
    quick()
    names = [{"name": target.name} for target in targets]
    assert bpy.ops.hiermatch.transfer_weights(source="Source", targets=names, refine=False) == {"FINISHED"}
    for target in targets:
        assert weight_error(source, target) < 0.3
        assert not target.data.attributes.get("HM Map Weights")
    assert len(bpy.context.scene.hiermatch_retarget.report.done.splitlines()) == 2


@pytest.fixture
def linked_source(tmp_path):
    """A pair whose source is another file's."""
    source, _ = add_rigged(resolution=4)
    add_target(source, part=0.3)
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    for name, link in (("Source", True), ("Target", False)):
        with bpy.data.libraries.load(path, link=link) as (_, into):
            into.objects = [name]
        bpy.context.scene.collection.objects.link(into.objects[0])
    bpy.context.view_layer.update()
    quick()
    return bpy.data.objects["Source"], bpy.data.objects["Target"]


def test_a_linked_source_is_carried_from_and_the_target_keeps_the_match(linked_source, monkeypatch, tmp_path):
    source, target = linked_source
    assert source.library is not None
    assert bpy.ops.hiermatch.transfer_weights(source="Source", target="Target", refine=False) == {"FINISHED"}
    assert weight_error(source, target) < 0.3
    assert not target.data.attributes.get("HM Map Weights")
    with pytest.raises(RuntimeError, match=r"is linked from.*As the Source of Retarget, Wear and Motion it can stay"):
        bpy.ops.hiermatch.match(source="Source", target="Target")
    state = bpy.context.scene.hiermatch
    state.source, state.target = source, target
    for operator in (bpy.ops.hiermatch.show, bpy.ops.hiermatch.write_regions, bpy.ops.hiermatch.refine):
        with pytest.raises(RuntimeError, match=r'"Source" is linked.*its matches cannot be shown or refined'):
            operator()
    # It is used by whatever is carried next, also in another session, until a mesh is edited.
    count = []
    real = match_job.match_steps
    monkeypatch.setattr(match_job, "match_steps", lambda *bodies, **names: count.append(1) or real(*bodies, **names))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    target = bpy.data.objects["Target"]
    target.vertex_groups.clear()
    assert bpy.ops.hiermatch.transfer_weights(source="Source", target="Target", refine=True) == {"FINISHED"}
    assert "spine" in target.vertex_groups
    assert not count
    assert kept_linked(bpy.data.objects["Source"], target).stored.answer.refined
    # The rest pose of the source does not make it out of date either.
    for _ in range(2):
        assert bpy.ops.hiermatch.retarget(source="Source", target="Target", rest_pose_like_source="ON") == {"FINISHED"}
    assert "a rest pose" in bpy.context.scene.hiermatch_retarget.report.done
    assert not count
    target.data.vertices[0].co.x += 0.01
    assert bpy.ops.hiermatch.transfer_weights(source="Source", target="Target", refine=False) == {"FINISHED"}
    assert count == [1]
    assert bpy.ops.hiermatch.clear(object="Target") == {"FINISHED"}
    assert kept_linked(bpy.data.objects["Source"], target) is None


def test_what_a_script_has_named_is_picked_if_nothing_is(pair):
    state = bpy.context.scene.hiermatch
    assert bpy.ops.hiermatch.transfer_weights(source="Source", target="Target", refine=False) == {"FINISHED"}
    assert (state.source, state.target) == pair
    state.target = None
    assert bpy.ops.hiermatch.transfer_weights(source="Source", target="Target", refine=False) == {"FINISHED"}
    assert (state.source, state.target) == (pair[0], None)


def test_the_selection_says_what_is_meant(pair):
    source, target = pair
    target.vertex_groups.clear()
    bpy.ops.object.select_all(action="DESELECT")
    for obj in pair:
        obj.select_set(state=True)
    bpy.context.view_layer.objects.active = source
    assert bpy.ops.hiermatch.transfer_weights() == {"FINISHED"}
    assert "spine" in target.vertex_groups


def test_parts_of_the_source_that_are_selected_as_well_are_left_alone(pair, monkeypatch):
    source, target = pair
    coat = source.copy()
    coat.name, coat.data = "Coat", source.data.copy()
    bpy.context.collection.objects.link(coat)
    for obj in (*pair, coat):
        obj.select_set(state=True)
    bpy.context.view_layer.objects.active = source
    bpy.context.scene.hiermatch.source = source  # this part of the character alone
    before, said = mesh_snapshot(coat), []
    monkeypatch.setattr(transfer_operator, "translated", lambda text: said.append(text) or text)
    target.vertex_groups.clear()
    assert bpy.ops.hiermatch.transfer_weights() == {"FINISHED"}
    assert "spine" in target.vertex_groups
    assert mesh_snapshot(coat) == before
    assert 'What the rig of "Source" moves as well was left alone: "Coat".' in said
    assert bpy.context.scene.hiermatch_retarget.report.remarks in said
    target.select_set(state=False)
    with pytest.raises(RuntimeError, match="moved by the same rig"):
        bpy.ops.hiermatch.transfer_weights()


def test_without_a_target_it_says_so(pair):
    source, _ = pair
    bpy.ops.object.select_all(action="DESELECT")
    source.select_set(state=True)
    bpy.context.view_layer.objects.active = source
    with pytest.raises(RuntimeError, match="Target"):
        bpy.ops.hiermatch.transfer_weights()


@pytest.mark.parametrize("change", ["edit", "delete", "hide"])
def test_a_change_while_it_runs_ends_it_with_nothing_written(pair, change):
    source, target = pair
    target.vertex_groups.clear()
    options = TransferOptions(job_options(bpy.context.scene.hiermatch))
    job = TransferJob(bpy.context, source, [target], lambda: [WeightTransfer(WeightSettings())], options)
    while not job.advance(1.0):
        pass
    if change == "edit":
        target.data.vertices[0].co.x += 1
    elif change == "hide":
        target.hide_set(state=True)
    else:
        bpy.data.objects.remove(target)
    before = snapshot()
    with pytest.raises(ObjectError):
        job.finish(bpy.context)
    assert snapshot() == before
    job.close()


def test_what_is_hidden_while_it_runs_does_not_end_it(pair):
    source, target = pair
    options = TransferOptions(job_options(bpy.context.scene.hiermatch))
    job = TransferJob(bpy.context, source, [target], lambda: [WeightTransfer(WeightSettings())], options)
    for obj in pair:
        obj.hide_set(state=True)
    while not job.advance(0.01):
        pass
    target.hide_set(state=False)
    job.finish(bpy.context)
    assert {group.name for group in source.vertex_groups} <= {group.name for group in target.vertex_groups}


@pytest.mark.computes_anew
def test_its_progress_never_goes_back(pair):
    source, target = pair
    bpy.context.scene.hiermatch.prefix = "Other"
    options = TransferOptions(job_options(bpy.context.scene.hiermatch), prefix="HM")
    job = TransferJob(bpy.context, source, [target], lambda: [WeightTransfer(WeightSettings())], options)
    fractions = []
    while not job.advance(0.0):
        fractions.append(job.progress.fraction)
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] <= 1
    job.close()


def test_one_step_back_undoes_it_all():
    source, target = add_rigged_pair()
    quick()
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.hiermatch.retarget("EXEC_DEFAULT", True, source=source.name, target=target.name, use_uvs=False)  # noqa: FBT003
    assert len(bpy.data.armatures) == 2
    bpy.ops.ed.undo()
    target = bpy.data.objects["Target"]
    assert not target.vertex_groups
    assert not target.modifiers
    assert len(bpy.data.armatures) == 1
