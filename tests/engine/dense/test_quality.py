# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of maps whose quality is known."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import TriangleMesh
from engine.dense.missing_parts import with_partner
from engine.dense.quality import assess_maps, exchanged_sentence, judged_map, overlap_sentence, with_pieces
from tests.bodies import mirrored_body
from tests.engine.dense.test_missing_parts import at, cut_square, nearest_on, without_cap
from tests.shapes import creature, icosphere, permuted, plane, rotation


def assessed(source, target, there, back, margin, *, doubt=0.0, **known):
    """Assess a map there, which may err by a doubt, and one back."""
    judged = judged_map(source, target, there, back, doubt), judged_map(target, source, back, there)
    return assess_maps((source, target), there, judged, margin, **known)


def by_index(source, target, margin=None):
    """Assess the map that keeps the indices."""
    return assessed(source, target, at(target), at(source), margin)


@pytest.fixture(scope="module")
def ball():
    return TriangleMesh(*icosphere(6))


@pytest.fixture(scope="module")
def square():
    return TriangleMesh(*plane(21))


@pytest.fixture(scope="module")
def symmetric():
    vertices, triangles, rest = mirrored_body(0.0, 9)
    other = cKDTree(rest).query(rest * [1, -1, 1])[1]
    return TriangleMesh(vertices, triangles), other


def test_the_identity_is_perfect(ball):
    quality = by_index(ball, ball)
    assert quality.orientation == pytest.approx(1)
    assert quality.distortion == pytest.approx(0, abs=1e-12)
    assert quality.coverage == pytest.approx(1)
    assert quality.disagreement == pytest.approx(0, abs=1e-12)
    assert quality.margin is None
    assert quality.confidence == pytest.approx(1)
    assert quality.sentence == "The shapes correspond closely."
    np.testing.assert_allclose(judged_map(ball, ball, at(ball), at(ball)).confidence, 1)


def test_size_place_and_order_do_not_matter():
    source, target = (TriangleMesh(*creature(pose, 9)[:2]) for pose in (0.0, 0.8))
    first = by_index(source, target, 1.5)
    turned = TriangleMesh(0.01 * target.vertices @ rotation([1, 2, 3], 2.0).T + 4, target.triangles)
    second = by_index(TriangleMesh(300 * source.vertices, source.triangles), turned, 1.5)
    vertices, triangles, new = permuted(source.vertices, source.triangles)
    shuffled, order = TriangleMesh(vertices, triangles), np.argsort(new)
    third = assessed(shuffled, target, at(target, order), at(shuffled, new), 1.5)
    for other in (second, third):
        for name in ("distortion", "coverage", "disagreement", "confidence"):
            assert getattr(other, name) == pytest.approx(getattr(first, name), rel=1e-6, abs=1e-9)
        assert other.orientation == pytest.approx(first.orientation, abs=0.01)
        assert other.sentence == first.sentence


def test_the_true_map_of_a_bent_body_corresponds_closely():
    source, target = (TriangleMesh(*creature(pose, 9)[:2]) for pose in (0.0, 0.8))
    quality = by_index(source, target)
    assert quality.orientation > 0.98
    assert quality.coverage == pytest.approx(1)
    assert quality.disagreement == pytest.approx(0, abs=1e-12)
    assert 0 < quality.distortion < 0.1
    assert quality.confidence > 0.9
    assert quality.sentence == "The shapes correspond closely."


@pytest.mark.parametrize("factor", [0.5, 1.3, 2.0, 4.0])
def test_the_distortion_of_a_stretched_square(factor, square):
    """Its sides change by the root of the factor, up and down; the diagonals of its cells by less."""
    stretched = TriangleMesh(square.vertices * [factor, 1, 1], square.triangles)
    quality = by_index(square, stretched)
    side, diagonal = abs(np.log(factor)) / 2, abs(np.log((factor + 1 / factor) / 2)) / 2
    sides, diagonals = 2 * 21 * 20, 20 * 20
    expected = (sides * side + 2 * diagonals * diagonal) / (sides + 2 * diagonals)
    assert quality.distortion == pytest.approx(expected, rel=1e-6)
    assert quality.orientation == pytest.approx(1)
    if expected > 0.5:
        assert "differ much" in quality.sentence
    elif expected > 0.2:
        assert "some stretching" in quality.sentence
    else:
        assert "closely" in quality.sentence


def test_a_mirrored_map_is_not_to_be_trusted(symmetric):
    body, other = symmetric
    quality = assessed(body, body, at(body, other), at(body, other), None)
    assert quality.orientation < -0.95
    assert quality.disagreement == pytest.approx(0, abs=1e-9)
    assert quality.distortion == pytest.approx(0, abs=1e-6)
    assert quality.confidence == 0
    assert "do not trust it" in quality.sentence


