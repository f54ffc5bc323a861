# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies for tests of symmetry, retrieval, many limbs and none, most made as or from the creature of `tests.shapes`."""

from __future__ import annotations

import numpy as np

from tests.shapes import bent, capsule_surface, creature, icosphere, irregular, posed


def mirrored_body(pose=0.0, resolution=13, seed=None):
    """Body that is symmetric at rest: the half y >= 0 of the creature and its mirror image.

    Parameters
    ----------
    pose : float
        How far legs, neck and tail are bent, each in its own way, so that nothing is symmetric in space; 0 to 1.
    resolution : int
        Of the creature.
    seed : int, optional
        Cut random triangles, so that the triangulation is not symmetric.

    Returns
    -------
    vertices : (n, 3) array of float
        Positions in the pose.
    triangles : (m, 3) array of int
        The same in all poses.
    rest : (n, 3) array of float
        Positions at rest: mirror images differ in the sign of y.
    """
    _, triangles, rest = creature(0.0, resolution)
    rest, triangles = _half(rest, triangles)
    middle = rest[:, 1] == 0
    other = np.arange(len(rest))
    other[~middle] = len(rest) + np.arange((~middle).sum())
    rest = np.concatenate([rest, rest[~middle] * [1, -1, 1]])
    triangles = np.concatenate([triangles, other[triangles][:, ::-1]])
    if seed is not None:
        rest, triangles = irregular(rest, triangles, rounds=1, seed=seed)
    return posed(rest, pose), triangles, rest


def relative_of_creature(legs=1.0, tail=1.0, pose=0.0, resolution=11, turn=0.0):
    """Body like the creature, its legs and tail longer by a factor, in a pose: vertices and triangles."""
    _, triangles, rest = creature(0.0, resolution, turn)
    rest = rest.copy()
    rest[:, 2] = np.where(rest[:, 2] < -0.3, -0.3 + legs * (rest[:, 2] + 0.3), rest[:, 2])
    rest[:, 0] = np.where(rest[:, 0] < -0.85, -0.85 + tail * (rest[:, 0] + 0.85), rest[:, 0])
    return posed(rest, pose), triangles


def octopus(pose, resolution, turn=0.0):
    """Round body with a head on top, and around it eight arms that are almost alike.

    Parameters
    ----------
    pose : int
        Seed of the bends of the arms.
    resolution : int
        Cells of the meshing grid per unit length; the body is about 5.5 wide.
    turn : float
        Angle in radians by which that grid is turned: another meshing.

    Returns
    -------
    vertices : (n, 3) array of float
        Positions in the pose.
    triangles : (m, 3) array of int
        The same in all poses.
    rest : (n, 3) array of float
        Positions with straight arms, which name the points of the surface.
    """
    arms = 8
    angles = 2 * np.pi * np.arange(arms) / arms
    out = np.stack([np.cos(angles), np.sin(angles), np.zeros(arms)], axis=1)
    lengths = 2.6 + 0.15 * np.cos(3 * angles + 1)
    thickness = 0.11 + 0.01 * np.cos(2 * angles)
    limbs = [
        ((0, 0, 0), tuple(length * axis), 0.17, end) for axis, length, end in zip(out, lengths, thickness, strict=True)
    ]
    capsules = [*limbs, ((0.0, 0.0, 0.0), (0.1, 0.0, 0.9), 0.5, 0.35)]
    rest, triangles = capsule_surface(capsules, [[-3.0, -3.0, -0.8], [3.0, 3.0, 1.5]], resolution, turn)
    vertices = rest.copy()
    bends = np.random.default_rng(pose).uniform(-1.5, 1.5, (arms, 2))
    nearest = (rest @ out.T).argmax(axis=1)
    for arm, (axis, both) in enumerate(zip(out, bends, strict=True)):
        beyond = (nearest == arm) & (rest @ axis > 0.9) & (rest[:, 2] < 0.5)
        for towards, angle in zip((np.array([0.0, 0.0, 1.0]), np.cross([0, 0, 1], axis)), both, strict=True):
            vertices[beyond] = bent(vertices[beyond] - 0.9 * axis, axis, towards, 1.5, angle) + 0.9 * axis
    return vertices, triangles, rest


def starfish(resolution, turn=0.0, arms=5):
    """Body with arms that are all alike, with a bump on its back so that it cannot be turned over."""
    angles = 2 * np.pi * np.arange(arms) / arms
    limbs = [((0, 0, 0), (2 * np.cos(angle), 2 * np.sin(angle), 0), 0.35, 0.15) for angle in angles]
    bump = ((0, 0, 0), (0, 0, 0.3), 0.5, 0.35)
    return capsule_surface([*limbs, bump], [[-2.4, -2.4, -0.8], [2.4, 2.4, 0.9]], resolution, turn)


