# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformation gradients: rotation and scale of a deformation around each vertex, for directions on the surface."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import SuperLU
from scipy.spatial import cKDTree

from ...geometry.laplacian import laplace_beltrami
from ...geometry.procrustes import nearest_orthogonal
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Floats, Ints, spread_rows, weighted_quantile
from ...runtime.errors import MeshError
from ..rig.fitted_rig import FittedRig
from ..weights.skin_weights import row_sums

_RADIUS = 0.1
"""Over what distance Jacobians are averaged, in sqrt(area): about the size of a face, which turns as a whole."""

_WIDE, _ALIKE = 0.2, 0.1
"""Over what distance, in sqrt(area), rotations are evened out, and by how much (as the norm of the difference of the
matrices, about 4 degrees) they may differ: a head that is built otherwise turns a cheek by three degrees and a brow by
as much the other way, which is no motion.  Errors of keys on three heads of another build were 0.056, 0.061 and 0.072
without, and are 0.047, 0.050 and 0.062; with 0.3 they are the same, but those of a walking body grow by a third."""

_MOST_ROTATIONS = 64
"""How many rotations at most stand for all others while they are evened out."""

_LARGEST_STRETCH = 4.0
"""By what factor the scale may differ from the mean: more is a place where the map has collapsed or is torn."""

_SMALL, _NEAR = 0.02, 0.02
"""Pieces up to this part of the area, of which on the mean no place is so far from the rest, in sqrt(area), turn as
what they lie on does: they have no surroundings of their own to average over."""

_ROOTED = 0.2
"""How much farther from what it lies on than the nearest one, in radii of their piece, vertices are that belong to its
root."""

_MOST_AREA = 3.0
"""How much more than at the median the area of a mapped triangle may count, per area of its own."""


@dataclass(frozen=True, eq=False)
class LocalFrames:
    """A rotation and a scale at each vertex of a surface.

    Attributes
    ----------
    rotations : (n, 3, 3) array of float
        Orthogonal matrices; reflections if the deformation mirrors the surface.
    scales : (n,) array of float
        How many times as long lengths become.
    overall : float
        How many times as long they become on the whole: root of the mean growth of areas.
    """

    rotations: Floats
    scales: Floats
    overall: float

    def __len__(self) -> int:
        return len(self.scales)

    def __repr__(self) -> str:
        return f"<LocalFrames: {len(self)} vertices, {self.overall:.3g} times as large>"

    def turned(self, vectors: Floats) -> Floats:
        """Turn vectors (..., n, 3), one for each vertex, without a change of length."""
        return np.einsum("nij,...nj->...ni", self.rotations, vectors)


def surface_frames(
    mesh: TriangleMesh, images: Floats, *, radius: float = _RADIUS, mirrored: bool = False
) -> LocalFrames:
    r"""Find what a deformation does to a surface from positions before and after.

    The Jacobian of each triangle maps its sides to those of the deformed one, and its normal, which is as long as its
    sides are on average, to that of the other.  Jacobians are averaged by area over a neighbourhood, with the weights
    of heat that has spread from the vertex, and the rotation is the orthogonal factor of their polar decomposition.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    images : (n, 3) array of float
        Where its vertices are after the deformation.
    radius : float
        How far heat spreads, in sqrt(area).
    mirrored : bool
        Whether the deformation turns the surface over, as a map to the mirror image does: the normals of the deformed
        triangles are then on their other side, and the rotations are reflections.

    Returns
    -------
    LocalFrames
        For each vertex; where it has no triangle, the mean of the whole surface.

    Raises
    ------
    MeshError
        If there is not one finite position for each vertex.
    """
    if images.shape != mesh.vertices.shape or not np.isfinite(images).all():
        raise MeshError(
            f"The deformed surface needs one finite position for each of the {mesh.vertex_count} vertices, "
            f"but got an array of the shape {images.shape}."
        )
    before = _sides(mesh.vertices, mesh.triangles, 1.0)
    after = _sides(images, mesh.triangles, -1.0 if mirrored else 1.0)
    # The transpose of the Jacobian times the area: large triangles count more, and needles are no division by zero.
    areas = np.maximum(mesh.triangle_areas, TINY)
    jacobians = after @ np.linalg.pinv(before)  # (m, 3, 3)
    grown = np.linalg.norm(np.cross(after[:, :, 0], after[:, :, 1]), axis=1) / (2 * areas)
    grown = np.minimum(grown, _MOST_AREA * np.maximum(weighted_quantile(grown, areas), TINY))
    stretches, overall = np.sqrt(grown), float(np.sqrt(areas @ grown / areas.sum()))
    columns = np.concatenate([jacobians.reshape(-1, 9), stretches[:, None]], axis=1) * areas[:, None]
    sums = np.stack([mesh.sum_at_vertices(column) for column in (columns / 3).T], axis=1)
    spread = _spread(mesh, sums, radius)[bearers(mesh)]
    rotations = nearest_orthogonal(spread[:, :9].reshape(-1, 3, 3), -1.0 if mirrored else 1.0)
    return LocalFrames(rotations, _bounded(spread[:, 9]), overall)


def bone_frames(rig: FittedRig, otherwise: LocalFrames) -> LocalFrames:
    """Blend the rotations and scales of the bones of a fitted rig, as they move each vertex of the source.

    Parameters
    ----------
    rig : FittedRig
        The rig.
    otherwise : LocalFrames
        What holds for vertices that no bone moves, (n_x,).

    Returns
    -------
    LocalFrames
        For each vertex of the source.

    Raises
    ------
    MeshError
        If the rig belongs to another surface.
    """
    weights = rig.weights
    if weights.shape[0] != len(otherwise):
        raise MeshError(f"The rig moves {weights.shape[0]} vertices, but the surface has {len(otherwise)}.")
    total = row_sums(weights)
    moved = total > 0
    blended = (weights @ rig.rotations.reshape(-1, 9)).reshape(-1, 3, 3)
    scales = np.divide(weights @ rig.scales, total, out=otherwise.scales.copy(), where=moved)
    rotations = np.where(moved[:, None, None], nearest_orthogonal(blended, rig.handedness), otherwise.rotations)
    return LocalFrames(rotations, scales, otherwise.overall)


