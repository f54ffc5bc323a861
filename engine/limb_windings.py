# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs that may be wound about their axes in two ways, which only the whole deformation tells apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .progress import Steps, within
from .registration import FINE

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from .deformable import DeformableSurface
    from .limb_twists import Untwisted
    from .registration import Registration

__all__ = ["local_costs", "wound_steps"]

_BETTER = 0.9
"""Cost of a limb that is wound the other way, as part of that of the first way, from which on it is taken."""


def wound_steps(
    register: Callable[[NDArray[np.float64]], Steps[Registration]],
    source: DeformableSurface,
    target: DeformableSurface,
    untwisted: Untwisted,
) -> Steps[Registration]:
    """Register from where limbs were turned back, and again with limbs wound otherwise that are better so.

    Parameters
    ----------
    register : callable
        Registers the source from given positions (n, 3).
    source, target : DeformableSurface
        The surfaces.
    untwisted : Untwisted
        Positions of the source, and other windings of some limbs.

    Yields
    ------
    Progress
        After each round of a registration.

    Returns
    -------
    Registration
        With each limb as it costs less.
    """
    positions, otherwise = untwisted
    first = yield from within(register(positions), 0.0, 0.3 if otherwise else 1.0)
    if not otherwise:
        return first
    # Limbs hardly touch each other, so all are tried at once.
    second = yield from within(register(_replaced(untwisted, range(len(otherwise)))), 0.3, 0.6)
    before, after = (local_costs(source, target, found) for found in (first, second))
    better = [
        number
        for number, limb in enumerate(otherwise)
        if after[limb.vertices].sum() < _BETTER * before[limb.vertices].sum()
    ]
    if not better or len(better) == len(otherwise):
        return second if better else first
    return (yield from within(register(_replaced(untwisted, better)), 0.6, 1.0))


def local_costs(
    source: DeformableSurface, target: DeformableSurface, registration: Registration
) -> NDArray[np.float64]:
    """Costs (n_x,) of a registration around each vertex of the source: energy, and distances from and to the target."""
    # As the registration itself weighs them in its last round.
    positions, weight = registration.positions, FINE.weights[-1]
    costs = source.elastic.energies(positions, source.elastic.rotations(positions, FINE.rotation_radius))
    images, back = registration.on_target, registration.on_source
    there = np.einsum("kc,kcd->kd", images.barycentric, target.vertices[target.triangles[images.triangles]])
    costs += weight * source.mass * np.square(there - positions).sum(axis=1)
    corners = source.triangles[back.triangles]
    here = np.einsum("kc,kcd->kd", back.barycentric, positions[corners])
    nearest = corners[np.arange(len(corners)), back.barycentric.argmax(axis=1)]
    apart = weight * target.mass * np.square(here - target.vertices).sum(axis=1)
    return costs + np.bincount(nearest, apart, len(costs))


def _replaced(untwisted: Untwisted, numbers: range | list[int]) -> NDArray[np.float64]:
    """Positions (n, 3) with the limbs of these numbers wound otherwise."""
    positions = untwisted.positions.copy()
    for number in numbers:
        limb = untwisted.otherwise[number]
        positions[limb.vertices] = limb.positions
    return positions
