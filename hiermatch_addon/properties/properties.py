# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Properties: the options of a match, on the scene and on the operator alike, and what the panel remembers."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, cast

import bpy

from ...engine import MatchSettings, call_background, match_steps
from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..scene.character import parts_of, side_of
from ..scene.pair import named_side
from ..storage.excluded_regions import region_names
from ..storage.writing import LONGEST_PREFIX
from .panel_state import picked
from .steering_lists import sync_lists
from .summary import remember_common

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_props: Any = bpy.props  # whose functions Blender's stubs declare to return nothing


def to_identifier(word: str) -> str:
    """Return how Blender writes one of the engine's words: in capitals."""
    return word.upper()


def _setting_property(setting: Any) -> Any:  # noqa: ANN401 - a dataclass field and a deferred property have no public type
    """Declare the Blender property of a field of `MatchSettings`."""
    about = setting.metadata
    if "choices" in about:
        return _props.EnumProperty(
            name=about["label"],
            description=about["description"],
            default=to_identifier(setting.default),
            items=[(to_identifier(word), *described) for word, described in about["choices"].items()],
        )
    if isinstance(setting.default, bool):
        return _props.BoolProperty(name=about["label"], description=about["description"], default=setting.default)
    make = _props.FloatProperty if isinstance(setting.default, float) else _props.IntProperty
    return make(
        name=about["label"],
        description=about["description"],
        default=setting.default,
        min=about["minimum"],
        max=about["maximum"],
    )


_SETTINGS: dict[str, Any] = {setting.name: _setting_property(setting) for setting in fields(MatchSettings)}
_CHOICES = {
    setting.name: {to_identifier(word): word for word in setting.metadata["choices"]}
    for setting in fields(MatchSettings)
    if "choices" in setting.metadata
}


def _search_regions(role: str) -> Callable[[Any, bpy.types.Context, str], list[str]]:
    """Make what lists the regions of one of the two objects, as they are picked or named."""

    def search(owner: Any, context: bpy.types.Context, _text: str) -> list[str]:  # noqa: ANN401 - options of a match
        chosen = getattr(owner, role) or getattr(owner, f"{role}_collection", None)
        layer = view_layer_of(context)
        try:
            side = named_side(layer, chosen) if isinstance(chosen, str) else side_of(chosen, layer) if chosen else None
        except ObjectError:
            return []
        return region_names(side) if side is not None and parts_of(side)[0].type == "MESH" else []

    return search


_OPTIONS: dict[str, Any] = {
    "use_modifiers": _props.BoolProperty(
        name="Use Modifiers",
        description="Match the meshes as their shape keys and modifiers show them. "
        "Possible unless a modifier adds or removes vertices",
    ),
    "alternative": _props.IntProperty(
        name="Alternative",
        description="For a shape that looks the same from several sides, which of the other answers to write, if there "
        "are as many: 1 is the one in which left and right are exchanged, if there is one. 0 writes the direct answer",
        min=0,
        soft_max=8,
    ),
    "use_landmarks": _props.BoolProperty(
        name="Use Landmarks",
        description="Keep to the landmarks that the two meshes have in common and that are switched on",
        default=True,
    ),
    "exclude_source": _props.StringProperty(
        name="Leave Out of Source",
        description="Vertex group, boolean attribute, material or face set of the source whose vertices are not "
        "matched. In the dense map they follow what is around them",
        search=_search_regions("source"),
    ),
    "exclude_target": _props.StringProperty(
        name="Leave Out of Target",
        description="Vertex group, boolean attribute, material or face set of the target whose vertices are not "
        "matched. In the dense map they follow what is around them",
        search=_search_regions("target"),
    ),
    "prefix": _props.StringProperty(
        name="Prefix",
        description="What the names of everything that is written start with. "
        "Another prefix keeps the results of other matches",
        default="HM",
        maxlen=LONGEST_PREFIX,
    ),
    "write_vertex_groups": _props.BoolProperty(
        name="Vertex Groups",
        description="Write a vertex group for each matched point; groups of the same name are the same point",
        default=True,
    ),
    "write_colors": _props.BoolProperty(
        name="Match Colors",
        description="Write a color attribute that gives corresponding places of both meshes the same color",
        default=True,
    ),
    "write_distortion": _props.BoolProperty(
        name="Distortion",
        description="Write how much lengths differ around each place, as a color attribute from dark blue (none) to "
        "yellow (twice or half as long), and as an attribute of numbers. Without a dense map: how much the distances "
        "to the matched points differ, yellow being the most",
        default=True,
    ),
    "write_confidence": _props.BoolProperty(
        name="Confidence",
        description="Write how far the dense map can be trusted at each place, as a color attribute from dark red (not "
        "at all) to white (fully)",
        default=True,
    ),
}

SETTING_NAMES = tuple(_SETTINGS)
"""The options that mirror `MatchSettings`."""

OUTPUT_NAMES = tuple(_OPTIONS)
"""The options that the engine knows nothing of."""

OPTION_NAMES = (*SETTING_NAMES, *OUTPUT_NAMES)
"""All options of a match."""


class MatchOptions:
    """The options of a match, for whatever class of Blender's inherits from it."""

    __annotations__ = {**_SETTINGS, **_OPTIONS}

    if TYPE_CHECKING:
        points: int
        dense: bool
        use_modifiers: bool
        alternative: int
        use_landmarks: bool
        exclude_source: str
        exclude_target: str
        prefix: str
        write_vertex_groups: bool
        write_colors: bool
        write_distortion: bool
        write_confidence: bool


def match_settings(options: MatchOptions) -> MatchSettings:
    """Make the engine's settings of the options.

    Raises
    ------
    SettingsError
        If they contradict each other.
    """
    return MatchSettings(**{name: setting_of(options, name) for name in SETTING_NAMES})


