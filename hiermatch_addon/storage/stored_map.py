# SPDX-License-Identifier: GPL-3.0-or-later
"""The dense map of a match that is kept on two meshes, for what uses it without matching again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...engine import run
from ..common.errors import ObjectError
from ..scene.character import read_surface
from .answer_writing import mapped_contents_steps, write_answer
from .halves import find_match, in_order
from .stored_match import StoredMatch
from .vertex_maps import StoredMaps, map_name, read_all_maps

if TYPE_CHECKING:
    import bpy

    from ..scene.character import Side
    from .halves import Half
    from .stored_match import Quality


@dataclass(frozen=True, eq=False)
class FoundMaps:
    """The dense maps that two objects carry.

    Attributes
    ----------
    source, target : Half
        The two sides, in the order in which they were asked for.
    maps : StoredMaps
        What is kept of the maps, in the same order.
    refined : bool
        Whether they were refined with a rig.
    use_modifiers : bool
        Whether the meshes were matched as shape keys and modifiers show them.
    quality : Quality or None
        How far they can be trusted, in the same order, as it was measured when the match was made; None if that is not
        known.
    """

    source: Half
    target: Half
    maps: StoredMaps
    refined: bool
    use_modifiers: bool
    quality: Quality | None = None


def find_maps(source: Side, target: Side, prefix: str = "") -> FoundMaps:
    """Find the dense maps between two objects that were matched, in whichever order.

    Parameters
    ----------
    source, target : bpy.types.Object or Character
        The objects; what is `source` here may have been the target of the match.
    prefix : str
        What the names that the match wrote start with; may be empty if the two carry one match only.

    Raises
    ------
    ObjectError
        If the objects carry no match with one another or several, if it has no dense map, or if a mesh was edited
        since: in a sentence that says which, and what to do.
    """
    pair, halves = f'"{source.name}" and "{target.name}"', find_match(source, target, prefix)
    first, second = in_order(*halves)
    stored = StoredMatch.from_plain(first.kept, second.kept)
    if not stored.written.dense:
        raise ObjectError(f"The match of {pair} has no dense map. Match them again with Dense Map on.")
    maps = StoredMaps.read(first.obj, second.obj, map_name(first.prefix))
    if maps is None:
        raise ObjectError(f"The dense map of {pair} was removed from the attributes of a mesh. Match them again.")
    answer, quality = stored.answer, stored.answer.quality
    if first is not halves[0]:
        maps, quality = maps.reverse, quality and quality.reverse
    return FoundMaps(*halves, maps, answer.refined, stored.written.use_modifiers, quality)


def keep_refined(context: bpy.types.Context, source: Side, target: Side, prefix: str, maps: StoredMaps) -> None:
    """Let better maps take the place of those that two objects carry, and write what shows them anew.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    source, target : bpy.types.Object or Character
        The objects, in the order of `maps`.
    prefix : str
        As in `find_maps`.
    maps : StoredMaps
        The better maps.

    Raises
    ------
    HierMatchError
        If the objects carry no such match (any more); nothing is written then.
    """
    found = find_maps(source, target, prefix)
    sides = (found.source, found.target)
    first, second = in_order(*sides)
    stored = StoredMatch.from_plain(first.kept, second.kept).as_refined()
    depsgraph = context.evaluated_depsgraph_get()
    source_mesh, target_mesh = (
        read_surface(half.obj, depsgraph, use_modifiers=stored.written.use_modifiers) for half in (first, second)
    )
    shown = maps if first is sides[0] else maps.reverse
    _, *others = read_all_maps(first.obj, second.obj, first.prefix, len(stored.answers))
    prepared = run(mapped_contents_steps(stored, (source_mesh, target_mesh), first.prefix, shown, others))
    write_answer((first.obj, second.obj), stored, prepared, first.prefix)
