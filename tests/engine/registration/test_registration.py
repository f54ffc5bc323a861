# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that are deformed onto others, from starts that are near the truth."""

from dataclasses import replace

import numpy as np
import pytest

from engine import Progress, TriangleMesh, run
from engine.geometry.eigenpairs import eigenpairs_steps
from engine.geometry.laplacian import laplace_beltrami
from engine.mesh.closest_points import ClosestPoints, FoundPoints
from engine.mesh.surface_points import SurfacePoints
from engine.registration.deformable import DeformableSurface
from engine.registration.elastic import ElasticSurface
from engine.registration.registration import (
    AGAIN,
    CLOSE,
    FINE,
    LAST,
    POLISH,
    SOFT,
    Stage,
    register_steps,
    restarted_steps,
    smooth_start,
)
from tests.bodies import relative_of_creature
from tests.shapes import compacted, creature, icosphere, permuted, rotation


def deformable(vertices, triangles, cut=None):
    mesh = TriangleMesh(vertices, triangles)
    return DeformableSurface(mesh, laplace_beltrami(mesh), cut)


def at(points, surface, values):
    """Values of vertices, interpolated at found points."""
    return np.einsum("kc,kcd->kd", points.barycentric, values[surface.triangles[points.triangles]])


@pytest.fixture(scope="module")
def bodies():
    """A body at rest and, in another meshing, bent: surfaces and rest positions."""
    first, second = creature(0.0, 9), creature(0.7, 9, turn=0.7)
    return deformable(*first[:2]), deformable(*second[:2]), first[2], second[2]


@pytest.fixture(scope="module")
def near_truth(bodies):
    """For each vertex of the source, the vertex of the target that is nearest at rest."""
    return np.linalg.norm(bodies[2][:, None] - bodies[3], axis=2).argmin(axis=1)


@pytest.fixture(scope="module")
def functions(bodies):
    source = bodies[0]
    spectrum = run(eigenpairs_steps(laplace_beltrami(source.mesh), 40))
    return spectrum.functions * np.sqrt(source.mesh.area)


@pytest.fixture(scope="module")
def registered(bodies, near_truth, functions):
    source, target = bodies[:2]
    return run(register_steps(source, target, smooth_start(source, target, near_truth, functions)))


def assert_valid(points, surface):
    assert points.triangles.min() >= 0
    assert points.triangles.max() < len(surface.triangles)
    assert points.barycentric.min() >= 0
    np.testing.assert_allclose(points.barycentric.sum(axis=1), 1)


def test_a_bent_body_is_recovered_between_the_vertices(registered, bodies):
    source, target, rest_x, rest_y = bodies
    size, edge = np.sqrt(source.mesh.area), source.mesh.edge_lengths.mean()
    for points, own, other, surface in (
        (registered.on_target, rest_x, rest_y, target),
        (registered.on_source, rest_y, rest_x, source),
    ):
        assert_valid(points, surface)
        errors = np.linalg.norm(own - at(points, surface, other), axis=1)
        assert errors.mean() < 0.25 * edge
        assert errors.mean() < 0.012 * size
        assert errors.max() < 0.08 * size


def test_the_source_lies_on_the_target(registered, bodies):
    source, target = bodies[:2]
    there = at(registered.on_target, target, target.vertices)
    gaps = np.square(registered.positions - there).sum(axis=1)
    assert registered.misfit == pytest.approx(float(source.mass @ gaps))
    back = at(registered.on_source, source, registered.positions) - target.vertices
    left = source.mass @ np.sqrt(gaps), target.mass @ np.linalg.norm(back, axis=1)
    assert registered.gaps == pytest.approx(left)
    assert registered.misfit < 1e-4
    rotations = source.elastic.rotations(registered.positions, FINE.rotation_radius)
    assert registered.energy == pytest.approx(source.elastic.energy(registered.positions, rotations))


def test_there_and_back_leads_home(registered, bodies):
    source, target = bodies[:2]
    homes = at(registered.on_source, source, source.vertices)
    trips = np.linalg.norm(at(registered.on_target, target, homes) - source.vertices, axis=1)
    assert trips.mean() < 0.01
    assert trips.max() < 0.06


def test_no_triangle_is_turned_over(registered, bodies):
    source, target = bodies[:2]
    a, b, c = registered.positions[source.triangles].transpose(1, 0, 2)
    seen = at(registered.on_target, target, target.normals)[source.triangles].sum(axis=1)
    kept = np.einsum("td,td->t", np.cross(b - a, c - a), seen) > 0
    assert np.average(kept, weights=source.mesh.triangle_areas) > 0.97


