# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks and vertices to leave out, given to a match: exact, decisive, and gentle to what is around them."""

from dataclasses import replace

import numpy as np
import pytest

from engine import MatchError, MatchSettings, Shape, TriangleMesh, match
from engine.geometry.geodesic_ball import vicinity
from engine.shapes.landmarks import locate_landmarks
from engine.shapes.shape_preparation import finer_shapes
from tests.bodies import mirrored_body
from tests.shapes import icosphere

QUICK = MatchSettings(points=24, samples=128)
SPARSE = replace(QUICK, dense=False)


@pytest.fixture(scope="module")
def bodies():
    """A symmetric body at rest and, in another meshing, bent; and the rest positions of both."""
    vertices_x, triangles_x, rest_x = mirrored_body(0.0, resolution=11, seed=3)
    vertices_y, triangles_y, rest_y = mirrored_body(0.6, resolution=9, seed=1)
    return TriangleMesh(vertices_x, triangles_x), TriangleMesh(vertices_y, triangles_y), rest_x, rest_y


@pytest.fixture(scope="module")
def shapes(bodies):
    return Shape(bodies[0]), Shape(bodies[1])


@pytest.fixture(scope="module")
def plain(shapes):
    return match(*shapes, QUICK)


def partner(bodies, vertex, *, mirror=False):
    """Vertex of the target at the same place at rest, or at its mirror image."""
    place = bodies[2][vertex] * [1, -1 if mirror else 1, 1]
    return int(np.square(bodies[3] - place).sum(axis=1).argmin())


def foot(bodies):
    """Vertex of the source at the end of a leg, on one side."""
    rest = bodies[2]
    return int((rest[:, 1] - rest[:, 2]).argmax())


def rest_error(rest_x, images, *, mirror=False):
    """Mean distance at rest between places and their images."""
    return np.linalg.norm(rest_x * [1, -1 if mirror else 1, 1] - images, axis=1).mean()


def assert_exact(result, pairs):
    """Check that a result takes landmarks exactly to their partners, wherever it has any."""
    source, target = np.transpose(pairs)
    count = len(source)
    coarse = min(count, len(result.coarse.source_vertices))
    np.testing.assert_array_equal(result.coarse.source_vertices[:coarse], source[:coarse])
    np.testing.assert_array_equal(result.coarse.target_vertices[:coarse], target[:coarse])
    np.testing.assert_array_equal(result.source_points.nearest_vertices[:count], source)
    for points in (result.target_points, *(level.target_points for level in result.levels)):
        here = min(count, len(points))
        np.testing.assert_array_equal(points.nearest_vertices[:here], target[:here])
        np.testing.assert_array_equal(points.barycentric[:here].max(axis=1), 1)
    for surface_map, vertices, images in (
        (result.source_to_target, source, target),
        (result.target_to_source, target, source),
    ):
        if surface_map is not None:
            np.testing.assert_array_equal(surface_map.nearest_vertices[vertices], images)
            np.testing.assert_array_equal(surface_map.barycentric[vertices].max(axis=1), 1)
            np.testing.assert_array_equal(surface_map.confidence[vertices], 1)


def folds(surface_map, domain, image, vertex, reach=0.1):
    """Count the triangles around a vertex that a map turns over."""
    near, _ = vicinity(domain, vertex, reach * np.sqrt(domain.area))
    inside = np.isin(domain.triangles, near).all(axis=1)
    return int((surface_map.face_orientations(domain, image)[inside] < 0).sum())


