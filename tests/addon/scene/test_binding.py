# SPDX-License-Identifier: GPL-3.0-or-later
"""What a target hangs on, when it gets a rig: whoever moves that moves the rig and the target together."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.binding import bind, hang_in_place
from hiermatch.hiermatch_addon.scene.character import joined
from mathutils import Euler, Matrix

from tests.addon.operators.carrying.test_fit_rig import add_weights, fit, own, own_rig
from tests.addon.rigs import add_mesh, add_rigged, add_target

ASKEW = Matrix.Translation((1, 2, 3)) @ Euler((0.3, 0.2, 1)).to_matrix().to_4x4() @ Matrix.Diagonal((1, 2, 1, 1))


def add_empty(name="Root", matrix=ASKEW, above=None):
    """Add an empty, on which something may hang."""
    empty = bpy.data.objects.new(name, None)
    bpy.context.scene.collection.objects.link(empty)
    empty.parent, empty.matrix_basis = above, matrix
    bpy.context.view_layer.update()
    return empty


def hang(obj, parent):
    """Hang an object on another one, where it stands, turned by itself."""
    obj.parent = parent
    obj.matrix_parent_inverse = parent.matrix_world.inverted_safe()
    bpy.context.view_layer.update()


def head_of(armature):
    return np.array(armature.matrix_world @ armature.data.bones["head"].head_local)


def check_moves_with(empty, made, target):
    """Make sure that an empty takes the armature and the target along, and the armature the target."""
    for moved in (empty, made):
        places = own(target), head_of(made)
        moved.location.z += 2
        bpy.context.view_layer.update()
        np.testing.assert_allclose(own(target) - places[0], np.tile((0, 0, 2), (len(places[0]), 1)), atol=1e-4)
        np.testing.assert_allclose(head_of(made) - places[1], (0, 0, 2), atol=1e-4)


def fitted(source, target):
    """Give a target its rig, and make sure that it stays where it is."""
    add_weights(source, target)
    place = own(target)
    made, report = fit(source, target)
    assert target.parent == made
    np.testing.assert_allclose(own(target), place, atol=1e-4)
    return made, report


def test_an_armature_hangs_on_the_empty_above_the_target():
    source, _ = add_rigged()
    target, _ = add_target(source)
    root = add_empty(matrix=Matrix.Translation((1, 2, 3)))
    hang(target, root)
    made, report = fitted(source, target)
    assert made.parent == root
    assert not report.notes
    check_moves_with(root, made, target)


def test_it_takes_the_place_of_an_own_rig_on_what_that_hangs_on():
    source, _ = add_rigged()
    target, _ = add_target(source)
    root = add_empty(matrix=Matrix.Scale(3, 4))
    hang(own_rig(target), root)
    made, _ = fitted(source, target)
    assert made.parent == root
    check_moves_with(root, made, target)


def test_a_target_that_is_sheared_by_what_it_hangs_on_stays_where_it_is():
    source, _ = add_rigged()
    target, _ = add_target(source)
    target.rotation_euler = (0.3, 0.5, 0.5)
    root = add_empty()
    hang(target, root)
    root.scale = (1, 1, 3)
    bpy.context.view_layer.update()
    assert not target.matrix_world.is_orthogonal_axis_vectors
    place = own(target)
    made, _ = fitted(source, target)
    assert made.parent == root
    assert np.abs(own(target) - place).max() < 1e-4


def test_a_target_that_is_sheared_by_its_own_rig_stays_where_it_is():
    source, _ = add_rigged()
    target, _ = add_target(source)
    body, other = add_rigged("Other")
    bpy.data.objects.remove(body)
    target.rotation_euler = (0.3, 0.5, 0.5)
    other.scale = (1, 2, 1)
    target.parent = other
    bpy.context.view_layer.update()
    assert not target.matrix_world.is_orthogonal_axis_vectors
    place = own(target)
    made, _ = fitted(source, target)
    assert made != other
    assert np.abs(own(target) - place).max() < 1e-4


@pytest.mark.parametrize("animated", [False, True])
def test_parts_on_several_empties_hang_on_the_armature_unless_one_moves_by_itself(animated):
    source, rig = add_rigged()
    body, _ = add_target(source)
    hat = add_mesh("Hat", np.eye(3), np.array([[0, 1, 2]]))
    root = add_empty()
    group = add_empty("Turntable", above=root, matrix=Matrix())
    if animated:
        group.keyframe_insert("location", frame=1)
    hang(body, root)
    hang(hat, group)
    place = own(hat)
    made = rig.copy()
    bpy.context.scene.collection.objects.link(made)
    hang_in_place(made, joined("Both", [body, hat]))
    notes = bind(joined("Both", [body, hat]), made, source)
    bpy.context.view_layer.update()
    assert made.parent == root
    np.testing.assert_allclose(np.array(made.matrix_world), np.array(rig.matrix_world), atol=1e-5)
    assert body.parent == made
    assert hat.parent == (group if animated else made)
    assert notes == (['"Hat" keeps its parent "Turntable".'] if animated else [])
    np.testing.assert_allclose(own(hat), place, atol=1e-5)


def test_an_armature_hangs_on_nothing_if_the_parts_have_nothing_above_them_in_common():
    source, rig = add_rigged()
    body, _ = add_target(source)
    hat = add_mesh("Hat", np.eye(3), np.array([[0, 1, 2]]))
    hang(body, add_empty())
    hang_in_place(rig, joined("Both", [body, hat]))
    assert rig.parent is None
