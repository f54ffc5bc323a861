# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectral domains: samples, eigenfunctions and signatures of one surface, as the search for maps needs them."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.orientation import tangent_directions, tangent_gradient
from ..hierarchical.spectral_descriptors import automatic_energies, wave_kernel_signatures
from ..runtime.arrays import TINY, Floats, Ints, group_sums
from ..shapes.shape import Shape
from .functional_maps import PointMaps, SampledBasis

_COARSE = 512  # samples on which many hypotheses are compared
_FINE = 800  # samples on which few are refined
_ORIENTING = 30  # eigenfunctions whose gradients tell the orientation
_HEAT_TIME = 1e-3  # over which curvature is smoothed, in units of the area: some fingers wide on a person
_PATCH = 0.1  # standard deviation of the patches that are compared as rigid bodies: a hand or a foot, on a person
_ENERGIES = 40
_EXTREMITY_PAIRS, _EXTREMITY_ENERGIES = 60, 30  # eigenpairs and energies by which extremities are recognised
_LEAST_SIGNATURE = 1e-9

_EQUAL = 1e-9
"""Relative difference up to which squared distances are taken to be the same."""


class MapDomain:
    """A shape prepared for the search for maps.

    All quantities are in units of the square root of the shape's area.

    Parameters
    ----------
    shape : Shape
        With its samples and spectrum.
    size : int
        Number of eigenfunctions to use, k; of both shapes of a pair the same.

    Attributes
    ----------
    shape : Shape
        With no more samples than are used.
    coarse_count : int
        How many of `vertices` are the coarse samples.
    vertices : (p,) array of int
        The fine samples; the first `coarse_count` of them are the coarse ones, farthest points first.
    functions : (n, k) array of float
        Eigenfunctions at all vertices; the mean square of each over the surface is one.
    values : (k,) array of float
        Eigenvalues.
    """

    is_sent_once = True
    """See `parallel_map.shared_steps`."""

    def __init__(self, shape: Shape, size: int) -> None:
        self.shape = shape.limited(_COARSE)
        spectrum, scale = shape.spectrum, shape.scale
        self.functions = spectrum.functions[:, :size] * scale
        self.values = spectrum.values[:size] * scale**2
        self.coarse_count = len(self.shape.samples)
        self.vertices = _filled_up(shape.mesh.vertices / scale, self.shape.samples.vertices, _FINE)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what the surface stands for, and what is made in no time."""
        return {**self.__dict__, "shape": self.shape.lean(), "functions": self.functions.shape[1]}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make what was left out."""
        self.__dict__.update(state)
        self.functions = self.shape.spectrum.functions[:, : state["functions"]] * self.shape.scale

    @cached_property
    def coarse_basis(self) -> SampledBasis:
        """Eigenfunctions at the coarse samples."""
        return SampledBasis(self.functions[self.vertices[: self.coarse_count]])

    @cached_property
    def fine_basis(self) -> SampledBasis:
        """Eigenfunctions at the fine samples."""
        return SampledBasis(self.functions[self.vertices])

    @cached_property
    def gradients(self) -> Floats:
        """Gradients of the first eigenfunctions at the fine samples, less of higher ones, (p, g, 2)."""
        count = min(_ORIENTING, self.functions.shape[1])
        gradients = tangent_gradient(self.shape.mesh, self.vertices) @ self.functions[:, :count]
        gradients *= self.shape.scale
        return gradients.reshape(len(self.vertices), 2, count).transpose(0, 2, 1)

    def directions(self, samples: Ints) -> Floats:
        """Take the unit directions at the coarse samples away from the given ones (m,), (coarse, m, 2)."""
        return tangent_directions(self.shape.mesh, self.shape.samples.vertices, self.shape.samples.rows[samples])

    @cached_property
    def places(self) -> Floats:
        """Positions of the fine samples, (p, 3); their mean is the origin."""
        places = self.shape.mesh.vertices[self.vertices] / self.shape.scale
        return places - places.mean(axis=0)

    def apart(self, first: PointMaps, second: PointMaps) -> float:
        """Mean distance in space between the images of samples by two maps to this surface."""
        return float(np.linalg.norm(self.places[first.on_y] - self.places[second.on_y], axis=1).mean())

    def nearest_samples(self, vertices: Ints) -> Ints:
        """Numbers of the fine samples nearest, in space, to vertices (k,), (k,)."""
        positions = self.shape.mesh.vertices
        return cKDTree(positions[self.vertices]).query(positions[vertices])[1]

    @cached_property
    def normals(self) -> Floats:
        """Unit normals at the fine samples, (p, 3)."""
        return self.shape.mesh.vertex_normals[self.vertices]

    @cached_property
    def patches(self) -> Floats:
        """Weights of the fine samples in a Gaussian patch around each coarse sample, (coarse, p); rows sum to one."""
        distances = self.shape.samples.rows[:, self.vertices].astype(np.float64)
        weights = np.exp(-np.square(distances / _PATCH) / 2)
        return weights / weights.sum(axis=1, keepdims=True)

    @cached_property
    def curvature(self) -> Floats:
        r"""Mean curvature after some heat flow, at the fine samples, (p,); its mean square is one.

        The gradient of the area by the place of a vertex is its mean curvature, integrated over its cell, along its
        normal.  A whole-surface integral, taken with the heat kernel, it is stable under noise and remeshing.
        """
        mesh, scale = self.shape.mesh, self.shape.scale
        corners = mesh.vertices[mesh.triangles] / scale  # (m, 3, 3)
        gradient = np.zeros((mesh.vertex_count, 3))
        for corner in range(3):
            opposite = corners[:, (corner + 2) % 3] - corners[:, (corner + 1) % 3]
            pull = np.cross(mesh.triangle_normals, opposite) / 2
            gradient += group_sums(mesh.triangles[:, corner], pull, mesh.vertex_count)
        integrated = np.einsum("nd,nd->n", gradient, mesh.vertex_normals)
        coefficients = np.exp(-_HEAT_TIME * self.values) * (self.functions.T @ integrated)
        return self.functions[self.vertices] @ coefficients / max(np.linalg.norm(coefficients), TINY)

    @cached_property
    def signatures(self) -> Floats:
        """Logarithms of wave kernel signatures at the fine samples, each of unit spread, (p, d)."""
        return self._log_signatures(len(self.values), _ENERGIES, self.vertices)

    def extremity_descriptors(self, samples: Ints) -> Floats:
        """Describe some coarse samples, given by number (m,), by low waves, (m, d)."""
        pairs = min(_EXTREMITY_PAIRS, len(self.values))
        signatures = self._log_signatures(pairs, _EXTREMITY_ENERGIES, self.shape.samples.vertices)[samples]
        areas = self.shape.samples.cell_areas
        means = self.shape.samples.distances @ areas
        return np.column_stack([signatures, 3 * means[samples] / (areas @ means)])

    def _log_signatures(self, pairs: int, count: int, vertices: Ints) -> Floats:
        spectrum = self.shape.spectrum
        spectrum = replace(spectrum, values=spectrum.values[:pairs], functions=spectrum.functions[vertices, :pairs])
        logarithms = np.log(wave_kernel_signatures(spectrum, automatic_energies(pairs, count)) + _LEAST_SIGNATURE)
        return logarithms / np.maximum(logarithms.std(axis=0), TINY)


def _filled_up(points: Floats, samples: Ints, count: int) -> Ints:
    """Add farthest points, by the distance in space, to samples until there are `count` (at most all vertices)."""
    count = min(count, len(points))
    chosen = np.empty(max(count, len(samples)), np.int64)
    chosen[: len(samples)] = samples
    axes = points.T.copy()
    nearest = np.square(cKDTree(points[samples]).query(points)[0])
    nearest[samples] = -1.0  # never twice, even where vertices lie in one place
    outer = np.linalg.norm(points - points[samples[0]], axis=1)
    for number in range(len(samples), count):
        # Of those that are equally far, such as ends of edges from their middles, neither rounding nor the order of the
        # vertices chooses, unless the surface is symmetric.
        equal = np.flatnonzero(nearest >= nearest.max() * (1 - _EQUAL))
        new = chosen[number] = equal[(outer[equal] >= outer[equal].max() * (1 - _EQUAL)).argmax()]
        distance = np.square(axes[0] - axes[0, new])
        distance += np.square(axes[1] - axes[1, new])
        distance += np.square(axes[2] - axes[2, new])
        np.minimum(nearest, distance, out=nearest)
        nearest[new] = -1.0
    return chosen
