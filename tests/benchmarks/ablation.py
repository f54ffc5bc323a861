# SPDX-License-Identifier: GPL-3.0-or-later
"""What each mechanism of the dense match buys: fixed pairs of every kind, with each mechanism switched off in turn.

Of each mechanism and kind of pair: the mean error with everything and without it, how many pairs become wrong, how many
become right, how many maps change at all, and the seconds with and without.  All is done in one process, where what is
switched off is off; so seconds are longer than a user's.

    python -m tests.benchmarks.ablation --data FOLDER
    python -m tests.benchmarks.ablation --data FOLDER --kinds near,pieces --mechanisms "rigid maps,limb sides"

FOLDER holds the shapes with known truth that all benchmarks use, see `known_shapes`; worms, fish and balls
are made here.
"""

import argparse
import csv
import time
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from scipy.sparse import eye_array
from scipy.sparse.linalg import LinearOperator, eigsh
from scipy.spatial import cKDTree

from engine import HierMatchError, TriangleMesh, match, use_processes
from engine.dense.components.attached_sheets import MappedSheets
from engine.geometry.block_krylov import EigenPairs
from engine.geometry.symmetric_factor import symmetric_factor
from tests.benchmarks.clothed import clothed, garments
from tests.benchmarks.known_shapes import LOST, KnownShape, KnownShapes
from tests.benchmarks.modular import as_it_is, closed_up, ends_of, put_together
from tests.benchmarks.partial_pairs import cut_off
from tests.benchmarks.smooth_bodies import pair_of_bodies
from tests.bodies import fish
from tests.messes import partly_turned, without_faces
from tests.shapes import capsule_surface, creature, permuted, rotation
from tests.steps import returned

WRONG = 0.03
"""Share of places that are brought to another part of the body from which on a pair counts as wrong."""

WHOLE = {
    "near": ("cat0:cat1", "dog0:dog5", "michael1:michael19"),
    "persons": ("tr_reg_002:tr_reg_017", "tr_reg_000:tr_reg_004", "tr_reg_023:tr_reg_008"),
    "unlike": ("8_gorilla_01:8_man_01", "8_man_03:8_gorilla_03", "8_gorilla_02:8_man_03", "8_man_02:8_gorilla_01"),
}
"""Kind -> pairs by name, which are matched as they are."""

OTHERS = ("cat2:cat8", "tr_reg_011:tr_reg_035")
"""Pairs of which parts are cut off, and which are taken to pieces, clothed and broken."""


@dataclass(frozen=True, eq=False)
class Case:
    """Two meshes to be matched, each with the whole body and, for each vertex, that of the whole body, or -1."""

    kind: str
    name: str
    bodies: tuple
    meshes: tuple
    wholes: tuple


NONE = np.empty(0, np.int64)


def nothing(*_given, **_options):
    return None


def pieces_apart(x, y, task):
    """Match main parts alone, and never join the pieces of a body."""
    result = yield from import_module("engine.matching.shape_matching").matched_steps(x, y, task)
    return result, x, y


def without_starts(own):
    """Propose maps without what the sparse match found."""
    return lambda x, y, starts=(), *, search=True, **options: own(
        x, y, () if search else starts, search=search, **options
    )


def agreeing_already(own):
    """Follow the target once at last, and never go on in turns."""
    return lambda follow, fit: own(replace(follow, disagree=()), fit)


def by_arpack(matrix, null, count, guess):
    """Find the lowest eigenpairs by ARPACK, with a shift below the spectrum."""
    n = matrix.shape[0]
    shift = -0.01 * guess
    factor = symmetric_factor(matrix - shift * eye_array(n))
    inverse = LinearOperator((n, n), matvec=factor.solve, dtype=float)
    start = np.random.default_rng(0).standard_normal(n)
    values, vectors = eigsh(matrix, min(count, n - 1), sigma=shift, OPinv=inverse, v0=start, tol=1e-4)
    vectors[:, 0] = null
    return returned(EigenPairs(np.append(0, values[1:].clip(0)), vectors, complete=True))


