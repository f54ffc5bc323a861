# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of every vertex, from whole matches and from sparse correspondences, where the truth is known."""

import numpy as np
import pytest

from engine import (
    MatchError,
    MatchQuality,
    MatchSettings,
    MeshError,
    Shape,
    SurfaceMap,
    SurfacePoints,
    TriangleMesh,
    densify,
    densify_steps,
    match,
    match_steps,
    use_processes,
)
from engine.dense.missing_parts import round_trips
from engine.mesh.closest_points import ClosestPoints
from engine.registration import fine_registration
from engine.registration.elastic import ElasticSurface
from tests.bodies import mirrored_body
from tests.messes import together
from tests.shapes import creature, icosphere, permuted, rotation, subdivided
from tests.steps import followed

QUICK = MatchSettings(points=12, samples=100, hypotheses=2)


def errors(found, own, other, mesh):
    """Distance at rest between the vertices of a mesh and their images, over the square root of its area."""
    return np.linalg.norm(own - found.transfer(other), axis=1) / np.sqrt(mesh.area)


def assert_valid(found, domain, image):
    assert isinstance(found, SurfaceMap)
    assert len(found) == domain.vertex_count
    assert found.image_vertex_count == image.vertex_count
    assert found.barycentric.min() >= 0
    np.testing.assert_allclose(found.barycentric.sum(axis=1), 1)
    np.testing.assert_array_equal(found.corners, image.triangles[found.triangles])
    assert np.isfinite(found.positions).all()


@pytest.fixture(scope="module")
def bodies():
    """A body at rest and, in another meshing, bent; and the rest positions of both."""
    first, second = creature(0.0, 9), creature(0.8, 9, turn=0.7)
    return TriangleMesh(*first[:2]), TriangleMesh(*second[:2]), first[2], second[2]


@pytest.fixture(scope="module")
def watched(bodies):
    """What a match yields on the way, and returns."""
    return followed(match_steps(*bodies[:2], QUICK))


@pytest.fixture(scope="module")
def result(watched):
    return watched[1]


@pytest.fixture(scope="module")
def symmetric():
    """The same for a body that is symmetric at rest."""
    first, second = mirrored_body(0.0, 9), mirrored_body(0.8, 9, seed=1)
    return TriangleMesh(*first[:2]), TriangleMesh(*second[:2]), first[2], second[2]


@pytest.fixture(scope="module")
def symmetric_result(symmetric):
    return match(*symmetric[:2], QUICK)


@pytest.fixture(scope="module")
def mirrored_map(symmetric, symmetric_result):
    mirrored = symmetric_result.mirrored
    return densify(*symmetric[:2], mirrored.source_points, mirrored.target_points)


def test_every_vertex_gets_its_point_between_the_vertices(result, bodies):
    source, target, rest_x, rest_y = bodies
    for found, domain, image, own, other in (
        (result.source_to_target, source, target, rest_x, rest_y),
        (result.target_to_source, target, source, rest_y, rest_x),
    ):
        assert_valid(found, domain, image)
        found_errors = errors(found, own, other, domain)
        assert found_errors.mean() < 0.013
        assert found_errors.max() < 0.08
        edge = image.edge_lengths.mean() / np.sqrt(image.area)
        assert found_errors.mean() < 0.3 * edge
        nearest = np.linalg.norm(own - other[found.nearest_vertices], axis=1) / np.sqrt(domain.area)
        assert found_errors.mean() < 0.6 * nearest.mean()
        assert found.orientation(domain, image) > 0.97
        assert found.flipped_faces(domain, image) < 0.015
        assert np.nanpercentile(found.edge_stretch(domain, image), 95) < 1.4


def test_the_two_maps_are_nearly_inverse(result, bodies):
    source, target = bodies[:2]
    for there, back, mesh in (
        (result.source_to_target, result.target_to_source, source),
        (result.target_to_source, result.source_to_target, target),
    ):
        trips = round_trips(mesh, there.points, back.points) / np.sqrt(mesh.area)
        assert trips.mean() < 0.01
        assert np.percentile(trips, 99) < 0.05


