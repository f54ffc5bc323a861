# SPDX-License-Identifier: GPL-3.0-or-later
"""Energies of a map between two surfaces: the terms of its score."""

from __future__ import annotations

import numpy as np

from ..geometry.orientation import orientation_agreement
from ..runtime.arrays import Floats, Ints
from .functional_maps import FunctionalMaps, PointMaps
from .spectral_domain import MapDomain

_COMPARED = 40  # samples whose distances are compared
_BOUNDING = 200  # samples whose distances bound other ones
_RIGID = 1e-3  # rigid defects below this are all the same
_POINT = 1e-12  # squared radius, in units of the area, of what is no more than a point


def spectral_terms(x: MapDomain, y: MapDomain, maps: FunctionalMaps) -> dict[str, float]:
    r"""Measure how far functional maps are from what an isometry would give; all zero for an isometry.

    Returns
    -------
    dict of float
        ``bijectivity``, :math:`\|C_X C_Y - I\|^2 / k`; ``commutator``, the mean over both directions of
        :math:`\|C \Lambda - \Lambda' C\|^2 / \|\Lambda\|^2`, zero for maps that keep distances, and for those of
        constants alone.
    """
    size = len(maps.onto_x)
    x_values, y_values = x.values[:size], y.values[:size]
    gaps = np.square(x_values[:, None] - y_values)  # (k of X, k of Y)
    commutator = (np.square(maps.onto_x) * gaps).sum() + (np.square(maps.onto_y) * gaps.T).sum()
    scale = np.square(x_values).sum() + np.square(y_values).sum()
    return {
        "bijectivity": float(np.square(maps.onto_x @ maps.onto_y - np.eye(size)).sum() / size),
        "commutator": float(commutator / scale) if scale > 0 else 0.0,  # of constants alone
    }


def map_orientation(x: MapDomain, y: MapDomain, points: PointMaps, maps: FunctionalMaps) -> float:
    r"""Measure whether a map keeps or mirrors the surface, by the sign of its Jacobian.

    The gradients of the first eigenfunctions of Y at the image of a point, and those of their pullbacks at the point,
    turn the same way if orientation is kept.

    Parameters
    ----------
    x, y : MapDomain
        The surfaces.
    points : PointMaps
        Between their first p and q fine samples.
    maps : FunctionalMaps
        Of the same map.

    Returns
    -------
    float
        Mean sign, -1 (mirrored everywhere) to 1 (kept everywhere), over the samples of both surfaces.
    """
    at_x = _agreement(x.gradients, y.gradients, points.on_y, maps.onto_x)
    at_y = _agreement(y.gradients, x.gradients, points.on_x, maps.onto_y)
    return float(np.sign(at_x).mean() + np.sign(at_y).mean()) / 2


def _agreement(here: Floats, there: Floats, images: Ints, pullback: Floats) -> Floats:
    """Agreement of orientation at points, (p,), whose images have gradients that are pulled back."""
    count = min(here.shape[1], there.shape[1], len(pullback))
    pulled = np.einsum("psf,sl->plf", here[: len(images), :count], pullback[:count, :count], optimize=True)
    return orientation_agreement(pulled, there[images, :count])


def curvature_terms(x: MapDomain, y: MapDomain, points: PointMaps) -> dict[str, float]:
    """Measure how differently the surfaces bend, and how differently they are spread around, at both ends of a map.

    Returns
    -------
    dict of float
        Mean absolute differences, over the fine samples of both surfaces: ``curvature`` of smoothed mean curvature,
        which is extrinsic, so that no isometry can fool it, and ``waves`` of logarithmic wave kernel signatures.
    """
    terms = {}
    for name, at_x, at_y in (("curvature", x.curvature, y.curvature), ("waves", x.signatures, y.signatures)):
        forward, back = np.abs(at_x - at_y[points.on_y]).mean(), np.abs(at_y - at_x[points.on_x]).mean()
        terms[name] = float(forward + back) / 2
    return terms


def distance_term(x: MapDomain, y: MapDomain, points: PointMaps) -> float:
    """Mean absolute change of the geodesic distances between the first samples, in sqrt(area), both ways."""
    changes = []
    for here, there, images in ((x, y, points.on_y), (y, x, points.on_x)):
        few = min(_COMPARED, here.coarse_count)
        known = here.shape.samples.distances[:few, :few]
        changes.append(np.abs(known - _distances_between(there, there.vertices[images[:few]])).mean())
    return float(np.mean(changes))


