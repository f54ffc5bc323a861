# SPDX-License-Identifier: GPL-3.0-or-later
"""Nearest similarities between points and nearest points, nearest rotations to many matrices, least rotations."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..runtime.arrays import TINY, Bools, Floats, Ints, slices, unit_vectors

_TURNS = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], np.float64)
"""No turn and the half turns around the axes: after one of them any rotation is less than 121 degrees from none."""

_REAL = 0.02
"""Square of a quaternion's real part from which on it is believed; with the right turn it is mostly 1/4 at least."""

_SEPARATE = 0.01
"""Product of the gaps between the largest eigenvalue and the others, for matrices of norm one, from which on its vector
is believed; 12.3 for rotations."""

_MOST_STEPS = 30
_STEP = 1e-14

_LEAST_SLOPE = 1e-10
"""Where two eigenvalues are the same, as for matrices of rank one, the slope vanishes with what is left to be found."""

_FEW = 100
"""Matrices up to which singular values, three microseconds each, are faster than the quaternions' many operations."""

_BLOCK = 4096
"""Matrices at once: what is computed from them stays in the cache."""


_FLAT = 1e-4
"""Part of the largest variance that points have along every axis at least: rounding decides below."""

_FEWEST = 4
"""Pairs of ends of limbs that are needed: three are in a plane, which does not tell front from back."""

_ALIKE = 0.8
"""Agreement of the ends of limbs, see `paired_points`, from which on bodies stand alike.  By prominent ends, a figure
with a large head and realistic persons have 0.90 to 0.93, persons among each other 0.99 and more, four-legged animals
0.79 to 0.98; an animal or a person and a bird, a fish or a spider have 0.76 at most, a person and a four-legged animal
less (18 characters, tried once).  By bones, people of six makers have 0.93 to 1.00, four-legged animals of three 0.84
to 0.95, a person and an animal 0.75 at most, a bird and a shark 0.82 (70 pairs, tried once)."""


def agreement_in_place(points: Floats, images: Floats, weights: Floats, *, half_turn: bool = False) -> float:
    """Say how well images lie in space as the points do, -1 to 1, if both are stretched to the same extent every way.

    Parameters
    ----------
    points, images : (n, 3) array of float
        The points, and where a map takes them.
    weights : (n,) array of float
        How much each counts.
    half_turn : bool
        Whether the points are turned halfway around before, about the axis that brings them nearest to the images.

    Returns
    -------
    float
        The mean correlation of the coordinates once either cloud has no correlation and unit variances: 1 if the map
        stretches along any axes, wherever to, -1/3 if it is a half turn.  It does not change if both are turned alike.
    """
    crossed = _correlations(points, images, weights)
    if half_turn:  # about an axis a it leaves twice a.T C a less the trace
        return float(2 * np.linalg.eigvalsh((crossed + crossed.T) / 2)[-1] - np.trace(crossed)) / 3
    return float(np.trace(crossed) / 3)


def mirrored_across(points: Floats, images: Floats, weights: Floats) -> Floats:
    """Find the direction, a unit vector (3,), in which images most nearly lie as the points do in a mirror.

    Parameters
    ----------
    points, images, weights
        As in `agreement_in_place`, which is the largest if the points are reflected in the plane across that direction.
    """
    crossed = _correlations(points, images, weights)
    return np.linalg.eigh((crossed + crossed.T) / 2)[1][:, 0]


def _correlations(points: Floats, images: Floats, weights: Floats) -> Floats:
    """Correlate coordinates of points and of images, (3, 3), once either have no correlation and unit variances."""
    shares = (weights / weights.sum())[:, None]
    here, there = points - (shares * points).sum(axis=0), images - (shares * images).sum(axis=0)
    return _unit_root(here.T @ (shares * here)) @ (here.T @ (shares * there)) @ _unit_root(there.T @ (shares * there))


