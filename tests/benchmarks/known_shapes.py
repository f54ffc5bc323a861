# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes with known correspondence for the benchmarks of dense maps: which pairs, and the error of a map between two.

A folder holds a folder per dataset, and anywhere in that .off files with, beside them, a folder `corres` of NAME.vts
and NAME.sym.vts: line i of two shapes names the same place, in the latter file its mirror image (the layout of the
remeshed TOSCA and FAUST collections).

The error of a place is the geodesic distance on the target (potpourri3d's heat method) from its true image to the image
under the map, over the square root of the target's area, times 100.  400 places are drawn at random, always the same.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import potpourri3d
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra

from engine import TriangleMesh
from tests.benchmarks.common import interpolated, known, read_off

SAMPLES = 400

LISTED = (
    "cat0:cat1,cat2:cat8,cat5:cat10,dog0:dog5,dog1:dog8,wolf0:wolf2,michael0:michael3,michael6:michael14,"
    "michael1:michael19,"
    "tr_reg_000:tr_reg_004,tr_reg_002:tr_reg_017,tr_reg_011:tr_reg_035,tr_reg_023:tr_reg_008,tr_reg_038:tr_reg_003,"
    "tr_reg_014:tr_reg_029,"
    "8_gorilla_01:8_man_01,8_man_03:8_gorilla_03"
)

MIXTURE = ("TOSCA_Isometric", "FAUST", "TOSCA_Isometric", "FAUST", "TOSCA_Isometric", "FAUST", "TOSCA_nonIsometric")
MIXTURE += ("FAUST", "TOSCA_Isometric", "FAUST")
"""Datasets that random pairs are taken from, in turns."""

LOST = 20.0
"""Error from which on a place counts as brought to the wrong part of the body."""

PATCH = 0.03
"""Connected parts of the surface smaller than this share of its area do not count as a limb."""


@dataclass(frozen=True, eq=False)
class KnownShape:
    """A surface and where on it the places are that all shapes of its kind share: vertices (t,), and mirrored (t,)."""

    name: str
    dataset: str
    mesh: TriangleMesh
    places: np.ndarray
    mirrored: np.ndarray

    @cached_property
    def chosen(self):
        """The places that errors are measured at, (k,)."""
        return np.random.default_rng(0).permutation(len(self.places))[:SAMPLES]

    @cached_property
    def samples(self):
        """Their vertices, (k,)."""
        return self.places[self.chosen]

    @cached_property
    def _rows(self):
        """Distances from the chosen places, and from the mirrored ones, to all vertices: (2, k, n)."""
        solver = potpourri3d.MeshHeatMethodDistanceSolver(self.mesh.vertices, self.mesh.triangles)
        rows = np.empty((2, len(self.chosen), self.mesh.vertex_count), np.float32)
        for block, images in zip(rows, (self.places, self.mirrored), strict=True):
            for row, vertex in zip(block, images[self.chosen], strict=True):
                row[:] = solver.compute_distance(int(vertex))
        rows /= np.sqrt(self.mesh.area)
        return rows

    def vertex_errors(self, vertices, *, mirrored=False):
        """Errors x 100 of vertices (k,) as the images of the chosen places, (k,)."""
        rows = self._rows[int(mirrored)]
        return 100 * rows[np.arange(len(rows)), vertices].astype(float)

    def point_errors(self, points):
        """Errors x 100 of points (k,) anywhere on the surface as the images of the chosen places, (k,)."""
        rows = self._rows[0]
        at_corners = rows[np.arange(len(rows))[:, None], points.corners].astype(float)
        return 100 * interpolated(self.mesh, at_corners, points)

    @cached_property
    def _regions(self):
        """For each vertex the sample nearest to it along edges, (n,); samples at the same vertex count once."""
        first = np.unique(self.samples, return_index=True)[1]
        n, (a, b) = self.mesh.vertex_count, self.mesh.edges.T
        graph = coo_array((self.mesh.edge_lengths, (a, b)), shape=(n, n)).tocsr()
        _, _, nearest = dijkstra(
            graph, directed=False, indices=self.samples[first], min_only=True, return_predecessors=True
        )
        number = np.full(n + 1, -1)  # the last for vertices without a path, which dijkstra numbers below zero
        number[self.samples[first]] = first
        return number[np.where(nearest < 0, n, nearest)]

    def largest_patch(self, wrong):
        """Share of the area of the largest connected part whose samples are all marked in `wrong` (k,)."""
        inside = np.append(wrong, [False])[self._regions]
        a, b = self.mesh.edges[inside[self.mesh.edges].all(axis=1)].T
        n = self.mesh.vertex_count
        _, labels = connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(n, n)), directed=False)
        return np.bincount(labels, self.mesh.vertex_areas * inside).max() / self.mesh.area


