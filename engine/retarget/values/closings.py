# SPDX-License-Identifier: GPL-3.0-or-later
"""Closings: what comes together in a shape key, such as lids and lips, comes together on another body as well."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, diags_array

from ...geometry.directions import spread_directions
from ...geometry.laplacian import laplace_beltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.closest_points import ClosestPoints, facing
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_map import SurfaceMap
from ...mesh.surface_points import interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, Ints
from ...runtime.background import can_go_beside
from ...runtime.errors import MatchError
from ...runtime.progress import Progress, Steps
from .deformation_gradients import bearers

_CLOSED = 0.25
"""Part of their distance at rest up to which two places that face each other are as good as closed: what comes only
half as near, such as a cheek to a shoulder, is not meant to meet."""

_MOVED = 0.05
"""Part of the largest offset of a key up to which a place stands still, and is not asked what it meets."""

_OPEN = 0.25
"""Part of the largest offset of a key that an opening is wide at least: narrower ones are folds of the skin."""

_BETWEEN = 0.25, 0.5, 0.75
"""Where on the line between two places it is looked whether there is anything but air: a key that flattens a belly
brings its skin together as well."""

_SEEN = 0.15
"""Part of all directions in which the middle of an opening sees out into the open at least: what comes together inside
a closed mouth is no opening.  With 0.05 to 0.2 ``python -m tests.benchmarks.faces`` has the same skin to .002; with 0.2
the depth of an opening, as in the tests, is seen no more."""

_TOUCHED = 0.02
"""Distance from the surface, as a part of the width, at which such a look ends."""

_DIRECTIONS = 20
"""Into how many directions it looks."""

_STEPS = 16
"""After how many steps, each to where the surface is next, a look that has not come out counts as blocked."""

_DOUBTED = 0.1
"""Length of the ways there and back at both ends, as a part of the width, at which an opening counts half."""

_UNLIKE = 2.0
"""By what factor an opening may be wider or narrower than most are beside the source's: more is an error of the map."""

_LOST = 1e-6
"""Part of the size of the target up to which the width of openings is lost: the map brings both sides to one place, as
where the target lacks what the key closes."""

_MOST = 0.5
"""Part of its way by which a place may go farther or less far at most."""

_MISSED = 0.1
"""Part of its width by which an opening counts half the second time that misses what is wanted of it the first time,
because its surroundings want something else."""

_FIRMLY = 30.0, 200.0
"""How much openings that stay open count against uneven ways, first and then.  Of the width, 10 % are left on the head
of the tests with 30 alone, 4 with 30 and then 200, 2 with 1,000."""


class _Closing(NamedTuple):
    """Places of a surface that face each other and come together in a key.

    Attributes
    ----------
    between : (p, n) csr_array of float
        What takes values at the n vertices to their differences, from the one place of each pair to the other.
    left : (p,) array of float
        The part of their distance that is left in the key, along the line between them; negative if they cross.
    widths : (p,) array of float
        Their distance at rest.
    areas : (p,) array of float
        How much of the surface each stands for.
    """

    between: csr_array
    left: Floats
    widths: Floats
    areas: Floats


@can_go_beside
def closings_kept_steps(
    source: TriangleMesh,
    offsets: ArrayLike,
    maps: tuple[SurfaceMap, SurfaceMap],
    target: TriangleMesh,
    carried: ArrayLike,
) -> Steps[Floats]:
    r"""Let keys close on the target what they close on the source.

    An eye that is a tenth higher than the source's stays open by a tenth when its lids go as far as the source's.  So
    pairs of places are looked for that face each other across an opening that is seen from outside, and that come
    together in a key, to a quarter of their distance or less.  On the target the same part of their distance is to be
    left, along the line between them.  For that, every place goes farther or less far along its own way: by the factor
    :math:`1 + t`, where t is the smoothest function that closes the pairs and fades over the width of the opening (a
    screened Poisson equation).

    Small pieces, such as lashes, go by the factor of what they lie on.

    Parameters
    ----------
    source : TriangleMesh
        The source, n_x vertices.
    offsets : (k, n_x, 3) array_like of float
        For each key, by how much each of its vertices moves.
    maps : pair of SurfaceMap
        Where each vertex of the source lies on the target, and the other way round: where ways there and back do not
        lead home, an opening counts less.
    target : TriangleMesh
        The target, n_y vertices.
    carried : (k, n_y, 3) array_like of float
        The keys on the target, as by `carry_offsets_steps`.

    Yields
    ------
    Progress
        After each key.

    Returns
    -------
    (k, n_y, 3) array of float
        The keys on the target, those without closings as they were.

    Raises
    ------
    MatchError
        If the keys and the map do not belong to these surfaces.
    """
    given, result = np.asarray(offsets, np.float64), np.array(carried, np.float64)
    _check(source, given, maps, target, result)
    yield Progress(0.0, "Carrying offsets")
    images = maps[0].interpolation
    trips = np.linalg.norm(images @ maps[1].positions - source.vertices, axis=1)
    seeking, ways = _Seeking(source, trips), None
    for number, key in enumerate(given):
        closing = seeking.closing(key)
        if closing is not None:
            ways = _Ways(target) if ways is None else ways
            result[number] *= (1 + ways.further(closing, images, result[number]))[:, None]
        yield Progress((number + 1) / len(given), "Carrying offsets")
    return result