def test_a_stiff_body_that_is_taken_as_strained_does_not_pull_longer_legs_short():
    source = deformable(*relative_of_creature())
    target = deformable(*relative_of_creature(legs=1.6))
    strained = source.elastic.strained(target.vertices, 0.05)
    misplaced = []
    for elastic in (None, strained):
        stages = (Stage((40,) * 5, 0.05, 0.0, matched="around"),)
        found = run(register_steps(source, target, target.vertices, stages, elastic=elastic))
        misplaced.append(source.mass @ np.linalg.norm(found.positions - target.vertices, axis=1))
    assert misplaced[1] < 0.6 * misplaced[0]


def test_a_body_at_rest_stays_where_it_is(bodies):
    source = bodies[0]
    result = run(register_steps(source, source, source.vertices, (FINE,)))
    gaps = np.linalg.norm(result.positions - source.vertices, axis=1)
    assert gaps.mean() < 1e-3
    assert result.energy < 1e-4
    assert result.misfit < 1e-6


def test_a_turned_and_resized_target_gets_the_source_turned(bodies, registered, near_truth, functions):
    source, target = bodies[:2]
    turn = rotation([2, -1, 1], 1.9)
    moved = deformable(0.02 * target.mesh.vertices @ turn.T + [1, 2, 3], target.triangles)
    result = run(register_steps(source, moved, smooth_start(source, moved, near_truth, functions)))
    np.testing.assert_allclose(result.positions, registered.positions @ turn.T, atol=1e-6)
    assert result.energy == pytest.approx(registered.energy, rel=1e-4)
    assert result.misfit == pytest.approx(registered.misfit, rel=1e-4)


def test_the_order_of_the_vertices_does_not_matter(bodies, registered, near_truth, functions):
    source, target = bodies[:2]
    vertices, triangles, new = permuted(source.mesh.vertices, source.triangles, seed=2)
    shuffled = deformable(vertices, triangles)
    start = np.empty_like(source.vertices)
    start[new] = smooth_start(source, target, near_truth, functions)
    result = run(register_steps(shuffled, target, start))
    np.testing.assert_allclose(result.positions[new], registered.positions, atol=1e-3)
    assert np.linalg.norm(result.positions[new] - registered.positions, axis=1).mean() < 1e-5


@pytest.mark.parametrize("matched", ["vertices", "around"])
def test_cheap_matches_lead_to_nearly_the_same(bodies, registered, near_truth, functions, matched):
    source, target = bodies[:2]
    stages = tuple(replace(stage, matched=matched) for stage in (SOFT, FINE, CLOSE, LAST))
    start = smooth_start(source, target, near_truth, functions)
    cheap = run(register_steps(source, target, start, stages))
    assert_valid(cheap.on_target, target)
    moves = np.linalg.norm(
        at(cheap.on_target, target, target.vertices) - at(registered.on_target, target, target.vertices), axis=1
    )
    assert np.sqrt(source.mass @ moves**2) < 0.4 * source.mesh.edge_lengths.mean() / np.sqrt(source.mesh.area)


def test_a_lead_goes_on_in_the_same_direction(bodies, near_truth, functions):
    source, target = bodies[:2]
    start = smooth_start(source, target, near_truth, functions)
    plain, leading = (
        run(register_steps(source, target, start, (Stage((20,), 0.1, 0.0, lead=lead),))).positions - start
        for lead in (0.0, 0.8)
    )
    np.testing.assert_allclose(leading, 1.8 * plain, atol=1e-12)


def test_momentum_adds_the_step_before(bodies, near_truth, functions):
    source, target = bodies[:2]
    start = smooth_start(source, target, near_truth, functions)
    one, two, carried = (
        run(register_steps(source, target, start, (Stage((20,) * rounds, 0.1, 0.0, momentum=momentum),))).positions
        for rounds, momentum in ((1, 0.0), (2, 0.0), (2, 0.8))
    )
    np.testing.assert_allclose(carried, two + 0.8 * (one - start), atol=1e-12)


def test_momentum_lets_a_surface_slide_back_sooner():
    """A ball on itself, its points crowded towards one pole: nothing but what that costs says where they belong."""
    ball = deformable(*icosphere(6))
    radius = np.linalg.norm(ball.vertices, axis=1).mean()
    crowded = ball.vertices + np.array([0, 0, 0.4 * radius])
    start = radius * crowded / np.linalg.norm(crowded, axis=1, keepdims=True)
    before = ball.elastic.energy(start, ball.elastic.rotations(start, CLOSE.rotation_radius))
    plain, carried = (
        run(register_steps(ball, ball, start, (Stage((1000,) * 16, 0.05, 0.0, momentum=momentum),)))
        for momentum in (0.0, 0.8)
    )
    assert before - carried.energy > 2 * (before - plain.energy) > 0
    assert carried.misfit < 1e-4


