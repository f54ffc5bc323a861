# SPDX-License-Identifier: GPL-3.0-or-later
"""Two bodies of each of which something was cut off: what they share, and what is said where that is unclear."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import MatchSettings, TriangleMesh, match
from engine.matching.overlap.overlap_maps import Overlap, overlap_steps
from engine.matching.overlap.overlap_match import CLEAR, credibility, overlap_match_steps
from engine.matching.shape_matching import MatchTask
from engine.mesh.surface_points import SurfacePoints
from engine.runtime.progress import run
from engine.shapes.shape import Shape
from tests.shapes import compacted, creature

QUICK = MatchSettings(points=12, samples=100, hypotheses=2)
FRONT, BACK = -0.45, 0.62
"""Where, along the body at rest, the one is cut off behind, and the other in front."""


def cut(vertices, triangles, rest, kept):
    both, faces = compacted(np.hstack([vertices, rest]), triangles[kept(rest[triangles][:, :, 0])])
    return TriangleMesh(both[:, :3], faces), both[:, 3:]


@pytest.fixture(scope="module")
def front():
    return cut(*creature(0.0, 9), lambda x: x.min(axis=1) > FRONT)


@pytest.fixture(scope="module")
def back():
    return cut(*creature(0.5, 9, turn=0.7), lambda x: x.max(axis=1) < BACK)


@pytest.fixture(scope="module")
def result(front, back):
    return match(front[0], back[0], QUICK)


def errors(found, rest, image_rest):
    """Distance at rest of each vertex from its image, over the length of the body."""
    images = np.einsum("kc,kcd->kd", found.barycentric, image_rest[found.corners])
    return np.linalg.norm(images - rest, axis=1) / 2.4


def test_what_both_show_is_matched_both_ways(result, front, back):
    for found, own, other in (
        (result.source_to_target, front, back),
        (result.target_to_source, back, front),
    ):
        both = (own[1][:, 0] > FRONT + 0.1) & (own[1][:, 0] < BACK - 0.1)
        assert found.has_partner[both].mean() > 0.9
        assert errors(found, own[1], other[1])[both].mean() < 0.03


def test_what_only_one_shows_has_no_partner_and_no_confidence(result, front, back):
    lacking = front[1][:, 0] > BACK + 0.1, back[1][:, 0] < FRONT - 0.1
    for found, alone in zip((result.source_to_target, result.target_to_source), lacking, strict=True):
        assert (~found.has_partner[alone]).mean() > 0.95
        assert (found.confidence[~found.has_partner] == 0).all()


def test_the_shares_are_said(result, front, back):
    quality = result.quality
    source = front[0].vertex_areas @ (front[1][:, 0] < BACK) / front[0].area
    target = back[0].vertex_areas @ (back[1][:, 0] > FRONT) / back[0].area
    assert quality.source_coverage == pytest.approx(source, abs=0.12)
    assert quality.coverage == pytest.approx(target, abs=0.12)
    assert f"{quality.source_coverage:.0%} of the source" in quality.sentence
    assert f"{quality.coverage:.0%} of the target" in quality.sentence
    assert quality.confidence > CLEAR


def test_the_unit_of_either_does_not_matter(result, front, back):
    millimetres = TriangleMesh(1000 * back[0].vertices, back[0].triangles)
    other = match(front[0], millimetres, QUICK)
    assert other.quality.distortion < 2 * result.quality.distortion
    assert other.point_distortion.mean() < 2 * result.point_distortion.mean()
    assert other.distortion < 5 * result.distortion


def test_points_lie_on_what_is_shared(result):
    vertices = result.source_points.nearest_vertices
    assert len(np.unique(vertices)) == 12
    assert result.source_to_target.has_partner[vertices].all()
    np.testing.assert_allclose(result.target_points.positions, result.source_to_target.positions[vertices])
    assert len(result.coarse.source_vertices) == QUICK.coarse_points


def overlap(**changes):
    nothing = (np.empty(0), np.empty(0))
    clear = {"score": 4.0, "margin": 5.0, "agreement": 0.95, "area": 0.5}
    return Overlap(nothing, nothing, nothing, **(clear | changes), search=None)


@pytest.mark.parametrize("doubtful", [{"score": -0.1}, {"margin": 0.3}, {"agreement": 0.3}, {"area": 0.04}])
def test_one_reason_to_doubt_is_enough(doubtful):
    assert credibility(overlap()) > 0.95
    assert credibility(overlap(**doubtful)) < 0.1


def test_it_does_not_matter_which_surface_is_which(front, back):
    here = run(overlap_steps(front[0], back[0]))
    there = run(overlap_steps(back[0], front[0]))
    assert there.score == pytest.approx(here.score, abs=1e-6)
    assert there.margin == pytest.approx(here.margin, abs=1e-6)
    for own, other in zip(here.members, there.members[::-1], strict=True):
        assert (own == other).mean() > 0.995


@pytest.fixture(scope="module")
def known(front, back):
    x, y = Shape(front[0]), Shape(back[0])
    return x, y, run(overlap_match_steps(x, y, MatchTask(QUICK, None)))


def claiming(result, confidence):
    """A match that says so much of itself."""
    return replace(result, quality=replace(result.quality, confidence=confidence))


def turned_round(found, mesh):
    """Where a map leads after half a turn of the surface that it leads to."""
    middle = mesh.vertices.mean(axis=0)
    opposite = middle + (found.positions - middle) * [-1, -1, 1]
    nearest = cKDTree(mesh.vertices).query(opposite)[1]
    return replace(found, points=SurfacePoints.at_vertices(mesh, nearest))


def test_a_right_map_of_all_is_hardly_doubted(known):
    x, y, overlap = known
    doubted = overlap.doubted(claiming(overlap.result, 0.9), x, y)
    assert 0.8 < doubted.quality.confidence < 0.9
    assert doubted.quality.sentence == overlap.result.quality.sentence


def test_a_wrong_map_of_all_is_doubted_and_that_is_said(known):
    x, y, overlap = known
    result = claiming(overlap.result, 0.9)
    wrong = replace(
        result,
        source_to_target=turned_round(result.source_to_target, y.original),
        target_to_source=turned_round(result.target_to_source, x.original),
    )
    doubted = overlap.doubted(wrong, x, y)
    assert doubted.quality.confidence < CLEAR
    assert "not clear what the shapes share" in doubted.quality.sentence
    assert doubted.source_to_target.confidence.max() < CLEAR
    assert (doubted.source_to_target.positions == wrong.source_to_target.positions).all()
