# SPDX-License-Identifier: GPL-3.0-or-later
"""Dense maps proposed for a body in two poses, whose truth is known vertex by vertex."""

from dataclasses import replace

import numpy as np
import pytest

from engine import Shape, TriangleMesh
from engine.dense import dense_hypotheses as map_hypotheses
from engine.dense.dense_hypotheses import (
    SparseStart,
    assessed_everywhere,
    map_hypotheses_steps,
    refined_hypothesis_steps,
    unrefined_hypotheses_steps,
    unrefined_hypothesis,
)
from engine.dense.functional_maps import PointMaps
from engine.runtime.progress import Progress, run
from tests.bodies import mirrored_body
from tests.shapes import creature, icosphere, permuted, plane, rotation

SAMPLES, EIGENPAIRS = 512, 120


def prepared(vertices, triangles):
    shape = Shape(TriangleMesh(vertices, triangles))
    run(shape.sample_steps(SAMPLES))
    run(shape.spectrum_steps(EIGENPAIRS))
    return shape


def hypotheses(x, y, starts=(), **options):
    return run(map_hypotheses_steps(x, y, starts, **options))


def error(rest, images, truth=None):
    """Mean distance at rest between the images of vertices and the true ones, by the size of the body."""
    truth = rest if truth is None else truth
    return np.linalg.norm(rest[images] - truth, axis=1).mean() / np.ptp(rest, axis=0).max()


@pytest.fixture(scope="module")
def poses():
    """A body without symmetry in two poses: shapes, and the place at rest of each vertex."""
    first, triangles, rest = creature(0.0, 9)
    return prepared(first, triangles), prepared(creature(1.0, 9)[0], triangles), rest


@pytest.fixture(scope="module")
def proposed(poses):
    return hypotheses(*poses[:2])


@pytest.fixture(scope="module")
def symmetric():
    """A body that is its own mirror image at rest, in two poses, triangulated without symmetry."""
    first, triangles, rest = mirrored_body(0.2, 9, seed=0)
    return prepared(first, triangles), prepared(mirrored_body(0.9, 9, seed=0)[0], triangles), rest


# --- what is found


def test_the_true_map_comes_first(poses, proposed):
    best = proposed[0]
    assert error(poses[2], best.images.on_y) < 0.02
    assert error(poses[2], best.images.on_x) < 0.02
    assert best.orientation > 0.6
    assert best.isometric_defect < 0.1
    assert best.origin == "extremities"


def test_hypotheses_are_ordered_few_and_distinct(poses, proposed):
    scores = [h.score for h in proposed]
    assert scores == sorted(scores)
    assert sum(h.orientation > 0 for h in proposed) <= 4
    assert sum(h.orientation <= 0 for h in proposed) <= 2
    places = poses[1].mesh.vertices
    for i, first in enumerate(proposed):
        for second in proposed[:i]:
            assert np.linalg.norm(places[first.images.on_y] - places[second.images.on_y], axis=1).mean() > 0.02


def test_maps_are_close_to_inverse_to_each_other(poses, proposed):
    best = proposed[0]
    there_and_back = best.images.on_x[best.images.on_y]
    assert error(poses[2], there_and_back) < 0.01


def test_the_mirror_image_is_found_and_flagged(symmetric):
    x, y, rest = symmetric
    found = hypotheses(x, y)
    assert error(rest, found[0].images.on_y) < 0.03
    assert found[0].orientation > 0.5
    mirrored = rest * [1, -1, 1]
    reversing = [h for h in found if h.orientation < 0]
    assert reversing
    assert min(error(rest, h.images.on_y, mirrored) for h in reversing) < 0.05
    assert all(error(rest, h.images.on_y, mirrored) > 0.05 for h in found if h.orientation > 0.3)


def test_a_mirrored_target_gives_maps_that_mirror(poses):
    x, y, rest = poses
    reflected = prepared(y.mesh.vertices * [1, -1, 1], y.mesh.triangles[:, ::-1])
    reversing = [h for h in hypotheses(x, reflected) if h.orientation < 0]
    assert reversing
    assert error(rest, reversing[0].images.on_y) < 0.03


