# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes that the tests and benchmarks make for themselves, most with exactly known geodesics.

Every generator returns vertices (n, 3) and triangles (m, 3), counter-clockwise seen from outside (planes: from +z).
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay

from engine.repair.surface_nets import surface_net


def plane(count=20, size=1.0, jitter=0.0, seed=0):
    """Square [0, size]^2 at z = 0 of count^2 vertices.

    Without jitter the squares of a grid are split along one diagonal.  With it, the inner vertices are moved by up to
    `jitter` grid steps in x and y and the points are triangulated anew.
    """
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(count), np.arange(count), indexing="ij"))
    points = np.stack([x, y], axis=1).astype(float)
    if jitter:
        inner = ((points > 0) & (points < count - 1)).all(axis=1)
        points[inner] += np.random.default_rng(seed).uniform(-jitter, jitter, (inner.sum(), 2))
        triangles = Delaunay(points).simplices
        a, b, c = points[triangles].transpose(1, 0, 2)
        turned = _cross(b - a, c - a) < 0
        triangles[turned] = triangles[turned][:, ::-1]
    else:
        triangles = _grid_triangles(count, count)
    return np.column_stack([points * (size / (count - 1)), np.zeros(count * count)]), triangles.astype(np.int64)


def plane_with_hole(cells=20, low=0.3, high=0.6):
    """Unit square of cells^2 squares without the inside of the square [low, high]^2, which lies on grid lines."""
    vertices, triangles = plane(cells + 1)
    centre = vertices[triangles].mean(axis=1)[:, :2]
    return compacted(vertices, triangles[~((centre > low) & (centre < high)).all(axis=1)])


def plane_with_slit(cells=20, end=0.6):
    """Unit square cut along x = 1/2 from y = 0 up to its tip at y = end; `cells` is even, and the tip on the grid.

    The vertices along the cut are double; the copies on the right side come last.
    """
    vertices, triangles = plane(cells + 1)
    on_cut = np.flatnonzero((abs(vertices[:, 0] - 0.5) < 1e-9) & (vertices[:, 1] < end - 1e-9))
    copies = np.arange(len(vertices))
    copies[on_cut] = len(vertices) + np.arange(len(on_cut))
    right = vertices[triangles].mean(axis=1)[:, 0] > 0.5
    triangles[right] = copies[triangles[right]]
    return np.concatenate([vertices, vertices[on_cut]]), triangles


def icosphere(subdivisions=10, radius=1.0):
    """Sphere from an icosahedron, each face split into subdivisions^2."""
    golden = (1 + 5**0.5) / 2
    near, far = np.array([[-1, golden], [1, golden], [-1, -golden], [1, -golden]]).T
    zero = np.zeros(4)
    vertices = np.concatenate(
        [np.stack(axes, axis=1) for axes in ((near, far, zero), (zero, near, far), (far, zero, near))]
    )
    # The faces of the hull of the twelve points: all triples at distance two.
    close = np.linalg.norm(vertices[:, None] - vertices, axis=2) < 2.1
    triples = [
        (a, b, c) for a in range(12) for b in range(a) for c in range(b) if close[a, b] and close[b, c] and close[a, c]
    ]
    vertices, triangles = subdivided(vertices, outward(vertices, np.array(triples)), subdivisions)
    return radius * vertices / np.linalg.norm(vertices, axis=1, keepdims=True), triangles


def cylinder(around=40, along=20, radius=1.0, height=2.0):
    """Side of a cylinder about the z axis, open at both ends: `around` x (along + 1) vertices, z the fast index."""
    angle, z = np.meshgrid(2 * np.pi * np.arange(around) / around, np.linspace(0, height, along + 1), indexing="ij")
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=-1).reshape(-1, 3)
    return vertices, _grid_triangles(around, along + 1, wrap_first=True)


def cone(around=40, along=20, radius=1.0, height=1.0):
    """Side of a cone about the z axis: the apex (0, 0, height) is vertex 0, then `along` rings down to z = 0."""
    ring = np.arange(1, along + 1) / along
    angle, part = np.meshgrid(2 * np.pi * np.arange(around) / around, ring, indexing="ij")
    vertices = np.stack([radius * part * np.cos(angle), radius * part * np.sin(angle), height * (1 - part)], axis=-1)
    first = 1 + along * np.arange(around)
    cap = np.stack([np.zeros(around, int), first, np.roll(first, -1)], axis=1)
    sides = _grid_triangles(around, along, wrap_first=True)[:, ::-1] + 1
    return np.concatenate([[[0.0, 0.0, height]], vertices.reshape(-1, 3)]), np.concatenate([cap, sides])


