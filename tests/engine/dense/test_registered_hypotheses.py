# SPDX-License-Identifier: GPL-3.0-or-later
"""Hypotheses that are followed by registrations: long bodies that lie turned about their axes."""

from dataclasses import replace

import numpy as np
import pytest

from engine import SurfacePoints, run
from engine.dense.dense_registration import registered_pair_steps
from engine.dense.registered_hypotheses import Follower
from engine.registration.positional_constraints import Ties
from engine.registration.registration import SOFT, register_steps
from tests.bodies import fish
from tests.registered import shape, start_from
from tests.steps import returned


@pytest.fixture(scope="module")
def long_bodies():
    """A fish and the same bent sideways."""
    vertices, triangles = fish(12)
    bent = vertices.copy()
    bent[:, 1] += 0.3 * vertices[:, 0] ** 2
    return shape(vertices, triangles), shape(bent, triangles)


@pytest.fixture(scope="module")
def upset(long_bodies):
    """The fish on the bent one, with its tail upside down, and what follows it."""
    x, y = long_bodies
    chosen = x.samples.vertices[:20]
    pair = run(registered_pair_steps(x, y, [start_from(x, y, chosen, chosen)], search=False))
    right = pair.candidates[0]
    over = np.where(x.mesh.vertices[:, 0] > 0.65, -1, 1)
    positions = pair.target.in_unit_size(y.mesh.vertices * np.stack([over**2, over, over], axis=1))
    registration = run(register_steps(pair.source, pair.target, positions, (SOFT,)))
    return Follower(x, y, pair.source, pair.target), replace(
        right, registration=registration, score=right.score + 3, likeness=right.likeness - 3
    )


def misplaced(x, target, registration):
    """Mean distance of the vertices of the tail from where they belong."""
    tail = x.mesh.vertices[:, 0] > 0.75
    return np.linalg.norm(registration.positions[tail] - target.vertices[tail], axis=1).mean()


def test_long_bodies_are_turned_back_where_that_is_more_credible(upset):
    follow, candidate = upset
    ((rolled, *others),) = run(follow.rolled_back_steps([candidate]))
    assert misplaced(follow.x, follow.target, candidate.registration) > 0.1
    assert misplaced(follow.x, follow.target, rolled.registration) < 0.03
    assert rolled.score < candidate.score
    assert rolled.hypothesis is candidate.hypothesis
    assert [rolled.score, *(o.score for o in others)] == sorted([rolled.score, *(o.score for o in others)])


def test_long_bodies_stay_where_turning_them_back_is_less_credible_or_landmarks_hold_them(upset):
    follow, candidate = upset
    better = replace(candidate, score=candidate.score - 100)
    assert run(follow.rolled_back_steps([better]))[0][0] is better
    held = SurfacePoints.at_vertices(follow.x.mesh, follow.x.samples.vertices[:1])
    ties = Ties.at(follow.x.mesh, held, follow.target.vertices[follow.x.samples.vertices[:1]])
    assert run(replace(follow, ties=ties).rolled_back_steps([candidate])) == [[candidate]]


def test_of_all_other_ways_to_lie_those_of_the_best_are_tried_and_three_at_most(upset, monkeypatch):
    follow, candidate = upset[0], replace(upset[1], in_place=0.0)
    second = replace(candidate, score=candidate.score - 1)
    way = candidate.registration.positions + 0.5
    tried = []
    monkeypatch.setattr(Follower, "turned_back_steps", lambda _self, own: returned((own, [way, way])))
    monkeypatch.setattr(Follower, "lying_steps", lambda _self, own, _way: tried.append(own.score) or returned(own))
    ways = run(follow.rolled_back_steps([candidate, second]))
    assert tried == [second.score, second.score, candidate.score]
    assert [len(found) for found in ways] == [2, 3]


def test_where_a_map_is_looked_for_long_bodies_are_turned_back(long_bodies, upset, monkeypatch):
    x, y = long_bodies
    monkeypatch.setattr(Follower, "steps", lambda _self, hypothesis: returned(replace(upset[1], hypothesis=hypothesis)))
    pair = run(registered_pair_steps(x, y))
    assert misplaced(x, pair.target, pair.registration) < 0.03
    assert pair.candidates[0].score < upset[1].score


def test_a_way_to_lie_that_is_no_better_at_first_is_registered_closely_as_well(long_bodies, upset, monkeypatch):
    x, y = long_bodies
    over = upset[1].registration

    def ways(_self, candidates):
        return returned([[c, replace(c, registration=over, score=c.score + 1)] for c in candidates])

    closely = []
    own = Follower.close_steps
    monkeypatch.setattr(Follower, "rolled_back_steps", ways)
    monkeypatch.setattr(Follower, "close_steps", lambda self, c: closely.append(c.registration) or own(self, c))
    chosen = x.samples.vertices[:20]
    pair = run(registered_pair_steps(x, y, [start_from(x, y, chosen, chosen)]))
    assert over in closely
    assert len(closely) == 2
    assert misplaced(x, pair.target, pair.registration) < 0.03
