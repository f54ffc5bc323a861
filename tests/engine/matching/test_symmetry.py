# SPDX-License-Identifier: GPL-3.0-or-later
"""The symmetry of bodies that are symmetric at rest, found in poses that are not."""

import numpy as np
import pytest

from engine.hierarchical.lifted_samples import curvature_agreement
from engine.hierarchical.settings import MatchSettings
from engine.matching import symmetry
from engine.matching.symmetry import find_symmetry, find_symmetry_steps
from engine.mesh.triangle_mesh import TriangleMesh
from engine.runtime.errors import MatchError
from engine.runtime.progress import run
from engine.shapes.shape import Shape
from tests.bodies import mirrored_body
from tests.shapes import creature, icosphere, permuted, plane, rotation
from tests.steps import followed

QUICK = MatchSettings(points=40, samples=200)


@pytest.fixture(scope="module")
def posed_body():
    """A symmetric body, bent differently on the left and the right, its triangles not symmetric; and its rest."""
    vertices, triangles, rest = mirrored_body(0.8, resolution=11, seed=1)
    return TriangleMesh(vertices, triangles), rest


@pytest.fixture(scope="module")
def watched(posed_body):
    """What the computation yields on the way, and returns."""
    return followed(find_symmetry_steps(posed_body[0], QUICK))


@pytest.fixture(scope="module")
def result(watched):
    return watched[1]


def mirror_errors(result, mesh, rest):
    """Distance at rest between the mirror image of each point and its image, over the square root of the area."""
    gap = result.source_points.interpolate(rest) * [1, -1, 1] - result.target_points.interpolate(rest)
    return np.linalg.norm(gap, axis=1) / np.sqrt(mesh.area)


@pytest.mark.parametrize("pose", [0.3, 0.9])
def test_left_and_right_are_found_in_any_pose(pose):
    vertices, triangles, rest = mirrored_body(pose, resolution=11, seed=2)
    mesh = TriangleMesh(vertices, triangles)
    result = find_symmetry(mesh, QUICK)
    errors = mirror_errors(result, mesh, rest)
    assert errors.mean() < 0.04
    assert errors.max() < 0.25
    assert result.reverses_orientation
    assert result.orientation < -0.5
    assert result.involution < 0.06
    assert result.curvature > 0.5
    assert result.proven
    assert not result.notes


def test_a_mesh_that_is_its_own_mirror_image_is_mapped_to_its_vertices_exactly():
    vertices, triangles, rest = mirrored_body(0.0, resolution=11)
    mesh = TriangleMesh(vertices, triangles)
    result = find_symmetry(mesh, QUICK)
    np.testing.assert_allclose(mirror_errors(result, mesh, rest), 0, atol=1e-9)
    assert result.asymmetry < 1e-3
    on_axis = result.axis_points.interpolate(rest)[:, 1]
    np.testing.assert_allclose(on_axis, 0, atol=1e-3)


def test_the_axis_and_the_sides(posed_body, result):
    mesh, rest = posed_body
    y, side = rest[:, 1], result.sides
    clear = np.abs(y) > 0.1
    agreement = (np.sign(y[clear]) == np.sign(side[clear])).mean()
    assert max(agreement, 1 - agreement) > 0.97  # which of them is positive does not matter
    assert len(result.axis_points) > 50
    axis = np.abs(result.axis_points.interpolate(rest)[:, 1]) / np.sqrt(mesh.area)
    assert axis.mean() < 0.03
    np.testing.assert_allclose(result.axis_points.interpolate(side), 0, atol=1e-9)
    # No more than half the distance to the image.
    chosen, images = result.source_points.nearest_vertices, result.target_points.nearest_vertices
    rows = np.concatenate([block for _, block in Shape(mesh).solver.distances_in_blocks(chosen)])
    assert (np.abs(side[chosen]) <= rows[np.arange(len(chosen)), images] / 2 * 1.05 + 0.02).all()


def test_asymmetry_tells_symmetric_bodies_from_others():
    poses = (0.0, 0.5)
    symmetric = [
        find_symmetry(TriangleMesh(*mirrored_body(pose, resolution=11)[:2]), QUICK).asymmetry for pose in poses
    ]
    other = [find_symmetry(TriangleMesh(*creature(pose, resolution=11)[:2]), QUICK).asymmetry for pose in poses]
    for body, unequal in zip(symmetric, other, strict=True):
        assert body < 0.7 * unequal
    assert symmetric[0] < 0.1 * other[0]


def test_asymmetry_compares_between_numbers_of_points():
    for surface in (mirrored_body(0.5, resolution=11), creature(0.5, resolution=11)):
        shape = Shape(TriangleMesh(*surface[:2]))
        few, many = (find_symmetry(shape, MatchSettings(points=n, samples=200)).asymmetry for n in (24, 60))
        assert few == pytest.approx(many, rel=0.4)


def test_position_size_and_vertex_order_do_not_matter(posed_body, result):
    mesh = posed_body[0]
    turned = 39.37 * mesh.vertices @ rotation([2, -1, 0.5], 1.3).T + [5, 70, -3]
    vertices, triangles, new = permuted(turned, mesh.triangles, seed=4)
    other = find_symmetry(TriangleMesh(vertices, triangles), QUICK)
    for name in ("source_points", "target_points"):
        ours, theirs = (getattr(r, name).nearest_vertices for r in (result, other))
        np.testing.assert_array_equal(new[ours], theirs)
    assert other.asymmetry == pytest.approx(result.asymmetry, rel=1e-5)
    np.testing.assert_allclose(other.sides[new], 39.37 * result.sides, rtol=1e-4, atol=1e-4)


