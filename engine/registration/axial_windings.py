# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs that may be wound about their axes in several ways, which only the whole deformation tells apart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..mesh.closest_points import FoundPoints
from ..runtime.arrays import Floats, Ints
from ..runtime.progress import Steps, within
from .axial_twists import Untwisted
from .deformable import DeformableSurface
from .registration import FINE, Registration, Stage

_TOGETHER = replace(FINE, weights=FINE.weights[-1:])
"""How the source is registered from where several registrations have brought its limbs."""

_APART = 0.02
"""Distance, in sqrt(area), from which on two registrations differ at a place: there they are compared."""

_MISFIT_WEIGHT = 320.0
"""How much squared distances count against elastic energy, a quarter of what they do at the end of the registrations:
arms beside a head fit badly at first, however they are wound."""

_FEATURE_LENGTH = 0.11
"""How many units of length a unit of difference of the normals or of the curvatures counts, where ways are compared: a
round arm fits any way round, but its elbow does not."""

_MOST_CURVED = 0.2
"""Difference of curvatures from which on more says no more: along seams and borders they have no meaning."""


def wound_steps(
    register: Callable[[list[Floats], Stage], Steps[list[Registration]]],
    source: DeformableSurface,
    target: DeformableSurface,
    untwisted: Untwisted,
) -> Steps[Registration]:
    """Register from where limbs were turned back, and again with limbs wound otherwise that are better so.

    Parameters
    ----------
    register : callable
        Registers the source from several positions, (n, 3) each, as a stage has it.
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
    otherwise = untwisted.otherwise
    count = max((len(limb.positions) for limb in otherwise), default=0)
    share = (count + 1) / (count + 2 if count else 1)
    # Limbs hardly touch each other, so all are tried at once.
    ways = [[min(way, len(limb.positions)) for limb in otherwise] for way in range(count + 1)]
    registered = yield from within(register([_wound(untwisted, tried) for tried in ways], FINE), 0.0, share)
    if not count:
        return registered[0]
    costs = [local_costs(source, target, registration) for registration in registered]
    chosen = []
    for limb in otherwise:
        best = 0
        for way in range(1, len(limb.positions) + 1):
            apart = np.linalg.norm(registered[way].positions - registered[best].positions, axis=1)[limb.vertices]
            differing = limb.vertices[apart > _APART]
            if costs[way][differing].sum() < costs[best][differing].sum():
                best = way
        chosen.append(best)
    kept = [ways[best][number] for number, best in enumerate(chosen)]
    if kept in ways:
        return registered[ways.index(kept)]
    positions = registered[0].positions.copy()
    for limb, way in zip(otherwise, chosen, strict=True):
        positions[limb.vertices] = registered[way].positions[limb.vertices]
    (registration,) = yield from within(register([positions], _TOGETHER), share, 1.0)
    return registration


def local_costs(source: DeformableSurface, target: DeformableSurface, registration: Registration) -> Floats:
    """Costs (n_x,) of a registration around each vertex of the source: energy, and misfits to and from the target."""
    positions = registration.positions
    on_target, on_source = registration.on_target, registration.on_source
    own = positions, source.search.moved(positions).vertex_normals, source.curvatures
    others = target.vertices, target.normals, target.curvatures
    costs = source.elastic.energies(positions, source.elastic.rotations(positions, FINE.rotation_radius))
    costs += _MISFIT_WEIGHT * source.mass * _misfits(on_target, target.triangles, own, others)
    apart = _MISFIT_WEIGHT * target.mass * _misfits(on_source, source.triangles, others, own)
    return costs + np.bincount(on_source.nearest_vertices(source.triangles), apart, len(costs))


def _misfits(matches: FoundPoints, triangles: Ints, own: tuple[Floats, ...], others: tuple[Floats, ...]) -> Floats:
    """Squared differences (k,) of positions, normals and curvatures between vertices and the points they match."""
    places, normals, curvatures = (
        np.square(matches.interpolate(triangles, theirs) - mine).sum(axis=1)
        for mine, theirs in zip(own, others, strict=True)
    )
    return places + _FEATURE_LENGTH**2 * (normals + np.minimum(curvatures, _MOST_CURVED**2))


def _wound(untwisted: Untwisted, ways: list[int]) -> Floats:
    """Positions (n, 3) with each limb wound in one of its ways: 0 as it is, then each of the others."""
    positions = untwisted.positions.copy()
    for limb, way in zip(untwisted.otherwise, ways, strict=True):
        if way:
            positions[limb.vertices] = limb.positions[way - 1]
    return positions
