# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay's points and lines between corresponding places, as plain arrays.

Nothing here knows the graphics card; all that it draws is computed here.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..storage.views.colors import distortion_colors, match_colors

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...engine import Preview

_POINT, _LANDMARK, _CHOSEN = 6.0, 9.0, 13.0
"""Widths of points, in pixels at normal interface scale."""

_THIN, _THICK = 1.0, 3.0
"""Widths of lines."""

_LINE_ALPHA = 0.55

_LABELLED = 40
"""So many matched points at most get their numbers, the first: thousands of texts take longer to draw than all else."""

_ON = (1.0, 0.35, 0.75, 1.0)
_OFF = (0.55, 0.55, 0.55, 1.0)
_SELECTED = (1.0, 1.0, 1.0, 1.0)
_PENDING = (1.0, 0.65, 0.1, 1.0)
"""Pink, grey, white and orange (sRGB): none of them is a color of `distortion_colors`."""


@dataclass(frozen=True, eq=False)
class Places:
    """Points on a mesh, by the vertices between which they lie.

    Attributes
    ----------
    corners : (k, 3) array of int
        Three vertices for each point.
    weights : (k, 3) array of float
        Barycentric coordinates between them.
    """

    corners: NDArray[np.int64]
    weights: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Marks:
    """Pairs of places in the world that correspond, k of them.

    Attributes
    ----------
    source, target : (k, 3) array of float
        Where they are.
    numbers : (k,) array of int
        What they are called.
    chosen : int
        The row of the one that is active; negative if there is none.
    """

    source: NDArray[np.float64]
    target: NDArray[np.float64]
    numbers: NDArray[np.int64]
    chosen: int = -1


@dataclass(frozen=True)
class Shown:
    """What of it is wanted.

    Attributes
    ----------
    points, lines, labels : bool
        Points on both meshes, the lines between them, and their numbers.
    """

    points: bool = True
    lines: bool = True
    labels: bool = False


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points of one width: positions (k, 3), sRGB colours with alpha (k, 4), and the width in pixels."""

    positions: NDArray[np.float32]
    colors: NDArray[np.float32]
    width: float

    @property
    def faint(self) -> NDArray[np.float32]:
        """The colours where a surface hides the points, (k, 4)."""
        return _buffer(self.colors * np.array([1, 1, 1, 0.25]))


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines of one width: both ends of one after the other (2k, 3), colours with alpha (2k, 4), and the width."""

    positions: NDArray[np.float32]
    colors: NDArray[np.float32]
    width: float


@dataclass(frozen=True)
class Label:
    """A text beside a place of the world (x, y, z), in a color with alpha."""

    text: str
    place: tuple[float, float, float]
    color: tuple[float, float, float, float]


_NONE = Marks(np.empty((0, 3)), np.empty((0, 3)), np.empty(0, np.int64))


@dataclass(frozen=True, eq=False)
class Drawing:
    """All that is drawn, in order: lines, then points, then labels; and the pairs whose points are drawn."""

    lines: tuple[Lines, ...] = ()
    points: tuple[PointCloud, ...] = ()
    labels: tuple[Label, ...] = ()
    pairs: Marks = _NONE
    landmarks: Marks = _NONE
    distortion: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))


def preview_points(preview: Preview) -> PointCloud:
    """Show corresponding places of two surfaces in the same colour, that of the place on the source."""
    colors = _with_alpha(match_colors(preview.source), 1.0)
    both = np.concatenate([preview.source, preview.target])
    return PointCloud(_buffer(both), _buffer(np.concatenate([colors, colors])), _LANDMARK)


