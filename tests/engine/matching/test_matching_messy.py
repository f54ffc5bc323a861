# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole matches of meshes that are broken as real ones are: a small error against the truth, or an error in words."""

from dataclasses import replace

import numpy as np
import pytest

from engine import HierMatchError, MatchError, MatchSettings, MeshError, Shape, TriangleMesh, match
from tests.bodies import mirrored_body
from tests.messes import (
    cut_along_seam,
    halves_apart,
    in_pieces,
    partly_turned,
    together,
    with_fin,
    without_disc,
    without_faces,
)
from tests.shapes import creature, icosphere, irregular, posed, rotation

QUICK = MatchSettings(points=12, samples=100, hypotheses=2)
UNKNOWN = np.full(3, np.nan)


@pytest.fixture(scope="module")
def bodies():
    """A body at rest and, in another meshing, bent: vertices, triangles and rest positions of both."""
    return creature(0.0, 9), creature(0.8, 9, turn=0.7)


# Each mess takes and returns vertices, triangles and rest positions, those of what has no truth unknown.


def clean(vertices, triangles, rest):
    return vertices, triangles, rest


def seam(vertices, triangles, rest):
    cut, faces = cut_along_seam(vertices, triangles)
    return cut, faces, with_copies(rest, triangles, faces)


def halves(vertices, triangles, rest):
    cut, faces = halves_apart(vertices, triangles, 0.02)
    return cut, faces, with_copies(rest, triangles, faces)


def with_copies(rest, triangles, faces):
    """Rest positions of the corners that got a copy as well."""
    beyond = faces >= len(rest)
    copies = np.empty((faces.max() + 1 - len(rest), 3))
    copies[faces[beyond] - len(rest)] = rest[triangles[beyond]]
    return np.concatenate([rest, copies])


def pieces(vertices, triangles, rest):
    return *in_pieces(vertices, triangles), rest[triangles].reshape(-1, 3)


def fin(vertices, triangles, rest):
    grown, faces = with_fin(vertices, triangles, first=50)
    return grown, faces, np.concatenate([rest, np.tile(UNKNOWN, (len(grown) - len(rest), 1))])


def holes(vertices, triangles, rest):
    for middle in (10, 200, 400):
        triangles = without_disc(vertices, triangles, vertices[middle], 0.12)[1]
    return vertices, triangles, rest


def shreds(vertices, triangles, rest):
    """Without a quarter of the faces, here and there."""
    return *without_faces(vertices, triangles, 0.25, seed=3), rest


def open_back(vertices, triangles, rest):
    """Without the upper side of the trunk: one wide opening."""
    middles = rest[triangles].mean(axis=1)
    return vertices, triangles[(middles[:, 2] < 0.12) | (abs(middles[:, 0]) > 0.45)], rest


def leg_cut_off(vertices, triangles, rest):
    middles = rest[triangles].mean(axis=1)
    return vertices, triangles[~((middles[:, 2] < -0.55) & (middles[:, 0] > 0) & (middles[:, 1] > 0))], rest


def repeated_faces(vertices, triangles, rest):
    return vertices, np.concatenate([triangles, triangles[::7], triangles[::11, ::-1]]), rest


def collapsed_faces(vertices, triangles, rest):
    """With edges of no length, and so triangles of no area."""
    vertices, rest = vertices.copy(), rest.copy()
    for first, second, _ in triangles[::40]:
        vertices[first], rest[first] = vertices[second], rest[second]
    return vertices, triangles, rest


def needles(vertices, triangles, rest):
    return *irregular(vertices, triangles, rounds=2), irregular(rest, triangles, rounds=2)[0]


def inward(vertices, triangles, rest):
    return vertices, triangles[:, ::-1], rest


def inconsistent(vertices, triangles, rest):
    return *partly_turned(vertices, triangles), rest


def stretched(vertices, triangles, rest):
    """Under an object scale that was not applied."""
    return vertices * [1, 1, 1.3], triangles, rest


