# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of every vertex from the map of the main part: what is beside that follows it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...mesh.closest_points import ClosestPoints
from ...mesh.surface_points import SurfacePoints
from ...mesh.triangle_mesh import TriangleMesh
from ...repair.clean_surface import CleanSurface, SurfacePart
from ...runtime.arrays import Floats, Ints
from ...runtime.parallel_map import shared_steps
from ...runtime.progress import Progress, Steps, within
from .attached_sheets import MappedSheets, mapped_sheets
from .component_alignment import laid_steps
from .component_pairs import Contact, contact_with, paired_parts
from .similarity_field import Surroundings

_TRUSTED_DISTANCE = 0.05
"""Distance from what is followed at which confidence is halved, in units of the root of the main part's area."""

_NEAR, _NEARLY = 0.02, 2.0
"""Parts follow what is mapped if they are as near to it, in units of the root of the main part's area, or at most so
many times as far from it as the nearest is; the others wait for those."""

_LARGE, _MOST_LARGE, _THOROUGHLY = 0.005, 24, 40_000
"""Parts of at least so much of the main part's area are laid onto their partners thoroughly: so many at most, with so
many vertices together."""

_MOST_WAVES = 12
"""How often parts that were found are followed by further ones."""

_RATHER = 0.5
"""What is so much nearer to another mapped part than to the main one follows that."""


@dataclass(frozen=True, eq=False)
class FollowedMap:
    """A map of every vertex of an original mesh.

    Attributes
    ----------
    points : SurfacePoints
        For each vertex of X, a point of the original mesh Y.
    confidence : (n,) array of float
        For each, a factor between 0 and 1 for the confidence of the map of the main part at `surroundings`: 1 for the
        vertices of the main part itself, and for those of parts that have one on Y.
    surroundings : (n,) array of int
        The vertex of the main part of X that each is, or that is nearest to it.
    partners : (p,) array of int
        For each part of X, the part of Y that it is mapped to; 0 for the main part.  A part other than the main one
        with 0 follows its surroundings onto what those are mapped to.
    alone : float
        Part of the surface of X that is in such parts without one of Y.
    """

    points: SurfacePoints
    confidence: Floats
    surroundings: Ints
    partners: Ints
    alone: float


def follow_steps(x: CleanSurface, y: CleanSurface, main_map: SurfacePoints) -> Steps[FollowedMap]:
    """Extend a map of the main part to every vertex of the mesh.

    Parameters
    ----------
    x, y : CleanSurface
        The meshes.
    main_map : SurfacePoints
        For each vertex of ``x.mesh``, a point of ``y.mesh``.

    Yields
    ------
    Progress
        After each part that was mapped.

    Returns
    -------
    FollowedMap
        A point of ``y.original`` for each vertex of ``x.original``.

    Notes
    -----
    Beside the main part there may be eyes, teeth, buttons, and loose vertices, or sleeves, hands and boots.  Where they
    are expected on Y is known from how the main part moves around them.  If Y has a part there of about the same size
    and shape, that part is the partner: the two are laid over each other, and each vertex is mapped to the closest
    point.  What touches such parts only, as a hand does a sleeve, follows them in turn.  What finds no partner goes to
    the closest point of what it follows, searched from the image of the nearest vertex along the surface, so that it
    does not jump to another limb.  Sheets that touch each other, as those of an eye do, are mapped before, one by one.
    """
    n = x.original.vertex_count
    triangles, barycentric, confidence = np.empty(n, np.int64), np.empty((n, 3)), np.ones(n)
    surroundings = np.maximum(x.vertex_images, 0)
    partners = np.zeros(len(x.pieces), np.int64)
    known = x.vertex_parts == 0
    main = np.flatnonzero(known)
    triangles[main], barycentric[main] = y.main.to_original(*x.images_of(main, main_map, y.mesh))
    others = np.flatnonzero(~known)
    if len(others):
        body = _Mapped(x.pieces, y.pieces, {0: _Image(0, main_map)})
        distances, surroundings[others] = body.around.nearest(x.original.vertices[others])
        sheets = mapped_sheets(x, y, body.around)
        yield Progress(0.0, "Mapping every vertex")
        maps = _PartMaps(x, y, body, sheets)
        yield from maps.find_steps()
        parts = maps.mapped
        for number, image in parts.items():
            vertices = np.flatnonzero(x.vertex_parts == number)
            partner, at = y.pieces[image.partner], x.vertex_images[vertices]
            triangles[vertices], barycentric[vertices] = partner.to_original(
                image.points.triangles[at], image.points.barycentric[at]
            )
            partners[number] = image.partner
            known[vertices] = True
        triangles[sheets.vertices], barycentric[sheets.vertices] = sheets.triangles, sheets.barycentric
        partners[x.vertex_parts[sheets.vertices]], known[sheets.vertices] = sheets.partners, True
        alone, distances = others[~known[others]], distances[~known[others]]
        followed = [body] if not parts else [body, _Mapped(x.pieces, y.pieces, parts)]
        for vertices, away, mapped in _by_what_they_follow(x.original.vertices, alone, distances, followed):
            triangles[vertices], barycentric[vertices] = mapped.carried(x.original.vertices[vertices], away)
            confidence[vertices] = 1 / (1 + (away / (_TRUSTED_DISTANCE * np.sqrt(x.mesh.area))) ** 2)
    points = SurfacePoints.from_barycentric(y.original, triangles, barycentric)
    areas = np.array([piece.mesh.area for piece in x.pieces])
    alone = float(areas[1:][partners[1:] == 0].sum() / areas.sum())
    return FollowedMap(points, confidence, surroundings, partners, alone)


