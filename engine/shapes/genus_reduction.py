# SPDX-License-Identifier: GPL-3.0-or-later
"""Genus reduction: handles are cut that only one of two surfaces has, or that both have in different places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from ..geometry.handle_loops import genus, shortest_handle_loop_steps
from ..mesh.connectivity.boundary_loops import boundary_loops
from ..mesh.connectivity.edge_chains import way_to_root
from ..mesh.connectivity.halfedges import twins_of
from ..mesh.connectivity.nonmanifold_vertices import split_fans
from ..mesh.triangle_mesh import TriangleMesh
from ..repair.clean_surface import SurfacePart
from ..repair.hole_filling import fill_holes
from ..runtime.arrays import Ints, numbered
from ..runtime.progress import Steps, part_of, within
from .proxy import Proxy, proxy_steps
from .shape import Shape
from .shape_preparation import spectra_apart_steps

_MOST = 6
"""Handles that are cut at most: a surface that has so many more, such as chain mail, has them on purpose."""

_NEARER = 0.8
"""Part of what the eigenvalues of two surfaces are apart up to which handles of both are cut: bodies whose hands rest
in different places come as near as 0.3 to 0.8 of it, rings that are cut somewhere to 0.7 or not at all (``python -m
tests.benchmarks.fused_bodies``)."""


def evened_steps(x: Shape, y: Shape) -> Steps[tuple[Shape, Shape]]:
    """Cut the handles of one shape that the other has not, and those of both if that makes them more alike.

    A hand that touches the thigh, or feet that touch, are one with it in a scan: then distances along the surface take
    a short cut, and none of them is that of the body in another pose.  Such a place is a handle.  The shortest loops
    are cut: they go around where parts touch, as touching parts enclose more than they share.

    Where both have handles, these may be the same, as those of two mugs, or not, as hands on the hips and hands on the
    face.  So as many more are cut on both sides as make their eigenvalues the most alike, if that is by much: where
    distances differ, eigenvalues do.

    Parameters
    ----------
    x, y : Shape
        The source and the target.

    Returns
    -------
    x, y : Shape
        The same, or cut, with a note that says so.
    """
    handles = genus(x.mesh), genus(y.mesh)
    most, least = max(handles), min(handles)
    if most - least > _MOST or most == 0 or x is y:
        return x, y
    left = range(least, -1, -1) if most <= _MOST else range(least, least + 1)
    ways = []
    for shape, count, names, begin in (
        (x, handles[0], ("source", "target"), 0.0),
        (y, handles[1], ("target", "source"), 0.4),
    ):
        cut = yield from within(_opened_steps(shape, count - left[-1], names), begin, begin + 0.4)
        ways.append([cut[min(count - kept, len(cut) - 1)] for kept in left])
    pairs = list(zip(*ways, strict=True))
    if len(pairs) == 1:
        return pairs[0]
    apart = []
    for number, pair in enumerate(pairs):
        apart.append((yield from within(spectra_apart_steps(*pair), *part_of(number, len(pairs), 0.8))))
    best = int(np.argmin(apart))
    return pairs[best if apart[best] < _NEARER * apart[0] else 0]


def _opened_steps(shape: Shape, count: int, names: tuple[str, str]) -> Steps[list[Shape]]:
    """Cut a shape along the shortest loops of so many handles, one by one: it with no cut, with one, and so on."""
    surface, opened = shape.surface, [shape]
    name, other = names
    note = f"The {name} hangs together where the {other} does not: it was cut open there for matching."
    notes = (*surface.cleaned.notes, note)
    for number in range(count):
        begin, middle, end = number / count, (number + 0.5) / count, (number + 1) / count
        lids = surface.cleaned.main.original_vertices[surface.proxy.vertices] < 0
        found = yield from within(shortest_handle_loop_steps(surface.mesh, lids), begin, middle)
        loop = _on_dense(surface.proxy, surface.cleaned.mesh, found)
        main = cut_along(surface.cleaned.main, loop)
        if main is None:
            break
        if surface.proxy.is_identity:
            proxy = Proxy.identity(main.mesh)
        else:
            proxy = yield from within(proxy_steps(main.mesh, surface.mesh.vertex_count), middle, end)
        cleaned = replace(surface.cleaned, pieces=(main, *surface.cleaned.pieces[1:]), notes=notes)
        surface = replace(surface, cleaned=cleaned, proxy=proxy)
        opened.append(Shape.of(surface))
    return opened


def cut_along(part: SurfacePart, loop: Ints) -> SurfacePart | None:
    """Cut a surface open along a loop and close both sides.

    Parameters
    ----------
    part : SurfacePart
        The surface.
    loop : (k,) array of int
        Vertices of a loop of edges, each once; the surface hangs together without it.

    Returns
    -------
    SurfacePart or None
        The surface with a second copy of each vertex of the loop, and a fan of triangles in each of the two openings;
        None if what is given is not such a loop.
    """
    mesh = part.mesh
    twins = twins_of(mesh.vertices, mesh.triangles)
    tails, heads = mesh.triangles.ravel(), np.roll(mesh.triangles, -1, axis=1).ravel()
    following = np.full(mesh.vertex_count, -1)
    following[loop] = np.roll(loop, -1)
    cut = np.flatnonzero(((following[tails] == heads) | (following[heads] == tails)) & (twins >= 0))
    if len(loop) < 3 or len(cut) != 2 * len(loop):
        return None
    twins[cut] = -1
    triangles, copied = split_fans(mesh.triangles, twins, mesh.vertex_count)
    if len(copied) != len(loop):
        return None
    vertices = np.concatenate([mesh.vertices, mesh.vertices[copied]])
    loops = boundary_loops(vertices, triangles, cut)
    if loops.count != 2:
        return None
    centres, lids = fill_holes(loops, np.ones(2, bool), len(vertices))
    cut_mesh = TriangleMesh(np.concatenate([vertices, centres]), np.concatenate([triangles, lids]))
    if cut_mesh.component_count > 1:
        return None
    added = np.full(len(lids), -1)
    return replace(
        part,
        mesh=cut_mesh,
        original_vertices=np.concatenate([part.original_vertices, part.original_vertices[copied], [-1, -1]]),
        original_triangles=np.concatenate([part.original_triangles, added]),
        turned=np.concatenate([part.turned, np.zeros(len(lids), bool)]),
    )


def _on_dense(proxy: Proxy, mesh: TriangleMesh, loop: Ints) -> Ints:
    """Find the loop of a dense mesh (k',) that goes where one of its proxy does; nothing if there is none."""
    if proxy.is_identity:
        return loop
    ring = proxy.mesh.edges[np.isin(proxy.mesh.edges, loop).any(axis=1)]
    band = np.flatnonzero(np.isin(proxy.points.nearest_vertices, ring))
    number = numbered(band, mesh.vertex_count)
    inside = (number[mesh.edges] >= 0).all(axis=1)
    a, b = number[mesh.edges[inside]].T
    graph = coo_array((mesh.edge_lengths[inside], (a, b)), shape=(len(band),) * 2).tocsr()
    stops = number[proxy.vertices[loop]]
    if (stops < 0).any():
        return np.empty(0, np.int64)
    distances, before = dijkstra(graph, directed=False, indices=stops, return_predecessors=True)
    way: list[int] = []
    for i, end in enumerate(np.roll(stops, -1)):
        if not np.isfinite(distances[i, end]):
            return np.empty(0, np.int64)
        way += way_to_root(before[i], end)[:0:-1]
    return band[_longest_simple(way)]


def _longest_simple(way: list[int]) -> list[int]:
    """Leave out of a closed way (a list of vertices) the short loops in it, so that each vertex comes once."""
    simple: list[int] = []
    for vertex in way:
        if vertex in simple:
            at = simple.index(vertex)
            if 2 * (len(simple) - at) > len(way):
                return simple[at:]
            del simple[at:]
        simple.append(vertex)
    return simple
