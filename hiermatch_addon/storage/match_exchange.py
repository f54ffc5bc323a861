# SPDX-License-Identifier: GPL-3.0-or-later
"""A match between objects and files: taken from two objects that carry it, and written on two that it fits."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ...engine import run
from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..scene.character import parts_of, positions_of, read_surface, topology_of, vertex_count
from ..scene.pair import check_mode, check_pair
from . import writing
from .answer_writing import mapped_contents_steps, restored, write_answer
from .contents import contents_steps
from .halves import find_match, in_order
from .match_file import MatchFile
from .stored_match import StoredMatch
from .vertex_maps import read_all_maps

if TYPE_CHECKING:
    import bpy

    from ..scene.character import Side

_SPARSE = "The imported match has no dense map: only its points were written, without colors and distortion."


def collect_match(one: Side, other: Side, prefix: str = "") -> MatchFile:
    """Take the match that two objects carry with one another; what was matched as the source comes first.

    It is called `swapped` if that is the `other` one here.

    Parameters
    ----------
    one, other : bpy.types.Object or Character
        The objects, in whichever order.
    prefix : str
        What the names that the match wrote start with; may be empty if the two carry one match only.

    Raises
    ------
    ObjectError
        If they carry no match with one another or several, have other faces since, or are being edited.
    """
    found = find_match(one, other, prefix)
    source, target = in_order(*found)
    for part in (*parts_of(one), *parts_of(other)):
        check_mode(part)
    stored = replace(StoredMatch.from_plain(source.kept, target.kept), swapped=source is not found[0])
    shown, *others = read_all_maps(source.obj, target.obj, source.prefix, len(stored.answers))
    return MatchFile(stored, (vertex_count(source.obj), vertex_count(target.obj)), shown, tuple(others))


def apply_match(context: bpy.types.Context, source: Side, target: Side, match: MatchFile, prefix: str) -> StoredMatch:
    """Write a match on two objects, as if they had just been matched.

    They may be named, placed and posed otherwise than those it was exported from, but must have the same vertices and
    faces.

    Returns
    -------
    StoredMatch
        What they carry now.

    Raises
    ------
    HierMatchError
        If it does not fit them, or they cannot be written to; nothing is written then.
    """
    depsgraph = context.evaluated_depsgraph_get()
    check_pair(view_layer_of(context), source, target)
    if match.kind != "match":
        raise ObjectError("The file holds the symmetry of one mesh, not the match of two. Choose another file.")
    writing.check_prefix(prefix)
    _check_fit(source, target, match)
    objects = (source, target)
    stored = replace(
        match.stored,
        names=(source.name, target.name),
        topologies=(topology_of(source), topology_of(target)),
        positions=(positions_of(source), positions_of(target)),
        swapped=False,
    )
    use_modifiers = stored.written.use_modifiers
    source_mesh, target_mesh = (read_surface(obj, depsgraph, use_modifiers=use_modifiers) for obj in objects)
    meshes = (source_mesh, target_mesh)
    if match.maps is not None:
        prepared = run(mapped_contents_steps(stored, meshes, prefix, match.maps, match.others))
    else:
        # Without maps, colors and distortion are made of distances that the file does not hold.
        written = replace(stored.written, match_colors=False, distortion=False, confidence=False)
        stored = replace(stored, written=written, notes=(*stored.notes, _SPARSE))
        prepared = run(contents_steps(restored(stored, meshes), prefix, written))
    write_answer(objects, stored, prepared, prefix, show=True)
    return stored


def _check_fit(source: Side, target: Side, match: MatchFile) -> None:
    """Make sure that the match is one of these meshes."""
    objects = (source, target)
    wanted = tuple(zip(match.counts, match.stored.topologies, strict=True))
    here = tuple((vertex_count(obj), topology_of(obj)) for obj in objects)
    if _all_fit(here, wanted):
        return
    if _all_fit(here[::-1], wanted):
        raise ObjectError(
            f'The match fits the other way round: "{target.name}" is its source and "{source.name}" its target. '
            "Exchange the two."
        )
    for obj, (count, digest), (vertices, faces) in zip(objects, here, wanted, strict=True):
        if count != vertices:
            raise ObjectError(
                f'The match does not fit "{obj.name}": it was exported from a mesh with {vertices} vertices, and this '
                f"one has {count}. Choose the mesh it was made for, or match again."
            )
        if faces not in ("", digest):
            raise ObjectError(
                f'The match does not fit "{obj.name}": its vertices or faces are numbered otherwise than on the mesh '
                "the match was exported from. Choose that mesh, or match again."
            )


def _all_fit(here: tuple[tuple[int, str], ...], wanted: tuple[tuple[int, str], ...]) -> bool:
    """Tell whether all numbers of vertices, and digests as far as they are known, agree."""
    return all(
        count == vertices and faces in ("", digest)
        for (count, digest), (vertices, faces) in zip(here, wanted, strict=True)
    )