def setting_of(options: MatchOptions, name: str) -> Any:  # noqa: ANN401 - a number or a word
    """Return one of the options as the engine writes it."""
    value = getattr(options, name)
    return _CHOICES[name][value] if name in _CHOICES else value


def set_settings(options: MatchOptions, values: Mapping[str, Any]) -> None:
    """Set some of the options to values as the engine writes them."""
    for name, value in values.items():
        setattr(options, name, to_identifier(value) if name in _CHOICES else value)


def copy_options(source: MatchOptions, target: MatchOptions) -> None:
    """Copy all options."""
    for name in OPTION_NAMES:
        setattr(target, name, getattr(source, name))


def _is_pickable(_owner: bpy.types.PropertyGroup, obj: bpy.types.Object) -> bool:
    return obj.type in ("MESH", "ARMATURE", "EMPTY")


def _on_pick(owner: HIERMATCH_PG_scene, _context: bpy.types.Context) -> None:
    """Tell of the match that the two meshes carry that are picked now, and list what they have in common.

    In a window, what will match them starts meanwhile.
    """
    scene = cast("bpy.types.Scene", owner.id_data)
    remember_common(scene)
    sync_lists(scene)
    if not bpy.app.background and all(picked(owner)):
        call_background(match_steps)


class HIERMATCH_PG_summary(bpy.types.PropertyGroup):
    """What the panel tells about the last match; it is there if `points` is not zero."""

    points: _props.IntProperty(name="Points", description="How many points were matched")
    source: _props.StringProperty(name="Source", description="Name of the source object")
    target: _props.StringProperty(name="Target", description="Name of the target object")
    distortion: _props.FloatProperty(name="Distortion", description="Distortion of the whole match")
    stretch: _props.FloatProperty(
        name="Stretch",
        description="By how much lengths differ between the two meshes on average, by the dense map",
        subtype="FACTOR",
    )
    worst_distortion: _props.FloatProperty(
        name="Worst Point",
        description="Largest distortion of a matched point, in units of the square root of the surface area",
    )
    proven: _props.BoolProperty(name="Optimum Proven", description="Whether no coarse match has less distortion")
    gap: _props.FloatProperty(
        name="Gap",
        description="By how much, at most, the coarse match can be worse than the best one",
        subtype="FACTOR",
    )
    orientation: _props.FloatProperty(
        name="Orientation", description="From 1, left stays left, to -1, the match mirrors the shape"
    )
    answers: _props.StringProperty(
        name="Answers", description="Names of all answers: the direct one and its alternatives, one per line"
    )
    answer: _props.IntProperty(
        name="Chosen Answer",
        description="Number of the answer that is written on the meshes, from 0 for the direct one",
    )
    verdict: _props.StringProperty(
        name="Verdict", description="How far the dense map can be trusted, in a sentence; empty if there is none"
    )
    confidence: _props.FloatProperty(
        name="Confidence", description="How far the dense map can be trusted as a whole", subtype="FACTOR"
    )
    stale: _props.StringProperty(
        name="Out of Date", description="Why the match is out of date; empty as long as it is not known to be"
    )
    lost: _props.BoolProperty(
        name="Lost", description="Whether one of its meshes was deleted, or carries the match no more"
    )
    hidden: _props.BoolProperty(
        name="Of Others", description="Whether the match is of other meshes than those that are picked"
    )
    swapped: _props.BoolProperty(
        name="Swapped", description="Whether source and target were exchanged since they were matched"
    )
    seconds: _props.FloatProperty(name="Seconds", description="How long the match took; zero if that is not known")
    notes: _props.StringProperty(
        name="Notes", description="What should be known about the match, one sentence per line"
    )
    prefix: _props.StringProperty(name="Prefix", description="What the names of everything that was written start with")
    key: _props.StringProperty(
        name="Key", description="By what the two meshes are recognised as the pair of this match"
    )


class HIERMATCH_PG_scene(MatchOptions, bpy.types.PropertyGroup):
    """The panel's state on a scene."""

    source: _props.PointerProperty(
        name="Source",
        description="Mesh that is matched, or an armature or an empty with all meshes that hang on it; if nothing is "
        "picked, what is active",
        type=bpy.types.Object,
        poll=_is_pickable,
        update=_on_pick,
    )
    target: _props.PointerProperty(
        name="Target",
        description="Mesh that corresponding points are sought on, or an armature or an empty with all meshes that "
        "hang on it; if nothing is picked, what else is selected",
        type=bpy.types.Object,
        poll=_is_pickable,
        update=_on_pick,
    )
    source_collection: _props.PointerProperty(
        name="Source Collection",
        description="Collection whose meshes are the source together, if no object is picked",
        type=bpy.types.Collection,
        update=_on_pick,
    )
    target_collection: _props.PointerProperty(
        name="Target Collection",
        description="Collection whose meshes are the target together, if no object is picked",
        type=bpy.types.Collection,
        update=_on_pick,
    )
    summary: _props.PointerProperty(name="Summary", description="The last match", type=HIERMATCH_PG_summary)


class HIERMATCH_PG_progress(bpy.types.PropertyGroup):
    """How far the match is that runs in the window manager, and whether to cancel it."""

    fraction: _props.FloatProperty(name="Fraction", description="Part of the match that is done", min=0, max=1)
    label: _props.StringProperty(name="Label", description="What is being done")
    cancel: _props.BoolProperty(name="Cancel", description="Whether the running match is to end")
    question: _props.StringProperty(
        name="Question", description="What has to be answered before the work goes on, one sentence per line"
    )
    answer: _props.StringProperty(name="Answer", description="The answer; empty as long as there is none")
