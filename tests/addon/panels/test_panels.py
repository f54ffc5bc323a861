# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sidebar shows."""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace

import bpy
import pytest
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.operators.checking.rig_operator import meant_target
from hiermatch.hiermatch_addon.panels import answer_menu, retarget_panels
from hiermatch.hiermatch_addon.panels import match_panels as panels
from hiermatch.hiermatch_addon.properties.properties import OPTION_NAMES, SETTING_NAMES
from hiermatch.hiermatch_addon.properties.setting_groups import shown_groups
from hiermatch.hiermatch_addon.transfers.retarget_properties import remember_transfer, shown_report

from tests.addon.scenes import QUICK, add_blob, add_pair, snapshot

KINDS = ("weights", "shape_keys", "uvs", "attributes")
ELSEWHERE = {f"hiermatch.{name}" for name in ("swap", "clear", "add_demo_pair", "export_match", "import_match")}
"""Buttons of what is done at once."""


class Layout:
    """A layout that notes what is drawn into it."""

    def __init__(self, drawn):
        self.__dict__.update(drawn=drawn)

    def _part(self, *_arguments, **_names):
        return Layout(self.drawn)

    row = column = split = box = grid_flow = _part

    def panel(self, name, *, default_closed):
        self.drawn.append(("panel", name, default_closed))
        return self._part(), self._part()

    def label(self, *, text, **_names):
        self.drawn.append(("label", text))

    def prop(self, owner, name, **_names):
        assert name in owner.bl_rna.properties, name
        self.drawn.append(("prop", name))

    def prop_search(self, owner, name, *_arguments, **_names):
        self.prop(owner, name)

    def separator(self):
        pass

    def operator_menu_enum(self, name, prop, *, text, **_names):
        group, operator = name.split(".")
        assert prop in getattr(getattr(bpy.ops, group), operator).get_rna_type().properties
        self.drawn.append(("menu", name, text))

    def menu(self, name, *, text, **_names):
        assert hasattr(bpy.types, name)
        self.drawn.append(("menu", name, text))

    def progress(self, *, text, factor):
        self.drawn.append(("progress", text, factor))

    def operator(self, name, **names):
        group, operator = name.split(".")
        assert operator in dir(getattr(bpy.ops, group)), name
        self.drawn.append(("operator", name) if "depress" not in names else ("switch", name, names["depress"]))
        return self.__dict__.setdefault("properties", SimpleNamespace())


@pytest.fixture
def context():
    shading = SimpleNamespace(type="SOLID", color_type="MATERIAL", bl_rna=bpy.types.View3DShading.bl_rna)
    return SimpleNamespace(
        scene=bpy.context.scene,
        view_layer=bpy.context.view_layer,
        window_manager=bpy.context.window_manager,
        region=SimpleNamespace(width=280),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        space_data=SimpleNamespace(shading=shading),
    )


def tell(panel, source="Source", target="Target", **values):
    """Let a panel tell of a transfer."""
    remember_transfer(bpy.context, panel, (source, target), [])
    report = bpy.context.scene.hiermatch_retarget.reports[panel]
    for name, value in {"done": "Carried.", **values}.items():
        setattr(report, name, value)
    return report


def draw(context):
    drawn = []
    panel = SimpleNamespace(layout=Layout(drawn))
    panels.HIERMATCH_PT_match.draw(panel, context)
    return drawn


def texts(drawn):
    return " ".join(entry[1] for entry in drawn if entry[0] == "label")


SPECTRAL = {"eigenfunctions": ("EIGENFUNCTIONS",), "eigenpairs": ("HEAT_KERNEL", "WAVE_KERNEL", "EIGENFUNCTIONS")}


def shown_settings(context):
    return [entry[1] for entry in draw(context) if entry[0] == "prop" and entry[1] in SETTING_NAMES]


def test_everything_that_can_be_set_is_there_once(context):
    state, seen = context.scene.hiermatch, set()
    choices = [("metric", ("GEODESIC", "DIFFUSION")), ("descriptor", ("HISTOGRAM", "EIGENFUNCTIONS"))]
    for values in product(*(values for _, values in choices)):
        for (name, _), value in zip(choices, values, strict=True):
            setattr(state, name, value)
        props = [entry[1] for entry in draw(context) if entry[0] == "prop"]
        assert len(props) == len(set(props))
        seen.update(props)
    assert seen >= {"source", "target", *OPTION_NAMES}


