# SPDX-License-Identifier: GPL-3.0-or-later
"""All that is computed once for a surface, whatever it is matched to."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..geometry.eigenpairs import Spectrum, eigenpairs_steps
from ..geometry.geodesics import GeodesicSolver
from ..geometry.laplacian import LaplaceBeltrami, laplace_beltrami
from ..mesh.triangle_mesh import TriangleMesh, check_mesh
from ..runtime.arrays import Bools, Floats, Ints
from ..runtime.errors import MatchError
from ..runtime.progress import Steps, run
from .prepared_surface import PreparedSurface, prepared_steps
from .proxy import MATCHED, Proxy
from .surface_samples import SurfaceSampler, SurfaceSamples

_FEW = 0.4
"""Part of the vertices wanted from which on a surface gains little by more where it is registered."""


@dataclass(eq=False)
class _Operators:
    """What is computed of a surface, whatever its samples: shared by all shapes that differ in these alone.

    Attributes
    ----------
    mesh : TriangleMesh
        The surface.
    solver : GeodesicSolver
        Measures distances on it.
    surface : PreparedSurface or None
        What it is of a mesh; None where that is not needed, as in other processes.
    spectrum : Spectrum or None
        The eigenpairs that were computed last.
    joined, finer : Shape or None
        Shapes that are used in the place of this one, once they were needed.
    """

    mesh: TriangleMesh
    solver: GeodesicSolver
    surface: PreparedSurface | None
    spectrum: Spectrum | None = None
    joined: Shape | None = None
    finer: Shape | None = None

    @cached_property
    def laplace(self) -> LaplaceBeltrami:
        """The Laplace-Beltrami operator of the mesh."""
        return laplace_beltrami(self.mesh)

    def of(self, surface: PreparedSurface | None) -> _Operators:
        """Return the same operators of another surface with the same distances and eigenpairs, or of no mesh."""
        other = _Operators(self.mesh if surface is None else surface.mesh, self.solver, surface, self.spectrum)
        other.laplace = self.laplace
        return other


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
    """

    is_sent_once = False
    """See `parallel_map.shared_steps`; true of `lean` ones, which do not change any more."""

    def __init__(
        self, mesh: TriangleMesh, name: str = "mesh", proxy_vertices: int = MATCHED, excluded: Bools | None = None
    ) -> None:
        surface = run(prepared_steps(mesh, name, proxy_vertices, excluded))
        self._start(_Operators(surface.mesh, GeodesicSolver(surface.mesh), surface))

    def __repr__(self) -> str:
        own, matched = self.original, self.mesh
        return f"<Shape: {own.vertex_count} vertices, {matched.vertex_count} to match>"

    @classmethod
    def steps(
        cls, mesh: TriangleMesh, name: str = "mesh", proxy_vertices: int = MATCHED, excluded: Bools | None = None
    ) -> Steps[Shape]:
        """Make a shape in steps: for dense meshes that takes seconds."""
        return cls.of((yield from prepared_steps(mesh, name, proxy_vertices, excluded)))

    @classmethod
    def of(cls, surface: PreparedSurface) -> Shape:
        """Make a shape of a surface that was prepared before."""
        return cls._made(_Operators(surface.mesh, GeodesicSolver(surface.mesh), surface))

    @classmethod
    def _made(
        cls, operators: _Operators, sampler: SurfaceSampler | None = None, samples: SurfaceSamples | None = None
    ) -> Shape:
        shape = object.__new__(cls)
        shape._start(operators, sampler, samples)
        return shape

    def _start(
        self, operators: _Operators, sampler: SurfaceSampler | None = None, samples: SurfaceSamples | None = None
    ) -> None:
        """Join operators and samples: those that a sampler takes, or fixed ones."""
        self._operators, self._samples = operators, samples
        self.sampler = sampler or SurfaceSampler(operators.mesh, operators.solver)
        self._views: dict[tuple[int, int | None], Shape] = {}
        self._lean: tuple[tuple[object, ...], Shape] | None = None
        self.mesh, self.solver = operators.mesh, operators.solver
        self.scale = float(np.sqrt(self.mesh.area))
        if operators.surface is not None:
            self.surface = operators.surface
            self.original, self.vertices = self.surface.original, self.surface.vertices

    @property
    def samples(self) -> SurfaceSamples:
        """The samples that distances are known of, and all that is known of them."""
        return self.sampler.taken if self._samples is None else self._samples

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
        if self._samples is None:
            yield from self.sampler.steps(count, measured)
        elif min(count, self.mesh.vertex_count) > len(self._samples):
            yield from self.sampler.steps(count)
            self._samples = self.sampler.taken.first(count)

    def lacks(self, count: int, measured: int | None = None) -> bool:
        """Say whether `sample_steps` would have anything to do."""
        fixed = self._samples is not None and min(count, self.mesh.vertex_count) <= len(self._samples)
        return not fixed and self.sampler.lacks(count, measured)

    def take_samples_of(self, sampler: SurfaceSampler) -> None:
        """Go on from where the sampler of the same shape has come elsewhere."""
        self.sampler = sampler if sampler is self.sampler else sampler.on(self.mesh, self.solver)

    def limited(self, count: int, measured: int | None = None) -> Shape:
        """Return the shape with only the first `count` of its samples, sharing all that was computed.

        A match uses this, so that its result does not depend on how many samples other matches took before.

        Parameters
        ----------
        count, measured : int
            As in `sample_steps`, which was run with the same numbers.  From the samples that are not measured,
            distances are estimated, see `SurfaceSampler.estimated`.  That errs by about 1 % of the square root of the
            area.
        """
        count = min(count, self.mesh.vertex_count)
        if measured is not None and measured >= count:
            measured = None
        if measured is None and count >= len(self.samples):
            return self
        view = self._views.get((count, measured))
        if view is None:
            samples = self.samples.first(count) if measured is None else self.sampler.estimated(count, measured)
            view = self._views[count, measured] = self._made(self._operators, self.sampler, samples)
        return view

    def starting_with(self, vertices: Ints) -> Shape:
        """Return the shape with samples of its own, the first of which are given vertices (k,) of `mesh`.

        All else that was computed is shared.
        """
        return self._made(self._operators, SurfaceSampler(self.mesh, self.solver, vertices))

    def reflected(self) -> Shape:
        """Return the shape as it is seen in a mirror, with all that does not depend on the side it is seen from."""
        surface = self.surface.reflected()
        samples = None if self._samples is None else self._samples.on(surface.mesh)
        return self._made(self._operators.of(surface), self.sampler.on(surface.mesh, self.solver), samples)

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
        if self._operators.finer is None:
            surface = replace(self.surface, proxy=Proxy.finer(self.mesh, self.surface.wanted))
            self._operators.finer = Shape.of(surface)
        return self._operators.finer

    def sampled_like(self, coarser: Shape) -> Shape:
        """Return the shape with just the samples of the one that it is finer than; distances are interpolated."""
        rows = np.ascontiguousarray(self.surface.proxy.on_finer(coarser.samples.rows.T).T)
        samples = SurfaceSamples(self.mesh, coarser.samples.vertices, rows, coarser.samples.measured)
        return self._made(self._operators, self.sampler, samples)

    def lean(self) -> Shape:
        """Return the shape with the samples and the spectrum it has, which do not change any more.

        It is without the mesh that its surface stands for, which may be large: that is what other processes are sent.
        """
        state = self.mesh, self.samples, self._operators.spectrum
        if self._lean is None or any(a is not b for a, b in zip(state, self._lean[0], strict=True)):
            shape = self._made(self._operators.of(None), samples=self.samples)
            shape.is_sent_once = True
            self._lean = shape._lean = state, shape  # noqa: SLF001
        return self._lean[1]

    @property
    def joined(self) -> Shape | None:
        """The shape of all pieces of the body as one surface, once that was needed; see `with_limbs_steps`."""
        return self._operators.joined

    def keep_joined(self, joined: Shape) -> None:
        """Keep the shape of all pieces of the body as one surface."""
        self._operators.joined = joined

    @property
    def laplace(self) -> LaplaceBeltrami:
        """The Laplace-Beltrami operator of the part that is used."""
        return self._operators.laplace

    def spectrum_steps(self, count: int) -> Steps[None]:
        """Compute the first `count` eigenpairs of the Laplace-Beltrami operator (as many as the mesh has, at most)."""
        if self.lacks_spectrum(count):
            self.take_spectrum((yield from eigenpairs_steps(self.laplace, min(count, self.mesh.vertex_count))))

    def lacks_spectrum(self, count: int) -> bool:
        """Say whether `spectrum_steps` would have anything to do."""
        # Not more either: a match must not depend on what was asked of the shape before.
        known = self._operators.spectrum
        return count > 0 and (known is None or len(known) != min(count, self.mesh.vertex_count))

    def take_spectrum(self, spectrum: Spectrum) -> None:
        """Take over the spectrum from elsewhere."""
        self._operators.spectrum = spectrum

    @property
    def spectrum(self) -> Spectrum:
        """The eigenpairs.

        Raises
        ------
        RuntimeError
            If `spectrum_steps` was not run before.
        """
        if self._operators.spectrum is None:
            raise RuntimeError("The spectrum was not computed: run spectrum_steps first.")
        return self._operators.spectrum

    def unit_functions(self, count: int | None = None) -> Floats:
        """First eigenfunctions at all vertices, in units in which the area is one, (n, count), or all."""
        return self.spectrum.functions[:, :count] * np.sqrt(self.laplace.area)


