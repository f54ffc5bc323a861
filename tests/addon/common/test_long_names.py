# SPDX-License-Identifier: GPL-3.0-or-later
"""Names are cut as Blender would cut them, but stay apart."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.hiermatch_addon.common.long_names import LONGEST_ID, LONGEST_KEY, shortened


def test_blender_keeps_names_of_that_length_and_no_longer_ones():
    obj = bpy.data.objects.new(LONGEST_ID * "x", bpy.data.meshes.new("Mesh"))
    assert len(obj.name) == LONGEST_ID
    obj.name = (LONGEST_ID + 1) * "y"
    assert len(obj.name) == LONGEST_ID
    assert len(obj.shape_key_add(name=(LONGEST_KEY + 1) * "x").name) == LONGEST_KEY


@pytest.mark.parametrize("letter", ["x", "Ä", "猫"])
def test_what_fits_stays_and_what_is_cut_stays_apart(letter):
    assert shortened(letter, 20, " (edited)") == f"{letter} (edited)"
    cut = {shortened(40 * letter + side, 40, " (edited)") for side in ("", ".L", ".R")}
    assert len(cut) == 3
    for name in cut:
        assert 36 < len(name.encode()) <= 40
        assert name.endswith(" (edited)")