def test_all_settings_but_two_are_tucked_away(context):
    drawn = draw(context)
    advanced = drawn.index(("panel", "hiermatch_advanced", True))
    for name in shown_settings(context):
        assert (drawn.index(("prop", name)) > advanced) == (name not in ("points", "dense"))


def test_only_settings_that_matter_are_shown(context):
    state = context.scene.hiermatch
    always = {"points", "metric", "descriptor", "coarse_points", "samples", "neighbourhood", "linear_weight"}
    metrics = [item.identifier for item in state.bl_rna.properties["metric"].enum_items]
    descriptors = [item.identifier for item in state.bl_rna.properties["descriptor"].enum_items]
    for state.metric, state.descriptor in product(metrics, descriptors):
        shown = set(shown_settings(context))
        assert shown >= always
        diffusion, descriptor = state.metric == "DIFFUSION", state.descriptor
        assert ("diffusion_time" in shown) == diffusion
        assert {"comparison", "histogram_bins"} <= shown or descriptor in ("HEAT_KERNEL", "WAVE_KERNEL")
        assert not {"comparison", "histogram_bins"} & shown or descriptor in ("HISTOGRAM", "EIGENFUNCTIONS")
        assert ("eigenfunctions" in shown) == (descriptor in SPECTRAL["eigenfunctions"])
        assert ("eigenpairs" in shown) == (diffusion or descriptor in SPECTRAL["eigenpairs"])


def test_a_new_setting_is_shown_without_further_ado(context, monkeypatch):
    monkeypatch.setattr(
        "hiermatch.hiermatch_addon.properties.setting_groups.SETTING_NAMES", (*SETTING_NAMES, "alternative")
    )
    assert shown_groups(context.scene.hiermatch)[0][1][-1] == "alternative"


def test_the_groups_have_headings(context):
    shown = texts(draw(context))
    for title in ("Metric and Descriptor", "Coarse Match", "Refinement"):
        assert title in shown


def test_the_setup_is_named(context):
    state = context.scene.hiermatch
    assert ("menu", "hiermatch.use_setup", "Geodesic Histograms") in draw(context)
    state.metric, state.descriptor = "DIFFUSION", "HEAT_KERNEL"
    assert ("menu", "hiermatch.use_setup", "Heat Kernel Signatures") in draw(context)
    state.descriptor = "WAVE_KERNEL"
    assert ("menu", "hiermatch.use_setup", "Custom") in draw(context)


def test_all_buttons_are_there(context):
    operators = [entry[1] for entry in draw(context) if entry[0] == "operator"]
    assert operators == [
        "hiermatch.swap",
        "hiermatch.add_demo_pair",  # as long as there is nothing to match
        "hiermatch.match",
        "hiermatch.clear",
        "hiermatch.add_demo_pair",
        "hiermatch.export_match",
        "hiermatch.import_match",
    ]


def test_the_button_carries_the_options_of_the_scene(context, monkeypatch):
    carried = SimpleNamespace()
    monkeypatch.setattr(Layout, "operator", lambda *_arguments, **_names: carried)
    context.scene.hiermatch.points = 33
    context.scene.hiermatch.prefix = "Mine"
    draw(context)
    assert {name: getattr(carried, name) for name in OPTION_NAMES} == {
        name: getattr(context.scene.hiermatch, name) for name in OPTION_NAMES
    }
    assert (carried.points, carried.prefix) == (33, "Mine")