def _unit_root(covariance: Floats) -> Floats:
    """Return the symmetric matrix that takes points of that covariance to such of unit covariance."""
    variances, axes = np.linalg.eigh(covariance)
    return (axes / np.sqrt(np.maximum(variances, max(_FLAT * variances[-1], TINY)))) @ axes.T


def paired_points(here: Floats, there: Floats) -> tuple[Ints, Ints, float]:
    """Pair points of two clouds so that they lie as near to each other as they can, in the sense of least squares.

    Parameters
    ----------
    here, there : (n, 3) and (m, 3) arrays of float
        The points of either cloud, from a common centre and in a common unit.

    Returns
    -------
    first, second : (k,) arrays of int
        The pairs, as many as the smaller cloud has points.
    agreement : float
        The correlation of both clouds, to which points without a partner add nothing: 1 if they are the same.
    """
    first, second = linear_sum_assignment(np.square(here[:, None] - there).sum(axis=2))
    total = float(np.square(here).sum() + np.square(there).sum())
    return first, second, 2 * float((here[first] * there[second]).sum()) / max(total, TINY)


def alike_points(turned: Iterable[Floats], there: Floats) -> Ints:
    """Pair the points of two clouds where both are alike, as the ends of limbs are of bodies that stand alike.

    Parameters
    ----------
    turned : iterable of (n, 3) arrays of float
        The points of one cloud, in each way in which it may be turned; see `paired_points`.
    there : (m, 3) array of float
        Those of the other.

    Returns
    -------
    (k, 2) array of int
        The pairs of the way that agrees best, four at least; none if the clouds are not alike.
    """
    first, second, agreement = max((paired_points(here, there) for here in turned), key=lambda pairs: pairs[2])
    pairs = np.column_stack([first, second])
    return pairs if len(pairs) >= _FEWEST and agreement >= _ALIKE else pairs[:0]


def in_unit_spread(points: Floats, weights: Floats) -> Floats:
    """Move points (n, 3) so that their mean is the origin and the mean square of the distance from it one, as weighed.

    There may be none.
    """
    shares = weights / max(float(weights.sum()), TINY)
    offsets = points - shares @ points
    return np.asarray(offsets / max(float(np.sqrt(shares @ np.square(offsets).sum(axis=1))), TINY))


def nearest_similarity(
    before: Floats, after: Floats, weights: Floats | None = None, scale: float | None = None
) -> tuple[Floats, Floats]:
    """Find the similarity that takes points nearest to others, in the sense of least squares.

    Parameters
    ----------
    before, after : (n, 3) array of float
        The points, and where they should go.
    weights : (n,) array of float, optional
        How much each counts; alike by default.
    scale : float, optional
        How many times as large they become, if that is known.

    Returns
    -------
    linear : (3, 3) array of float
        A rotation, never a reflection, times the scale.
    translation : (3,) array of float
        What is added then.
    """
    shares = np.full(len(before), 1 / len(before)) if weights is None else weights / weights.sum()
    here, there = shares @ before, shares @ after
    start, end = before - here, after - there
    left, stretch, right = np.linalg.svd((shares[:, None] * end).T @ start)
    sign = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right)) or 1.0])
    if scale is None:
        spread = float(shares @ np.square(start).sum(axis=1))
        scale = float(stretch @ sign) / spread if spread > 0 else 1.0
    linear: Floats = scale * ((left * sign) @ right)
    return linear, there - linear @ here


