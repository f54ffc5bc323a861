# SPDX-License-Identifier: GPL-3.0-or-later
"""From a mesh to what is matched of it, and back."""

from copy import deepcopy

import numpy as np
import pytest

from engine import MatchError, SurfacePoints, TriangleMesh, run
from engine.shapes.prepared_surface import prepared_steps
from tests.messes import in_pieces, partly_turned, together, without_disc
from tests.shapes import compacted, creature, cylinder, icosphere, permuted, subdivided


def prepared(mesh, **options):
    return run(prepared_steps(mesh, **options))


def random_points(mesh, count=200, seed=0):
    random = np.random.default_rng(seed)
    triangles = random.choice(mesh.triangle_count, count, p=mesh.triangle_areas / mesh.area)
    return SurfacePoints.from_barycentric(mesh, triangles, random.dirichlet(np.ones(3), count))


def assert_valid(points, mesh):
    assert points.barycentric.min() >= 0
    np.testing.assert_allclose(points.barycentric.sum(axis=1), 1)
    np.testing.assert_array_equal(points.corners, mesh.triangles[points.triangles])


@pytest.fixture(scope="module")
def body():
    return TriangleMesh(*creature(0.4, 9)[:2])


@pytest.fixture(scope="module")
def dense():
    """A mesh of some thousand vertices, and what stands for it."""
    mesh = TriangleMesh(*subdivided(*creature(0.4, 9, turn=0.7)[:2], 2))
    return prepared(mesh, proxy_vertices=600)


def test_a_clean_mesh_is_matched_as_it_is(body):
    surface = prepared(body)
    assert surface.is_whole
    assert surface.mesh is body
    assert not surface.cleaned.notes
    np.testing.assert_array_equal(surface.vertices, np.arange(body.vertex_count))
    np.testing.assert_array_equal(surface.kept_triangles, np.arange(body.triangle_count))
    points = random_points(body)
    for there in (surface.on_original(points), surface.on_mesh(points)):
        np.testing.assert_allclose(there.positions, points.positions, atol=1e-9)
    values = np.random.default_rng(0).normal(size=(3, body.vertex_count))
    np.testing.assert_array_equal(surface.spread(values, np.inf), values)


def test_what_was_prepared_in_another_process_keeps_no_second_mesh(body, dense):
    for surface in (prepared(body), dense):
        original = surface.original
        sent = deepcopy(surface)
        assert sent.original is not original
        same = sent.of_same(original)
        assert same.original is same.cleaned.original is same.cleaned.mesh is original
        assert (same.mesh is original) == surface.is_whole
        np.testing.assert_array_equal(same.vertices, surface.vertices)


def test_only_what_takes_part_of_a_mesh_is_kept_beside_it(body):
    excluded = body.vertices[:, 2] > np.median(body.vertices[:, 2])
    surface = prepared(body, excluded=excluded)
    same = deepcopy(surface).of_same(body)
    assert same.original is body
    assert same.cleaned.original.triangle_count == len(surface.kept_triangles) < body.triangle_count
    np.testing.assert_array_equal(same.vertices, surface.vertices)


def test_a_dense_mesh_is_matched_through_a_coarse_one(dense):
    original, mesh = dense.original, dense.mesh
    assert not dense.is_whole
    assert not dense.proxy.is_identity
    assert 400 < mesh.vertex_count < 0.5 * original.vertex_count
    size = np.sqrt(original.area)
    assert np.linalg.norm(original.vertices[dense.vertices] - mesh.vertices, axis=1).max() < 0.06 * size
    assert len(np.unique(dense.vertices)) == mesh.vertex_count


def test_points_go_from_the_coarse_mesh_to_the_dense_one_and_back(dense):
    points = random_points(dense.mesh)
    there = dense.on_original(points)
    assert_valid(there, dense.original)
    size = np.sqrt(dense.original.area)
    gaps = np.linalg.norm(there.positions - points.positions, axis=1) / size
    assert gaps.mean() < 0.01
    assert gaps.max() < 0.05
    home = dense.on_mesh(there)
    assert_valid(home, dense.mesh)
    assert np.linalg.norm(home.positions - points.positions, axis=1).max() < 0.05 * size


