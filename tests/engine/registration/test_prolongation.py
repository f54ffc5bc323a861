# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of dense meshes from the match of coarse ones."""

from types import SimpleNamespace

import numpy as np
import pytest

from engine import SurfacePoints, TriangleMesh, run
from engine.mesh.closest_points import ClosestPoints
from engine.registration.prolongation import lift_steps
from engine.registration.untangling import flipped_triangles
from engine.shapes.proxy import Proxy, proxy_steps
from tests.shapes import creature, icosphere, permuted, plane, rotation

PROXY = 1500


class Dense:
    """A body in a pose, its positions at rest, which name its points, and its proxy."""

    def __init__(self, pose, resolution, turn=0.0):
        vertices, triangles, self.rest = creature(pose, resolution, turn)
        self.mesh = TriangleMesh(vertices, triangles)
        self.proxy = run(proxy_steps(self.mesh, PROXY))

    def proxy_rest(self):
        """Positions at rest of the proxy's vertices."""
        found = ClosestPoints(self.mesh).walk(self.proxy.mesh.vertices, self.proxy.vertices)
        return SurfacePoints.from_barycentric(self.mesh, found.triangles, found.barycentric).interpolate(self.rest)


@pytest.fixture(scope="module")
def source():
    return Dense(0.0, 40)


@pytest.fixture(scope="module")
def target():
    return Dense(0.8, 34, turn=0.4)


def bent(rest, target):
    """Where points known at rest are in the pose of a target: on its surface."""
    at_rest = TriangleMesh(target.rest, target.mesh.triangles)
    found = ClosestPoints(at_rest).nearest(rest)
    return SurfacePoints.from_barycentric(target.mesh, found.triangles, found.barycentric).positions


def assert_valid(points, mesh, count):
    assert len(points) == count
    assert (points.barycentric >= 0).all()
    np.testing.assert_allclose(points.barycentric.sum(axis=1), 1)
    np.testing.assert_array_equal(points.corners, mesh.triangles[points.triangles])


def stretch(points, mesh):
    """Length of each edge after the map by that before."""
    a, b = mesh.edges.T
    return np.linalg.norm(points.positions[a] - points.positions[b], axis=1) / mesh.edge_lengths


def flipped(points, source, target):
    return len(flipped_triangles(source, target, points.triangles, points.barycentric)) / source.triangle_count


def errors(points, source, target):
    """Distances at rest from where vertices are mapped to where they belong, in units of sqrt(area)."""
    return np.linalg.norm(points.interpolate(target.rest) - source.rest, axis=1) / np.sqrt(target.mesh.area)


def lifted_steps(source, registered, target, *, proxy_map=None, search=None):
    """Lift where the proxy was registered, to what is matched there, or else to what is nearest."""
    if proxy_map is None:
        proxy_map = ClosestPoints(target.proxy.mesh).nearest_vertices(registered)
    return lift_steps(
        source.mesh,
        source.proxy,
        registered,
        target.mesh,
        target_proxy=target.proxy,
        proxy_map=proxy_map,
        search=search or ClosestPoints(target.mesh),
    )


def lifted(*given, **options):
    return run(lifted_steps(*given, **options))


def for_itself(mesh):
    return SimpleNamespace(mesh=mesh, proxy=Proxy.identity(mesh))


def test_identity(source):
    points = lifted(source, source.proxy.mesh.vertices, source)
    assert_valid(points, source.mesh, source.mesh.vertex_count)
    moved = np.linalg.norm(points.positions - source.mesh.vertices, axis=1) / np.sqrt(source.mesh.area)
    assert moved.mean() < 3e-4
    assert moved.max() < 5e-3
    ratio = stretch(points, source.mesh)
    assert np.sqrt((ratio**2).mean()) == pytest.approx(1, abs=0.01)
    assert flipped(points, source.mesh, source.mesh) < 1e-3


def test_a_mesh_that_stands_for_itself_goes_where_it_was_registered():
    mesh = TriangleMesh(*icosphere(10))
    target = TriangleMesh(*permuted(*icosphere(14))[:2])
    found = ClosestPoints(target).nearest(mesh.vertices)
    wanted = SurfacePoints.from_barycentric(target, found.triangles, found.barycentric).positions
    points = lifted(for_itself(mesh), wanted, for_itself(target))
    np.testing.assert_allclose(points.positions, wanted, atol=1e-9)


