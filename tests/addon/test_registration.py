# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in Blender while the add-on is registered, and that nothing stays behind."""

from __future__ import annotations

import inspect
import weakref
from dataclasses import fields

import bpy
import pytest
from hiermatch.engine import MatchSettings
from hiermatch.hiermatch_addon import registration
from hiermatch.hiermatch_addon.jobs.job_operator import JobOperator
from hiermatch.hiermatch_addon.operators.steering.landmark_clicks import LandmarkClicks
from hiermatch.hiermatch_addon.overlay import drawing
from hiermatch.hiermatch_addon.properties import freshness
from hiermatch.hiermatch_addon.properties.properties import OPTION_NAMES, SETTING_NAMES, match_settings
from hiermatch.hiermatch_addon.registration import CLASSES

OPERATORS = [cls for cls in CLASSES if issubclass(cls, bpy.types.Operator)]


def rna_of(cls):
    """Blender's description of a class, as registered."""
    if issubclass(cls, bpy.types.Operator):
        group, name = cls.bl_idname.split(".")
        return getattr(getattr(bpy.ops, group), name).get_rna_type()
    return cls.bl_rna


def own_properties(cls):
    """The properties that the class itself declares."""
    annotations = {}
    for base in cls.__mro__:
        annotations |= inspect.get_annotations(base)
    rna = rna_of(cls).properties
    return {name: rna[name] for name in annotations if name in rna}


def our_handlers():
    """All functions of the add-on that Blender calls by itself."""
    lists = [getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers) if name.endswith(("_post", "_pre"))]
    return [function for found in lists for function in found if "hiermatch" in function.__module__]


def test_unregister_leaves_nothing_and_register_comes_back(extension):
    extension.unregister()
    try:
        assert not hasattr(bpy.types.Scene, "hiermatch")
        assert not hasattr(bpy.types.WindowManager, "hiermatch")
        assert not [name for name in dir(bpy.types) if name.startswith("HIERMATCH_")]
        assert not dir(bpy.ops.hiermatch)
        assert not our_handlers()
        assert not bpy.app.timers.is_registered(freshness._look)  # noqa: SLF001
    finally:
        extension.register()
    assert bpy.context.scene.hiermatch.points == MatchSettings().points
    assert len(our_handlers()) == 8
    assert {cls.bl_idname.split(".")[1] for cls in OPERATORS} == set(dir(bpy.ops.hiermatch))


def test_unregister_ends_what_runs_in_a_window(extension, monkeypatch):
    """Blender drops it without a word: the timer and the text in the status bar would stay."""
    ended = []

    class Working(JobOperator):
        def cancel(self, context):
            ended.append((self, context.window))

    class Waiting(LandmarkClicks):
        def cancel(self, context):
            ended.append((self, context.window))

    window = bpy.context.window_manager.windows[0]
    running = [(window, Working()), (window, Waiting()), (window, object())]
    monkeypatch.setattr(registration, "modal_operators", lambda _manager: running)
    extension.unregister()
    try:
        assert ended == [(operator, window) for window, operator in running[:2]]
    finally:
        extension.register()


def test_unregister_does_without_handlers_that_somebody_has_cleared(extension):
    for name in ("load_post", "depsgraph_update_post", "undo_post", "frame_change_post"):
        getattr(bpy.app.handlers, name).clear()
    extension.unregister()
    try:
        assert not hasattr(bpy.types.Scene, "hiermatch")
        assert not our_handlers()
    finally:
        extension.register()


@pytest.mark.parametrize(
    ("owner", "name", "broken"),
    [(registration, "CLASSES", (*CLASSES, object)), (bpy.utils, "register_cli_command", None)],
)
def test_what_cannot_be_registered_leaves_nothing(extension, monkeypatch, owner, name, broken):
    extension.unregister()
    try:
        with monkeypatch.context() as patched:
            patched.setattr(owner, name, broken)
            with pytest.raises((TypeError, RuntimeError)):
                extension.register()
        assert not hasattr(bpy.types.Scene, "hiermatch")
        assert not [found for found in dir(bpy.types) if found.startswith("HIERMATCH_")]
        assert not our_handlers()
    finally:
        extension.register()


