# SPDX-License-Identifier: GPL-3.0-or-later
"""Read characters and their animations in the Inter-Quake format: triangles, bones with weights, and frames."""

import struct

import numpy as np

from tests.benchmarks.game_models import Model, transformations

NAME = b"INTERQUAKEMODEL\0"
POSITION, BONES, WEIGHTS = 0, 4, 5
TYPES = {0: "i1", 1: "u1", 2: "<i2", 3: "<u2", 4: "<i4", 5: "<u4", 6: "<f2", 7: "<f4", 8: "<f8"}
CHANNELS = 10
"""Numbers that place a bone: three for the place, four for the rotation, three for the scale."""


def _header(path):
    """Bytes of a file, and the 27 numbers that follow the name of the format."""
    data = path.read_bytes()
    if data[: len(NAME)] != NAME:
        raise ValueError(f"{path} is no Inter-Quake model.")
    return data, struct.unpack("<27I", data[16:124])


def _placed(numbers):
    """Matrices (k, 4, 4) of places, rotations and scales (k, 10)."""
    matrices = transformations(numbers[:, :7])
    matrices[:, :3, :3] *= numbers[:, None, 7:]
    return matrices


def _chained(matrices, parents):
    """Matrices of bones (b, 4, 4) relative to the world, from those relative to their parents."""
    chained = []
    for matrix, parent in zip(matrices, parents, strict=True):
        chained.append(matrix if parent < 0 else chained[parent] @ matrix)
    return np.array(chained)


def read_character(path):
    """Read a model, with vertices at the same place as one."""
    data, header = _header(path)
    arrays, vertex_count, first = header[7:10]
    triangle_count, triangle_start = header[10:12]
    joints, joint_start = header[13:15]
    found = {}
    for number in range(arrays):
        kind, _, form, size, start = struct.unpack_from("<5I", data, first + 20 * number)
        found[kind] = np.frombuffer(data, TYPES[form], vertex_count * size, start).reshape(vertex_count, size)
    triangles = np.frombuffer(data, "<u4", 3 * triangle_count, triangle_start).reshape(-1, 3).astype(int)
    bones = [struct.unpack_from("<Ii10f", data, joint_start + 48 * number) for number in range(joints)]
    rest = _chained(_placed(np.array([bone[2:] for bone in bones])), [bone[1] for bone in bones])
    _, kept, number = np.unique(
        np.round(found[POSITION].astype(float), 5), axis=0, return_index=True, return_inverse=True
    )
    triangles = number.ravel()[triangles]
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    vertices, influences, weights = (found[kind][kept] for kind in (POSITION, BONES, WEIGHTS))
    return Model(vertices.astype(float), triangles, influences.astype(int), weights.astype(float), rest)


def read_frames(path):
    """Read the frames of an animation: matrices of all bones (f, b, 4, 4); none if there are none."""
    data, header = _header(path)
    poses, start = header[15:17]
    frames, channels, frame_start = header[19:22]
    if not frames:
        return np.empty((0, poses, 4, 4))
    raw = np.frombuffer(data, "<u2", frames * channels, frame_start).reshape(frames, channels)
    values, parents, used = np.empty((frames, poses, CHANNELS)), [], 0
    for number in range(poses):
        parent, mask, *numbers = struct.unpack_from("<iI20f", data, start + 88 * number)
        parents.append(parent)
        for channel in range(CHANNELS):
            values[:, number, channel] = numbers[channel]
            if mask >> channel & 1:
                values[:, number, channel] += raw[:, used] * numbers[CHANNELS + channel]
                used += 1
    return np.array([_chained(_placed(frame), parents) for frame in values])
