# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps between surfaces: what they carry over, how they follow one another, and what is measured of them."""

from dataclasses import replace

import numpy as np
import pytest

from engine import MatchError, MeshError, SurfacePoints, TriangleMesh
from engine.mesh import surface_map
from engine.mesh.closest_points import ClosestPoints
from engine.mesh.surface_map import SurfaceMap
from tests.shapes import creature, icosphere, plane, rotation, torus


def onto(domain, image, positions=None, confidence=None):
    """The map of each vertex, or of other positions, to the closest point."""
    found = ClosestPoints(image).nearest(domain.vertices if positions is None else positions)
    return SurfaceMap.from_barycentric(image, found.triangles, found.barycentric, confidence)


@pytest.fixture(scope="module")
def fine():
    return TriangleMesh(*icosphere(12))


@pytest.fixture(scope="module")
def coarse():
    vertices, triangles = icosphere(5)
    return TriangleMesh(vertices @ rotation([1.0, 1.0, 0.0], 0.4).T, triangles)


@pytest.fixture(scope="module")
def flat():
    return TriangleMesh(*plane(8, jitter=0.3))


@pytest.fixture(scope="module")
def other_flat():
    return TriangleMesh(*plane(11, jitter=0.3, seed=1))


def test_a_map_shows_its_points(fine, coarse):
    mapped = onto(fine, coarse)
    assert len(mapped) == fine.vertex_count
    assert mapped.image_vertex_count == coarse.vertex_count
    np.testing.assert_array_equal(mapped.corners, coarse.triangles[mapped.triangles])
    np.testing.assert_allclose(
        mapped.positions, np.einsum("kc,kcd->kd", mapped.barycentric, coarse.vertices[mapped.corners])
    )
    heaviest = mapped.barycentric.argmax(axis=1)
    np.testing.assert_array_equal(mapped.nearest_vertices, mapped.corners[np.arange(len(mapped)), heaviest])
    np.testing.assert_array_equal(mapped.confidence, 1)


# --- values


def test_linear_functions_are_carried_over_exactly(flat, other_flat):
    mapped = onto(flat, other_flat)
    slope = np.array([[1.0, -2.0], [0.5, 3.0], [0.0, 0.0]])
    np.testing.assert_allclose(mapped.transfer(other_flat.vertices @ slope + 3), flat.vertices @ slope + 3, atol=1e-12)
    np.testing.assert_allclose(mapped.transfer(other_flat.vertices[:, 0]), flat.vertices[:, 0], atol=1e-12)


def test_constants_and_bounds_are_kept(fine, coarse):
    mapped = onto(fine, coarse)
    np.testing.assert_allclose(mapped.transfer(np.full((coarse.vertex_count, 2, 3), 7.0)), 7)
    values = np.random.default_rng(0).normal(size=coarse.vertex_count)
    carried = mapped.transfer(values)
    assert carried.min() >= values.min() - 1e-12
    assert carried.max() <= values.max() + 1e-12


def test_numbers_that_name_something_are_taken_from_the_nearest_vertex(fine, coarse):
    mapped = onto(fine, coarse)
    numbers = np.random.default_rng(0).integers(0, 100, (coarse.vertex_count, 2)).astype(np.int32)
    carried = mapped.transfer(numbers)
    assert carried.dtype == np.int32
    np.testing.assert_array_equal(carried, numbers[mapped.nearest_vertices])
    truth = mapped.transfer(numbers[:, 0] > 50)
    assert truth.dtype == bool
    np.testing.assert_array_equal(truth, numbers[mapped.nearest_vertices, 0] > 50)
    names = np.array(["left", "right"])[numbers[:, 0] % 2]
    np.testing.assert_array_equal(mapped.transfer(names), names[mapped.nearest_vertices])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("shape", [(), (2,)])