@pytest.mark.parametrize("mirror", [False, True], ids=["true", "mirrored"])
def test_one_landmark_decides_between_the_true_and_the_mirrored_dense_map(mirror, bodies, shapes):
    _, _, rest_x, rest_y = bodies
    pairs = [[foot(bodies), partner(bodies, foot(bodies), mirror=mirror)]]
    result = match(*shapes, QUICK, landmarks=pairs)
    assert_exact(result, pairs)
    assert rest_error(rest_x, result.source_to_target.transfer(rest_y), mirror=mirror) < 0.03
    assert rest_error(rest_y, result.target_to_source.transfer(rest_x), mirror=mirror) < 0.04
    assert rest_error(rest_x, result.source_to_target.transfer(rest_y), mirror=not mirror) > 0.2
    sign = -1 if mirror else 1
    assert sign * result.orientation > 0.5
    assert sign * result.source_to_target.orientation(*bodies[:2]) > 0.9
    assert sign * result.target_to_source.orientation(*bodies[1::-1]) > 0.9
    assert result.quality.orientation > 0.9
    assert result.mirrored is None


def test_landmarks_that_turn_a_body_round_are_followed_against_all_that_fits_better(bodies, shapes):
    _, _, rest_x, rest_y = bodies
    turned = rest_x * [-1, -1, 1]
    directions = [[1, 0, 0], [-1, 0, 0], [1, 1, -1], [1, -1, -1], [-1, 1, -1], [-1, -1, -1]]
    ends = np.argmax(rest_x @ np.transpose(directions), axis=0)
    pairs = [[int(end), int(np.square(rest_y - turned[end]).sum(axis=1).argmin())] for end in ends]
    result = match(*shapes, QUICK, landmarks=pairs)
    assert_exact(result, pairs)
    images = result.source_to_target.transfer(rest_y)
    assert np.linalg.norm(images - turned, axis=1).mean() < 0.25
    assert np.linalg.norm(images - rest_x, axis=1).mean() > 1


@pytest.mark.parametrize(
    ("solver", "mirror"), [("hierarchical", False), ("hierarchical", True), ("flat", True), ("gmds", True)]
)
def test_one_landmark_decides_for_every_solver(solver, mirror, bodies, shapes):
    settings = replace(SPARSE, solver=solver, points=12 if solver == "flat" else 24)
    pairs = [[foot(bodies), partner(bodies, foot(bodies), mirror=mirror)]]
    result = match(*shapes, settings, landmarks=pairs)
    assert_exact(result, pairs)
    here, there = result.source_points.interpolate(bodies[2]), result.target_points.interpolate(bodies[3])
    assert rest_error(here, there, mirror=mirror) < 0.5 * rest_error(here, there, mirror=not mirror)
    assert (result.orientation < 0) == mirror


def test_a_landmark_in_the_middle_leaves_both_answers(bodies, shapes):
    nose = int(bodies[2][:, 0].argmax())
    pairs = [[nose, partner(bodies, nose)]]
    result = match(*shapes, SPARSE, landmarks=pairs)
    assert result.orientation > 0.5
    assert result.mirrored is not None
    assert result.mirrored.orientation < -0.5
    assert_exact(result, pairs)
    assert_exact(result.mirrored, pairs)


@pytest.mark.parametrize("mirror", [False, True], ids=["true", "mirrored"])
def test_more_landmarks_than_coarse_points_are_all_exact(mirror, bodies, shapes):
    vertices = np.random.default_rng(0).choice(len(bodies[2]), 14, replace=False)
    pairs = [[v, partner(bodies, v, mirror=mirror)] for v in vertices]
    result = match(*shapes, QUICK, landmarks=pairs)
    assert_exact(result, pairs)
    assert rest_error(bodies[2], result.source_to_target.transfer(bodies[3]), mirror=mirror) < 0.04
    assert result.source_to_target.orientation(*bodies[:2]) * (-1 if mirror else 1) > 0.9


def test_every_point_may_be_a_landmark_in_whatever_metric(bodies, shapes):
    vertices = np.random.default_rng(1).choice(len(bodies[2]), 8, replace=False)
    pairs = [[v, partner(bodies, v)] for v in vertices]
    settings = MatchSettings(points=8, samples=64, dense=False, metric="diffusion", linear_weight=0.0)
    assert_exact(match(*shapes, settings, landmarks=pairs), pairs)