def test_a_map_carries_linear_functions_exactly_and_rest_positions_nearly(result, bodies):
    _, target, _, _ = bodies
    found = result.source_to_target
    slope, offset = np.array([0.3, -2.0, 1.1]), 0.7
    np.testing.assert_allclose(
        found.transfer(target.vertices @ slope + offset), found.positions @ slope + offset, atol=1e-12
    )
    np.testing.assert_array_equal(found.transfer(np.arange(target.vertex_count)), found.nearest_vertices)


def test_the_quality_is_that_of_the_maps(result):
    quality = result.quality
    assert isinstance(quality, MatchQuality)
    assert quality.orientation > 0.97
    assert quality.coverage > 0.99
    assert quality.disagreement < 0.01
    assert quality.distortion < 0.15
    assert quality.margin is None or quality.margin > 0
    assert quality.confidence > 0.8
    assert quality.sentence.startswith("The shapes correspond")
    assert result.source_to_target.confidence.mean() == pytest.approx(quality.confidence, abs=0.1)
    assert not result.notes


def test_the_sparse_points_lie_where_the_dense_map_takes_them(result, bodies):
    target = bodies[1]
    points = result.source_points.nearest_vertices
    gaps = np.linalg.norm(result.target_points.positions - result.source_to_target.positions[points], axis=1)
    assert gaps.max() < target.edge_lengths.mean()
    assert np.median(gaps) < 0.2 * target.edge_lengths.mean()
    assert result.source_distances is None
    if result.mirrored is not None:
        assert result.mirrored.source_to_target is None
        assert result.mirrored.target_to_source is None
        assert result.mirrored.quality is None


def test_a_body_is_mapped_to_itself(bodies):
    source = bodies[0]
    result = match(source, source, QUICK)
    for found in (result.source_to_target, result.target_to_source):
        gaps = np.linalg.norm(found.positions - source.vertices, axis=1)
        assert gaps.mean() < 0.02 * source.edge_lengths.mean()
        assert gaps.max() < 0.15 * source.edge_lengths.mean()
        assert (found.nearest_vertices == np.arange(source.vertex_count)).mean() > 0.99
    assert result.quality.confidence > 0.98
    assert result.quality.sentence == "The shapes correspond closely."


def test_rigid_motion_and_scale_do_not_matter(result, bodies):
    source, target = bodies[:2]
    turn = rotation([1, 2, 0.5], 2.0)
    moved = TriangleMesh(254 * source.vertices @ turn.T + [10, -300, 7], source.triangles)
    other = match(moved, TriangleMesh(0.01 * target.vertices @ turn, target.triangles), QUICK)
    back = 100 * other.source_to_target.positions @ turn.T
    np.testing.assert_allclose(back, result.source_to_target.positions, atol=1e-4)
    np.testing.assert_allclose(other.source_to_target.confidence, result.source_to_target.confidence, atol=1e-3)
    assert other.quality.confidence == pytest.approx(result.quality.confidence, abs=1e-4)


def as_it_is(mesh):
    """Let a mesh be registered with the vertices it has."""
    return Shape(mesh, proxy_vertices=mesh.vertex_count)


@pytest.mark.parametrize(("shape_of", "uneven", "bounds"), [(as_it_is, 0.0, (2e-4, 0.01)), (Shape, 1e-3, (1e-5, 2e-3))])
def test_the_order_of_the_vertices_does_not_matter(shape_of, uneven, bounds, bodies):
    """But for the first of equal samples that a symmetric body has."""
    random = np.random.default_rng(2)
    meshes = [TriangleMesh(m.vertices + random.normal(0, uneven, m.vertices.shape), m.triangles) for m in bodies[:2]]
    expected = match(*map(shape_of, meshes), QUICK)
    first, faces, new = permuted(meshes[0].vertices, meshes[0].triangles, seed=3)
    second, other_faces, other_new = permuted(meshes[1].vertices, meshes[1].triangles, seed=4)
    other = match(shape_of(TriangleMesh(first, faces)), shape_of(TriangleMesh(second, other_faces)), QUICK)
    for found, before, order, mesh in (
        (other.source_to_target, expected.source_to_target, new, meshes[1]),
        (other.target_to_source, expected.target_to_source, other_new, meshes[0]),
    ):
        gaps = np.linalg.norm(found.positions[order] - before.positions, axis=1) / np.sqrt(mesh.area)
        assert gaps.mean() < bounds[0]
        assert gaps.max() < bounds[1]