def check_surface(surface: object, name: str = "surface") -> None:
    """Raise a `MeshError` if what should be a mesh, or the shape of one, is neither; see `check_mesh`."""
    if not isinstance(surface, Shape):
        check_mesh(surface, name)


def shape_steps(surface: TriangleMesh | Shape, name: str = "surface") -> Steps[Shape]:
    """Return a shape as it is, and make one of a mesh; see `check_surface`."""
    check_surface(surface, name)
    return surface if isinstance(surface, Shape) else (yield from Shape.steps(surface))


def check_vertex_count(shape: Shape, points: int, name: str = "mesh", least: int | None = None) -> None:
    """Raise an error if a shape, which it calls by a name, has fewer vertices than points, or than are needed at least.

    Raises
    ------
    MatchError
        If it has.
    """
    if shape.mesh.vertex_count < (points if least is None else least):
        raise MatchError(
            f"{points} points cannot be matched: the {name} has only {shape.mesh.vertex_count} vertices"
            f"{'' if shape.surface.is_whole else ' in its main part'}. Use fewer points or subdivide the mesh."
        )


def left_out_of(
    surfaces: tuple[TriangleMesh | Shape, TriangleMesh | Shape], excluded: tuple[ArrayLike | None, ArrayLike | None]
) -> list[Bools | None]:
    """Return which vertices (n,) are to be left out of the source and the target, or None.

    Raises
    ------
    MatchError
        If that is no pair, or something is to be left out of a shape, of which nothing can be any more.
    """
    try:
        masks = first, second = tuple(excluded)
    except (TypeError, ValueError) as error:
        raise MatchError(
            "What is to be left out should be a pair: vertices of the source, and vertices of the target, or None."
        ) from error
    for surface, name, mask in zip(surfaces, ("source", "target"), masks, strict=True):
        if mask is not None and isinstance(surface, Shape):
            raise MatchError(
                f"No vertices can be left out of the {name} any more, because it was prepared before. "
                "Give the mesh itself, or leave them out when you make the shape."
            )
    return [None if mask is None else np.asarray(mask, bool) for mask in (first, second)]
