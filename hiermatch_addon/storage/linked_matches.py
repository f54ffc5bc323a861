# SPDX-License-Identifier: GPL-3.0-or-later
"""Matches with bodies of other files, which cannot be written to: the other body keeps all of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..common.access import group_of, mesh_of
from ..common.errors import ObjectError
from ..scene.character import parts_of, positions_of, topology_of, vertex_count
from ..scene.pair import is_own
from .match_file import MatchFile, packed_match, unpacked_match

if TYPE_CHECKING:
    import bpy

    from ..scene.character import Side
    from .stored_match import StoredMatch
    from .vertex_maps import StoredMaps

_PROPERTY = "hiermatch_linked"
"""Custom property of the mesh of a body's first part: for each prefix a match, as an NPZ file would hold it."""


def keep_linked(source: Side, target: Side, stored: StoredMatch, maps: StoredMaps, prefix: str) -> None:
    """Keep a match on its target alone, or else on its source, in the place of one with the same prefix."""
    packed = packed_match(MatchFile(stored, (vertex_count(source), vertex_count(target)), maps))
    for keeper in [side for side in (target, source) if is_own(side)][:1]:
        mesh: Any = mesh_of(parts_of(keeper)[0])
        mesh[_PROPERTY] = _packed(parts_of(keeper)[0]) | {prefix: packed}


def kept_linked(source: Side, target: Side, prefix: str = "") -> MatchFile | None:
    """Return the match of two sides that one of them keeps alone, if neither was edited since; None if there is none.

    Parameters
    ----------
    source, target : bpy.types.Object or Character
        The sides.
    prefix : str
        With which it was kept; empty for any.
    """
    topologies = topology_of(source), topology_of(target)
    positions = positions_of(source), positions_of(target)
    kept = (one for side in (target, source) for one in _packed(parts_of(side)[0]).items())
    for name, packed in kept:
        if prefix not in ("", name):
            continue
        try:
            match = unpacked_match(packed)
        except ObjectError:  # by a later version, or somebody has written there
            continue
        if (match.stored.topologies, match.stored.positions) == (topologies, positions) and match.maps is not None:
            return match
    return None


def move_linked(target: Side, before: str) -> None:
    """Keep those matches up to date that a target keeps alone, and that were so before its vertices were moved.

    Parameters
    ----------
    target : bpy.types.Object or Character
        The target.
    before : str
        What `positions_of` said of it then.
    """
    first = parts_of(target)[0]
    kept = _packed(first)
    for name, packed in kept.items():
        try:
            match = unpacked_match(packed)
        except ObjectError:  # as in `kept_linked`
            continue
        if match.stored.positions[1] == before:
            positions = match.stored.positions[0], positions_of(target)
            kept[name] = packed_match(replace(match, stored=replace(match.stored, positions=positions)))
    if kept:
        mesh: Any = mesh_of(first)
        mesh[_PROPERTY] = kept


def has_linked(obj: bpy.types.Object) -> bool:
    """Return whether an object keeps matches alone, without reading these."""
    return bool(group_of(mesh_of(obj), _PROPERTY))


def linked_prefixes(obj: bpy.types.Object) -> tuple[str, ...]:
    """Return the prefixes of the matches that an object keeps alone."""
    return tuple(_packed(obj))


def forget_linked(obj: bpy.types.Object, prefix: str) -> None:
    """Remove the match that an object keeps alone."""
    mesh: Any = mesh_of(obj)
    left = {name: packed for name, packed in _packed(obj).items() if name != prefix}
    if left:
        mesh[_PROPERTY] = left
    else:
        del mesh[_PROPERTY]


def _packed(obj: bpy.types.Object) -> dict[str, bytes]:
    """Return all that an object keeps."""
    return {name: packed for name, packed in group_of(mesh_of(obj), _PROPERTY).items() if isinstance(packed, bytes)}
