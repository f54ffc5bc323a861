# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs and long bodies that are turned about their axes, and turned back."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import Shape, TriangleMesh, run
from engine.geometry.laplacian import laplace_beltrami
from engine.registration.axial_twists import rolled_back, untwisted
from engine.registration.deformable import DeformableSurface
from tests.bodies import fish, forked
from tests.shapes import icosphere, rotation

BEND = 1.5
"""Curvature of the bent blade's axis."""


def blade():
    """A flat, pointed body along x, much wider than it is thick."""
    vertices, triangles = icosphere(24)
    return vertices * [1, 0.2, 0.07], triangles


def lopsided():
    """The blade, narrower on one side, so that half a turn does not bring it onto itself."""
    vertices, triangles = blade()
    return vertices * np.stack(
        [np.ones(len(vertices)), np.where(vertices[:, 1] > 0, 0.4, 1), np.ones(len(vertices))], 1
    ), triangles


def paddle():
    """A body along x with flat hands at both ends: a thin finger, the palm, a thin wrist, and the trunk."""
    vertices, triangles = icosphere(24)
    along, radii = np.abs(vertices[:, 0]), np.maximum(np.linalg.norm(vertices[:, 1:], axis=1), 1e-9)
    wide = np.interp(
        along, [0, 0.35, 0.45, 0.55, 0.62, 0.8, 0.86, 0.97, 1], [0.2, 0.18, 0.05, 0.05, 0.14, 0.14, 0.03, 0.03, 0]
    )
    return vertices * np.stack([np.ones_like(wide), wide / radii, 0.4 * wide / radii], axis=1), triangles


def bent(vertices):
    """Bend what lies along x upwards, to an arc."""
    x, y, z = vertices.T
    return np.stack([(1 / BEND - z) * np.sin(BEND * x), y, 1 / BEND - (1 / BEND - z) * np.cos(BEND * x)], axis=1)


def twisted(vertices, most, begin=0.45, length=0.3):
    """Turn what lies along x about it: the more the nearer to one end, and not at all in the middle."""
    angles = most * np.clip((vertices[:, 0] - begin) / length, 0, 1)
    x, y, z = vertices.T
    return np.stack([x, np.cos(angles) * y - np.sin(angles) * z, np.sin(angles) * y + np.cos(angles) * z], axis=1)


def surface(mesh):
    return DeformableSurface(mesh, laplace_beltrami(mesh))


def shape(mesh):
    made = Shape(mesh)
    run(made.sample_steps(150))
    run(made.spectrum_steps(3))
    return made


def on_surface(target, positions):
    """Take positions to the nearest vertices of a surface, as a registration does."""
    return target.vertices[cKDTree(target.vertices).query(positions)[1]]


def mean_distance(surface, first, second):
    return surface.mass @ np.linalg.norm(first - second, axis=1)


@pytest.fixture(scope="module")
def straight():
    return TriangleMesh(*blade())


@pytest.fixture(scope="module")
def made(straight):
    return shape(straight)


@pytest.mark.parametrize("most", [2.5, -1.5, np.pi])
@pytest.mark.parametrize("form", [np.asarray, bent])
def test_a_limb_that_is_turned_about_its_axis_is_turned_back(form, most, straight, made):
    vertices, triangles = blade()
    target = surface(TriangleMesh(form(vertices), triangles))
    wrong = on_surface(target, target.in_unit_size(form(twisted(vertices, most))))
    source = surface(straight)
    before = mean_distance(target, wrong, target.vertices)
    after = mean_distance(target, untwisted(made, source, target, wrong).positions, target.vertices)
    assert before > 0.008
    assert after < 0.6 * before  # turned and brought onto the flat surface, some vertices coincide


def test_a_hand_is_turned_back_though_it_is_wider_than_its_finger():
    vertices, triangles = paddle()
    mesh = TriangleMesh(vertices, triangles)
    target = surface(mesh)
    wrong = on_surface(target, target.in_unit_size(twisted(vertices, 2.5)))
    before = mean_distance(target, wrong, target.vertices)
    after = mean_distance(target, untwisted(shape(mesh), target, target, wrong).positions, target.vertices)
    assert before > 0.004
    assert after < 0.6 * before


def test_a_limb_whose_prongs_have_changed_places_is_turned_back_at_its_stem():
    vertices, triangles = forked(stem=0.06)
    target = surface(TriangleMesh(vertices, triangles))
    wrong = on_surface(target, target.in_unit_size(twisted(vertices, np.pi, begin=0.3, length=0.4)))
    before = mean_distance(target, wrong, target.vertices)
    after = untwisted(shape(TriangleMesh(vertices, triangles)), target, target, wrong, isometry=0.0).positions
    outer = vertices[:, 0] > 1
    assert before > 0.05
    assert (np.sign(wrong[outer, 1]) != np.sign(vertices[outer, 1])).mean() > 0.9
    assert (np.sign(after[outer, 1]) == np.sign(vertices[outer, 1])).all()
    assert mean_distance(target, after, target.vertices) < 0.2 * before