def test_what_is_not_finite_is_carried_to_where_it_has_a_weight_and_nowhere_else(fine, coarse, shape):
    values = np.ones((fine.vertex_count, *shape))
    values[5], values[7] = np.inf, np.nan
    same = SurfaceMap.identity(fine)
    np.testing.assert_array_equal(same.transfer(values), values)
    np.testing.assert_array_equal(same.points.interpolate(values), values)
    mapped = onto(coarse, fine)
    touched = ((mapped.corners == 5) & (mapped.barycentric > 0)).any(axis=1)
    nan = ((mapped.corners == 7) & (mapped.barycentric > 0)).any(axis=1)
    assert touched.any()
    expected = np.where(nan, np.nan, np.where(touched, np.inf, 1.0))
    for carried in (mapped.transfer(values), mapped.points.interpolate(values)):
        np.testing.assert_allclose(carried.T, np.broadcast_to(expected, carried.T.shape))


def test_single_precision_and_lists_become_double_precision(flat, other_flat):
    mapped = onto(flat, other_flat)
    single = mapped.transfer(other_flat.vertices[:, 0].astype(np.float32))
    assert single.dtype == np.float64
    np.testing.assert_allclose(single, flat.vertices[:, 0], atol=1e-6)
    np.testing.assert_array_equal(mapped.transfer([1.0] * other_flat.vertex_count).shape, (flat.vertex_count,))


def test_parts_change_nothing(fine, coarse, monkeypatch):
    mapped = onto(fine, coarse)
    values = np.random.default_rng(0).normal(size=(coarse.vertex_count, 3))
    whole = mapped.transfer(values), mapped.face_orientations(fine, coarse)
    monkeypatch.setattr(surface_map, "_CHUNK", 100)
    np.testing.assert_array_equal(mapped.transfer(values), whole[0])
    np.testing.assert_array_equal(mapped.face_orientations(fine, coarse), whole[1])


@pytest.mark.parametrize("values", [np.zeros(5), np.zeros((3, 121)), 1.0, np.zeros(0, int)])
def test_values_must_be_those_of_the_image(flat, other_flat, values):
    with pytest.raises(MatchError, match="one value for each of the 121 vertices"):
        onto(flat, other_flat).transfer(values)


# --- maps one after the other


def test_the_identity_changes_nothing(fine, coarse):
    mapped = onto(fine, coarse)
    identity = SurfaceMap.identity(coarse)
    np.testing.assert_array_equal(identity.positions, coarse.vertices)
    np.testing.assert_allclose(mapped.then(identity, coarse).positions, mapped.positions, atol=1e-12)
    np.testing.assert_allclose(SurfaceMap.identity(fine).then(mapped, coarse).positions, mapped.positions, atol=1e-12)


def test_a_mesh_with_a_loose_vertex_has_no_identity(fine):
    loose = TriangleMesh(np.vstack([fine.vertices, [[9.0, 9.0, 9.0]]]), fine.triangles)
    with pytest.raises(MeshError, match="no face"):
        SurfaceMap.identity(loose)


def test_affine_maps_follow_one_another_exactly(flat, other_flat):
    third = TriangleMesh(*plane(9, jitter=0.2, seed=2))
    turn = np.array([[0.0, 0.5, 0.0], [-0.5, 0.0, 0.0], [0.0, 0.0, 0.0]])
    shift = np.array([0.2, 0.7, 0.0])
    first = onto(flat, other_flat, flat.vertices * 0.8)
    second = onto(other_flat, third, other_flat.vertices @ turn.T + shift)
    both = first.then(second, third)
    np.testing.assert_allclose(both.positions, 0.8 * flat.vertices @ turn.T + shift, atol=1e-12)


def test_a_map_there_and_back_comes_close(fine, coarse):
    back = onto(fine, coarse).then(onto(coarse, fine), fine, ClosestPoints(fine))
    distance = np.linalg.norm(back.positions - fine.vertices, axis=1)
    assert distance.max() < coarse.edge_lengths.max() / 2
    assert distance.mean() < coarse.edge_lengths.max() / 10


def test_confidence_multiplies(flat, other_flat):
    first = onto(flat, other_flat, confidence=np.linspace(0, 1, flat.vertex_count))
    second = onto(other_flat, flat, confidence=np.full(other_flat.vertex_count, 0.5))
    np.testing.assert_allclose(first.then(second, flat).confidence, first.confidence / 2)


def test_all_have_a_partner_unless_it_is_said(flat, other_flat):
    assert onto(flat, other_flat).has_partner.all()
    none = np.zeros(flat.vertex_count, bool)
    alone = replace(onto(flat, other_flat), has_partner=none)
    assert not alone.has_partner.any()
    assert (alone.confidence == 0).all()


