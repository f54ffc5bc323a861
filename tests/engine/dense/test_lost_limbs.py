# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends of limbs that maps lose on both surfaces: a body in two poses, one leg of which lies on the other."""

from dataclasses import replace

import numpy as np
import pytest

from engine import SurfacePoints, run
from engine.dense import proposers
from engine.dense.dense_registration import registered_pair_steps
from engine.dense.functional_maps import PointMaps
from engine.dense.lost_limbs import lost_limbs
from engine.dense.proposers import Contest
from engine.dense.registered_hypotheses import Follower, at_vertices
from engine.registration.positional_constraints import Ties
from tests.bodies import mirrored_body
from tests.registered import shape, start_from

MIRROR = np.array([1, -1, 1])


class Bodies:
    """The body at rest and in a pose, of one triangulation; and which vertices are on its left fore leg."""

    def __init__(self):
        vertices, triangles, self.rest = mirrored_body(0.0, 9)
        self.x, self.y = shape(vertices, triangles), shape(mirrored_body(0.6, 9)[0], triangles)
        self.leg = (self.rest[:, 0] > 0.2) & (self.rest[:, 2] < -0.35) & (self.rest[:, 1] > 0)
        self.other = np.array([self.nearest(place * MIRROR) for place in self.rest])

    def nearest(self, place):
        """Vertex nearest to a place at rest."""
        return np.linalg.norm(self.rest - place, axis=1).argmin()

    def truth(self):
        """The true maps."""
        same = np.arange(len(self.rest))
        return PointMaps(same, same.copy())

    def lost(self):
        """The true maps, but that both left fore legs lie on the right ones."""
        maps = self.truth()
        return PointMaps(*(np.where(self.leg, self.other, own) for own in (maps.on_y, maps.on_x)))


@pytest.fixture(scope="module")
def bodies():
    return Bodies()


def test_true_maps_lose_no_limbs(bodies):
    assert lost_limbs(bodies.x, bodies.y, bodies.truth()).shape == (0, 2)


def test_limbs_that_are_lost_on_both_surfaces_belong_together(bodies):
    pairs = lost_limbs(bodies.x, bodies.y, bodies.lost())
    assert len(pairs) >= 1
    assert bodies.leg[pairs].all()
    assert np.linalg.norm(bodies.rest[pairs[:, 0]] - bodies.rest[pairs[:, 1]], axis=1).max() < 0.15 * bodies.x.scale


def test_limbs_that_only_one_surface_has_are_left_alone(bodies):
    knee = bodies.nearest([*bodies.rest[bodies.leg][:, :2].mean(axis=0), -0.4])
    vertices = bodies.x.mesh.vertices.copy()
    vertices[bodies.leg, 2] = -0.4 + 0.05 * (vertices[bodies.leg, 2] + 0.4)
    stump = shape(vertices, bodies.x.mesh.triangles)
    maps = PointMaps(*(np.where(bodies.leg, knee, own) for own in (bodies.truth().on_y, bodies.truth().on_x)))
    assert lost_limbs(bodies.x, stump, maps).shape == (0, 2)
    assert lost_limbs(stump, bodies.x, maps).shape == (0, 2)


def test_nothing_is_said_where_hardly_anything_is_at_home(bodies):
    nowhere = PointMaps(np.zeros(len(bodies.rest), int), np.zeros(len(bodies.rest), int))
    assert lost_limbs(bodies.x, bodies.y, nowhere).shape == (0, 2)


@pytest.fixture(scope="module")
def astray(bodies):
    """What follows the bodies, and the true candidate, but that its left fore leg has come to lie on the right one."""
    x, y = bodies.x, bodies.y
    chosen = x.samples.vertices[:20]
    pair = run(registered_pair_steps(x, y, [start_from(x, y, chosen, chosen)], search=False))
    right = pair.candidates[0]
    lost = bodies.lost()
    registration = replace(
        right.registration,
        positions=pair.target.vertices[lost.on_y],
        on_target=at_vertices(pair.target, lost.on_y),
        on_source=at_vertices(pair.source, lost.on_x),
    )
    wrong = replace(right, registration=registration, score=right.score + 3)
    return Follower(x, y, pair.source, pair.target), wrong


def misplaced(bodies, follow, candidate):
    """Mean distance of the vertices of the leg from where they belong, in sqrt(area)."""
    away = candidate.registration.positions - follow.target.vertices
    return np.linalg.norm(away[bodies.leg], axis=1).mean()


def test_a_limb_that_lies_on_another_is_put_where_it_belongs_if_that_is_more_credible(bodies, astray):
    follow, wrong = astray
    found = run(proposers.PROPOSERS[2].steps(Contest(follow), [wrong]))
    assert misplaced(bodies, follow, wrong) > 0.1
    assert misplaced(bodies, follow, found[0]) < 0.05
    assert wrong in found
    best = replace(wrong, score=wrong.score - 100)
    assert run(proposers.PROPOSERS[2].steps(Contest(follow), [best]))[0] is best


def test_landmarks_alone_hold_limbs_where_there_are_any(bodies, astray):
    follow, wrong = astray
    held = SurfacePoints.at_vertices(bodies.x.mesh, np.array([0]))
    tied = replace(follow, ties=Ties.at(bodies.x.mesh, held, follow.target.vertices[:1]))
    assert run(proposers.PROPOSERS[2].steps(Contest(tied), [wrong])) == [wrong]


def test_vertices_that_are_held_together_meet(bodies, astray):
    follow, wrong = astray
    pairs = np.column_stack([np.flatnonzero(bodies.leg)[:1]] * 2)
    held = run(follow.held_steps(wrong.hypothesis, pairs))
    here, there = held.registration.positions[pairs[0, 0]], follow.target.vertices[pairs[0, 1]]
    assert np.linalg.norm(here - there) < 0.02
