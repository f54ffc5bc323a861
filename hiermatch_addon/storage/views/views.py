# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of a match in colours: color attributes of both meshes, made when they are wanted first."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ....engine import nearest_regions
from ...common.access import mesh_of
from ...common.errors import ObjectError
from ...scene.character import parts_of, read_surface
from .. import writing
from ..contents import Content
from ..halves import check_fresh, in_order
from ..stored_match import StoredMatch
from ..vertex_maps import StoredMaps, map_name
from . import colors
from .view_colors import check_size, checked, overlap_colors, region_colors

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ..halves import Half
    from ..vertex_maps import MapPair

VIEW_ITEMS: Final = (
    ("NONE", "Nothing", "Show the meshes as before"),
    ("MATCH", "Match Colors", "Show corresponding places in the same color"),
    ("DISTORTION", "Distortion", "Show how much lengths differ, from dark blue (none) to yellow"),
    ("CONFIDENCE", "Confidence", "Show how far the dense map can be trusted, from dark red to white (fully)"),
    ("OVERLAP", "Overlap", "Show in blue what has a counterpart on the other mesh, and in grey what has none"),
    ("REGIONS", "Regions", "Show each vertex in the color of the nearest matched point"),
    ("CHECKER", "Checker", "Show checks on the source, and where the dense map takes them on the target"),
)
"""Identifier, name and description of each view."""

_ENDINGS: Final = {
    "MATCH": "Match",
    "DISTORTION": "Distortion",
    "CONFIDENCE": "Confidence",
    "OVERLAP": "Overlap Colors",
    "REGIONS": "Regions",
    "CHECKER": "Checker",
}


def attribute_of(prefix: str, view: str) -> str:
    """Return the name of the color attribute that a view shows."""
    return f"{prefix} {_ENDINGS[view]}"


def prepare_view(context: bpy.types.Context, halves: tuple[Half, Half], view: str) -> None:
    """Make sure that both meshes have the colours that a view shows.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    halves : tuple of Half
        The two sides of the match.
    view : str
        One of `VIEW_ITEMS`.

    Raises
    ------
    HierMatchError
        If the colours are not there and cannot be made; the message says what to do.
    """
    name = attribute_of(halves[0].prefix, view)
    if view in _MADE:
        check_fresh(halves)
        shades = _MADE[view](context, halves)
        _write(halves, [Content(colors={name: colors.opaque(colors.to_linear(shade))}) for shade in shades])
        return
    for half in halves:
        if any(name not in mesh_of(part).color_attributes for part in parts_of(half.obj)):
            raise ObjectError(
                f'"{half.obj.name}" carries no colors called "{name}". Match again with {_ENDINGS[view]} on under '
                "Output, and for confidence with Dense Map on."
            )


def show_attribute(mesh: bpy.types.Mesh, name: str) -> None:
    """Make a color attribute the active one of a mesh, if it exists."""
    if name in mesh.color_attributes:
        mesh.attributes.active_color_name = name
        mesh.update()


def region_groups(context: bpy.types.Context, halves: tuple[Half, Half]) -> int:
    """Write the regions of both meshes as vertex groups; return how many there are.

    Raises
    ------
    HierMatchError
        If they cannot be found, or vertex groups of the user's own are in the way; nothing is written then.
    """
    check_fresh(halves)
    prefix, found = halves[0].prefix, _region_numbers(context, halves)
    contents = []
    for numbers in found:
        groups = {}
        for number in range(int(max(side.max() for side in found)) + 1):
            vertices = np.flatnonzero(numbers == number)
            groups[f"{prefix} Region.{number + 1:03d}"] = (vertices, np.ones(len(vertices)))
        contents.append(Content(groups=groups))
    _write(halves, contents)
    return len(contents[0].groups)


def _write(halves: tuple[Half, Half], contents: list[Content]) -> None:
    """Write more on both meshes, given for the source and for the target, if nothing else has its names."""
    plan = [(half.obj, content, half.prefix) for half, content in zip(in_order(*halves), contents, strict=True)]
    for each in plan:
        writing.check_names(*each)
    for each in plan:
        writing.extend(*each)


def _maps(context: bpy.types.Context, halves: tuple[Half, Half]) -> MapPair | None:
    """Read the dense maps, of what was matched as the source first; None if there are none."""
    first, second = in_order(*halves)
    stored = StoredMatch.from_plain(first.kept, second.kept)
    kept = StoredMaps.read(first.obj, second.obj, map_name(first.prefix))
    if kept is None:
        return None
    depsgraph = context.evaluated_depsgraph_get()
    source, target = (
        read_surface(half.obj, depsgraph, use_modifiers=stored.written.use_modifiers) for half in (first, second)
    )
    return kept.between(source, target)


def _region_numbers(
    context: bpy.types.Context, halves: tuple[Half, Half]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Find the region of each vertex of the source and of the target.

    With a dense map, the regions of the source go where it takes them; without one, each mesh has its own.
    """
    first, second = in_order(*halves)
    stored = StoredMatch.from_plain(first.kept, second.kept)
    maps = _maps(context, halves)
    kept = np.setdiff1d(np.arange(len(stored.answer.point_distortion)), stored.left_out)
    here, there = (points.nearest_vertices[kept] for points in (stored.source_points, stored.answer.target_points))
    if maps is None:
        depsgraph = context.evaluated_depsgraph_get()
        meshes = [read_surface(half.obj, depsgraph, use_modifiers=False) for half in (first, second)]
        found = (nearest_regions(meshes[0], here), nearest_regions(meshes[1], there))
    else:
        own = nearest_regions(maps.source, here)
        found = (own, own[maps.target_to_source.nearest_vertices])
    source, target = (np.where(side >= 0, kept[side], side) for side in found)
    return source, target


def _regions(context: bpy.types.Context, halves: tuple[Half, Half]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Colour source and target by regions."""
    one, other = _region_numbers(context, halves)
    return region_colors(one), region_colors(other)


def _overlap(context: bpy.types.Context, halves: tuple[Half, Half]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Colour source and target by what has a partner on the other."""
    maps = _needed_maps(context, halves)
    own, other = (overlap_colors(found.has_partner) for found in (maps.source_to_target, maps.target_to_source))
    return own, other


def _needed_maps(context: bpy.types.Context, halves: tuple[Half, Half]) -> MapPair:
    """Read the dense maps, see `_maps`; that there are none is an error."""
    maps = _maps(context, halves)
    if maps is None:
        raise ObjectError(
            f'The match of "{halves[0].obj.name}" and "{halves[1].obj.name}" has no dense map. '
            "Match them with Dense Map on."
        )
    return maps


def _checks(context: bpy.types.Context, halves: tuple[Half, Half]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Colour source and target by checks on the source."""
    maps = _needed_maps(context, halves)
    places = maps.source.vertices
    size = check_size(places, float(np.median(maps.source.edge_lengths)))
    shades = colors.match_colors(places, maps.source.vertex_areas)
    carried = maps.target_to_source.transfer(np.column_stack([shades, places]))
    return checked(shades, places, size), checked(carried[:, :3], carried[:, 3:], size)


_MADE: Final = {"OVERLAP": _overlap, "REGIONS": _regions, "CHECKER": _checks}
"""Views that a match does not write, and what makes their colours."""
