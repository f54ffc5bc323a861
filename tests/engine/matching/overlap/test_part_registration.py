# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration where only a part has a partner, and how credible the outcome is."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.matching.overlap.overlap_score import overlap_score, shared_area
from engine.matching.overlap.part_registration import FINE, Marks, placed, register_parts
from engine.matching.overlap.part_surface import PartSurface
from tests.shapes import compacted, creature, rotation

CUT = 0.05


@pytest.fixture(scope="module")
def whole():
    vertices, triangles, rest = creature(0.0, 10)
    return PartSurface(TriangleMesh(vertices / np.sqrt(TriangleMesh(vertices, triangles).area), triangles)), rest


@pytest.fixture(scope="module")
def half(whole):
    surface, rest = whole
    triangles = surface.mesh.triangles
    both, faces = compacted(np.hstack([surface.vertices, rest]), triangles[rest[triangles][:, :, 0].min(axis=1) > CUT])
    return PartSurface(TriangleMesh(both[:, :3], faces)), both[:, 3:]


@pytest.fixture(scope="module")
def fit(whole, half):
    return register_parts(whole[0], half[0], whole[0].vertices, FINE)


def test_landmarks_of_a_rigid_motion_place_all_of_a_surface(whole):
    surface, _ = whole
    turn = rotation([1.0, 2.0, 0.5], 1.3)
    places = surface.vertices @ turn.T + [1.0, 0.0, -2.0]
    some = np.arange(0, surface.count, 60)
    marks = Marks(some, places[some], np.ones(len(some)))
    rotations = np.broadcast_to(turn, (len(some), 3, 3))
    positions, weighted = placed(surface, marks, rotations, surface.paths(some))
    np.testing.assert_allclose(positions, places, atol=1e-6)
    assert weighted.weights.sum() == pytest.approx(1)


def test_what_the_other_surface_lacks_has_no_partner(whole, half, fit):
    shown = whole[1][:, 0] > CUT
    assert (fit.members == shown).mean() > 0.95
    assert fit.members_back.mean() > 0.98
    assert shared_area(whole[0], half[0], fit) == pytest.approx(half[0].area, rel=0.05)


def test_what_has_none_stays_with_its_surroundings(whole, fit):
    """Nothing draws the rear half to the cut, so it stays where it was."""
    np.testing.assert_allclose(fit.positions, whole[0].vertices, atol=0.01)


def test_the_true_overlap_is_more_credible_than_others(whole, half, fit):
    turned = register_parts(whole[0], half[0], whole[0].vertices * [-1, -1, 1], FINE)
    moved = register_parts(whole[0], half[0], whole[0].vertices + np.array([0.1, 0.0, 0.0]), FINE[-1:])
    true, *others = (overlap_score(whole[0], half[0], each) for each in (fit, turned, moved))
    assert true > max(others) + 5


def test_nothing_in_common_is_less_credible_than_anything(whole, half):
    apart = register_parts(whole[0], half[0], whole[0].vertices + 50.0, ())
    assert not apart.members.any()
    assert overlap_score(whole[0], half[0], apart) == -np.inf


def test_the_score_does_not_depend_on_which_surface_is_which(whole, half, fit):
    back = register_parts(half[0], whole[0], half[0].vertices, FINE)
    assert overlap_score(half[0], whole[0], back) == pytest.approx(overlap_score(whole[0], half[0], fit), abs=3)


def test_rounds_can_be_gone_through_in_parts(whole, half):
    start = whole[0].vertices + np.array([0.02, 0.0, 0.0])
    near = np.zeros(whole[0].count)
    at_once = register_parts(whole[0], half[0], start, FINE, from_marks=near)
    begun = register_parts(whole[0], half[0], start, FINE[:2], from_marks=near)
    rest = register_parts(whole[0], half[0], begun.positions, FINE[2:], from_marks=near, done=2)
    np.testing.assert_allclose(rest.positions, at_once.positions, atol=1e-12)


def test_far_places_wait_until_those_at_the_landmarks_lie(whole, half):
    """With nothing near to the landmarks, no match counts, and the surface stays as it was."""
    surface, _ = whole
    start = surface.vertices + np.array([0.3, 0.0, 0.0])
    far = np.full(surface.count, 10.0)
    stayed = register_parts(surface, half[0], start, FINE, from_marks=far)
    apart = np.linalg.norm(
        stayed.positions[surface.mesh.edges[:, 0]] - stayed.positions[surface.mesh.edges[:, 1]], axis=1
    )
    np.testing.assert_allclose(apart, surface.mesh.edge_lengths, atol=1e-4)
