# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel's summary of the match that was written last, or that the picked meshes carry."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import bpy

from ..scene.character import parts_of
from ..storage.halves import find_carriers, in_order
from ..storage.stored_match import StoredMatch
from .panel_state import pick, picked, summary_of
from .steering_lists import common_match, picked_side

if TYPE_CHECKING:
    from .properties import HIERMATCH_PG_summary


def remember(
    summary: HIERMATCH_PG_summary, stored: StoredMatch, names: tuple[str, str], prefix: str, seconds: float
) -> None:
    """Fill the summary.

    Parameters
    ----------
    summary : HIERMATCH_PG_summary
        What to fill.
    stored : StoredMatch
        The match.
    names : tuple of str
        What the objects that were matched as source and target are called now.
    prefix : str
        What all names written start with.
    seconds : float
        How long the match took; zero if that is not known.
    """
    answer, (quality, notes) = stored.answer, stored.told
    summary.points = len(answer.point_distortion)
    summary.source, summary.target = names[::-1] if stored.swapped else names
    summary.swapped = stored.swapped
    summary.distortion = answer.distortion
    summary.worst_distortion = float(answer.point_distortion.max())
    summary.proven, summary.gap = answer.proven, answer.gap
    summary.orientation = answer.orientation
    summary.answers, summary.answer = "\n".join(answer.name for answer in stored.answers), stored.chosen
    summary.stretch = quality.distortion if quality else 0.0
    summary.verdict = quality.sentence if quality else ""
    summary.confidence = quality.confidence if quality else 0.0
    summary.seconds = seconds
    summary.notes = "\n".join(notes)
    summary.prefix, summary.key = prefix, stored.key


def pick_named(scene: bpy.types.Scene, source: str, target: str) -> None:
    """Show a pair that a script has named in the pickers, unless the user has picked others there.

    To be called before `remember`: what the pickers show of the last match may be replaced.  What has no picker, such
    as several objects named together, is passed over.
    """
    state: Any = cast("Any", scene).hiermatch
    shown = tuple("" if chosen is None else chosen.name for chosen in picked(state))
    if shown not in (("", ""), (state.summary.source, state.summary.target)):
        return
    found = [bpy.data.objects.get(name) or bpy.data.collections.get(name) for name in (source, target)]
    for role, chosen in zip(("source", "target"), found, strict=True):
        if all(found):
            pick(state, role, chosen)


def is_of_picked(scene: bpy.types.Scene) -> bool:
    """Tell whether a scene's summary is about what is picked, or about one side of it if nothing else is picked.

    What is picked carries its side of the match then; if none of it is in sight, its name tells.
    """
    summary = summary_of(scene)
    names, roles = (summary.source, summary.target), ("source", "target")
    for number, chosen in enumerate(picked(cast("Any", scene).hiermatch)):
        if chosen is None:
            continue
        side, role = picked_side(scene, chosen), roles[number != summary.swapped]
        if side is None and chosen.name != names[number]:
            return False
        if side is not None and not find_carriers(parts_of(side), summary.key, summary.prefix, role):
            return False
    return True


def remember_common(scene: bpy.types.Scene) -> None:
    """Fill a scene's summary with the match of the two meshes that its panels are about, such as after appending them.

    It calls source and target what they do.  If they carry none, it is hidden as long as they are picked.
    """
    _remember_common(scene)
    summary_of(scene).hidden = summary_of(scene).points > 0 and not is_of_picked(scene)


def _remember_common(scene: bpy.types.Scene) -> None:
    summary, halves = summary_of(scene), common_match(scene)
    if halves is None:
        return
    swapped, same = halves[0].role == "target", (halves[0].key, halves[0].prefix) == (summary.key, summary.prefix)
    if same and swapped == summary.swapped:
        return
    source, target = in_order(*halves)
    stored = replace(StoredMatch.from_plain(source.kept, target.kept), swapped=swapped)
    remember(summary, stored, (source.obj.name, target.obj.name), source.prefix, summary.seconds if same else 0.0)
    summary.stale, summary.lost = source.staleness() or target.staleness(), False