R, D, P = "engine.dense.registered_hypotheses", "engine.dense.dense_registration", "engine.registration.prolongation"
Q, C, E = "engine.dense.proposers", "engine.dense.components", "engine.shapes.enclosing_surface"
MECHANISMS = {
    "the paper's answers": [(f"{D}.map_hypotheses_steps", without_starts)],
    "rigid maps": [("engine.dense.dense_hypotheses.rigid_maps", lambda _: lambda *_given: [])],
    "matchings as they are": [(f"{Q}.unrefined_hypotheses_steps", lambda _: lambda *_given: returned([]))],
    "limb sides": [(f"{Q}.repaired_start_steps", lambda _: lambda *_given: returned(None))],
    "half turns": [(f"{Q}.is_placed", lambda _: lambda _in_place: False)],
    "rolling back": [
        (f"{R}.Follower.rolled_back_steps", lambda _: lambda _self, candidates: returned([[c] for c in candidates]))
    ],
    "untwisting": [
        (
            f"{R}.untwisted",
            lambda _: lambda _x, _s, _t, positions, _i=1.0: SimpleNamespace(positions=positions, otherwise=[]),
        )
    ],
    "forked limbs": [("engine.registration.axial_twists.forked_limbs", lambda _: lambda *_given: [])],
    "other windings": [(f"{R}.untwisted", lambda own: lambda *given: own(*given)._replace(otherwise=[]))],
    "close contest": [(f"{room}.contenders", lambda own: lambda *given: own(*given)[:1]) for room in (D, Q)],
    "agreeing in turns": [(f"{R}.Follower.settled_steps", agreeing_already)],
    "softening by strain": [("engine.registration.registration._softened", lambda _: lambda elastic, *_given: elastic)],
    "mended patches": [(f"{P}.with_patches_mended", lambda _: lambda _mesh, images, *_given: images)],
    "untangling": [(f"{P}.untangle_steps", lambda _: lambda *_given, **_options: returned(None))],
    "finer coarse shapes": [
        ("engine.matching.shape_matching.finer_shapes_steps", lambda _: lambda x, y, _count: returned((x, y)))
    ],
    "joined pieces": [("engine.matching.matching.matched_with_pieces_steps", lambda _: pieces_apart)],
    "parts": [
        ("engine.matching.matching.part_matched_steps", lambda _: lambda result, *_given, **_options: returned(result)),
        (
            "engine.matching.matching.agreed_part_steps",
            lambda _: lambda known, *_given, **_options: returned((known, False)),
        ),
    ],
    "ends of limbs": [("engine.matching.matching.standing_match_steps", lambda _: lambda *_given: returned(None))],
    "spikes pulled in": [("engine.repair.cleaning._pull_in_spikes", lambda _: nothing)],
    "pinched gaps": [
        ("engine.repair.cleaning.pinched_gaps", lambda _: lambda *_given: (np.empty((0, 3), np.int64),) * 2)
    ],
    "joined borders": [
        ("engine.repair.cleaning.seam_partners", lambda _: lambda vertices, *_: np.arange(len(vertices)))
    ],
    "cut handles": [
        (f"{room}.evened_steps", lambda _: lambda x, y: returned((x, y)))
        for room in ("engine.matching.shape_matching", "engine.dense.densify")
    ],
    "block Krylov": [("engine.geometry.eigenpairs.lowest_eigenpairs_steps", lambda _: by_arpack)],
    "filled openwork": [(f"{E}.is_openwork", lambda _: lambda _mesh: False)],
    "bridged gaps": [(f"{E}.bridged", lambda _: lambda values, *_given: values)],
    "pieces between": [(f"{E}._between", lambda _: lambda pieces, *_given: np.zeros(len(pieces), bool))],
    "thin pieces": [(f"{E}._midst", lambda _: lambda *_given: np.zeros((0, 3)))],
    "sheets": [
        (
            f"{C}.component_maps.mapped_sheets",
            lambda _: lambda *_given: MappedSheets(NONE, NONE, np.empty((0, 3)), NONE),
        )
    ],
    "paired pieces": [(f"{C}.component_maps.paired_parts", lambda _: lambda *_given: [])],
    "turned pieces": [(f"{C}.component_alignment._turned", lambda _: lambda pair: [pair.rotations[-1]] * 2)],
    "deformed pieces": [(f"{C}.component_alignment._DEFORMED", lambda _: (10**9, 0))],
}
"""Mechanism -> what is put in the place of what, made of the latter."""