def test_a_bend_is_recovered(source, target):
    registered = bent(source.proxy_rest(), target)
    points = lifted(source, registered, target)
    assert_valid(points, target.mesh, source.mesh.vertex_count)
    error = errors(points, source, target)
    assert error.mean() < 2e-3
    assert np.quantile(error, 0.99) < 0.01
    ratio = stretch(points, source.mesh)
    assert np.sqrt((ratio**2).mean()) < 1.1
    assert (ratio > 3).mean() < 2e-3
    assert (ratio < 0.05).mean() < 2e-3
    assert flipped(points, source.mesh, target.mesh) < 2e-3


def test_a_noisy_registration_does_not_make_the_map_blocky(source, target):
    noise = np.random.default_rng(0).normal(size=source.proxy.mesh.vertices.shape) * 0.003
    registered = bent(source.proxy_rest(), target) + noise * np.sqrt(target.mesh.area)
    points = lifted(source, registered, target)
    assert errors(points, source, target).mean() < 4e-3
    ratio = stretch(points, source.mesh)
    assert np.sqrt((ratio**2).mean()) < 1.15
    assert flipped(points, source.mesh, target.mesh) < 5e-3


@pytest.mark.parametrize(("dense", "coarse"), [(40, 12), (12, 40)])
def test_dense_against_coarse(dense, coarse):
    first, second = Dense(0.0, dense), Dense(0.8, coarse, turn=0.4)
    assert first.proxy.is_identity == (dense < coarse)
    assert second.proxy.is_identity == (dense > coarse)
    registered = bent(first.proxy_rest(), second)
    points = lifted(first, registered, second)
    assert_valid(points, second.mesh, first.mesh.vertex_count)
    # A coarse mesh is no nearer to the surface than its own edges tell.
    assert errors(points, first, second).mean() < 8e-3
    assert np.sqrt((stretch(points, first.mesh) ** 2).mean()) < 1.15
    assert flipped(points, first.mesh, second.mesh) < 0.01


def test_a_moved_and_scaled_target_gets_the_same_map(source, target):
    registered = bent(source.proxy_rest(), target)
    first = lifted(source, registered, target)
    turn = rotation([1, 2, -1], 0.9).T * 100
    moved = TriangleMesh(target.mesh.vertices @ turn + [10, -20, 5], target.mesh.triangles)
    moved = SimpleNamespace(mesh=moved, proxy=run(proxy_steps(moved, PROXY)))
    second = lifted(source, registered @ turn + [10, -20, 5], moved)
    far = np.linalg.norm(second.interpolate(target.mesh.vertices) - first.positions, axis=1)
    assert np.quantile(far, 0.999) < 1e-4


def test_the_order_of_the_target_does_not_matter(source, target):
    registered = bent(source.proxy_rest(), target)
    first = lifted(source, registered, target)
    other = TriangleMesh(*permuted(target.mesh.vertices, target.mesh.triangles)[:2])
    second = lifted(source, registered, SimpleNamespace(mesh=other, proxy=run(proxy_steps(other, PROXY))))
    assert np.quantile(np.linalg.norm(second.positions - first.positions, axis=1), 0.999) < 1e-4


def test_a_search_can_be_shared_and_the_map_is_reproducible(source, target):
    registered = bent(source.proxy_rest(), target)
    search = ClosestPoints(target.mesh)
    first, second = (lifted(source, registered, target, search=search) for _ in range(2))
    np.testing.assert_array_equal(first.triangles, second.triangles)
    np.testing.assert_array_equal(first.barycentric, second.barycentric)


def rolled(part, layers=3, gap=0.06):
    """Sheet rolled up to a spiral: points (x in 0..1, y) to layers that face the same way."""
    angle = 2 * np.pi * layers * np.sqrt(part[:, 0] + 0.1)
    radius = 0.2 + gap * angle / (2 * np.pi)
    return np.stack([radius * np.cos(angle), part[:, 1] * 0.5, radius * np.sin(angle)], axis=1)


def test_by_the_map_of_the_proxies_surfaces_close_in_space_are_not_confused():
    vertices, triangles = plane(60)
    sheet = TriangleMesh(rolled(vertices), triangles)
    # Laid a little nearer to the next layer.
    away = 0.033 * sheet.vertices * [1, 0, 1]
    away /= np.linalg.norm(sheet.vertices * [1, 0, 1], axis=1, keepdims=True)
    registered = sheet.vertices + away
    roll = for_itself(sheet)
    misled = lifted(roll, registered, roll)
    led = lifted(roll, registered, roll, proxy_map=np.arange(sheet.vertex_count))
    wrong = [np.linalg.norm(points.interpolate(vertices) - vertices, axis=1) > 0.15 for points in (misled, led)]
    assert wrong[0].mean() > 0.2
    assert wrong[1].mean() < 0.01


def test_progress_grows(source):
    fractions = [p.fraction for p in lifted_steps(source, source.proxy.mesh.vertices, source)]
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] <= 1