def test_given_matches_pull_first(bodies, registered, near_truth):
    """Even from a place that tells nothing: all of the source in one small ball."""
    source, target, rest_x, rest_y = bodies
    back = np.linalg.norm(rest_y[:, None] - rest_x, axis=2).argmin(axis=1)
    corners = np.eye(3)

    def at_vertices(surface, vertices):
        first = np.array([np.flatnonzero((surface.triangles == v).any(axis=1))[0] for v in vertices])
        place = (surface.triangles[first] == vertices[:, None]).argmax(axis=1)
        return type(registered.on_target)(first, corners[place], np.zeros(len(vertices)))

    first = at_vertices(target, near_truth), at_vertices(source, back)
    result = run(register_steps(source, target, 1e-3 * source.vertices, (SOFT,), first))
    errors = np.linalg.norm(rest_x - at(result.on_target, target, rest_y), axis=1) / np.sqrt(source.mesh.area)
    assert errors.mean() < 0.02


def test_the_weights_decide_between_fit_and_shape():
    """A ball onto one that is longer: stiff it keeps its shape, soft it takes that of the target."""
    source = deformable(*icosphere(5))
    vertices, triangles = icosphere(5)
    target = deformable(vertices * [1, 1, 1.5], triangles)
    stiff, soft = (
        run(register_steps(source, target, source.vertices, (Stage((weight,) * 6, 0.1, 0.0),))) for weight in (1, 1000)
    )
    assert stiff.energy < soft.energy
    assert stiff.misfit > 10 * soft.misfit


def test_progress_counts_the_rounds(bodies, near_truth, functions):
    source, target = bodies[:2]
    start = smooth_start(source, target, near_truth, functions)
    reports = list(register_steps(source, target, start, (POLISH, Stage((1000,), 0.1, 0.05))))
    assert all(isinstance(report, Progress) for report in reports)
    rounds = len(POLISH.weights) + 1
    fractions = [report.fraction for report in reports]
    # Searches report as well, where the round before ended.
    np.testing.assert_allclose(np.unique(fractions), np.arange(rounds + 1) / rounds)
    assert fractions == sorted(fractions)


def test_a_smooth_start_with_all_functions_is_the_map_itself():
    ball = deformable(*icosphere(3))
    spectrum = run(eigenpairs_steps(laplace_beltrami(ball.mesh), len(ball.vertices)))
    functions = spectrum.functions * np.sqrt(ball.mesh.area)
    images = np.random.default_rng(0).permutation(len(ball.vertices))
    if functions.shape[1] == len(ball.vertices):
        np.testing.assert_allclose(smooth_start(ball, ball, images, functions), ball.vertices[images], atol=1e-6)
    constant = smooth_start(ball, ball, images, functions[:, :1])
    np.testing.assert_allclose(constant, np.broadcast_to(ball.mass @ ball.vertices[images], constant.shape), atol=1e-6)


def test_a_smooth_start_is_without_the_noise_of_the_map(bodies, near_truth, functions):
    source, target = bodies[:2]
    random = np.random.default_rng(1)
    noisy = np.where(
        random.random(len(near_truth)) < 0.1, random.integers(0, len(target.vertices), len(near_truth)), near_truth
    )
    wanted = target.vertices[near_truth]
    before = np.linalg.norm(target.vertices[noisy] - wanted, axis=1)
    after = np.linalg.norm(smooth_start(source, target, noisy, functions) - wanted, axis=1)
    assert after.max() < 0.6 * before.max()


def test_what_the_target_lacks_keeps_its_shape():
    """A tail that is cut off on the target is not squeezed into the stump, and what is left comes to lie in place."""
    vertices, triangles, _ = creature(0.4, 11)
    whole = TriangleMesh(vertices, triangles)
    tail = vertices[:, 0] < -1.0
    assert 0.01 < tail.mean() < 0.1
    cut = TriangleMesh(*compacted(vertices, triangles[~tail[triangles].any(axis=1)]))
    source, target = (deformable(mesh.vertices, mesh.triangles) for mesh in (whole, cut))
    truth = target.in_unit_size(vertices)
    found = run(register_steps(source, target, 0.97 * truth, (FINE, CLOSE, LAST)))
    away = np.linalg.norm(found.positions - truth, axis=1)
    assert away[~tail].max() < 0.02
    assert away[tail].max() < 0.05
    back = run(register_steps(target, source, 1.03 * source.in_unit_size(cut.vertices), (FINE, CLOSE, LAST)))
    assert np.linalg.norm(back.positions - source.in_unit_size(cut.vertices), axis=1).max() < 0.02


