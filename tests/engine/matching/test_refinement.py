# SPDX-License-Identifier: GPL-3.0-or-later
"""A dense map made better around landmarks."""

from __future__ import annotations

import numpy as np
import pytest

from engine import GeodesicSolver, MatchError, MeshError, SurfaceMap, SurfacePoints, TriangleMesh
from engine.matching.refinement import distortion_after, placed_by_map, point_distortions, refine_map
from tests.shapes import creature, icosphere, posed


@pytest.fixture(scope="module")
def pair():
    """A creature in two poses: its vertices correspond."""
    _, triangles, rest = creature(0.0, 9)
    return TriangleMesh(posed(rest, 0.0), triangles), TriangleMesh(posed(rest, 0.6), triangles)


def identity(mesh):
    return SurfaceMap.identity(mesh)


def slid(mesh, amount):
    """Take each vertex to a place beside it, the same way all around."""
    moved = mesh.vertices + amount * np.sqrt(mesh.area) * np.array([0.6, 0.8, 0.0])
    nearest = np.square(mesh.vertices[:, None] - moved[None]).sum(axis=2).argmin(axis=0)
    return SurfaceMap.from_points(mesh, SurfacePoints.at_vertices(mesh, nearest))


def errors(found, mesh):
    return np.linalg.norm(found.positions - mesh.vertices, axis=1) / np.sqrt(mesh.area)


def spread(mesh, count):
    chosen = [0]
    for _ in range(count - 1):
        away = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[chosen], axis=2).min(axis=1)
        chosen.append(int(away.argmax()))
    return np.array(chosen)


@pytest.fixture(scope="module")
def refined(pair):
    places = spread(pair[0], 8)
    return places, refine_map(*pair, slid(pair[1], 0.04), np.column_stack([places, places]))


def test_landmarks_are_exact_both_ways(pair, refined):
    places, dense = refined
    assert dense.source_to_target.positions[places] == pytest.approx(pair[1].vertices[places])
    assert dense.target_to_source.positions[places] == pytest.approx(pair[0].vertices[places])


def test_a_map_that_is_off_comes_nearer_to_the_truth(pair, refined):
    before, after = errors(slid(pair[1], 0.04), pair[1]), errors(refined[1].source_to_target, pair[1])
    assert np.median(after) < 0.5 * np.median(before)
    assert refined[1].quality.orientation > 0.95


def test_a_good_map_stays_good(pair):
    places = spread(pair[0], 3)
    dense = refine_map(*pair, identity(pair[1]), np.column_stack([places, places]))
    assert np.median(errors(dense.source_to_target, pair[1])) < 0.01
    assert dense.quality.confidence > 0.8


def test_a_mirrored_map_stays_one(pair):
    source = pair[0]
    mirror = TriangleMesh(source.vertices * [1, -1, 1], source.triangles[:, ::-1])
    places = spread(source, 3)
    dense = refine_map(source, mirror, identity(mirror), np.column_stack([places, places]))
    assert dense.source_to_target.orientation(source, mirror) < -0.95
    assert np.median(errors(dense.source_to_target, mirror)) < 0.01


def test_no_landmarks(pair):
    with pytest.raises(MatchError, match="no landmarks to refine"):
        refine_map(*pair, identity(pair[1]), np.empty((0, 2), int))


def test_landmarks_that_cannot_be(pair):
    with pytest.raises(MatchError, match="no such vertex"):
        refine_map(*pair, identity(pair[1]), [[0, 10**6]])


def test_what_is_no_surface_and_maps_of_other_meshes_are_refused(pair):
    few, own = identity(TriangleMesh(np.eye(3), [[0, 1, 2]])), identity(pair[1])
    with pytest.raises(MatchError, match="one of 3 vertices"):
        refine_map(*pair, own, [[0, 0]], target_to_source=few)
    with pytest.raises(MeshError, match="target is of the type ndarray"):
        refine_map(pair[0], pair[1].vertices, own, [[0, 0]])


class TestDistortions:
    def test_none_for_a_scaled_copy(self):
        ball = TriangleMesh(*icosphere(6))
        vertices = np.arange(0, ball.vertex_count, 9)
        large = TriangleMesh(64 * ball.vertices, ball.triangles)
        assert point_distortions(ball, large, vertices, vertices) == pytest.approx(0, abs=1e-6)

    def test_the_wrong_one_stands_out(self):
        ball = TriangleMesh(*icosphere(6))
        vertices = np.arange(0, ball.vertex_count, 9)
        wrong = vertices.copy()
        away = np.linalg.norm(ball.vertices - ball.vertices[wrong[5]], axis=1)
        wrong[5] = int(away.argmax())
        found = point_distortions(ball, ball, vertices, wrong)
        assert found.argmax() == 5
        assert found[5] > 2 * np.delete(found, 5).max()

    def test_what_is_on_a_piece_beside_the_main_part_is_measured_from_next_to_it(self):
        ball = TriangleMesh(*icosphere(6))
        vertices = np.arange(0, ball.vertex_count, 9)
        bead, triangles = icosphere(1)
        bead = 0.02 * bead + 1.03 * ball.vertices[vertices[5]]
        both = TriangleMesh(
            np.concatenate([ball.vertices, bead]), np.concatenate([ball.triangles, triangles + len(ball.vertices)])
        )
        images = vertices.copy()
        images[5] = ball.vertex_count + 3
        assert point_distortions(ball, both, vertices, images).max() < 0.02
        assert point_distortions(both, ball, images, vertices).max() < 0.02

    @pytest.mark.parametrize(("count", "error"), [(20, 1e-6), (140, 0.15)])
    def test_it_is_the_root_mean_square_over_the_others_or_a_spread_part_of_them(self, count, error):
        ball, random = TriangleMesh(*icosphere(6)), np.random.default_rng(0)
        large = TriangleMesh(5 * ball.vertices, ball.triangles)
        vertices, images = (random.choice(ball.vertex_count, count, replace=False) for _ in range(2))
        rows = [
            GeodesicSolver(mesh).distances(chosen)[:, chosen] / np.sqrt(mesh.area)
            for mesh, chosen in ((ball, vertices), (large, images))
        ]
        expected = np.sqrt(np.square(rows[0] - rows[1]).sum(axis=0) / (count - 1))
        found = point_distortions(ball, large, vertices, images)
        np.testing.assert_allclose(found, expected, rtol=2 * error)
        assert found.mean() == pytest.approx(expected.mean(), rel=error)

    def test_one_point(self):
        ball = TriangleMesh(*icosphere(3))
        assert point_distortions(ball, ball, [3], [4]).tolist() == [0.0]


class TestPlacedByMap:
    """Matched points follow a map."""

    def test_points_lie_where_the_map_takes_them(self):
        ball = TriangleMesh(*icosphere(5))
        points = SurfacePoints.at_vertices(ball, spread(ball, 8))
        images, distortion = placed_by_map(ball, ball, points, identity(ball))
        np.testing.assert_allclose(images.positions, points.positions)
        np.testing.assert_allclose(distortion, 0, atol=1e-6)
        images, distortion = placed_by_map(ball, ball, points, slid(ball, 0.1))
        assert np.linalg.norm(images.positions - points.positions, axis=1).min() > 0.05 * np.sqrt(ball.area)
        assert distortion.max() > 0

    def test_the_distortion_of_the_whole_is_made_of_squares(self):
        assert distortion_after(4.0, np.array([1.0, 1.0]), np.array([0.5, 0.5])) == pytest.approx(1.0)
        assert distortion_after(4.0, np.zeros(2), np.ones(2)) == 4.0