def mean_errors(found, bodies, target, rest):
    """Mean errors of the maps between the first body and a target at rest like this, there and back."""
    there = errors(found.source_to_target, bodies[2], rest, bodies[0])
    return there.mean(), errors(found.target_to_source, rest, bodies[2], target).mean()


def test_a_coarse_stand_in_gives_nearly_the_same_map(result, bodies, monkeypatch):
    source, target, _, rest_y = bodies
    vertices, triangles = subdivided(target.vertices, target.triangles, 2)
    rest, _ = subdivided(rest_y, target.triangles, 2)
    fine = TriangleMesh(vertices, triangles)
    shape = Shape(fine, "target", proxy_vertices=700)
    assert not shape.surface.proxy.is_identity
    assert shape.mesh.vertex_count < 0.5 * fine.vertex_count
    other = match(source, shape, QUICK)
    assert_valid(other.source_to_target, source, fine)
    assert_valid(other.target_to_source, fine, source)
    there, back = mean_errors(other, bodies, fine, rest)
    plain = match(as_it_is(source), as_it_is(target), QUICK)
    assert there + back < sum(mean_errors(plain, bodies, target, rest_y))
    # Registered in full resolution at last, it is nearer to the truth than what the coarse meshes lead to.
    monkeypatch.setattr("engine.dense.densify._POLISHED", 0)
    coarse = mean_errors(match(source, shape, QUICK), bodies, fine, rest)
    assert there < coarse[0]
    assert back < coarse[1]
    gaps = np.linalg.norm(other.source_to_target.positions - result.source_to_target.positions, axis=1)
    assert gaps.mean() < 0.22 * target.edge_lengths.mean()
    assert other.source_to_target.flipped_faces(source, fine) < 0.02
    assert np.isfinite(other.target_points.positions).all()


@pytest.fixture
def alone():
    """No other process, which would not see what is put in the place of functions here."""
    use_processes(1)
    yield
    use_processes()


@pytest.mark.usefixtures("alone")
def test_full_resolution_starts_from_the_strain_that_the_stand_ins_led_to(bodies, monkeypatch):
    strained, registered = [], []
    own, steps = ElasticSurface.strained, fine_registration.register_steps

    def recorded(*given, elastic, **others):
        registered.append(elastic)
        return steps(*given, elastic=elastic, **others)

    monkeypatch.setattr(ElasticSurface, "strained", lambda *given: strained.append(own(*given)) or strained[-1])
    monkeypatch.setattr(fine_registration, "register_steps", recorded)
    fine = TriangleMesh(*subdivided(bodies[1].vertices, bodies[1].triangles, 2))
    match(bodies[0], Shape(fine, "target", proxy_vertices=700), QUICK)
    assert len(registered) == 2  # there and back
    assert registered == strained


def test_what_is_excluded_follows_what_is_around_it(bodies):
    source, target, rest_x, rest_y = bodies
    shapes = [Shape(mesh, excluded=rest[:, 0] < -0.95) for mesh, rest in ((source, rest_x), (target, rest_y))]
    result = match(*shapes, QUICK)
    left_out = rest_x[:, 0] < -0.95
    assert_valid(result.source_to_target, source, target)
    found_errors = errors(result.source_to_target, rest_x, rest_y, source)
    assert found_errors[~left_out].mean() < 0.02
    assert found_errors.max() < 0.25
    allowed = ~(rest_y[:, 0] < -0.95)[target.triangles].any(axis=1)
    assert allowed[result.source_to_target.triangles].all()
    assert result.source_to_target.confidence[left_out].mean() < result.source_to_target.confidence[~left_out].mean()
    assert any("large opening" in note for note in result.notes)