def test_limbs_of_another_build_are_turned_only_if_that_saves_much():
    vertices, triangles = blade()
    vertices = vertices * [1, 0.7, 1.4]
    source = surface(TriangleMesh(vertices, triangles))
    other = surface(TriangleMesh(vertices * [1, 0.7, 1.2], triangles))  # wide where the source is thin
    made = shape(source.mesh)
    little, much = (on_surface(other, other.in_unit_size(twisted(vertices, most))) for most in (1.3, 2.0))
    np.testing.assert_array_equal(untwisted(made, source, other, little, isometry=0.0).positions, little)
    for wrong, isometry in (little, 1.0), (much, 0.0):
        assert np.abs(untwisted(made, source, other, wrong, isometry).positions - wrong).max() > 0.02


@pytest.mark.parametrize("form", [np.asarray, bent])
def test_what_is_right_stays_as_it_is(form, straight, made):
    vertices, triangles = blade()
    target = surface(TriangleMesh(form(vertices), triangles))
    kept = untwisted(made, surface(straight), target, target.vertices)
    np.testing.assert_array_equal(kept.positions, target.vertices)
    assert not kept.otherwise


def test_what_is_twisted_by_less_than_half_a_turn_might_be_twisted_the_other_way():
    vertices, triangles = lopsided()
    vertices = vertices * [1, 0.7, 0.7]  # thin enough for the twist to be worth it
    mesh, target = TriangleMesh(vertices, triangles), surface(TriangleMesh(twisted(vertices, 3.0), triangles))
    found = untwisted(shape(mesh), surface(mesh), target, target.vertices)
    np.testing.assert_array_equal(found.positions, target.vertices)
    (other,) = found.otherwise
    along, rest = vertices[other.vertices, 0], target.vertices[other.vertices]
    # Only one end is twisted; what is half-way there lies on the other side, and the tip nearly where it was.
    halfway, tip = np.abs(along - 0.65) < 0.02, along > 0.95
    assert along.min() > 0
    apart = min((np.linalg.norm(way - rest, axis=1) for way in other.positions), key=lambda away: away[tip].max())
    around = rest[halfway, 1:] - rest[halfway, 1:].mean(axis=0)
    assert apart[halfway].max() > 1.5 * np.linalg.norm(around, axis=1).max()
    assert apart[tip].max() < 0.45 * apart.max()


def test_a_flat_limb_might_lie_upside_down():
    vertices, triangles = lopsided()
    vertices = vertices * [1, 0.7, 0.7]
    mesh, target = TriangleMesh(vertices, triangles), surface(TriangleMesh(twisted(vertices, 2.8), triangles))
    (other,) = untwisted(shape(mesh), surface(mesh), target, target.vertices).otherwise
    along, rest = vertices[other.vertices, 0], target.vertices[other.vertices]
    # Across the limb, near its end, what was on one side is on the other.
    end = (along > 0.85) & (along < 0.9)
    across = [(places[end] - places[end].mean(axis=0))[:, 1:] for places in (rest, *other.positions)]
    agreements = [np.sum(across[0] * way) / np.square(across[0]).sum() for way in across[1:]]
    assert min(agreements) < -0.9


def test_a_limb_is_turned_back_from_where_it_leaves_the_body():
    vertices, triangles = icosphere(24)
    along = vertices[:, 0]
    radii = np.maximum(np.linalg.norm(vertices[:, 1:], axis=1), 1e-9)
    width = np.interp(along, [-1, -0.9, -0.2, 0, 0.9, 1], [0, 0.4, 0.4, 0.08, 0.08, 0])
    wide = np.where(vertices[:, 1] > 0, 0.4, 1.0) * width  # so that half a turn does not bring it onto itself
    vertices = np.stack([along, wide * vertices[:, 1] / radii, 0.6 * width * vertices[:, 2] / radii], axis=1)
    mesh = TriangleMesh(vertices, triangles)
    target = surface(mesh)
    wrong = target.in_unit_size(twisted(vertices, 1.3, 0.05, 0.2))
    after = untwisted(shape(mesh), target, target, wrong).positions
    arm = along > 0.05
    before, after = (np.linalg.norm(places - target.vertices, axis=1)[arm].mean() for places in (wrong, after))
    assert before > 0.01
    assert after < 0.6 * before


