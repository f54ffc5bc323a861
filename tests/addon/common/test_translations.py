# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface in other languages: nothing is missing, nothing is left over."""

from __future__ import annotations

import ast
import inspect
import re
from dataclasses import fields
from functools import cache
from string import Formatter
from types import SimpleNamespace

import bpy
import pytest
from hiermatch.engine.repair.cleaning_notes import CleaningCounts, cleaning_notes
from hiermatch.hiermatch_addon.common import translated_text, translations
from hiermatch.hiermatch_addon.common.phrases import counted
from hiermatch.hiermatch_addon.common.translated_text import translated
from hiermatch.hiermatch_addon.common.translations import CONTEXT, LANGUAGES
from hiermatch.hiermatch_addon.panels.panel_text import wrap_text
from hiermatch.hiermatch_addon.registration import CLASSES
from hiermatch.hiermatch_addon.transfers.options.attributes import AttributeOptions
from hiermatch.hiermatch_addon.transfers.options.motion import MotionOptions
from hiermatch.hiermatch_addon.transfers.options.my_rig import MyRigOptions
from hiermatch.hiermatch_addon.transfers.options.rig import RigOptions
from hiermatch.hiermatch_addon.transfers.options.shape_keys import ShapeKeyOptions
from hiermatch.hiermatch_addon.transfers.options.symmetrise import SymmetriseOptions
from hiermatch.hiermatch_addon.transfers.options.uvs import UVOptions
from hiermatch.hiermatch_addon.transfers.options.wear import WearOptions
from hiermatch.hiermatch_addon.transfers.options.weights import WeightOptions
from hiermatch.hiermatch_addon.transfers.options.wrap import WrapOptions

from tools.source_extension import ROOT

READS_CODE_ONLY = True
"""See `conftest.empty_file`: it takes longer than the tests."""

ADDON = [path for path in sorted((ROOT / "hiermatch_addon").rglob("*.py")) if path.parent.name != "translations"]
INTERFACE = [path for path in ADDON if "command_line" not in path.parts]
ENGINE = sorted((ROOT / "engine").rglob("*.py"))
NAMES = {"HierMatch", "VRM", "Mixamo", "Unreal", "Rigify"}
SENTENCES = {
    "DoubtfulMatchError",
    "NothingToCarryError",
    "ObjectError",
    "SharedMeshError",
    "report",
    "Progress",
    "translated",
    "poll_message_set",
}


def literals(node):
    """Strings that an expression may be as it stands in the code, with numbers in the places of what is filled in."""
    if isinstance(node, ast.Constant):
        return [node.value] if isinstance(node.value, str) else []
    if isinstance(node, ast.JoinedStr):
        return [with_gaps(node)]
    if isinstance(node, ast.IfExp):
        return literals(node.body) + literals(node.orelse)
    return []


def with_gaps(node):
    """The pattern of a sentence that is put together; nothing if there are no words in it."""
    text, numbers = "", iter(range(99))
    for part in node.values:
        text += part.value if isinstance(part, ast.Constant) else f"{{{next(numbers)}}}"
    return text if re.search("[A-Za-z]{3}", text) else ""


def rna_of(cls):
    if issubclass(cls, bpy.types.Operator):
        group, name = cls.bl_idname.split(".")
        return getattr(getattr(bpy.ops, group), name).get_rna_type()
    return cls.bl_rna


def shown_by_classes():
    """Labels and tooltips of what is registered, each with where it is."""
    for cls in CLASSES:
        rna = rna_of(cls)
        if issubclass(cls, bpy.types.Operator):
            yield from ((text, cls.__name__) for text in (rna.name, rna.description))
        if issubclass(cls, bpy.types.Panel):
            yield from ((getattr(cls, name, ""), cls.__name__) for name in ("bl_label", "bl_category"))
        ours = [base for base in cls.__mro__ if not base.__module__.startswith(("bpy", "bl_"))]
        for name in {name for base in ours for name in inspect.get_annotations(base)} & set(rna.properties.keys()):
            described = rna.properties[name]
            yield from ((text, f"{cls.__name__}.{name}") for text in (described.name, described.description))
            for item in getattr(described, "enum_items", ()):
                yield from ((text, f"{cls.__name__}.{name}") for text in (item.name, item.description))