def loose_vertices(vertices, triangles, rest):
    added = [vertices, vertices[::50] * 1.01, [[50, 50, 50]]]
    return np.concatenate(added), triangles, np.concatenate([rest, rest[::50], [UNKNOWN]])


def several_parts(vertices, triangles, rest):
    """With an eye and a button that touch the body, the first in front of all its vertices."""
    normals = TriangleMesh(vertices, triangles).vertex_normals
    ball = icosphere(2, 0.06)
    near = [np.linalg.norm(rest - place, axis=1).argmin() for place in ([1.0, 0.15, 0.5], [-0.3, 0.25, 0.1])]
    balls = [(ball[0] + vertices[v] + 0.05 * normals[v], ball[1]) for v in near]
    known = [np.repeat(rest[v : v + 1], len(ball[0]), axis=0) for v in near]
    return *together(balls[0], (vertices, triangles), balls[1]), np.concatenate([known[0], rest, known[1]])


def assert_valid(found, domain, image):
    assert len(found) == domain.vertex_count
    assert found.image_vertex_count == image.vertex_count
    assert found.barycentric.min() >= 0
    np.testing.assert_allclose(found.barycentric.sum(axis=1), 1)
    np.testing.assert_array_equal(found.corners, image.triangles[found.triangles])
    assert np.isfinite(found.positions).all()
    assert ((found.confidence >= 0) & (found.confidence <= 1)).all()


def assert_finite(result):
    for points in (result.source_points, result.target_points):
        assert np.isfinite(points.positions).all()
        assert points.barycentric.min() >= 0
    assert np.isfinite([result.distortion, result.orientation]).all()
    quality = result.quality
    assert np.isfinite([quality.orientation, quality.distortion, quality.coverage, quality.disagreement]).all()
    assert 0 <= quality.confidence <= 1
    assert quality.sentence


def errors(found, own, other, mesh):
    """Distances at rest over the square root of the area, where the truth is known."""
    gaps = np.linalg.norm(own - found.transfer(other), axis=1) / np.sqrt(mesh.area)
    return gaps[np.isfinite(gaps)]


@pytest.mark.parametrize(
    ("first", "second", "bounds", "noted"),
    [
        (loose_vertices, seam, (0.013, 0.1), "duplicate vertices along open seams"),
        (halves, clean, (0.014, 0.1), "at gaps between pieces"),
        (clean, halves, (0.014, 0.1), "at gaps between pieces"),
        (pieces, collapsed_faces, (0.014, 0.1), "duplicate vertices"),
        (repeated_faces, fin, (0.013, 0.1), "non-manifold edge"),
        (needles, inward, (0.013, 0.1), "normals of the target point inwards"),
        (inconsistent, needles, (0.013, 0.1), "normals against their neighbours"),
        (holes, clean, (0.014, 0.1), "small holes"),
        (clean, holes, (0.014, 0.15), "small holes"),
        (shreds, clean, (0.014, 0.1), "small holes"),
        (clean, shreds, (0.016, 0.15), "small holes"),
        (clean, open_back, (0.03, 0.3), "large opening"),
        (leg_cut_off, clean, (0.025, 0.25), "large opening"),
        (clean, leg_cut_off, (0.025, 0.3), "large opening"),
        (stretched, clean, (0.03, 0.2), None),
    ],
)
def test_a_broken_mesh_is_matched_nearly_as_the_whole_one(first, second, bounds, noted, bodies):
    (vertices_x, triangles_x, rest_x), (vertices_y, triangles_y, rest_y) = first(*bodies[0]), second(*bodies[1])
    source, target = TriangleMesh(vertices_x, triangles_x), TriangleMesh(vertices_y, triangles_y)
    result = match(source, target, QUICK)
    assert_valid(result.source_to_target, source, target)
    assert_valid(result.target_to_source, target, source)
    assert_finite(result)
    for found, own, other, mesh in (
        (result.source_to_target, rest_x, rest_y, source),
        (result.target_to_source, rest_y, rest_x, target),
    ):
        gaps = errors(found, own, other, mesh)
        assert gaps.mean() < bounds[0]
        assert gaps.max() < bounds[1]
    assert result.quality.orientation > 0.95
    assert result.quality.confidence > 0.75
    if noted is None:
        assert not result.notes
    else:
        assert any(noted in note for note in result.notes)