def test_without_mirrored_maps_the_others_are_the_same(poses, proposed):
    found = hypotheses(*poses[:2], mirrored=False)
    assert all(h.orientation > 0 for h in found)
    assert error(poses[2], found[0].images.on_y) < 0.02
    assert found[0].score == pytest.approx(proposed[0].score, abs=0.2)


def test_the_map_to_all_vertices_is_the_same_in_steps(poses):
    x, y, _ = poses
    first, second = (hypotheses(x, y)[0] for _ in range(2))
    steps = run(first.images_steps())
    assert (steps.on_y == second.images.on_y).all()
    assert (steps.on_x == second.images.on_x).all()
    assert run(first.images_steps()) is first.images


def test_a_shape_is_mapped_to_itself_by_the_identity(poses):
    x, _, rest = poses
    best = hypotheses(x, x)[0]
    assert (best.images.on_y == np.arange(len(rest))).mean() > 0.99
    assert best.orientation > 0.99
    assert best.score < -10


# --- what must not matter


@pytest.mark.parametrize("change", ["turned", "scaled", "renumbered"])
def test_scores_do_not_depend_on_place_scale_or_order(poses, proposed, change):
    x, y, rest = poses
    vertices, triangles, new = y.mesh.vertices, y.mesh.triangles, np.arange(len(rest))
    if change == "turned":
        vertices = vertices @ rotation([1.0, -2.0, 0.5], 1.1).T + [3.0, -1.0, 10.0]
    elif change == "scaled":
        vertices = 250 * vertices
    else:
        vertices, triangles, new = permuted(vertices, triangles, seed=2)
    found = hypotheses(x, prepared(vertices, triangles))
    assert found[0].score == pytest.approx(proposed[0].score, abs=0.05)
    assert found[0].orientation == pytest.approx(proposed[0].orientation, abs=0.02)
    moved = np.linalg.norm(rest[np.argsort(new)[found[0].images.on_y]] - rest[proposed[0].images.on_y], axis=1)
    assert (moved > 0.05).mean() < 0.01


def test_more_samples_than_used_do_not_matter_and_the_answer_is_the_same_every_time(poses, proposed):
    x, y, _ = poses
    again = prepared(y.mesh.vertices, y.mesh.triangles)
    run(again.sample_steps(SAMPLES + 100))
    for first, second in zip(hypotheses(x, again), proposed, strict=True):
        np.testing.assert_array_equal(first.images.on_y, second.images.on_y)
        np.testing.assert_array_equal(first.images.on_x, second.images.on_x)
        assert first.terms == second.terms


# --- landmarks


def test_known_landmarks_enter_the_comparison(poses):
    x, y, rest = poses
    places = x.samples.vertices[20:60]  # not the extremities; the vertices of both poses have the same numbers
    rows_x, rows_y = (np.stack([_row(shape, place) for place in places]) for shape in (x, y))
    found = hypotheses(x, y, [SparseStart(rows_x, rows_y, "friend")])
    assert error(rest, found[0].images.on_y) < 0.02
    assert {h.origin for h in found} <= {"extremities", "friend"}


def test_landmarks_are_enough_without_a_search(poses):
    x, y, rest = poses
    rows = (np.stack([_row(shape, place) for place in x.samples.vertices[:30]]) for shape in (x, y))
    (only,) = hypotheses(x, y, [SparseStart(*rows)], search=False)
    assert only.origin == "landmarks"
    assert error(rest, only.images.on_y) < 0.02


def test_a_start_can_be_taken_as_it_is(poses, proposed):
    x, y, rest = poses
    known = x.samples.vertices[:30]
    start = SparseStart(x.solver.distances(known) / x.scale, y.solver.distances(known) / y.scale, "known")
    found = unrefined_hypothesis(proposed[0].domains, start)
    assert error(rest, found.images.on_y) < 0.02
    assert error(rest, found.images.on_x) < 0.02
    assert found.orientation > 0.6
    assert found.origin == "known"


def test_maps_that_are_no_isometries_or_turn_parts_over_are_doubtful(proposed):
    best = proposed[0]
    assert not best.is_doubtful
    assert replace(best, orientation=0.6).is_doubtful
    assert replace(best, terms={**best.terms, "commutator": 0.06}).is_doubtful


