# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys and what is set on them."""

import pytest
from hiermatch.hiermatch_addon.scene.shape_key_io import key_value_path

from tests.addon.scenes import add_blob


@pytest.mark.parametrize("name", ["Smile", 'so called "Smile"', "back\\slash", "a tab\tand\na line"])
def test_the_path_to_a_key_is_that_of_blender(name):
    obj = add_blob("Blob")
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name=name)
    assert key_value_path(key.name, "mute") == f"{key.path_from_id()}.mute"
    assert obj.data.shape_keys.path_resolve(key_value_path(key.name)) == key.value
