# SPDX-License-Identifier: GPL-3.0-or-later
"""Making what a surface carries symmetric, in any pose and any meshing: one side is taken to the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, diags_array

from ...geometry.laplacian import laplace_beltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, Ints
from ...runtime.errors import MatchError
from .deformation_gradients import LocalFrames, surface_frames

_LEAST_CONFIDENCE = 0.02
"""Places where the map to the mirror image is trusted less keep what they have."""

_HINT = 1e4
"""How much a full hint counts against the smoothness of the sides, per area."""

_NOTHING = 1e-6
"""Sides smaller than this part of the largest are none: parts of the surface of which nothing is known."""


@dataclass(frozen=True, eq=False)
class Symmetriser:
    """Takes values from the good side of a surface to the other.

    Attributes
    ----------
    mirror : SurfaceMap
        For each vertex its mirror image on the same surface.
    own : (n,) array of float
        How much each vertex keeps of its own: 1 on the good side, 0 on the other, 1/2 in the middle.
    frames : LocalFrames
        The reflections that take surroundings to those of the mirror image, (n,).
    """

    mirror: SurfaceMap
    own: Floats
    frames: LocalFrames

    def __repr__(self) -> str:
        return f"<Symmetriser: {len(self.own)} vertices>"

    @classmethod
    def of(cls, mesh: TriangleMesh, mirror: SurfaceMap, hints: Floats) -> Symmetriser:
        """Tell the sides apart.

        Parameters
        ----------
        mesh : TriangleMesh
            The surface.
        mirror : SurfaceMap
            For each vertex its mirror image, see `symmetry_map`.
        hints : (n,) array of float
            Positive on the good side, negative on the other, zero or small where that is not known: a smooth function
            that changes its sign under the map is made of them.

        Raises
        ------
        MatchError
            If the map or the hints do not belong to the mesh, or the hints tell nothing.
        """
        n = mesh.vertex_count
        if len(mirror) != n or mirror.image_vertex_count != n or hints.shape != (n,):
            raise MatchError(
                f"A mesh of {n} vertices needs a map to itself and a hint at each vertex, but got a map of "
                f"{len(mirror)} vertices and hints of the shape {hints.shape}."
            )
        own = np.where(_sides(mesh, mirror, hints) >= 0, 1.0, 0.0)
        own[_in_the_middle(mesh, mirror)] = 0.5
        own[mirror.confidence < _LEAST_CONFIDENCE] = 1.0
        return cls(mirror, own, surface_frames(mesh, mirror.positions, mirrored=True))

    def values(self, values: Floats) -> Floats:
        """Make values (n, ...) at the vertices symmetric."""
        own = self.own.reshape(-1, *[1] * (values.ndim - 1))
        return own * values + (1 - own) * self.mirror.transfer(values)

    def weights(self, weights: csr_array, partners: Ints) -> csr_array:
        """Make weights symmetric.

        Parameters
        ----------
        weights : (n, g) csr_array of float
            How much each of g groups has of each vertex.
        partners : (g,) array of int
            The group on the other side for each group; itself if it is in the middle.

        Returns
        -------
        (n, g) csr_array of float
            The weights.
        """
        mirrored = csr_array(self.mirror.interpolation @ weights[:, partners])
        result = csr_array(diags_array(self.own) @ weights + diags_array(1 - self.own) @ mirrored)
        result.eliminate_zeros()
        return result

    def offsets(self, offsets: Floats, partners: Ints) -> Floats:
        """Make offsets (k, n, 3) of shape keys symmetric; `partners` (k,) are the keys of the other side."""
        own = self.own[:, None]
        mirrored = [self.mirrored_offsets(each) for each in offsets[partners]]
        return own * offsets + (1 - own) * np.reshape(mirrored, offsets.shape)

    def mirrored_offsets(self, offsets: Floats) -> Floats:
        """Take offsets (n, 3) of all vertices to the mirror images, both ways."""
        return self.mirror.transfer(self.frames.turned(offsets))


def _sides(mesh: TriangleMesh, mirror: SurfaceMap, hints: Floats) -> Floats:
    """Find a smooth function that is positive on the good side, negative on the other, zero if not known, (n,)."""
    odd = hints - mirror.transfer(hints)
    largest = float(np.abs(odd).max(initial=0.0))
    if not largest > 0:
        raise MatchError(
            "Nothing tells the two sides apart. Give the vertex groups names that end in .L and .R, or move the "
            "object's origin so that its X axis points to the left side."
        )
    odd = odd / largest
    laplace = laplace_beltrami(mesh)
    mass = np.maximum(laplace.mass / laplace.area, TINY)
    trust = _HINT * mass * np.abs(odd)
    hold = np.full(len(mass), 1e-9 * float(mass.mean()))  # for parts without any hint
    smooth = symmetric_factor(laplace.stiffness + diags_array(trust + hold)).solve(trust * odd)
    smooth = smooth - mirror.transfer(smooth)
    return np.where(np.abs(smooth) > _NOTHING * np.abs(smooth).max(), smooth, 0.0)


def _in_the_middle(mesh: TriangleMesh, mirror: SurfaceMap) -> Bools:
    """Tell which vertices are, up to an edge, their own mirror images, (n,)."""
    a, b = mesh.edges.T
    n = mesh.vertex_count
    vertices, images = np.arange(n), mirror.nearest_vertices
    keys = np.concatenate([a * n + b, b * n + a, vertices * (n + 1)])
    return np.isin(vertices * n + images, keys)