def _check(
    source: TriangleMesh, offsets: Floats, maps: tuple[SurfaceMap, SurfaceMap], target: TriangleMesh, carried: Floats
) -> None:
    """Make sure that all belong together."""
    expected = (len(offsets), source.vertex_count, 3), (len(offsets), target.vertex_count, 3)
    if (offsets.shape, carried.shape) != expected:
        raise MatchError(
            f"Offsets of the source and of the target should have the shapes {expected[0]} and {expected[1]}, "
            f"but have {offsets.shape} and {carried.shape}."
        )
    maps[0].check(source, target)
    maps[1].check(target, source)


class _Seeking:
    """Finds what a key closes on a surface, but for its small pieces."""

    def __init__(self, mesh: TriangleMesh, trips: Floats) -> None:
        self._mesh, self._trips = mesh, trips
        own = bearers(mesh) == np.arange(mesh.vertex_count)
        self._own, self._triangles = own, mesh.triangles[own[mesh.triangles].all(axis=1)]
        self._search = ClosestPoints(TriangleMesh(mesh.vertices, self._triangles))
        self._normals = self._search.vertex_normals

    def closing(self, offsets: Floats) -> _Closing | None:
        """Find the places that a key (n, 3) brings together, or none."""
        rest, moved, n = self._mesh.vertices, self._mesh.vertices + offsets, self._mesh.vertex_count
        lengths = np.linalg.norm(offsets, axis=1)
        least = max(_MOVED * float(lengths[self._own].max(initial=0.0)), TINY)
        places = np.flatnonzero(self._own & (lengths > least))
        if not len(places):
            return None
        search = self._search.moved(moved)
        normals = search.vertex_normals
        found = facing(search, moved[places], -normals[places], float(np.sqrt(self._mesh.area)))
        there = interpolation_matrix(found.barycentric, self._triangles[found.triangles], n)
        apart, now = there @ rest - rest[places], there @ moved - moved[places]
        widths = np.linalg.norm(apart, axis=1)
        closed = (widths > _OPEN * lengths.max()) & (np.sqrt(found.squared_distances) <= _CLOSED * widths)
        for both in (normals, self._normals):  # in the key and at rest
            closed &= np.einsum("pd,pd->p", there @ both, both[places]) < 0
        closed &= np.einsum("pd,pd->p", apart, self._normals[places]) > 0
        closed &= np.einsum("pd,pd->p", apart, there @ self._normals) < 0
        closed[closed] = self._see(rest[places[closed]], apart[closed])
        closed[closed] = self._open(rest[places[closed]], apart[closed])
        if not closed.any():
            return None
        chosen, widths = places[closed], widths[closed]
        here = csr_array((np.ones(len(chosen)), (np.arange(len(chosen)), chosen)), shape=(len(chosen), n))
        left = np.einsum("pd,pd->p", now[closed], apart[closed]) / widths**2
        doubts = (self._trips[chosen] + there[closed] @ self._trips) / widths
        areas = np.maximum(self._mesh.vertex_areas[chosen] / (1 + np.square(doubts / _DOUBTED)), TINY)
        return _Closing(csr_array(there[closed] - here), left, widths, areas)

    def _see(self, places: Floats, lines: Floats) -> Bools:
        """Tell which places (p, 3) see the other ends of lines (p, 3) that begin there: only air is between."""
        seeing = np.ones(len(places), bool)
        for part in _BETWEEN:
            points = places + part * lines
            found = self._search.nearest(points)
            nearest, normals = (found.interpolate(self._triangles, v) for v in (self._mesh.vertices, self._normals))
            seeing &= np.einsum("pd,pd->p", points - nearest, normals) > 0
        return seeing

    def _open(self, places: Floats, lines: Floats) -> Bools:
        """Tell which middles of lines (p, 3) that begin at places (p, 3) see out of the surface."""
        low, high = self._mesh.vertices.min(axis=0), self._mesh.vertices.max(axis=0)
        directions = spread_directions(_DIRECTIONS)
        points = np.repeat(places + 0.5 * lines, len(directions), axis=0)
        ways, out = np.tile(directions, (len(places), 1)), np.zeros(len(points), bool)
        least = np.repeat(_TOUCHED * np.linalg.norm(lines, axis=1), len(directions))
        active = np.arange(len(points))
        for _ in range(_STEPS):
            free = np.sqrt(self._search.nearest(points[active]).squared_distances)
            active, free = active[free > least[active]], free[free > least[active]]
            points[active] += free[:, None] * ways[active]
            outside = ((points[active] < low) | (points[active] > high)).any(axis=1)
            out[active[outside]] = True
            active = active[~outside]
        return out.reshape(len(places), _DIRECTIONS).mean(axis=1) >= _SEEN