def test_it_says_what_to_do_until_there_are_two_meshes(context):
    assert "Pick two meshes" in texts(draw(context))
    pair = add_pair()
    assert "Pick two meshes" in texts(draw(context))
    for obj in pair:
        obj.select_set(state=True)
    assert "Pick two meshes" not in texts(draw(context))
    bpy.ops.object.select_all(action="DESELECT")
    for _ in pair:
        empty = bpy.data.objects.new("Above", None)
        bpy.context.collection.objects.link(empty)
        empty.select_set(state=True)
    assert "Pick two meshes" not in texts(draw(context))
    bpy.ops.object.select_all(action="DESELECT")
    state = context.scene.hiermatch
    state.source = pair[0]
    for chosen, lacking in ((pair[:1], True), (pair[1:], False), (pair, False)):
        bpy.ops.object.select_all(action="DESELECT")
        for obj in chosen:
            obj.select_set(state=True)
        assert ("Pick two meshes" in texts(draw(context))) == lacking
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(rig)
    pair[0].parent = state.source = rig
    bpy.ops.object.select_all(action="DESELECT")
    pair[0].select_set(state=True)
    assert "Pick two meshes" in texts(draw(context))  # it is a part of what is picked
    bpy.ops.object.select_all(action="DESELECT")
    state.source, state.target = pair
    assert "Pick two meshes" not in texts(draw(context))


def test_while_a_match_runs_there_are_a_bar_and_a_way_out(context):
    running = SimpleNamespace(bl_idname="HIERMATCH_OT_match", panel="HIERMATCH_PT_match")
    progress = SimpleNamespace(fraction=0.4, label="Measuring", question="")
    context.window_manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[running])], hiermatch=progress)
    drawn = draw(context)
    assert ("progress", "Measuring", 0.4) in drawn
    assert ("operator", "hiermatch.cancel") in drawn
    assert ("operator", "hiermatch.match") not in drawn


def test_while_something_else_runs_the_bar_is_where_it_was_started(context):
    running = SimpleNamespace(bl_idname="HIERMATCH_OT_retarget", panel="HIERMATCH_PT_retarget")
    progress = SimpleNamespace(fraction=0.4, label="Measuring", question="")
    context.window_manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[running])], hiermatch=progress)
    drawn = draw(context)
    assert not [entry for entry in drawn if entry[0] == "progress" or entry == ("operator", "hiermatch.cancel")]
    assert "HierMatch is at work" in texts(drawn)
    assert ("operator", "hiermatch.match") in drawn


def test_a_button_that_starts_a_job_is_its_name_while_one_runs(context):
    """Else Blender draws it as disabled afterwards, as long as the mouse stays on it."""
    context.scene.hiermatch.summary.points, context.scene.hiermatch.summary.answers = 5, "direct\nmirrored"

    def starters():
        drawn = draw(context)
        retarget_panels.HIERMATCH_PT_retarget.draw(
            SimpleNamespace(layout=Layout(drawn), bl_idname="HIERMATCH_PT_retarget"), context
        )
        return {name for kind, name, *_ in drawn if kind in ("operator", "switch")} - ELSEWHERE

    jobs = {"fit_rig", "fit_my_rig", "flip", "retarget", "wrap", *(f"transfer_{kind}" for kind in KINDS)}
    assert starters() == {f"hiermatch.{job}" for job in (*jobs, "match")}
    running = SimpleNamespace(bl_idname="HIERMATCH_OT_flip", panel="HIERMATCH_PT_match")
    progress = SimpleNamespace(fraction=0.4, label="Measuring", question="")
    context.window_manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[running])], hiermatch=progress)
    assert starters() == {"hiermatch.retarget", "hiermatch.cancel"}


@pytest.mark.parametrize("name", ["HIERMATCH_OT_pick_landmarks", "HIERMATCH_OT_export_match"])
def test_what_waits_for_clicks_or_a_name_is_no_work(context, name):
    waiting = SimpleNamespace(bl_idname=name)
    context.window_manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[waiting])])
    drawn = draw(context)
    assert ("operator", "hiermatch.match") in drawn
    assert "HierMatch is at work" not in texts(drawn)


def test_the_last_result(context):
    add_pair()
    assert "matched" not in texts(draw(context))
    bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK)
    shown = texts(draw(context))
    assert "12 points matched" in shown
    assert "Source Source Target Target" in shown
    assert "Search finished" in shown
    assert "kept" in shown
    assert "Worst Point" in shown


