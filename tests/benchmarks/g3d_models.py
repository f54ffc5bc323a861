# SPDX-License-Identifier: GPL-3.0-or-later
"""Read the models of the game MegaGlest, whose data anyone can install: bodies in the frames of their animations.

A file (.g3d, version 4) holds meshes, each with the places of its vertices in all frames and its triangles; they are in
Debian's package megaglest-data.
"""

import struct
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

_HEADER, _NAME, _TEXTURE = 7, 64, 64
_SEAM = 1e-4
"""Part of a body's extent below which two of its vertices are one, cut apart for its texture."""


def read_meshes(path):
    """Read the meshes of a file: places of the vertices (frames, n, 3) and triangles (m, 3) of each."""
    data = Path(path).read_bytes()
    if data[:4] != b"G3D\x04":
        raise ValueError(f"{path} is not a model of version 4.")
    (count,) = struct.unpack_from("<H", data, 4)
    at, found = _HEADER, []
    for _ in range(count):
        frames, vertices, corners = struct.unpack_from("<III", data, at + _NAME)
        (textures,) = struct.unpack_from("<I", data, at + _NAME + 48)
        at += _NAME + 52 + _TEXTURE * textures.bit_count()
        places = np.frombuffer(data, "<f4", 3 * frames * vertices, at).reshape(frames, vertices, 3)
        at += 2 * places.nbytes + (8 * vertices if textures else 0)  # the normals and the texture follow
        triangles = np.frombuffer(data, "<u4", corners, at).reshape(-1, 3)
        at += triangles.nbytes
        found.append((places.astype(float), triangles.astype(int)))
    return found


def read_unit(folder):
    """Read what most files of a unit show, if anything: vertices in all frames (f, n, 3), and triangles (m, 3)."""
    frames = {}
    for path in sorted(folder.glob("models/*.g3d")):
        places, triangles = max(read_meshes(path), key=lambda mesh: len(mesh[1]))
        frames.setdefault((places.shape[1], triangles.tobytes()), []).append(places)
    if not frames:
        return None
    key = max(frames, key=lambda k: sum(map(len, frames[k])))
    return np.concatenate(frames[key]), np.frombuffer(key[1], int).reshape(-1, 3)


def largest_part(places, triangles):
    """Join vertices that go together in all frames, take the part of the largest area, and say how much it is."""
    tracks = places.transpose(1, 0, 2).reshape(places.shape[1], -1)
    reach = _SEAM * np.ptp(places[0], axis=0).max() * np.sqrt(len(places))
    pairs = cKDTree(tracks).query_pairs(reach, output_type="ndarray")
    _, joined = _components(pairs, len(tracks))
    places, triangles = places[:, np.unique(joined, return_index=True)[1]], joined[triangles]
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    triangles = triangles[np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1]]
    _, parts = _components(np.concatenate([triangles[:, :2], triangles[:, 1:]]), places.shape[1])
    sizes = np.bincount(parts[triangles[:, 0]], areas(places[0], triangles))
    kept = triangles[parts[triangles[:, 0]] == sizes.argmax()]
    used, corners = np.unique(kept, return_inverse=True)
    return places[:, used], corners.reshape(-1, 3), sizes.max() / sizes.sum()


def areas(vertices, triangles):
    """Areas of triangles."""
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def _components(pairs, count):
    return connected_components(coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(count, count)), directed=False)
