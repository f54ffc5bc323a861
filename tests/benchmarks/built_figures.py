# SPDX-License-Identifier: GPL-3.0-or-later
"""Match figures of random proportions, as artists build them over a skeleton, with others of their kind.

    python -m tests.benchmarks.built_figures [--kinds chibi,bird,...] [--pairs 4] [--seed 1] [--style NAME]

People, toys with large heads or short legs, centaurs, mermaids, people with wings and a tail, quadrupeds, birds,
insects, two-legged lizards: each is made of round cones along bones.  Both of a pair are one such surface,
deformed to other lengths and girths of its limbs, by as much as `--spread` says (0.25: a quarter up or down is usual),
and to another pose, so that the true correspondence is known.  They look the same way, but for a turn about the
vertical of one in four.  Both are then meshed anew, the source evenly, the target in one of the styles; with `same`,
neither is, and both have the same triangles:

    even      4,000 vertices, spread evenly
    few       900 of them, by Blender's Decimate
    voxels    by Blender's voxel remesh, so that what touches is one
    uneven    small triangles on one side of the body, large ones on the other

A row holds for either map the mean error, and the share of places with one of more than 15: distances from the truth x
100 over the square root of the area; then by how much another map was less credible, the confidence and the seconds of
processor time.  A pair is wrong if more than three hundredths of the places of either map are that far away.
"""

import argparse
import itertools
import time
from dataclasses import dataclass
from functools import cache

import bpy
import numpy as np
from scipy.spatial import cKDTree

from engine import HierMatchError, MatchSettings, Skeleton, TriangleMesh, match
from tests.benchmarks.remeshed import FAR, WRONG, Remeshed, errors, remeshed, said
from tests.people import RADII, bones_of, smooth_weights
from tests.shapes import capsule_surface, rotation, subdivided

CONFIDENT = 0.5
HANDS = {"hand", "thumb1", "thumb2", "index1", "index2", "middle1", "middle2"}
FINE = 28
"""Cells of the grid per unit length on which figures are meshed; they are about 2 tall or long."""


def mirrored(bones):
    """Add the right side of bones whose names end in .L."""
    result = dict(bones)
    for name, (above, head, tail, radii) in bones.items():
        if name.endswith(".L"):
            other = above[:-1] + "R" if above.endswith(".L") else above
            result[name[:-1] + "R"] = (other, (-head[0], *head[1:]), (-tail[0], *tail[1:]), radii)
    return result


def chain(name, above, points, radii):
    """Bones one after the other through points, whose radii are those there."""
    side = name[-2:] if name[-2:] == ".L" else ""
    plain, result = name.removesuffix(side), {}
    for number, (head, tail) in enumerate(itertools.pairwise(points)):
        own = f"{plain}{number + 1}{side}"
        result[own] = (above, tuple(head), tuple(tail), (radii[number], radii[number + 1]))
        above = own
    return result


def human(*, head=1.0, legs=1.0, arms=1.0, girth=1.0, fingers=True):
    """Somebody with arms to the sides; see `bones_of`."""
    result = {}
    for name, (above, *ends) in bones_of(legs, arms, fingers=fingers).items():
        start, end = (np.array(place, float) for place in ends)
        radii = np.array(RADII.get(name.split(".")[0], (0.024, 0.02)))
        if name == "head":
            low = start[2] + 0.08 * (head - 1)
            result[name] = (above, (0, 0, low), (0, 0, low + 0.24 / head), tuple(radii * head))
        else:
            is_thin = name.split(".")[0] in {*HANDS, "foot", "toe"}
            result[name] = (above, tuple(start), tuple(end), tuple(radii * (1 if is_thin else girth)))
    return result


def trunk(height=1.0, y=0.0):
    """Upper half of somebody, from the hips up."""
    low = 0.95
    upper = {n: b for n, b in human().items() if n.split(".")[0] not in {"thigh", "shin", "foot", "toe"}}

    def moved(point):
        return (point[0], point[1] + y, point[2] - low + height)

    return {name: (above, moved(head), moved(tail), radii) for name, (above, head, tail, radii) in upper.items()}