class _Ways:
    """Finds how much farther the places of a target are to go."""

    def __init__(self, mesh: TriangleMesh) -> None:
        parts = WeldedParts.of(mesh)
        self._vertices = mesh.vertices
        self._laplace = laplace_beltrami(parts.closed)
        self._unknowns: Ints = parts.welded[bearers(mesh)]

    def further(self, closing: _Closing, images: csr_array, ways: Floats) -> Floats:
        """Find the part of its way by which each vertex goes farther.

        Parameters
        ----------
        closing : _Closing
            What the key closes on the source.
        images : (n_x, n_y) csr_array of float
            The map of the source's vertices.
        ways : (n_y, 3) array of float
            The key as it was carried.

        Returns
        -------
        (n_y,) array of float
            t, zero for what does not move.
        """
        between = csr_array(closing.between @ images)
        apart = between @ self._vertices
        widths = np.maximum(np.linalg.norm(apart, axis=1), TINY)
        if np.median(widths) <= _LOST * np.ptp(self._vertices, axis=0).max():
            return np.zeros(len(ways))
        grown = np.log(widths / closing.widths)
        usual = float(np.median(grown))
        alike = np.flatnonzero(np.abs(grown - usual) <= np.log(_UNLIKE))
        between, widths, areas = between[alike], widths[alike], closing.areas[alike]
        lines = apart[alike] / widths[:, None]
        # All by the width: how wide each opening still is, and what going on along its own way does to it.
        yet_open = 1 - closing.left[alike] + np.einsum("pd,pd->p", between @ ways, lines) / widths
        closes = sum(diags_array(lines[:, axis] / widths) @ between @ diags_array(ways[:, axis]) for axis in range(3))

        moving = np.flatnonzero(ways.any(axis=1))
        used, numbers = np.unique(self._unknowns[moving], return_inverse=True)
        gathering = csr_array((np.ones(len(moving)), (moving, numbers.ravel())), shape=(len(ways), len(used)))
        closes = csr_array(closes @ gathering)
        fading = float(np.average(np.square(widths), weights=areas))
        mass = np.maximum(self._laplace.mass[used], TINY) / fading
        even = self._laplace.stiffness[used][:, used] + diags_array(mass)
        found = np.zeros(len(used))
        for firmly in _FIRMLY:
            misses = np.square((yet_open + closes @ found) / _MISSED) if found.any() else np.zeros(len(areas))
            weights = diags_array(firmly * np.exp(2 * usual) / fading * areas / (1 + misses))
            found = symmetric_factor(even + closes.T @ weights @ closes).solve(closes.T @ (weights @ -yet_open))
        return gathering @ np.clip(found, -_MOST, _MOST)
