# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of a thousand vertices or some more, which are registered with more than they have."""

from dataclasses import replace

import numpy as np
import pytest

from engine import MatchSettings, Shape, SurfacePoints, TriangleMesh, match
from engine.dense.densify import densify
from engine.geometry.eigenpairs import Spectrum
from engine.matching.refinement import refine_map
from engine.runtime.progress import run
from engine.shapes.proxy import Proxy
from engine.shapes.shape_preparation import finer_shapes, finer_shapes_steps
from tests.shapes import creature, cylinder, subdivided

QUICK = MatchSettings(points=24, samples=128)


@pytest.fixture(scope="module")
def bodies():
    """A body at rest and, in another meshing, bent, and the rest positions of both."""
    first, second = creature(0.0, 12), creature(0.8, 11, turn=0.7)
    return TriangleMesh(*first[:2]), TriangleMesh(*second[:2]), first[2], second[2]


@pytest.fixture(scope="module")
def result(bodies):
    return match(*bodies[:2], QUICK)


def as_it_is(mesh):
    return Shape(mesh, proxy_vertices=mesh.vertex_count)


def mean_errors(found, bodies):
    """Mean distance at rest of the images from where they belong, there and back, over the root of the areas."""
    x, y, rest_x, rest_y = bodies
    there = np.linalg.norm(rest_x - found.source_to_target.transfer(rest_y), axis=1) / np.sqrt(x.area)
    back = np.linalg.norm(rest_y - found.target_to_source.transfer(rest_x), axis=1) / np.sqrt(y.area)
    return np.array([there.mean(), back.mean()])


def test_maps_are_nearer_to_the_truth(result, bodies):
    plain = match(*map(as_it_is, bodies[:2]), QUICK)
    assert (mean_errors(result, bodies) < 0.9 * mean_errors(plain, bodies)).all()
    for found, domain, image in (
        (result.source_to_target, *bodies[:2]),
        (result.target_to_source, *bodies[1::-1]),
    ):
        assert len(found) == domain.vertex_count
        np.testing.assert_array_equal(found.corners, image.triangles[found.triangles])
        assert found.flipped_faces(domain, image) < 0.02


def test_the_sparse_answer_is_that_of_the_mesh_itself(bodies):
    sparse = replace(QUICK, dense=False)
    ours, plain = match(*bodies[:2], sparse), match(*map(as_it_is, bodies[:2]), sparse)
    np.testing.assert_array_equal(ours.target_points.positions, plain.target_points.positions)


def test_shapes_give_the_same_again_and_after_other_matches(result, bodies):
    shapes = [Shape(mesh) for mesh in bodies[:2]]
    match(*shapes, replace(QUICK, samples=256))
    for _ in range(2):
        again = match(*shapes, QUICK)
        np.testing.assert_array_equal(again.source_to_target.positions, result.source_to_target.positions)


def test_a_coarse_and_a_dense_mesh_are_matched(bodies):
    x, y, rest_x, rest_y = bodies
    vertices, triangles = subdivided(y.vertices, y.triangles, 3)
    rest, _ = subdivided(rest_y, y.triangles, 3)
    dense = TriangleMesh(vertices, triangles)
    assert Shape(dense).surface.proxy.is_coarser
    errors = mean_errors(match(x, dense, QUICK), (x, dense, rest_x, rest))
    plain = mean_errors(match(as_it_is(x), dense, QUICK), (x, dense, rest_x, rest))
    assert errors.sum() < plain.sum()
    assert errors.max() < 0.015


@pytest.mark.parametrize("mirrored", [False, True])
def test_landmarks_are_exact(mirrored, bodies, result):
    x, y, rest_x, rest_y = bodies
    chosen = np.random.default_rng(0).choice(x.vertex_count, 3, replace=False)
    wanted = rest_x[chosen] * [1, -1 if mirrored else 1, 1]
    pairs = [[v, int(np.linalg.norm(rest_y - place, axis=1).argmin())] for v, place in zip(chosen, wanted, strict=True)]
    matched = match(x, y, QUICK, landmarks=pairs)
    refined = refine_map(x, y, result.source_to_target, pairs) if not mirrored else matched
    for found in (matched, refined):
        for v, partner in pairs:
            np.testing.assert_allclose(found.source_to_target.positions[v], y.vertices[partner], atol=1e-9)
            np.testing.assert_allclose(found.target_to_source.positions[partner], x.vertices[v], atol=1e-9)
    if not mirrored:
        assert mean_errors(refined, bodies).max() < 1.2 * mean_errors(result, bodies).max()