def test_a_vertex_has_a_partner_if_all_of_its_way_has(flat, other_flat):
    left = flat.vertices[:, 0] < 0.4
    first = replace(onto(flat, other_flat), has_partner=left)
    second = onto(other_flat, flat)
    upper = second.transfer(flat.vertices[:, 1]) > 0.5
    way = first.then(replace(second, has_partner=upper), flat)
    np.testing.assert_array_equal(way.has_partner, left & upper[first.nearest_vertices])
    assert (way.confidence[~way.has_partner] == 0).all()


def test_partners_are_checked(flat, other_flat):
    with pytest.raises(MatchError, match="one truth value for each"):
        replace(onto(flat, other_flat), has_partner=np.ones(3, bool))


def test_maps_must_meet(fine, coarse, flat):
    mapped = onto(fine, coarse)
    with pytest.raises(MatchError, match="second starts on the mesh"):
        mapped.then(onto(flat, coarse), coarse)
    with pytest.raises(MatchError, match="given as its image"):
        mapped.then(onto(coarse, fine), flat)


# --- measures


def test_stretch_of_similarities_is_one(fine):
    turn = rotation([3.0, 1.0, 2.0], 1.0)
    larger = TriangleMesh(5 * fine.vertices @ turn.T + 1, fine.triangles)
    mapped = SurfaceMap.identity(larger)
    np.testing.assert_allclose(mapped.edge_stretch(fine, larger), 1)
    assert mapped.rms_edge_stretch(fine, larger) == pytest.approx(1)
    assert mapped.flipped_faces(fine, larger) == 0
    assert mapped.orientation(fine, larger) == pytest.approx(1)


def test_stretch_along_one_axis():
    vertices, triangles = plane(6)
    square, oblong = TriangleMesh(vertices, triangles), TriangleMesh(vertices * [4, 1, 1], triangles)
    stretch = SurfaceMap.identity(oblong).edge_stretch(square, oblong)
    side = vertices[square.edges[:, 1]] - vertices[square.edges[:, 0]]
    np.testing.assert_allclose(stretch[side[:, 1] == 0], 2)
    np.testing.assert_allclose(stretch[side[:, 0] == 0], 0.5)


def test_edges_without_length_have_no_stretch():
    vertices, triangles = plane(4)
    merged = vertices.copy()
    merged[5] = merged[6]
    domain, image = TriangleMesh(merged, triangles), TriangleMesh(vertices, triangles)
    mapped = SurfaceMap.identity(image)
    stretch = mapped.edge_stretch(domain, image)
    assert np.isnan(stretch).sum() == 1
    assert np.isfinite(mapped.rms_edge_stretch(domain, image))


def test_the_mirror_image_turns_every_triangle_over(fine):
    mirrored = fine.vertices * [-1, 1, 1]
    mapped = onto(fine, fine, mirrored)
    assert mapped.orientation(fine, fine) == pytest.approx(-1)
    assert mapped.flipped_faces(fine, fine) == pytest.approx(1)
    np.testing.assert_array_equal(mapped.face_orientations(fine, fine), -1)


@pytest.mark.parametrize("turn", [np.eye(3), rotation([1, 2, 3], 2.0)])
def test_only_what_lies_as_in_a_mirror_is_mirrored(turn):
    """Triangles that are all the wrong way round on one of the meshes are no mirror."""
    vertices, triangles, _ = creature(0.4, 7)
    mesh = TriangleMesh(vertices, triangles)
    turned = vertices @ turn.T
    for other, wound, mirrored in [
        (turned, triangles, False),
        (turned, triangles[:, ::-1], False),
        (turned * [1, -1, 1], triangles[:, ::-1], True),
    ]:
        image = TriangleMesh(other, wound)
        for domain, end in ((mesh, image), (image, mesh)):
            led = SurfaceMap.from_points(end, SurfacePoints.at_vertices(end, np.arange(len(vertices))))
            assert led.mirrors(domain, end) is mirrored


def test_between_triangulations_orientation_is_kept(fine, coarse):
    for domain, image in ((fine, coarse), (coarse, fine)):
        mapped = onto(domain, image)
        assert mapped.orientation(domain, image) > 0.99
        assert mapped.flipped_faces(domain, image) < 0.005


