# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays from a file that anybody may have made: given out only if they are what they should be."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .stored_match import CornerPoints
from .vertex_maps import StoredMaps, VertexMap

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

MAPS = ("source_to_target", "target_to_source")
"""What the names of the arrays of the two dense maps start with."""


class CheckedArrays:
    """Arrays that may be anything, given out only if they are what they should be."""

    def __init__(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        self._arrays = arrays

    def numbers(self, name: str, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """Return finite numbers; a length of -1 may be any."""
        array = self._shaped(name, shape)
        if not (np.issubdtype(array.dtype, np.number) and np.isrealobj(array)):
            raise ValueError(f"{name} are no numbers")
        numbers = array.astype(np.float64)
        if not np.isfinite(numbers).all():
            raise ValueError(f"{name} are not finite")
        return numbers

    def corners(self, name: str, count: int, vertices: int) -> NDArray[np.int64]:
        """Return three numbers of vertices for each of so many places."""
        array = self._shaped(name, (count, 3))
        if array.size and not np.issubdtype(array.dtype, np.integer):
            raise ValueError(f"{name} are no whole numbers")
        if array.size and not (array.min() >= 0 and array.max() < vertices):
            raise ValueError(f"{name} name vertices that the mesh does not have")
        return array.astype(np.int64)

    def points(self, name: str, vertices: int) -> CornerPoints:
        """Return points on a mesh with so many vertices."""
        corners = self.corners(f"{name}_corners", -1, vertices)
        return CornerPoints(corners, self._barycentric(f"{name}_barycentric", len(corners)))

    def maps(self, start: str, counts: tuple[int, int]) -> StoredMaps | None:
        """Return both dense maps of one answer, if they are there."""
        if f"{start}{MAPS[0]}_corners" not in self._arrays:
            return None
        one = self._map(f"{start}{MAPS[0]}", counts[0], counts[1])
        return StoredMaps(one, self._map(f"{start}{MAPS[1]}", counts[1], counts[0]))

    def _map(self, name: str, count: int, vertices: int) -> VertexMap:
        corners = self.corners(f"{name}_corners", count, vertices)
        weights = self._barycentric(f"{name}_weights", count)
        confidence = self.numbers(f"{name}_confidence", (count,))
        if ((confidence < 0) | (confidence > 1)).any():
            raise ValueError(f"{name}_confidence is not between 0 and 1")
        has_partner = np.ones(count, bool)
        if f"{name}_partner" in self._arrays:  # which there is if some have none
            has_partner = self.numbers(f"{name}_partner", (count,)) != 0
        return VertexMap(
            corners.astype(np.int32), weights.astype(np.float32), confidence.astype(np.float32), has_partner
        )

    def _barycentric(self, name: str, count: int) -> NDArray[np.float64]:
        weights = self.numbers(name, (count, 3))
        if (weights < 0).any() or (np.abs(weights.sum(axis=1) - 1) > 1e-4).any():
            raise ValueError(f"{name} are not positive numbers that sum to one")
        return weights

    def _shaped(self, name: str, shape: tuple[int, ...]) -> NDArray[Any]:
        if name not in self._arrays:
            raise ValueError(f"{name} is missing")
        array = self._arrays[name]
        if array.size == 0 and shape[0] <= 0:
            array = array.reshape((0, *shape[1:]))
        if array.ndim != len(shape) or any(want not in (-1, is_) for want, is_ in zip(shape, array.shape, strict=True)):
            raise ValueError(f"{name} has the wrong shape {array.shape}")
        return array