def test_a_given_correspondence_is_extended_as_well(bodies, result):
    x, y = bodies[:2]
    found = densify(x, y, result.source_points, result.target_points)
    assert mean_errors(found, bodies).max() < 1.2 * mean_errors(result, bodies).max()
    shape = Shape(x)
    for _ in range(2):
        matched = match(shape, y, QUICK)
        np.testing.assert_array_equal(matched.source_to_target.positions, result.source_to_target.positions)
        again = densify(shape, y, result.source_points, result.target_points)
        np.testing.assert_allclose(again.source_to_target.positions, found.source_to_target.positions)


def test_one_shape_is_extended_to_itself(bodies):
    shape = Shape(bodies[0])
    everything = SurfacePoints.at_vertices(shape.mesh, np.arange(0, shape.mesh.vertex_count, 20))
    found = densify(shape, shape, everything, everything)
    away = np.linalg.norm(found.source_to_target.positions - shape.mesh.vertices, axis=1)
    assert away.mean() < 0.002 * shape.scale


def test_the_vertices_of_the_shape_come_first_and_its_samples_stay(bodies):
    shape = Shape(bodies[0])
    run(shape.sample_steps(60, 12))
    shape = shape.limited(60, 12)
    finer, other = run(finer_shapes_steps(shape, shape, 30))
    n = shape.mesh.vertex_count
    assert n < finer.mesh.vertex_count <= 4 * n
    np.testing.assert_array_equal(finer.mesh.vertices[:n], shape.mesh.vertices)
    for each in (finer, other):
        np.testing.assert_array_equal(each.samples.vertices, shape.samples.vertices)
        assert (len(each.samples), each.samples.measured) == (60, 12)
        np.testing.assert_array_equal(each.samples.rows[:, :n], shape.samples.rows)
        true = each.solver.distances(each.samples.vertices[:12]) / each.scale
        assert np.abs(each.samples.rows[:12] - true).max() < 0.03
        assert np.abs(each.samples.rows[:12] - true).mean() < 0.005
        assert isinstance(each.spectrum, Spectrum)
        assert len(each.spectrum) == 30
    assert finer.spectrum is other.spectrum
    assert finer.reflected().finer().mesh.vertex_count == finer.mesh.vertex_count


@pytest.mark.parametrize(
    ("parts", "wanted", "expected"),
    [
        ((12, 4), 5000, 156),
        ((50, 20), 5000, 3050),
        ((50, 20), 3000, 1950),
        ((50, 20), 1000, 0),
        ((100, 20), 5000, 2900),
    ],
    ids=["all edges", "nearly all", "some", "enough", "many"],
)
def test_how_many_there_are_at_last(parts, wanted, expected):
    around, along = parts
    mesh = TriangleMesh(*cylinder(around, along))
    shape = Shape(mesh, proxy_vertices=wanted)
    added = shape.finer().mesh.vertex_count - mesh.vertex_count
    # Edges that are equally long are split together.
    assert expected <= added <= 1.4 * expected
    assert (shape.finer() is shape) == (expected == 0)


def test_two_shapes_are_made_finer_if_one_has_few_vertices():
    few, some, many = (Shape(TriangleMesh(*cylinder(around, 20))) for around in (50, 110, 240))
    finer = finer_shapes(few, some)
    assert [shape.mesh.vertex_count > 3900 for shape in finer] == [True, True]
    assert finer_shapes(few, many)[1] is many
    assert finer_shapes(some, many) == (some, many)
    # What shall have no more than it has keeps them.
    given = as_it_is(few.mesh)
    assert finer_shapes(given, some) == (given, some)
    assert finer_shapes(given, few)[1] is few.finer()


def test_functions_are_linear_along_split_edges(bodies):
    mesh = bodies[0]
    proxy = Proxy.finer(mesh, 3000)
    assert proxy.is_finer
    assert not proxy.is_coarser
    assert not proxy.is_identity
    np.testing.assert_allclose(proxy.on_finer(mesh.vertices), proxy.mesh.vertices)
    np.testing.assert_allclose(proxy.points.positions, mesh.vertices)
    nearest = np.linalg.norm(mesh.vertices[proxy.vertices] - proxy.mesh.vertices, axis=1)
    assert nearest.max() <= mesh.edge_lengths.max() / 2 * (1 + 1e-9)
    same = Proxy.identity(mesh)
    assert same.on_finer(mesh.vertices) is mesh.vertices
