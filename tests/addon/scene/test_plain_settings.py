# SPDX-License-Identifier: GPL-3.0-or-later
"""What is set on modifiers, as texts."""

import numpy as np
from hiermatch.hiermatch_addon.scene.plain_settings import written_settings

from tests.addon.rigs import add_mesh


def test_the_text_is_another_one_once_a_setting_was_changed():
    obj = add_mesh("Item", np.eye(3), np.array([[0, 1, 2]]))
    modifier = obj.modifiers.new("Solidify", "SOLIDIFY")
    before = written_settings(modifier)
    modifier.show_expanded, modifier.name = False, "Thickness"
    assert written_settings(modifier) == before
    modifier.thickness = 0.3
    assert written_settings(modifier) != before
    assert written_settings(modifier, {"thickness"}) == written_settings(modifier).replace(
        f"'thickness': {modifier.thickness}, ", ""
    )