def test_unregister_frees_what_the_overlay_has_drawn(extension):
    """Batches that are left when Blender ends are told of as memory that was not freed."""
    batch = type("Batch", (), {})()
    kept = weakref.ref(batch)
    drawing._overlay._lines = [(batch, 1.0)]  # noqa: SLF001
    drawing._overlay._previewed = (None, [(batch, batch, 1.0)])  # noqa: SLF001
    del batch
    extension.unregister()
    try:
        assert kept() is None
    finally:
        extension.register()


@pytest.mark.parametrize("owner", ["hiermatch.match", "scene"])
@pytest.mark.parametrize("setting", fields(MatchSettings), ids=lambda setting: setting.name)
def test_every_setting_is_mirrored(owner, setting):
    rna = bpy.context.scene.hiermatch.bl_rna if owner == "scene" else bpy.ops.hiermatch.match.get_rna_type()
    mirror = rna.properties[setting.name]
    assert mirror.name == setting.metadata["label"]
    assert mirror.description == setting.metadata["description"]
    if "choices" in setting.metadata:
        assert mirror.type == "ENUM"
        assert mirror.default == setting.default.upper()
        items = [(item.identifier.lower(), (item.name, item.description)) for item in mirror.enum_items]
        assert items == list(setting.metadata["choices"].items())
        assert all(item.identifier.isupper() for item in mirror.enum_items)
        return
    if isinstance(setting.default, bool):
        assert mirror.type == "BOOLEAN"
        assert mirror.default is setting.default
        return
    assert mirror.type == {int: "INT", float: "FLOAT"}[type(setting.default)]
    assert mirror.default == pytest.approx(setting.default)
    assert mirror.hard_min == pytest.approx(setting.metadata["minimum"])
    assert mirror.hard_max == pytest.approx(setting.metadata["maximum"])


def test_nothing_else_calls_itself_a_setting():
    assert set(SETTING_NAMES) == {setting.name for setting in fields(MatchSettings)}


def test_scene_and_operator_have_the_same_options():
    scene, match = bpy.context.scene.hiermatch.bl_rna, bpy.ops.hiermatch.match.get_rna_type()
    for name in OPTION_NAMES:
        one, other = scene.properties[name], match.properties[name]
        assert (one.type, one.name, one.description, one.default) == (
            other.type,
            other.name,
            other.description,
            other.default,
        )


def test_options_become_settings():
    state = bpy.context.scene.hiermatch
    assert match_settings(state) == MatchSettings()
    for setting in fields(MatchSettings):
        for word in setting.metadata.get("choices", ()):
            setattr(state, setting.name, word.upper())
            assert getattr(match_settings(state), setting.name) == word
            with pytest.raises(TypeError):  # not one of Blender's identifiers
                setattr(state, setting.name, word.lower())
    state.diffusion_time, state.points = 0.5, 33
    assert (match_settings(state).diffusion_time, match_settings(state).points) == (0.5, 33)


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_every_property_is_described(cls):
    for name, described in own_properties(cls).items():
        assert described.name, name
        assert len(described.description) > 10, name
        assert not described.description.endswith("."), f"{name}: Blender adds the full stop"


def test_properties_are_found_where_they_are():
    assert len(own_properties(next(cls for cls in CLASSES if cls.__name__ == "HIERMATCH_OT_match"))) > len(OPTION_NAMES)


@pytest.mark.parametrize("cls", OPERATORS, ids=lambda cls: cls.__name__)
def test_every_operator_is_described(cls):
    assert len(rna_of(cls).description) > 10
    assert not rna_of(cls).description.endswith(".")


def test_the_operators_can_be_undone():
    for name in ("match", "flip", "use_setup", "clear"):
        assert getattr(bpy.types, f"HIERMATCH_OT_{name}").bl_options == {"REGISTER", "UNDO"}


OF_ONE_RUN = {"source", "target", "targets", "object", "source_vertex", "target_vertex", "number"}
"""Options of operators that say which objects, vertices or rows are meant."""


def test_no_button_means_what_another_press_of_it_meant():
    """Blender fills in for a button what an operator had been given before, unless it is told not to."""
    kept, known = [], set()
    for cls in CLASSES:
        if issubclass(cls, bpy.types.Operator):
            group, name = cls.bl_idname.split(".")
            properties = getattr(getattr(bpy.ops, group), name).get_rna_type().properties
            known |= OF_ONE_RUN & set(properties.keys())
            kept += [
                (cls.__name__, option)
                for option in OF_ONE_RUN
                if option in properties and not properties[option].is_skip_save
            ]
    assert known == OF_ONE_RUN
    assert not kept