@contextmanager
def switched(*patches):
    """Put something in the place of attributes, given by module and name, for a while."""
    with ExitStack() as undo:
        for path, make in patches:
            owner, name = owner_of(path)
            own = getattr(owner, name)
            setattr(owner, name, make(own))
            undo.callback(setattr, owner, name, own)
        yield


def counting(mechanism, reached):
    """What notes that a mechanism is used, in the place of any function of it."""

    def of(own):
        if not callable(own):
            reached.add(mechanism)
            return own

        def used(*given, **options):
            reached.add(mechanism)
            return own(*given, **options)

        return used

    return of


def measured_with_all(case):
    """What is measured of a case with everything, and which mechanisms it uses at all."""
    reached = set()
    patches = [(path, counting(name, reached)) for name, own in MECHANISMS.items() for path, _ in own]
    with switched(*patches):
        return measured(case), reached


def owner_of(path):
    """The module or class that an attribute belongs to, and its name."""
    where, _, name = path.rpartition(".")
    try:
        return import_module(where), name
    except ModuleNotFoundError:
        module, _, cls = where.rpartition(".")
        return getattr(import_module(module), cls), name


def cases(shapes, kinds):
    """All pairs of some kinds."""
    for kind in kinds:
        yield from _whole(shapes, kind) if kind in WHOLE else _made(shapes, kind)


def _whole(shapes, kind):
    for name in WHOLE[kind]:
        bodies = tuple(shapes.read(one) for one in name.split(":"))
        meshes = tuple(body.mesh for body in bodies)
        yield Case(kind, name, bodies, meshes, tuple(np.arange(mesh.vertex_count) for mesh in meshes))


def _made(shapes, kind):
    if kind in MADE:
        yield from MADE[kind]()
        return
    for number, name in enumerate(OTHERS):
        bodies = tuple(shapes.read(one) for one in name.split(":"))
        random = np.random.default_rng(number)
        first, second = (as_it_is(body.mesh) for body in bodies)
        if kind == "parts":
            second = _part(bodies[1].mesh, 0.6, number)
        elif kind == "busts":
            second = _part(bodies[1].mesh, 0.5, number, closed=True)
        elif kind == "both cut":
            first, second = _part(bodies[0].mesh, 0.8, number + 10), _part(bodies[1].mesh, 0.65, number)
        elif kind == "pieces":
            second = put_together(bodies[1], *ends_of(bodies[1], random), "capped")
        elif kind == "clothed":
            worn = garments(bodies[0], random)
            first, second = (
                SimpleNamespace(mesh=c.mesh, whole=np.where(c.pieces == 0, c.bare, -1))
                for c in (clothed(body, worn) for body in bodies)
            )
        elif kind == "messy":
            vertices, triangles = without_faces(bodies[1].mesh.vertices, bodies[1].mesh.triangles, 0.01, seed=number)
            second = _changed(*partly_turned(vertices, triangles, seed=number))
        elif kind == "spikes":
            mesh = bodies[1].mesh
            tips = random.choice(mesh.vertex_count, 12, replace=False)
            vertices = mesh.vertices.copy()
            vertices[tips] += random.uniform(0.2, 0.6, (12, 1)) * np.sqrt(mesh.area) * mesh.vertex_normals[tips]
            second = _changed(vertices, mesh.triangles)
        else:
            message = f"There is no kind {kind}."
            raise ValueError(message)
        yield Case(kind, name, bodies, (first.mesh, second.mesh), (first.whole, second.whole))


