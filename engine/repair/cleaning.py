# SPDX-License-Identifier: GPL-3.0-or-later
"""Cleaning: surfaces that can be matched, from a mesh as artists leave it."""

from __future__ import annotations

import numpy as np

from ..mesh.connectivity.boundary_loops import boundary_loops
from ..mesh.connectivity.components import triangle_components
from ..mesh.connectivity.halfedges import EdgeGroups, group_half_edges, pair_half_edges, repeated_triangles
from ..mesh.connectivity.mesh_orientation import inward_components, orient_consistently, turn_triangles
from ..mesh.connectivity.nonmanifold_vertices import split_fans
from ..mesh.connectivity.vertex_welding import weld_boundaries
from ..mesh.triangle_mesh import TriangleMesh, triangle_areas
from ..runtime.arrays import Bools, Floats, Ints, group_means, marked, numbered
from ..runtime.errors import MeshError
from .border_seams import seam_partners
from .clean_surface import CleanSurface, SurfacePart
from .cleaning_notes import CleaningCounts, cleaning_notes
from .hole_filling import fill_holes, small_holes
from .pinched_gaps import pinched_gaps
from .spikes import find_spikes, pulled_in

_MOST_OPEN = 1.0
"""Length of its open borders, in the root of its area, from which on a part counts as if it were half as large."""

_FEW = 50
"""Vertices of a part that counts as if it were half as large: a floor under a body may have four corners."""

_MOST_PARTS = 256
"""Parts that are kept beside the main one, the largest; there may be thousands of hairs or crumbs."""


def clean(mesh: TriangleMesh, name: str = "mesh", left_out: Bools | None = None) -> CleanSurface:
    """Make a mesh into oriented manifolds.

    In this order: vertices along open seams, and across narrow gaps between pieces, are welded; triangles without three
    different vertices, and repeated ones, left out; edges of more than two triangles opened; triangles turned to agree
    with their neighbours; single missing faces put back where gaps meet; vertices split at which sheets only touch;
    single vertices that stick out pulled in; parts turned that look inward; small holes of the main part filled.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.
    name : str
        What the notes call it, such as 'source'.
    left_out : (n,) array of bool, optional
        Vertices whose faces were left out on purpose: notes do not count them among the loose ones.

    Returns
    -------
    CleanSurface
        The parts, and the way back.

    Raises
    ------
    MeshError
        If nothing with an area is left.

    Notes
    -----
    Time grows as n log n; a mesh that is clean already is found to be so by two sorts and shares its arrays with the
    result.
    """
    work = _Work(mesh)
    groups, representatives = _weld(work)
    repeated = repeated_triangles(work.triangles, groups)
    if repeated.any():
        work.counts.repeated = int(repeated.sum())
        work.keep(~repeated)
        groups = group_half_edges(work.triangles, len(work.vertices))
    _make_manifold(work, groups)
    _pull_in_spikes(work)
    inward = inward_components(work.vertices, work.triangles, work.twins, work.components)
    work.turn(inward[work.components])
    work.counts.loose = _loose_vertices(mesh, left_out)
    return _in_parts(mesh, work, inward, representatives, name)


def _loose_vertices(mesh: TriangleMesh, left_out: Bools | None) -> int:
    """Count the vertices without a face, but for those whose faces were left out on purpose."""
    loose = np.bincount(mesh.triangles.ravel(), minlength=mesh.vertex_count) == 0
    return int((loose if left_out is None else loose & ~left_out).sum())


