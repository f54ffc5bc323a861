# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps that were made with only a piece of a mesh, and which piece an earlier map knows a partner of."""

import numpy as np
import pytest

from engine import DenseMatch, SurfaceMap, SurfacePoints, TriangleMesh
from engine.dense.components.masked_maps import piece_of, with_pieces_only
from engine.dense.quality import MatchQuality
from tests.shapes import icosphere

NONE = np.empty(0, np.int64)


@pytest.fixture
def ball():
    return TriangleMesh(*icosphere(6))


@pytest.fixture
def upper(ball):
    return ball.vertices[:, 2] > 0


def identity(mesh, confidence):
    points = SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count))
    return SurfaceMap(points, np.broadcast_to(confidence, mesh.vertex_count).astype(float), mesh.vertex_count)


def test_what_has_no_confidence_has_no_partner(ball, upper):
    np.testing.assert_array_equal(piece_of(ball, identity(ball, upper), NONE), upper)


def test_nothing_is_left_out_where_little_is_missing_or_nothing_is_known(ball):
    assert piece_of(ball, None, NONE) is None
    assert piece_of(ball, identity(ball, ball.vertices[:, 2] > -0.95), NONE) is None


def test_landmarks_speak_against_what_a_map_says(ball, upper):
    below, above = int(ball.vertices[:, 2].argmin()), int(ball.vertices[:, 2].argmax())
    assert piece_of(ball, identity(ball, upper), np.array([above, below])) is None
    assert piece_of(ball, identity(ball, upper), np.array([above])) is not None
    # A vertex that does not exist is refused elsewhere, in words.
    assert piece_of(ball, identity(ball, upper), np.array([above, 10**6, -1])) is not None


def test_a_landmark_that_would_be_cut_off_from_most_speaks_against_it_too(ball):
    heights = ball.vertices[:, 2]
    known = identity(ball, (heights < 0) | (heights > 0.8))
    assert piece_of(ball, known, np.array([int(heights.argmax())])) is None
    assert piece_of(ball, known, np.array([int(heights.argmin())])) is not None


@pytest.mark.parametrize("of_source", [True, False])
def test_what_was_left_out_is_said_to_be_without_a_partner(of_source, ball, upper):
    quality = MatchQuality(1.0, 0.1, 0.9, 0.001, None, 0.8, "", 0.8)
    maps = DenseMatch(identity(ball, 0.5), identity(ball, 0.5), quality)
    found = with_pieces_only(maps, (ball, ball), (upper, None) if of_source else (None, upper))
    changed, other = found.source_to_target, found.target_to_source
    changed, other = (changed, other) if of_source else (other, changed)
    np.testing.assert_array_equal(changed.confidence, 0.5 * upper)
    assert (other.confidence == 0.5).all()
    share = ball.vertex_areas[upper].sum() / ball.area
    assert found.quality.source_coverage == pytest.approx(0.8 * (share if of_source else 1))
    assert found.quality.coverage == pytest.approx(0.9 * (1 if of_source else share))
    assert ("of the source has a partner" if of_source else "of the target is reached") in found.quality.sentence
    assert with_pieces_only(maps, (ball, ball), (None, None)) is maps
