# SPDX-License-Identifier: GPL-3.0-or-later
"""Read models and animations of the game 0 A.D., whose data anyone can install: many animals in many poses.

Models (.pmd) hold triangles, and for each vertex up to four bones with weights; animations (.psa) hold a rotation and a
place for each bone and frame.  Both are in `mods/public/public.zip` of Debian's package 0ad-data.
"""

import struct
import zipfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PurePosixPath

import numpy as np

MODELS = "art/meshes/skeletal"
ANIMATIONS = "art/animation/quadraped"
SEAM = 1e-5
"""Part of a model's extent below which two of its vertices are one, cut apart for its texture."""


@dataclass(frozen=True)
class Model:
    """An animal at rest: vertices (n, 3), triangles (m, 3), for each vertex four bones and weights, and the bones."""

    vertices: np.ndarray
    triangles: np.ndarray
    influences: np.ndarray
    weights: np.ndarray
    bones: np.ndarray

    def posed(self, frame):
        """Vertices with the bones at a frame (b, 4, 4) of an animation."""
        motion = frame @ np.linalg.inv(self.bones)
        there = self.influences < len(motion)
        weights = np.where(there, self.weights, 0)
        each = motion[np.where(there, self.influences, 0)]
        moved = np.einsum("nkab,nb->nka", each[..., :3, :3], self.vertices) + each[..., :3, 3]
        return np.einsum("nk,nka->na", weights, moved) / np.maximum(weights.sum(axis=1, keepdims=True), 1e-9)


def transformations(states):
    """Matrices (k, 4, 4) of bones, given by places and quaternions (k, 7)."""
    places, (x, y, z, w) = states[:, :3], (states[:, 3:] / np.linalg.norm(states[:, 3:], axis=1, keepdims=True)).T
    matrices = np.zeros((len(states), 4, 4))
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    matrices[:, :3, :3] = np.moveaxis(np.array(rows), 2, 0)
    matrices[:, :3, 3] = places
    matrices[:, 3, 3] = 1
    return matrices


@dataclass(frozen=True)
class Archive:
    """The game's data; two of one path are the same, so that what was read from it is found again."""

    path: Path

    @cached_property
    def names(self):
        """All files."""
        with zipfile.ZipFile(self.path) as archive:
            return archive.namelist()

    def _bytes(self, name, magic):
        with zipfile.ZipFile(self.path) as archive:
            data = archive.read(name)
        if data[:4] != magic:
            raise ValueError(f"{name} is not a file of the kind {magic.decode()}.")
        return data

    def model(self, name):
        """Read a model, with the vertices on either side of the seams of its texture joined."""
        data = self._bytes(f"{MODELS}/{name}.dae.cached.pmd", b"PSMD")
        count, layers = struct.unpack_from("<II", data, 12)
        kind = np.dtype(
            [("place", "<f4", 3), ("normal", "<f4", 3), ("uv", "<f4", 2 * layers), ("bones", "u1", 4), ("w", "<f4", 4)]
        )
        corners = np.frombuffer(data, kind, count, 20)
        at = 20 + corners.nbytes
        (faces,) = struct.unpack_from("<I", data, at)
        triangles = np.frombuffer(data, "<u2", 3 * faces, at + 4).reshape(-1, 3).astype(int)
        at += 4 + 6 * faces
        (bones,) = struct.unpack_from("<I", data, at)
        states = np.frombuffer(data, "<f4", 7 * bones, at + 4).reshape(-1, 7).astype(float)
        places = corners["place"].astype(float)
        cells = np.round(places / (SEAM * np.ptp(places))).astype(int)
        _, first, joined = np.unique(cells, axis=0, return_index=True, return_inverse=True)
        triangles = joined.reshape(-1)[triangles]
        a, b, c = triangles.T
        kept = corners[first]
        return Model(
            places[first],
            triangles[(a != b) & (b != c) & (c != a)],
            kept["bones"].astype(int),
            kept["w"].astype(float),
            transformations(states),
        )

    def frames(self, name, bones, count):
        """Take frames (k, b, 4, 4), spread over an animation; none if it is for another number of bones."""
        data = self._bytes(name, b"PSSA")
        (letters,) = struct.unpack_from("<I", data, 12)
        keys, frames = struct.unpack_from("<II", data, 20 + letters)
        if keys != bones:
            return np.empty((0, bones, 4, 4))
        states = np.frombuffer(data, "<f4", 7 * keys * frames, 28 + letters).astype(float)
        chosen = np.unique(np.linspace(0, frames - 1, count).astype(int))
        return transformations(states.reshape(-1, 7)).reshape(frames, keys, 4, 4)[chosen]

    def animations(self, start, folder=ANIMATIONS):
        """Names of the animations in a folder that start with a word."""
        names = (PurePosixPath(name) for name in self.names)
        return [str(n) for n in names if n.suffix == ".psa" and n.is_relative_to(folder) and n.name.startswith(start)]
