# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from tests.domains import domain
from tests.shapes import creature, icosphere, permuted, rotation, torus


@pytest.fixture(scope="module")
def body():
    return domain(*creature(0.5, 12)[:2])


def test_fine_samples_begin_with_the_coarse_ones_and_are_distinct(body):
    np.testing.assert_array_equal(body.vertices[: body.coarse_count], body.shape.samples.vertices)
    assert len(np.unique(body.vertices)) == len(body.vertices) == 800


def test_fine_samples_leave_no_large_gaps(body):
    places = body.shape.mesh.vertices / body.shape.scale
    gaps = np.linalg.norm(places[:, None] - places[body.vertices], axis=2).min(axis=1)
    spacing = np.linalg.norm(body.places[:, None] - body.places, axis=2)
    np.fill_diagonal(spacing, np.inf)
    assert gaps.max() <= spacing.min(axis=1).max()


def test_all_vertices_are_samples_of_a_small_mesh():
    small = domain(*icosphere(3))
    np.testing.assert_array_equal(np.sort(small.vertices), np.arange(92))
    assert small.coarse_count == 92


def test_vertices_in_one_place_are_taken_once():
    vertices, triangles = icosphere(3)
    # Two spheres that share all places and one vertex.
    other = np.where(triangles == 0, 0, triangles + len(vertices) - 1)
    both = domain(np.concatenate([vertices, vertices[1:]]), np.concatenate([triangles, other]), samples=20)
    assert len(np.unique(both.vertices)) == len(both.vertices)


def test_functions_and_values_are_without_unit(body):
    large = domain(50 * body.shape.mesh.vertices, body.shape.mesh.triangles)
    mass = body.shape.spectrum.mass / body.shape.spectrum.area
    np.testing.assert_allclose(mass @ np.square(body.functions), 1, rtol=1e-6)
    np.testing.assert_allclose(large.values, body.values, rtol=1e-4, atol=1e-6)
    np.testing.assert_allclose(np.abs(large.gradients), np.abs(body.gradients), atol=0.05)


def test_gradients_have_the_energy_of_the_eigenvalues():
    ring = domain(*torus(60, 24), samples=60)
    energy = np.square(ring.gradients).sum(axis=2).mean(axis=0)
    # Samples are spread evenly enough for a mean over them to be one over the surface, roughly.
    np.testing.assert_allclose(energy[1:20], ring.values[1:20], rtol=0.25)


def test_directions_lead_away_from_samples():
    ball = domain(*icosphere(10), samples=100)
    directions = ball.directions(np.array([0, 7, 2]))
    assert directions.shape == (100, 3, 2)
    lengths = np.linalg.norm(directions, axis=2)
    assert ((lengths > 0.999) | (lengths == 0)).all()


def test_a_bump_is_curved_outwards_and_a_saddle_less():
    ring = domain(*torus(60, 24), samples=60)
    radius = np.linalg.norm(ring.places[:, :2], axis=1)
    assert (
        ring.curvature[radius > np.quantile(radius, 0.9)].mean()
        > ring.curvature[radius < np.quantile(radius, 0.1)].mean()
    )
    assert np.square(ring.curvature).mean() == pytest.approx(1, abs=0.2)


@pytest.mark.parametrize("change", ["turned", "scaled", "renumbered"])
def test_descriptors_do_not_depend_on_place_scale_or_order(body, change):
    mesh = body.shape.mesh
    vertices, triangles, new = mesh.vertices, mesh.triangles, np.arange(mesh.vertex_count)
    if change == "turned":
        vertices = vertices @ rotation([1.0, 2.0, -1.0], 0.7).T + 5
    elif change == "scaled":
        vertices = 0.01 * vertices
    else:
        vertices, triangles, new = permuted(vertices, triangles, seed=3)
    other = domain(vertices, triangles)
    where = np.full(len(new), -1)
    where[other.vertices] = np.arange(len(other.vertices))
    same = where[new[body.vertices]]
    here = same >= 0  # of equally far points another may have been taken
    assert here.mean() > 0.9
    np.testing.assert_allclose(other.curvature[same[here]], body.curvature[here], atol=1e-3)
    np.testing.assert_allclose(other.signatures[same[here]], body.signatures[here], atol=0.05)
    first = np.arange(6)
    np.testing.assert_allclose(other.extremity_descriptors(first), body.extremity_descriptors(first), atol=0.05)


def test_patches_are_means_over_the_surroundings(body):
    np.testing.assert_allclose(body.patches.sum(axis=1), 1)
    assert body.patches.shape == (body.coarse_count, len(body.vertices))
    np.testing.assert_array_equal(body.patches.argmax(axis=1), np.arange(body.coarse_count))
