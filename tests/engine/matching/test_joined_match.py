# SPDX-License-Identifier: GPL-3.0-or-later
"""Matches of bodies that were put together from pieces."""

from types import SimpleNamespace

import numpy as np
import pytest

from engine import MatchError, MatchSettings, Shape, TriangleMesh, densify, match
from engine.matching.joined_match import _is_better, matched_with_pieces_steps
from engine.matching.refinement import point_distortions, refine_map
from engine.matching.shape_matching import MatchTask
from engine.mesh.surface_points import SurfacePoints
from engine.repair.cleaning import clean
from engine.runtime.progress import run
from tests.limbs import modular_creature
from tests.messes import together
from tests.shapes import creature, cylinder, icosphere

QUICK = MatchSettings(points=12, samples=100, hypotheses=2)


@pytest.fixture(scope="module")
def whole():
    vertices, triangles, rest = creature(0.0, 10)
    return TriangleMesh(vertices, triangles), rest


@pytest.fixture(scope="module")
def modular():
    return modular_creature(0.8, turn=0.7)


@pytest.fixture(scope="module")
def result(whole, modular):
    return match(whole[0], modular.mesh, QUICK)


def errors(found, rest, image_rest):
    """Distance at rest of each vertex from its image, over the length of the body."""
    images = np.einsum("kc,kcd->kd", found.barycentric, image_rest[found.corners])
    return np.linalg.norm(images - rest, axis=1) / 2.4


def check(result, source_rest, target_rest):
    there = errors(result.source_to_target, source_rest, target_rest)
    back = errors(result.target_to_source, target_rest, source_rest)
    assert max(there.mean(), back.mean()) < 0.02
    assert max(there.max(), back.max()) < 0.2


def test_a_whole_body_is_matched_with_one_in_pieces(result, whole, modular):
    check(result, whole[1], modular.rest)
    assert result.quality.confidence > 0.7
    assert result.quality.coverage == 1
    assert result.quality.source_coverage == 1
    assert result.quality.pieces_alone == 0
    assert any("one surface around all of them was matched" in note for note in result.notes)
    limbs = modular.pieces > 0
    assert np.median(result.target_to_source.confidence[limbs]) > 0.7


def test_matched_points_lie_on_all_pieces(result, modular):
    assert len(np.unique(modular.pieces[result.target_points.nearest_vertices])) > 3
    assert np.isfinite(result.distortion)


def test_the_way_back_works_as_well(whole, modular):
    check(match(modular.mesh, whole[0], QUICK), modular.rest, whole[1])


def test_bodies_that_are_cut_alike_are_matched_piece_by_piece(modular):
    other = modular_creature(0.0)
    result = match(other.mesh, modular.mesh, QUICK)
    check(result, other.rest, modular.rest)
    assert not any("one surface around all" in note for note in result.notes)
    pieces = modular.pieces[result.source_to_target.nearest_vertices]
    shares = np.histogram2d(other.pieces, pieces, bins=7)[0] / np.bincount(other.pieces)[:, None]
    assert np.sort(shares, axis=1)[:, -1].min() > 0.98
    assert len(np.unique(shares.argmax(axis=1))) == 7


@pytest.mark.parametrize("cuts", [(0.75, 0.3, 0.6), (0.45, 0.4, 0.75)])
def test_bodies_that_are_cut_elsewhere_are_matched(modular, cuts):
    other = modular_creature(0.0, cuts=cuts)
    result = match(other.mesh, modular.mesh, QUICK)
    check(result, other.rest, modular.rest)


def test_landmarks_on_limbs_are_exact(whole, modular):
    paw = int(np.linalg.norm(whole[1] - [0.45, 0.2, -1.03], axis=1).argmin())
    target = int(np.linalg.norm(modular.rest - [0.45, 0.2, -1.03], axis=1).argmin())
    assert modular.pieces[target] > 0
    result = match(whole[0], modular.mesh, QUICK, landmarks=[(paw, target)])
    check(result, whole[1], modular.rest)
    assert result.target_points.nearest_vertices[0] == target
    assert result.source_to_target.nearest_vertices[paw] == target
    assert result.target_to_source.nearest_vertices[target] == paw


def test_wrong_landmarks_are_refused_in_words(whole, modular):
    with pytest.raises(MatchError, match="which has no such vertex"):
        match(whole[0], modular.mesh, QUICK, landmarks=[(0, 10**6)])


def test_of_landmarks_on_pieces_that_is_named_which_is_on_none_of_the_body(whole, modular):
    paw = int(np.linalg.norm(whole[1] - [0.45, 0.2, -1.03], axis=1).argmin())
    target = int(np.linalg.norm(modular.rest - [0.45, 0.2, -1.03], axis=1).argmin())
    body = modular.mesh.vertices, modular.mesh.triangles
    ball, faces = icosphere(1)
    mesh = TriangleMesh(*together(body, (0.02 * ball + [5.0, 5.0, 5.0], faces)))
    stray = mesh.vertex_count - 1
    with pytest.raises(MatchError, match=f"Landmark 2 is at vertex {stray} of the target"):
        match(whole[0], mesh, QUICK, landmarks=[(paw, target), (0, stray)])


