# SPDX-License-Identifier: GPL-3.0-or-later
"""The as-rigid-as-possible energy: what costs nothing, what costs a known amount, and its derivative."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import TriangleMesh
from engine.geometry.laplacian import laplace_beltrami
from engine.registration.elastic import ElasticSurface
from tests.shapes import creature, icosphere, permuted, plane, rotation

NEAR = 0.1


def elastic_of(vertices, triangles):
    return ElasticSurface(vertices, laplace_beltrami(TriangleMesh(vertices, triangles)))


@pytest.fixture(scope="module")
def body():
    vertices, triangles, _ = creature(0.0, 9)
    return vertices, triangles, elastic_of(vertices, triangles)


@pytest.fixture(scope="module")
def ball():
    vertices, triangles = icosphere(5)
    return vertices, triangles, elastic_of(vertices, triangles)


@pytest.mark.parametrize(("axis", "angle"), [([1, 0, 0], 0.3), ([1, 2, 3], 2.0), ([0, 1, -1], np.pi)])
def test_a_rigid_motion_costs_nothing_and_is_found(axis, angle, body):
    vertices, _, elastic = body
    turn = rotation(axis, angle)
    moved = vertices @ turn.T + [3, -2, 5]
    rotations = elastic.rotations(moved, NEAR)
    np.testing.assert_allclose(rotations, np.broadcast_to(turn, rotations.shape), atol=1e-9)
    assert elastic.energy(moved, rotations) == pytest.approx(0, abs=1e-15)
    np.testing.assert_allclose(elastic.stiffness @ moved, elastic.pull(rotations), atol=1e-9)


@pytest.mark.parametrize("scale", [0.5, 0.9, 1.0, 1.3, 2.0])
def test_uniform_scaling_costs_the_dirichlet_energy_of_the_difference(scale, ball):
    """Twice the area by the squared change of scale, as the gradient of each position has the squared norm two."""
    vertices, triangles, elastic = ball
    rotations = elastic.rotations(scale * vertices, NEAR)
    np.testing.assert_allclose(rotations, np.broadcast_to(np.eye(3), rotations.shape), atol=1e-9)
    area = TriangleMesh(vertices, triangles).area
    assert elastic.energy(scale * vertices, rotations) == pytest.approx(2 * area * (scale - 1) ** 2, rel=1e-9, abs=1e-9)


def test_stretching_a_plane_one_way_costs_its_area_by_the_squared_strain():
    vertices, triangles = plane(12, jitter=0.2)
    elastic = elastic_of(vertices, triangles)
    stretched = vertices * [1.4, 1, 1]
    # No edge is left quite without weight, which is not in the integral.
    assert elastic.energy(stretched, elastic.rotations(stretched, NEAR)) == pytest.approx(0.4**2, rel=1e-3)


def test_the_energy_is_an_area(body):
    vertices, triangles, elastic = body
    bent = creature(0.5, 9)[0]
    cost = elastic.energy(bent, elastic.rotations(bent, NEAR))
    assert cost > 0
    assert elastic.energies(bent, elastic.rotations(bent, NEAR)).sum() == pytest.approx(cost)
    large = elastic_of(50 * vertices, triangles)
    assert large.energy(50 * bent, large.rotations(50 * bent, 50 * NEAR)) == pytest.approx(2500 * cost)


def test_the_equilibrium_is_where_the_energy_has_no_slope(body):
    """The gradient of the energy is twice the stiffness applied to the positions, less the pull."""
    vertices, _, elastic = body
    assert_equilibrium(elastic, vertices, elastic.rotations(creature(0.7, 9)[0], NEAR))


def assert_equilibrium(elastic, vertices, rotations):
    random = np.random.default_rng(1)
    positions = vertices + 0.1 * random.normal(size=vertices.shape)
    direction = random.normal(size=vertices.shape)
    step = 1e-3  # central differences of a square are exact
    ahead, behind = (elastic.energy(positions + sign * step * direction, rotations) for sign in (1, -1))
    slope = 2 * (elastic.stiffness @ positions - elastic.pull(rotations))
    assert (ahead - behind) / (2 * step) == pytest.approx((slope * direction).sum(), rel=1e-6)


def test_the_stiffness_is_symmetric_without_negative_modes_and_ignores_where_the_surface_is(body):
    vertices, _, elastic = body
    assert abs(elastic.stiffness - elastic.stiffness.T).max() < 1e-12
    np.testing.assert_allclose(elastic.stiffness @ np.ones(len(vertices)), 0, atol=1e-10)
    vectors = np.random.default_rng(0).normal(size=(len(vertices), 20))
    assert (np.einsum("nk,nk->k", vectors, elastic.stiffness @ vectors) > 0).all()


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10**6), noise=st.floats(0, 3), mirror=st.booleans(), flat=st.booleans())
def test_rotations_never_reflect(ball, seed, noise, mirror, flat):
    vertices, _, elastic = ball
    positions = vertices * [-1 if mirror else 1, 1, 0 if flat else 1]
    positions = positions + noise * np.random.default_rng(seed).normal(size=vertices.shape)
    rotations = elastic.rotations(positions, NEAR)
    np.testing.assert_allclose(np.linalg.det(rotations), 1, atol=1e-9)
    np.testing.assert_allclose(
        rotations @ rotations.transpose(0, 2, 1), np.broadcast_to(np.eye(3), rotations.shape), atol=1e-9
    )


def test_a_mirrored_plane_is_one_that_was_turned_over():
    vertices, triangles = plane(10, jitter=0.2)
    elastic = elastic_of(vertices, triangles)
    mirrored = vertices * [-1, 1, 1]
    rotations = elastic.rotations(mirrored, NEAR)
    np.testing.assert_allclose(rotations, np.broadcast_to(np.diag([-1, 1, -1]), rotations.shape), atol=1e-9)
    assert elastic.energy(mirrored, rotations) == pytest.approx(0, abs=1e-15)


def test_rotations_are_smooth_over_the_radius(body):
    vertices, triangles, elastic = body
    noisy = vertices + 0.02 * np.random.default_rng(2).normal(size=vertices.shape)
    first, second = TriangleMesh(vertices, triangles).edges.T

    def roughness(radius):
        rotations = elastic.rotations(noisy, radius)
        return np.square(rotations[first] - rotations[second]).sum(axis=(1, 2)).mean()

    near, far = roughness(0.05), roughness(0.4)
    assert far < 0.3 * near


def test_bending_costs_far_less_than_noise_as_large(body):
    vertices, _, elastic = body
    bent = creature(0.5, 9)[0]
    noise = np.random.default_rng(0).normal(size=vertices.shape)
    noisy = vertices + noise * np.linalg.norm(bent - vertices) / np.linalg.norm(noise)
    bending, wrinkling = (elastic.energy(x, elastic.rotations(x, NEAR)) for x in (bent, noisy))
    assert 0 < bending < 0.1 * wrinkling


def test_the_order_of_the_vertices_does_not_matter(body):
    vertices, triangles, elastic = body
    shuffled, faces, new = permuted(vertices, triangles, seed=3)
    other = elastic_of(shuffled, faces)
    bent = creature(0.5, 9)[0]
    bent_there = np.empty_like(bent)
    bent_there[new] = bent
    rotations, there = elastic.rotations(bent, NEAR), other.rotations(bent_there, NEAR)
    np.testing.assert_allclose(there[new], rotations, atol=1e-8)
    assert other.energy(bent_there, there) == pytest.approx(elastic.energy(bent, rotations), rel=1e-8)


def test_a_surface_strained_alike_everywhere_is_as_stiff_as_before(ball):
    vertices, _, elastic = ball
    softened = elastic.softened(1.3 * vertices, NEAR)
    assert abs(softened.stiffness - elastic.stiffness).max() < 1e-9


def half_stretched():
    """A plane around the origin, how far its vertices lie beyond x = 0, its size, and its half beyond stretched."""
    vertices, triangles = plane(40)
    vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    beyond = np.maximum(vertices[:, 0], 0)
    stretched = vertices + 0.4 * beyond[:, None] * [1, 0, 0]
    return vertices, beyond, np.ptp(vertices[:, 0]), elastic_of(vertices, triangles), stretched


@pytest.mark.parametrize(("power", "constant"), [(0.5, 1), (0.75, 0.3), (0.0, 0.3)])
def test_the_strained_half_of_a_plane_is_softer_by_what_the_robust_energy_says(power, constant):
    """One half strained and one not: the strain is twice its mean there, and the factors have the mean one."""
    vertices, beyond, size, elastic, stretched = half_stretched()
    softened = elastic.softened(stretched, 0.02 * size, power, constant)
    ratio = softened.stiffness.diagonal() / elastic.stiffness.diagonal()
    still, strained = vertices[:, 0] < -0.2 * size, beyond > 0.2 * size
    factors = (constant + np.array([0.0, 2.0])) ** -power
    factors /= factors.mean()
    np.testing.assert_allclose(ratio[still], factors[0], rtol=0.03)
    np.testing.assert_allclose(ratio[strained], factors[1], rtol=0.03)


def test_a_surface_strained_alike_everywhere_and_every_way_is_as_stiff_as_before(ball):
    """But for what is given to the normals, in which there are hardly any edges."""
    vertices, triangles = plane(12, jitter=0.2)
    flat = elastic_of(vertices, triangles)
    turned = vertices @ rotation([1, 2, 3], 1.0).T
    for elastic, positions in ((flat, 1.3 * turned), (ball[2], 1.3 * ball[0])):
        softened = elastic.softened(positions, NEAR, directed=1.0)
        assert abs(softened.stiffness - elastic.stiffness).max() < 1e-4 * abs(elastic.stiffness).max()


def edges_softened(softened, elastic):
    """Edges (first, second) of the surface, and by what the stiffness of each was multiplied."""
    entries = elastic.stiffness.tocoo()
    first, second = entries.row[entries.row < entries.col], entries.col[entries.row < entries.col]
    return first, second, softened.stiffness[first, second] / elastic.stiffness[first, second]


@pytest.mark.parametrize(("power", "constant"), [(0.5, 1), (0.75, 0.3), (0.0, 0.3)])
def test_the_strained_half_of_a_plane_is_softer_along_the_strain_by_what_the_robust_energy_says(power, constant):
    """One half is strained, one way: there the squared strain is four times its mean over all edges of both ways."""
    vertices, _, size, elastic, stretched = half_stretched()
    softened = elastic.softened(stretched, 0.02 * size, power, constant, directed=1.0)
    first, second, ratio = edges_softened(softened, elastic)
    along = np.abs(vertices[first] - vertices[second])
    places = (vertices[first, 0] + vertices[second, 0]) / 2
    still, strained = places < -0.2 * size, places > 0.2 * size
    lengthened, across = along[:, 1] < 1e-9, along[:, 0] < 1e-9
    factors = (constant + np.array([0.0, 4.0])) ** -power
    factors /= 0.75 * factors[0] + 0.25 * factors[1]
    np.testing.assert_allclose(ratio[still], factors[0], rtol=0.03)
    np.testing.assert_allclose(ratio[strained & across], factors[0], rtol=0.03)
    np.testing.assert_allclose(ratio[strained & lengthened], factors[1], rtol=0.03)


def test_a_bent_plane_is_softer_where_and_along_which_it_bends():
    """A strip bent to a right angle over a narrow fold, without any stretch."""
    vertices, triangles = plane(40)
    size = np.ptp(vertices[:, 0])
    radius = 0.05 * size
    along = vertices[:, 0] - vertices[:, 0].mean()
    angle = np.clip(along / radius, -np.pi / 4, np.pi / 4)
    rest = along - angle * radius
    bent = np.stack([radius * np.sin(angle) + rest * np.cos(angle), vertices[:, 1]], axis=1)
    bent = np.column_stack([bent, radius * (1 - np.cos(angle)) + rest * np.sin(angle)])
    elastic = elastic_of(vertices, triangles)
    softened = elastic.softened(bent, 0.03 * size, directed=1.0)
    first, second, ratio = edges_softened(softened, elastic)
    offsets = np.abs(vertices[first] - vertices[second])
    fold = np.maximum(np.abs(along[first]), np.abs(along[second])) < 0.5 * radius
    far = np.minimum(np.abs(along[first]), np.abs(along[second])) > 6 * radius
    towards, across = offsets[:, 1] < 1e-9, offsets[:, 0] < 1e-9
    assert ratio[fold & towards].max() < 0.5 * ratio[fold & across].min()
    np.testing.assert_allclose(ratio[far], ratio[fold & across].mean(), rtol=0.03)


@pytest.mark.parametrize("directed", [0.0, 1.0])
def test_a_softened_surface_has_its_own_equilibrium_and_the_same_rotations(directed, body):
    vertices, _, elastic = body
    bent, other = creature(0.7, 9)[0], creature(0.3, 9)[0]
    softened = elastic.softened(bent, NEAR, directed=directed)
    rotations = softened.rotations(other, NEAR)
    np.testing.assert_array_equal(rotations, elastic.rotations(other, NEAR))
    assert_equilibrium(softened, vertices, rotations)
    assert softened.energy(other, rotations) != pytest.approx(elastic.energy(other, rotations), rel=0.01)


@pytest.mark.parametrize("directed", [0.0, 0.6, 1.0])
def test_size_does_not_decide_what_is_softer(directed, body):
    vertices, triangles, elastic = body
    bent = creature(0.5, 9)[0]
    large = elastic_of(50 * vertices, triangles).softened(50 * bent, 50 * NEAR, directed=directed)
    assert abs(large.stiffness - elastic.softened(bent, NEAR, directed=directed).stiffness).max() < 1e-9


def test_a_surface_that_is_stretched_as_a_whole_is_at_rest_so_but_for_a_tenth(ball):
    vertices, _, elastic = ball
    for scale in (1.5, 0.7):
        rest = np.exp(np.sign(np.log(scale)) * (abs(np.log(scale)) - 0.1))
        at_rest = rest * vertices
        strained = elastic.strained(scale * vertices @ rotation([1, 2, 3], 1.0).T, NEAR)
        assert strained.energy(at_rest, strained.rotations(at_rest, NEAR)) == pytest.approx(0, abs=1e-4)
        assert abs(strained.stiffness - elastic.stiffness).max() < 1e-12


def test_a_plane_that_is_stretched_one_way_is_at_rest_so():
    vertices, triangles = plane(12, jitter=0.2)
    elastic = elastic_of(vertices, triangles)
    strained = elastic.strained(vertices * [1.4, 1, 1], NEAR)
    at_rest = vertices * [1.4 * np.exp(-0.1), 1, 1]
    assert strained.energy(at_rest, strained.rotations(at_rest, NEAR)) == pytest.approx(0, abs=1e-4)
    assert strained.energy(vertices, strained.rotations(vertices, NEAR)) > 0.01


def test_what_is_strained_by_less_than_a_tenth_is_at_rest_as_before(body):
    vertices, _, elastic = body
    strained = elastic.strained(1.08 * vertices, NEAR)
    assert strained.energy(vertices, strained.rotations(vertices, NEAR)) == pytest.approx(0, abs=1e-12)


def test_only_one_half_of_a_plane_is_at_rest_otherwise_if_only_that_is_stretched():
    vertices, beyond, size, elastic, stretched = half_stretched()
    strained = elastic.strained(stretched, 0.05 * size)
    at_rest = vertices + (1.4 * np.exp(-0.1) - 1) * beyond[:, None] * [1, 0, 0]
    costs = [strained.energy(each, strained.rotations(each, 0.05 * size)) for each in (vertices, at_rest)]
    assert costs[1] < 0.1 * costs[0]  # the strain is averaged over where it begins


def test_collapsed_and_exploded_surfaces_are_at_rest_at_most_twice_as_long_or_short(ball):
    vertices, triangles, elastic = ball
    area = TriangleMesh(vertices, triangles).area
    for scale, rest in ((0.0, 2**-1), (1e9, 2)):
        strained = elastic.strained(scale * vertices, NEAR)
        at_rest = np.exp(np.sign(rest - 1) * (np.log(2) - 0.1)) * vertices
        assert strained.energy(at_rest, strained.rotations(at_rest, NEAR)) < 1e-3 * area


def test_size_does_not_decide_what_is_strained_and_softening_keeps_it(body):
    vertices, triangles, elastic = body
    bent = creature(0.5, 9)[0] * [1.3, 1, 1]
    strained = elastic.strained(bent, NEAR)
    rotations = strained.rotations(bent, NEAR)
    large = elastic_of(50 * vertices, triangles).strained(50 * bent, 50 * NEAR)
    np.testing.assert_allclose(large.pull(rotations), 50 * strained.pull(rotations), atol=1e-6)
    assert strained.energy(bent, rotations) < 0.9 * elastic.energy(bent, rotations)
    softened = strained.softened(bent, NEAR)
    assert softened.energy(bent, rotations) < 0.9 * elastic.softened(bent, NEAR).energy(bent, rotations)
    assert_equilibrium(softened, vertices, rotations)


def test_the_operator_may_be_that_of_the_surface_in_another_size(body):
    vertices, triangles, elastic = body
    bent = creature(0.5, 9)[0] * [1.3, 1, 1]
    other = ElasticSurface(vertices, laplace_beltrami(TriangleMesh(7 * vertices, triangles)))
    rotations = elastic.rotations(bent, NEAR)
    np.testing.assert_allclose(
        other.strained(bent, NEAR).pull(rotations), elastic.strained(bent, NEAR).pull(rotations), atol=1e-6
    )


def test_a_surface_posed_anew_is_the_one_made_of_these_vertices(body):
    vertices, triangles, elastic = body
    places = vertices + 0.1 * np.sin(3 * vertices[:, ::-1])
    posed, made = elastic.posed(places), ElasticSurface(places, laplace_beltrami(TriangleMesh(vertices, triangles)))
    turned = posed.rotations(vertices, NEAR)
    np.testing.assert_allclose(turned, made.rotations(vertices, NEAR), atol=1e-12)
    np.testing.assert_allclose(posed.pull(turned), made.pull(turned), atol=1e-12)
    assert abs(posed.stiffness - made.stiffness).max() == 0
    assert elastic.energy(vertices, elastic.rotations(vertices, NEAR)) < 1e-12  # which stays as it was
