# SPDX-License-Identifier: GPL-3.0-or-later
"""Second registration of dense meshes, for details that the coarse surfaces before did not have."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ..geometry.laplacian import laplace_beltrami
from ..mesh.closest_points import ClosestPoints
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats, Ints
from ..runtime.parallel_map import shared_steps
from ..runtime.progress import Steps, within
from ..shapes.landmarks import Landmarks
from ..shapes.prepared_surface import PreparedSurface
from ..shapes.proxy import Proxy, proxy_steps
from .deformable import DeformableSurface
from .positional_constraints import Ties
from .prolongation import lift_steps
from .registration import COARSE, POLISHED, Stage, register_steps

_VERTICES = 12_000
"""About how many vertices are registered of a dense mesh: enough for each finger to have its own.  With all of 80,000
vertices the map is hardly better."""

_STRAINED = 0.05
"""Over what distance, in sqrt(area), the strain is averaged that is accepted then as how the bodies differ."""

_STIFFER = 4.0
"""How many times as stiff meshes of few vertices are: their corners lie beside the other's faces, and would pull it out
of shape.  A body of 718 vertices is off by .0083 sqrt(area) with it, by .0092 without (`test_densify`)."""


@dataclass(frozen=True, eq=False)
class FinerSurface:
    """What is registered once more of a mesh.

    Attributes
    ----------
    prepared : PreparedSurface
        The mesh, and the coarse surface that was matched in its place.
    proxy : Proxy
        What stands for its main part here: itself, if that is not dense.
    coarse : Proxy
        What was matched, as what stands for that.
    """

    prepared: PreparedSurface
    proxy: Proxy
    coarse: Proxy

    @cached_property
    def deformable(self) -> DeformableSurface:
        """The surface to register."""
        mesh = self.proxy.mesh
        return DeformableSurface(mesh, laplace_beltrami(mesh), self.prepared.cut_border(mesh))


def finer_surfaces_steps(x: PreparedSurface, y: PreparedSurface) -> Steps[tuple[FinerSurface, FinerSurface]]:
    """Make the surfaces that are registered once more: at most some 19,000 vertices each, see `proxy_steps`."""
    found = yield from shared_steps(_finer_proxy_steps, None, [(each.cleaned.mesh, each.proxy) for each in (x, y)])
    return FinerSurface(x, *found[0]), FinerSurface(y, *found[1])


def _finer_proxy_steps(_: None, given: tuple[TriangleMesh, Proxy]) -> Steps[tuple[Proxy, Proxy]]:
    """Make the proxy of a mesh that is registered once more, and say what the coarse one is to that."""
    main, coarse = given
    if coarse.is_finer:
        return coarse, Proxy.identity(coarse.mesh)
    proxy = yield from proxy_steps(main, _VERTICES)
    if proxy.is_identity:
        return proxy, coarse
    starts = coarse.points.nearest_vertices[proxy.vertices]
    points = ClosestPoints(coarse.mesh).walk(proxy.mesh.vertices, starts).on(coarse.mesh)
    return proxy, Proxy(coarse.mesh, points, proxy.points.nearest_vertices[coarse.vertices])


class Polish:
    """Registers two meshes once more, from where coarser surfaces lie on one another.

    Parameters
    ----------
    x, y : FinerSurface
        The surfaces.
    stage : Stage
        How they are registered.
    landmarks : Landmarks, optional
        What is held together.
    """

    def __init__(self, x: FinerSurface, y: FinerSurface, stage: Stage, landmarks: Landmarks | None = None) -> None:
        self._surfaces = x, y
        self._stage = stage
        self._landmarks = None if landmarks is None else (landmarks.source, landmarks.target)

    def steps(self, registered: Floats, proxy_map: Ints, here: int) -> Steps[SurfacePoints]:
        """Map every vertex of the main part of X to that of Y (`here` is 0), or of Y to that of X (1).

        Parameters
        ----------
        registered : (k, 3) array of float
            Where the vertices of the coarse surface lie, in the coordinates of the other mesh.
        proxy_map : (k,) array of int
            The matching vertices of the other coarse surface.
        here : int
            From which surface.
        """
        x, y = self._surfaces[here], self._surfaces[1 - here]
        source, target = x.deformable, y.deformable
        lift = lift_steps(
            source.mesh,
            x.coarse,
            registered,
            target.mesh,
            target_proxy=y.coarse,
            proxy_map=proxy_map,
            search=target.search,
            untangled=False,
        )
        points = yield from within(lift, 0.0, 0.2)
        start = target.in_unit_size(points.positions)
        # The bodies stay as unlike as the coarse surfaces found them.
        elastic = source.elastic.strained(start, _STRAINED)
        fewest = min(each.prepared.cleaned.mesh.vertex_count for each in (x, y))
        stiffer = _STIFFER if fewest < COARSE else 1.0
        stages = self._stage.stiffer(stiffer), POLISHED.stiffer(stiffer)
        steps = register_steps(source, target, start, stages, elastic=elastic, ties=self._ties(here))
        fine = yield from within(steps, 0.2, 0.7)
        lift = lift_steps(
            x.prepared.cleaned.mesh,
            x.proxy,
            target.in_its_units(fine.positions),
            y.prepared.cleaned.mesh,
            target_proxy=y.proxy,
            proxy_map=fine.on_target.nearest_vertices(target.triangles),
            search=y.prepared.dense_search,
        )
        return (yield from within(lift, 0.7, 1.0))

    def _ties(self, here: int) -> Ties | None:
        """Tie the landmarks of the source, wherever they are on its surface, to those of the target."""
        if self._landmarks is None:
            return None
        x, y = self._surfaces[here], self._surfaces[1 - here]
        places = self._landmarks[here], self._landmarks[1 - here]
        return Ties.of_landmarks(x.proxy, y.proxy, y.deformable, *places)
