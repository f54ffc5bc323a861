# SPDX-License-Identifier: GPL-3.0-or-later
"""The dense map of a match that is kept on two meshes, for whoever wants to use it without matching again."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .access import mesh_of
from .errors import ObjectError
from .halves import find_common
from .mesh_io import read_mesh
from .stored_match import Written
from .vertex_maps import StoredMaps, map_name

if TYPE_CHECKING:
    import bpy

    from .vertex_maps import MapPair

__all__ = ["stored_map"]


def stored_map(
    context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object, prefix: str = ""
) -> MapPair:
    """Read the dense maps between two objects that were matched, in whichever order.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    source, target : bpy.types.Object
        The objects; what is `source` here may have been the target of the match.
    prefix : str
        What the names that the match wrote start with; may be empty if the two carry one match only.

    Returns
    -------
    MapPair
        The meshes as they stand in the world, and the maps from the one to the other and back.

    Raises
    ------
    HierMatchError
        If the objects carry no match with one another or several, if it has no dense map, or if a mesh was edited
        since: in a sentence that says which, and what to do.
    """
    pair = f'"{source.name}" and "{target.name}"'
    found = [halves for halves in find_common(source, target) if prefix in ("", halves[0].prefix)]
    if not found:
        of_prefix = f' with the Prefix "{prefix}"' if prefix else ""
        raise ObjectError(f"{pair} carry no match with one another{of_prefix}. Match them first.")
    if len(found) > 1:
        prefixes = ", ".join(f'"{half.prefix}"' for half, _ in found)
        raise ObjectError(f"{pair} carry several matches. Name the Prefix of one of them: {prefixes}.")
    (halves,) = found
    for half in halves:
        if stale := half.staleness():
            raise ObjectError(stale)
    first, second = halves if halves[0].role == "source" else halves[::-1]
    written = Written(**first.kept["written"])
    if not written.dense:
        raise ObjectError(f"The match of {pair} has no dense map. Match them again with Dense Map on.")
    maps = StoredMaps.read(mesh_of(first.obj), mesh_of(second.obj), map_name(first.prefix))
    if maps is None:
        raise ObjectError(f"The dense map of {pair} was removed from the attributes of a mesh. Match them again.")
    depsgraph = context.evaluated_depsgraph_get()
    meshes = [read_mesh(half.obj, depsgraph, use_modifiers=written.use_modifiers) for half in (first, second)]
    between = maps.between(meshes[0], meshes[1])
    return between if first is halves[0] else between.reverse