@pytest.mark.parametrize("which", ["source", "target"])
def test_where_a_surface_was_cut_it_is_not_drawn_to_where_the_other_ends(which):
    """What was cut out too large is not squeezed onto the part that it stands for."""
    vertices, triangles, _ = creature(0.4, 11)
    part, piece = (compacted(vertices, triangles[vertices[triangles, 0].min(axis=1) > x]) for x in (0.05, -0.2))
    cut = np.zeros(len(piece[0]), bool)
    cut[np.unique(TriangleMesh(*piece).boundary_edges)] = True
    errors = []
    for where in (None, cut):
        surfaces = deformable(*piece, where), deformable(*part)
        source, target = surfaces if which == "source" else surfaces[::-1]
        here = source.mesh.vertices
        truth = target.in_unit_size(here)
        found = run(register_steps(source, target, truth, (FINE, CLOSE, LAST)))
        errors.append(np.linalg.norm(found.positions - truth, axis=1)[here[:, 0] > 0.1].mean())
    assert errors[1] < 0.7 * errors[0]


def test_rotations_are_averaged_over_more_between_unlike_bodies(bodies, near_truth, functions):
    source, target = bodies[:2]
    start = smooth_start(source, target, near_truth, functions)
    wider = replace(FINE, rotation_radius=FINE.rotation_radius + 0.02)
    halfway = run(register_steps(source, target, start, (FINE,), isometry=0.5))
    np.testing.assert_array_equal(halfway.positions, run(register_steps(source, target, start, (wider,))).positions)
    alike = run(register_steps(source, target, start, (FINE,))).positions
    assert 1e-4 < np.abs(halfway.positions - alike).mean() < 0.02


def test_guides_lead_to_what_is_far_in_space():
    ball = deformable(*icosphere(6))
    turned = ball.vertices @ rotation([0.0, 0.0, 1.0], 1.2).T
    # A ball lies on itself whichever way it is turned: only guides can tell.
    stage = Stage((5,) * 10, 0.0, 0.0, guide_length=1.0)
    guides = ball.vertices, ball.vertices

    def error(**options):
        found = run(register_steps(ball, ball, turned, (stage,), **options))
        return np.linalg.norm(found.positions - ball.vertices, axis=1).mean()

    start = np.linalg.norm(turned - ball.vertices, axis=1).mean()
    assert error(guides=guides) < 0.1 * start
    assert error() > 0.8 * start


def test_a_restart_goes_by_guides():
    ball = deformable(*icosphere(6))
    turn = rotation([0.0, 0.0, 1.0], 0.5)
    search = ClosestPoints(ball.mesh).moved(ball.vertices)
    matches = search.nearest(ball.vertices @ turn.T), search.nearest(ball.vertices @ turn)
    everything = np.linalg.qr(np.concatenate([ball.vertices, ball.normals], axis=1))[0]
    functions = everything / np.sqrt(ball.mass.mean())
    guides = ball.vertices, ball.vertices

    def error(**options):
        stages = (replace(AGAIN, guide_length=1.0), LAST)
        found = run(restarted_steps(ball, ball, functions, matches, stages=stages, **options))
        return np.linalg.norm(found.positions - ball.vertices, axis=1).mean()

    # The first round goes where the matches say; then nothing but guides tells one place of a ball from another.
    start = np.linalg.norm(ball.vertices @ turn.T - ball.vertices, axis=1).mean()
    assert error(guides=guides) < 0.5 * start
    assert error() > 0.8 * start


@pytest.mark.parametrize(("subdivisions", "decides"), [(16, True), (8, False)])
def test_of_a_start_without_cross_sections_other_positions_say_which_way_round_it_is(subdivisions, decides):
    vertices, triangles = icosphere(subdivisions)
    blade = deformable(vertices * [1, 0.2, 0.07], triangles)
    turned = blade.vertices * [1, -1, -1]
    steps = register_steps(blade, blade, blade.vertices * [1, 0, 0], (SOFT,), posed=turned)
    np.testing.assert_allclose(run(steps).positions, turned if decides else blade.vertices, atol=1e-3)


def test_a_smooth_start_does_not_say_where_the_surface_is_strained(monkeypatch):
    vertices, triangles = icosphere(16)
    blade = deformable(vertices * [1, 0.2, 0.07], triangles)
    itself = SurfacePoints.at_vertices(blade.mesh, np.arange(len(vertices)))
    matches = FoundPoints(itself.triangles, itself.barycentric, np.zeros(len(vertices)))
    seen = []
    softened = ElasticSurface.softened

    def noted(surface, positions, *rest, **more):
        seen.append(positions)
        return softened(surface, positions, *rest, **more)

    monkeypatch.setattr(ElasticSurface, "softened", noted)
    start = blade.vertices * [1, 0, 0]  # no more than a curve
    run(register_steps(blade, blade, start, (AGAIN,), (matches, matches), posed=blade.vertices))
    assert len(seen) == 1
    np.testing.assert_allclose(np.ptp(seen[0], axis=0), np.ptp(blade.vertices, axis=0), rtol=0.1)