def test_what_is_not_proven_and_what_is_mirrored(context):
    summary = context.scene.hiermatch.summary
    summary.points, summary.proven, summary.gap, summary.orientation = 5, False, 0.25, -0.8
    summary.notes = "The source has two parts.\nMind the gap."
    drawn = draw(context)
    shown = texts(drawn)
    assert ("panel", "hiermatch_notes", True) in drawn
    assert "2 notes" in shown
    assert "Search ended early, at most 25% from the best" in shown
    assert "Left and Right exchanged" in shown
    assert "The source has two parts." in shown
    assert "Mind the gap." in shown


@pytest.mark.parametrize("mirrored", [False, True])
def test_the_switch_between_two_answers(context, mirrored):
    summary = context.scene.hiermatch.summary
    summary.points, summary.answers, summary.answer = 5, "direct\nmirrored", int(mirrored)
    drawn = draw(context)
    assert ("switch", "hiermatch.flip", mirrored) in drawn
    assert "Other Answers" not in texts(drawn)
    summary.answers, summary.answer = "direct", 0
    drawn = draw(context)
    assert not [entry for entry in drawn if entry[0] == "switch"]
    assert "Other Answers none" in texts(drawn)


def test_the_menu_of_several_answers(context):
    summary = context.scene.hiermatch.summary
    summary.points, summary.answers, summary.answer = 5, "direct\nmirrored\nturned 1", 2
    drawn = draw(context)
    assert ("menu", "HIERMATCH_MT_answers", "Turned 1") in drawn
    assert not [entry for entry in drawn if entry[0] == "switch"]
    rows = []
    answer_menu.HIERMATCH_MT_answers.draw(SimpleNamespace(layout=Layout(rows)), context)
    assert [entry for entry in rows if entry[0] == "operator"] == 3 * [("operator", "hiermatch.flip")]


def test_how_far_the_dense_map_can_be_trusted(context):
    summary = context.scene.hiermatch.summary
    summary.points = 5
    assert "Confidence" not in texts(draw(context))
    summary.verdict, summary.confidence, summary.stretch = "The map can be trusted.", 0.874, 0.123
    shown = texts(draw(context))
    assert "The map can be trusted." in shown
    assert "Confidence 87%, good" in shown
    assert "Distortion 12%, some" in shown
    assert "Worst Point" not in shown


@pytest.mark.parametrize("confidence", [0.04, 0.29, 0.3, 0.9])
def test_a_worthless_match_has_no_check_mark_but_a_way_on(context, monkeypatch, confidence):
    icons = []
    monkeypatch.setattr(Layout, "label", lambda _self, *, text, icon="", **_names: icons.append((text, icon)))
    summary = context.scene.hiermatch.summary
    summary.points, summary.verdict, summary.confidence = 5, "So it is.", confidence
    drawn = draw(context)
    doubtful = confidence < 0.3
    assert (("So it is.", "CHECKMARK") in icons) == (not doubtful)
    assert (("So it is.", "ERROR") in icons) == doubtful
    assert (("operator", "hiermatch.guide_me") in drawn) == doubtful


def test_the_button_and_the_result_come_before_all_that_unfolds(context):
    context.scene.hiermatch.summary.points = 5
    kinds = [(kind, name) for kind, name, *_ in draw(context)]
    first = kinds.index(("panel", "hiermatch_details"))
    assert {("prop", "source"), ("prop", "target"), ("operator", "hiermatch.match")} <= set(kinds[:first])
    drawn = []
    panel = SimpleNamespace(layout=Layout(drawn), bl_idname="HIERMATCH_PT_retarget")
    retarget_panels.HIERMATCH_PT_retarget.draw(panel, context)
    assert drawn[0] == ("operator", "hiermatch.retarget")
    assert all(closed for kind, _, *closed in [*draw(context), *drawn] if kind == "panel")


def test_the_way_to_see_for_oneself_is_not_below_what_is_to_be_checked(context):
    add_pair()
    said = {"verdict": "Confidence 83%: so it is.", "notes": "Check this.\nCheck that."}
    tell("HIERMATCH_PT_retarget", **said)
    drawn = []
    panel = SimpleNamespace(layout=Layout(drawn), bl_idname="HIERMATCH_PT_retarget")
    retarget_panels.HIERMATCH_PT_retarget.draw(panel, context)
    poses = drawn.index(("switch", "hiermatch.test_poses", False))
    assert drawn.index(("label", "Confidence 83%: so it is.")) < poses < drawn.index(("label", "Check this."))
    assert ("label", "Check that.") in drawn


