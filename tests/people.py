# SPDX-License-Identifier: GPL-3.0-or-later
"""People of any build with rigs of several kinds, of which it is known which bone is which, and how they move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from engine import Skeleton, TriangleMesh, posed_motion
from tests.shapes import capsule_surface, rotation

WIDTH = 0.025
"""Over what distance the weights of two bones mix."""


@dataclass(frozen=True, eq=False)
class Rig:
    """Bones, weights (n, b), and for each bone the names of those of the plain rig that it does the work of."""

    names: tuple[str, ...]
    skeleton: Skeleton
    weights: csr_array
    origins: tuple[frozenset[str], ...]


@dataclass(frozen=True, eq=False)
class Person:
    """A body at rest with its plain rig."""

    mesh: TriangleMesh
    rig: Rig

    @property
    def height(self):
        """How tall it is."""
        return np.ptp(self.mesh.vertices[:, 2])

    def posed(self, motion):
        """Vertices (f, n, 3) as its plain rig moves them."""
        return skinned(self.mesh.vertices, self.rig, motion)


def bones_of(legs=1.0, arms=1.0, *, fingers=True):
    """Bones of the plain rig: of each its parent, head and tail; it stands on z = 0, looks to -y, and is 1.8 tall."""
    hip = 0.10 + 0.82 * legs
    up = hip - 0.92
    bones = {
        "hips": (None, (0, 0, 0.95), (0, 0, 1.08)),
        "spine1": ("hips", (0, 0, 1.08), (0, 0, 1.2)),
        "spine2": ("spine1", (0, 0, 1.2), (0, 0, 1.32)),
        "spine3": ("spine2", (0, 0, 1.32), (0, 0, 1.46)),
        "neck": ("spine3", (0, 0, 1.46), (0, 0, 1.56)),
        "head": ("neck", (0, 0, 1.56), (0, 0, 1.8)),
    }
    bones = {name: (above, *((0, 0, end[2] + up) for end in ends)) for name, (above, *ends) in bones.items()}
    for side, s in (("L", 1), ("R", -1)):
        z = 1.42 + up
        out = [s * x for x in (0.03, 0.16, 0.16 + 0.28 * arms, 0.16 + 0.54 * arms, 0.26 + 0.54 * arms)]
        bones |= {
            f"clavicle.{side}": ("spine3", (out[0], 0, z), (out[1], 0, z)),
            f"upper_arm.{side}": (f"clavicle.{side}", (out[1], 0, z), (out[2], 0.01, z)),
            f"forearm.{side}": (f"upper_arm.{side}", (out[2], 0.01, z), (out[3], 0, z)),
            f"hand.{side}": (f"forearm.{side}", (out[3], 0, z), (out[4], 0, z)),
        }
        for name, y, along in (("thumb", -0.05, (0.6, -0.8)), ("index", -0.035, (1, 0)), ("middle", 0.035, (1, 0))):
            x = out[3] + s * 0.05 if name == "thumb" else out[4]
            step = 0.075 * np.array([s * along[0], along[1], 0])
            first = np.array([x, y, z])
            if fingers:
                bones[f"{name}1.{side}"] = (f"hand.{side}", tuple(first), tuple(first + step))
                bones[f"{name}2.{side}"] = (f"{name}1.{side}", tuple(first + step), tuple(first + 2 * step))
        x = s * 0.1
        bones |= {
            f"thigh.{side}": ("hips", (x, 0, hip), (x, -0.015, 0.1 + 0.4 * legs)),
            f"shin.{side}": (f"thigh.{side}", (x, -0.015, 0.1 + 0.4 * legs), (x, 0.02, 0.1)),
            f"foot.{side}": (f"shin.{side}", (x, 0.02, 0.1), (x, -0.12, 0.035)),
            f"toe.{side}": (f"foot.{side}", (x, -0.12, 0.035), (x, -0.2, 0.035)),
        }
    return bones


RADII = {
    "hips": (0.14, 0.13),
    "spine1": (0.13, 0.125),
    "spine2": (0.125, 0.13),
    "spine3": (0.13, 0.11),
    "neck": (0.06, 0.055),
    "head": (0.09, 0.11),
    "clavicle": (0.08, 0.075),
    "upper_arm": (0.07, 0.052),
    "forearm": (0.052, 0.038),
    "hand": (0.04, 0.045),
    "thigh": (0.095, 0.065),
    "shin": (0.062, 0.042),
    "foot": (0.048, 0.035),
    "toe": (0.035, 0.03),
}


def person(resolution=40, girth=1.0, turn=0.0, **build):
    """Make somebody: girth, and lengths of legs and arms, in units of the usual ones; see `bones_of`."""
    bones = bones_of(**build)
    names = tuple(bones)
    parents = np.array([-1 if above is None else names.index(above) for above, _, _ in bones.values()])
    skeleton = Skeleton(parents, *(np.array([bone[end] for bone in bones.values()], float) for end in (1, 2)))
    radii = np.array([RADII.get(name.split(".")[0], (0.024, 0.02)) for name in names])
    thick = girth * radii
    thick[
        [name.split(".")[0] in {"hand", "foot", "toe"} or name[:-3] in {"thumb", "index", "middle"} for name in names]
    ] /= girth
    capsules = [
        (tuple(head), tuple(tail), *ends)
        for head, tail, ends in zip(skeleton.heads, skeleton.tails, thick, strict=True)
    ]
    points = np.concatenate([skeleton.heads, skeleton.tails])
    box = [points.min(axis=0) - 0.2 * girth, points.max(axis=0) + 0.2 * girth]
    mesh = TriangleMesh(*capsule_surface(capsules, box, resolution, turn))
    weights = smooth_weights(mesh.vertices, skeleton, radii)
    return Person(mesh, Rig(names, skeleton, weights, tuple(frozenset([name]) for name in names)))


def figure_surface(resolution=18, turn=0.3, *, head=1.0, legs=1.0, arms=1.0, apart=0.0):
    """Make the surface of somebody who may look like a toy, without fingers.

    Parameters
    ----------
    head, legs, arms : float
        How large the head is, and how long legs and arms are, in units of the usual ones.
    apart : float
        How much farther each leg is to its side.

    Returns
    -------
    mesh : TriangleMesh
        The surface.
    bones : (n,) array of str
        The name of the nearest bone of each vertex.
    """
    bones = bones_of(legs, arms, fingers=False)
    names = np.array(list(bones))
    ends = np.array([bone[1:] for bone in bones.values()], float)
    radii = np.array([RADII[name.split(".")[0]] for name in names])
    is_leg = np.array([name.split(".")[0] in {"thigh", "shin", "foot", "toe"} for name in names])
    ends[is_leg, :, 0] += apart * np.sign(ends[is_leg, :, 0])
    skull = names == "head"
    ends[skull, :, 2] = ends[skull, :1, 2] + np.array([0.08 * (head - 1), 0.24 + 0.12 * (head - 1)])
    radii[skull] *= head
    capsules = [(tuple(start), tuple(end), *own) for (start, end), own in zip(ends, radii, strict=True)]
    margin = 0.2 * max(head, 1.0)
    box = [ends.min(axis=(0, 1)) - margin, ends.max(axis=(0, 1)) + margin]
    mesh = TriangleMesh(*capsule_surface(capsules, box, resolution, turn))
    return mesh, names[away_from(mesh.vertices, ends, radii).argmin(axis=1)]


def smooth_weights(points, skeleton, radii):
    """Weights (n, b) by the distances from bones with radii (b, 2), four at most for each point."""
    away = away_from(points, np.stack([skeleton.heads, skeleton.tails], axis=1), radii)
    weights = np.exp((away.min(axis=1, keepdims=True) - away) / WIDTH * 2)
    weights[weights < np.maximum(0.02, np.sort(weights, axis=1)[:, [-4]])] = 0
    return csr_array(weights / weights.sum(axis=1, keepdims=True))


def away_from(points, ends, radii):
    """Signed distances of points from the surfaces of round cones, (n, b): ends (b, 2, 3) and radii at both (b, 2)."""
    axes = ends[:, 1] - ends[:, 0]
    along = (np.einsum("nbd,bd->nb", points[:, None] - ends[:, 0], axes) / np.square(axes).sum(axis=1)).clip(0, 1)
    nearest = ends[:, 0] + along[:, :, None] * axes
    lengths = np.linalg.norm(points[:, None] - nearest, axis=2)
    return lengths - (radii[:, 0] + along * (radii[:, 1] - radii[:, 0]))


def skinned(vertices, rig, motion):
    """Vertices (f, n, 3) moved by a rig: linear blend skinning."""
    shifts = motion.heads - np.einsum("fbij,bj->fbi", motion.turns, rig.skeleton.heads)
    result = np.empty((len(motion), *vertices.shape))
    for number, (turns, moved) in enumerate(zip(motion.turns, shifts, strict=True)):
        blended = (rig.weights @ turns.reshape(-1, 9)).reshape(-1, 3, 3)
        result[number] = np.einsum("nij,nj->ni", blended, vertices) + rig.weights @ moved
    return result


def moved(rig, angles, ways=None, slides=None):
    """Motion of a rig: for some bones rotation vectors (f, 3) in space against the parent, and the way of the first.

    `slides` are the ways of others against what they hang on, (f, 3) each.
    """
    count = max((len(vectors) for vectors in angles.values()), default=1)
    basis = np.tile(np.eye(4), (count, len(rig.names), 1, 1))
    for name, vectors in angles.items():
        if name in rig.names:
            for frame, vector in enumerate(np.asarray(vectors, float)):
                angle = np.linalg.norm(vector)
                if angle > 0:
                    basis[frame, rig.names.index(name), :3, :3] = rotation(vector, angle)
    if ways is not None:
        basis[:, 0, :3, 3] = ways
    for name, way in (slides or {}).items():
        basis[:, rig.names.index(name), :3, 3] = way
    rest = np.tile(np.eye(4), (len(rig.names), 1, 1))
    rest[:, :3, 3] = rig.skeleton.heads
    return posed_motion(rig.skeleton, rest, basis)


def walk(person, count=48, rate=24):
    """Motion of a walk in which the lower foot stands exactly where it is, and the side of that foot in each pose."""
    phase = 2 * np.pi * np.arange(count) / rate
    angles = {}
    for side, shift in (("L", 0), ("R", np.pi)):
        swing, lift = 0.4 * np.sin(phase + shift), 0.6 * np.cos(phase + shift).clip(0)
        angles[f"thigh.{side}"], angles[f"shin.{side}"] = (np.outer(each, [1, 0, 0]) for each in (swing, lift))
        angles[f"foot.{side}"] = -angles[f"thigh.{side}"] - angles[f"shin.{side}"]
    toes = [person.rig.names.index(f"toe.{side}") for side in "LR"]
    places = moved(person.rig, angles).heads[:, toes]
    lower = places[:, :, 2].argmin(axis=1)
    steps = np.diff(places, axis=0)[np.arange(count - 1), lower[1:]]
    ways = -np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    ways[:, 2] = person.rig.skeleton.heads[toes[0], 2] - places[np.arange(count), lower, 2]
    return moved(person.rig, angles, ways), np.array(list("LR"))[lower]


def at_rest_in(person, angles):
    """The same person, at rest in a pose of the plain rig: arms hanging down, for instance."""
    motion = moved(person.rig, {name: [vector] for name, vector in angles.items()})
    skeleton = Skeleton(person.rig.skeleton.parents, motion.heads[0], motion.tails[0])
    rig = Rig(person.rig.names, skeleton, person.rig.weights, person.rig.origins)
    return Person(TriangleMesh(person.posed(motion)[0], person.mesh.triangles), rig)


HANGING = {
    "upper_arm.L": (0, 0.9, 0),
    "upper_arm.R": (0, -0.9, 0),
    "forearm.L": (0, 0, -0.3),
    "forearm.R": (0, 0, 0.3),
    "thigh.L": (0, -0.12, 0),
    "thigh.R": (0, 0.12, 0),
}
"""A rest pose with arms and legs as many rigs have it."""


def renamed(rig, seed=0):
    """The same rig: other names, and its bones in another order."""
    order = np.random.default_rng(seed).permutation(len(rig.names))
    place = np.argsort(order)
    parents = rig.skeleton.parents[order]
    skeleton = Skeleton(np.where(parents < 0, -1, place[parents]), rig.skeleton.heads[order], rig.skeleton.tails[order])
    names = tuple(f"B{number:02}" for number in range(len(order)))
    return Rig(names, skeleton, csr_array(rig.weights[:, order]), tuple(rig.origins[bone] for bone in order))


class _Draft:
    """A rig under construction."""

    def __init__(self, rig):
        self.parents = {
            n: rig.names[p] if p >= 0 else None for n, p in zip(rig.names, rig.skeleton.parents, strict=True)
        }
        self.ends = {n: (h, t) for n, h, t in zip(rig.names, rig.skeleton.heads, rig.skeleton.tails, strict=True)}
        self.columns = {n: rig.weights[:, [i]].toarray().ravel() for i, n in enumerate(rig.names)}
        self.origins = dict(zip(rig.names, rig.origins, strict=True))

    def done(self, prefix):
        """Finish it, with other names."""
        names = list(self.parents)
        parents = np.array([names.index(above) if above else -1 for above in self.parents.values()])
        skeleton = Skeleton(parents, *(np.array([self.ends[n][end] for n in names], float) for end in (0, 1)))
        weights = csr_array(np.stack([self.columns[n] for n in names], axis=1))
        return Rig(tuple(prefix + n for n in names), skeleton, weights, tuple(self.origins[n] for n in names))

    def add(self, name, parent, ends, column=0.0, origins=()):
        """Add a bone."""
        self.parents[name], self.ends[name] = parent, tuple(np.array(end, float) for end in ends)
        self.columns[name] = np.zeros_like(next(iter(self.columns.values()))) + column
        self.origins[name] = frozenset(origins)

    def merge(self, name, into):
        """Let one bone do the work of another, too."""
        self.columns[into] = self.columns[into] + self.columns.pop(name)
        self.origins[into] |= self.origins.pop(name)
        above = self.parents.pop(name)
        self.parents = {n: (into if into != n else above) if p == name else p for n, p in self.parents.items()}
        del self.ends[name]

    def rechain(self, chain, count, points):
        """Replace a chain by one of so many bones of equal length."""
        joints = np.array([*(self.ends[n][0] for n in chain), self.ends[chain[-1]][1]])
        starts = np.append(0, np.cumsum(np.linalg.norm(np.diff(joints, axis=0), axis=1)))
        cuts = np.linspace(0, starts[-1], count + 1)
        new = np.stack([np.interp(cuts, starts, axis) for axis in joints.T], axis=1)
        along = joints[-1] - joints[0]
        place = (points - joints[0]) @ along / np.linalg.norm(along)
        total = sum(self.columns[n] for n in chain)
        hats = np.stack(
            [
                np.interp(place, np.add(cuts[[i, i + 1]].mean(), cuts[1] * np.array([-1, 0, 1])), [0, 1, 0])
                for i in range(count)
            ]
        )
        hats[0] = np.where(place < cuts[1] / 2, 1, hats[0])
        hats[-1] = np.where(place > cuts[-1] - cuts[1] / 2, 1, hats[-1])
        above, names = self.parents[chain[0]], [f"{chain[0]}.{i}" for i in range(count)]
        origins = {
            i: frozenset().union(
                *(
                    self.origins[n]
                    for n, a, b in zip(chain, starts, starts[1:], strict=False)
                    if min(b, cuts[i + 1]) - max(a, cuts[i]) > 1e-6
                )
            )
            for i in range(count)
        }
        for name in chain:
            del self.parents[name], self.ends[name], self.columns[name], self.origins[name]
        for i, name in enumerate(names):
            self.add(name, names[i - 1] if i else above, new[i : i + 2], total * hats[i] / hats.sum(axis=0), origins[i])
        self.parents = {n: names[-1] if p in chain else p for n, p in self.parents.items()}


def fine_rig(person):
    """The person's rig with more bones: a spine of five, arms in two pieces, twist bones, a root, controls."""
    draft, points = _Draft(person.rig), person.mesh.vertices
    draft.rechain(["spine1", "spine2", "spine3"], 5, points)
    for side in "LR":
        draft.rechain([f"upper_arm.{side}"], 2, points)
        head, tail = draft.ends[f"forearm.{side}"]
        place = ((points - head) @ (tail - head) / np.square(tail - head).sum()).clip(0, 1)
        column = draft.columns[f"forearm.{side}"] * place
        draft.columns[f"forearm.{side}"] = draft.columns[f"forearm.{side}"] - column
        draft.add(f"forearm_twist.{side}", f"forearm.{side}", ((head + tail) / 2, tail), column)
        foot = draft.ends[f"foot.{side}"][0]
        draft.add(f"foot_ik.{side}", None, (foot, foot + np.array([0, 0.1, 0])))
    draft.add("root", None, ((0, 0, 0), (0, 0.2, 0)))
    draft.parents |= {name: "root" for name, above in draft.parents.items() if above is None and name != "root"}
    return draft.done("X_")


