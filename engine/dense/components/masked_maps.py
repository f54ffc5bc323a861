# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps that were made with only a piece of a surface: what they say of the rest, and which piece that was."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar, Protocol, TypeVar

from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Ints
from ..quality import MatchQuality, of_covered_part


class _HasMaps(Protocol):
    """A dataclass with the maps of a match, such as `DenseMatch`."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def source_to_target(self) -> SurfaceMap | None:
        """The map from the source."""

    @property
    def target_to_source(self) -> SurfaceMap | None:
        """The map from the target."""

    @property
    def quality(self) -> MatchQuality | None:
        """How far they can be trusted."""


Maps = TypeVar("Maps", bound=_HasMaps)

_LEAST_LEFT = 0.1
"""Part of a surface without a partner from which on it is left out: less does little harm, and may be a mistake."""


def with_piece_only(maps: Maps, covered: Bools, share: float, *, of_source: bool) -> Maps:
    """Say of maps what was left out when they were made.

    Parameters
    ----------
    maps : DenseMatch or MatchResult
        Maps between all vertices.
    covered : (n,) array of bool
        Which vertices of the original source, or of the target, took part.
    share : float
        What part of the area they have.
    of_source : bool
        Whether they are of the source.

    Returns
    -------
    DenseMatch or MatchResult
        The maps without confidence at all other vertices, which count as not covered.
    """
    there, back, quality = maps.source_to_target, maps.target_to_source, maps.quality
    if there is None or back is None or quality is None:
        return maps
    quality = of_covered_part(quality, share, of_source=of_source)
    if of_source:
        there = replace(there, has_partner=there.has_partner & covered)
    else:
        back = replace(back, has_partner=back.has_partner & covered)
    return replace(maps, source_to_target=there, target_to_source=back, quality=quality)


def piece_of(mesh: TriangleMesh, found: SurfaceMap | None, needed: Ints) -> Bools | None:
    """Tell which vertices of a mesh (n,) have a partner by an earlier map.

    Parameters
    ----------
    mesh : TriangleMesh
        The original mesh.
    found : SurfaceMap or None
        The map from it, with confidence zero also where it has no partner.
    needed : (k,) array of int
        Vertices that have to be among them, as far as there are such.

    Returns
    -------
    (n,) array of bool or None
        None if nearly all have one, if nothing is known, or if needed ones have none.
    """
    if found is None:
        return None
    covered = found.has_partner & (found.confidence > 0)
    existing = needed[(needed >= 0) & (needed < len(covered))]
    if not covered[existing].all() or share_of(mesh, covered) > 1 - _LEAST_LEFT:
        return None
    return covered


def with_pieces_only(
    maps: Maps, meshes: tuple[TriangleMesh, TriangleMesh], pieces: tuple[Bools | None, Bools | None]
) -> Maps:
    """Say of maps what was left out of either mesh, see `with_piece_only`; of None nothing was."""
    for mesh, covered, of_source in zip(meshes, pieces, (True, False), strict=True):
        if covered is not None:
            maps = with_piece_only(maps, covered, share_of(mesh, covered), of_source=of_source)
    return maps


def share_of(mesh: TriangleMesh, covered: Bools) -> float:
    """Say what part of the area of a mesh some of its vertices, (n,), have."""
    return float(mesh.vertex_areas @ covered / mesh.vertex_areas.sum())