@pytest.mark.parametrize("name", ["Target", "Target + Source"])
def test_the_buttons_below_a_report_mean_what_is_picked_if_its_target_has_another_name_now(context, monkeypatch, name):
    buttons = {}

    def operator(_self, name, **_names):
        return buttons.setdefault(name, SimpleNamespace())

    def drawn():
        buttons.clear()
        retarget_panels.draw_report(Layout([]), context, "HIERMATCH_PT_retarget", has_before=True)
        return {buttons[f"hiermatch.{name}"].target for name in ("test_poses", "before_after")}

    target = add_pair()[1]
    report = tell("HIERMATCH_PT_retarget", target="Target")
    report.target = name
    monkeypatch.setattr(Layout, "operator", operator)
    assert drawn() == {name}
    context.scene.hiermatch.target = target
    target.name = "Other"
    assert drawn() == {""}
    assert meant_target(bpy.context, "") == target
    context.scene.hiermatch.target = None
    with pytest.raises(ObjectError, match="It is open which character is meant"):
        meant_target(bpy.context, "")


PANELS = ("HIERMATCH_PT_retarget", "HIERMATCH_PT_motion", "HIERMATCH_PT_wear")


class TestReports:
    """A report is shown in the panel of its work, while its objects are there and are the ones that are picked."""

    def test_each_panel_has_its_own(self, context):
        add_pair()
        tell(PANELS[2], done="2 items")
        assert [shown_report(context, panel) is not None for panel in PANELS] == [False, False, True]
        tell(PANELS[0], done="A rig")
        found = [shown_report(context, panel) for panel in PANELS]
        assert [one and one.done for one in found] == ["A rig", None, "2 items"]

    def test_while_others_are_picked_it_is_not_shown(self, context):
        (source, target), other, state = add_pair(), add_blob("Other"), context.scene.hiermatch
        tell(PANELS[0])
        for picks, is_shown in (
            ((source, target), True),
            ((None, target), True),
            ((source, None), True),
            ((source, other), False),
            ((other, target), False),
            ((other, None), False),
        ):
            state.source, state.target = picks
            assert (shown_report(context, PANELS[0]) is not None) == is_shown, picks

    def test_a_character_may_be_picked_by_its_armature_or_a_collection(self, context):
        target, state = add_pair()[1], context.scene.hiermatch
        tell(PANELS[0])
        rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
        held, other = bpy.data.collections.new("Held"), bpy.data.collections.new("Other")
        for collection in (held, other):
            context.scene.collection.children.link(collection)
        held.objects.link(rig)
        held.objects.link(target)
        state.target = rig
        assert shown_report(context, PANELS[0]) is None
        target.parent = rig
        assert shown_report(context, PANELS[0]) is not None
        state.target, state.target_collection = None, other
        assert shown_report(context, PANELS[0]) is None
        state.target_collection = held
        assert shown_report(context, PANELS[0]) is not None

    def test_it_ends_with_its_target_but_not_with_its_source(self, context):
        source, target = add_pair()
        tell(PANELS[0])
        bpy.data.objects.remove(source)
        assert shown_report(context, PANELS[0]) is not None
        context.scene.hiermatch.target = target  # which keeps it in the file
        target.users_collection[0].objects.unlink(target)
        bpy.context.view_layer.update()
        assert shown_report(context, PANELS[0]) is None
        context.scene.hiermatch.target = None
        target.name = "Gone"
        add_blob("Target")
        assert shown_report(context, PANELS[0]) is None

    def test_in_another_session_it_goes_by_names(self, context):
        target = add_pair()[1]
        report = tell(PANELS[0])
        report.session, report.target_uid, report.source_uid = report.session + 1, 1, 1
        context.scene.hiermatch.target = target
        assert shown_report(context, PANELS[0]) is not None
        target.name = "Other"
        assert shown_report(context, PANELS[0]) is None

    def test_it_is_there_again_when_its_file_is_opened_again(self, tmp_path):
        state = bpy.context.scene.hiermatch
        state.source, state.target = add_pair()
        tell(PANELS[0])
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "told.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "told.blend"))
        state = bpy.context.scene.hiermatch
        assert state.target.name == "Target"
        assert shown_report(bpy.context, PANELS[0]) is not None
        bpy.data.objects["Target"].name = "Other"
        assert shown_report(bpy.context, PANELS[0]) is None