def _part(mesh, share, seed, *, closed=False):
    """What a plane leaves of a mesh."""
    part = cut_off(mesh, share, seed)
    if not closed:
        return SimpleNamespace(mesh=part.mesh, whole=part.vertices)
    vertices, triangles = closed_up(part.mesh.vertices, part.mesh.triangles)
    added = np.full(len(vertices) - len(part.vertices), -1)
    return SimpleNamespace(mesh=TriangleMesh(vertices, triangles), whole=np.append(part.vertices, added))


def _changed(vertices, triangles):
    """A mesh with the vertices of the whole body."""
    return SimpleNamespace(mesh=TriangleMesh(vertices, triangles), whole=np.arange(len(vertices)))


def _worms():
    """A worm with a thin tail, a dent and a fin, straight, and meshed anew and bent."""
    capsules = [((0, 0, 0), (2.6, 0, 0), 0.16, 0.05), ((0.1, 0, 0.05), (0.1, 0.0, 0.3), 0.05, 0.03)]
    box = [[-0.4, -0.4, -0.4], [2.9, 0.4, 0.5]]
    first, second = (capsule_surface(capsules, box, 22, turn) for turn in (0.0, 0.4))
    bent = bent_along(second[0], 0.9, np.array([0.0, 1.0, 0.0]))
    yield made_case("long", "worm:bent worm", first, (bent, second[1]), (first[0], second[0]))


def _fish():
    """A fish with a fin and a fluke that is nearly the same from below: bent sideways, upwards, and both ways."""
    for number, (bend, up) in enumerate(((0.5, 0.0), (0.5, 1.0), (-0.7, 0.6), (0.8, -0.8))):
        first, second = fish(18), permuted(*fish(21), number)[:2]
        towards = np.array([0.0, 1.0, up]) / np.hypot(1.0, up)
        bent = bent_along(second[0], bend, towards) @ rotation([1, 2, 3], 2.0 * number + 1).T
        yield made_case("fish", f"fish:bent {bend} {up}", first, (bent, second[1]), (first[0], second[0]))


def _balls():
    """Bodies without limbs, and what is left of them after a cap has been cut off."""
    for seed, missing in ((3, 0.0), (4, 0.08), (5, 0.2), (6, 0.2)):
        meshes, rests = pair_of_bodies(seed, 300, missing, 0.02)
        name = f"ball:without {missing}"
        yield made_case("balls", name, *((m.vertices, m.triangles) for m in meshes), rests)


def _spiky():
    """Small bodies, one of which has four spikes of a vertex each."""
    for seed in (1, 2, 3):
        random = np.random.default_rng(seed)
        (*first, rest), (vertices, triangles, other_rest) = creature(0.0, 8), creature(0.7, 9, turn=0.4)
        tips = random.choice(len(vertices), 4, replace=False)
        spiked = vertices.copy()
        spiked[tips] += random.uniform(0.5, 1.5, (4, 1)) * TriangleMesh(vertices, triangles).vertex_normals[tips]
        yield made_case("spiky", f"body:with spikes {seed}", first, (spiked, triangles), (rest, other_rest))


def bent_along(points, bend, towards):
    """Bend what lies along the x axis to an arc, by so many radians per unit of length."""
    across = points @ towards
    radius, angle = 1 / bend - across, bend * points[:, 0]
    turned = np.stack([np.sin(angle) * radius, 1 / bend - np.cos(angle) * radius], axis=1)
    others = points - points[:, :1] * [1, 0, 0] - across[:, None] * towards
    return others + turned[:, :1] * [1, 0, 0] + turned[:, 1:] * towards