def test_parts_that_are_left_out_are_in_the_notes_and_in_the_map(bodies):
    source, target, rest_x, rest_y = bodies
    ball = icosphere(2, 0.05)
    place = np.linalg.norm(rest_x - [1.0, 0.1, 0.6], axis=1).argmin()
    outside = source.vertices[place] + 0.05 * source.vertex_normals[place]
    mesh = TriangleMesh(*together((ball[0] + outside, ball[1]), (source.vertices, source.triangles)))
    result = match(mesh, target, QUICK)
    assert result.notes == ("The source has 1 smaller part: it follows its surroundings.",)
    assert_valid(result.source_to_target, mesh, target)
    there = np.linalg.norm(result.source_to_target.transfer(rest_y)[: len(ball[0])] - rest_x[place], axis=1)
    assert there.max() < 0.2
    assert_valid(result.target_to_source, target, mesh)
    assert errors(result.target_to_source, rest_y, np.concatenate([ball[0] + 99, rest_x]), target).mean() < 0.013


def test_progress_rises_to_the_end(watched):
    fractions = [report.fraction for report in watched[0]]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0
    assert fractions[-1] == 1
    assert len({report.label for report in watched[0]}) > 5
    assert all(report.label for report in watched[0])
    assert max(np.diff(fractions)) < 0.2


@pytest.mark.parametrize("until", [0.0, 0.3, 0.55, 0.8, 0.95])
def test_a_match_can_be_dropped_at_any_time(until):
    ball = TriangleMesh(icosphere(3)[0] * [1, 1.3, 1.9], icosphere(3)[1])
    steps = match_steps(ball, ball, QUICK)
    for report in steps:
        if report.fraction >= until:
            break
    steps.close()
    with pytest.raises(StopIteration):
        next(steps)


def test_a_mirrored_correspondence_gives_the_mirrored_map(symmetric, mirrored_map):
    source, target, rest_x, rest_y = symmetric
    dense = mirrored_map
    flip = np.array([1, -1, 1])
    for found, domain, image, own, other in (
        (dense.source_to_target, source, target, rest_x, rest_y),
        (dense.target_to_source, target, source, rest_y, rest_x),
    ):
        assert_valid(found, domain, image)
        assert found.orientation(domain, image) < -0.9
        assert errors(found, own * flip, other, domain).mean() < 0.01
        assert errors(found, own * flip, other, domain).max() < 0.08
        assert errors(found, own, other, domain).mean() > 0.1
    assert dense.quality.sentence == "The shapes correspond closely."


def test_a_mirrored_map_leaves_a_body_in_place_whichever_way_it_looks(symmetric, symmetric_result, mirrored_map):
    assert mirrored_map.quality.in_place > 0.9  # which is mirrored in y
    turn = rotation([0, 0, 1], np.pi / 2)
    source, target = (TriangleMesh(mesh.vertices @ turn.T, mesh.triangles) for mesh in symmetric[:2])
    mirrored = symmetric_result.mirrored
    points = [
        SurfacePoints.from_barycentric(mesh, own.triangles, own.barycentric)
        for mesh, own in ((source, mirrored.source_points), (target, mirrored.target_points))
    ]
    turned = densify(source, target, *points)
    assert turned.quality.in_place == pytest.approx(mirrored_map.quality.in_place, abs=1e-3)
    apart = turned.source_to_target.positions @ turn - mirrored_map.source_to_target.positions
    assert np.linalg.norm(apart, axis=1).mean() < 1e-3 * np.sqrt(target.area)