def torus(around=48, across=20, radius=1.0, thickness=0.35):
    """Torus about the z axis: `around` x `across` vertices, the index across the tube the fast one."""
    u, v = np.meshgrid(2 * np.pi * np.arange(around) / around, 2 * np.pi * np.arange(across) / across, indexing="ij")
    out = radius + thickness * np.cos(v)
    vertices = np.stack([out * np.cos(u), out * np.sin(u), thickness * np.sin(v)], axis=-1).reshape(-1, 3)
    return vertices, _grid_triangles(around, across, wrap_first=True, wrap_second=True)


def subdivided(vertices, triangles, parts):
    """Split each edge into `parts` and each triangle into parts^2, in its plane; the first vertices stay."""
    count = len(vertices)
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(parts + 1), np.arange(parts + 1), indexing="ij"))
    inside = i + j <= parts
    weights = np.stack([parts - i - j, i, j], axis=1)[inside]
    number = np.full((parts + 1) ** 2, -1)
    number[inside] = np.arange(inside.sum())
    number = number.reshape(parts + 1, parts + 1)
    # A point is known by the vertices with weight and their weights, in the order of the vertices.
    ranked = np.argsort(triangles, axis=1)
    ids = np.take_along_axis(triangles, ranked, axis=1)[:, None]
    weight = weights.T[ranked].transpose(0, 2, 1)
    ids, weight = np.broadcast_arrays(np.where(weight > 0, ids, count), weight)
    last = np.argsort(ids, axis=2, kind="stable")
    ids, weight = (np.take_along_axis(array, last, axis=2).reshape(-1, 3) for array in (ids, weight))
    key = ((ids[:, 0] * (count + 1) + ids[:, 1]) * (count + 1) + ids[:, 2]) * (parts + 1) ** 2
    key += weight[:, 0] * (parts + 1) + weight[:, 1]
    key = np.where(weight[:, 0] == parts, ids[:, 0] - count, key)  # corners first, in their order
    keys, first, inverse = np.unique(key, return_index=True, return_inverse=True)
    points = np.einsum("pc,mcd->mpd", weights / parts, vertices[triangles]).reshape(-1, 3)[first]
    used = keys[keys < 0] + count
    renumber = np.concatenate([used, count + np.arange(len(keys) - len(used))])
    result = np.concatenate([vertices, points[len(used) :]])
    local = []
    for p in range(parts):
        for q in range(parts - p):
            local.append((number[p, q], number[p + 1, q], number[p, q + 1]))
            if p + q < parts - 1:
                local.append((number[p + 1, q], number[p + 1, q + 1], number[p, q + 1]))
    return result, renumber[inverse.reshape(len(triangles), -1)][:, np.array(local)].reshape(-1, 3)


def irregular(vertices, triangles, rounds=2, part=0.4, seed=0):
    """Cut random triangles at random points inside: the same surface, the first vertices kept, but many needles.

    Each round cuts `part` of the triangles into three.
    """
    random = np.random.default_rng(seed)
    for _ in range(rounds):
        cut = random.random(len(triangles)) < part
        weights = random.dirichlet([2.0, 2.0, 2.0], cut.sum())
        inner = np.einsum("kc,kcd->kd", weights, vertices[triangles[cut]])
        new = len(vertices) + np.arange(len(inner))
        a, b, c = triangles[cut].T
        pieces = [np.stack([p, q, new], axis=1) for p, q in ((a, b), (b, c), (c, a))]
        vertices, triangles = np.concatenate([vertices, inner]), np.concatenate([triangles[~cut], *pieces])
    return vertices, triangles


def permuted(vertices, triangles, seed=0):
    """Shuffle vertices, triangles and the corner each triangle starts at.

    Returns the vertices, the triangles, and for each old vertex its new index.
    """
    random = np.random.default_rng(seed)
    order = random.permutation(len(vertices))
    new = np.empty(len(order), np.int64)
    new[order] = np.arange(len(order))
    corners = (np.arange(3) + random.integers(0, 3, (len(triangles), 1))) % 3
    return vertices[order], new[np.take_along_axis(triangles, corners, axis=1)][random.permutation(len(triangles))], new


def compacted(vertices, triangles):
    """Drop the vertices without a triangle."""
    used, inverse = np.unique(triangles, return_inverse=True)
    return vertices[used], inverse.reshape(-1, 3)


def cut_open(vertices, triangles, seam):
    """Cut a mesh open between its triangles, as files cut it at UV seams.

    `seam` (m,) tells which triangles are on the one side; their vertices on the border are copied.

    Returns
    -------
    vertices, triangles
        The mesh.
    home : (n',) array of int
        The vertex that each was before.
    """
    shared = np.intersect1d(triangles[seam], triangles[~seam])
    copies = np.arange(len(vertices))
    copies[shared] = len(vertices) + np.arange(len(shared))
    home = np.append(np.arange(len(vertices)), shared)
    return vertices[home], np.where(seam[:, None], copies[triangles], triangles), home