def tailed_and_winged():
    """Somebody with a tail and wings."""
    tail = chain(
        "tail", "hips", [(0, 0.1, 0.95), (0, 0.4, 0.75), (0, 0.75, 0.7), (0, 1.1, 0.8)], (0.07, 0.05, 0.04, 0.02)
    )
    wing = chain(
        "wing.L",
        "spine3",
        [(0.06, 0.1, 1.38), (0.3, 0.35, 1.7), (0.75, 0.5, 1.75), (1.1, 0.6, 1.4)],
        (0.06, 0.06, 0.05, 0.035),
    )
    rib = chain("rib.L", "wing2.L", [(0.75, 0.5, 1.75), (0.7, 0.55, 1.2)], (0.045, 0.035))
    return human() | tail | mirrored(wing | rib)


def quadruped(*, legs=1.0, neck=1.0, tail=1.0):
    """An animal on four legs."""
    top = 0.8
    bones = {
        "hips": (None, (0, 0.45, top), (0, 0.05, top), (0.18, 0.17)),
        "chest": ("hips", (0, 0.05, top), (0, -0.45, top), (0.17, 0.2)),
        "neck": ("chest", (0, -0.52, top + 0.08), (0, -0.52 - 0.25 * neck, top + 0.08 + 0.3 * neck), (0.12, 0.09)),
    }
    nape = np.array(bones["neck"][2])
    bones["head"] = ("neck", tuple(nape), tuple(np.add(nape, (0, -0.33, -0.03))), (0.11, 0.06))
    bones |= mirrored(
        chain("ear.L", "head", [np.add(nape, (0.07, 0, 0.07)), np.add(nape, (0.13, 0.03, 0.24))], (0.045, 0.02))
    )
    ends = [(0, 0.58, top), (0, 0.58 + 0.3 * tail, top - 0.12), (0, 0.58 + 0.6 * tail, top - 0.3)]
    bones |= chain("tail", "hips", ends, (0.06, 0.045, 0.03))
    low = top - 0.1 - 0.62 * legs
    for name, y, above in (("fore", -0.4, "chest"), ("hind", 0.4, "hips")):
        points = [(0.14, y, top - 0.08), (0.15, y, (top + low) / 2), (0.15, y, low), (0.15, y - 0.1, low - 0.02)]
        bones |= mirrored(chain(f"{name}.L", above, points, (0.11, 0.065, 0.05, 0.045)))
    return bones


def centaur():
    """Somebody from the hips up on the body of an animal."""
    below = {n: b for n, b in quadruped(tail=1.2).items() if n.rstrip("12.LR") not in {"neck", "head", "ear"}}
    upper = trunk(0.95, -0.5)
    below = {f"h-{n}": (a and f"h-{a}", *rest) for n, (a, *rest) in below.items()}
    upper["hips"] = ("h-chest", *upper["hips"][1:])
    return below | upper


def mermaid():
    """Somebody with a fish's tail in place of legs."""
    points = [(0, 0, 0.98), (0, 0.02, 0.7), (0, 0.05, 0.4), (0, 0.03, 0.1), (0, 0.06, -0.1)]
    tail = chain("tail", "hips", points, (0.14, 0.12, 0.085, 0.05, 0.035))
    fluke = chain(
        "fluke.L", "tail4", [(0.02, 0.06, -0.1), (0.16, 0.14, -0.2), (0.32, 0.22, -0.24)], (0.05, 0.045, 0.025)
    )
    return trunk(0.95) | tail | mirrored(fluke)


