# SPDX-License-Identifier: GPL-3.0-or-later
"""Matches of bodies with parts of others: busts, halves, and what a scanner did not see."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from engine import (
    DenseMatch,
    MatchSettings,
    Shape,
    SurfaceMap,
    SurfacePoints,
    TriangleMesh,
    densify,
    match,
    match_steps,
)
from engine.matching import partial_match
from engine.matching.covered_parts import CoveredPart
from engine.matching.partial_match import PartialPair, agreed_part_steps, part_matched_steps, piece_matched_steps
from engine.matching.refinement import refine_map
from engine.matching.shape_matching import MatchTask, matched_steps
from engine.runtime.progress import Progress, run
from tests.shapes import compacted, creature, permuted, rotation

QUICK = MatchSettings(points=12, samples=100, hypotheses=2)


def cut(vertices, triangles, rest, kept):
    """What is left of a mesh of which only triangles with all of their places at rest kept are there."""
    both, faces = compacted(np.hstack([vertices, rest]), triangles[kept(rest[triangles])])
    return TriangleMesh(both[:, :3], faces), both[:, 3:]


def front(corners):
    """Head, neck, forelegs, and less than half of the trunk."""
    return corners[:, :, 0].min(axis=1) > 0.05


@pytest.fixture(scope="module")
def whole():
    vertices, triangles, rest = creature(0.0, 10)
    return TriangleMesh(vertices, triangles), rest


@pytest.fixture(scope="module")
def half():
    return cut(*creature(0.8, 10, turn=0.7), front)


@pytest.fixture(scope="module")
def result(whole, half):
    return match(whole[0], half[0], QUICK)


@pytest.fixture(scope="module")
def parts(result, whole, half):
    return result, whole, half


def test_no_landmarks_are_as_if_none_were_asked_for(whole, half, result):
    again = match(whole[0], half[0], QUICK, landmarks=[])
    np.testing.assert_array_equal(again.source_to_target.positions, result.source_to_target.positions)


def errors(found, rest, image_rest):
    """Distance at rest of each vertex from its image, over the length of the body."""
    images = np.einsum("kc,kcd->kd", found.barycentric, image_rest[found.corners])
    return np.linalg.norm(images - rest, axis=1) / 2.4


def astray(image, count):
    """Map everything to one place of an image."""
    return SurfaceMap.from_points(image, SurfacePoints.at_vertices(image, np.zeros(count, np.int64)))


def test_a_whole_body_is_matched_with_the_front_half_of_one(result, whole, half):
    assert np.mean(errors(result.target_to_source, half[1], whole[1])) < 0.02
    shown = whole[1][:, 0] > 0.15
    assert np.mean(errors(result.source_to_target, whole[1], half[1])[shown]) < 0.02


def test_a_half_that_was_closed_and_stands_where_the_whole_does_is_known_to_be_one(whole):
    opened, rest = cut(*creature(0.0, 10), front)
    ends = np.concatenate([opened.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]).tolist()
    border = [(head, tail, len(rest)) for tail, head in ends if [head, tail] not in ends]
    rim = np.unique(border)[:-1]
    half = TriangleMesh(
        np.vstack([opened.vertices, opened.vertices[rim].mean(axis=0)]), np.vstack([opened.triangles, border])
    )
    assert not len(half.boundary_edges)
    found = match(whole[0], half, QUICK)
    assert np.mean(errors(found.target_to_source, np.vstack([rest, rest[rim].mean(axis=0)]), whole[1])) < 0.02
    assert found.quality.confidence > 0.5
    assert found.quality.source_coverage < 0.6


def test_what_the_half_lacks_is_said_to_have_no_partner(result, whole):
    lacking = whole[1][:, 0] < -0.15
    assert (result.source_to_target.confidence[lacking] == 0).mean() > 0.95
    assert np.mean(result.source_to_target.confidence[whole[1][:, 0] > 0.15]) > 0.5
    areas = whole[0].vertex_areas
    share = areas @ (whole[1][:, 0] > 0.05) / areas.sum()
    assert result.quality.source_coverage == pytest.approx(share, abs=0.1)
    assert result.quality.coverage > 0.9
    assert "of the source has a partner" in result.quality.sentence


def test_the_time_that_parts_were_looked_for_is_noted(result):
    assert result.seconds["overlap"] > 0


def test_every_vertex_has_an_image_and_matched_points_lie_on_what_both_show(result, whole, half):
    assert len(result.source_to_target) == whole[0].vertex_count
    assert len(result.target_to_source) == half[0].vertex_count
    assert np.isfinite(result.source_to_target.positions).all()
    assert (result.source_points.positions[:, 0] > -0.2).all()


def test_the_other_way_round_the_target_is_cut_down(whole, half):
    result = match(half[0], whole[0], QUICK)
    assert np.mean(errors(result.source_to_target, half[1], whole[1])) < 0.02
    assert result.quality.coverage < 0.7
    assert "of the target is reached" in result.quality.sentence
    assert (result.target_to_source.confidence[whole[1][:, 0] < -0.15] == 0).mean() > 0.95


def test_size_rotation_and_vertex_order_of_the_part_do_not_matter(result, whole, half):
    vertices, triangles, new = permuted(half[0].vertices, half[0].triangles, seed=4)
    moved = 30 * vertices @ rotation([1.0, 2.0, 0.5], 2.0).T + [3.0, 2.0, -1.0]
    other = match(whole[0], TriangleMesh(moved, triangles), QUICK)
    rest = np.empty_like(half[1])
    rest[new] = half[1]
    expected = np.mean(errors(result.target_to_source, half[1], whole[1]))
    assert np.mean(errors(other.target_to_source, rest, whole[1])) == pytest.approx(expected, abs=0.003)


def test_a_landmark_holds_and_what_was_left_out_stays_so(whole, half):
    """The tail is left out by the user, the rear half by the match."""
    nose, nose_of_half = (int(rest[:, 0].argmax()) for rest in (whole[1], half[1]))
    tail = whole[1][:, 0] < -1.0
    result = match(whole[0], half[0], QUICK, landmarks=[[nose, nose_of_half]], excluded=(tail, None))
    assert result.source_to_target.nearest_vertices[nose] == nose_of_half
    assert result.seconds["missing parts"] > 0
    assert np.mean(errors(result.target_to_source, half[1], whole[1])) < 0.02


def test_a_shape_that_was_prepared_before_can_be_cut_down(result, whole, half):
    again = match(Shape(whole[0]), Shape(half[0]), QUICK)
    np.testing.assert_array_equal(again.source_to_target.triangles, result.source_to_target.triangles)
    np.testing.assert_array_equal(again.target_to_source.barycentric, result.target_to_source.barycentric)


def test_progress_rises_also_while_parts_are_looked_for(whole, half):
    reports = list(match_steps(whole[0], half[0], QUICK))
    fractions = [report.fraction for report in reports]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
    assert "Looking for what the surfaces share" in {report.label for report in reports}


@pytest.mark.parametrize("useless", ["too small", "without the landmark", "all of it"])
def test_with_a_piece_that_is_of_no_use_the_first_match_stays(useless, whole, half, monkeypatch):
    nose, nose_of_half = (int(rest[:, 0].argmax()) for rest in (whole[1], half[1]))
    task = MatchTask(QUICK, [[nose, nose_of_half]] if useless == "without the landmark" else None)
    x, y = Shape(whole[0]), Shape(half[0])
    first = run(matched_steps(x, y, task))
    height = {"too small": 0.98 * whole[1][:, 0].max(), "all of it": -np.inf}.get(useless, 0.0)
    covered = whole[1][:, 0] < 0 if useless == "without the landmark" else whole[1][:, 0] >= height
    asked = []

    def found_steps(*_):
        asked.append(covered)
        return [CoveredPart(covered, -100.0, is_new=True)]
        yield

    monkeypatch.setattr("engine.matching.partial_match.covered_parts_steps", found_steps)
    monkeypatch.setattr("engine.matching.partial_match.PartialPair.shows_all", lambda *_: False)
    assert run(part_matched_steps(first, x, y, task)) is first
    assert asked


@pytest.mark.parametrize("what", ["clear", "found again", "found elsewhere", "lacks something"])
def test_what_a_known_map_covers_is_enough_if_it_is_clear_or_found_again(what, result, whole, half, monkeypatch):
    known, x, y = result.dense, Shape(whole[0]), Shape(half[0])
    quality = replace(known.quality, likeness=1.0)
    first = result.with_dense(DenseMatch(known.source_to_target, known.target_to_source, quality))
    asked, tried = [], []

    def found_steps(*_):
        shown = whole[1][:, 0] > (-0.4 if what == "lacks something" else 0.1)
        asked.append(CoveredPart(shown, -100.0, is_new=what == "found elsewhere"))
        return asked
        yield

    def piece_matched_steps(*given, **named):
        tried.append(given)
        return steps(*given, **named)

    steps = partial_match.piece_matched_steps
    monkeypatch.setattr(partial_match, "covered_parts_steps", found_steps)
    monkeypatch.setattr(partial_match, "piece_matched_steps", piece_matched_steps)
    monkeypatch.setattr(partial_match, "ALL_ALIKE", -1000.0 if what == "clear" else 1000.0)
    monkeypatch.setattr(partial_match, "MUCH_ALIKE", -1000.0)
    found = run(part_matched_steps(first, x, y, MatchTask(QUICK, None)))
    assert found is not first
    assert np.mean(errors(found.target_to_source, half[1], whole[1])) < 0.02
    assert bool(asked) == (what != "clear")
    assert len(tried) == (2 if what in ("found elsewhere", "lacks something") else 1)


@pytest.mark.parametrize("start", [-0.4, 0.4], ids=["too large", "too small"])
def test_a_piece_that_is_too_large_shrinks_and_one_that_is_too_small_grows(start, result, whole, half, monkeypatch):
    areas, steps = [], partial_match.matched_steps

    def tried_steps(x, y, task):
        areas.append(x.mesh.area / whole[0].area)
        return steps(x, y, task)

    monkeypatch.setattr(partial_match, "matched_steps", tried_steps)
    quality = replace(result.dense.quality, likeness=1.0)
    known = result.with_dense(DenseMatch(result.source_to_target, result.target_to_source, quality))
    pair, piece = PartialPair(Shape(whole[0]), Shape(half[0]), of_source=True), whole[1][:, 0] > start
    found = run(piece_matched_steps(known, pair, MatchTask(QUICK, None), piece))
    true = whole[0].vertex_areas @ (whole[1][:, 0] > 0.05) / whole[0].area
    assert len(areas) == 2
    assert (areas[1] > areas[0]) == (start > 0.05)
    assert abs(areas[1] - true) < abs(areas[0] - true)
    assert found is not known
    assert np.mean(errors(found.target_to_source, half[1], whole[1])) < (0.04 if start > 0.05 else 0.02)


@pytest.mark.parametrize("way", ["the piece", "the match with another piece"])
@pytest.mark.parametrize("is_right", [True, False])
def test_another_search_agrees_with_a_right_map_alone_and_finds_one_either_way(is_right, way, parts, monkeypatch):
    result, whole, half = parts
    search = partial_match.covered_parts_steps

    def pieces_steps(*given):
        found = yield from search(*given)
        return found if way == "the piece" else [replace(piece, is_new=True) for piece in found]

    monkeypatch.setattr(partial_match, "covered_parts_steps", pieces_steps)
    known, pair = result.dense, PartialPair(Shape(whole[0]), Shape(half[0]), of_source=True)
    there, back = known.source_to_target, known.target_to_source
    if not is_right:
        there, back = astray(half[0], len(there)), astray(whole[0], len(back))
    # As of an overlap: how much alike they are is not known.
    quality = replace(known.quality, likeness=None, confidence=0.1)
    given = result.with_dense(DenseMatch(there, back, quality))
    found, agrees = run(agreed_part_steps(given, given, pair, MatchTask(QUICK, None)))
    assert agrees == is_right
    assert np.mean(errors(found.target_to_source, half[1], whole[1])) < 0.02


def test_refining_keeps_to_what_the_half_shows(result, whole, half):
    nose, nose_of_half = (int(rest[:, 0].argmax()) for rest in (whole[1], half[1]))
    maps = result.source_to_target, result.target_to_source
    refined = refine_map(whole[0], half[0], maps[0], [[nose, nose_of_half]], target_to_source=maps[1])
    assert refined.source_to_target.nearest_vertices[nose] == nose_of_half
    assert np.mean(errors(refined.target_to_source, half[1], whole[1])) < 0.02
    assert refined.quality.source_coverage == pytest.approx(result.quality.source_coverage, abs=0.05)
    assert (refined.source_to_target.confidence[whole[1][:, 0] < -0.15] == 0).mean() > 0.95


def test_another_correspondence_is_extended_over_what_the_half_shows(result, whole, half):
    maps = result.source_to_target, result.target_to_source
    dense = densify(whole[0], half[0], result.source_points, result.target_points, maps=maps)
    assert np.mean(errors(dense.target_to_source, half[1], whole[1])) < 0.02
    assert (dense.source_to_target.confidence[whole[1][:, 0] < -0.15] == 0).mean() > 0.95


def test_progress_never_goes_back_where_nothing_says_which_surface_is_the_part(monkeypatch):
    """Both ways round are tried, one after the other."""
    quality = SimpleNamespace(likeness=0.0, confidence=0.0, coverage=1.0, source_coverage=1.0)
    known = SimpleNamespace(dense=SimpleNamespace(quality=quality))

    def working(answer):
        """A computation of two steps."""
        yield from (Progress(0.0, "Working"), Progress(1.0, "Working"))
        return answer

    monkeypatch.setattr(partial_match, "has_border", lambda _: False)
    monkeypatch.setattr(partial_match, "known_piece_matched_steps", lambda *_: working(known))
    monkeypatch.setattr(partial_match, "_pieces_steps", lambda *_: working([]))
    task = SimpleNamespace(landmarks=None, clock=SimpleNamespace(lap=lambda _: None))
    fractions = [progress.fraction for progress in part_matched_steps(known, None, None, task)]
    assert len(fractions) == 8
    assert fractions == sorted(fractions)
