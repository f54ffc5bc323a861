# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances and eigenfunctions of two shapes, computed at the same time where there are helpers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.eigenpairs import Spectrum, eigenpairs_steps
from ..geometry.laplacian import LaplaceBeltrami
from ..runtime.arrays import TINY
from ..runtime.parallel_map import shared_steps
from ..runtime.progress import Steps
from .shape import Shape
from .surface_samples import SurfaceSampler

_COMPARED = 30
"""Eigenvalues that tell how much alike two surfaces are: from ten to sixty they choose nearly the same cuts of handles
(``python -m tests.benchmarks.fused_bodies``)."""


class Wanted(NamedTuple):
    """What is wanted of shapes.

    Attributes
    ----------
    samples : int
        How many samples, see `Shape.sample_steps`.
    measured : int or None
        From how many of them distances are measured.
    eigenpairs : int
        How many eigenpairs; 0 for none.
    """

    samples: int
    measured: int | None = None
    eigenpairs: int = 0


def prepared_shapes_steps(x: Shape, y: Shape, wanted: Wanted) -> Steps[None]:
    """Do what `Shape.sample_steps` and `Shape.spectrum_steps` do, for two shapes.

    Parameters
    ----------
    x, y : Shape
        The shapes, or one of them twice.
    wanted : Wanted
        What they shall have.
    """
    shapes = [x] if x is y else [x, y]
    sampled = [shape for shape in shapes if shape.lacks(wanted.samples, wanted.measured)]
    analysed = [shape for shape in shapes if shape.lacks_spectrum(wanted.eigenpairs)]
    parts: list[SurfaceSampler | LaplaceBeltrami] = [shape.sampler for shape in sampled]
    parts += [shape.laplace for shape in analysed]
    found = yield from shared_steps(_prepared_steps, wanted, parts)
    for shape, result in zip([*sampled, *analysed], found, strict=True):
        if isinstance(result, Spectrum):
            shape.take_spectrum(result)
        else:
            shape.take_samples_of(result)


def spectra_apart_steps(x: Shape, y: Shape) -> Steps[float]:
    """Measure how far the lowest eigenvalues of two shapes, in units of area, are apart, also called *Shape-DNA* [1]_.

    Parameters
    ----------
    x, y : Shape
        The shapes.

    Returns
    -------
    float
        The mean difference of their logarithms.

    References
    ----------
    .. [1] M. Reuter, F.-E. Wolter, N. Peinecke, "Laplace-Beltrami spectra as 'Shape-DNA' of surfaces and solids",
       Computer-Aided Design 38(4), 2006.
    """
    operators = x.laplace, y.laplace
    spectra = yield from shared_steps(_spectrum_steps, _COMPARED + 1, operators)
    count = min(map(len, spectra))
    logarithms = [
        np.log(np.maximum(found.values[1:count] * operator.area, TINY))
        for found, operator in zip(spectra, operators, strict=True)
    ]
    return float(np.abs(logarithms[0] - logarithms[1]).mean())


def finer_shapes(x: Shape, y: Shape) -> tuple[Shape, Shape]:
    """Give two shapes more vertices to be registered with, see `Shape.finer`, if either has few.

    A surface can bend at its vertices only, and there are few around a joint of a body of a thousand.  Both get as
    many, as far as they can: a fine surface and a coarse one agree less than two coarse ones.
    """
    return (x.finer(), y.finer()) if x.is_coarse or y.is_coarse else (x, y)


def finer_shapes_steps(x: Shape, y: Shape, eigenpairs: int) -> Steps[tuple[Shape, Shape]]:
    """Take what is registered in the place of two shapes, see `finer_shapes`, with so many eigenpairs if it is new."""
    finer = finer_shapes(x, y)
    new = [fine for fine, shape in zip(finer, (x, y), strict=True) if fine is not shape]
    if new:
        yield from prepared_shapes_steps(new[0], new[-1], Wanted(0, 0, eigenpairs))
    first, second = (f if f is s else f.sampled_like(s) for f, s in zip(finer, (x, y), strict=True))
    return first, second


def _prepared_steps(wanted: Wanted, part: SurfaceSampler | LaplaceBeltrami) -> Steps[SurfaceSampler | Spectrum]:
    """Sample a surface, or compute the eigenpairs of an operator."""
    if isinstance(part, LaplaceBeltrami):
        return (yield from _spectrum_steps(wanted.eigenpairs, part))
    yield from part.steps(wanted.samples, wanted.measured)
    return part


def _spectrum_steps(count: int, operator: LaplaceBeltrami) -> Steps[Spectrum]:
    """Compute so many eigenpairs of an operator, if it has them."""
    return eigenpairs_steps(operator, min(count, operator.vertex_count))