def test_points_and_maps_of_joined_bodies_are_understood(result, whole, modular):
    """What a match gave can be extended, measured and refined, though much of it is not on the main piece."""
    meshes = whole[0], modular.mesh
    source, target = result.source_to_target, result.target_to_source
    vertices = np.linspace(0, whole[0].vertex_count - 1, 40).astype(int)
    points = SurfacePoints.at_vertices(whole[0], vertices)
    images = SurfacePoints.from_barycentric(modular.mesh, source.triangles[vertices], source.barycentric[vertices])
    again = densify(*meshes, points, images, maps=(source, target))
    check(again, whole[1], modular.rest)
    assert np.median(point_distortions(*meshes, vertices, images.nearest_vertices)) < 0.1
    tail = int(whole[1][:, 0].argmin())
    end = int(modular.rest[:, 0].argmin())
    refined = refine_map(*meshes, source, [(tail, end)], target_to_source=target)
    check(refined, whole[1], modular.rest)
    assert refined.source_to_target.nearest_vertices[tail] == end
    on_trunk = int(np.linalg.norm(whole[1], axis=1).argmin())
    its = int(np.where(modular.pieces == 0, np.linalg.norm(modular.rest - whole[1][on_trunk], axis=1), 9).argmin())
    check(refine_map(*meshes, source, [(on_trunk, its)], target_to_source=target), whole[1], modular.rest)


def test_what_cannot_be_joined_is_refused_as_before(whole):
    """Pieces each of which has too few vertices, and that have no inside together."""
    vertices, triangles = cylinder(3, 1, radius=0.2, height=0.5)
    apart = TriangleMesh(*together(*((vertices + np.array([2.0 * i, 0, 0]), triangles) for i in range(3))))
    with pytest.raises(MatchError, match="points cannot be matched"):
        match(whole[0], apart, MatchSettings(points=20, samples=100, hypotheses=2))


def test_what_a_body_stands_beside_stays_a_piece(whole):
    """A ball that touches the back is large, but the body is all there without it."""
    vertices, triangles, rest = creature(0.8, 10, turn=0.7)
    ball, faces = icosphere(6)
    target = TriangleMesh(*together((vertices, triangles), (0.4 * ball + [0.0, 0.0, 0.72], faces)))
    assert clean(target).limbs.any()
    result = match(whole[0], target, QUICK)
    assert not any("one surface around all" in note for note in result.notes)
    its_rest = np.concatenate([rest, np.full((len(ball), 3), np.nan)])
    found = errors(result.target_to_source, its_rest, whole[1])[: len(rest)]
    assert found.mean() < 0.02
    assert result.quality.pieces_alone > 0.2


def test_bodies_in_one_piece_are_matched_as_they_are(whole):
    shape = Shape(whole[0])
    result, x, y = run(matched_with_pieces_steps(shape, shape, MatchTask(QUICK, None)))
    assert x is shape
    assert y is shape
    assert result.distortion == pytest.approx(0, abs=1e-5)


@pytest.mark.parametrize(("pairs", "fault"), [([[0, 10**9]], "no such vertex"), ([[3, 5], [3, 6]], "both at vertex 3")])
def test_wrong_landmarks_are_said_before_anything_is_matched(pairs, fault, whole, modular, monkeypatch):
    monkeypatch.setattr("engine.matching.joined_match.matched_steps", None)
    shapes = Shape(whole[0]), Shape(modular.mesh)
    with pytest.raises(MatchError, match=fault):
        run(matched_with_pieces_steps(*shapes, MatchTask(QUICK, pairs)))


def judged(likeness, coverage=1.0, alone=0.0):
    """A match of which no more than that is known."""
    known = {"likeness": likeness, "in_place": 0.0, "coverage": coverage, "source_coverage": 1.0, "pieces_alone": alone}
    return SimpleNamespace(dense=SimpleNamespace(quality=SimpleNamespace(**known)))


@pytest.mark.parametrize(
    ("joined", "pieces", "together", "better"),
    [
        (judged(20.0, 0.5), judged(5.0), 1.0, True),  # right rather than not, and the other is not
        (judged(20.0), judged(25.0), 0.9, True),  # more of the bodies goes together
        (judged(20.0), judged(15.0), 0.99, False),  # hardly more does
        (judged(20.0, 0.8), judged(25.0), 0.9, False),  # less has a partner
        (judged(20.0, alone=0.2), judged(25.0), 0.9, False),  # pieces have none
        (judged(8.0), judged(5.0), 0.5, True),  # both are wrong rather than not: the more likely one
        (judged(5.0), judged(8.0), 0.5, False),
        (judged(None), judged(None), 0.5, True),  # landmarks say that both are right
    ],
)
def test_joined_bodies_are_preferred_if_more_of_them_goes_together_or_pieces_are_wrong(
    joined, pieces, together, better
):
    assert _is_better(joined, pieces, together) == better