class _Image(NamedTuple):
    """The part that another one is mapped to, and a point there for each of its vertices."""

    partner: int
    points: SurfacePoints


class _Mapped:
    """Parts that are mapped, by their numbers: what is near to them moves as they do."""

    def __init__(
        self, x_pieces: Sequence[SurfacePart], y_pieces: Sequence[SurfacePart], images: Mapping[int, _Image]
    ) -> None:
        self._partners = [y_pieces[image.partner] for image in images.values()]
        here = TriangleMesh.concatenated([x_pieces[number].mesh for number in images])
        self._there = TriangleMesh.concatenated([partner.mesh for partner in self._partners])
        counts = [partner.mesh.triangle_count for partner in self._partners]
        self._firsts = np.concatenate([[0], np.cumsum(counts)])
        found = [image.points for image in images.values()]
        triangles = [points.triangles + first for points, first in zip(found, self._firsts[:-1], strict=True)]
        barycentric = np.concatenate([points.barycentric for points in found])
        self._images = SurfacePoints.from_barycentric(self._there, np.concatenate(triangles), barycentric)
        self.around = Surroundings(here, self._there, self._images)

    @cached_property
    def _tree(self) -> cKDTree:
        """Search for the vertices that these are mapped to."""
        return cKDTree(self._there.vertices, balanced_tree=False, compact_nodes=False)

    def contact(self, part: TriangleMesh) -> Contact:
        """Find where a part of X is next to these."""
        return contact_with(self.around.nearest(part.vertices)[0], part)

    def contact_there(self, part: TriangleMesh) -> Contact:
        """Find where a part of Y is next to what these are mapped to."""
        return contact_with(self._tree.query(part.vertices)[0], part)

    def carried(self, points: Floats, distances: Floats) -> tuple[Ints, Floats]:
        """Take points (k, 3), at distances (k,), along: triangles of the other original mesh (k,), and (k, 3) there."""
        moved = self.around.similarities(points, distances)(points)
        _, nearest = self.around.nearest(points)
        found = ClosestPoints(self._there).walk(moved, self._images.nearest_vertices[nearest])
        triangles, barycentric = found.triangles.copy(), found.barycentric.copy()
        owners = np.searchsorted(self._firsts, found.triangles, side="right") - 1
        for number in np.unique(owners):
            its = owners == number
            inside = found.triangles[its] - self._firsts[number]
            triangles[its], barycentric[its] = self._partners[number].to_original(inside, found.barycentric[its])
        return triangles, barycentric