def moved_landmark(bodies, shapes, plain, place):
    """Match with a landmark near a place at rest, 0.03 from where the plain match has it.

    Returns the result, the pair, and how far rings around it have moved, from there on out.
    """
    source, target = bodies[:2]
    vertex, size = int(np.square(bodies[2] - place).sum(axis=1).argmin()), np.sqrt(target.area)
    before = plain.source_to_target
    near, away = vicinity(target, int(before.nearest_vertices[vertex]), 0.08 * size)
    pair = [vertex, int(near[np.abs(away - 0.03 * size).argmin()])]
    result = match(*shapes, QUICK, landmarks=[pair])
    shift = np.linalg.norm(result.source_to_target.positions - before.positions, axis=1) / size
    around, distances = vicinity(source, vertex, 0.6 * np.sqrt(source.area))
    distances = distances / np.sqrt(source.area)
    rings = [(0, 0.001), (0.001, 0.05), (0.05, 0.12), (0.12, 0.25), (0.25, 0.6)]
    return result, pair, [shift[around[(distances >= low) & (distances < high)]].mean() for low, high in rings]


PLACES = pytest.mark.parametrize("place", [(0.0, 1.0, 0.0), (0.0, 0.0, 1.0)], ids=["flank", "back"])


@PLACES
def test_a_moved_landmark_pulls_its_surroundings_along_smoothly(place, bodies):
    """On surfaces as they are: with more vertices the ends of limbs, far away, turn by more than nearer rings move."""
    shapes = [Shape(mesh, proxy_vertices=mesh.vertex_count) for mesh in bodies[:2]]
    plain = match(*shapes, QUICK)
    result, pair, profile = moved_landmark(bodies, shapes, plain, place)
    assert_moved_without_folds(bodies, result, plain, pair)
    assert profile == sorted(profile, reverse=True)
    assert profile[1] > 0.4 * profile[0]  # a ring that lagged behind more would be on the verge of folding
    assert profile[-1] < 0.15 * profile[0]


@PLACES
def test_a_moved_landmark_pulls_a_surface_along_that_has_more_vertices_where_it_is_registered(
    place, bodies, shapes, plain
):
    assert finer_shapes(*shapes)[0] is not shapes[0]
    result, pair, profile = moved_landmark(bodies, shapes, plain, place)
    assert_moved_without_folds(bodies, result, plain, pair)
    assert profile[:4] == sorted(profile[:4], reverse=True)
    assert profile[1] > 0.4 * profile[0]
    assert profile[-1] < 0.2 * profile[0]


def assert_moved_without_folds(bodies, result, plain, pair):
    source, target = bodies[:2]
    assert_exact(result, [pair])
    assert folds(result.source_to_target, source, target, pair[0]) == 0
    back = result.target_to_source
    assert folds(back, target, source, pair[1]) <= folds(plain.target_to_source, target, source, pair[1]) + 1


def test_landmarks_of_dense_meshes_are_exact_through_their_proxies(bodies):
    source, target, rest_x, rest_y = bodies
    x, y = Shape(source, proxy_vertices=700), Shape(target, proxy_vertices=600)
    assert x.mesh.vertex_count < source.vertex_count / 1.5
    # The second landmark is beside the first: nearer than the vertices of the proxy are to each other.
    first = foot(bodies)
    beside = source.edges[(source.edges == first).any(axis=1)].max()
    others = [int(rest_x[:, 0].argmax()), int(rest_x[:, 0].argmin())]
    vertices = [first, *([beside] if partner(bodies, beside) != partner(bodies, first) else []), *others]
    pairs = [[v, partner(bodies, v)] for v in vertices]
    result = match(x, y, QUICK, landmarks=pairs)
    assert_exact(result, pairs)
    assert rest_error(rest_x, result.source_to_target.transfer(rest_y)) < 0.04
    assert result.source_to_target.flipped_faces(source, target) < 0.02