def bird():
    """A bird that spreads its wings."""
    bones = {
        "body": (None, (0, 0.25, 0.6), (0, -0.15, 0.68), (0.16, 0.19)),
        "neck": ("body", (0, -0.25, 0.78), (0, -0.36, 1.0), (0.09, 0.075)),
        "head": ("neck", (0, -0.36, 1.02), (0, -0.44, 1.02), (0.1, 0.09)),
        "beak": ("head", (0, -0.5, 1.0), (0, -0.7, 0.95), (0.045, 0.015)),
    }
    bones |= chain("tail", "body", [(0, 0.35, 0.56), (0, 0.6, 0.5), (0, 0.85, 0.47)], (0.09, 0.07, 0.05))
    wing = [(0.14, -0.1, 0.74), (0.5, -0.12, 0.82), (0.95, 0.0, 0.82), (1.3, 0.15, 0.76)]
    bones |= mirrored(chain("wing.L", "body", wing, (0.07, 0.06, 0.05, 0.025)))
    for number, start in enumerate(wing[1:3]):
        feather = [start, (start[0] + 0.05, start[1] + 0.4 - 0.1 * number, start[2] - 0.04)]
        bones |= mirrored(chain(f"feather{'ab'[number]}.L", f"wing{number + 1}.L", feather, (0.05, 0.025)))
    leg = [(0.09, 0.1, 0.5), (0.1, 0.12, 0.25), (0.1, 0.08, 0.04), (0.1, -0.08, 0.02)]
    return bones | mirrored(chain("leg.L", "body", leg, (0.06, 0.035, 0.03, 0.028)))


def insect():
    """An insect with six legs and feelers."""
    bones = {
        "thorax": (None, (0, 0.12, 0.42), (0, -0.15, 0.42), (0.13, 0.13)),
        "abdomen": ("thorax", (0, 0.32, 0.42), (0, 0.85, 0.36), (0.15, 0.1)),
        "head": ("thorax", (0, -0.32, 0.43), (0, -0.42, 0.42), (0.1, 0.09)),
    }
    feeler = [(0.05, -0.46, 0.5), (0.16, -0.68, 0.62), (0.22, -0.95, 0.58)]
    bones |= mirrored(chain("feeler.L", "head", feeler, (0.03, 0.025, 0.02)))
    for number, (y, out) in enumerate(((-0.12, -0.28), (0.0, 0.05), (0.12, 0.42))):
        leg = [(0.1, y, 0.4), (0.4, y + out / 2, 0.58), (0.62, y + out, 0.25), (0.74, y + 1.15 * out, 0.0)]
        bones |= mirrored(chain(f"leg{'abc'[number]}.L", "thorax", leg, (0.05, 0.042, 0.034, 0.022)))
    return bones


def lizard():
    """A lizard that runs on its hind legs."""
    bones = {
        "hips": (None, (0, 0.12, 0.9), (0, -0.08, 0.94), (0.17, 0.18)),
        "chest": ("hips", (0, -0.08, 0.94), (0, -0.38, 1.02), (0.18, 0.14)),
        "neck": ("chest", (0, -0.42, 1.08), (0, -0.6, 1.28), (0.1, 0.09)),
        "head": ("neck", (0, -0.62, 1.32), (0, -0.98, 1.27), (0.12, 0.07)),
    }
    tail = [(0, 0.25, 0.88), (0, 0.6, 0.84), (0, 1.0, 0.82), (0, 1.4, 0.86)]
    bones |= chain("tail", "hips", tail, (0.13, 0.09, 0.06, 0.03))
    arm = [(0.13, -0.36, 0.94), (0.17, -0.4, 0.78), (0.15, -0.52, 0.72)]
    bones |= mirrored(chain("arm.L", "chest", arm, (0.05, 0.035, 0.03)))
    leg = [(0.12, 0.05, 0.85), (0.16, -0.12, 0.52), (0.16, 0.08, 0.25), (0.16, 0.0, 0.04), (0.16, -0.2, 0.03)]
    return bones | mirrored(chain("leg.L", "hips", leg, (0.13, 0.085, 0.055, 0.045, 0.035)))


KINDS = {
    "human": human,
    "chibi": lambda: human(head=2.1, legs=0.5, arms=0.7, girth=1.05, fingers=False),
    "dwarf": lambda: human(head=1.25, legs=0.45, arms=0.95, girth=1.3),
    "winged": tailed_and_winged,
    "centaur": centaur,
    "mermaid": mermaid,
    "quadruped": quadruped,
    "giraffe": lambda: quadruped(legs=1.25, neck=2.6, tail=0.7),
    "dachshund": lambda: quadruped(legs=0.5, tail=1.2),
    "bird": bird,
    "insect": insect,
    "lizard": lizard,
}