def test_a_thin_end_of_a_limb_does_not_make_it_another_way_to_lie():
    """A fingertip can be spun at no cost, and says nothing."""
    vertices, triangles = paddle()
    mesh = TriangleMesh(vertices, triangles)
    found = untwisted(shape(mesh), surface(mesh), surface(mesh), surface(mesh).vertices)
    assert not found.otherwise


def test_order_of_the_vertices_and_motion_do_not_matter(straight, made):
    vertices, triangles = blade()
    target = surface(straight)
    wrong = on_surface(target, target.in_unit_size(twisted(vertices, 2.5)))
    found = untwisted(made, target, target, wrong).positions
    assert np.abs(found - wrong).max() > 0.05
    order = np.random.default_rng(0).permutation(len(vertices))
    back = np.argsort(order)
    other = TriangleMesh(3 * vertices[order] + 1, back[triangles])
    turn = rotation([1, 2, 3], 2.0)
    moved = surface(TriangleMesh(straight.vertices @ turn.T, triangles))
    again = untwisted(shape(other), surface(other), moved, wrong[order] @ turn.T).positions
    np.testing.assert_allclose(again[back], found @ turn.T, atol=0.02)


def test_bodies_without_limbs_stay_as_they_are():
    mesh = TriangleMesh(*icosphere(8))
    ball = surface(mesh)
    turned = ball.vertices @ rotation([0, 0, 1], 1.0).T
    np.testing.assert_array_equal(untwisted(shape(mesh), ball, ball, turned).positions, turned)


@pytest.mark.parametrize("most", [2.5, -1.5, np.pi])
@pytest.mark.parametrize("form", [np.asarray, bent])
def test_a_long_body_whose_tail_lies_the_other_way_round_is_turned_back(form, most):
    vertices, triangles = fish()
    mesh = TriangleMesh(vertices, triangles)
    target = surface(TriangleMesh(form(vertices), triangles))
    placed = target.in_unit_size(form(twisted(vertices, most)))
    wrong = (placed + on_surface(target, placed)) / 2  # near the surface, as by a soft registration
    before = mean_distance(target, wrong, target.vertices)
    after = mean_distance(target, rolled_back(shape(mesh), surface(mesh), target, wrong).positions, target.vertices)
    assert before > 0.008
    assert after < 0.5 * before


@pytest.mark.parametrize("form", [np.asarray, bent])
def test_a_long_body_that_lies_right_stays_as_it_is(form):
    vertices, triangles = fish()
    mesh = TriangleMesh(vertices, triangles)
    target = surface(TriangleMesh(form(vertices), triangles))
    assert rolled_back(shape(mesh), surface(mesh), target, target.vertices).positions is target.vertices


@pytest.mark.parametrize("part", [0.0, 0.7])
@pytest.mark.parametrize("form", [np.asarray, bent])
def test_how_else_a_long_body_might_lie_is_offered(form, part):
    """All of the fish, or its tail, is upside down, and has been bent until it fits as well as it can."""
    vertices, triangles = fish()
    mesh = TriangleMesh(vertices, triangles)
    target = surface(TriangleMesh(form(vertices), triangles))
    places = vertices[:, 0] / vertices[:, 0].max()
    over = np.where(places > part if part else np.ones(len(places), bool), -1, 1)
    placed = target.in_unit_size(form(vertices * np.stack([over**2, over, over], axis=1)))
    wrong = on_surface(target, placed)
    found = rolled_back(shape(mesh), surface(mesh), target, wrong)
    ways = [found.positions, *(way for winding in found.otherwise for way in winding.positions)]
    before = mean_distance(target, wrong, target.vertices)
    assert before > 0.008
    assert min(mean_distance(target, way, target.vertices) for way in ways) < 0.5 * before
    assert all(way.shape == wrong.shape for way in ways)
    assert len(ways) <= 4


def test_bodies_that_are_not_long_are_not_turned():
    vertices, triangles = icosphere(12)
    mesh = TriangleMesh(vertices * [1, 0.8, 0.6], triangles)
    plump = surface(mesh)
    wrong = on_surface(plump, plump.in_unit_size(twisted(mesh.vertices, 2.5)))
    found = rolled_back(shape(mesh), plump, plump, wrong)
    assert found.positions is wrong
    assert not found.otherwise


def test_slices_without_vertices_do_not_matter():
    # A rod of few rings of vertices: most slices of equal differences of the first eigenfunction hold none.
    vertices, triangles = icosphere(2)
    mesh = TriangleMesh(vertices * [1, 0.2, 0.1], triangles)
    rod = surface(mesh)
    assert np.isfinite(rolled_back(shape(mesh), rod, rod, rod.vertices[::-1].copy()).positions).all()