class _Work:
    """The mesh while it is being cleaned."""

    def __init__(self, mesh: TriangleMesh) -> None:
        self.vertices = mesh.vertices
        self.triangles = mesh.triangles
        self.areas = mesh.triangle_areas
        self.origins = np.arange(mesh.triangle_count)  # the original triangle
        self.turned = np.zeros(mesh.triangle_count, bool)  # against the original
        self.counts = CleaningCounts()
        self.copied = np.empty(0, np.int64)  # the original vertex of each vertex beyond the original ones
        self.twins = np.empty(0, np.int64)
        self.components = np.empty(0, np.int64)  # of each triangle

    def keep(self, kept: Bools) -> None:
        """Leave out triangles."""
        self.triangles, self.areas = self.triangles[kept], self.areas[kept]
        self.origins, self.turned = self.origins[kept], self.turned[kept]
        if len(self.twins):
            number = np.append(np.cumsum(kept) - 1, -1)
            number[:-1][~kept] = -1
            twins = self.twins.reshape(-1, 3)[kept].ravel()
            triangle = number[np.where(twins >= 0, twins // 3, -1)]
            self.twins = np.where(triangle >= 0, 3 * triangle + twins % 3, -1)

    def move(self, vertices: Floats, moved: Ints) -> None:
        """Put all vertices to where they are now, after some of them (k,) have moved."""
        affected = np.flatnonzero(marked(moved, len(vertices))[self.triangles].any(axis=1))
        self.vertices, self.areas = vertices, self.areas.copy()
        self.areas[affected] = triangle_areas(vertices, self.triangles[affected])

    def turn(self, turned: Bools) -> None:
        """Turn triangles over."""
        self.triangles, self.twins = turn_triangles(self.triangles, self.twins, turned)
        self.turned = self.turned ^ turned

    def split(self) -> None:
        """Give each fan of triangles a vertex of its own."""
        self.triangles, copied = split_fans(self.triangles, self.twins, len(self.vertices))
        if len(copied):
            original_count = len(self.vertices) - len(self.copied)
            sources = np.concatenate([np.arange(original_count), self.copied])[copied]
            self.vertices = np.concatenate([self.vertices, self.vertices[copied]])
            self.copied = np.concatenate([self.copied, sources])


def _weld(work: _Work) -> tuple[EdgeGroups, Ints]:
    """Weld vertices along seams and gaps: the edges then, and the vertex that stands for each (n,)."""
    groups = group_half_edges(work.triangles, len(work.vertices))
    representatives = weld_boundaries(work.vertices, work.triangles, groups)
    groups, work.counts.welded = _merged(work, groups, representatives)
    partners = seam_partners(work.vertices, work.triangles, groups)
    groups, work.counts.joined = _merged(work, groups, partners)
    return groups, partners[representatives]


def _merged(work: _Work, groups: EdgeGroups, representatives: Ints) -> tuple[EdgeGroups, int]:
    """Let vertices be moved to those that stand for them (n,): the edges then, and how many were moved."""
    n = len(work.vertices)
    moved = np.flatnonzero(representatives != np.arange(n))
    if not len(moved):
        return groups, 0
    # A welded vertex lies in the middle of its copies, so that their order does not matter.
    involved = np.unique(np.concatenate([moved, representatives[moved]]))
    homes, number = np.unique(representatives[involved], return_inverse=True)
    offsets = work.vertices[involved] - work.vertices[representatives[involved]]
    vertices = work.vertices.copy()
    vertices[homes] += group_means(number, offsets, len(homes))
    work.triangles = triangles = representatives[work.triangles]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    work.move(vertices, involved)
    work.counts.degenerate += int((~proper).sum())
    if not proper.all():
        work.keep(proper)
    if not len(work.triangles):
        raise MeshError("No triangle of the mesh has three different corners. Check its scale and its vertices.")
    return group_half_edges(work.triangles, n), len(moved)


def _make_manifold(work: _Work, groups: EdgeGroups) -> None:
    """Pair the triangles across edges, orient them, and separate sheets that touch in edges or vertices."""
    work.twins = pair_half_edges(work.vertices, work.triangles, groups)
    work.counts.crowded = int((groups.counts > 2).sum())
    orientation = orient_consistently(work.triangles, work.areas, work.twins)
    work.counts.turned = int(orientation.turned.sum())
    work.counts.one_sided = orientation.twins is not work.twins
    work.components, work.twins = orientation.components, orientation.twins
    work.turn(orientation.turned)
    _fill_pinched_gaps(work)
    work.split()
    if not work.counts.crowded:
        work.counts.touching = len(work.copied)
    if work.counts.crowded or work.counts.one_sided:
        _leave_out_crowding(work)


def _fill_pinched_gaps(work: _Work) -> None:
    """Put single faces back that are missing where gaps meet, instead of cutting the surface apart there."""
    faces, half_edges = pinched_gaps(work.vertices, work.triangles, work.twins, float(work.areas.sum()))
    if not len(faces):
        return
    work.counts.filled = len(faces)
    work.twins = np.append(work.twins, half_edges.ravel())
    work.twins[half_edges.ravel()] = 3 * len(work.triangles) + np.arange(half_edges.size)
    work.triangles = np.concatenate([work.triangles, faces])
    work.areas = np.append(work.areas, triangle_areas(work.vertices, faces))
    work.origins = np.append(work.origins, np.full(len(faces), -1))
    work.turned = np.append(work.turned, np.zeros(len(faces), bool))
    work.components = triangle_components(work.twins)


def _leave_out_crowding(work: _Work) -> None:
    """Leave out triangles until no two sheets share an edge.

    Two sheets that touch in an edge may hang together around both of its ends; then no splitting of vertices parts
    them, and the smaller one loses its triangles there.
    """
    while True:
        groups = group_half_edges(work.triangles, len(work.vertices))
        first = groups.order[groups.starts]
        crowded = np.flatnonzero((groups.counts > 2) | ((groups.counts == 2) & (work.twins[first] < 0)))
        if not len(crowded):
            break
        group = np.repeat(np.arange(len(groups.counts)), groups.counts)
        members = np.isin(group, crowded)
        half_edges, group = groups.order[members], group[members]
        twins = work.twins[half_edges]
        paired = twins >= 0
        sizes = work.areas[half_edges // 3] + np.where(paired, work.areas[twins // 3], 0)
        order = np.lexsort((sizes, paired, group))
        best = order[np.append(group[order][1:] != group[order][:-1], True)]
        staying = np.concatenate([half_edges[best], twins[best]])
        kept = ~marked(half_edges[~np.isin(half_edges, staying)] // 3, len(work.triangles))
        work.counts.left_out += int((~kept).sum())
        work.keep(kept)
        work.split()
    if work.counts.left_out:
        work.components = triangle_components(work.twins)


def _pull_in_spikes(work: _Work) -> None:
    """Move single vertices that stick out back to their neighbours: they would be taken for limbs."""
    spikes = find_spikes(work.vertices, work.triangles)
    work.counts.spikes = len(spikes)
    if len(spikes):
        work.move(pulled_in(work.vertices, work.triangles, spikes), spikes)


def _in_parts(mesh: TriangleMesh, work: _Work, inward: Bools, representatives: Ints, name: str) -> CleanSurface:
    """Take the mesh apart, and fill the holes of the main part."""
    components, counts = work.components, work.counts
    areas: Floats = np.bincount(components, work.areas).astype(np.float64)
    order = _main_first(work, areas)
    if not len(order):
        raise MeshError("Nothing of the mesh has an area once repeated and degenerate faces are left out.")
    order = order[: _MOST_PARTS + 1]
    triangle_parts = numbered(order, len(areas))[components]

    vertex_parts = np.full(len(work.vertices), -1)
    vertex_parts[work.triangles] = triangle_parts[:, None]
    by_part = np.argsort(vertex_parts, kind="stable")
    starts = np.searchsorted(vertex_parts[by_part], np.arange(-1, len(order) + 1))
    local = np.empty(len(work.vertices), np.int64)
    local[by_part] = np.arange(len(by_part)) - starts[vertex_parts[by_part] + 1]
    local[vertex_parts < 0] = -1

    sources = np.concatenate([np.arange(mesh.vertex_count), work.copied])
    triangle_order = np.argsort(triangle_parts, kind="stable")
    triangle_starts = np.searchsorted(triangle_parts[triangle_order], np.arange(len(order) + 1))
    pieces = []
    for part, component in enumerate(order):
        chosen = triangle_order[triangle_starts[part] : triangle_starts[part + 1]]
        members = by_part[starts[part + 1] : starts[part + 2]]
        piece = (work.vertices[members], local[work.triangles[chosen]], sources[members], work.origins[chosen])
        turned = work.turned[chosen]
        if part == 0:
            open_half_edges = np.flatnonzero(work.twins.reshape(-1, 3)[chosen].ravel() < 0)
            piece, filled, counts.left_open = _filled(piece, open_half_edges, float(areas[component]))
            counts.filled += filled
            turned = np.concatenate([turned, np.zeros(len(piece[1]) - len(turned), bool)])
        vertices, triangles, original_vertices, original_triangles = piece
        unchanged = len(vertices) == mesh.vertex_count and np.array_equal(triangles, mesh.triangles)
        unchanged = unchanged and np.array_equal(vertices, mesh.vertices)
        part_mesh = mesh if unchanged else TriangleMesh(vertices, triangles)
        pieces.append(SurfacePart(part_mesh, original_vertices, original_triangles, turned))

    images = _images(vertex_parts, work.copied, representatives)
    counts.inverted = bool(inward[order[0]])
    counts.parts = len(areas) - 1
    notes = cleaning_notes(name, counts)
    return CleanSurface(mesh, tuple(pieces), vertex_parts[images], local[images], notes, counts)


def _main_first(work: _Work, areas: Floats) -> Ints:
    """Order the components by area, but put the main one first: a body may be smaller than its clothes, but is closed.

    Those without an area (c,) are left out.
    """
    order = np.argsort(-areas, kind="stable")
    order = order[areas[order] > 0]
    borders = np.flatnonzero(work.twins < 0)
    ends = work.triangles[borders // 3, borders % 3], work.triangles[borders // 3, (borders + 1) % 3]
    lengths = np.linalg.norm(work.vertices[ends[0]] - work.vertices[ends[1]], axis=1)
    openness = np.bincount(work.components[borders // 3], lengths, len(areas))[order] / np.sqrt(areas[order])
    counts = np.bincount(work.components, minlength=len(areas))[order] / 2  # a surface has half as many vertices
    weights = areas[order] / (1 + np.minimum(openness / _MOST_OPEN, 1)) / (1 + _FEW / counts)
    main = order[weights.argmax()] if len(order) else -1
    return np.concatenate([order[order == main], order[order != main]])


_Piece = tuple[Floats, Ints, Ints, Ints]


def _filled(piece: _Piece, open_half_edges: Ints, area: float) -> tuple[_Piece, int, int]:
    """Fill the small holes of a part: the part, and how many holes were filled and left open."""
    vertices, triangles, original_vertices, original_triangles = piece
    if not len(open_half_edges):
        return piece, 0, 0
    loops = boundary_loops(vertices, triangles, open_half_edges)
    small = small_holes(vertices, triangles, loops, area)
    centres, fans = fill_holes(loops, small, len(vertices))
    piece = (
        np.concatenate([vertices, centres]),
        np.concatenate([triangles, fans]),
        np.concatenate([original_vertices, np.full(len(centres), -1)]),
        np.concatenate([original_triangles, np.full(len(fans), -1)]),
    )
    return piece, int(small.sum()), int((~small).sum())


def _images(vertex_parts: Ints, copied: Ints, representatives: Ints) -> Ints:
    """For each original vertex, which of the copies of the vertex that stands for it is in the largest part."""
    n = len(representatives)
    best = np.arange(n)
    if len(copied):
        parts = np.where(vertex_parts >= 0, vertex_parts, vertex_parts.max() + 1)
        candidates = np.concatenate([copied, np.arange(n)[copied]])
        vertices = np.concatenate([n + np.arange(len(copied)), copied])
        order = np.lexsort((vertices, parts[vertices], candidates))
        first = np.append(True, candidates[order][1:] != candidates[order][:-1])
        best[candidates[order[first]]] = vertices[order[first]]
    return best[representatives]