@dataclass(frozen=True)
class MapScore:
    """Errors x 100 of one map, and what went wrong with it.

    Attributes
    ----------
    direct, mirrored : float
        Mean error of the images rounded to vertices, against the true images and against their mirror images.
    p95 : float
        95th percentile of the former.
    inside : float
        Mean error of the images as points inside triangles.
    swapped : float
        Share of the area of the largest connected patch that is lost (error above 20) and less than half as far from
        its mirror image: an arm or leg exchanged with the other.
    lost : float
        The same of the largest patch that is lost, to wherever it may be.
    errors, inside_errors : (k,) array of float
        Those behind `direct` and `inside`.
    """

    direct: float
    mirrored: float
    p95: float
    inside: float
    swapped: float
    lost: float
    errors: np.ndarray
    inside_errors: np.ndarray

    @property
    def flip(self):
        """What is exchanged: "whole", "limb", "lost" (a patch elsewhere than at its mirror image), or nothing.

        A map that turns the whole body front to back exchanges left and right as well, which puts its error far above
        15; so it counts as "whole".
        """
        if self.mirrored < self.direct or self.direct > 15:
            return "whole"
        return "limb" if self.swapped > PATCH else "lost" if self.lost > PATCH else ""


def score(source, target, points):
    """Score the images, points (k,) on `target`, of the samples of `source`."""
    errors = target.vertex_errors(points.nearest_vertices)
    mirrored = target.vertex_errors(points.nearest_vertices, mirrored=True)
    inside = target.point_errors(points)
    lost = errors > LOST
    return MapScore(
        errors.mean(),
        mirrored.mean(),
        np.percentile(errors, 95),
        inside.mean(),
        source.largest_patch(lost & (mirrored < errors / 2)),
        source.largest_patch(lost),
        errors,
        inside,
    )


class KnownShapes:
    """The shapes of a folder, read as they are asked for; what was measured on the last of them is kept."""

    def __init__(self, folder):
        self._folder = folder
        self._paths = {path.stem: path for path in sorted(folder.rglob("*.off"))}

    def read(self, name):
        """Read the shape of this name."""
        return _read(self._paths[name], self.dataset(name))

    def dataset(self, name):
        """Folder that the shape of this name comes from."""
        return self._paths[name].relative_to(self._folder).parts[0]

    def of_kind(self, kind):
        """Names of the shapes that show this animal, which share their places."""
        return [name for name in self._paths if _kind(name) == kind]

    def random_pairs(self, count, seed):
        """Random pairs (source, target) of different shapes of one kind, without repetition, in the `MIXTURE`."""
        random = np.random.default_rng(seed)
        stacks = {}
        for dataset in dict.fromkeys(MIXTURE):
            names = [name for name in self._paths if self.dataset(name) == dataset]
            pairs = [(a, b) for a in names for b in names if a != b and _kind(a) == _kind(b)]
            stacks[dataset] = [pairs[i] for i in random.permutation(len(pairs))]
        turns = (MIXTURE[i % len(MIXTURE)] for i in range(10 * count))
        return [stacks[dataset].pop() for dataset in turns if stacks[dataset]][:count]


def _kind(name):
    """Animal that a shape shows: shapes that share a leading number are of one kind, all others are named by it."""
    number, _, rest = name.partition("_")
    return number if number.isdigit() and rest else name.rstrip("0123456789_")


@lru_cache(maxsize=16)
def _read(path, dataset):
    return KnownShape(path.stem, dataset, TriangleMesh(*read_off(path)), known(path), known(path, ".sym"))
