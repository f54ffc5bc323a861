# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of a match that is not to be trusted: scripts fail, a window asks, and whoever wants it gets it."""

from types import SimpleNamespace

import bpy
import pytest
from hiermatch.hiermatch_addon.jobs import verdict
from hiermatch.hiermatch_addon.operators.carrying.transfer_operator import TransferOperator
from hiermatch.hiermatch_addon.operators.carrying.transfers import HIERMATCH_OT_transfer_uvs
from hiermatch.hiermatch_addon.panels import retarget_panels

from tests.addon.panels.test_panels import Layout, tell, texts
from tests.addon.scenes import add_pair, snapshot


@pytest.fixture
def doubtful(dense_pair, monkeypatch):
    """A matched pair whose match nobody should trust."""
    monkeypatch.setattr(verdict, "DOUBTFUL", 1.1)
    source, target = dense_pair
    source.data.uv_layers.new(name="Layout")
    return source, target


def carry(operator="transfer_uvs", **options):
    return getattr(bpy.ops.hiermatch, operator)(source="Source", target="Target", **options)


@pytest.mark.parametrize("operator", ["retarget", "transfer_uvs", "wrap"])
@pytest.mark.usefixtures("doubtful")
def test_a_script_fails_and_nothing_changes(operator):
    before = snapshot()
    with pytest.raises(
        RuntimeError, match=r'The match of "Source" and "Target" is doubtful, .*Confidence \d+%: .*Accept'
    ):
        carry(operator)
    assert snapshot() == before


@pytest.mark.parametrize("which", [0, 1])
def test_of_a_half_under_a_mirror_modifier_it_is_said_what_to_do(doubtful, monkeypatch, which):
    monkeypatch.setattr(verdict, "GOOD", 1.1)
    doubtful[which].modifiers.new("Mirror", "MIRROR")
    with pytest.raises(RuntimeError, match=f'"{doubtful[which].name}" has a Mirror modifier, .* apply the modifier'):
        carry()


def test_who_accepts_it_gets_it_with_a_warning(doubtful):
    assert carry(accept_doubtful=True) == {"FINISHED"}
    assert "Layout" in doubtful[1].data.uv_layers
    report = bpy.context.scene.hiermatch_retarget.report
    assert report.doubtful
    assert report.verdict.startswith("Confidence ")


def test_a_match_to_be_trusted_is_told_as_well(dense_pair):
    dense_pair[0].data.uv_layers.new(name="Layout")
    assert carry() == {"FINISHED"}
    report = bpy.context.scene.hiermatch_retarget.report
    assert not report.doubtful
    assert "Confidence" in report.verdict


@pytest.mark.parametrize("doubt", [False, True])
def test_no_check_mark_stands_before_what_is_doubtful(doubt):
    add_pair()
    said = {"done": 'Carried to "Cat": nothing', "verdict": "Confidence 4%: Do not trust it.", "doubtful": doubt}
    tell("HIERMATCH_PT_retarget", **said)
    icons = []

    class Icons(Layout):
        def _part(self, *_arguments, **_names):
            return Icons(self.drawn)

        row = column = split = box = _part

        def label(self, *, text, icon="", **_names):
            icons.append(icon)
            super().label(text=text)

    system = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))
    own = {"scene": bpy.context.scene, "view_layer": bpy.context.view_layer}
    context = SimpleNamespace(region=SimpleNamespace(width=300), preferences=system, **own)
    drawn = []
    retarget_panels.draw_report(Icons(drawn), context, "HIERMATCH_PT_retarget", has_before=True)
    assert "Confidence 4%" in texts(drawn)
    assert ("CHECKMARK" in icons) == (not doubt)


class Names(list):
    """A collection of names."""

    def add(self):
        self.append(SimpleNamespace(name=""))
        return self[-1]


class Asking(TransferOperator):
    """The operator without Blender around it."""

    refine = accept_doubtful = False
    prefix, _transfers = "", HIERMATCH_OT_transfer_uvs._transfers  # noqa: SLF001

    def __init__(self):
        self.source, self.target, self.reports = "Source", "Target", []
        self.targets = Names()
        for option, default in bpy.context.scene.hiermatch_retarget.bl_rna.properties.items():
            if option.startswith("uv"):
                setattr(self, option, default.default)
        self._workspace = bpy.context.workspace.name
        self._timer = bpy.context.window_manager.event_timer_add(0.01, window=bpy.context.window)
        bpy.context.window_manager.hiermatch.cancel = False
        self._asks = True
        self._job = self._start(bpy.context)

    def report(self, kind, text):
        self.reports.append((*kind, text))

    def send(self, kind="TIMER", value="PRESS"):
        return self.modal(bpy.context, SimpleNamespace(type=kind, value=value, is_repeat=False))

    def until_asked(self):
        for _ in range(200):
            assert self.send() == {"PASS_THROUGH"}
            if bpy.context.window_manager.hiermatch.question:
                return


@pytest.fixture
def asking(doubtful):
    assert doubtful
    operator = Asking()
    operator.until_asked()
    return operator


def test_a_window_asks_and_waits(asking):
    progress = bpy.context.window_manager.hiermatch
    assert progress.question.startswith('The match with "Target" is doubtful. Confidence ')
    before = snapshot()
    for _ in range(5):
        assert asking.send() == {"PASS_THROUGH"}
    assert snapshot() == before
    asking.send("ESC")
    assert not progress.question


def test_write_anyway(asking, doubtful):
    assert bpy.ops.hiermatch.answer(answer="WRITE") == {"FINISHED"}
    answers = [asking.send()]
    while answers[-1] == {"PASS_THROUGH"}:
        answers.append(asking.send())
    assert answers[-1] == {"FINISHED"}
    assert "Layout" in doubtful[1].data.uv_layers
    assert asking.accept_doubtful
    assert not bpy.context.window_manager.hiermatch.question


@pytest.mark.parametrize("answer", ["CANCEL", "LANDMARKS"])
def test_other_answers_write_nothing(asking, answer):
    before = snapshot()
    bpy.ops.hiermatch.answer(answer=answer)
    assert asking.send() == {"CANCELLED"}
    assert snapshot() == before
    assert not bpy.context.window_manager.hiermatch.question


def test_without_a_question_there_is_no_answer():
    with pytest.raises(RuntimeError, match="Nothing is asked"):
        bpy.ops.hiermatch.answer(answer="WRITE")