def place(positions: NDArray[np.float32], places: Places, matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Find where points of a mesh are in the world.

    Parameters
    ----------
    positions : (n, 3) array of float
        Vertices of the mesh, in the object's space.
    places : Places
        The points, k of them.
    matrix : (4, 4) array of float
        From the object's space to the world.

    Returns
    -------
    (k, 3) array of float
        Where they are; points of vertices that the mesh does not have are left at the origin of the object.
    """
    count = len(positions)
    known = ((places.corners >= 0) & (places.corners < count)).all(axis=1)
    corners = np.where(known[:, None], places.corners, 0)
    if count:
        local = np.einsum("kc,kcd->kd", places.weights, positions[corners].astype(np.float64))
    else:
        local = np.zeros((len(corners), 3))
    local[~known] = 0.0
    world: NDArray[np.float64] = local @ matrix[:3, :3].T + matrix[:3, 3]
    return world


def drawing(
    pairs: Marks,
    distortion: NDArray[np.float64],
    landmarks: Marks,
    used: NDArray[np.bool_],
    shown: Shown,
    *,
    pending: tuple[float, float, float] | None = None,
) -> Drawing:
    """Compute what is drawn.

    Parameters
    ----------
    pairs : Marks
        The matched points.
    distortion : (k,) array of float
        Distortion of each: from dark blue, none, to yellow, the worst of them.
    landmarks : Marks
        The landmarks.
    used : (l,) array of bool
        Which of them are on.
    shown : Shown
        What is wanted.  Landmarks are always drawn.
    pending : tuple of float, optional
        A place that waits for its partner.

    Returns
    -------
    Drawing
        The same for every viewport.
    """
    worst = float(distortion.max()) if len(distortion) else 0.0
    shades = _with_alpha(distortion_colors(distortion, worst), 1.0)
    marks = np.where(used[:, None], np.array(_ON), np.array(_OFF))
    lines, points, labels = [], [], []
    if shown.lines:
        lines.append(_lines(pairs, shades, _THIN))
        lines.append(_lines(landmarks, marks, _THIN))
        lines += [_lines(_row(group), _one(_SELECTED), _THICK) for group in (pairs, landmarks) if group.chosen >= 0]
    if shown.points:
        points.append(_points(pairs, shades, _POINT))
    points.append(_points(landmarks, marks, _LANDMARK))
    if shown.points and pairs.chosen >= 0:
        points += _ringed(pairs, shades)
    if landmarks.chosen >= 0:
        points += _ringed(landmarks, marks)
    if pending is not None:
        points.append(PointCloud(_buffer(np.array([pending])), _buffer(_one(_PENDING)), _CHOSEN))
    if shown.labels:
        labels += _labels(_first(pairs), "", _SELECTED) if shown.points else []
        labels += _labels(landmarks, "L", _ON)
    return Drawing(
        tuple(group for group in lines if len(group.positions)),
        tuple(group for group in points if len(group.positions)),
        tuple(labels),
        pairs if shown.points else _NONE,
        landmarks,
        distortion,
    )


def project(
    places: NDArray[np.float64], perspective: NDArray[np.float64], size: tuple[int, int]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Find where places of the world (k, 3) are in a viewport.

    Parameters
    ----------
    places : (k, 3) array of float
        Places.
    perspective : (4, 4) array of float
        The viewport's perspective matrix, to normalised coordinates.
    size : (int, int)
        Width and height of the viewport in pixels.

    Returns
    -------
    pixels : (k, 2) array of float
        Where they are.
    visible : (k,) array of bool
        Which of them are inside of it and not behind the eye.
    """
    seen = np.column_stack([places, np.ones(len(places))]) @ perspective.T
    depth = seen[:, 3]
    ahead = depth > 1e-9
    flat = seen[:, :2] / np.where(ahead, depth, 1.0)[:, None]
    return (flat + 1) / 2 * np.array(size), ahead & (np.abs(flat) <= 1).all(axis=1)


def _row(marks: Marks) -> Marks:
    """Take the active pair alone."""
    chosen = slice(marks.chosen, marks.chosen + 1)
    return Marks(marks.source[chosen], marks.target[chosen], marks.numbers[chosen])


def _first(marks: Marks) -> Marks:
    """Take those that get numbers: the first, and the active one."""
    rows = np.arange(min(len(marks.numbers), _LABELLED))
    if marks.chosen >= len(rows):
        rows = np.append(rows, marks.chosen)
    return Marks(marks.source[rows], marks.target[rows], marks.numbers[rows])


def _one(color: tuple[float, float, float, float]) -> NDArray[np.float64]:
    return np.array([color])


def _with_alpha(colors: NDArray[np.float64], alpha: float) -> NDArray[np.float64]:
    return np.column_stack([colors, np.full(len(colors), alpha)])


def _points(marks: Marks, colors: NDArray[np.float64], width: float) -> PointCloud:
    positions = np.concatenate([marks.source, marks.target])
    return PointCloud(_buffer(positions), _buffer(np.concatenate([colors, colors])), width)


def _ringed(marks: Marks, colors: NDArray[np.float64]) -> list[PointCloud]:
    """Draw the active pair larger, with a ring around it."""
    row = _row(marks)
    return [_points(row, _one(_SELECTED), _CHOSEN), _points(row, colors[[marks.chosen]], _CHOSEN - 5)]


def _lines(marks: Marks, colors: NDArray[np.float64], width: float) -> Lines:
    ends = np.stack([marks.source, marks.target], axis=1).reshape(-1, 3)
    shades = np.repeat(_with_alpha(colors[:, :3], _LINE_ALPHA), 2, axis=0)
    return Lines(_buffer(ends), _buffer(shades), width)


def _buffer(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return numbers as graphics cards read them: row by row, of single precision."""
    return np.ascontiguousarray(values, np.float32)


def _labels(marks: Marks, before: str, color: tuple[float, float, float, float]) -> list[Label]:
    return [
        Label(f"{before}{number}", (x, y, z), color)
        for side in (marks.source, marks.target)
        for number, (x, y, z) in zip(marks.numbers.tolist(), side.tolist(), strict=True)
    ]