def test_a_half_that_is_not_reached_is_told(square):
    folded = nearest_on(square, square.vertices * [0.5, 1, 1])
    quality = assessed(square, square, folded, nearest_on(square, np.minimum(square.vertices * [2, 1, 1], 1)), None)
    reach = 0.5 + 2 / 21  # what is at most two spacings away counts as reached
    assert quality.coverage == pytest.approx(reach, abs=0.06)
    assert f"Only {quality.coverage:.0%} of the target is reached" in quality.sentence
    assert quality.disagreement == pytest.approx(0, abs=1e-9)


def test_a_small_part_that_the_other_lacks_does_not_sound_like_a_failure():
    sentence = overlap_sentence((1.0, 0.989), credible=True)
    assert sentence == "The shapes correspond, but for a small part of the target (1.1%) that the other lacks."
    assert "100% of the source and 100% of the target" in overlap_sentence((1.0, 0.999), credible=True)
    assert "of the source (1.5%)" in overlap_sentence((0.985, 0.99), credible=True)
    assert overlap_sentence((0.97, 1.0), credible=True).startswith("Only 97% of the source has a partner")


def test_a_map_to_one_point_has_no_orientation_and_hardly_any_coverage(ball):
    point = at(ball, np.zeros(ball.vertex_count, int))
    quality = assessed(ball, ball, point, point, None)
    assert quality.orientation == 0
    assert quality.coverage < 0.1
    assert quality.confidence == 0
    assert np.isfinite(quality.distortion)
    assert quality.disagreement == pytest.approx(4 / 3 / np.sqrt(4 * np.pi), rel=0.03)  # mean chord over the root area


def test_the_choice_of_the_map_counts(ball):
    clear, doubtful, even = (by_index(ball, ball, margin) for margin in (20.0, 0.5, 0.0))
    assert clear.confidence == pytest.approx(1)
    assert clear.sentence == "The shapes correspond closely."
    assert even.confidence == pytest.approx(0.5)
    assert even.confidence < doubtful.confidence < clear.confidence
    for quality in (doubtful, even):
        assert "Another map was almost as likely" in quality.sentence
    assert doubtful.margin == 0.5


def test_shapes_that_are_too_unlike_are_not_trusted(ball):
    """However well one is laid onto the other."""
    sure, even, unlike = (
        assessed(ball, ball, at(ball), at(ball), None, likeness=likeness) for likeness in (25.0, 13.5, 10.0)
    )
    assert sure.confidence == pytest.approx(1, abs=1e-6)
    assert sure.sentence == "The shapes correspond closely."
    assert even.confidence == pytest.approx(0.5)
    assert unlike.confidence < 0.01
    assert "too little in common" in unlike.sentence
    assert (sure.likeness, unlike.likeness, by_index(ball, ball).likeness) == (25.0, 10.0, None)


def test_the_worst_is_said_first(symmetric):
    body, other = symmetric
    turned = assessed(body, body, at(body, other), at(body, other), 0.1)
    assert "do not trust it" in turned.sentence
    point = at(body, np.zeros(body.vertex_count, int))
    reached = assessed(body, body, at(body), point, 0.1)
    assert "almost as likely" in reached.sentence
    unlike = assessed(body, body, at(body), point, 0.1, likeness=5.0)
    assert "too little in common" in unlike.sentence


@pytest.mark.parametrize("slide", [0.0, 0.01, 0.02, 0.04])
def test_confidence_falls_with_the_distance_from_home(slide, square):
    """It is halved where there and back lead two hundredths of the surface's size away."""
    back = nearest_on(square, np.minimum(square.vertices + np.array([slide, 0, 0]), 1))
    confidence = judged_map(square, square, at(square), back).confidence
    inner = ((square.vertices > 0.15) & (square.vertices < 0.85))[:, :2].all(axis=1)
    np.testing.assert_allclose(confidence[inner], 1 / (1 + (slide / 0.02) ** 2), rtol=1e-6)
    assert assessed(square, square, at(square), back, None).disagreement == pytest.approx(slide, rel=0.05, abs=1e-12)


def test_confidence_is_low_where_the_map_is_wrong_only(square):
    wrong = np.linalg.norm(square.vertices - [0.3, 0.7, 0], axis=1) < 0.12
    images = np.where(wrong, 0, np.arange(square.vertex_count))
    confidence = judged_map(square, square, at(square, images), at(square)).confidence
    assert confidence[wrong].max() < 0.5
    far = np.linalg.norm(square.vertices - [0.3, 0.7, 0], axis=1) > 0.3
    np.testing.assert_allclose(confidence[far], 1)
    assert ((confidence >= 0) & (confidence <= 1)).all()


