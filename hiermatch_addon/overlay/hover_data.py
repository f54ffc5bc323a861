# SPDX-License-Identifier: GPL-3.0-or-later
"""The drawn pair under the mouse and its highlight, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .overlay_data import Drawing, project

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Hovered:
    """A pair that the mouse points at.

    Attributes
    ----------
    ends : (e, 3) array of float
        Where its places are on the screen, in pixels, with a third coordinate of zero: both, or the one that is not
        behind the eye.
    landmark : bool
        Whether it is a landmark.
    number : int
        What the pair is called.
    distortion : float or None
        Its distortion; None for a landmark.
    """

    ends: NDArray[np.float32]
    landmark: bool
    number: int
    distortion: float | None


def pointed_at(
    drawn: Drawing,
    perspective: NDArray[np.float64],
    size: tuple[int, int],
    mouse: tuple[float, float],
    reach: float,
) -> int:
    """Find the pair one of whose two places is nearest to the mouse on the screen.

    Parameters
    ----------
    drawn : Drawing
        What is drawn.
    perspective : (4, 4) array of float
        The viewport's perspective matrix.
    size : (int, int)
        Width and height of the viewport in pixels.
    mouse : (float, float)
        Where the mouse is in it.
    reach : float
        How far away from it, in pixels, a place may be.

    Returns
    -------
    int
        Row of the pair among the matched points and then the landmarks; -1 if none is so near.
    """
    source, target = _places(drawn)
    if not len(source):
        return -1
    pixels, visible = project(np.concatenate([source, target]), perspective, size)
    distances = np.where(visible, np.hypot(*(pixels - np.array(mouse)).T), np.inf)
    nearest = int(distances.argmin())
    return nearest % len(source) if distances[nearest] <= reach else -1


def hovered(drawn: Drawing, row: int, perspective: NDArray[np.float64], size: tuple[int, int]) -> Hovered | None:
    """Return what is drawn to show a row of `pointed_at`; None if there is none such any more."""
    source, target = _places(drawn)
    if not 0 <= row < len(source):
        return None
    ends = np.stack([source[row], target[row]])
    pixels, _ = project(ends, perspective, size)
    ahead = (np.column_stack([ends, np.ones(2)]) @ perspective.T)[:, 3] > 0
    flat = np.column_stack([pixels, np.zeros(2)]).astype(np.float32)[ahead]
    points = len(drawn.pairs.numbers)
    if row >= points:
        return Hovered(flat, True, int(drawn.landmarks.numbers[row - points]), None)  # noqa: FBT003 - its name is above
    return Hovered(flat, False, int(drawn.pairs.numbers[row]), float(drawn.distortion[row]))  # noqa: FBT003


def _places(drawn: Drawing) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where all pairs are on the source and on the target, (n, 3) each."""
    groups = (drawn.pairs, drawn.landmarks)
    return np.concatenate([group.source for group in groups]), np.concatenate([group.target for group in groups])