def nearest_rotations(matrices: Floats) -> Floats:
    r"""Find the nearest rotation to each matrix.

    The rotation R with the largest :math:`\mathrm{tr}(R^T F)` belongs to the unit quaternion that is the eigenvector of
    the largest eigenvalue of a symmetric 4 x 4 matrix made of F [1]_.  The eigenvalue is found by Newton's method, from
    above, in the characteristic polynomial, and its vector among the cofactors [2]_: many times as fast as
    decompositions into singular values.  Those are left for the few matrices to which two rotations are almost equally
    near.

    Parameters
    ----------
    matrices : (n, 3, 3) array of float
        The matrices F, for instance covariances of edges after and before a deformation.

    Returns
    -------
    (n, 3, 3) array of float
        Rotations, never reflections.

    References
    ----------
    .. [1] B. K. P. Horn, "Closed-form solution of absolute orientation using unit quaternions", JOSA A 4(4), 1987.
    .. [2] D. L. Theobald, "Rapid calculation of RMSDs using a quaternion-based characteristic polynomial", Acta
       Crystallographica A 61, 2005.
    """
    if len(matrices) <= _FEW:
        return _by_singular_values(matrices)
    rotations = np.empty(matrices.shape)
    for part in slices(len(matrices), _BLOCK):
        rotations[part] = _of_block(matrices[part])
    return rotations


def nearest_orthogonal(matrices: Floats, handedness: float) -> Floats:
    """Find the nearest rotations to matrices (n, 3, 3), or the nearest reflections if the handedness is -1, not 1."""
    return handedness * nearest_rotations(handedness * matrices)


def _of_block(matrices: Floats) -> Floats:
    """Nearest rotations: by quaternions, after the half turn that leaves least to turn, or where that fails exactly."""
    diagonals = np.einsum("nii->ni", matrices)
    turns = _TURNS[(diagonals @ _TURNS.T).argmax(axis=1)][:, :, None]
    rotations, sure = _by_quaternions(turns * matrices)
    rotations *= turns
    rest = np.flatnonzero(~sure)
    rotations[rest] = _by_singular_values(matrices[rest])
    return rotations


def _by_singular_values(matrices: Floats) -> Floats:
    """Nearest rotations to any matrices (n, 3, 3)."""
    left, _, right = np.linalg.svd(matrices)
    left[:, :, 2] *= np.sign(np.linalg.det(left @ right))[:, None]
    return left @ right


def _by_quaternions(matrices: Floats) -> tuple[Floats, Bools]:
    """Nearest rotations to matrices (n, 3, 3), and which of them can be believed, (n,)."""
    entries = np.ascontiguousarray(matrices.reshape(-1, 9).T)
    # First by the largest, as squares of very small numbers vanish.
    entries /= np.maximum(np.abs(entries).max(axis=0), TINY)
    entries /= np.maximum(np.sqrt(np.einsum("en,en->n", entries, entries)), TINY)
    xx, xy, xz, yx, yy, yz, zx, zy, zz = entries
    # The rows of the symmetric matrix are (a, b, c, d), (b, e, f, g), (c, f, h, i), (d, g, i, j).
    b, c, d = zy - yz, xz - zx, yx - xy
    f, g, i = xy + yx, zx + xz, yz + zy
    value, gaps = _largest_eigenvalue(entries)
    e, h, j = xx - yy - zz - value, yy - xx - zz - value, zz - xx - yy - value
    # Minors of its last two rows, less the eigenvalue on the diagonal; then the cofactors of its first row.
    hj, fj, fi = h * j - i * i, f * j - g * i, f * i - g * h
    cj, ci, cg = c * j - d * i, c * i - d * h, c * g - d * f
    quaternions = np.stack(
        [e * hj - f * fj + g * fi, f * cj - b * hj - g * ci, b * fj - e * cj + g * cg, e * ci - b * fi - f * cg]
    )
    lengths = np.sqrt(np.einsum("qn,qn->n", quaternions, quaternions))  # the real part times the gaps, or rounding
    sure = (gaps > _SEPARATE) & (np.square(lengths) > _REAL * np.square(gaps))
    return _rotations(quaternions / np.maximum(lengths, TINY)), sure