def test_small_parts_find_each_other(bodies):
    """Eyes go to eyes, not to the skin beneath them."""
    (vertices_x, triangles_x, rest_x), (vertices_y, triangles_y, rest_y) = (several_parts(*body) for body in bodies)
    source, target = TriangleMesh(vertices_x, triangles_x), TriangleMesh(vertices_y, triangles_y)
    result = match(source, target, QUICK)
    assert_valid(result.source_to_target, source, target)
    assert_valid(result.target_to_source, target, source)
    assert errors(result.source_to_target, rest_x, rest_y, source).mean() < 0.016
    assert errors(result.target_to_source, rest_y, rest_x, target).mean() < 0.016
    assert sum("has 2 smaller parts" in note for note in result.notes) == 2
    count = len(icosphere(2)[0])
    assert result.source_to_target.corners[:count].max() < count
    assert result.source_to_target.corners[-count:].min() >= target.vertex_count - count
    assert result.target_to_source.corners[:count].max() < count
    main = result.source_to_target.corners[count:-count]
    assert main.min() >= count
    assert main.max() < target.vertex_count - count


def arm(bend, pose):
    """Two pieces, one on top of the other, that grow out of the back and are bent where they touch."""
    ball, faces = icosphere(6)
    lower, upper = ball * [0.13, 0.08, 0.3] + [0, 0, 0.28], ball * [0.1, 0.06, 0.26] + [0, 0, 0.24]
    upper = upper @ rotation([0, 1, 0], bend).T + [0, 0, 0.55]
    return tuple((posed(np.add(piece, [0, 0, 0.1]), pose), faces) for piece in (lower, upper))


def test_pieces_that_hang_on_pieces_are_matched_as_well(bodies):
    (vertices, triangles, _), (there, there_triangles, _) = bodies
    source = together((vertices, triangles), *arm(0.2, 0.0))
    target = together((there, there_triangles), *arm(1.1, 0.8)[::-1])
    result = match(TriangleMesh(*source), TriangleMesh(*target), QUICK)
    upper, lower = np.split(target[0][len(there) :], 2)
    found = result.source_to_target.points.positions[len(vertices) :]
    assert np.linalg.norm(found - np.concatenate([lower, upper]), axis=1).mean() < 0.03
    assert result.quality.pieces_alone == 0


def test_pieces_without_a_counterpart_are_told(bodies):
    (vertices, triangles, _), (there, there_triangles, _) = bodies
    source = TriangleMesh(*together((vertices, triangles), *arm(0.2, 0.0)))
    for x, y in ((source, TriangleMesh(there, there_triangles)), (TriangleMesh(there, there_triangles), source)):
        quality = match(x, y, QUICK).quality
        assert quality.pieces_alone > 0.03
        assert quality.sentence.startswith("Separate pieces")


@pytest.mark.parametrize("turned", [False, True])
def test_a_mirrored_copy_is_matched_by_its_sides(turned):
    """What was the left leg is the right one of an object of negative scale, whose normals may be turned or not."""
    vertices_x, triangles_x, rest_x = mirrored_body(0.0, 9)
    vertices_y, triangles_y, rest_y = mirrored_body(0.8, 9, seed=1)
    flip = np.array([1, -1, 1])
    source = TriangleMesh(vertices_x, triangles_x)
    target = TriangleMesh(vertices_y * flip, triangles_y[:, ::-1] if turned else triangles_y)
    result = match(source, target, QUICK)
    assert_valid(result.source_to_target, source, target)
    assert_valid(result.target_to_source, target, source)
    for found, own, other, mesh in (
        (result.source_to_target, rest_x, rest_y * flip, source),
        (result.target_to_source, rest_y * flip, rest_x, target),
    ):
        gaps = errors(found, own, other, mesh)
        assert gaps.mean() < 0.01
        assert gaps.max() < 0.08
    assert result.quality.orientation > 0.95
    assert any("point inwards" in note for note in result.notes) != turned