def test_edges_and_faces_without_size_do_no_harm():
    vertices, triangles = icosphere(4)
    vertices = vertices.copy()
    vertices[triangles[::20, 0]] = vertices[triangles[::20, 1]]
    mesh = TriangleMesh(vertices, triangles)
    quality = by_index(mesh, mesh)
    assert quality.orientation > 0.99
    assert quality.distortion == pytest.approx(0, abs=1e-12)
    assert quality.coverage == pytest.approx(1)
    assert np.isfinite(judged_map(mesh, mesh, at(mesh), at(mesh)).confidence).all()


def test_what_is_doubted_otherwise_counts_if_it_is_more(ball):
    doubt = np.where(ball.vertices[:, 2] > 0, 0.02, 0.0)  # the length at which confidence is a half
    confidence = judged_map(ball, ball, at(ball), at(ball), doubt=doubt).confidence
    far = np.abs(ball.vertices[:, 2]) > 0.5
    np.testing.assert_allclose(confidence[far], np.where(doubt, 0.5, 1)[far])
    quality = assessed(ball, ball, at(ball), at(ball), None, doubt=doubt)
    assert quality.disagreement == pytest.approx(0.01, rel=0.1)
    assert quality.confidence == pytest.approx(0.75, abs=0.03)
    there = at(ball, np.roll(np.arange(ball.vertex_count), 1))
    for doubt in (0.0, 1e-9):
        assert assessed(ball, ball, there, at(ball), None, doubt=doubt).disagreement == pytest.approx(
            assessed(ball, ball, there, at(ball), None).disagreement
        )


def test_what_the_target_lacks_is_told(square):
    """A whole square and half of one: both ways are said, and nothing is trusted where something is missing."""
    half = cut_square(square)
    there, back = nearest_on(half, square.vertices), nearest_on(square, half.vertices)
    known = with_partner(square, half, there, back)
    confidence = judged_map(square, half, there, back).confidence
    assert (confidence[~known] == 0).all()
    assert confidence[known].min() > 0
    quality = assessed(square, half, there, back, None)
    assert quality.source_coverage == pytest.approx(0.5 + 2 / 21, abs=0.06)  # up to two spacings
    assert quality.coverage == 1
    assert f"Only {quality.source_coverage:.0%} of the source has a partner" in quality.sentence
    turned = assessed(half, square, back, there, None)
    assert (turned.coverage, turned.source_coverage) == (quality.source_coverage, 1)
    assert f"Only {turned.coverage:.0%} of the target is reached" in turned.sentence


def test_so_is_a_small_part():
    """What is left does not vanish where it is said."""
    ball = TriangleMesh(*icosphere(16))
    rest, depth = without_cap(ball, 0.03)
    there, back = nearest_on(rest, ball.vertices), nearest_on(ball, rest.vertices)
    quality = assessed(ball, rest, there, back, None)
    assert 0.98 < quality.source_coverage < 0.995
    assert f"a small part of the source ({1 - quality.source_coverage:.1%})" in quality.sentence
    assert judged_map(ball, rest, there, back).confidence[depth.argmax()] == 0


def test_pieces_without_a_counterpart_are_mentioned_if_they_are_not_few(ball):
    quality = by_index(ball, ball)
    few, many = (with_pieces(quality, share, 1.0) for share in (0.01, 0.12))
    assert few.sentence == quality.sentence
    assert many.sentence.startswith("Separate pieces, 12% of a mesh, have no counterpart on the other")
    assert (few.pieces_alone, many.pieces_alone) == (0.01, 0.12)
    doubtful = with_pieces(by_index(ball, ball, 0.2), 0.12, 1.0)
    assert doubtful.sentence.startswith("Another map was almost as likely")


def test_pieces_that_are_less_to_be_trusted_than_the_main_part_count_as_well(ball):
    quality = by_index(ball, ball, 2.0)
    less = with_pieces(quality, 0.0, 0.6)
    assert less.confidence == pytest.approx(0.6 * quality.confidence)
    assert with_pieces(quality, 0.0, 5.0).confidence <= 1


@pytest.mark.parametrize("shares", [(1, 0.5), (0.5, 0.6), (0.96, 0.7), (1, 0.99)])
def test_of_exchanged_shapes_the_other_one_is_said_to_lack_something(shares):
    said, other = (overlap_sentence(given, credible=True) for given in (shares, shares[::-1]))
    assert said != other
    assert exchanged_sentence(said, shares[::-1]) == other
    assert exchanged_sentence(other, shares) == said


def test_what_is_said_of_both_shapes_stays(ball):
    for said in (by_index(ball, ball).sentence, overlap_sentence((0.5, 0.6), credible=False)):
        assert exchanged_sentence(said, (0.6, 0.5)) == said
