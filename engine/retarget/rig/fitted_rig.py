# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig fitted into another body: what its bones do to the source so that it becomes the target."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ...mesh.surface_map import SurfaceMap
from ...runtime.arrays import Floats
from .skeleton import Skeleton


@dataclass(frozen=True, eq=False)
class FittedRig:
    """A skeleton with the transforms that pose and scale the source's body as the target's.

    Attributes
    ----------
    skeleton : Skeleton
        The source's bones, b, in the space of the source.
    weights : (n_x, b) csr_array of float
        How much each bone moves each vertex of the source; rows sum to one, or are empty.
    linear : (b, 3, 3) array of float
        Linear part of each bone's transform from the source's space into the target's: rotation, scale, some shear.
    translations : (b, 3) array of float
        Its translation.
    rotations : (b, 3, 3) array of float
        The rotation nearest to `linear`; the reflection nearest to it if the map takes the source to its mirror image.
    scales : (b,) array of float
        Its mean scale.
    posed : (n_x, 3) array of float
        The source's vertices, moved by the bones alone.
    registered : (n_x, 3) array of float
        The source's vertices, laid onto the target.
    source_to_target, target_to_source : SurfaceMap
        The maps between the meshes; better ones than without the rig, if they were refined.
    """

    skeleton: Skeleton
    weights: csr_array
    linear: Floats
    translations: Floats
    rotations: Floats
    scales: Floats
    posed: Floats
    registered: Floats
    source_to_target: SurfaceMap
    target_to_source: SurfaceMap

    def __repr__(self) -> str:
        return f"<FittedRig: {len(self.scales)} bones, {len(self.posed)} vertices>"

    @property
    def handedness(self) -> float:
        """-1 if the source comes to lie as if seen in a mirror, its left side on the right, else 1."""
        return -1.0 if (np.linalg.det(self.rotations) < 0).any() else 1.0

    @property
    def heads(self) -> Floats:
        """Where the heads of the bones lie in the target, (b, 3)."""
        return self._placed(self.skeleton.heads)

    @property
    def tails(self) -> Floats:
        """Where their tails lie, (b, 3)."""
        return self._placed(self.skeleton.tails)

    def _placed(self, points: Floats) -> Floats:
        """Move one point (b, 3) with each bone."""
        return np.einsum("bij,bj->bi", self.linear, points) + self.translations