def test_a_true_correspondence_gives_the_true_map(symmetric, symmetric_result):
    source, target, rest_x, rest_y = symmetric
    dense = densify(source, target, symmetric_result.source_points, symmetric_result.target_points)
    for found, domain, image, own, other in (
        (dense.source_to_target, source, target, rest_x, rest_y),
        (dense.target_to_source, target, source, rest_y, rest_x),
    ):
        assert_valid(found, domain, image)
        assert found.orientation(domain, image) > 0.9
        assert errors(found, own, other, domain).mean() < 0.01
    gaps = dense.source_to_target.positions - symmetric_result.source_to_target.positions
    assert np.linalg.norm(gaps, axis=1).mean() < 0.1 * target.edge_lengths.mean()
    assert dense.quality.margin is None


def test_progress_of_a_densification_rises(symmetric, symmetric_result):
    """Also where it has to start again from the reflected source."""
    source, target = symmetric[:2]
    mirrored = symmetric_result.mirrored
    steps = densify_steps(source, target, mirrored.source_points, mirrored.target_points)
    reports = list(steps)
    fractions = [report.fraction for report in reports]
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] < 0.05
    assert fractions[-1] <= 1
    previews = [report.preview for report in reports if report.preview is not None]
    assert previews
    for preview in previews:
        for mesh, places in ((source, preview.source), (target, preview.target)):
            distances = ClosestPoints(mesh).nearest(places).squared_distances
            assert distances.max() < 1e-18 * mesh.area


def test_what_is_excluded_is_left_out_of_the_map_of_an_answer_as_well(symmetric, symmetric_result):
    source, target, rest_x, rest_y = symmetric
    left_out = [rest[:, 1] > 0.9 * rest[:, 1].max() for rest in (rest_x, rest_y)]
    mirrored = symmetric_result.alternatives[0]
    inside = ~left_out[0][mirrored.source_points.nearest_vertices]
    inside &= ~left_out[1][target.triangles[mirrored.target_points.triangles]].any(axis=1)
    points = mirrored.source_points.at(inside), mirrored.target_points.at(inside)
    dense = densify(source, target, *points, excluded=left_out)
    for found, image, gone in (
        (dense.source_to_target, target, left_out[1]),
        (dense.target_to_source, source, left_out[0]),
    ):
        assert gone.any()
        assert not gone[image.triangles[found.triangles]].any()
    with pytest.raises(MatchError, match="No vertices can be left out of the source"):
        densify(Shape(source), target, *points, excluded=left_out)


def test_points_that_cannot_be_extended_are_refused_in_words(symmetric, symmetric_result):
    source, target = symmetric[:2]
    here, there = symmetric_result.source_points, symmetric_result.target_points
    few = np.arange(2)
    for points in ((here, there.at(few)), (here.at(few), there.at(few))):
        with pytest.raises(MatchError, match="cannot be extended to a map"):
            densify(source, target, *points)
    with pytest.raises(MatchError, match="points of the target do not lie on it"):
        densify(source, TriangleMesh(*icosphere(2)), here, there)
    with pytest.raises(MeshError, match="source is of the type ndarray"):
        densify(source.vertices, target, here, there)
    other = SurfaceMap.identity(TriangleMesh(*icosphere(2)))
    for maps in ((other, None), (None, other)):
        with pytest.raises(MatchError, match="map is one of 42 vertices"):
            densify(source, target, here, there, maps=maps)


def test_points_beside_the_main_part_are_refused_in_words(symmetric, symmetric_result):
    source, target = symmetric[:2]
    ball = icosphere(2, 0.05)
    mesh = TriangleMesh(*together((source.vertices, source.triangles), (ball[0] + 3, ball[1])))
    beside = SurfacePoints.at_vertices(mesh, source.vertex_count + np.arange(12))
    with pytest.raises(MatchError, match="main part of the mesh"):
        densify(mesh, target, beside, symmetric_result.target_points)


def test_a_body_that_is_symmetric_is_not_mirrored(symmetric, symmetric_result):
    source, target, rest_x, rest_y = symmetric
    assert errors(symmetric_result.source_to_target, rest_x, rest_y, source).max() < 0.05
    assert errors(symmetric_result.target_to_source, rest_y, rest_x, target).max() < 0.08
