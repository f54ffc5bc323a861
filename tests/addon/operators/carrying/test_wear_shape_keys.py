# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys and Wear: fits that are keys of the original, keys of items, and those of bodies that items follow."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from tests.addon.garments import add_twin, evaluated, fitted, in_world, wear
from tests.addon.shape_keys import positions


def test_a_shape_key_is_found_again_after_renaming(dressed_pair):
    _, target, shirt, _ = dressed_pair
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    target.name = "Giant"
    assert wear("Shirt", target="Giant", wear_result="KEY") == {"FINISHED"}
    assert shirt.data.shape_keys.key_blocks.keys() == ["Basis", "Fit to Giant"]


def test_a_shape_key_on_the_original(dressed_pair):
    _, target, shirt, _ = dressed_pair
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    key = shirt.data.shape_keys.key_blocks["Fit to Target"]
    assert key.value == 1
    assert not [obj for obj in bpy.data.objects if "hiermatch_body" in obj]
    moved = np.array([shirt.matrix_world @ point.co for point in key.data])
    assert np.linalg.norm(moved.mean(axis=0) - in_world(target).mean(axis=0)) < 0.3


def test_shape_keys_for_several_bodies_stay_as_far_on_as_they_are(dressed_pair):
    _, target, shirt, _ = dressed_pair
    add_twin(target)
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    assert wear("Shirt", target="Twin", wear_result="KEY") == {"FINISHED"}
    keys = shirt.data.shape_keys.key_blocks
    assert [keys["Fit to Target"].value, keys["Fit to Twin"].value] == [1, 0]
    keys["Fit to Twin"].value, keys["Fit to Twin"].slider_max = 0.5, 2
    for body in ("Target", "Twin"):
        assert wear("Shirt", target=body, wear_result="KEY") == {"FINISHED"}
    assert [keys["Fit to Target"].value, keys["Fit to Twin"].value] == [1, 0.5]
    assert keys["Fit to Twin"].slider_max == 2


def test_a_copy_of_an_item_with_shape_keys_for_bodies_is_not_fitted_twice(dressed_pair):
    _, target, shirt, coat = dressed_pair
    coat.shape_key_add(name="Basis")
    coat.shape_key_add(name="Puffed", from_mix=False)
    assert wear("Shirt", "Coat", wear_result="KEY") == {"FINISHED"}
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert fitted("Shirt").data.shape_keys is None
    assert fitted("Coat").data.shape_keys.key_blocks.keys() == ["Basis", "Puffed"]
    assert shirt.data.shape_keys.key_blocks["Fit to Target"].value == 1
    bpy.context.view_layer.update()
    seen = fitted("Coat").evaluated_get(bpy.context.evaluated_depsgraph_get())
    middle = np.mean([seen.matrix_world @ vertex.co for vertex in seen.data.vertices], axis=0)
    assert np.linalg.norm(middle - in_world(target).mean(axis=0)) < 0.3


def test_keys_of_the_user_that_are_called_like_fits_are_none(dressed_pair):
    _, target, shirt, _ = dressed_pair
    shirt.shape_key_add(name="Basis")
    shirt.shape_key_add(name="Fit to waist")
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    assert shirt.data.shape_keys.key_blocks["Fit to Target"].value == 1
    target.name = "Giant"
    assert wear("Shirt", target="Giant") == {"FINISHED"}
    assert fitted("Shirt", "Giant").data.shape_keys.key_blocks.keys() == ["Basis", "Fit to waist"]


def test_a_locked_shape_key_is_not_written_over(dressed_pair):
    _, _, shirt, _ = dressed_pair
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    shirt.data.shape_keys.key_blocks["Fit to Target"].lock_shape = True
    with pytest.raises(RuntimeError, match='The shape key "Fit to Target" of "Shirt" is locked'):
        wear("Shirt", wear_result="KEY")


def test_bodies_with_long_names_get_shape_keys_of_their_own(dressed_pair):
    _, target, shirt, _ = dressed_pair
    other = add_twin(target)
    for body, end in ((target, "A"), (other, "B")):
        body.name = "\u4eba" * 20 + end  # with "Fit to " longer than the name of a key can be
    for body in (target, other, target):
        assert wear("Shirt", target=body.name, wear_result="KEY") == {"FINISHED"}
    _, *made = shirt.data.shape_keys.key_blocks.keys()
    assert len(made) == 2
    assert all(name.startswith("Fit to \u4eba\u4eba") for name in made)


def test_keys_of_an_item_go_along(dressed_pair):
    _, _, shirt, _ = dressed_pair
    shirt.shape_key_add(name="Basis")
    key = shirt.shape_key_add(name="Puffed")
    up = np.zeros((len(key.data), 3))
    up[:, 2] = 0.1
    key.data.foreach_set("co", (positions(shirt) + up).astype(np.float32).ravel())
    assert wear("Shirt") == {"FINISHED"}
    copy = fitted("Shirt")
    basis, puffed = (np.array([p.co for p in copy.data.shape_keys.key_blocks[n].data]) for n in ("Basis", "Puffed"))
    lengths = np.linalg.norm(puffed - basis, axis=1)
    assert lengths.min() > 0.03
    assert lengths.max() < 0.4