def test_matchings_are_proposed_as_they_are_from_either_side(poses, proposed):
    rest, domains = poses[2], proposed[0].domains
    found = run(unrefined_hypotheses_steps(domains))
    assert len(found) == 2
    for hypothesis in found:
        assert hypothesis.origin == "matching"
        assert hypothesis.orientation > 0.3
    assert min(error(rest, h.images.on_y) for h in found) < 0.04


def test_a_matching_that_only_the_target_offers_is_turned_round(poses, proposed, monkeypatch):
    rest, (x, y) = poses[2], proposed[0].domains
    places = [rest[d.vertices[: d.coarse_count]] for d in (x, y)]
    gaps = np.linalg.norm(places[0][:, None] - places[1], axis=2)

    def only_back(source, _target):
        yield Progress(0.5, "")
        return [PointMaps(gaps.argmin(axis=0), gaps.argmin(axis=1))] if source is y else []

    monkeypatch.setattr(map_hypotheses, "fitting_maps_steps", only_back)
    (found,) = run(unrefined_hypotheses_steps((x, y)))
    assert error(rest, found.images.on_y) < 0.03
    assert error(rest, found.images.on_x) < 0.03


def test_a_map_that_functional_maps_refine_is_scored_like_hypotheses(poses, proposed):
    everywhere = np.arange(poses[0].mesh.vertex_count)
    refined = run(refined_hypothesis_steps(proposed[0].domains, PointMaps(everywhere, everywhere), "truth"))
    assert refined.score == pytest.approx(proposed[0].score, abs=0.3)
    assert refined.origin == "truth"
    assert error(poses[2], refined.images.on_y) < 0.02


def test_maps_between_all_vertices_are_scored_like_hypotheses(poses, proposed):
    x, domains = poses[0], proposed[0].domains
    everywhere = np.arange(x.mesh.vertex_count)
    ahead = x.mesh.triangles[[np.flatnonzero((x.mesh.triangles == v).any(axis=1))[0] for v in everywhere]].max(axis=1)
    truth, shuffled = PointMaps(everywhere, everywhere), PointMaps(everywhere[::-1], everywhere[::-1])
    score = assessed_everywhere(domains, truth).score
    assert score < proposed[0].score + 0.5  # it is the true map itself
    assert (
        score
        < assessed_everywhere(domains, PointMaps(ahead, ahead)).score
        < assessed_everywhere(domains, shuffled).score
    )


def test_a_wrong_start_does_not_win(poses):
    x, y, rest = poses
    rng = np.random.default_rng(0)
    start = SparseStart(x.samples.rows[:30], y.samples.rows[rng.permutation(30)], "stranger")
    best = hypotheses(x, y, [start])[0]
    assert best.origin == "extremities"
    assert error(rest, best.images.on_y) < 0.02


# --- small and odd meshes


@pytest.mark.parametrize(
    "mesh",
    [(np.eye(3), np.array([[0, 1, 2]])), icosphere(1), icosphere(2), plane(5), creature(0.0, 5)[:2]],
    ids=["triangle", "icosahedron", "sphere", "plane", "body"],
)
def test_meshes_with_few_vertices_are_mapped(mesh):
    x = prepared(*mesh)
    found = hypotheses(x, x)
    count = x.mesh.vertex_count
    assert found
    for h in found:
        assert h.images.on_y.shape == h.images.on_x.shape == (count,)
        assert 0 <= h.images.on_y.min() <= h.images.on_y.max() < count
        assert np.isfinite(h.score)
        assert -1 <= h.orientation <= 1


def test_shapes_of_very_different_vertex_counts_are_mapped(poses):
    x, _, rest = poses
    vertices, triangles, other = creature(1.0, 7)
    found = hypotheses(x, prepared(vertices, triangles))
    assert np.linalg.norm(other[found[0].images.on_y] - rest, axis=1).mean() < 0.2


def _row(shape, vertex):
    """Distances from a vertex to all vertices, in sqrt(area)."""
    return shape.solver.distances(np.array([vertex]))[0] / shape.scale