def table(resolution, turn=0.0):
    """A longish top on four legs: the same if it is turned by half."""
    legs = [((x, y, 0), (x, y, -1.6), 0.14, 0.14) for x in (-1.2, 1.2) for y in (-0.8, 0.8)]
    top = [((-1.2, y, 0), (1.2, y, 0), 0.16, 0.16) for y in np.linspace(-0.8, 0.8, 8)]
    return capsule_surface([*legs, *top], [[-1.7, -1.3, -2], [1.7, 1.3, 0.5]], resolution, turn)


def two_headed(resolution, turn=0.0):
    """Trunk with the same head and legs at either end, the other way round: the same if it is turned by half."""
    half = [((0, 0, 0), (1.0, 0, 0.1), 0.3, 0.3), ((1.0, 0.1, 0.2), (1.5, 0.25, 0.9), 0.2, 0.15)]
    half += [((0.8, 0.2, 0), (0.9, 0.3, -1.0), 0.14, 0.1), ((0.7, -0.2, 0), (0.6, -0.5, -0.8), 0.14, 0.12)]
    way = np.array([-1, -1, 1])
    other = [(tuple(way * a), tuple(way * b), *radii) for a, b, *radii in half]
    return capsule_surface([*half, *other], [[-1.9, -1.0, -1.3], [1.9, 1.0, 1.3]], resolution, turn)


def forked(stem, resolution=24):
    """A trunk with one limb along x that forks into two prongs, to both sides along y."""
    prongs = [((0.9, 0, 0), (1.25, side * 0.4, 0), 0.05, 0.045) for side in (-1, 1)]
    capsules = [((-0.5, 0, 0), (-0.1, 0, 0), 0.25, 0.2), ((-0.1, 0, 0), (0.9, 0, 0), stem, stem), *prongs]
    return capsule_surface(capsules, [[-1, -0.7, -0.5], [1.5, 0.7, 0.5]], resolution, 0.3)


def fish(resolution=24):
    """Long body along x with a fin on its back and, behind a thin stalk, a fluke that looks the same from below."""
    vertices, triangles = icosphere(resolution)
    x, y, z = vertices.T
    radii = np.maximum(np.hypot(y, z), 1e-9)
    places = [-1, -0.6, 0, 0.5, 0.7, 0.9, 1]
    width = np.interp(x, places, [0, 0.12, 0.15, 0.08, 0.04, 0.24, 0]) / radii
    height = np.interp(x, places, [0, 0.13, 0.16, 0.09, 0.05, 0.03, 0]) / radii
    fin = 1 + np.where(z > 0, np.exp(-(((x - 0.1) / 0.15) ** 2)), 0)
    return np.stack([x, width * y, height * fin * z], axis=1), triangles


def _half(points, triangles):
    """Cut a surface along y = 0 and keep the part above, its border exactly at 0."""
    points = points.copy()
    # A cut close to a vertex would leave needles: such vertices are moved onto the plane.
    edge = np.linalg.norm(points[triangles[:, 0]] - points[triangles[:, 1]], axis=1).mean()
    points[np.abs(points[:, 1]) < 0.2 * edge, 1] = 0
    above = points[:, 1] >= 0
    vertices, cuts, kept = list(points), {}, []
    for triangle in triangles:
        polygon = []
        for a, b in zip(triangle, np.roll(triangle, -1), strict=True):
            if above[a]:
                polygon.append(a)
            if above[a] != above[b] and points[a, 1] and points[b, 1]:
                pair = (min(a, b), max(a, b))
                if pair not in cuts:
                    p, q = points[pair[0]], points[pair[1]]
                    cuts[pair] = len(vertices)
                    vertices.append((p + (q - p) * p[1] / (p[1] - q[1])) * [1, 0, 1])
                polygon.append(cuts[pair])
        kept += [(polygon[0], polygon[i], polygon[i + 1]) for i in range(1, len(polygon) - 1)]
    vertices, kept = np.array(vertices), np.array(kept)
    kept = kept[(vertices[kept][:, :, 1] > 0).any(axis=1)]  # triangles in the plane itself would be there twice
    used, kept = np.unique(kept, return_inverse=True)
    return vertices[used], kept.reshape(-1, 3)