def made_case(kind, name, first, second, rests):
    """Two made bodies, the places of which are named by where they lie at rest."""
    meshes = TriangleMesh(*first), TriangleMesh(*second)
    nearest = cKDTree(rests[1]).query(rests[0])[1]
    places = np.arange(len(rests[0]))
    bodies = tuple(
        KnownShape(one, "made", mesh, where, where)
        for one, mesh, where in zip(name.split(":"), meshes, (places, nearest), strict=True)
    )
    return Case(kind, name, bodies, meshes, tuple(np.arange(mesh.vertex_count) for mesh in meshes))


MADE = {"long": _worms, "fish": _fish, "balls": _balls, "spiky": _spiky}
"""Kind -> what makes its pairs, without any data."""


def measured(case):
    """Error x 100 / sqrt(area), share of lost places, seconds, and what tells maps apart."""
    numbers = []
    for body, whole in zip(case.bodies, case.wholes, strict=True):
        found = np.full(body.mesh.vertex_count, -1)
        found[whole[whole >= 0]] = np.flatnonzero(whole >= 0)
        numbers.append(found[body.samples])
    kept = (numbers[0] >= 0) & (numbers[1] >= 0)
    start = time.process_time()
    try:
        result = match(*case.meshes)
    except HierMatchError:
        return 100.0, 1.0, time.process_time() - start, 0
    seconds = time.process_time() - start
    errors = []
    for found, own, there in (
        (result.source_to_target, 0, 1),
        (result.target_to_source, 1, 0),
    ):
        images = case.wholes[there][found.nearest_vertices[numbers[own]]]
        known = kept & (images >= 0)
        errors.append(case.bodies[there].vertex_errors(images)[known])
    errors = np.concatenate(errors)
    return errors.mean(), (errors > LOST).mean(), seconds, hash(result.target_to_source.barycentric.tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    every = ("near", "persons", "unlike", "parts", "busts", "both cut", "pieces", "clothed", "messy", "spikes", *MADE)
    parser.add_argument("--kinds", default=",".join(every), help="kinds of pairs (default %(default)s)")
    parser.add_argument("--mechanisms", default=",".join(MECHANISMS), help="what to switch off (default: all in turn)")
    parser.add_argument("--most", type=int, default=99, help="pairs of each kind at most")
    parser.add_argument("--csv", type=Path, help="file to which each match is written")
    options = parser.parse_args()
    use_processes(1)
    chosen = {}
    for case in cases(KnownShapes(options.data), options.kinds.split(",")):
        chosen.setdefault(case.kind, []).append(case)
    chosen = {kind: of_kind[: options.most] for kind, of_kind in chosen.items()}
    rows = []
    print(f"{'switched off':24s} {'kind':9s} pairs   error  without  new wrong  new right  changed  seconds  without")
    for kind, of_kind in chosen.items():
        base, reached = zip(*(measured_with_all(case) for case in of_kind), strict=True)
        for mechanism in options.mechanisms.split(","):
            # What is never used changes nothing if it is switched off.
            with switched(*MECHANISMS[mechanism]):
                other = [
                    measured(case) if mechanism in used else own
                    for case, own, used in zip(of_kind, base, reached, strict=True)
                ]
            rows += [(mechanism, kind, c.name, *b, *o) for c, b, o in zip(of_kind, base, other, strict=True)]
            print(_row(mechanism, kind, base, other), flush=True)
    if options.csv:
        with options.csv.open("w", newline="") as file:
            csv.writer(file).writerows(rows)


def _row(mechanism, kind, base, other):
    error, _, seconds, _ = np.mean(base, axis=0)
    without, _, without_seconds, _ = np.mean(other, axis=0)
    wrong, right = (
        sum(b[1] <= WRONG < o[1] for b, o in zip(first, second, strict=True))
        for first, second in ((base, other), (other, base))
    )
    changed = sum(b[3] != o[3] for b, o in zip(base, other, strict=True))
    return (
        f"{mechanism:24s} {kind:9s} {len(base):5d} {error:7.2f} {without:8.2f} {wrong:10d} {right:10d} {changed:8d}"
        f" {seconds:8.1f} {without_seconds:8.1f}"
    )


if __name__ == "__main__":
    main()