def test_no_landmarks_are_the_same_as_none(shapes):
    first, second = (match(*shapes, SPARSE, landmarks=given) for given in (None, np.empty((0, 2), int)))
    np.testing.assert_array_equal(first.target_points.triangles, second.target_points.triangles)
    np.testing.assert_array_equal(first.target_points.barycentric, second.target_points.barycentric)


def test_a_match_with_landmarks_leaves_the_shapes_as_they_were(shapes):
    first = match(*shapes, SPARSE)
    match(*shapes, SPARSE, landmarks=[[3, 5]])
    again = match(*shapes, SPARSE)
    np.testing.assert_array_equal(first.target_points.barycentric, again.target_points.barycentric)
    np.testing.assert_array_equal(first.source_points.nearest_vertices, again.source_points.nearest_vertices)


@pytest.mark.parametrize(
    ("landmarks", "sentence"),
    [
        ([1, 2], r"pairs of vertex numbers.*shape \(2,\)"),
        ([[1, 2, 3]], r"pairs of vertex numbers.*shape \(1, 3\)"),
        ([[0.5, 2.0]], "whole numbers.*float64"),
        (np.array([[0, 2**63]], np.uint64), "whole numbers.*uint64"),
        ([[i, i] for i in range(25)], "25 landmarks are more than the 24 points"),
        ([[0, 0], [10**6, 1]], "Landmark 2 is at vertex 1000000 of the source, which has no such vertex"),
        ([[0, -1]], "Landmark 1 is at vertex -1 of the target"),
        ([[3, 4], [5, 6], [3, 8]], "Landmarks 1 and 3 are both at vertex 3 of the source"),
        ([[3, 4], [5, 4]], "Landmarks 1 and 2 are both at vertex 4 of the target"),
    ],
)
def test_landmarks_that_cannot_be_used_are_refused_in_words(landmarks, sentence, shapes):
    with pytest.raises(MatchError, match=sentence):
        match(*shapes, QUICK, landmarks=landmarks)


def test_landmarks_have_to_be_on_the_main_part_and_apart(bodies):
    body = bodies[0]
    ball, faces = icosphere(2, radius=0.05)
    apart = TriangleMesh(np.concatenate([ball + 5, body.vertices]), np.concatenate([faces, body.triangles + len(ball)]))
    with pytest.raises(MatchError, match="Landmark 1 is at vertex 0 of the target, which is not on its main part"):
        match(body, apart, SPARSE, landmarks=[[0, 0]])
    left_out = np.zeros(body.vertex_count, bool)
    left_out[7] = True
    with pytest.raises(MatchError, match="vertex 7 of the source, which is not on its main part"):
        match(body, apart, SPARSE, landmarks=[[7, 60]], excluded=(left_out, None))
    # A seam: each triangle around a vertex of its own.
    torn = TriangleMesh(body.vertices[body.triangles.ravel()], np.arange(body.triangles.size).reshape(-1, 3))
    first, second = np.flatnonzero(body.triangles.ravel() == 0)[:2]
    with pytest.raises(MatchError, match="Landmarks 1 and 2 are at the same place of the source"):
        match(torn, body, SPARSE, landmarks=[[first, 1], [second, 2]])