def test_a_fold_is_flipped_by_its_area():
    mesh = TriangleMesh(*plane(21))
    # There to 3/5, back to 2/5, and on: a fifth of the area is passed the wrong way.
    folded = mesh.vertices.copy()
    folded[:, 0] = np.interp(mesh.vertices[:, 0], [0, 0.4, 0.6, 1], [0, 0.6, 0.4, 1])
    mapped = onto(mesh, mesh, folded)
    assert mapped.flipped_faces(mesh, mesh) == pytest.approx(0.2)
    assert mapped.orientation(mesh, mesh) == pytest.approx(0.6)


def test_a_collapsed_map_has_no_orientation(fine):
    points = SurfacePoints.at_vertices(fine, np.zeros(fine.vertex_count, int))
    mapped = SurfaceMap.from_points(fine, points)
    assert mapped.orientation(fine, fine) == 0
    assert mapped.flipped_faces(fine, fine) == 0
    assert mapped.rms_edge_stretch(fine, fine) == 0


def test_a_map_onto_a_line_has_no_orientation(fine):
    flat = TriangleMesh(*plane(5))
    along = np.column_stack(
        [(fine.vertices[:, 0] + 1) / 2, np.full((fine.vertex_count, 1), 0.3), np.zeros(len(fine.vertices))]
    )
    mapped = onto(fine, flat, along)
    np.testing.assert_array_equal(mapped.face_orientations(fine, flat), 0)


def test_measures_do_not_depend_on_order_motion_or_scale():
    mesh, image = TriangleMesh(*torus(24, 10)), TriangleMesh(*torus(30, 13))
    bent = mesh.vertices + 0.1 * np.sin(5 * mesh.vertices[:, [1, 2, 0]])
    mapped = onto(mesh, image, bent)
    new = np.random.default_rng(0).permutation(mesh.vertex_count)
    vertices, triangles = np.empty_like(mesh.vertices), new[mesh.triangles][::-1]
    vertices[new] = mesh.vertices
    turn = rotation([0.0, 1.0, 2.0], 2.0)
    moved, moved_image = (
        TriangleMesh(3 * vertices @ turn.T, triangles),
        TriangleMesh(image.vertices * 7, image.triangles),
    )
    order = np.argsort(new)
    again = SurfaceMap.from_barycentric(moved_image, mapped.triangles[order], mapped.barycentric[order])
    for measure in ("rms_edge_stretch", "flipped_faces", "orientation"):
        first, second = getattr(mapped, measure)(mesh, image), getattr(again, measure)(moved, moved_image)
        assert first == pytest.approx(second, abs=1e-12)


# --- errors


def test_measures_need_the_meshes_of_the_map(fine, coarse):
    mapped = onto(fine, coarse)
    with pytest.raises(MatchError, match="should lead from"):
        mapped.edge_stretch(coarse, coarse)
    with pytest.raises(MatchError, match="given as its image"):
        mapped.orientation(fine, fine)


@pytest.mark.parametrize(
    ("confidence", "message"),
    [(np.ones(3), "one confidence for each"), (np.full(64, 1.5), "between 0 and 1"), (np.full(64, np.nan), "between")],
)
def test_confidence_is_checked(flat, confidence, message):
    points = SurfacePoints.at_vertices(flat, np.arange(64))
    with pytest.raises(MatchError, match=message):
        SurfaceMap.from_points(flat, points, confidence)


def test_points_must_be_on_the_image(flat, other_flat):
    points = SurfacePoints.at_vertices(other_flat, np.arange(121))
    with pytest.raises(MatchError, match="on another mesh"):
        SurfaceMap.from_points(flat, points)


def test_points_are_at_vertices_that_there_are(flat):
    points = SurfacePoints.at_vertices(flat, np.arange(4))
    with pytest.raises(MatchError, match="has a point at vertex -1"):
        SurfaceMap(replace(points, corners=points.corners - points.corners.min() - 1), np.ones(4), flat.vertex_count)


def test_no_vertices(flat):
    nothing = SurfaceMap.from_points(flat, SurfacePoints.at_vertices(flat, np.empty(0, int)))
    assert nothing.transfer(np.zeros((flat.vertex_count, 2))).shape == (0, 2)
