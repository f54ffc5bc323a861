# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of vertex groups as a matrix: read and written, and nothing else changed."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene.deform_layer import (
    check_weights_writable,
    read_group,
    read_weights,
    reading_once,
    write_weights,
)
from scipy.sparse import csr_array

from tests.addon.scenes import add_blob, mesh_snapshot, weights_of


def random_weights(rows, columns, seed=0, share=0.4):
    """Weights as single precision keeps them, so that they come back exactly."""
    random = np.random.default_rng(seed)
    dense = random.random((rows, columns)) * (random.random((rows, columns)) < share)
    return csr_array(dense.astype(np.float32).astype(float))


@pytest.fixture
def blob():
    return add_blob("Blob")


def test_weights_come_back_exactly(blob):
    weights = random_weights(len(blob.data.vertices), 7)
    write_weights(blob, list("gfedcba"), weights)
    assert [group.name for group in blob.vertex_groups] == list("gfedcba")
    np.testing.assert_array_equal(read_weights(blob).toarray(), weights.toarray())
    found = weights_of(blob)
    for column, name in enumerate("gfedcba"):
        rows = np.flatnonzero(weights[:, [column]].toarray())
        assert found[name] == {row: weights[row, column] for row in rows.tolist()}


def test_weights_that_are_no_numbers_count_as_none(blob):
    weights = random_weights(len(blob.data.vertices), 2)
    write_weights(blob, list("ab"), weights)
    group = next(element for vertex in blob.data.vertices for element in vertex.groups if element.group == 1)
    group.weight = float("nan")
    read = read_weights(blob)
    assert np.isfinite(read.data).all()
    assert (read.toarray() != weights.toarray()).sum() == 1
    write_weights(blob, list("ab"), read)
    np.testing.assert_array_equal(read_weights(blob).toarray(), read.toarray())


@pytest.mark.parametrize(("stored", "counts"), [(1.5, 1), (float("inf"), 1), (-0.5, 0), (float("-inf"), 0)])
def test_weights_beyond_their_range_count_as_its_ends(blob, stored, counts):
    write_weights(blob, ["a"], csr_array(np.full((len(blob.data.vertices), 1), 0.5)))
    blob.data.vertices[3].groups.foreach_set("weight", np.array([stored], np.float32))
    read = read_weights(blob)
    assert read[3, 0] == counts
    assert read_group(blob, "a")[3] == counts
    write_weights(blob, ["a"], read)
    np.testing.assert_array_equal(read_weights(blob).toarray(), read.toarray())


def test_an_object_without_groups_has_no_columns(blob):
    assert read_weights(blob).shape == (len(blob.data.vertices), 0)
    write_weights(blob, [], csr_array((len(blob.data.vertices), 0)))
    assert not len(blob.vertex_groups)


def test_writing_again_replaces_whatever_the_groups_held(blob):
    n = len(blob.data.vertices)
    for seed in range(4):
        weights = random_weights(n, 5, seed)
        write_weights(blob, list("abcde"), weights)
        np.testing.assert_array_equal(read_weights(blob).toarray(), weights.toarray())
    write_weights(blob, list("edcba"), weights)
    np.testing.assert_array_equal(read_weights(blob).toarray(), weights.toarray()[:, ::-1])


def test_other_groups_stay_as_they_are(blob):
    n = len(blob.data.vertices)
    before = random_weights(n, 6)
    write_weights(blob, list("abcdef"), before)
    blob.vertex_groups["b"].lock_weight = True
    blob.vertex_groups["e"].lock_weight = True
    blob.vertex_groups.active_index = 4
    blob.vertex_groups["c"].add([0, 5], 0.0, "REPLACE")  # in the group, but with no weight
    new = random_weights(n, 3, 1)
    write_weights(blob, ["new", "d", "b"], new)
    expected = np.concatenate([before.toarray(), np.zeros((n, 1))], axis=1)
    expected[:, [6, 3, 1]] = new.toarray()
    expected[[0, 5], 2] = 0
    np.testing.assert_array_equal(read_weights(blob).toarray(), expected)
    assert [group.name for group in blob.vertex_groups] == [*"abcdef", "new"]
    assert [group.lock_weight for group in blob.vertex_groups] == [False, True, False, False, True, False, False]
    assert blob.vertex_groups.active_index == 4
    assert weights_of(blob)["c"][5] == 0


