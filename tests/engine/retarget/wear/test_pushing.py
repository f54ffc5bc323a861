# SPDX-License-Identifier: GPL-3.0-or-later
"""Cloth that is pushed out of what is below it."""

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from engine import TriangleMesh
from engine.geometry.laplacian import laplace_beltrami
from engine.retarget.wear.contact import Surface, surface_samples
from engine.retarget.wear.pushing import Layer, _Above, _directly, _near_cells, layer_of, pushed_out
from tests.shapes import icosphere

RADIUS, CLOTH = 1.0, 1.03
UNIT = float(np.sqrt(4 * np.pi))


def ball(resolution, radius):
    """A ball around the origin."""
    return TriangleMesh(*icosphere(resolution, radius))


BODY, ITEM = ball(9, RADIUS), ball(6, CLOTH)
SAMPLES = surface_samples(ITEM, 0.2)


def layer(least=0.02, margin=0.0, before=ITEM):
    """What an item lies on, of which more than `least` need not be kept."""
    skin, scales = Surface(BODY), np.ones(ITEM.vertex_count)
    known = {"unit": UNIT, "least": least, "margin": margin}
    return layer_of(skin, skin, samples=SAMPLES, items=(before, before), scales=scales, **known)


def pushed(positions, below, fixed=None, drawn=None):
    """Push the item out of what is below it."""
    fixed = np.zeros(ITEM.vertex_count, bool) if fixed is None else fixed
    known = {"layers": [below], "fixed": fixed, "unit": UNIT, "drawn": drawn}
    return pushed_out(ITEM, positions, laplace_beltrami(ITEM), SAMPLES[0], **known)


def test_what_lay_near_is_to_keep_its_distance_as_far_as_that_is_more_than_enough():
    heights = Surface(BODY).clearance(SAMPLES[0] @ ITEM.vertices).distances
    assert np.allclose(layer(least=1.0).wanted, heights.clip(min=0))
    assert np.allclose(layer(least=0.01).wanted, np.minimum(heights, 0.01))
    assert np.allclose(layer(least=0.01, margin=0.5).wanted, 0.5)
    assert layer().outside.all()
    assert not layer().closing.any()


def test_nothing_is_asked_of_what_lay_inside_or_far_away():
    for size in (0.9, 1.3):
        moved = TriangleMesh(size * ITEM.vertices, ITEM.triangles)
        assert np.isneginf(layer(before=moved).wanted).all()


def test_what_has_come_inside_is_pushed_out_and_no_further():
    below, away = layer(), ITEM.vertices[:, 0] > 0.5
    positions = np.where(away[:, None], 0.95, 1.0) * ITEM.vertices
    found = pushed(positions, below)
    skin = Surface(BODY)
    assert skin.clearance(SAMPLES[0] @ positions).distances.min() < -0.01
    assert skin.clearance(SAMPLES[0] @ found).distances.min() > 0.015
    assert np.linalg.norm(found, axis=1).max() < CLOTH + 0.01
    assert np.allclose(found[ITEM.vertices[:, 0] < -0.6], positions[ITEM.vertices[:, 0] < -0.6], atol=2e-3)


def test_what_lies_as_it_lay_is_not_moved():
    assert np.array_equal(pushed(ITEM.vertices.copy(), layer()), ITEM.vertices)


def test_what_is_fixed_stays_and_is_moved_only_as_it_is_drawn():
    fixed, positions = ITEM.vertices[:, 2] > 0.3, 0.97 * ITEM.vertices
    found = pushed(positions, layer(), fixed)
    assert np.allclose(found[fixed], positions[fixed], atol=1e-6)
    assert (np.linalg.norm(found[ITEM.vertices[:, 2] < -0.3], axis=1) > 1.005).all()
    drawn = np.where(fixed[:, None], [0.0, 0.0, 0.05], 0.0)
    found = pushed(ITEM.vertices.copy(), layer(), fixed, drawn)
    assert np.allclose(found[fixed], ITEM.vertices[fixed] + drawn[fixed], atol=1e-4)
    beside = ~fixed & (ITEM.vertices[:, 2] > 0)
    assert (found[beside, 2] > ITEM.vertices[beside, 2] + 1e-3).all()


@pytest.mark.parametrize("seed", range(3))
def test_what_has_moved_little_is_seen_as_if_it_were_looked_at_anew(seed):
    random, below, count = np.random.default_rng(seed), layer(), SAMPLES[0].shape[0]
    kept, numbers, vertices = _Above(below, count), np.arange(count), ITEM.vertices.copy()
    lacked = []
    for _ in range(6):
        points = SAMPLES[0] @ vertices
        found = kept.lacking(points, numbers)
        assert np.allclose(found, _Above(below, count).lacking(points, numbers))
        lacked.append(np.count_nonzero(found.any(axis=1)))
        vertices = vertices + 0.012 * random.normal(size=vertices.shape)
    assert lacked[0] == 0 < lacked[-1]


@pytest.mark.parametrize("size", [0.05, 0.3])
def test_cells_near_to_places_hold_all_points_that_are_near_and_none_that_are_far(size):
    random = np.random.default_rng(0)
    points, places = random.uniform(-1, 1, (2000, 3)), random.uniform(-1, 1, (20, 3))
    found, away = _near_cells(points, places, size), cKDTree(places).query(points)[0]
    assert found[away <= size].all()
    assert not found[away > 2 * np.sqrt(3) * size].any()


def test_a_vertex_moves_as_far_as_any_place_near_it_has_to():
    rows = csr_array([[0.5, 0.5, 0, 0], [0, 0.2, 0.8, 0]])
    found = _directly(rows, np.array([[1.0, 0, 0], [0, 3.0, 0]]))
    assert np.allclose(found[0], [1, 0, 0])
    assert np.allclose(found[1], 3 * np.array([0.5, 0.6, 0]) / np.hypot(0.5, 0.6))
    assert np.allclose(found[2], [0, 3, 0])
    assert np.allclose(found[3], 0)


def at(x):
    """A place on the x axis."""
    return np.array([[x, 0.0, 0.0]])


def between(gap, wanted):
    """Cloth that lay on the first of two balls, so far apart on the x axis around 0, and is to keep a distance."""
    balls = [TriangleMesh(BODY.vertices + at(x * (RADIUS + gap / 2)), BODY.triangles) for x in (-1, 1)]
    both = TriangleMesh.concatenated(balls)
    start = np.array([int(balls[0].vertices[:, 0].argmax())])
    one = np.ones(1, bool)
    return _Above(Layer(Surface(both), np.array([wanted]), start, one, one[:0]), 1)


def test_cloth_is_pushed_out_of_another_limb_too_if_there_is_room_between():
    above, first = between(0.1, 0.02), np.zeros(1, np.int64)
    assert not above.lacking(at(0.0), first).any()
    # It has come into the other limb since, far enough from its own one.
    assert np.allclose(above.lacking(at(0.07), first), at(-0.04), atol=5e-3)
    assert np.allclose(above.lacking(at(-0.04), first), at(0.01), atol=5e-3)


def test_where_there_is_no_room_between_limbs_cloth_keeps_away_from_its_own():
    assert between(0.01, 0.02).lacking(at(0.003), np.zeros(1, np.int64))[0, 0] > 0.008


def test_cloth_that_is_far_from_its_own_limb_is_still_seen_to_come_nearer_to_another():
    above, first = between(0.1, 0.02), np.zeros(1, np.int64)
    assert not above.lacking(at(0.02), first).any()
    assert above.lacking(at(0.04), first)[0, 0] < -0.005
