# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of a match of the demo pair, as it is written on the objects."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from hiermatch.engine import GeodesicSolver, TriangleMesh  # see `source_extension`
from hiermatch.hiermatch_addon.common.access import mesh_of
from hiermatch.hiermatch_addon.demo.demo_pair import REST_ATTRIBUTE
from hiermatch.hiermatch_addon.scene.mesh_io import read_mesh
from mathutils.bvhtree import BVHTree

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

__all__ = ["MatchErrors", "Places", "match_errors", "point_distances", "rest_vertices", "true_places", "written_places"]


class Places(NamedTuple):
    """Points on a mesh, each a mean of three vertices.

    Attributes
    ----------
    corners : (k, 3) array of int
        The vertices.
    weights : (k, 3) array of float
        Their shares, summing to one.
    """

    corners: NDArray[np.int64]
    weights: NDArray[np.float64]

    def interpolate(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Take the mean of values at the vertices, (n, d), for each point, (k, d)."""
        return np.einsum("kc,kcd->kd", self.weights, values[self.corners])


class MatchErrors(NamedTuple):
    """Geodesic distances (k,) of matched points from where they belong, over the square root of the target's area.

    Attributes
    ----------
    direct : (k,) array of float
        From the true images.
    mirrored : (k,) array of float
        From the true images of the points' mirror images: small where left and right were exchanged.
    """

    direct: NDArray[np.float64]
    mirrored: NDArray[np.float64]


def match_errors(
    source: bpy.types.Object, target: bpy.types.Object, depsgraph: bpy.types.Depsgraph, prefix: str = "HM"
) -> MatchErrors:
    """Compare the match that is written on a demo pair with the truth.

    Parameters
    ----------
    source, target : bpy.types.Object
        The cats, with the vertex groups of a match.
    depsgraph : bpy.types.Depsgraph
        The evaluated dependency graph.
    prefix : str
        What the names of the vertex groups start with.

    Returns
    -------
    MatchErrors
        One pair of distances per matched point, in the order of the names.
    """
    mesh = read_mesh(target, depsgraph, use_modifiers=False)
    source_rest, target_rest = rest_vertices(source), rest_vertices(target)
    asked = written_places(source, prefix).interpolate(source_rest)
    answered = written_places(target, prefix)
    errors = []
    for rest in (asked, asked * [-1, 1, 1]):
        truth = true_places(rest, TriangleMesh(target_rest, mesh.triangles))
        errors.append(point_distances(mesh, truth, answered) / np.sqrt(mesh.area))
    return MatchErrors(*errors)


def rest_vertices(cat: bpy.types.Object) -> NDArray[np.float64]:
    """Read where the vertices of a cat were in the rest pose, (n, 3)."""
    mesh = mesh_of(cat)
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    attribute: Any = mesh.attributes[REST_ATTRIBUTE]
    attribute.data.foreach_get("vector", flat)
    return flat.reshape(-1, 3).astype(np.float64)


def true_places(rest: NDArray[np.float64], target: TriangleMesh) -> Places:
    """Find where points belong on the target.

    Parameters
    ----------
    rest : (k, 3) array of float
        Where the points are in the rest pose.
    target : TriangleMesh
        The target in the rest pose.

    Returns
    -------
    Places
        The nearest points of the target.
    """
    tree: Any = BVHTree.FromPolygons(target.vertices.tolist(), target.triangles.tolist())
    found = [tree.find_nearest(point) for point in rest.tolist()]
    triangles = np.array([triangle for _, _, triangle, _ in found])
    corners = target.triangles[triangles]
    a, b, c = np.moveaxis(target.vertices[corners], 1, 0)
    p = np.array([place for place, _, _, _ in found])
    normal = np.cross(b - a, c - a)
    shares = [(np.cross(v - u, p - u) * normal).sum(axis=1) for u, v in ((b, c), (c, a), (a, b))]
    weights = np.maximum(np.stack(shares, axis=1), 0)
    return Places(corners, weights / weights.sum(axis=1, keepdims=True))


def written_places(thing: bpy.types.Object, prefix: str) -> Places:
    """Read matched points from the vertex groups ``<prefix>.001`` and so on, in this order."""
    pattern = re.compile(re.escape(prefix) + r"\.\d+")
    names = [group.name for group in thing.vertex_groups if pattern.fullmatch(group.name)]
    names.sort(key=lambda name: (len(name), name))
    row = {thing.vertex_groups[name].index: i for i, name in enumerate(names)}
    corners, weights = np.zeros((len(names), 3), np.int64), np.zeros((len(names), 3))
    used = np.zeros(len(names), np.int64)
    for vertex in mesh_of(thing).vertices:
        for element in vertex.groups:
            i = row.get(element.group)
            if i is not None:
                corners[i, used[i]], weights[i, used[i]] = vertex.index, element.weight
                used[i] += 1
    return Places(corners, weights / weights.sum(axis=1, keepdims=True))


def point_distances(mesh: TriangleMesh, first: Places, second: Places) -> NDArray[np.float64]:
    r"""Measure geodesic distances between pairs of points that need not be vertices.

    The distances between the corners are combined by Leibniz' rule, exact where the surface is flat: for
    :math:`p = \sum a_i v_i` and :math:`q = \sum b_j w_j`,

    .. math:: |p - q|^2 = \sum_{ij} a_i b_j |v_i - w_j|^2 - \sum_{i<k} a_i a_k |v_i - v_k|^2
                          - \sum_{j<l} b_j b_l |w_j - w_l|^2

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    first, second : Places
        The points, k each.

    Returns
    -------
    (k,) array of float
        The distance between the i-th of one and the i-th of the other.
    """
    sources, rows = np.unique(first.corners, return_inverse=True)
    distances = GeodesicSolver(mesh).distances(sources)
    between = distances[rows.reshape(-1, 3, 1), second.corners[:, None, :]]  # (k, 3, 3)
    squares = np.einsum("ki,kj,kij->k", first.weights, second.weights, between**2)
    for corners, weights in (first, second):
        spread = mesh.vertices[corners] - np.einsum("kc,kcd->kd", weights, mesh.vertices[corners])[:, None]
        # The sum over pairs is the mean square distance from the mean.
        squares -= np.einsum("kc,kcd->k", weights, spread**2)
    return np.sqrt(np.maximum(squares, 0))
