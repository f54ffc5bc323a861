# SPDX-License-Identifier: GPL-3.0-or-later
"""What one surface has and another lacks, told by maps that are known."""

import numpy as np
import pytest

from engine import ClosestPoints, SurfacePoints, TriangleMesh
from engine.dense.missing_parts import round_trips, with_partner
from tests.shapes import compacted, icosphere, plane, rotation


def at(mesh, vertices=None):
    return SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count) if vertices is None else vertices)


def nearest_on(mesh, positions):
    found = ClosestPoints(mesh).nearest(positions)
    return SurfacePoints.from_barycentric(mesh, found.triangles, found.barycentric)


def cut_square(square, end=0.5):
    """Keep the part of a square with x up to an end."""
    kept = (square.vertices[square.triangles][:, :, 0] <= end + 1e-9).all(axis=1)
    return TriangleMesh(*compacted(square.vertices, square.triangles[kept]))


def without_cap(ball, share):
    """Cut a cap of this share of its area off a sphere: the rest, and how deep each vertex was in the cap, (n,)."""
    depth = ball.vertices[:, 2] - (1 - 2 * share)
    return TriangleMesh(*compacted(ball.vertices, ball.triangles[(depth[ball.triangles] <= 0).all(axis=1)])), depth


@pytest.fixture(scope="module")
def ball():
    return TriangleMesh(*icosphere(16))


@pytest.fixture(scope="module")
def square():
    return TriangleMesh(*plane(21))


def test_round_trips_are_distances_from_home():
    ball = TriangleMesh(*icosphere(6))
    random = np.random.default_rng(3)
    target = TriangleMesh(*icosphere(4, 2.0))
    there = SurfacePoints.from_barycentric(
        target,
        random.integers(0, target.triangle_count, ball.vertex_count),
        random.dirichlet(np.ones(3), ball.vertex_count),
    )
    back = SurfacePoints.from_barycentric(
        ball,
        random.integers(0, ball.triangle_count, target.vertex_count),
        random.dirichlet(np.ones(3), target.vertex_count),
    )
    expected = [
        np.linalg.norm(sum(w * back.positions[c] for w, c in zip(weights, corners, strict=True)) - home)
        for weights, corners, home in zip(there.barycentric, there.corners, ball.vertices, strict=True)
    ]
    np.testing.assert_allclose(round_trips(ball, there, back), expected)


def test_what_the_target_lacks_has_no_partner(square):
    half = cut_square(square)
    there, back = nearest_on(half, square.vertices), nearest_on(square, half.vertices)
    missing = square.vertices[:, 0] > 0.5 + 4 / 20
    known = with_partner(square, half, there, back)
    assert not known[missing].any()
    assert known[square.vertices[:, 0] < 0.5 - 1 / 20].all()
    assert with_partner(half, square, back, there).all()


def test_a_surface_misses_nothing_of_itself(square):
    assert with_partner(square, square, at(square), at(square)).all()


@pytest.mark.parametrize("angle", [0.1, 0.3, 1.0])
def test_maps_that_disagree_miss_nothing(ball, angle):
    """One of them turns the sphere: the way back leads home nowhere but at the poles, yet all of it is reached."""
    back = nearest_on(ball, ball.vertices @ rotation([0, 0, 1], angle).T)
    assert with_partner(ball, ball, at(ball), back).all()


@pytest.mark.parametrize("share", [0.02, 0.05, 0.2])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_a_small_part_that_is_cut_off(share, size):
    """A cap of a sphere; what is missing ends at most three spacings from the cut."""
    ball = TriangleMesh(size * icosphere(20)[0], icosphere(20)[1])
    rest, depth = without_cap(TriangleMesh(ball.vertices / size, ball.triangles), share)
    rest = TriangleMesh(size * rest.vertices, rest.triangles)
    known = with_partner(ball, rest, nearest_on(rest, ball.vertices), nearest_on(ball, rest.vertices))
    assert known[depth <= 0].all()
    assert not known[depth.argmax()]
    angles = np.arccos(np.clip(ball.vertices[:, 2] / size, -1, 1))
    spacing = np.sqrt(4 * np.pi / ball.vertex_count)
    assert not known[angles < np.arccos(1 - 2 * share) - 3 * spacing].any()


@pytest.mark.parametrize("size", [1e-3, 1e3])
def test_the_unit_of_length_does_not_matter(ball, size):
    rest, _ = without_cap(ball, 0.2)
    there, back = nearest_on(rest, ball.vertices), nearest_on(ball, rest.vertices)
    known = with_partner(ball, rest, there, back)
    sized = [TriangleMesh(size * mesh.vertices, mesh.triangles) for mesh in (ball, rest)]
    points = [
        SurfacePoints.from_barycentric(mesh, found.triangles, found.barycentric)
        for mesh, found in zip(sized[::-1], (there, back), strict=True)
    ]
    np.testing.assert_array_equal(with_partner(*sized, *points), known)


@pytest.mark.parametrize("parts", [4, 10, 30, 46])
def test_it_does_not_depend_on_how_finely_the_other_is_meshed(ball, parts):
    """However few vertices the other sphere has, nothing is missing; without a fifth of it, that is."""
    other = TriangleMesh(*icosphere(parts))
    back = nearest_on(ball, other.vertices)
    assert with_partner(ball, other, nearest_on(other, ball.vertices), back).all()
    rest, _ = without_cap(other, 0.2)
    known = with_partner(ball, rest, nearest_on(rest, ball.vertices), nearest_on(ball, rest.vertices))
    assert 0.1 < np.average(~known, weights=ball.vertex_areas) < 0.35