def add_belly(body, name="Belly"):
    """Add a key that moves one end of a body outwards; return which of its vertices."""
    if body.data.shape_keys is None:
        body.shape_key_add(name="Basis")
    key = body.shape_key_add(name=name, from_mix=False)
    key.value = 0
    points = positions(body)
    chosen = points[:, 0] > np.quantile(points[:, 0], 0.8)
    normals = np.array([vertex.normal for vertex in body.data.vertices])
    key.data.foreach_set("co", (points + 0.1 * chosen[:, None] * normals).astype(np.float32).ravel())
    return chosen


def test_items_follow_the_keys_of_the_body(dressed_pair):
    _, target, *_ = dressed_pair
    add_belly(target)
    target.data.shape_keys.key_blocks["Belly"].slider_max = 2
    target.shape_key_add(name="Nothing", from_mix=False)
    assert wear("Shirt", "Coat") == {"FINISHED"}
    for name in ("Shirt", "Coat"):
        copy = fitted(name)
        assert copy.data.shape_keys.key_blocks.keys() == ["Basis", "Belly"]
        assert copy.data.shape_keys.key_blocks["Belly"].slider_max == 2
        before = evaluated(copy)
        target.data.shape_keys.key_blocks["Belly"].value = 1
        moved = np.linalg.norm(evaluated(copy) - before, axis=1)
        target.data.shape_keys.key_blocks["Belly"].value = 0
        assert moved.max() > 0.05
        assert (moved == 0).any()
    assert 'follows 1 shape key of "Target"' in bpy.context.scene.hiermatch_retarget.report.remarks
    assert wear("Shirt", wear_keys=False) == {"FINISHED"}
    assert fitted("Shirt").data.shape_keys is None


def drive(obj, name, body, leader):
    """Let a key of an object be driven by one of a body's."""
    driver = obj.data.shape_keys.driver_add(f'key_blocks["{name}"].value').driver
    driver.type = "AVERAGE"
    place = driver.variables.new().targets[0]
    place.id_type, place.id = "KEY", body.data.shape_keys
    place.data_path = f'key_blocks["{leader}"].value'


def test_keys_of_an_item_that_the_body_drives_are_driven_by_the_other_body(dressed_pair):
    source, target, shirt, _ = dressed_pair
    for body in (source, target):
        add_belly(body)
    add_belly(source, "Tail")
    for name in ("Belly", "Tail"):
        add_belly(shirt, name)
        drive(shirt, name, source, name)
    assert wear("Shirt") == {"FINISHED"}
    keys = fitted("Shirt").data.shape_keys
    assert keys.key_blocks.keys() == ["Basis", "Belly", "Tail"]
    read = {curve.data_path: curve.driver.variables[0].targets[0].id for curve in keys.animation_data.drivers}
    assert read == {
        'key_blocks["Belly"].value': target.data.shape_keys,
        'key_blocks["Tail"].value': source.data.shape_keys,
    }
    assert f'still read from "{source.data.shape_keys.name}"' in bpy.context.scene.hiermatch_retarget.report.notes


@pytest.mark.parametrize("follows", ["", "key", "surface"])
def test_an_item_lies_on_a_body_as_its_keys_show_it_unless_it_follows_them(dressed_pair, follows):
    """As where characters are made by keys that are on, such as a belly, and clothes are made on them."""
    source, _, shirt, _ = dressed_pair
    assert wear("Shirt") == {"FINISHED"}
    expected = in_world(fitted("Shirt"))
    chosen = add_belly(source)
    key = source.data.shape_keys.key_blocks["Belly"]
    key.slider_max = key.value = 2
    if follows == "key":
        shirt.shape_key_add(name="Basis")
        shirt.shape_key_add(name="Belly", from_mix=False)
    elif follows == "surface":
        shirt.modifiers.new("Follow", "SURFACE_DEFORM").target = source
    else:
        moved = positions(shirt)
        moved[chosen] += 0.2 * np.array([vertex.normal for vertex in source.data.vertices])[chosen]
        shirt.data.vertices.foreach_set("co", moved.astype(np.float32).ravel())
    bpy.context.view_layer.update()
    assert wear("Shirt") == {"FINISHED"}
    np.testing.assert_allclose(in_world(fitted("Shirt")), expected, atol=0.05)


def test_what_does_not_follow_the_keys_of_the_body_is_fitted_to_what_they_show(dressed_pair):
    """A body that is made by keys, such as a belly that is on, pokes through nothing that is worn by it."""
    _, target, shirt, coat = dressed_pair
    add_belly(target)
    key = target.data.shape_keys.key_blocks["Belly"]
    key.slider_max = key.value = 2
    assert wear("Shirt") == {"FINISHED"}
    expected = evaluated(fitted("Shirt"))
    assert wear("Shirt", wear_keys=False) == {"FINISHED"}
    np.testing.assert_allclose(in_world(fitted("Shirt")), expected, atol=0.1)
    assert wear("Shirt", "Coat", wear_result="KEY") == {"FINISHED"}
    np.testing.assert_allclose(evaluated(shirt), expected, atol=0.1)
    assert coat.data.shape_keys.key_blocks.keys() == ["Basis", "Fit to Target"]