def coarse_rig(person):
    """The person's rig with fewer bones: a spine of two, no collar bones, no toes, fingers of one bone."""
    draft, points = _Draft(person.rig), person.mesh.vertices
    for side in "LR":
        draft.merge(f"clavicle.{side}", "spine3")
        draft.merge(f"toe.{side}", f"foot.{side}")
        for finger in ("thumb", "index", "middle"):
            if f"{finger}2.{side}" in draft.parents:
                draft.merge(f"{finger}2.{side}", f"{finger}1.{side}")
    draft.rechain(["spine1", "spine2", "spine3"], 2, points)
    return draft.done("Y_")


def haunched_rig(person, reach):
    """The person's rig with a bone above each thigh that carries it and moves the upper part of it, reach above it."""
    draft, points = _Draft(person.rig), person.mesh.vertices
    for side in "LR":
        head, tail = draft.ends[f"thigh.{side}"]
        place = ((points - head) @ (tail - head) / np.square(tail - head).sum()).clip(0, 1)
        column = draft.columns[f"thigh.{side}"] * (1 - place) / 2
        draft.columns[f"thigh.{side}"] = draft.columns[f"thigh.{side}"] - column
        draft.add(f"haunch.{side}", "hips", (head + np.array([0, 0, reach]), head), column)
        draft.parents[f"thigh.{side}"] = f"haunch.{side}"
    return draft.done("Z_")