def test_linear_functions_are_spread_over_the_dense_mesh(dense):
    spread = dense.spread(dense.mesh.vertices.T, np.nan).T
    assert spread.shape == dense.original.vertices.shape
    assert np.linalg.norm(spread - dense.original.vertices, axis=1).max() < 0.06 * np.sqrt(dense.original.area)
    np.testing.assert_allclose(dense.spread(np.ones(dense.mesh.vertex_count), 0), 1)


def test_vertices_go_to_the_nearest_of_the_coarse_mesh(dense):
    chosen = np.arange(0, dense.original.vertex_count, 37)
    gaps = dense.mesh.vertices[dense.mesh_vertices(chosen)] - dense.original.vertices[chosen]
    assert np.linalg.norm(gaps, axis=1).max() < 1.5 * dense.mesh.edge_lengths.max()


def test_excluded_vertices_take_no_part(body):
    excluded = body.vertices[:, 2] < -0.6
    surface = prepared(body, excluded=excluded)
    assert not surface.is_whole
    assert not excluded[body.triangles[surface.kept_triangles]].any()
    without = np.setdiff1d(np.arange(body.triangle_count), surface.kept_triangles)
    assert excluded[body.triangles[without]].any(axis=1).all()
    kept = np.flatnonzero(~excluded)
    np.testing.assert_allclose(surface.mesh.vertices[surface.mesh_vertices(kept)], body.vertices[kept])
    there = surface.on_original(random_points(surface.mesh))
    assert_valid(there, body)
    assert set(there.triangles) <= set(surface.kept_triangles)
    assert np.isinf(surface.spread(np.zeros(surface.mesh.vertex_count), np.inf)[excluded]).all()
    with pytest.raises(MatchError, match="do not lie on the main part"):
        surface.mesh_vertices(np.flatnonzero(excluded)[:1])


@pytest.mark.parametrize("is_dense", [False, True])
def test_where_something_was_left_out_the_surface_was_cut_and_not_where_it_ends(body, dense, is_dense):
    whole = dense.original if is_dense else body
    tail, nose = whole.vertices[:, 2] < -0.6, whole.vertices[:, 2] > np.quantile(whole.vertices[:, 2], 0.95)
    open_mesh = TriangleMesh(*compacted(whole.vertices, whole.triangles[~nose[whole.triangles].any(axis=1)]))
    assert not prepared(open_mesh).cut_border(prepared(open_mesh).mesh).any()
    surface = prepared(open_mesh, excluded=open_mesh.vertices[:, 2] < -0.6, proxy_vertices=600 if is_dense else 5000)
    cut = surface.cut_border(surface.mesh)
    assert tail.any()
    border = np.unique(surface.mesh.boundary_edges)
    expected = border[surface.mesh.vertices[border, 2] < 0]
    assert 0 < len(expected) < len(border)
    np.testing.assert_array_equal(np.flatnonzero(cut), expected)


def test_points_return_exactly_from_a_mesh_with_a_part_left_out(body):
    surface = prepared(body, excluded=body.vertices[:, 2] < -0.6)
    points = random_points(surface.mesh)
    there = surface.on_original(points)
    np.testing.assert_allclose(there.positions, points.positions, atol=1e-12)
    np.testing.assert_allclose(surface.on_mesh(there).positions, points.positions, atol=1e-9)


def test_what_is_left_out_is_not_called_loose(body):
    mesh = TriangleMesh(np.concatenate([body.vertices, [[0.0, 0.0, 9.0]]]), body.triangles)
    notes = prepared(mesh, excluded=mesh.vertices[:, 2] < -0.6).cleaned.notes
    assert [note for note in notes if "loose" in note] == ["The mesh has 1 loose vertex: it follows its surroundings."]


