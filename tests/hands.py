# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand on an arm, with its bones, in any pose."""

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from engine import Skeleton, TriangleMesh
from tests.shapes import icosphere

TRUNK, ARM, PALM = 0, 1, 2
LENGTHS = (0.5, 0.8, 0.9, 0.85, 0.65)
"""Of the fingers, the thumb first."""


def hand_bones():
    """A trunk, an arm along x, a palm, and five fingers of two bones: parents, heads, tails."""
    parents, heads, tails = [-1, 0, 1], [[-8.0, 0, 0], [-3.0, 0, 0], [0, 0, 0]], [[-5.0, 0, 0], [0, 0, 0], [0.9, 0, 0]]
    for number, length in enumerate(LENGTHS):
        thumb = number == 0
        base = np.array([0.3, -0.5, 0.1] if thumb else [1.0, -0.55 + 0.3 * number, 0])
        along = np.array([0.6, -0.8, 0.2] if thumb else [1.0, 0.06 * (number - 2), 0])
        middle, tip = base + length / 2 * along, base + length * along
        parents += [PALM, len(parents)]
        heads += [base, middle]
        tails += [middle, tip]
    return Skeleton(np.array(parents), np.array(heads), np.array(tails))


def hand_body(skeleton, resolution=4):
    """An ellipsoid around each bone, which moves with it: a mesh and weights."""
    vertices, triangles, owner = [], [], []
    ball, faces = icosphere(resolution)
    for bone, (head, tail) in enumerate(zip(skeleton.heads, skeleton.tails, strict=True)):
        axis = (tail - head) / np.linalg.norm(tail - head)
        across = np.cross([0.0, 0.0, 1.0], axis)
        frame = np.stack([axis, across / np.linalg.norm(across), np.cross(axis, across / np.linalg.norm(across))])
        width, height = {TRUNK: (3.0, 3.0), ARM: (0.4, 0.35), PALM: (0.6, 0.2)}.get(bone, (0.12, 0.1))
        size = np.array([0.6 * np.linalg.norm(tail - head), width, height])
        triangles.append(faces + len(ball) * bone)
        vertices.append((ball * size) @ frame + (head + tail) / 2)
        owner += [bone] * len(ball)
    weights = csr_array((np.ones(len(owner)), (np.arange(len(owner)), owner)), shape=(len(owner), len(skeleton)))
    return TriangleMesh(np.concatenate(vertices), np.concatenate(triangles)), weights


def hand_pose(skeleton, roll=0.0, curl=0.0, tilt=0.0):
    """Transforms of a hand that is turned and tilted at the wrist, with bent fingers; angles in degrees."""
    linear, translations = np.empty((len(skeleton), 3, 3)), np.empty((len(skeleton), 3))
    for bone in skeleton.order:
        turn = Rotation.identity()
        if bone == ARM:
            turn = Rotation.from_rotvec([0.2, 0.5, -0.3])
        elif bone == PALM:
            turn = Rotation.from_rotvec(np.radians([roll, tilt, 0.0]))
        elif bone > PALM:
            turn = Rotation.from_rotvec(np.radians([0.0, curl, 0.0]))
        parent = skeleton.parents[bone]
        linear[bone] = turn.as_matrix() if parent < 0 else linear[parent] @ turn.as_matrix()
        head = skeleton.heads[bone]
        place = head if parent < 0 else linear[parent] @ head + translations[parent]
        translations[bone] = place - linear[bone] @ head
    return linear, translations
