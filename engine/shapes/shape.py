# SPDX-License-Identifier: GPL-3.0-or-later
"""All that is computed once for a surface, whatever it is matched to."""

from __future__ import annotations

import copy
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse.csgraph import dijkstra

from ..geometry.eigenpairs import Spectrum, eigenpairs_steps
from ..geometry.geodesics import GeodesicSolver
from ..geometry.laplacian import LaplaceBeltrami, laplace_beltrami
from ..geometry.mean_curvature import smoothed_mean_curvature
from ..geometry.orientation import tangent_gradient
from ..geometry.sampling import FarthestPointSampler
from ..runtime.progress import Progress, Steps, run
from .prepared_surface import PreparedSurface, prepared_steps
from .proxy import Proxy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..mesh.triangle_mesh import TriangleMesh

__all__ = ["Shape"]

_CURVATURE_RADII = (0.02, 0.03)  # in units of sqrt(area): on a person, some fingers wide

_TAKEN_TOGETHER, _FOLLOWED_TOGETHER = 100, 40
"""Samples that are taken, and from which paths are followed, in one step."""

_FEW = 0.4
"""Part of the vertices wanted from which on a surface gains little by more where it is registered."""

_COMPARED = 8
"""Samples by whose distances it is found how much longer paths are."""


class Shape:
    """A surface with its samples and the distances between them.

    One `Shape` can take part in any number of matches: what a match asks for is computed once and kept.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.  It is cleaned, and its main part is used, the largest or one of half its size that is closed,
        through a coarse mesh that stands for it where it is dense.
    name : str
        What notes call it.
    proxy_vertices : int
        About how many vertices that coarse mesh has.  Where either of two meshes has fewer than 0.4 times as many,
        both get up to so many where they are registered, see `finer`.
    excluded : (n,) array of bool, optional
        Vertices to leave out.

    Attributes
    ----------
    surface : PreparedSurface
        What is used of the mesh, and the way back.
    mesh : TriangleMesh
        The surface that is used.
    original : TriangleMesh
        The mesh as it was given.
    vertices : array of int
        For each vertex of the surface that is used, its own or the nearest vertex of the original mesh.
    scale : float
        Square root of the area of the surface that is used: the unit of all distances below.
    joined : Shape or None
        The shape of all pieces of the body as one surface, once that was needed; see `with_limbs_steps`.
    """

    surface: PreparedSurface
    joined: Shape | None
    is_sent_once = False
    """See `sharing.shared_steps`; true of `lean` ones, which do not change any more."""

    def __init__(
        self,
        mesh: TriangleMesh,
        name: str = "mesh",
        proxy_vertices: int = 5000,
        excluded: NDArray[np.bool_] | None = None,
    ) -> None:
        self._start(run(prepared_steps(mesh, name, proxy_vertices, excluded)))

    def __repr__(self) -> str:
        own, matched = self.original, self.mesh
        return f"<Shape: {own.vertex_count} vertices, {matched.vertex_count} to match>"

    @classmethod
    def steps(
        cls,
        mesh: TriangleMesh,
        name: str = "mesh",
        proxy_vertices: int = 5000,
        excluded: NDArray[np.bool_] | None = None,
    ) -> Steps[Shape]:
        """Make a shape in steps: for dense meshes that takes seconds."""
        shape = object.__new__(cls)
        shape._start((yield from prepared_steps(mesh, name, proxy_vertices, excluded)))
        return shape

    @classmethod
    def of(cls, surface: PreparedSurface) -> Shape:
        """Make a shape of a surface that was prepared before."""
        shape = object.__new__(cls)
        shape._start(surface)
        return shape

    def _start(self, surface: PreparedSurface) -> None:
        self.surface, self.joined = surface, None
        self.original, self.mesh, self.vertices = surface.original, surface.mesh, surface.vertices
        self.scale = float(np.sqrt(self.mesh.area))
        self.solver = GeodesicSolver(self.mesh)
        self._rows = np.empty((0, self.mesh.vertex_count), np.float32)
        self._measured: int | None = None
        self._paths: dict[int, NDArray[np.float32]] = {}
        self._spectrum: Spectrum | None = None
        self._views: dict[tuple[int, int | None], Shape] = {}
        self._finer: Shape | None = None
        self._lean: tuple[tuple[object, ...], Shape] | None = None

    @cached_property
    def _sampler(self) -> FarthestPointSampler:
        """Farthest point sampling from one end of the surface: a start that does not depend on the vertex order."""
        graph = self.solver.graph
        centre = np.average(self.mesh.vertices, axis=0, weights=self.mesh.vertex_areas)
        outermost = int(np.square(self.mesh.vertices - centre).sum(axis=1).argmax())
        return FarthestPointSampler(graph, int(dijkstra(graph, indices=outermost).argmax()))

    @property
    def sample_count(self) -> int:
        """Number of samples with distances so far, S."""
        return len(self._rows)

    @property
    def measured_count(self) -> int:
        """Number of samples, the first, whose distances are by fast marching, and not estimated."""
        return self.sample_count if self._measured is None else self._measured

    def sample_steps(self, count: int, measured: int | None = None) -> Steps[None]:
        """Take samples until there are `count` (at most all vertices), with their distances to all vertices.

        Parameters
        ----------
        count : int
            How many samples.
        measured : int, optional
            From how many of them, the first, distances are measured by fast marching; from all by default.  From the
            others paths are followed, which takes a fraction of the time, for `limited` to estimate distances by.
        """
        count = min(count, self.mesh.vertex_count)
        measured = count if measured is None else min(measured, count)
        for taken in range(len(self._sampler.samples), count, _TAKEN_TOGETHER):
            self._sampler.extend(min(taken + _TAKEN_TOGETHER, count))
            yield Progress(0.0, "Measuring distances")
        known = self.sample_count
        new = np.array(self._sampler.samples[known:measured], np.int64)
        followed = [*range(min(_COMPARED, measured)), *range(measured, count)] if measured < count else []
        followed = [number for number in followed if number not in self._paths]
        total = max(len(new) + len(followed), 1)
        if len(new):
            # float32 keeps a hundred thousand vertices in reach of an ordinary machine; its error, 1e-7 of the
            # distance, is far below that of fast marching.
            rows = np.empty((measured, self.mesh.vertex_count), np.float32)
            rows[:known] = self._rows
            for first, block in self.solver.distances_in_blocks(new):
                rows[known + first : known + first + len(block)] = block / self.scale
                yield Progress((first + len(block)) / total, "Measuring distances")
            self._rows = rows
            self._forget_samples()
        for start in range(0, len(followed), _FOLLOWED_TOGETHER):
            part = followed[start : start + _FOLLOWED_TOGETHER]
            lengths = self.solver.path_lengths([self._sampler.samples[number] for number in part]) / self.scale
            self._paths.update(zip(part, lengths.astype(np.float32), strict=True))
            yield Progress((len(new) + start + len(part)) / total, "Measuring distances")

    def spectrum_steps(self, count: int) -> Steps[None]:
        """Compute the first `count` eigenpairs of the Laplace-Beltrami operator (as many as the mesh has, at most)."""
        if self.lacks_spectrum(count):
            self._spectrum = yield from eigenpairs_steps(self.laplace, min(count, self.mesh.vertex_count))

    @cached_property
    def laplace(self) -> LaplaceBeltrami:
        """The Laplace-Beltrami operator of the part that is used."""
        return laplace_beltrami(self.mesh)

    def limited(self, count: int, measured: int | None = None) -> Shape:
        """Return the shape with only the first `count` of its samples, sharing all that was computed.

        A match uses this, so that its result does not depend on how many samples other matches took before.

        Parameters
        ----------
        count, measured : int
            As in `sample_steps`, which was run with the same numbers.  From the samples that are not measured,
            distances are estimated: the lengths of paths, divided by how much longer paths from the first samples are
            than distances, in the mean.  That errs by about 1 % of the square root of the area.
        """
        count = min(count, self.mesh.vertex_count)
        if measured is not None and measured >= count:
            measured = None
        if measured is None and count >= self.sample_count:
            return self
        view = self._views.get((count, measured))
        if view is None:
            view = self._views[count, measured] = copy.copy(self)
            view._views = {}  # noqa: SLF001
            view._forget_samples()  # noqa: SLF001
            if measured is None:
                view._rows = self._rows[:count]  # noqa: SLF001
                view._measured = min(self.measured_count, count)  # noqa: SLF001
            else:
                view._rows = self._with_estimates(count, measured)  # noqa: SLF001
                view._measured = measured  # noqa: SLF001
        view._spectrum = self._spectrum  # noqa: SLF001
        return view

    def _with_estimates(self, count: int, measured: int) -> NDArray[np.float32]:
        """Distances from samples to all vertices, (count, n), from the first by fast marching."""
        compared = min(_COMPARED, measured)
        lengths = sum(float(self._paths[number].sum()) for number in range(compared))
        rows = np.empty((count, self.mesh.vertex_count), np.float32)
        rows[:measured] = self._rows[:measured]
        np.stack([self._paths[number] for number in range(measured, count)], out=rows[measured:])
        rows[measured:] *= float(rows[:compared].sum()) / lengths
        return rows

    def starting_with(self, vertices: NDArray[np.int64]) -> Shape:
        """Return the shape with samples of its own, the first of which are given vertices (k,) of `mesh`.

        All else that was computed is shared.
        """
        shape = copy.copy(self)
        shape._forget_samples()  # noqa: SLF001
        shape._rows = self._rows[:0]  # noqa: SLF001
        shape._measured = None  # noqa: SLF001
        shape._paths = {}  # noqa: SLF001
        shape._views = {}  # noqa: SLF001
        shape._sampler = FarthestPointSampler(self.solver.graph, vertices)  # noqa: SLF001
        return shape

    def reflected(self) -> Shape:
        """Return the shape as it is seen in a mirror, with all that does not depend on the side it is seen from."""
        shape = copy.copy(self)
        shape.surface, shape.joined = self.surface.reflected(), None
        shape.original, shape.mesh = shape.surface.original, shape.surface.mesh
        shape._views, shape._finer = {}, None  # noqa: SLF001
        shape.__dict__.pop("directions", None)
        return shape

    @property
    def is_coarse(self) -> bool:
        """Whether a surface has few vertices to be registered with."""
        return self.mesh.vertex_count < _FEW * self.surface.wanted

    def finer(self) -> Shape:
        """Return the shape with about as many vertices as are wanted, and without samples; a proxy as it is.

        Its own vertices come first, then some in the middle of its edges.
        """
        if not self.surface.proxy.is_identity or self.mesh.vertex_count >= self.surface.wanted:
            return self
        if self._finer is None:
            self._finer = Shape.of(replace(self.surface, proxy=Proxy.finer(self.mesh, self.surface.wanted)))
        return self._finer

    def sampled_like(self, coarser: Shape) -> Shape:
        """Return the shape with just the samples of the one that it is finer than; distances are interpolated."""
        shape = copy.copy(self)
        shape._forget_samples()  # noqa: SLF001
        shape._views, shape._paths = {}, {}  # noqa: SLF001
        shape.samples = coarser.samples
        shape._rows = np.ascontiguousarray(self.surface.proxy.on_finer(coarser.sample_rows.T).T)  # noqa: SLF001
        shape._measured = coarser.measured_count  # noqa: SLF001
        return shape

    def bare(self) -> Shape:
        """Return the shape without the mesh that its surface stands for, which may be large, to sample it elsewhere."""
        shape = copy.copy(self)
        for name in ("surface", "original", "vertices", "joined"):
            shape.__dict__.pop(name, None)
        shape._views, shape._lean, shape._finer = {}, None, None  # noqa: SLF001
        return shape

    def lean(self) -> Shape:
        """Return the shape with the samples and the spectrum it has, which do not change any more, and bare.

        That is what other processes are sent.
        """
        state = self.mesh, self._rows, self._spectrum
        if self._lean is None or any(a is not b for a, b in zip(state, self._lean[0], strict=True)):
            shape = self.bare()
            shape.samples = self.samples
            shape._paths = {}  # noqa: SLF001
            shape.__dict__.pop("_sampler", None)
            shape.is_sent_once = True
            self._lean = shape._lean = state, shape  # noqa: SLF001
        return self._lean[1]

    def lacks(self, count: int, measured: int | None = None) -> bool:
        """Say whether `sample_steps` would have anything to do."""
        count = min(count, self.mesh.vertex_count)
        measured = count if measured is None else min(measured, count)
        return self.sample_count < measured or any(number not in self._paths for number in range(measured, count))

    def take_samples_of(self, other: Shape) -> None:
        """Take over the samples of the same shape from elsewhere."""
        if len(other._rows) > len(self._rows):
            self._forget_samples()
        self._sampler, self._rows, self._paths = other._sampler, other._rows, other._paths

    def lacks_spectrum(self, count: int) -> bool:
        """Say whether `spectrum_steps` would have anything to do."""
        # Not more either: a match must not depend on what was asked of the shape before.
        return count > 0 and (self._spectrum is None or len(self._spectrum) != min(count, self.mesh.vertex_count))

    def take_spectrum(self, spectrum: Spectrum) -> None:
        """Take over the spectrum from elsewhere."""
        self._spectrum = spectrum

    def _forget_samples(self) -> None:
        for name in ("samples", "cell_areas", "sample_distances", "directions", "curvatures"):
            self.__dict__.pop(name, None)

    @property
    def spectrum(self) -> Spectrum:
        """The eigenpairs.

        Raises
        ------
        RuntimeError
            If `spectrum_steps` was not run before.
        """
        if self._spectrum is None:
            raise RuntimeError("The spectrum was not computed: run spectrum_steps first.")
        return self._spectrum

    @cached_property
    def samples(self) -> NDArray[np.int64]:
        """Vertices of the samples, farthest points first, (S,)."""
        return np.array(self._sampler.samples[: self.sample_count])

    @property
    def sample_rows(self) -> NDArray[np.float32]:
        """Distance from each sample to each vertex, (S, n), estimated from the samples that are not measured."""
        return self._rows

    @cached_property
    def cell_areas(self) -> NDArray[np.float64]:
        """Area of each sample's Voronoi cell as a part of the whole, (S,)."""
        nearest = self._rows.argmin(axis=0)
        return np.bincount(nearest, self.mesh.vertex_areas, self.sample_count) / self.mesh.area

    @cached_property
    def sample_distances(self) -> NDArray[np.float64]:
        """Distances between the samples, (S, S), symmetric with a zero diagonal."""
        square = self._rows[:, self.samples].astype(np.float64)
        measured = self.measured_count
        square[measured:, :measured] = square[:measured, measured:].T
        square = (square + square.T) / 2
        np.fill_diagonal(square, 0)
        return square

    @cached_property
    def directions(self) -> NDArray[np.float64]:
        """Unit direction at each sample in which the distance from each sample grows, (S at, S from, 2)."""
        gradient = tangent_gradient(self.mesh, self.samples) @ self._rows.T.astype(np.float64)
        planar = gradient.reshape(self.sample_count, 2, -1).transpose(0, 2, 1)
        lengths = np.linalg.norm(planar, axis=2, keepdims=True)
        return np.divide(planar, lengths, out=np.zeros_like(planar), where=lengths > 0)

    @cached_property
    def curvatures(self) -> NDArray[np.float64]:
        """Mean curvature at each sample, smoothed at two scales, (2, S)."""
        distances = self._rows * self.scale
        return np.stack([smoothed_mean_curvature(self.mesh, distances, r * self.scale) for r in _CURVATURE_RADII])
