# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs at the corners of faces, carried from one mesh to another so that islands stay islands and seams stay seams."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...mesh.polygons import Polygons
from ...runtime.arrays import Bools, Floats, Ints, marked
from ...runtime.background import can_go_beside
from ...runtime.errors import MatchError
from ...runtime.progress import Progress, Steps
from .charts import CornerSheets, cut_into_sheets
from .corner_welding import jumps, weld
from .face_correspondence import CornerPlaces, FacePlaces
from .stray_faces import splinters, teeth

_SAME = 1e-5
"""UVs that differ by less than this part of the extent of the layer are the same; Blender's own rule for a layer that
fills the unit square is ten times as generous."""

_MOST_STRETCH = 3.0
"""A corner near a border that is so many times as far from the centre of its face as it would be by what the layer does
around that, and on the whole, has come there by a detour."""

_ROUNDING = 1e-7
"""Rounding of coordinates of single precision, as a part of them."""

_ROUNDS = 3
"""How often stray faces are moved at most: some lie beside others."""

_LEAST_CONFIDENCE = 0.1
"""Below it, a place on the target has no trustworthy counterpart."""

_FEW = 4.0
"""Faces of the target, of mean size, that an island is larger than if it is missing there: smaller ones, such as single
faces with a color each, may lie between the faces of a target that has larger ones.  As many as meet at a corner."""


@dataclass(frozen=True, eq=False)
class CarriedUVs:
    """UVs of the faces of a target.

    Attributes
    ----------
    uvs : (l, 2) array of float
        For each corner.
    seams : (e,) array of bool
        Edges across which the UVs jump.
    island_count : int
        How many islands the source has.
    lost : int
        How many of them no face of the target lies on, though they are larger than some of its faces.
    untrusted : int
        How many of the others lie mostly where the map has no confidence.
    """

    uvs: Floats
    seams: Bools
    island_count: int
    lost: int
    untrusted: int

    def __repr__(self) -> str:
        return f"<CarriedUVs: {len(self.uvs)} corners, {self.lost} of {self.island_count} islands lost>"


@can_go_beside
def carry_uvs_steps(uvs: ArrayLike, source: Polygons, places: FacePlaces, areas: Floats) -> Steps[CarriedUVs]:
    """Carry UVs at the corners of the source's faces to those of the target's.

    The source is cut into its islands.  Each face of the target takes the island, and the place there, under its
    centre.  Corners whose own image cannot be reached from it without crossing a border are continued linearly from
    where the border is met.  Then corners that meet on the same island are welded.  Faces beside a seam that have come
    to lie away from the rest of their island, or reach into another, are moved to what is around them.

    Parameters
    ----------
    uvs : (l_x, 2) array_like of float
        UVs at the corners of the source.
    source : Polygons
        Faces of the source, cut as the image of `places` is.
    places : FacePlaces
        Where the faces of the target lie on the source.
    areas : (f,) array of float
        Areas of the target's faces.

    Yields
    ------
    Progress
        Between the parts of the work.

    Returns
    -------
    CarriedUVs
        The UVs.  The coordinates may lie anywhere: neither tiles nor overlapping islands mean anything special.

    Raises
    ------
    MatchError
        If there is not one pair of coordinates for each corner.
    MeshError
        If one is not a finite number.
    """
    array = np.asarray(uvs, np.float64)
    if array.shape != (source.corner_count, 2):
        raise MatchError(f"UVs should have the shape ({source.corner_count}, 2), but have {array.shape}.")
    yield Progress(0.0, "Cutting islands")
    tolerance = _SAME * float(np.ptp(array, axis=0).max(initial=0.0)) + _ROUNDING * float(
        np.abs(array).max(initial=0.0)
    )
    sheets = cut_into_sheets(places.image, source, array, tolerance)
    seats, corners = places.seats, None
    for number in range(_ROUNDS + 1):
        yield Progress(0.3 + 0.7 * number / (_ROUNDS + 1), "Laying faces onto islands")
        corners = places.on_sheets(sheets, seats, corners)
        carried = _laid_out(places, sheets, corners, tolerance)
        seams = jumps(carried, places.polygons, tolerance)
        stray, beside = _strays(seams, sheets, corners, places, areas)
        if not len(stray) or number == _ROUNDS:
            break
        seats = places.seated_beside(sheets, seats, stray, beside)
    islands = sheets.labels[seats.triangles]
    own = np.bincount(sheets.labels, places.image.triangle_areas, sheets.count) / places.image.area
    lost, untrusted = _misplaced(islands, own, places.confidence, areas)
    return CarriedUVs(carried, seams, sheets.count, lost, untrusted)


def _laid_out(places: FacePlaces, sheets: CornerSheets, corners: CornerPlaces, tolerance: float) -> Floats:
    """UVs (l, 2) of faces, whose corners have these places on islands."""
    seats = corners.seats
    carried = sheets.at(corners.triangles, corners.barycentric)
    beyond = np.flatnonzero(corners.is_beyond)
    carried[beyond] += sheets.beyond(corners.triangles[beyond], corners.barycentric[beyond], corners.offsets[beyond])
    known = ~corners.is_beyond
    # The way along an island to a place beside the face may lead around the end of a cut, as at the pole of a sphere.
    near = np.flatnonzero(corners.near_border)
    face = places.polygons.corner_faces[near]
    triangles, barycentric = seats.triangles[face], seats.barycentric[face]
    centres = sheets.at(triangles, barycentric)
    away = places.images[near] - seats.interpolate(places.image.triangles, places.image.vertices)[face]
    expected = sheets.beyond(triangles, barycentric, away)
    usual = np.maximum(np.linalg.norm(expected, axis=1), sheets.density * np.linalg.norm(away, axis=1))
    astray = np.linalg.norm(carried[near] - centres, axis=1) > _MOST_STRETCH * usual
    carried[near[astray]] = (centres + expected)[astray]
    known[near[astray]] = False
    return weld(carried, places.polygons, sheets.labels[seats.triangles], known, tolerance)


def _strays(
    seams: Bools, sheets: CornerSheets, corners: CornerPlaces, places: FacePlaces, areas: Floats
) -> tuple[Ints, Ints]:
    """Find faces that go better with a neighbour's island, and these neighbours, (k,) each."""
    polygons = places.polygons
    stray, beside = splinters(polygons, seams, sheets.labels[corners.seats.triangles], areas)
    straddling = marked(polygons.corner_faces[corners.is_beyond], polygons.face_count)
    ends = places.map.positions[polygons.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    tooth, next_to = teeth(polygons, seams, straddling, areas, lengths)
    fresh = ~np.isin(tooth, stray)
    return np.append(stray, tooth[fresh]), np.append(beside, next_to[fresh])


def _misplaced(islands: Ints, shares: Floats, confidence: Floats, areas: Floats) -> tuple[int, int]:
    """Count the islands (i,) that no face lies on, and of the others those without confidence, by the area of faces.

    Of the former the shares of the source's surface tell which are too small to count.
    """
    count = len(shares)
    covered = np.bincount(islands, areas, count)
    doubtful = np.bincount(islands, areas * (confidence < _LEAST_CONFIDENCE), count)
    used = np.bincount(islands, minlength=count) > 0
    lost = ~used & (shares * len(areas) > _FEW)
    return int(lost.sum()), int((used & (2 * doubtful > covered)).sum())