def test_ten_times_as_many_vertices_are_matched(bodies):
    source, rest_x = TriangleMesh(*bodies[0][:2]), bodies[0][2]
    vertices, triangles, rest_y = creature(0.8, 28, turn=0.7)
    target = TriangleMesh(vertices, triangles)
    assert target.vertex_count > 10 * source.vertex_count
    result = match(source, Shape(target, "target", proxy_vertices=900), QUICK)
    assert_valid(result.source_to_target, source, target)
    assert_valid(result.target_to_source, target, source)
    for found, own, other, mesh in (
        (result.source_to_target, rest_x, rest_y, source),
        (result.target_to_source, rest_y, rest_x, target),
    ):
        gaps = errors(found, own, other, mesh)
        assert gaps.mean() < 0.012
        assert gaps.max() < 0.08
    # Vertices of the fine mesh go to different points of the same triangle, not all to a corner.
    assert (result.target_to_source.barycentric.max(axis=1) < 0.99).mean() > 0.8


def test_shapes_that_have_nothing_in_common_are_matched_without_confidence(bodies):
    source, target = TriangleMesh(*icosphere(6)), TriangleMesh(*bodies[1][:2])
    result = match(source, target, QUICK)
    assert_valid(result.source_to_target, source, target)
    assert_valid(result.target_to_source, target, source)
    assert_finite(result)
    assert result.quality.confidence < 0.1
    assert "too little in common" in result.quality.sentence


def test_a_flattened_body_is_no_reason_to_fail(bodies):
    vertices, triangles, _ = bodies[0]
    source, target = TriangleMesh(vertices * [1, 1, 0], triangles), TriangleMesh(*bodies[1][:2])
    result = match(source, target, QUICK)
    assert_valid(result.source_to_target, source, target)
    assert_valid(result.target_to_source, target, source)
    assert_finite(result)


def soup(count=300):
    random = np.random.default_rng(0)
    return random.random((count, 3)), random.permutation(count).reshape(-1, 3)


@pytest.mark.parametrize(
    ("broken", "error", "words"),
    [
        (soup, MatchError, "12 points cannot be matched: the source has only 3 vertices in its main part"),
        (lambda: (icosphere(1)[0], icosphere(1)[1][:3]), MatchError, "Use fewer points or subdivide"),
        (lambda: (icosphere(2)[0] * 0, icosphere(2)[1]), MeshError, "zero area"),
        (lambda: (icosphere(2)[0] * [1, 0, 0], icosphere(2)[1]), MeshError, "zero area"),
        (lambda: (icosphere(2)[0] * np.nan, icosphere(2)[1]), MeshError, "not a finite number"),
        (lambda: (icosphere(2)[0], np.zeros((0, 3), int)), MeshError, "no faces"),
        (lambda: (icosphere(2)[0], icosphere(2)[1][:, [0, 1, 1]]), MeshError, "degenerate"),
        (lambda: (icosphere(2)[0][:20], icosphere(2)[1]), MeshError, "vertices are numbered 0 to 19"),
    ],
)
def test_what_is_no_surface_is_refused_in_words(broken, error, words, bodies):
    target = TriangleMesh(*bodies[1][:2])
    with pytest.raises(error, match=words) as raised:
        match(TriangleMesh(*broken()), target, QUICK)
    assert isinstance(raised.value, HierMatchError)


def test_a_mesh_with_fewer_vertices_than_points_is_matched_with_all_of_them():
    small = TriangleMesh(*icosphere(2))
    assert MatchSettings().coarse_points <= small.vertex_count < MatchSettings().points
    turned = TriangleMesh(small.vertices @ rotation([1, 2, 3], 0.4).T, small.triangles)
    result = match(small, turned, replace(QUICK, points=64))
    assert len(result.source_points.positions) == small.vertex_count
    assert_valid(result.source_to_target, small, turned)
    with pytest.raises(MatchError, match="Use fewer points"):
        match(small, turned, replace(QUICK, points=64, dense=False))