def shown_by_panels():
    """Texts in the code that draws: they start with a capital; names of icons and identifiers do not go on small."""
    for path in (path for path in INTERFACE if path.name.endswith("panels.py") or path.name == "setting_groups.py"):
        tree = ast.parse(path.read_text("utf8"))
        documented = (ast.Module, ast.ClassDef, ast.FunctionDef)
        documents = {ast.get_docstring(node, clean=False) for node in ast.walk(tree) if isinstance(node, documented)}
        documents |= {node.value.value for node in ast.walk(tree) if _is_text(node)}
        parts = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
        parts |= {id(node.args[0]) for node in ast.walk(tree) if _is_cast(node)}
        for node in ast.walk(tree):
            for text in literals(node) if id(node) not in parts else []:
                if re.match("[A-Z][a-z]", text) and text not in documents:
                    yield text, path.name


def _is_text(node):
    """Whether this is the description that follows a constant."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _is_cast(node):
    """Whether this names a type."""
    return isinstance(node, ast.Call) and getattr(node.func, "id", "") == "cast"


def fixed_sentences():
    """Reports, errors, and what a bar of progress says.

    Of the engine's errors those are left out that only a program can cause, and that no table has.
    """
    for path in (*INTERFACE, *ENGINE):
        for node in ast.walk(ast.parse(path.read_text("utf8"))):
            if isinstance(node, ast.Call):
                called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
                arguments = node.args if called in SENTENCES else []
                if called == "within":  # what a bar of progress says of a part
                    arguments = [*node.args[3:], *(named.value for named in node.keywords if named.arg == "label")]
                yield from ((text, path.name) for argument in arguments for text in literals(argument))
                if called == "append" and "notes" in ast.unparse(node.func):
                    yield from ((text, path.name) for text in literals(node.args[0]))
            elif isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") in ("cancelled", "doing"):
                yield from ((text, path.name) for text in literals(node.value))


def preset_names():
    """The built-in presets, as the menu shows them."""
    folder = ROOT / "hiermatch_addon" / "presets" / "hiermatch"
    return [(bpy.path.display_name(path.name, title_case=False), path.name) for path in folder.glob("*.py")]


@cache
def needed():
    """All texts to be translated, each with where it is."""
    found = {}
    for text, where in (*shown_by_classes(), *shown_by_panels(), *preset_names(), *fixed_sentences()):
        if any(letter.isalpha() for letter in text) and text not in NAMES:
            found.setdefault(text, where)
    return found


@cache
def written():
    """All strings in the code."""
    trees = [ast.parse(path.read_text("utf8")) for path in (*ADDON, *ENGINE)]
    return {text for tree in trees for node in ast.walk(tree) for text in literals(node)}


@pytest.fixture(params=LANGUAGES)
def messages(request):
    return LANGUAGES[request.param]


def test_what_is_shown_is_found():
    texts = needed()
    assert {"Match", "Retarget", "Points", "Of Source", "Earth Mover's", "Metric and Descriptor"} <= set(texts)
    assert {
        "Simplifying the mesh",
        "Two mesh objects are needed in this view layer",
        "{count} points matched",
        "Fast Preview",
    } <= set(texts)
    assert not {"HIERMATCH_PT_match", "ERROR", "UI", "hiermatch.match"} & set(texts)


def test_nothing_is_missing(messages):
    missing = [f"{text!r} ({where})" for text, where in needed().items() if text not in messages]
    assert not missing, "To be added to hiermatch_addon/common/translations:\n" + "\n".join(missing)


def test_nothing_is_left_over(messages):
    unknown = sorted(set(messages) - set(needed()) - written())
    assert not unknown, "Not in the code any more:\n" + "\n".join(unknown)


def test_nothing_is_empty_or_left_in_english(messages):
    bad = [text for text, said in messages.items() if not said.strip() or (said == text and text not in NAMES)]
    assert not bad
    assert not [said for said in messages.values() if said != said.strip()]


def test_each_language_is_written_in_its_own_letters(messages):
    latin = [said for said in messages.values() if not re.search("[\u3040-\u30ff\u4e00-\u9fff]", said)]
    assert not latin


def test_the_languages_translate_the_same():
    first, *others = LANGUAGES.values()
    for other in others:
        assert list(other) == list(first)


def test_sentences_end_as_in_english(messages):
    """Blender adds the full stop of a tooltip itself."""
    assert not [text for text, said in messages.items() if text.endswith(".") != said.endswith("。")]


@pytest.mark.parametrize("language", sorted(LANGUAGES))
def test_labels_beside_their_fields_are_not_cut_off(language):
    """In a sidebar of 300 pixels there is room for eight ideographs; two columns of Latin letters count as one."""
    kinds = [RigOptions, WeightOptions, ShapeKeyOptions, UVOptions, AttributeOptions, MyRigOptions]
    groups = [*kinds, WrapOptions, WearOptions, MotionOptions, SymmetriseOptions]
    names = {one.keywords["name"] for group in groups for one in group.__annotations__.values() if is_beside(one)}
    assert "Same Rest Pose" in names
    said = {name: LANGUAGES[language][name] for name in names}
    assert {name: text for name, text in said.items() if columns(text) > 16} == {}


def is_beside(definition):
    """Tell whether the label of a property stands to the left of its field."""
    return definition.function.__name__ != "BoolProperty" and "HIDDEN" not in definition.keywords.get("options", ())


def columns(text):
    return sum(1 if letter.isascii() else 2 for letter in text)


def test_all_names_are_translated_in_our_context():
    """Where Blender's own catalog has a word, it would come first in every other one."""
    for cls in CLASSES:
        rna = rna_of(cls)
        if issubclass(cls, (bpy.types.Operator, bpy.types.Panel, bpy.types.Menu)):
            assert rna.translation_context == CONTEXT, cls
        ours = [base for base in cls.__mro__ if not base.__module__.startswith(("bpy", "bl_"))]
        names = {name for base in ours for name in inspect.get_annotations(base)}
        for name in names & set(rna.properties.keys()):
            assert rna.properties[name].translation_context == CONTEXT, (cls, name)
    labels = [
        (path.name, ast.unparse(node))
        for path in INTERFACE
        for node in ast.walk(ast.parse(path.read_text("utf8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "label"
    ]
    assert len(labels) > 10
    assert not [found for found in labels if "translate=False" not in found[1]]


def test_what_is_filled_in_is_kept(messages):
    for text, said in messages.items():
        fields = [{name for _, name, _, _ in Formatter().parse(each) if name} for each in (text, said)]
        assert fields[0] == fields[1], text


def test_registering_hands_over_all_and_unregistering_takes_it_back(monkeypatch):
    known = {}
    blender = SimpleNamespace(register=known.__setitem__, unregister=known.__delitem__)
    monkeypatch.setattr(translations, "bpy", SimpleNamespace(app=SimpleNamespace(translations=blender)))
    translations.register_translations()
    (package, tables) = next(iter(known.items()))
    assert package == "hiermatch"
    assert set(tables) == {"ja_JP", "zh_HANS"}
    assert tables["ja_JP"]["*", "Retarget"] == tables["ja_JP"]["Operator", "Retarget"] == "リターゲット"
    assert tables["zh_HANS"]["*", "Dense Map"] == "稠密映射"
    translations.unregister_translations()
    assert not known


@pytest.mark.skipif(not bpy.app.build_options.international, reason="this Blender was built without translations")
@pytest.mark.parametrize("language", LANGUAGES)
def test_blender_speaks_it(language):
    view = bpy.context.preferences.view
    before = view.language, view.use_translate_interface
    try:
        view.language, view.use_translate_interface = language, True
        for text in ("Dense Map", "Coarse Candidates", "Fit Rig"):
            assert bpy.app.translations.pgettext_iface(text) == LANGUAGES[language][text]
    finally:
        view.language, view.use_translate_interface = before


def test_english_is_broken_at_spaces():
    assert wrap_text("The shapes correspond closely.", 16) == ["The shapes", "correspond", "closely."]


def test_japanese_and_chinese_are_broken_anywhere(messages):
    for said in (said for said in messages.values() if "{" not in said):
        lines = wrap_text(said, 20)
        assert "".join(lines).replace(" ", "") == said.replace(" ", "")
        assert all(len(line) <= 11 for line in lines if not re.search("[A-Za-z0-9.]", line))
        assert not [line for line in lines[1:] if line[0] in "、。，：；」"]


def test_latin_words_stay_whole():
    assert wrap_text("HierMatchが作業中です", 10) == ["HierMatch", "が作業中で", "す"]


class TestSentencesWithGaps:
    """Sentences that were put together, in a Blender that speaks Japanese."""

    @pytest.fixture(autouse=True)
    def japanese(self, monkeypatch):
        messages = LANGUAGES["ja_JP"]
        blender = SimpleNamespace(locale="ja_JP", pgettext_iface=lambda text, _context="": messages.get(text, text))
        monkeypatch.setattr(translated_text, "bpy", SimpleNamespace(app=SimpleNamespace(translations=blender)))

    def test_what_is_filled_in_is_kept(self):
        said = translated(
            '"Cat" has 12 vertices, too few for 64 Points. Set Points to 12 or fewer, or subdivide the mesh.'
        )
        assert said.startswith("「Cat」の頂点は12個で、ポイント64個には")

    def test_order_may_differ(self):
        said = translated('Matched 64 points of "A" and "B" in 3.2 s. The shapes correspond closely.')
        assert said.index("「A」") < said.index("64") < said.index("3.2")
        assert said.endswith(LANGUAGES["ja_JP"]["The shapes correspond closely."])

    def test_names_are_not_translated_and_words_are(self):
        said = translated(
            'The source of this match, "source", was deleted, or renamed and cleared, or is not in the view layer '
            '"Points". Bring it back, or match again.'
        )
        assert "ソース「source」" in said
        assert "「Points」" in said

    def test_the_pattern_that_says_most_counts(self):
        said = translated('"Cat" cannot be read: it is empty. Choose another file.')
        assert said == "「Cat」を読み込めません：it is empty。別のファイルを選んでください。"

    def test_parts_of_a_list_are_translated_if_all_are_known(self):
        said = translated('Carried to "Walking Cat": the rig "Rig" with 24 bones, 24 vertex groups, 1 shape key')
        assert (
            said == "「Walking Cat」に引き継ぎました：リグ「Rig」（ボーン24本）、24個の頂点グループ、1個のシェイプキー"
        )
        assert translated("24 bones, some of them small") == "24 bones, some of them small"

    def test_one_thing_and_several_things_are_counted(self):
        assert translated(f"Removed {counted(1, 'landmark')}") == "1個のランドマークを削除しました"
        said = translated(f"Added {counted(2, 'landmark')} on the other side")
        assert said == "反対側に2個のランドマークを追加しました"

    def test_everything_that_cleaning_tells_is_translated(self):
        for fault in fields(CleaningCounts):
            for count in (1, 2000):
                (note,) = cleaning_notes("source", CleaningCounts(**{fault.name: count}))
                said = translated(note)
                assert said.startswith("ソース")
                assert not re.search("[A-Za-z]", said)

    @pytest.mark.parametrize("text", ["Nobody has translated this.", "", '"Cat" sat on the mat.'])
    def test_what_is_unknown_stays(self, text):
        assert translated(text) == text

    def test_every_pattern_finds_itself(self):
        for template, _ in translated_text._patterns():  # noqa: SLF001
            fields = {name: f"<{name}>" for _, name, _, _ in Formatter().parse(template) if name}
            text = re.sub(r"\{(\w+)\}", lambda field: fields[field[1]], template)  # noqa: B023
            wanted = LANGUAGES["ja_JP"][template]
            assert translated(text) == re.sub(r"\{(\w+)\}", lambda field: fields[field[1]], wanted)  # noqa: B023


def test_english_stays_english():
    text = '"Cat" was edited meanwhile. Nothing was written.'
    assert translated(text) == text
