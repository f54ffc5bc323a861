# SPDX-License-Identifier: GPL-3.0-or-later
"""Coarse stand-ins for dense meshes."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from engine import TriangleMesh, run
from engine.geometry.eigenpairs import eigenpairs_steps
from engine.repair.cleaning import clean
from engine.shapes.proxy import Proxy, coarse_mesh_steps, proxy_steps
from tests.bodies import mirrored_body
from tests.shapes import (
    compacted,
    creature,
    cylinder,
    icosphere,
    irregular,
    permuted,
    plane,
    plane_with_hole,
    plane_with_slit,
    rotation,
    subdivided,
    torus,
)
from tests.steps import followed


def characteristic(mesh):
    return len(np.unique(mesh.triangles)) - len(mesh.edges) + mesh.triangle_count


def loop_count(mesh):
    ends = mesh.boundary_edges
    if not len(ends):
        return 0
    graph = coo_array((np.ones(len(ends)), ends.T), shape=(mesh.vertex_count,) * 2)
    return len(np.unique(connected_components(graph, directed=False)[1][ends[:, 0]]))


def assert_manifold(mesh):
    """Each half-edge once, the triangles around each vertex one fan, every vertex used."""
    tail, head = mesh.triangles.ravel(), np.roll(mesh.triangles, -1, axis=1).ravel()
    assert len(np.unique(tail * mesh.vertex_count + head)) == len(tail)
    for vertex in range(mesh.vertex_count):
        around = mesh.triangles[(mesh.triangles == vertex).any(axis=1)]
        assert len(around)
        link = np.array([np.roll(triangle, -list(triangle).index(vertex))[1:] for triangle in around])
        names, ends = np.unique(link, return_inverse=True)
        ends = ends.reshape(-1, 2)
        graph = coo_array((np.ones(len(ends)), ends.T), shape=(len(names),) * 2)
        assert connected_components(graph, directed=False)[0] == 1


def assert_valid(proxy, mesh):
    """The proxy is a manifold, and what it says of the mesh is true."""
    assert_manifold(proxy.mesh)
    points = proxy.points
    assert len(points) == mesh.vertex_count
    assert (points.barycentric >= 0).all()
    np.testing.assert_allclose(points.barycentric.sum(axis=1), 1)
    np.testing.assert_array_equal(points.corners, proxy.mesh.triangles[points.triangles])
    assert len(np.unique(proxy.vertices)) == proxy.mesh.vertex_count == len(proxy.vertices)
    assert proxy.vertices.min() >= 0
    assert proxy.vertices.max() < mesh.vertex_count


def distances(proxy, mesh):
    """From the vertices of the mesh to their places on the proxy, in units of sqrt(area)."""
    return np.linalg.norm(proxy.points.positions - mesh.vertices, axis=1) / np.sqrt(mesh.area)


@pytest.fixture(scope="module")
def body():
    return TriangleMesh(*creature(0.5, 36)[:2])


@pytest.fixture(scope="module")
def body_proxy(body):
    return run(proxy_steps(body, 1000))


SHAPES = {
    "sphere": icosphere(28),
    "torus": torus(160, 50),
    "thin torus": torus(400, 20, thickness=0.02),
    "plane": plane(80),
    "hole": plane_with_hole(80),
    "slit": plane_with_slit(80),
    "cylinder": cylinder(120, 60),
    "ribbon": cylinder(600, 8, height=0.05),
}


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("count", [150, 600])
def test_topology_and_boundaries_survive(name, count):
    mesh = TriangleMesh(*SHAPES[name])
    proxy = run(proxy_steps(mesh, count))
    assert_valid(proxy, mesh)
    assert characteristic(proxy.mesh) == characteristic(mesh)
    assert loop_count(proxy.mesh) == loop_count(mesh)
    assert proxy.mesh.component_count == 1
    # Thin shapes need more.
    assert 0.85 * count < proxy.mesh.vertex_count
    if name not in {"thin torus", "ribbon"}:
        assert proxy.mesh.vertex_count < 1.25 * count


@pytest.mark.parametrize("name", ["plane", "hole", "slit", "cylinder"])
def test_open_surfaces_keep_their_area(name):
    mesh = TriangleMesh(*SHAPES[name])
    assert run(proxy_steps(mesh, 600)).mesh.area == pytest.approx(mesh.area, rel=1e-2)


def test_the_fit_keeps_area_and_volume():
    mesh = TriangleMesh(*SHAPES["sphere"])
    proxy = run(proxy_steps(mesh, 400))
    a, b, c = proxy.mesh.vertices[proxy.mesh.triangles].transpose(1, 0, 2)
    assert np.einsum("ij,ij->", np.cross(a, b), c) / 6 == pytest.approx(4 / 3 * np.pi, rel=0.005)
    assert proxy.mesh.area == pytest.approx(4 * np.pi, rel=0.005)
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a) > 0).all()


def test_a_body(body, body_proxy):
    assert_valid(body_proxy, body)
    assert characteristic(body_proxy.mesh) == 2
    assert 850 < body_proxy.mesh.vertex_count < 1150
    assert distances(body_proxy, body).mean() < 1e-3
    assert distances(body_proxy, body).max() < 1e-2
    steps = body.vertices[body_proxy.vertices] - body_proxy.mesh.vertices
    assert np.linalg.norm(steps, axis=1).max() < 0.015 * np.sqrt(body.area)
    # Each place is in the proxy's sheet that faces the same way.
    normals = body_proxy.mesh.triangle_normals[body_proxy.points.triangles]
    assert (np.einsum("ij,ij->i", normals, body.vertex_normals) > 0).mean() > 0.995


def test_the_spectrum_is_that_of_the_mesh(body):
    proxy = run(proxy_steps(body, 2000))
    dense, coarse = (run(eigenpairs_steps(mesh, 25)).values[1:] for mesh in (body, proxy.mesh))
    error = abs(coarse / dense - 1)
    assert error.mean() < 0.02
    assert error.max() < 0.05


def test_the_order_of_the_vertices_does_not_matter():
    vertices, triangles = creature(0.0, 20)[:2]
    mesh = TriangleMesh(vertices, triangles)
    shuffled, turned, new = permuted(vertices, triangles)
    first = run(proxy_steps(mesh, 400))
    again = run(proxy_steps(TriangleMesh(shuffled, turned), 400))
    assert again.mesh.vertex_count == first.mesh.vertex_count
    order, other = (np.lexsort(np.round(mesh.vertices, 6).T) for mesh in (first.mesh, again.mesh))
    np.testing.assert_allclose(again.mesh.vertices[other], first.mesh.vertices[order], atol=1e-9)
    np.testing.assert_allclose(again.points.positions[new], first.points.positions, atol=1e-7)


def test_scale_and_place_do_not_matter():
    mesh = TriangleMesh(*creature(0.0, 18)[:2])
    scaled = TriangleMesh(mesh.vertices / 1024, mesh.triangles)
    first, second = (run(proxy_steps(m, 400)) for m in (mesh, scaled))
    np.testing.assert_array_equal(second.mesh.triangles, first.mesh.triangles)
    np.testing.assert_allclose(second.mesh.vertices * 1024, first.mesh.vertices, rtol=1e-9)
    np.testing.assert_array_equal(second.vertices, first.vertices)


def test_a_turned_mesh_has_as_good_a_proxy(body, body_proxy):
    turned = TriangleMesh(body.vertices @ rotation([1, -2, 0.5], 1.1).T + [5, 0, 0], body.triangles)
    proxy = run(proxy_steps(turned, 1000))
    assert_valid(proxy, turned)
    assert proxy.mesh.vertex_count == pytest.approx(body_proxy.mesh.vertex_count, rel=0.05)
    assert distances(proxy, turned).mean() == pytest.approx(distances(body_proxy, body).mean(), rel=0.1)


def test_the_resolution_does_not_matter(body, body_proxy):
    finer = TriangleMesh(*subdivided(body.vertices, body.triangles, 2))
    proxy = run(proxy_steps(finer, 1000))
    assert_valid(proxy, finer)
    assert proxy.mesh.vertex_count == pytest.approx(body_proxy.mesh.vertex_count, rel=0.1)
    assert distances(proxy, finer).mean() == pytest.approx(distances(body_proxy, body).mean(), rel=0.15)


@pytest.mark.parametrize("spoil", ["needles", "uneven"])
def test_bad_triangles_do_not_matter(spoil):
    vertices, triangles = creature(0.5, 24)[:2]
    if spoil == "needles":
        mesh = TriangleMesh(*irregular(vertices, triangles, rounds=3))
    else:  # one side of the body ten times as dense
        dense = vertices[triangles].mean(axis=1)[:, 0] > 0.6
        for _ in range(4):
            centres = vertices[triangles[dense]].mean(axis=1)
            new = len(vertices) + np.arange(len(centres))
            a, b, c = triangles[dense].T
            pieces = [np.stack(corners, axis=1) for corners in ((a, b, new), (b, c, new), (c, a, new))]
            vertices, triangles = np.concatenate([vertices, centres]), np.concatenate([triangles[~dense], *pieces])
            dense = vertices[triangles].mean(axis=1)[:, 0] > 0.6
        mesh = TriangleMesh(vertices, triangles)
    proxy = run(proxy_steps(mesh, 800))
    assert_valid(proxy, mesh)
    assert characteristic(proxy.mesh) == 2
    assert 650 < proxy.mesh.vertex_count < 1000
    assert distances(proxy, mesh).mean() < 2e-3


def test_a_cut_limb_stays_open_and_small_holes_are_closed(body):
    centres = body.vertices[body.triangles].mean(axis=1)
    cut = centres[:, 2] > -0.6
    lost = np.random.default_rng(0).random(body.triangle_count) < 0.002
    mesh = TriangleMesh(*compacted(body.vertices, body.triangles[cut & ~lost]))
    cleaned = clean(mesh).mesh
    proxy = run(proxy_steps(cleaned, 1000))
    assert_valid(proxy, cleaned)
    assert loop_count(mesh) > 20
    assert loop_count(proxy.mesh) == loop_count(TriangleMesh(*compacted(body.vertices, body.triangles[cut])))


def test_holes_that_are_not_small_stay():
    vertices, triangles = plane(101)
    centres = vertices[triangles].mean(axis=1)[:, :2]
    far = np.ones(len(triangles), bool)
    for x in (0.25, 0.5, 0.75):
        for y in (0.25, 0.5, 0.75):
            far &= abs(centres - [x, y]).max(axis=1) > 0.04
    mesh = TriangleMesh(*compacted(vertices, triangles[far]))
    proxy = run(proxy_steps(mesh, 500))
    assert_valid(proxy, mesh)
    assert loop_count(proxy.mesh) == loop_count(mesh) == 10


def test_fingers_that_touch_stay_apart():
    vertices, triangles = icosphere(24)
    stretched = vertices * [0.2, 0.2, 1.0]
    beside = np.array([0.401, 0, 0])
    pair = TriangleMesh(
        np.concatenate([stretched, stretched + beside]),
        np.concatenate([triangles, triangles + len(vertices)]),
    )
    proxy = run(proxy_steps(pair, 400))
    assert_valid(proxy, pair)
    assert proxy.mesh.component_count == 2
    assert characteristic(proxy.mesh) == 4
    parts = proxy.mesh.component_labels
    own = parts[proxy.points.nearest_vertices]
    assert len(np.unique(own[: len(vertices)])) == len(np.unique(own[len(vertices) :])) == 1


def test_a_tiny_handle_survives():
    # A handle a hundredth of the sphere wide, much smaller than a cell.
    vertices, triangles = icosphere(30)
    centres = vertices[triangles].mean(axis=1)
    first = int(np.argmax(centres[:, 2]))
    ring = np.isin(triangles, triangles[first]).any(axis=1)
    near = np.isin(triangles, triangles[ring]).any(axis=1)
    second = int(np.where(near, np.inf, np.linalg.norm(centres - centres[first], axis=1)).argmin())
    top, bottom = triangles[first], triangles[second][::-1]
    sides = []
    for i in range(3):
        a, b, c, d = top[i], top[(i + 1) % 3], bottom[i], bottom[(i + 1) % 3]
        sides += [(a, b, c), (b, d, c)]
    rest = np.delete(triangles, [first, second], axis=0)
    mesh = TriangleMesh(vertices, np.concatenate([rest, sides]))
    assert mesh.is_closed
    assert characteristic(mesh) == 0
    proxy = run(proxy_steps(mesh, 300))
    assert_valid(proxy, mesh)
    assert characteristic(proxy.mesh) == 0


def test_what_is_no_manifold_gives_a_manifold_all_the_same():
    vertices, triangles = creature(0.0, 24)[:2]
    random = np.random.default_rng(1)
    glued = np.arange(len(vertices))
    glued[random.permutation(len(vertices))[:12]] = random.permutation(len(vertices))[:12]
    broken = glued[triangles]
    broken = broken[(broken != np.roll(broken, 1, axis=1)).all(axis=1)]
    turned = random.random(len(broken)) < 0.01
    mesh = TriangleMesh(*compacted(vertices, np.where(turned[:, None], broken[:, ::-1], broken)))
    proxy = run(proxy_steps(mesh, 600))
    assert_valid(proxy, mesh)
    assert proxy.mesh.component_count == 1
    assert proxy.mesh.area > 0.8 * mesh.area


def test_small_meshes_stand_for_themselves():
    mesh = TriangleMesh(*mirrored_body(0.3, 11)[:2])
    proxy = run(proxy_steps(mesh))
    assert proxy.is_identity
    assert proxy.mesh is mesh
    np.testing.assert_array_equal(proxy.vertices, np.arange(mesh.vertex_count))
    np.testing.assert_array_equal(proxy.points.nearest_vertices, np.arange(mesh.vertex_count))
    np.testing.assert_allclose(proxy.points.positions, mesh.vertices)
    assert Proxy.identity(mesh).is_identity


def test_proxies_are_reproducible_and_report_progress(body, body_proxy):
    reports, again = followed(proxy_steps(body, 1000))
    fractions = [report.fraction for report in reports]
    np.testing.assert_array_equal(again.mesh.triangles, body_proxy.mesh.triangles)
    np.testing.assert_array_equal(again.mesh.vertices, body_proxy.mesh.vertices)
    np.testing.assert_array_equal(again.vertices, body_proxy.vertices)
    assert not again.is_identity
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] <= 1


@pytest.mark.parametrize("vertices", [300, 5000])
def test_the_coarse_mesh_alone_is_that_of_the_proxy(vertices):
    mesh = TriangleMesh(*irregular(*icosphere(14), seed=1))
    alone, whole = run(coarse_mesh_steps(mesh, vertices)), run(proxy_steps(mesh, vertices)).mesh
    assert np.array_equal(alone.vertices, whole.vertices)
    assert np.array_equal(alone.triangles, whole.triangles)
