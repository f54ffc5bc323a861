# SPDX-License-Identifier: GPL-3.0-or-later
"""The content that a match writes on two objects, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine import Progress
from .views import colors
from .views.stretch import DOUBLED, vertex_stretch

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from ...engine import MatchResult, Steps, SurfacePoints
    from .stored_match import Written
    from .vertex_maps import MapPair

_LABEL = "Preparing what is written"

UNREACHED = -1.0
"""Value of the distortion where there is none to tell: at a vertex without an edge, or, if there is no dense map, one
that no matched point has a path to."""


@dataclass(frozen=True, eq=False)
class Restored:
    """What is written of an answer, as the engine had given it; see `MatchResult`."""

    source_points: SurfacePoints
    target_points: SurfacePoints
    point_distortion: NDArray[np.float64]
    source_distances: NDArray[np.float64] | None = None
    target_distances: NDArray[np.float64] | None = None


@dataclass(frozen=True, eq=False)
class Content:
    """What shall stand on one object.

    Attributes
    ----------
    groups : dict
        For each vertex group its vertices (c,) and their weights (c,).
    colors : dict
        For each color attribute its linear colours, (n, 4).
    values : dict
        For each attribute of numbers its values, (n,), or of vectors, (n, 3).
    keep : dict
        Plain data to keep with it: numbers, texts, lists of numbers, and such dicts; see `kept`.
    """

    groups: dict[str, tuple[NDArray[np.int64], NDArray[np.float64]]] = field(default_factory=dict)
    colors: dict[str, NDArray[np.float32]] = field(default_factory=dict)
    values: dict[str, NDArray[Any]] = field(default_factory=dict)
    keep: dict[str, Any] = field(default_factory=dict)

    def of_part(self, own: slice, number: int, count: int, name: str) -> Content:
        """Return what of it stands on one part of a character.

        Parameters
        ----------
        own : slice
            Which of all vertices are the part's.
        number, count : int
            Which part it is, from 0, of how many; kept with it, so that the parts find each other again.
        name : str
            What the part is called now.
        """
        groups = {}
        for group, (vertices, weights) in self.groups.items():
            inside = (vertices >= own.start) & (vertices < own.stop)
            if inside.any():
                groups[group] = (vertices[inside] - own.start, weights[inside])
        colored = {layer: values[own] for layer, values in self.colors.items()}
        values = {layer: values[own] for layer, values in self.values.items()}
        keep = {**self.keep, "part": number, "parts": count, "part_name": name} if self.keep else {}
        return Content(groups, colored, values, keep)

    @property
    def shown(self) -> str | None:
        """The color attribute to make the active one: the first."""
        return next(iter(self.colors), None)


def contents_steps(
    result: MatchResult | Restored,
    prefix: str,
    kinds: Written,
    maps: MapPair | None = None,
    *,
    left_out: Collection[int] = (),
) -> Steps[tuple[Content, Content]]:
    """Prepare what a match writes on the source and on the target.

    Parameters
    ----------
    result : MatchResult or Restored
        The match; its distances are used for colors and distortion only, and only if there are no maps.
    prefix : str
        What every name starts with.
    kinds : Written
        Which kinds to write; confidence only if there are maps.
    maps : MapPair, optional
        The dense maps of the match, if it has any.
    left_out : collection of int
        Numbers, from 0, of points that get no vertex groups.

    Returns
    -------
    source, target : Content
        What to write on each.
    """
    prepared = (Content(), Content())
    if kinds.vertex_groups:
        for content, points in zip(prepared, (result.source_points, result.target_points), strict=True):
            content.groups.update(_groups(points, prefix, left_out))
    if maps is not None:
        yield from _add_mapped_steps(prepared, maps, prefix, kinds)
    elif result.source_distances is not None and result.target_distances is not None:
        _add_spread(prepared, result, (result.source_distances, result.target_distances), prefix, kinds)
    return prepared


def _add_mapped_steps(prepared: tuple[Content, Content], maps: MapPair, prefix: str, kinds: Written) -> Steps[None]:
    """Add what dense maps tell of every vertex."""
    yield Progress(0.0, _LABEL)
    if kinds.match_colors:
        own = colors.match_colors(maps.source.vertices, maps.source.vertex_areas)
        for content, shown in zip(prepared, (own, maps.target_to_source.transfer(own)), strict=True):
            content.colors[f"{prefix} Match"] = colors.opaque(colors.to_linear(shown))
    for number, (content, sides) in enumerate(zip(prepared, (maps, maps.reverse), strict=True)):
        yield Progress((1 + number) / 3, _LABEL)
        if kinds.distortion:
            stretch = vertex_stretch(sides.source_to_target, sides.source, sides.target)
            yield Progress((1.5 + number) / 3, _LABEL)
            _add_distortion(content, prefix, stretch, DOUBLED)
        if kinds.confidence:
            shades = colors.confidence_colors(sides.source_to_target.confidence)
            content.colors[f"{prefix} Confidence"] = colors.opaque(colors.to_linear(shades))
    if kinds.vertex_groups and not (
        maps.source_to_target.has_partner.all() and maps.target_to_source.has_partner.all()
    ):
        for content, found in zip(prepared, (maps.source_to_target, maps.target_to_source), strict=True):
            shared = np.flatnonzero(found.has_partner)
            content.groups[f"{prefix} Overlap"] = shared, np.ones(len(shared))


def _add_spread(
    prepared: tuple[Content, Content],
    result: MatchResult | Restored,
    rows: tuple[NDArray[np.float64], NDArray[np.float64]],
    prefix: str,
    kinds: Written,
) -> None:
    """Add what the matched points tell of the vertices around them, by their distances (k, n) and (k, m)."""
    if not (kinds.match_colors or kinds.distortion):
        return
    sides = (result.source_points, result.target_points)
    pairs = [distances[:, points.nearest_vertices] for points, distances in zip(sides, rows, strict=True)]
    reaches = colors.bandwidths(pairs[0], pairs[1])
    # Red, green, blue and the distortion of each point, (k, 4): spread in one go.
    shown = np.column_stack([colors.match_colors(result.source_points.positions), result.point_distortion])
    worst = float(result.point_distortion.max())
    for content, distances, reach in zip(prepared, rows, reaches, strict=True):
        mixed = colors.spread(shown, distances, reach)
        if kinds.match_colors:
            content.colors[f"{prefix} Match"] = colors.opaque(colors.to_linear(mixed[:, :3]))
        if kinds.distortion:
            _add_distortion(content, prefix, mixed[:, 3], worst)


def _add_distortion(content: Content, prefix: str, values: NDArray[np.float64], maximum: float) -> None:
    """Add values (n,), nan where there is none, as numbers and as colours; `maximum` is yellow."""
    shades = colors.to_linear(colors.distortion_colors(values, maximum))
    content.colors[f"{prefix} Distortion"] = colors.opaque(shades)
    content.values[f"{prefix} Distortion Value"] = np.where(np.isnan(values), UNREACHED, values)


def _groups(
    points: SurfacePoints, prefix: str, left_out: Collection[int] = ()
) -> dict[str, tuple[NDArray[np.int64], NDArray[np.float64]]]:
    """Name a vertex group for each point: its corners with a positive barycentric coordinate, weighted by it."""
    groups = {}
    for number, (corners, weights) in enumerate(zip(points.corners, points.barycentric, strict=True), start=1):
        if number - 1 in left_out:
            continue
        positive = weights > 0
        groups[f"{prefix}.{number:03d}"] = (corners[positive], weights[positive])
    return groups