def test_nothing_else_on_the_mesh_changes(blob):
    blob.shape_key_add(name="Basis")
    key = blob.shape_key_add(name="Key")
    key.data[3].co.x += 1
    blob.data.attributes.new("numbers", "FLOAT", "POINT")
    blob.data.color_attributes.new("colors", "BYTE_COLOR", "CORNER")
    before = mesh_snapshot(blob)
    write_weights(blob, ["a"], random_weights(len(blob.data.vertices), 1))
    after = mesh_snapshot(blob)
    changed = {name for name in before if before[name] != after[name]}
    assert changed <= {"groups", "weights", "active_group"}
    assert tuple(blob.data.shape_keys.key_blocks["Key"].data[3].co) == tuple(key.data[3].co)


def test_weights_that_fit_nowhere_are_refused_before_anything_is_written(blob):
    n = len(blob.data.vertices)
    before = mesh_snapshot(blob)
    with pytest.raises(ValueError, match="should have the shape"):
        write_weights(blob, ["a"], random_weights(n, 2))
    with pytest.raises(ValueError, match="between 0 and 1"):
        write_weights(blob, ["a"], csr_array(np.full((n, 1), 1.5)))
    with pytest.raises(ValueError, match="between 0 and 1"):
        write_weights(blob, ["a"], csr_array(np.full((n, 1), np.nan)))
    with pytest.raises(ValueError, match="twice"):
        write_weights(blob, ["a", "a"], random_weights(n, 2))
    assert mesh_snapshot(blob) == before


def test_a_little_more_than_one_is_one(blob):
    n = len(blob.data.vertices)
    write_weights(blob, ["a"], csr_array(np.full((n, 1), 1 + 1e-9)))
    np.testing.assert_array_equal(read_weights(blob).toarray(), 1)


def test_a_shared_mesh_is_refused(blob):
    other = bpy.data.objects.new("Other", blob.data)
    bpy.context.scene.collection.objects.link(other)
    with pytest.raises(ObjectError, match="shares its mesh"):
        write_weights(blob, ["a"], random_weights(len(blob.data.vertices), 1))
    other.data = other.data.copy()
    blob.data.use_fake_user = True
    check_weights_writable(blob)


def test_edit_mode_is_refused(blob):
    bpy.context.view_layer.objects.active = blob
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        with pytest.raises(ObjectError, match="Edit Mode"):
            check_weights_writable(blob)
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def test_linked_objects_are_refused(tmp_path):
    add_blob("Blob")
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, chosen):
        chosen.objects = ["Blob"]
    obj = bpy.data.objects["Blob"]
    with pytest.raises(ObjectError, match="Make Local"):
        check_weights_writable(obj)


def test_what_is_read_once_is_read_anew_afterwards(blob):
    group = blob.vertex_groups.new(name="Group")
    group.add([0], 0.25, "REPLACE")
    with reading_once():
        first = read_weights(blob)
        first.data[:] = 1  # whoever gets it may change it
        group.add([0], 0.75, "REPLACE")
        assert read_weights(blob)[0, 0] == 0.25
        assert read_group(blob, "Group")[0] == 0.25
    assert read_weights(blob)[0, 0] == 0.75


def test_after_an_error_weights_are_read_anew(blob):
    group = blob.vertex_groups.new(name="Group")
    group.add([0], 0.25, "REPLACE")
    with pytest.raises(KeyError), reading_once():
        blob.data.attributes[str(read_weights(blob).shape)]
    group.add([0], 0.75, "REPLACE")
    assert read_weights(blob)[0, 0] == 0.75
