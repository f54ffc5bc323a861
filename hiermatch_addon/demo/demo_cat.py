# SPDX-License-Identifier: GPL-3.0-or-later
"""The body of the demo cat: a closed surface in its rest pose, modelled from a table of tubes.

The cat stands on the plane z = 0, faces -Y and has its left on +X.  A unit is about the height of its shoulders.
Its plane of symmetry is x = 0, but for what tells its left from its right: the tip of its right ear is clipped, as vets
mark the cats of the street, and the bell of its collar hangs on the left.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Point = tuple[float, float, float]

# Width of the voxels that melt the parts together, and how often their steps are smoothed away.
_VOXEL = 0.0125
_SMOOTHING = 4


@dataclass(frozen=True)
class _Tube:
    """A part of the body: ellipses along a curve.

    Attributes
    ----------
    rings : sequence of (x, y, z, radius, depth)
        Centre of each ellipse, and its radii to the side and across.
    side : (x, y, z)
        Where the first radius points, as far as the curve allows.
    cup : float
        How far the edges of the ellipses are bent to one side, as parts of the first radius: hollows an ear.
    """

    rings: Sequence[tuple[float, float, float, float, float]]
    side: Point = (1.0, 0.0, 0.0)
    cup: float = 0.0

    def moved(self, by: Point) -> _Tube:
        """Return the tube at another place."""
        rings = [(x + by[0], y + by[1], z + by[2], radius, depth) for x, y, z, radius, depth in self.rings]
        return replace(self, rings=rings)

    def mirrored(self) -> _Tube:
        """Return the tube of the other side of the body."""
        x, y, z = self.side
        return _Tube([(-ring[0], *ring[1:]) for ring in self.rings], (x, -y, -z), self.cup)


def _ball(centre: Point, radii: Point) -> _Tube:
    """Describe an ellipsoid with its axes along X, Y and Z."""
    (x, y, z), (rx, ry, rz) = centre, radii
    latitudes = np.linspace(-np.pi / 2, np.pi / 2, 7)
    heights, widths = np.sin(latitudes).tolist(), np.maximum(np.cos(latitudes), 0.05).tolist()
    return _Tube([(x, y, z + rz * h, rx * w, ry * w) for h, w in zip(heights, widths, strict=True)])


_TRUNK = [
    _Tube(  # from the rump to the breast
        [
            (0, 0.66, 0.80, 0.04, 0.05),
            (0, 0.62, 0.79, 0.12, 0.13),
            (0, 0.52, 0.77, 0.175, 0.19),
            (0, 0.34, 0.755, 0.20, 0.22),
            (0, 0.10, 0.725, 0.195, 0.215),
            (0, -0.16, 0.71, 0.205, 0.23),
            (0, -0.38, 0.725, 0.21, 0.24),
            (0, -0.55, 0.77, 0.19, 0.215),
            (0, -0.66, 0.82, 0.13, 0.15),
            (0, -0.71, 0.85, 0.04, 0.05),
        ]
    ),
    _Tube(  # neck
        [
            (0, -0.20, 0.74, 0.08, 0.09),
            (0, -0.34, 0.79, 0.175, 0.18),
            (0, -0.48, 0.865, 0.18, 0.19),
            (0, -0.60, 0.96, 0.155, 0.17),
            (0, -0.70, 1.07, 0.14, 0.15),
            (0, -0.78, 1.17, 0.10, 0.10),
        ]
    ),
    _Tube(  # tail
        [
            (0, 0.46, 0.83, 0.07, 0.07),
            (0, 0.60, 0.85, 0.082, 0.08),
            (0, 0.74, 0.83, 0.066, 0.066),
            (0, 0.92, 0.775, 0.058, 0.058),
            (0, 1.14, 0.735, 0.056, 0.056),
            (0, 1.38, 0.73, 0.057, 0.057),
            (0, 1.58, 0.76, 0.056, 0.056),
            (0, 1.70, 0.79, 0.044, 0.044),
            (0, 1.745, 0.803, 0.016, 0.016),
        ]
    ),
]

# The head is measured from the middle of the skull.
_SKULL = (0.0, -0.82, 1.20)

_HEAD = [
    _ball((0, 0, 0), (0.215, 0.205, 0.19)),  # skull
    _ball((0, -0.185, -0.125), (0.058, 0.052, 0.045)),  # chin
    _Tube(  # bridge of the nose
        [
            (0, -0.05, 0.12, 0.05, 0.05),
            (0, -0.14, 0.085, 0.045, 0.05),
            (0, -0.205, 0.02, 0.036, 0.045),
            (0, -0.245, -0.025, 0.036, 0.032),
            (0, -0.262, -0.048, 0.014, 0.014),
        ]
    ),
]

_HEAD_LEFT = [
    _ball((0.105, -0.04, -0.065), (0.125, 0.125, 0.105)),  # cheek
    _ball((0.047, -0.200, -0.075), (0.064, 0.06, 0.05)),  # pad of the whiskers
    _ball((0.095, -0.160, 0.030), (0.060, 0.055, 0.056)),  # eye
]

_EAR = _Tube(
    [
        (0.110, 0.02, 0.08, 0.120, 0.055),
        (0.130, 0.02, 0.15, 0.115, 0.045),
        (0.156, 0.025, 0.23, 0.090, 0.037),
        (0.180, 0.03, 0.31, 0.056, 0.034),
        (0.191, 0.035, 0.35, 0.032, 0.030),
        (0.196, 0.035, 0.365, 0.010, 0.012),
    ],
    side=(1.0, 0.45, 0.0),
    cup=0.45,
)

_CLIPPED_EAR = _Tube(
    [
        (-0.110, 0.02, 0.08, 0.120, 0.055),
        (-0.130, 0.02, 0.15, 0.112, 0.045),
        (-0.146, 0.025, 0.195, 0.096, 0.040),
        (-0.154, 0.027, 0.230, 0.078, 0.037),
        (-0.157, 0.028, 0.250, 0.040, 0.026),
    ],
    side=(1.0, -0.45, 0.0),
    cup=0.45,
)

_LEGS_LEFT = [
    _Tube(  # foreleg, from the shoulder down
        [
            (0.09, -0.38, 0.90, 0.04, 0.08),
            (0.120, -0.41, 0.81, 0.085, 0.15),
            (0.142, -0.42, 0.66, 0.092, 0.145),
            (0.145, -0.38, 0.51, 0.078, 0.105),
            (0.138, -0.375, 0.37, 0.064, 0.074),
            (0.132, -0.39, 0.23, 0.057, 0.062),
            (0.130, -0.405, 0.13, 0.058, 0.062),
            (0.130, -0.42, 0.06, 0.056, 0.062),
            (0.130, -0.425, 0.02, 0.03, 0.04),
        ]
    ),
    _Tube(  # hind leg, from the hip down
        [
            (0.08, 0.42, 0.90, 0.04, 0.08),
            (0.125, 0.40, 0.81, 0.095, 0.165),
            (0.155, 0.38, 0.66, 0.104, 0.19),
            (0.160, 0.35, 0.52, 0.092, 0.150),
            (0.155, 0.39, 0.40, 0.068, 0.100),
            (0.148, 0.48, 0.30, 0.056, 0.070),
            (0.142, 0.535, 0.215, 0.052, 0.057),
            (0.137, 0.52, 0.12, 0.052, 0.057),
            (0.135, 0.50, 0.05, 0.052, 0.056),
            (0.135, 0.495, 0.02, 0.03, 0.03),
        ]
    ),
    _ball((0.130, -0.47, 0.058), (0.084, 0.105, 0.062)),  # paws
    _ball((0.135, 0.44, 0.058), (0.082, 0.105, 0.062)),
]

_TOES = [
    _ball((x + dx, y + dy, 0.044), (0.030, 0.055, 0.044))
    for x, y in ((0.130, -0.57), (0.135, 0.34))
    for dx, dy in ((-0.070, 0.035), (-0.026, 0.0), (0.026, 0.0), (0.070, 0.035))
]


def _collar() -> list[_Tube]:
    """Make the collar, around the neck, and the bell that hangs from it on the left of the throat."""
    around = np.radians(np.arange(-20, 381, 20))[:, None]
    middle, along = np.array([0.0, -0.61, 0.965]), (0.0, -0.73, 0.68)
    to_left, to_throat = np.array([0.158, 0.0, 0.0]), np.array([0.0, -0.121, -0.130])
    centres = middle + np.sin(around) * to_left + np.cos(around) * to_throat
    return [
        _Tube([(x, y, z, 0.036, 0.026) for x, y, z in centres.tolist()], side=along),
        _ball((0.075, -0.74, 0.80), (0.062, 0.062, 0.062)),
    ]


def _parts() -> list[_Tube]:
    head = [*_HEAD, *_HEAD_LEFT, *(part.mirrored() for part in _HEAD_LEFT), _EAR, _CLIPPED_EAR]
    legs = [*_LEGS_LEFT, *_TOES]
    return [
        *_TRUNK,
        *(part.moved(_SKULL) for part in head),
        *legs,
        *(part.mirrored() for part in legs),
        *_collar(),
    ]


def _smooth_curve(points: NDArray[np.float64], steps: int) -> NDArray[np.float64]:
    """Run a Catmull-Rom spline through points (n, d), with `steps` pieces between two of them."""
    ends = np.concatenate([2 * points[:1] - points[1:2], points, 2 * points[-1:] - points[-2:-1]])
    before, start, end, after = (ends[i : len(ends) - 3 + i, None, :] for i in range(4))
    t = (np.arange(steps) / steps)[None, :, None]
    curve = (
        start
        + (end - before) * t / 2
        + (before - 2.5 * start + 2 * end - after / 2) * t**2
        + (1.5 * (start - end) + (after - before) / 2) * t**3
    )
    return np.concatenate([curve.reshape(-1, points.shape[1]), points[-1:]])


def _loft(tube: _Tube, *, steps: int = 5, around: int = 28) -> tuple[NDArray[np.float64], list[list[int]]]:
    """Make the closed surface of a tube: vertices and faces, counter-clockwise seen from outside."""
    curve = _smooth_curve(np.array(tube.rings, dtype=float), steps)
    centres, radii = curve[:, :3], np.maximum(curve[:, 3:], 1e-3)
    tangents = np.gradient(centres, axis=0)
    across = np.cross(tangents, tube.side)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    side = np.cross(across, tangents)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    angles = np.linspace(0, 2 * np.pi, around, endpoint=False)
    u = radii[:, :1] * np.cos(angles)
    v = radii[:, 1:] * np.sin(angles) + tube.cup * radii[:, :1] * np.cos(angles) ** 2
    rings = centres[:, None] + u[..., None] * side[:, None] + v[..., None] * across[:, None]
    k = len(curve)
    i, j = np.meshgrid(np.arange(k - 1) * around, np.arange(around), indexing="ij")
    after = (j + 1) % around
    walls = np.stack([i + j, i + after, i + around + after, i + around + j], axis=-1).reshape(-1, 4)
    bottom = list(range(around))[::-1]
    top = list(range((k - 1) * around, k * around))
    return rings.reshape(-1, 3), [*walls.tolist(), bottom, top]


def build_body(name: str) -> bpy.types.Object:
    """Build the object that becomes the rest surface when its modifiers are evaluated.

    The parts overlap in its mesh; a voxel remesh makes one skin around them, which is then smoothed.

    Parameters
    ----------
    name : str
        Name of the new object and mesh; the caller links the object to a scene and removes both in the end.

    Returns
    -------
    bpy.types.Object
        The object, in no scene yet.
    """
    vertices: list[list[float]] = []
    faces: list[list[int]] = []
    for part in _parts():
        part_vertices, part_faces = _loft(part)
        faces.extend([corner + len(vertices) for corner in face] for face in part_faces)
        vertices.extend(part_vertices.tolist())
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    body = bpy.data.objects.new(name, mesh)
    add_modifier(body, "REMESH", mode="VOXEL", voxel_size=_VOXEL)
    add_modifier(body, "SMOOTH", factor=0.5, iterations=_SMOOTHING)
    return body


def add_modifier(thing: bpy.types.Object, kind: str, **settings: object) -> None:
    """Add a modifier with some of its settings at the end of an object's stack."""
    modifier = thing.modifiers.new(kind.title(), cast("Any", kind))
    for name, value in settings.items():
        setattr(modifier, name, value)