def evened_frames(mesh: TriangleMesh, frames: LocalFrames) -> LocalFrames:
    r"""Even out rotations over what turns alike, such as a head, and not across a joint that bends.

    A bilateral filter [1]_: rotations of the neighbourhood count by the heat that comes from there, times
    :math:`\exp(-d^2/2s^2)` for rotations that differ by :math:`d`.  Heat spreads at once from all places that are
    turned much like one of a few rotations, and each place takes most from those that are like its own [2]_.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    frames : LocalFrames
        Its frames, as by `surface_frames`.

    Returns
    -------
    LocalFrames
        With other rotations, and the same scales.

    References
    ----------
    .. [1] C. Tomasi, R. Manduchi, "Bilateral filtering for gray and color images", ICCV 1998.
    .. [2] F. Durand, J. Dorsey, "Fast bilateral filtering for the display of high-dynamic-range images", SIGGRAPH 2002.
    """
    flat = frames.rotations.reshape(-1, 9)
    spread = _spreader(mesh, _WIDE)
    columns = np.concatenate([flat, np.ones((len(flat), 1))], axis=1) * mesh.vertex_areas[:, None]
    sums = 1e-9 * np.concatenate([flat, np.ones((len(flat), 1))], axis=1)  # its own, where nothing is around
    # Each is the farthest from those before, so that all others are like one of them.
    for chosen in spread_rows(flat, 0, _MOST_ROTATIONS, _ALIKE):
        alike = np.exp(-np.square(flat - flat[chosen]).sum(axis=1) / (2 * _ALIKE**2))[:, None]
        sums += alike * spread.solve(alike * columns)
    evened = (sums[:, :9] / sums[:, 9:])[bearers(mesh)].reshape(-1, 3, 3)
    return replace(frames, rotations=nearest_orthogonal(evened, float(np.sign(np.linalg.det(frames.rotations[0])))))


def bearers(mesh: TriangleMesh) -> Ints:
    """For each vertex of a small piece, such as a lash, that of what it lies on which its root is nearest to, (n,).

    The root is the nearest part of the piece: tips of lashes may be near to the fold above the lid.  For all other
    vertices themselves.
    """
    bearers = np.arange(mesh.vertex_count)
    parts = WeldedParts.of(mesh)
    if parts.part_count == 1:
        return bearers
    labels = parts.vertex_labels
    small = np.bincount(labels, mesh.vertex_areas, parts.part_count) <= _SMALL * mesh.area
    on_small = small[labels]
    if on_small.all():
        return bearers
    chosen, rest = np.flatnonzero(on_small), np.flatnonzero(~on_small)
    distances, nearest = cKDTree(mesh.vertices[rest]).query(mesh.vertices[chosen])
    counts = np.bincount(labels[chosen], minlength=parts.part_count)
    away = np.bincount(labels[chosen], distances, parts.part_count) / np.maximum(counts, 1)
    for part in np.flatnonzero((counts > 0) & (away <= _NEAR * np.sqrt(mesh.area))):
        own = np.flatnonzero(labels[chosen] == part)
        places = mesh.vertices[chosen[own]]
        radius = np.sqrt(np.square(places - places.mean(axis=0)).sum(axis=1).mean())
        rooted = own[distances[own] <= distances[own].min() + _ROOTED * radius]
        roots = rooted[cKDTree(mesh.vertices[chosen[rooted]]).query(places)[1]]
        bearers[chosen[own]] = rest[nearest[roots]]
    return bearers


def _sides(points: Floats, triangles: Ints, side: float) -> Floats:
    """Two sides of each triangle and a normal of the length of a mean side, as columns, (m, 3, 3)."""
    a, b, c = (points[corner] for corner in triangles.T)
    first, second = b - a, c - a
    normal = np.cross(first, second)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = side * normal / np.sqrt(np.maximum(length, TINY))
    return np.stack([first, second, normal], axis=2)


def _spread(mesh: TriangleMesh, sums: Floats, radius: float) -> Floats:
    """Let integrals over the vertices' areas (n, k) spread like heat, and divide them by the area that they come from.

    A vertex that no heat reaches, without a triangle, gets the mean.
    """
    heat = _spreader(mesh, radius).solve(np.concatenate([sums, mesh.vertex_areas[:, None]], axis=1))
    mean = sums.sum(axis=0) / mesh.area
    reached = heat[:, -1:] > 0
    return np.where(reached, heat[:, :-1] / np.where(reached, heat[:, -1:], 1), mean)


def _spreader(mesh: TriangleMesh, radius: float) -> SuperLU:
    """Let integrals over the vertices' areas spread like heat over a distance in sqrt(area)."""
    laplace = laplace_beltrami(mesh)
    # A length r is the root mean square way of heat after the time r^2 / 4, in the plane.
    time = radius**2 * mesh.area / 4
    return symmetric_factor(diags_array(laplace.mass + (laplace.mass <= 0)) + time * laplace.stiffness)


def _bounded(scales: Floats) -> Floats:
    """Bound scales (n,) around their middle."""
    middle = float(np.maximum(np.median(scales), TINY))
    return scales.clip(middle / _LARGEST_STRETCH, middle * _LARGEST_STRETCH)