class _PartMaps:
    """Maps parts beside the main one onto their partners, those next to the main one first."""

    def __init__(self, x: CleanSurface, y: CleanSurface, body: _Mapped, sheets: MappedSheets) -> None:
        self._x, self._y, self._body = x, y, body
        self._free = set(range(1, len(y.pieces))) - set(sheets.partners)
        self._done = set(x.vertex_parts[sheets.vertices])
        areas = np.array([piece.mesh.area for piece in x.pieces])
        counts = np.array([piece.mesh.vertex_count for piece in x.pieces])
        counts[0] = 0
        thoroughly = (areas >= _LARGE * areas[0]) & (np.cumsum(counts) <= _THOROUGHLY)
        self._large = frozenset(np.flatnonzero(thoroughly[: _MOST_LARGE + 1]))
        self.mapped: dict[int, _Image] = {}

    def find_steps(self) -> Steps[None]:
        """Fill `mapped`."""
        pieces = enumerate(self._x.pieces)
        meshes = {number: piece.mesh for number, piece in pieces if number and number not in self._done}
        waiting = {number: self._body.contact(mesh) for number, mesh in meshes.items()}
        parts: _Mapped | None = None
        for wave in range(_MOST_WAVES):
            if not waiting or not self._free:
                break
            touching: dict[int, Contact] = {}
            if parts is not None:
                others = {number: parts.contact(meshes[number]) for number in waiting}
                touching = {number: contact for number, contact in others.items() if contact.gap < waiting[number].gap}
            gaps = {number: touching.get(number, contact).gap for number, contact in waiting.items()}
            farthest = max(_NEAR * np.sqrt(self._x.mesh.area), _NEARLY * min(gaps.values()))
            ready = {number for number, gap in gaps.items() if gap <= farthest or wave == _MOST_WAVES - 1}
            before = len(self.mapped)
            yield from self._map_steps({number: waiting[number] for number in ready - touching.keys()}, self._body)
            if parts is not None:
                yield from self._map_steps({number: touching[number] for number in ready & touching.keys()}, parts)
            waiting = {number: contact for number, contact in waiting.items() if number not in ready}
            if len(self.mapped) > before:
                parts = _Mapped(self._x.pieces, self._y.pieces, self.mapped)

    def _map_steps(self, contacts: Mapping[int, Contact], followed: _Mapped) -> Steps[None]:
        """Map those of some parts that have a partner among the free ones."""
        if not contacts:
            return
        numbers, candidates = sorted(contacts), sorted(self._free)
        here, there = ([c.pieces[i].mesh for i in chosen] for c, chosen in ((self._x, numbers), (self._y, candidates)))
        unit = float(np.sqrt(self._y.mesh.area))
        touching = [contacts[number] for number in numbers], [followed.contact_there(part) for part in there]
        large = np.isin(numbers, list(self._large))
        pairs = paired_parts((here, touching[0]), (there, touching[1]), followed.around, unit, large)
        items = [(here[pair.part], there[pair.partner], pair, bool(large[pair.part])) for pair in pairs]
        done = len(self.mapped) / len(self._x.pieces), (len(self.mapped) + len(items)) / len(self._x.pieces)
        laid = yield from within(shared_steps(laid_steps, followed.around, items), *done, "Mapping every vertex")
        for pair, found in zip(pairs, laid, strict=True):
            self.mapped[numbers[pair.part]] = _Image(candidates[pair.partner], found.on(there[pair.partner]))
            self._free.remove(candidates[pair.partner])


def _by_what_they_follow(
    vertices: Floats, alone: Ints, distances: Floats, followed: list[_Mapped]
) -> list[tuple[Ints, Floats, _Mapped]]:
    """Group vertices by what they follow, with the distances from that: the main part, or others that are nearer."""
    if len(followed) == 1 or not len(alone):
        return [(alone, distances, followed[0])] if len(alone) else []
    from_parts, _ = followed[1].around.nearest(vertices[alone])
    nearer = from_parts < _RATHER * distances
    groups = (~nearer, distances, followed[0]), (nearer, from_parts, followed[1])
    return [(alone[chosen], away[chosen], mapped) for chosen, away, mapped in groups if chosen.any()]