def rigidity_term(x: MapDomain, y: MapDomain, points: PointMaps, size: int) -> float:
    r"""Measure how far patches are from being moved as rigid bodies, up to their size.

    Let :math:`p_i` be the places in a patch and :math:`q_i` those of their images, both from their weighted means, and
    :math:`n_i` and :math:`m_i` the normals there.  With the singular values of

    .. math:: C = \frac{\sum_i w_i p_i q_i^T}{\sqrt{\sum_i w_i |p_i|^2 \sum_i w_i |q_i|^2}}
        + \frac{\sum_i w_i n_i m_i^T}{\sqrt{\sum_i w_i |n_i|^2 \sum_i w_i |m_i|^2}},

    the last with the sign of its determinant, so that only rotations count and no reflections [1]_, the defect
    :math:`1 - (\sigma_1 + \sigma_2 \pm \sigma_3) / 2` is zero where one patch is a rotated and scaled copy of the
    other.  Front and back differ in this, and ends of limbs that do not belong together: what distances alone can
    hardly tell apart.

    Parameters
    ----------
    x, y : MapDomain
        The surfaces.
    points : PointMaps
        Between their fine samples.
    size : int
        Number of eigenfunctions by which patches and images are smoothed first; otherwise the width of the gaps
        between samples would count.

    Returns
    -------
    float
        Geometric mean over the patches of both surfaces: joints bend, and should not outvote all that does not.

    References
    ----------
    .. [1] S. Umeyama, "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991.
    """
    logarithms = []
    for here, there, images in ((x, y, points.on_y), (y, x, points.on_x)):
        basis = here.fine_basis
        count = min(size, basis.size)
        rough = np.concatenate([here.places, here.normals, there.places[images], there.normals[images]], axis=1)
        smoothed = basis.functions[:, :count] @ basis.coefficients(rough, count)
        logarithms.append(np.log(_rigid_defects(here.patches, *np.split(smoothed, 4, axis=1)) + _RIGID).mean())
    return float(np.exp(np.mean(logarithms)))


def _rigid_defects(weights: Floats, places: Floats, normals: Floats, images: Floats, image_normals: Floats) -> Floats:
    """Compare weighted patches (c, p) of points with normals (p, 3) and of their images: 0 for similar ones; (c,)."""
    kept = _correlation(weights, places, images, (weights @ places, weights @ images))
    kept += _correlation(weights, normals, image_normals)
    values = np.linalg.svd(kept, compute_uv=False)
    values[:, 2] *= np.sign(np.linalg.det(kept))
    return (1 - values.sum(axis=1) / 2).clip(0, 1)


def _correlation(weights: Floats, first: Floats, second: Floats, means: tuple[Floats, ...] = ()) -> Floats:
    """Correlate vectors (p, 3) in weighted patches (c, p), from means (c, 3) or from zero: (c, 3, 3)."""
    products = np.einsum("pi,pj->pij", first, second).reshape(-1, 9)
    squares = np.stack([np.square(first).sum(axis=1), np.square(second).sum(axis=1)], axis=1)
    moments = weights @ np.concatenate([products, squares], axis=1)
    covariance, spreads = moments[:, :9].reshape(-1, 3, 3), moments[:, 9:]
    if means:
        covariance = covariance - means[0][:, :, None] * means[1][:, None, :]
        spreads = spreads - np.stack([np.square(each).sum(axis=1) for each in means], axis=1)
    size = np.sqrt(spreads.clip(0).prod(axis=1))[:, None, None]
    return np.divide(covariance, size, out=np.zeros_like(covariance), where=size > _POINT)


def _distances_between(domain: MapDomain, vertices: Ints) -> Floats:
    """Distances between vertices, (k, k), half-way between the bounds of the triangle inequality over samples."""
    rows = domain.shape.samples.rows[:_BOUNDING, vertices]  # (s, k)
    lower = np.zeros((len(vertices), len(vertices)), np.float32)
    upper = np.full_like(lower, np.inf)
    for row in rows:
        np.maximum(lower, np.abs(row[:, None] - row), out=lower)
        np.minimum(upper, row[:, None] + row, out=upper)
    return (lower.astype(np.float64) + upper) / 2