@dataclass(frozen=True, eq=False)
class Figure:
    """A figure at rest: its mesh, bones, their names, and weights of the vertices (n, b)."""

    mesh: TriangleMesh
    skeleton: Skeleton
    names: tuple[str, ...]
    weights: np.ndarray


@cache
def figure(kind):
    """Make a figure of a kind."""
    bones = KINDS[kind]()
    names = tuple(bones)
    parents = np.array([-1 if above is None else names.index(above) for above, *_ in bones.values()])
    heads, tails = (np.array([bone[end] for bone in bones.values()], float) for end in (1, 2))
    radii = np.array([bone[3] for bone in bones.values()])
    points = np.concatenate([heads, tails])
    margin = 1.5 * radii.max() + 0.05
    capsules = [(tuple(a), tuple(b), *ends) for a, b, ends in zip(heads, tails, radii, strict=True)]
    mesh = TriangleMesh(
        *capsule_surface(capsules, [points.min(axis=0) - margin, points.max(axis=0) + margin], FINE, 0.3)
    )
    skeleton = Skeleton(parents, heads, tails)
    return Figure(mesh, skeleton, names, smooth_weights(mesh.vertices, skeleton, radii).toarray())


def build_of(made, random, spread):
    """Length and girth of each bone, (b, 2): alike on both sides, and nearly so all along a limb."""
    plain = [name.removesuffix(".L").removesuffix(".R") for name in made.names]
    limbs = ["hand" if name in HANDS else name.rstrip("0123456789") for name in plain]
    each = {name: np.exp(random.normal(0, spread / 4, 2)) for name in plain}
    whole = {name: np.exp(random.normal(0, spread, 2)) for name in limbs}
    return np.array([each[name] * whole[limb] for name, limb in zip(plain, limbs, strict=True)]).clip(0.4, 2.5)


ARMS_DOWN = {"T": 0.0, "A": 0.7, "hanging": 1.15}


def pose_of(made, random, bend):
    """Rotation of each bone against its parent, (b, 3): arms down by one of three angles, and all bent at random."""
    down = random.choice(list(ARMS_DOWN.values()))
    vectors = random.normal(0, bend, (len(made.names), 3)) * [1, 0.5, 0.5]
    for number, name in enumerate(made.names):
        plain = name.split(".")[0]
        if plain in HANDS or made.skeleton.parents[number] < 0:
            vectors[number] *= 0.3
        if plain == "upper_arm":
            vectors[number, 1] += down if name.endswith("L") else -down
    return vectors


def deformed(made, build, vectors):
    """Vertices of a figure whose bones have other lengths and girths, and are turned by rotation vectors."""
    skeleton, count = made.skeleton, len(made.names)
    matrices, turns, heads = np.empty((count, 3, 3)), np.empty((count, 3, 3)), np.empty((count, 3))
    for bone, above in enumerate(skeleton.parents):
        angle = np.linalg.norm(vectors[bone])
        own = rotation(vectors[bone], angle) if angle > 0 else np.eye(3)
        turns[bone] = own if above < 0 else turns[above] @ own
        axis = skeleton.tails[bone] - skeleton.heads[bone]
        axis = axis / np.linalg.norm(axis)
        length, girth = build[bone]
        matrices[bone] = turns[bone] @ (girth * np.eye(3) + (length - girth) * np.outer(axis, axis))
        at = skeleton.heads[bone]
        heads[bone] = at if above < 0 else matrices[above] @ (at - skeleton.heads[above]) + heads[above]
    moved = np.einsum("bij,nbj->nbi", matrices, made.mesh.vertices[:, None] - skeleton.heads) + heads
    return np.einsum("nb,nbi->ni", made.weights, moved)


def by_blender(vertices, triangles, kind, **settings):
    """A surface after one of Blender's modifiers, its faces cut into triangles; the group Left is of its left half."""
    mesh = bpy.data.meshes.new("Figure")
    mesh.from_pydata(vertices, [], triangles)
    thing = bpy.data.objects.new("Figure", mesh)
    bpy.context.collection.objects.link(thing)
    left = vertices[:, 0] > np.median(vertices[:, 0])
    thing.vertex_groups.new(name="Left").add(np.flatnonzero(left).tolist(), 1.0, "REPLACE")
    modifier = thing.modifiers.new("Made", kind)
    for name, value in settings.items():
        setattr(modifier, name, value)
    made = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    made.calc_loop_triangles()
    places = np.array([vertex.co for vertex in made.vertices], float)
    faces = np.array([list(triangle.vertices) for triangle in made.loop_triangles])
    bpy.data.objects.remove(thing)
    bpy.data.meshes.remove(mesh)
    return TriangleMesh(places, faces)