def test_landmarks_are_located_on_seams_and_proxies(bodies):
    body = bodies[0]
    torn = TriangleMesh(body.vertices[body.triangles.ravel()], np.arange(body.triangles.size).reshape(-1, 3))
    x, y = Shape(torn), Shape(body, proxy_vertices=300)
    corners, vertices = np.array([0, 30, 900]), np.arange(60)
    found = locate_landmarks(x, y, np.stack([corners, vertices[:3]], axis=1), 10)
    np.testing.assert_array_equal(found.source.original, corners)
    np.testing.assert_array_equal(x.mesh.vertices[found.source.matched], torn.vertices[corners])
    crowd = np.flatnonzero(vicinity(body, 0, 0.1)[1] >= 0)[:5]
    near = vicinity(body, 0, 0.1)[0][crowd]
    crowded = locate_landmarks(y, y, np.stack([near, near], axis=1), 10)
    assert len(np.unique(crowded.source.matched)) == len(near)
    distances = np.linalg.norm(y.mesh.vertices[crowded.source.matched] - body.vertices[near], axis=1)
    assert distances.max() < 4 * y.mesh.edge_lengths.mean()


def appended(mesh, at, length=0.9, radius=0.08):
    """Grow a long appendage out of a body around a vertex: the mesh, and which vertices are of it."""
    near, distances = vicinity(mesh, at, 2 * radius)
    vertices = mesh.vertices.copy()
    pull = np.zeros(mesh.vertex_count)
    pull[near] = np.clip(2 - distances / radius, 0, 1)
    vertices += length * pull[:, None] * mesh.vertex_normals[at]
    return TriangleMesh(vertices, mesh.triangles), pull > 0


@pytest.fixture(scope="module")
def with_tail(bodies):
    """The target with something long on its back that the source has not, which vertices it has, and a plain match."""
    middle = int(np.square(bodies[3] - [0, 0, 0.35]).sum(axis=1).argmin())
    return appended(bodies[1], middle)


def test_what_the_other_mesh_lacks_is_better_left_out(bodies, with_tail):
    source, _, rest_x, rest_y = bodies
    target, tail = with_tail
    found = [match(source, target, QUICK, excluded=(None, mask)) for mask in (None, tail)]
    found.append(match(source, bodies[1], QUICK))
    with_it, left_out, without = (rest_error(rest_x, one.source_to_target.transfer(rest_y)) for one in found)
    assert left_out - without < 0.4 * (with_it - without)  # of what the part costs
    assert left_out < 0.03
    there, back = found[1].source_to_target, found[1].target_to_source
    assert not tail[there.corners].any()
    assert len(back) == target.vertex_count
    assert back.confidence[tail].mean() < 0.5 * back.confidence[~tail].mean()
    assert np.isfinite(back.positions).all()


def test_vertices_of_the_source_may_be_left_out_beside_landmarks(bodies, with_tail):
    target, _, rest_y, rest_x = bodies[0], bodies[1], bodies[2], bodies[3]
    source, tail = with_tail
    vertex = int((rest_x[:, 1] - rest_x[:, 2]).argmax())
    pairs = [[vertex, int(np.square(rest_y - rest_x[vertex] * [1, -1, 1]).sum(axis=1).argmin())]]
    result = match(source, target, QUICK, landmarks=pairs, excluded=(tail.tolist(), None))
    assert_exact(result, pairs)
    images = result.source_to_target.transfer(rest_y)
    assert rest_error(rest_x[~tail], images[~tail], mirror=True) < 0.04
    assert not tail[result.source_points.nearest_vertices].any()
    assert not tail[result.target_to_source.corners].any()


def test_shapes_that_are_prepared_and_masks_that_do_not_fit_are_refused(bodies, shapes):
    mask = np.zeros(bodies[1].vertex_count, bool)
    with pytest.raises(MatchError, match="left out of the target any more, because it was prepared before"):
        match(bodies[0], shapes[1], SPARSE, excluded=(None, mask))
    with pytest.raises(MatchError, match="left out of the source any more"):
        match(*shapes, SPARSE, excluded=(mask, None))
    with pytest.raises(MatchError, match="one for each vertex"):
        match(bodies[0], bodies[1], SPARSE, excluded=(mask[:-1], None))
    with pytest.raises(MatchError, match="Nothing of the source is left"):
        match(bodies[0], bodies[1], SPARSE, excluded=(np.ones(bodies[0].vertex_count, bool), None))
