# SPDX-License-Identifier: GPL-3.0-or-later
"""Offsets of vertices, as shape keys hold them, carried from one surface to another in another pose."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array
from scipy.sparse.csgraph import connected_components

from ...geometry.laplacian import laplace_beltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, marked
from ...runtime.background import can_go_beside
from ...runtime.errors import MatchError, SettingsError
from ...runtime.progress import Progress, Steps
from .deformation_gradients import LocalFrames

Scaling = Literal["auto", "none", "overall", "local"]
"""How lengths of offsets change: as the whole surface has grown if the two are of clearly different sizes, and as the
unit of length does if they are not, but one is in metres and the other in centimetres; not at all; as the whole has
grown in any case; or as the surface has around each vertex."""

_SAME_SIZE = 1.25
"""Up to this factor two surfaces count as bodies of one size, on which a smile is as wide, in units that are the same
or a power of ten apart: for `auto`."""

_LEAST_CONFIDENCE = 0.02
"""Below it, a place is taken from its neighbours: only what is surely wrong, because that blurs the offsets."""


@can_go_beside
def carry_offsets_steps(
    offsets: ArrayLike,
    frames: LocalFrames,
    target: TriangleMesh,
    target_to_source: SurfaceMap,
    *,
    scaling: Scaling = "auto",
    threshold: float = 0.001,
) -> Steps[Floats]:
    """Carry offsets at the vertices of the source to those of the target.

    At each vertex of the source an offset is turned as the surface is there, so that a smile follows a turned head.
    Turned offsets are interpolated inside the triangles of the source.  Where the map cannot be trusted at all, they
    are continued from the surroundings on the target: harmonically, in the manner of a soap film.
    Vertices at a seam that the target was cut open at, as for UVs, are one point and move alike.

    Parameters
    ----------
    offsets : (k, n_x, 3) array_like of float
        For each key, by how much each vertex of the source moves.
    frames : LocalFrames
        What the source goes through on its way to the target, at each of its vertices.
    target : TriangleMesh
        The target.
    target_to_source : SurfaceMap
        Where each vertex of the target lies on the source.
    scaling : {"auto", "none", "overall", "local"}
        What becomes of the length of offsets.
    threshold : float
        As a part of the largest offset of a key: shorter ones become exactly zero.

    Yields
    ------
    Progress
        After each key.

    Returns
    -------
    (k, n_y, 3) array of float
        By how much each vertex of the target moves.

    Raises
    ------
    MatchError
        If offsets, frames and maps do not belong to the same two surfaces, or an offset is not a finite number.
    SettingsError
        If there is no such scaling.
    """
    array = np.asarray(offsets, np.float64)
    _check(array, frames, target, target_to_source)
    yield Progress(0.0, "Finding regions without confidence")
    fill = _Filling(target, target_to_source.confidence >= _LEAST_CONFIDENCE)
    factors = _factors(frames, scaling)
    parts = WeldedParts.of(target)
    carried = np.zeros((len(array), target.vertex_count, 3))
    for number, key in enumerate(array):
        moved = fill(target_to_source.transfer(factors[:, None] * frames.turned(key)))
        if parts.seams:
            moved = (parts.means @ moved)[parts.welded]
        lengths = np.linalg.norm(moved, axis=1)
        least = threshold * float((factors * np.linalg.norm(key, axis=1)).max(initial=0.0))
        carried[number] = np.where((lengths > least)[:, None], moved, 0.0)
        yield Progress((number + 1) / len(array), "Carrying offsets")
    return carried


def _check(offsets: Floats, frames: LocalFrames, target: TriangleMesh, target_to_source: SurfaceMap) -> None:
    """Make sure that all belong together."""
    count = target_to_source.image_vertex_count
    if offsets.ndim != 3 or offsets.shape[1:] != (count, 3):
        raise MatchError(
            f"Offsets should have the shape (k, {count}, 3), one for each vertex that the map leads to, "
            f"but have {offsets.shape}."
        )
    if len(frames) != count or len(target_to_source) != target.vertex_count:
        raise MatchError(
            f"There are {len(frames)} local frames for {count} vertices, and a map of {len(target_to_source)} vertices "
            f"for a mesh of {target.vertex_count}: they do not belong together."
        )
    if not np.isfinite(offsets).all():
        raise MatchError("A shape key of the source moves a vertex by what is not a finite number. Repair that key.")


def _factors(frames: LocalFrames, scaling: Scaling) -> Floats:
    """By what to multiply the offset of each vertex, (n_x,)."""
    if scaling not in get_args(Scaling):
        raise SettingsError(f'Offsets cannot be scaled by "{scaling}", but by {", ".join(get_args(Scaling))}.')
    if scaling == "local":
        return frames.scales
    if scaling == "none":
        return np.ones(len(frames))
    unit = 10.0 ** np.round(np.log10(np.maximum(frames.overall, TINY)))
    same = scaling == "auto" and 1 / _SAME_SIZE <= frames.overall / unit <= _SAME_SIZE
    return np.full(len(frames), unit if same else frames.overall)


class _Filling:
    """Replaces values at vertices of a mesh that are not known by the harmonic continuation of those around.

    Parts of the surface of which nothing is known are left as they are.
    """

    def __init__(self, mesh: TriangleMesh, known: Bools) -> None:
        self._unknown = np.zeros(0, np.int64)
        if known.all():
            return
        stiffness = laplace_beltrami(mesh).stiffness
        labels = connected_components(stiffness, directed=False)[1]
        reachable = marked(labels[known], labels.max() + 1)
        self._known = np.flatnonzero(known)
        self._unknown = np.flatnonzero(~known & reachable[labels])
        rows = stiffness[self._unknown]
        self._boundary = rows[:, self._known]
        inner = csc_array(rows[:, self._unknown])
        # Some vertices may hang on by edges without weight only: a little of what they have holds them.
        weights = np.abs(inner.diagonal())
        self._held = np.full(len(weights), 1e-9 * np.maximum(weights.mean(), TINY) if len(weights) else 0.0)
        if len(weights):
            inner.setdiag(inner.diagonal() + self._held)
            self._factor = symmetric_factor(inner)

    def __call__(self, values: Floats) -> Floats:
        """Fill values (n, d)."""
        if not len(self._unknown):
            return values
        filled = values.copy()
        right = self._held[:, None] * values[self._unknown] - self._boundary @ values[self._known]
        filled[self._unknown] = self._factor.solve(right)
        return filled