def test_an_empty_exclusion_changes_nothing(body):
    surface = prepared(body, excluded=np.zeros(body.vertex_count, bool))
    assert surface.is_whole
    assert surface.mesh is body


def test_nothing_left_and_masks_that_do_not_fit_are_refused_in_words(body):
    with pytest.raises(MatchError, match="Nothing of the rabbit is left to match"):
        prepared(body, name="rabbit", excluded=np.ones(body.vertex_count, bool))
    with pytest.raises(MatchError, match=rf"given by {body.vertex_count} values.*\(5,\)"):
        prepared(body, excluded=np.zeros(5, bool))


def test_only_the_main_part_is_matched(body):
    ball = icosphere(3, 0.1)
    mesh = TriangleMesh(*together((ball[0] + 3, ball[1]), (body.vertices, body.triangles)))
    surface = prepared(mesh, name="rabbit")
    assert not surface.is_whole
    small = len(ball[0])
    np.testing.assert_array_equal(surface.vertices, small + np.arange(body.vertex_count))
    points = random_points(surface.mesh)
    there = surface.on_original(points)
    assert_valid(there, mesh)
    np.testing.assert_allclose(there.positions, points.positions, atol=1e-12)
    spread = surface.spread(np.ones((2, surface.mesh.vertex_count)), -1)
    assert (spread[:, :small] == -1).all()
    assert (spread[:, small:] == 1).all()
    assert any("The rabbit has 1 smaller part" in note for note in surface.cleaned.notes)
    with pytest.raises(MatchError, match="Choose points on that part"):
        surface.on_mesh(SurfacePoints.at_vertices(mesh, np.array([0])))


@pytest.mark.parametrize("mess", [in_pieces, partly_turned, lambda v, t: (v, np.concatenate([t, t[::5, ::-1]]))])
def test_points_of_a_mess_return_to_the_original_triangles(mess, body):
    mesh = TriangleMesh(*mess(body.vertices, body.triangles))
    surface = prepared(mesh)
    assert surface.mesh.vertex_count == body.vertex_count
    points = random_points(surface.mesh)
    there = surface.on_original(points)
    assert_valid(there, mesh)
    np.testing.assert_allclose(there.positions, points.positions, atol=1e-9)
    np.testing.assert_allclose(mesh.vertices[surface.vertices], surface.mesh.vertices, atol=1e-9)


def test_filled_holes_lead_to_vertices_around_them():
    vertices, triangles = icosphere(14)
    mesh = TriangleMesh(*compacted(*without_disc(vertices, triangles, vertices[40], 0.12)))
    surface = prepared(mesh)
    assert surface.mesh.is_closed
    assert surface.mesh.vertex_count > mesh.vertex_count
    assert surface.vertices.min() >= 0
    assert surface.vertices.max() < mesh.vertex_count
    gaps = mesh.vertices[surface.vertices] - surface.mesh.vertices
    assert np.linalg.norm(gaps, axis=1).max() < 0.25
    there = surface.on_original(random_points(surface.mesh, 2000))
    assert_valid(there, mesh)


def test_open_boundaries_stay():
    mesh = TriangleMesh(*cylinder(24, 12))
    surface = prepared(mesh)
    assert surface.mesh.boundary_edges.shape == mesh.boundary_edges.shape
    assert surface.cleaned.notes


def test_the_order_of_the_vertices_does_not_matter(dense):
    mesh = dense.original
    vertices, triangles, new = permuted(mesh.vertices, mesh.triangles, seed=4)
    other = prepared(TriangleMesh(vertices, triangles), proxy_vertices=600)
    np.testing.assert_array_equal(np.sort(new[dense.vertices]), np.sort(other.vertices))


def test_progress_rises(body):
    mesh = TriangleMesh(*subdivided(body.vertices, body.triangles, 2))
    fractions = [report.fraction for report in prepared_steps(mesh, proxy_vertices=500)]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0
    assert fractions[-1] <= 1
