# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways to make a mess of a clean mesh, for the tests of its cleaning.

Each takes and returns vertices (n, 3) and triangles (m, 3); the first vertices stay what they are.
"""

from __future__ import annotations

import numpy as np


def cut_along_seam(vertices, triangles, axis=0, noise=0.0, seed=0):
    """Double the vertices between the two sides of the plane through the middle: the copies come last."""
    beyond = vertices[triangles].mean(axis=1)[:, axis] > vertices[:, axis].mean()
    shared = np.intersect1d(triangles[beyond], triangles[~beyond])
    copies = np.arange(len(vertices))
    copies[shared] = len(vertices) + np.arange(len(shared))
    triangles = np.where(beyond[:, None], copies[triangles], triangles)
    shift = noise * np.random.default_rng(seed).uniform(-1, 1, (len(shared), 3))
    return np.concatenate([vertices, vertices[shared] + shift]), triangles


def halves_apart(vertices, triangles, gap, axis=0):
    """Cut along the plane through the middle, and move what is beyond it on: mirrored, but never merged."""
    beyond = vertices[triangles].mean(axis=1)[:, axis] > vertices[:, axis].mean()
    vertices, triangles = cut_along_seam(vertices, triangles, axis)
    vertices[np.unique(triangles[beyond]), axis] += gap
    return vertices, triangles


def in_limbs(vertices, triangles, parts, depth):
    """Cut a body into pieces that go on a row of triangles beneath the trunk, so deep, where they meet it.

    Each vertex belongs to a part (n,), the trunk is 0.  Also returns the vertex of the body that each vertex was.
    """
    normals = np.zeros_like(vertices)
    corners = vertices[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    np.add.at(normals, triangles, across[:, None])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    meshes, whole = [], []
    for part in range(parts.max() + 1):
        inside = parts == part
        rows = triangles[inside[triangles].any(axis=1)]
        if part:  # one row further
            rows = triangles[np.isin(triangles, rows).any(axis=1)]
        own, faces = np.unique(rows, return_inverse=True)
        hidden = (~inside[own])[:, None] * (depth if part else 0.0)
        meshes.append((vertices[own] - hidden * normals[own], faces.reshape(-1, 3)))
        whole.append(own)
    return *together(*meshes), np.concatenate(whole)


def in_pieces(vertices, triangles):
    """Give every triangle three vertices of its own, as a raw scan or a text format has them."""
    return vertices[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def with_fin(vertices, triangles, first=0, count=3):
    """Add a strip of triangles that stands on a path of edges, each of which then has three triangles."""
    path = _path(triangles, first, count + 1)
    normal = vertices[path].mean(axis=0) - vertices.mean(axis=0)
    height = 2 * np.linalg.norm(np.diff(vertices[path], axis=0), axis=1).mean()
    top = vertices[path] + height * normal / np.linalg.norm(normal)
    upper = len(vertices) + np.arange(count + 1)
    fin = [(path[i], path[i + 1], upper[i]) for i in range(count)]
    fin += [(path[i + 1], upper[i + 1], upper[i]) for i in range(count)]
    return np.concatenate([vertices, top]), np.concatenate([triangles, np.array(fin)])


def without_disc(vertices, triangles, centre, radius):
    """Take out the triangles around a point (3,)."""
    away = np.linalg.norm(vertices[triangles].mean(axis=1) - centre, axis=1) > radius
    return vertices, triangles[away]


def without_faces(vertices, triangles, part, seed=0):
    """Leave out so large a part of the faces, here and there."""
    return vertices, triangles[np.random.default_rng(seed).random(len(triangles)) >= part]


def partly_turned(vertices, triangles, part=0.3, seed=0):
    """Turn random triangles over."""
    turned = np.random.default_rng(seed).random(len(triangles)) < part
    return vertices, np.where(turned[:, None], triangles[:, ::-1], triangles)


def together(*meshes):
    """Put meshes side by side into one, in the order given."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    triangles = [part + start for (_, part), start in zip(meshes, starts[:-1], strict=True)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(triangles)


def _path(triangles, first, count):
    """Walk along edges to `count` vertices, each of which is a neighbour of the one before it only."""
    path, near = [first], set()
    while len(path) < count:
        around = triangles[(triangles == path[-1]).any(axis=1)]
        following = [v for v in np.unique(around) if v not in near and v not in path]
        near.update(np.unique(around).tolist())
        path.append(int(following[0]))
    return np.array(path)


def bridged(vertices, triangles, first, second):
    """Join two places by a tube: the triangles around two vertices give way to a strip between their borders."""
    one, other = (triangles[(triangles == vertex).any(axis=1)] for vertex in (first, second))
    here, there = _ring(one, first), _ring(other, second)[::-1]
    nearest = np.linalg.norm(vertices[there] - vertices[here[0]], axis=1).argmin()
    there = np.roll(there, -nearest)
    strip, i, j = [], 0, 0
    while i < len(here) or j < len(there):
        a, b, c, d = (ring[k % len(ring)] for ring, k in ((here, i), (here, i + 1), (there, j), (there, j + 1)))
        if j == len(there) or (i < len(here) and (i + 1) * len(there) <= (j + 1) * len(here)):
            strip.append((a, b, c))
            i += 1
        else:
            strip.append((a, d, c))
            j += 1
    kept = ~np.isin(triangles, (first, second)).any(axis=1)
    return vertices, np.concatenate([triangles[kept], np.array(strip)])


def _ring(around, middle):
    """Walk along the border of the triangles around a vertex, in their direction."""
    following = {}
    for triangle in around.tolist():
        place = triangle.index(middle)
        following[triangle[(place + 1) % 3]] = triangle[(place + 2) % 3]
    ring = [min(following)]
    while following[ring[-1]] != ring[0]:
        ring.append(following[ring[-1]])
    return np.array(ring)