def test_alternatives_are_other_maps(posed_body, result):
    assert result.alternatives
    for other in result.alternatives:
        assert other.alternatives == ()
        assert other.asymmetry > result.asymmetry
        gap = mirror_errors(other, *posed_body)
        assert gap.mean() > 2 * mirror_errors(result, *posed_body).mean()
        moved = np.linalg.norm(other.source_points.positions - other.target_points.positions, axis=1)
        assert (moved > 0).mean() > 0.5


def test_what_a_shape_was_used_for_before_does_not_matter(posed_body, result):
    shape = Shape(posed_body[0])
    run(shape.sample_steps(QUICK.samples + 100))
    again = find_symmetry(shape, QUICK)
    assert again.orientation == result.orientation
    np.testing.assert_array_equal(again.target_points.positions, result.target_points.positions)


def test_the_axis_crosses_borders_and_edges_between_faces_that_are_turned_over():
    vertices, triangles = plane(13)
    turned = triangles.copy()
    turned[::3] = turned[::3, ::-1]
    axes = []
    for faces in (triangles, turned):
        mesh = TriangleMesh(vertices, faces)
        found = find_symmetry(mesh, MatchSettings(points=16, samples=96, hypotheses=2))
        ahead = found.sides[mesh.edges] >= 0
        assert len(found.axis_points) == (ahead[:, 0] != ahead[:, 1]).sum()
        axes.append(found.axis_points.positions[:, :2])
    on_border = ((axes[0] < 1e-9) | (axes[0] > 1 - 1e-9)).any(axis=1)
    assert on_border.sum() == 2
    assert len(np.unique(axes[1].round(9), axis=0)) == len(np.unique(axes[0].round(9), axis=0))


def test_turns_have_no_axis():
    square = TriangleMesh(*plane(25))
    result = find_symmetry(square, QUICK)
    maps = [result, *result.alternatives]
    assert result.reverses_orientation
    assert all(found.asymmetry < 0.01 for found in maps)
    turns = [found for found in maps if not found.reverses_orientation]
    assert turns
    assert all(len(found.axis_points) == 0 for found in turns)
    assert len(result.axis_points) > 0
    # The axis of a square is a straight line through its centre, a diagonal or parallel to two sides.
    points = result.axis_points.positions[:, :2] - 0.5
    assert np.linalg.svd(points, compute_uv=False)[1] < 0.02 * np.linalg.norm(points)


def test_a_ball_gives_one_of_its_many_reflections():
    ball = TriangleMesh(*icosphere(8))
    result = find_symmetry(ball, MatchSettings(points=30, samples=150))
    assert result.reverses_orientation
    assert result.asymmetry < 0.03
    moved = np.linalg.norm(result.source_points.positions - result.target_points.positions, axis=1)
    assert moved.mean() > 0.2


def test_only_the_largest_part_is_looked_at_and_the_result_says_so(posed_body, result):
    mesh = posed_body[0]
    ball, faces = icosphere(3, radius=0.1)
    both = TriangleMesh(np.concatenate([ball + 5, mesh.vertices]), np.concatenate([faces, mesh.triangles + len(ball)]))
    other = find_symmetry(both, QUICK)
    np.testing.assert_array_equal(
        other.target_points.nearest_vertices - len(ball), result.target_points.nearest_vertices
    )
    assert np.isnan(other.sides[: len(ball)]).all()
    np.testing.assert_allclose(other.sides[len(ball) :], result.sides)
    np.testing.assert_allclose(other.axis_points.positions, result.axis_points.positions)
    assert "1 smaller part" in other.notes[0]


def test_progress_rises(watched):
    fractions = [report.fraction for report in watched[0]]
    assert len(watched[1].source_points) == QUICK.points
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1


def test_a_mesh_with_too_few_vertices_is_refused_in_words():
    with pytest.raises(MatchError, match="has only 12 vertices"):
        find_symmetry(TriangleMesh(*icosphere(1)), QUICK)


def test_every_even_or_odd_exchange_of_the_corners_of_a_tetrahedron_is_a_symmetry():
    corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    tetrahedron = TriangleMesh(corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    result = find_symmetry(tetrahedron, MatchSettings(points=4, coarse_points=3, coarse_candidates=4))
    assert result.asymmetry == pytest.approx(0, abs=1e-6)
    assert result.reverses_orientation
    assert result.involution == pytest.approx(0, abs=1e-6)
    images = result.target_points.nearest_vertices
    assert sorted(images.tolist()) == [0, 1, 2, 3]
    assert (images != result.source_points.nearest_vertices).any()


def test_how_far_twice_the_map_leads_is_that_of_the_map_that_is_returned(monkeypatch):
    seen = []

    def noting(source, target, images):
        seen.append(images)
        return curvature_agreement(source, target, images)

    monkeypatch.setattr(symmetry, "curvature_agreement", noting)
    shape = Shape(TriangleMesh(*mirrored_body(0.5, 8)[:2]))
    result = find_symmetry(shape)
    distances = shape.samples.distances
    twice = [distances[images[images], np.arange(len(images))].mean() for images in seen]
    assert result.involution in [pytest.approx(each, abs=1e-12) for each in twice]