def _largest_eigenvalue(entries: Floats) -> tuple[Floats, Floats]:
    """Largest eigenvalue of the 4 x 4 matrices of matrices of norm one, (9, n), and the product of its gaps, (n,) each.

    With the cofactors of a matrix F its characteristic polynomial is t^4 - 2 t^2 - 8 det(F) t + 1 - 4 |cof(F)|^2.
    """
    xx, xy, xz, yx, yy, yz, zx, zy, zz = entries
    along_x = yy * zz - yz * zy, yz * zx - yx * zz, yx * zy - yy * zx
    along_y = zy * xz - zz * xy, zz * xx - zx * xz, zx * xy - zy * xx
    along_z = xy * yz - xz * yy, xz * yx - xx * yz, xx * yy - xy * yx
    linear = 8 * (xx * along_x[0] + xy * along_x[1] + xz * along_x[2])
    constant = 1 - 4 * sum((np.square(cofactor) for cofactor in (*along_x, *along_y, *along_z)), np.zeros(len(xx)))
    value = np.full(len(xx), np.sqrt(3.0))  # no sum of singular values is larger
    for _ in range(_MOST_STEPS):
        square = value * value
        slope = 4 * value * (square - 1) - linear
        step = ((square - 2) * square - linear * value + constant) / np.maximum(slope, _LEAST_SLOPE)
        np.maximum(step, 0, out=step)  # rounding aside, it approaches from above
        value -= step
        if not (step > _STEP).any():
            break
    return value, 4 * value * (np.square(value) - 1) - linear


def _rotations(quaternions: Floats) -> Floats:
    """Rotations (n, 3, 3) of unit quaternions (4, n), the real part first."""
    r, x, y, z = quaternions
    entries = [
        1 - 2 * (y * y + z * z), 2 * (x * y - r * z), 2 * (x * z + r * y),
        2 * (x * y + r * z), 1 - 2 * (x * x + z * z), 2 * (y * z - r * x),
        2 * (x * z - r * y), 2 * (y * z + r * x), 1 - 2 * (x * x + y * y),
    ]  # fmt: skip
    return np.stack(entries, axis=1).reshape(-1, 3, 3)


def least_turns(start: Floats, end: Floats) -> Floats:
    """Find the rotations by the least angle from unit vectors (..., 3) to others, (..., 3, 3); none from or to zero."""
    # Two reflections: first the start to its negative, then that to the end; the other way round near half a turn.
    cosine = (start * end).sum(axis=-1)
    middle = unit_vectors(start + end)
    opposite = cosine < -1 + 1e-9
    if opposite.any():
        least = np.abs(start[opposite]).argmin(axis=1)
        middle[opposite] = across_axes(np.eye(3)[least], start[opposite])
    first = np.eye(3) - 2 * start[..., :, None] * start[..., None, :]
    second = np.eye(3) - 2 * middle[..., :, None] * middle[..., None, :]
    known = start.any(axis=-1) & end.any(axis=-1)
    return np.where(known[..., None, None], second @ first, np.eye(3))


def across_axes(vectors: Floats, axes: Floats) -> Floats:
    """Take what of the vectors (b, 3) lies across the axes, to length one; any direction across if nothing does."""
    axes = unit_vectors(axes)
    flat = vectors - (vectors * axes).sum(axis=1, keepdims=True) * axes
    lost = np.linalg.norm(flat, axis=1) <= 1e-6 * np.maximum(np.linalg.norm(vectors, axis=1), TINY)
    if lost.any():
        other = np.eye(3)[np.abs(axes[lost]).argmin(axis=1)]
        flat[lost] = other - (other * axes[lost]).sum(axis=1, keepdims=True) * axes[lost]
    return unit_vectors(flat)


def nearest_frame(turn: Floats, frames: Floats | None, angle: float) -> Floats:
    """Take the frame, of (k, 3, 3), that a rotation (3, 3) is nearest to; the rotation itself if none is so near."""
    if frames is None or not len(frames):
        return turn
    cosines = (np.einsum("kij,ij->k", frames, turn) - 1) / 2
    return frames[cosines.argmax()] if cosines.max() > np.cos(angle) else turn
