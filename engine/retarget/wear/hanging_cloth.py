# SPDX-License-Identifier: GPL-3.0-or-later
"""Cloth that hangs over limbs, such as a skirt, of a body on which it stands for skin that is lacking elsewhere."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...mesh.area_samples import AreaSamples, even_samples
from ...mesh.connectivity.components import joined_components
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints
from .sight_lines import depths_behind

_BLOCKING, _SAMPLES = 20_000, 6_000
"""Points that stand for the surface where it is in the way of light, and where it covers or is covered."""

_NEAREST, _LOOKED_AT = 256, 4
"""How many of the latter are near one, and how many of those that it may cover are looked at."""

_REACH, _LEAST_GAP = 0.08, 0.01
"""How far from skin, in sqrt(area), cloth hangs over it at most, 11 cm on a person, and at least: what lies closer, as
a boot on a leg, is as good as skin.  With 0.12 one leg of the Witch of ``python -m tests.benchmarks.worn_makers`` seems
to hang over the other."""

_ABOVE, _BELOW = 0.7, 0.3
"""Least cosine between the way from the one to the other and the normals of skin and cloth."""

_DIRECTIONS, _CELL = 80, 2.0
"""From how many sides light falls, and how wide the cells are that it falls through, in distances between points."""

_LIT = 0.05
"""Part of these from which light falls on both a third and two thirds of the way: what is solid, or ends within another
part, is dark.  With 0.02 and 0.1 the areas named below are 0.038, 0.064 and 0.010, and 0.019, 0.029 and 0.005."""

_CLOSED, _BEYOND = 0.12, 0.06
"""Over what distance, in sqrt(area), it is filled up between places that hang, and how far it goes on beyond them.  If
that is 0.03, the knees below the skirts of ``python -m tests.benchmarks.worn_makers`` are fitted 1 and 3 cm higher."""

_LEAST, _SHARED = 0.015, 0.2
"""Least part of the body, by area, that is seen to hang, and of that what hangs over a second limb: cloth around one
limb is as good as its skin.  Of the skirts of that benchmark it is 0.029 and 0.055, and nearly half; of all else there
0.006 at most."""

_GAP, _PIECE = 0.06, 0.01
"""How far apart, in sqrt(area), parts are that are no body together, as for the surface around all of them (see
``enclosing_surface``), and how large they are at least, by area."""


def hanging_triangles(body: TriangleMesh, cloth: Bools) -> Bools:
    """Tell which triangles are of cloth that hangs over several limbs, with air below it that is open to the outside.

    Parameters
    ----------
    body : TriangleMesh
        The body with what stands for parts that it lacks, m triangles.
    cloth : (m,) array of bool
        The triangles of the latter.

    Returns
    -------
    (m,) array of bool
        Those that hang: not what holds the body together.
    """
    body = TriangleMesh(body.vertices - body.vertices.mean(axis=0), body.triangles)
    part = WeldedParts.of(body).vertex_labels[body.triangles[:, 0]]
    samples, areas = even_samples(body, body.area / _SAMPLES), np.bincount(part, body.triangle_areas)
    places, of, unit = samples.positions, part[samples.triangles], float(np.sqrt(body.area))
    above, below = _facing(body, samples, np.flatnonzero(cloth[samples.triangles]))
    apart = of[above] != of[below]
    above, below = _lit(body, places, above[apart], below[apart])
    hanging = np.zeros(body.triangle_count, bool)
    if not len(above):
        return hanging
    whole = _pieces(places, unit)
    for region in _regions(places, of, above, unit):
        over = of[below[region]]
        largest = max(np.unique(over), key=lambda one: areas[one])
        # It may be the trunk, which ends in the cloth that holds all together.
        for rows in (region, region[over != largest]):
            counts = np.sort(np.bincount(of[below[rows]]))
            seen = np.unique(above[rows])
            if len(seen) < _LEAST * len(of) or len(counts) < 2 or counts[-2] < _SHARED * counts.sum():
                continue
            own = np.flatnonzero(cloth[samples.triangles] & (of == of[seen[0]]))
            triangles = np.flatnonzero(cloth & (part == of[seen[0]]))
            middles = body.vertices[body.triangles[triangles]].mean(axis=1)
            filled = _filled(places[own], np.isin(own, seen), unit)
            found = hanging.copy()
            found[triangles] |= filled[cKDTree(places[own]).query(middles)[1]]
            if _pieces(places[~found[samples.triangles]], unit) <= whole:
                hanging = found
                break
    return hanging


def _regions(places: Floats, of: Ints, above: Ints, unit: float) -> list[Ints]:
    """Tell which rows of pairs, whose upper samples are given, (p,), are near each other on one part."""
    seen, rows = np.unique(above, return_inverse=True)
    pairs = cKDTree(places[seen]).query_pairs(2 * _CLOSED * unit, output_type="ndarray")
    pairs = pairs[of[seen[pairs[:, 0]]] == of[seen[pairs[:, 1]]]]
    labels = joined_components(len(seen), pairs[:, 0], pairs[:, 1])[rows.ravel()]
    return [np.flatnonzero(labels == number) for number in range(int(labels.max()) + 1)]


def _pieces(places: Floats, unit: float) -> int:
    """Count the pieces of a body that are near to no other, as places (k, 3) on it show them."""
    pairs = cKDTree(places).query_pairs(_GAP * unit, output_type="ndarray")
    counts = np.bincount(joined_components(len(places), pairs[:, 0], pairs[:, 1]))
    return int((counts >= _PIECE * len(places)).sum())


def _lit(body: TriangleMesh, places: Floats, above: Ints, below: Ints) -> tuple[Ints, Ints]:
    """Keep those pairs of places on cloth and on skin, (p,) and (p,), between which there is light."""
    thirds = np.concatenate([(2 * places[below] + places[above]) / 3, (places[below] + 2 * places[above]) / 3])
    kept = _light(body, thirds).reshape(2, -1).min(axis=0) > _LIT
    return above[kept], below[kept]


def _facing(body: TriangleMesh, samples: AreaSamples, worn: Ints) -> tuple[Ints, Ints]:
    """Find samples that look at the inner side of some (k,): pairs of one of these and one of those, (p,) and (p,)."""
    unit, places = np.sqrt(body.area), samples.positions
    normals = body.triangle_normals[samples.triangles]
    lengths, near = cKDTree(places).query(places[worn], min(_NEAREST, len(places)), distance_upper_bound=_REACH * unit)
    near = np.where(np.isfinite(lengths), near, 0)
    ways = places[worn][:, None] - places[near]
    faces = np.einsum("kpi,kpi->kp", ways, normals[near]) > _ABOVE * lengths
    faces &= np.einsum("kpi,ki->kp", ways, normals[worn]) > _BELOW * lengths
    faces &= np.isfinite(lengths) & (lengths > _LEAST_GAP * unit)
    faces &= np.cumsum(faces, axis=1) <= _LOOKED_AT  # the nearest first
    row, column = np.nonzero(faces)
    return worn[row], near[row, column]


def _light(mesh: TriangleMesh, points: Floats) -> Floats:
    """Find from what part of all directions light falls on points (k, 3) past a surface, (k,)."""
    spacing = np.sqrt(mesh.area / _BLOCKING)
    surface = even_samples(mesh, mesh.area / _BLOCKING).positions
    lit = sum(
        (depths < 0).astype(np.float64) for depths in depths_behind(surface, points, _CELL * spacing, _DIRECTIONS)
    )
    return np.asarray(lit) / _DIRECTIONS


def _filled(places: Floats, chosen: Bools, unit: float) -> Bools:
    """Fill up what lies between chosen ones of some places (k, 3), and go on a little beyond them."""
    away = cKDTree(places[chosen]).query(places)[0]
    far = away >= _CLOSED * unit
    if not far.any():
        return away < _BEYOND * unit
    return cKDTree(places[far]).query(places)[0] > (_CLOSED - _BEYOND) * unit