def outward(vertices, triangles):
    """Turn the triangles of a shape that is star-shaped about the origin so that they look away from it."""
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    return np.where(inward[:, None], triangles[:, ::-1], triangles)


def rotation(axis, angle):
    """Rotation matrix (3, 3) about an axis (3,) by an angle in radians."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def _cross(u, v):
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def _grid_triangles(first, second, *, wrap_first=False, wrap_second=False):
    """Triangles of a grid of first x second vertices, the second index the fast one."""
    i, j = (
        axis.ravel()
        for axis in np.meshgrid(
            np.arange(first if wrap_first else first - 1),
            np.arange(second if wrap_second else second - 1),
            indexing="ij",
        )
    )
    a, b = i * second + j, (i + 1) % first * second + j
    c, d = (i + 1) % first * second + (j + 1) % second, i * second + (j + 1) % second
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def creature(pose=0.0, resolution=18, turn=0.0):
    """Closed body of a quadruped that is not symmetric, at rest (pose 0) or bent nearly without stretching.

    Parameters
    ----------
    pose : float
        How far legs, neck and tail are bent, 0 to 1.  Vertices correspond by index among all poses of one meshing.
    resolution : int
        Cells of the meshing grid per unit length; the body is about 2.4 long.  18 gives about 3000 vertices.
    turn : float
        Angle in radians by which the meshing grid is turned against the body: another meshing of the same surface.

    Returns
    -------
    vertices : (n, 3) array of float
        Positions in the pose.
    triangles : (m, 3) array of int
        The same in all poses.
    rest : (n, 3) array of float
        Positions at rest, which name the points of the surface: the truth between different meshings.
    """
    rest, triangles = capsule_surface(_CAPSULES, [[-1.4, -0.5, -1.3], [1.5, 0.5, 0.9]], resolution, turn)
    return posed(rest, pose), triangles, rest


def capsule_surface(capsules, box, resolution, turn=0.0):
    """Mesh a smooth union of capsules.

    Parameters
    ----------
    capsules : sequence of tuple
        Start, end, and the radii there.
    box : (2, 3) array_like
        Lowest and highest coordinates around them.
    resolution : int
        Cells of the meshing grid per unit length.
    turn : float
        Angle in radians by which the grid is turned.

    Returns
    -------
    vertices : (n, 3) array of float
        Points of the surface.
    triangles : (m, 3) array of int
        Their triangles.
    """
    frame, box = rotation([1.0, 2.0, 3.0], turn), np.asarray(box)
    corners = np.stack(np.meshgrid(*box.T, indexing="ij"), axis=-1).reshape(-1, 3) @ frame
    low, high = corners.min(axis=0), corners.max(axis=0)
    # Now and then two sheets of the net touch in an edge: shift the grid until none do.
    for shift in np.arange(20) / 20:
        axes = [
            np.arange(a - shift / resolution, b + 1 / resolution, 1 / resolution)
            for a, b in zip(low, high, strict=True)
        ]
        points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1) @ frame.T
        near = ((points > box[0]) & (points < box[1])).all(axis=-1)
        values = np.ones(near.shape)
        values[near] = _depth(capsules, points[near])
        places, triangles = surface_net(-values)
        vertices = (places / resolution + [axis[0] for axis in axes]) @ frame.T
        sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
        if (np.unique(sides @ [len(vertices), 1], return_counts=True)[1] == 2).all():
            break
    for _ in range(3):  # onto the surface itself, along the gradient
        step = 1e-4
        value = _depth(capsules, vertices)
        gradient = np.stack([_depth(capsules, vertices + step * axis) - value for axis in np.eye(3)], axis=1) / step
        vertices -= gradient * (value / np.maximum((gradient**2).sum(axis=1), 0.1))[:, None]
    return vertices, triangles


def wire_box(cells, wire, size=(2.0, 2.0, 2.0), resolution=20):
    """Mesh a box of wire around the origin: a grid of cells on each of its sides, as one closed surface."""
    places = np.stack(np.meshgrid(*3 * [np.arange(cells + 1)]), axis=-1).reshape(-1, 3)
    places = places[((places == 0) | (places == cells)).any(axis=1)]
    first, second = (places[ends] for ends in np.nonzero(np.abs(places[:, None] - places).sum(axis=2) == 1))
    once = first.sum(axis=1) < second.sum(axis=1)
    step = np.asarray(size) / cells
    ends = zip((first[once] - cells / 2) * step, (second[once] - cells / 2) * step, strict=True)
    box = np.array([[-0.5], [0.5]]) * size + [[-3 * wire], [3 * wire]]
    return capsule_surface([(*pair, wire, wire) for pair in ends], box, resolution)


# Ends, radii at the ends: torso, neck, head, snout, two unequal ears, tail, four legs of different lengths, a hump.
_CAPSULES = (
    ((-0.55, 0.0, 0.0), (0.5, 0.0, 0.05), 0.28, 0.3),
    ((0.55, 0.0, 0.12), (0.95, 0.0, 0.45), 0.18, 0.14),
    ((0.98, 0.0, 0.48), (1.1, 0.0, 0.48), 0.19, 0.17),
    ((1.1, 0.0, 0.44), (1.32, 0.0, 0.38), 0.12, 0.08),
    ((0.96, 0.13, 0.58), (0.93, 0.2, 0.76), 0.07, 0.055),
    ((0.96, -0.13, 0.58), (0.93, -0.17, 0.68), 0.075, 0.07),
    ((-0.7, 0.0, 0.1), (-1.25, 0.0, 0.16), 0.1, 0.07),
    ((0.45, 0.2, -0.05), (0.45, 0.2, -0.95), 0.13, 0.09),
    ((0.45, -0.2, -0.05), (0.45, -0.2, -0.85), 0.13, 0.1),
    ((-0.5, 0.2, -0.05), (-0.5, 0.2, -1.1), 0.15, 0.09),
    ((-0.5, -0.2, -0.05), (-0.5, -0.2, -1.0), 0.14, 0.1),
    ((-0.1, 0.16, 0.2), (-0.25, 0.12, 0.24), 0.15, 0.1),
)

# Joints: whose points (x and y sign of a leg, or None for all beyond the start), where the bend starts, the direction
# along the limb, the direction it bends to, the length of the bend, the angle at pose 1.
_JOINTS = (
    ((1, 1), (0.45, 0.2, -0.62), (0, 0, -1), (1, 0, 0), 0.2, -0.7),
    ((1, -1), (0.45, -0.2, -0.58), (0, 0, -1), (1, 0, 0), 0.2, -1.1),
    ((-1, 1), (-0.5, 0.2, -0.7), (0, 0, -1), (1, 0, 0), 0.2, -0.9),
    ((-1, -1), (-0.5, -0.2, -0.65), (0, 0, -1), (1, 0, 0), 0.2, -0.5),
    ((1, 1), (0.45, 0.2, -0.36), (0, 0, -1), (1, 0, 0), 0.22, 1.0),
    ((1, -1), (0.45, -0.2, -0.36), (0, 0, -1), (1, 0, 0), 0.22, 0.3),
    ((-1, 1), (-0.5, 0.2, -0.38), (0, 0, -1), (1, 0, 0), 0.22, 0.1),
    ((-1, -1), (-0.5, -0.2, -0.38), (0, 0, -1), (1, 0, 0), 0.22, 0.9),
    (None, (-0.9, 0.0, 0.13), (-1, 0, 0.1), (0.1, 0, 1), 0.25, 1.1),
    (None, (0.66, 0.0, 0.2), (0.78, 0, 0.63), (0, 1, 0), 0.24, 0.6),
)


def _depth(capsules, points):
    """Smooth union of capsules at points (k, 3): negative inside, near the surface about the distance."""
    softness, total = 0.03, np.zeros(len(points))
    for start, end, first, last in capsules:
        axis = np.subtract(end, start)
        part = np.clip((points - start) @ axis / (axis @ axis), 0, 1)
        distance = np.linalg.norm(points - start - part[:, None] * axis, axis=1) - (first + (last - first) * part)
        total += np.exp(-np.minimum(distance, 2.0) / softness)
    return -softness * np.log(total)


def posed(rest, pose):
    """Bend the limbs, the outer joints first, so that each joint carries what is already bent beyond it."""
    points = rest.copy()
    for leg, start, *directions, length, angle in _JOINTS:
        along, towards = (np.asarray(v) / np.linalg.norm(v) for v in directions)
        beyond = (rest - start) @ along > 0
        if leg is not None:
            beyond &= (rest[:, 0] * leg[0] > 0) & (rest[:, 1] * leg[1] > 0)
        if pose * angle:
            points[beyond] = bent(points[beyond] - start, along, towards, length, pose * angle) + start
    return points


def bent(points, along, towards, length, angle):
    """Bend a beam from the origin on, to an arc that turns by `angle` from `along` to `towards`, and straight on."""
    s, u = points @ along, points @ towards
    turned = angle * np.clip(s / length, 0, 1)
    radius, rest = length / angle, s - np.clip(s, 0, length)
    new_s = radius * np.sin(turned) + rest * np.cos(turned) - u * np.sin(turned)
    new_u = radius * (1 - np.cos(turned)) + rest * np.sin(turned) + u * np.cos(turned)
    return points + (new_s - s)[:, None] * along + (new_u - u)[:, None] * towards