STYLES = {
    "same": TriangleMesh,
    "even": lambda v, t: remeshed(*subdivided(v, t, 2), "figure", 4000).mesh,
    "few": lambda v, t: by_blender(v, t, "DECIMATE", ratio=900 / len(v)),
    "voxels": lambda v, t: by_blender(v, t, "REMESH", mode="VOXEL", voxel_size=np.ptp(v, axis=0).max() / 90),
    "uneven": lambda v, t: by_blender(v, t, "DECIMATE", ratio=0.65, vertex_group="Left"),
}


def pair(kind, seed, styles, spread, bend):
    """Two figures of a kind, as `Remeshed`."""
    random, found = np.random.default_rng(seed), []
    for style in styles:
        made = figure(kind)
        vertices = deformed(made, build_of(made, random, spread), pose_of(made, random, bend))
        vertices = vertices @ rotation([0, 0, 1], random.choice([0, 0, 0, random.uniform(0, 2 * np.pi)])).T
        mesh = STYLES[style](vertices, made.mesh.triangles)
        model, places = cKDTree(vertices).query(mesh.vertices)[1], cKDTree(mesh.vertices).query(vertices)[1]
        found.append(Remeshed(mesh, model, places))
    return found


def measure(task):
    """Match a pair: a row to be printed, if it is wrong, its mean error and confidence."""
    kind, seed, styles, spread, bend = task
    source, target = pair(kind, seed, styles, spread, bend)
    label = f"{kind:10s} {seed:5d} {'/'.join(styles):14s}"
    start = time.process_time()
    try:
        result = match(source.mesh, target.mesh, MatchSettings(dense=True))
    except HierMatchError as error:
        return f"{label} {error}", True, None
    seconds = time.process_time() - start
    away = errors(source, target, result.source_to_target), errors(target, source, result.target_to_source)
    wrong = any((e > FAR).mean() > WRONG for e in away)
    what = "  ".join(f"{e.mean():6.2f} {(e > FAR).mean():6.1%}" for e in away)
    row = said(label, what, result.quality, seconds, wrong)
    return row, wrong, (np.mean([e.mean() for e in away]), result.quality.confidence)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", default=",".join(KINDS), help="which (default: all)")
    parser.add_argument("--pairs", type=int, default=4, help="of each kind (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the first pair (default %(default)s)")
    parser.add_argument("--style", default="all", help="how both are meshed: one of the styles, or all in turn")
    parser.add_argument("--spread", type=float, default=0.25, help="of lengths and girths (default %(default)s)")
    parser.add_argument("--bend", type=float, default=0.15, help="of the joints, in radians (default %(default)s)")
    options = parser.parse_args()
    styles, tasks = list(STYLES)[1:] if options.style == "all" else [options.style], []
    for number, kind in enumerate(options.kinds.split(",")):
        for seed in range(options.seed, options.seed + options.pairs):
            style = styles[(number + seed - 1) % len(styles)]
            source = "same" if style == "same" else "even"
            tasks.append((kind, seed, (source, style), options.spread, options.bend))
    print(f"{'':32s} {'there':14s}  {'back':14s} margin conf.  seconds")
    found = []
    for row, wrong, numbers in map(measure, tasks):
        print(row, flush=True)
        found.append((wrong, *(numbers or (np.nan, 0.0))))
    wrong, away, confidence = (np.array(column) for column in zip(*found, strict=True))
    sure = np.count_nonzero(wrong & (confidence >= CONFIDENT))
    print(f"{wrong.sum()} of {len(wrong)} wrong, {sure} of them with a confidence of {CONFIDENT} or more")
    if not wrong.all():
        print(f"the others: mean error {away[~wrong].mean():.2f}, worst {away[~wrong].max():.2f}")


if __name__ == "__main__":
    main()
