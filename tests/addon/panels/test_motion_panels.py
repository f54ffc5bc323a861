# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel for motion has a button for each thing that can be done with two rigs."""

from __future__ import annotations

from types import SimpleNamespace

from hiermatch.hiermatch_addon.operators.carrying.transfer_paired_weights import HIERMATCH_OT_transfer_paired_weights
from hiermatch.hiermatch_addon.panels import motion_panels

from tests.addon.panels.test_panels import Layout
from tests.addon.panels.test_panels import context as context  # noqa: PLC0414  (a fixture)


def drawn_in_panel(context):
    drawn = []
    panel = SimpleNamespace(layout=Layout(drawn), bl_idname="HIERMATCH_PT_motion")
    motion_panels.HIERMATCH_PT_motion.draw(panel, context)
    return drawn


def test_weights_go_to_the_own_rig_by_a_button_below_the_table_that_starts_as_the_others_do(context):
    drawn = drawn_in_panel(context)
    names = [entry[1] for entry in drawn if entry[0] in ("menu", "operator")]
    weights = "hiermatch.transfer_paired_weights"
    assert names.index("hiermatch.rename_bones") + 1 == names.index(weights)
    assert names.index("hiermatch.pair_bones") < names.index(weights) < names.index("hiermatch.retarget_action")
    running = SimpleNamespace(bl_idname="HIERMATCH_OT_match", panel="HIERMATCH_PT_match")
    context.window_manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[running])])
    assert ("operator", weights) not in drawn_in_panel(context)


def test_the_bar_of_the_weights_stands_in_the_panel_of_their_button(context):
    running = SimpleNamespace(
        bl_idname="HIERMATCH_OT_transfer_paired_weights", panel=HIERMATCH_OT_transfer_paired_weights.panel
    )
    progress = SimpleNamespace(fraction=0.4, label="Carrying over", question="")
    context.window_manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[running])], hiermatch=progress)
    assert drawn_in_panel(context) == [("progress", "Carrying over", 0.4), ("operator", "hiermatch.cancel")]