def test_a_match_that_is_out_of_date(context):
    summary = context.scene.hiermatch.summary
    summary.points, summary.stale = 5, 'The match is out of date: "Cat" was edited since.'
    assert "The match is out of date" in texts(draw(context))
    summary.points = 0
    assert "The match is out of date" not in texts(draw(context))


def test_nothing_is_told_of_the_match_of_others_and_no_number_of_one_that_is_lost(context):
    summary = context.scene.hiermatch.summary
    summary.points, summary.verdict, summary.confidence, summary.answers = 5, "So it is.", 0.9, "direct\nmirrored"
    assert {"So it is.", "90%, good"} <= {entry[1] for entry in draw(context) if entry[0] == "label"}
    assert ("switch", "hiermatch.flip", False) in draw(context)
    summary.lost, summary.stale = True, 'The match is out of date: "Cat" was deleted.'
    drawn = draw(context)
    assert "was deleted" in texts(drawn)
    assert "So it is." not in texts(drawn)
    assert "90%" not in texts(drawn)
    assert not [entry for entry in drawn if entry[0] == "switch"]
    summary.lost, summary.hidden = False, True
    drawn = draw(context)
    assert "was deleted" not in texts(drawn)
    assert not [entry for entry in drawn if entry[0] == "switch" or entry[1] in ("So it is.", "hiermatch_details")]


def test_the_names_stand_above_the_verdict_as_long_as_no_pair_is_picked(context):
    state = context.scene.hiermatch
    state.source, state.target = add_pair()
    bpy.ops.hiermatch.match(**QUICK)

    def box():
        drawn = draw(context)
        return drawn[drawn.index(("operator", "hiermatch.match")) : drawn.index(("panel", "hiermatch_details", True))]

    assert ("label", "Target") not in box()
    state.source = state.target = None
    assert box().count(("label", "Target")) == 2  # what it is, and what it is called


def test_no_time_is_shown_if_none_is_known(context):
    summary = context.scene.hiermatch.summary
    summary.points, summary.seconds = 5, 0.0
    assert "Time" not in texts(draw(context))
    summary.seconds = 1.24
    assert "Time 1.2 s" in texts(draw(context))


def test_a_script_s_pair_stands_in_the_pickers(context):
    """Unless the user has picked others."""
    state = context.scene.hiermatch
    pair = add_pair()
    bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK)
    assert (state.source, state.target) == pair
    bpy.ops.hiermatch.match(source="Target", target="Source", **QUICK)
    assert (state.source, state.target) == pair[::-1]
    state.source, state.target = pair[0], None
    bpy.ops.hiermatch.match(source="Target", target="Source", **QUICK)
    assert (state.source, state.target) == (pair[0], None)


def test_drawing_changes_nothing(context):
    add_pair()
    bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK)
    before = snapshot()
    draw(context)
    assert snapshot() == before


def test_long_names_of_numbers_stand_inside_their_fields(context, monkeypatch):
    """A usual sidebar has no room for them beside the fields."""
    split = {}
    monkeypatch.setattr(
        Layout, "prop", lambda self, _owner, name, **_names: split.update({name: self.use_property_split})
    )
    monkeypatch.setattr(Layout, "use_property_split", True, raising=False)
    draw(context)
    assert not split["coarse_candidates"]
    assert split["metric"]
    assert split["settle"]


def test_labels_of_what_is_carried_fit_beside_their_values():
    """At the sidebar's default width: 90 pixels beside a value, 130 beside a check mark, about six for a letter."""
    for prop in type(bpy.context.scene.hiermatch_retarget).bl_rna.properties:
        if prop.type not in ("POINTER", "COLLECTION"):
            assert len(prop.name) <= (20 if prop.type == "BOOLEAN" else 14), prop.name
