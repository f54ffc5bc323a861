# SPDX-License-Identifier: GPL-3.0-or-later
"""Which candidates are compared; what each proposer proposes is tested where all are asked, with the registration."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

from engine import MatchError, run
from engine.dense import proposers
from engine.dense.credibility import EVEN, MUCH_ALIKE
from engine.dense.proposers import Contest, Proposer, are_distinct, contenders, proposed_steps


def test_maps_that_take_one_limb_elsewhere_are_distinct_and_those_that_err_a_little_everywhere_are_not():
    rng = np.random.default_rng(0)
    areas, places = rng.uniform(1, 2, 400), rng.standard_normal((400, 3))
    limb = np.zeros((400, 3))
    limb[:12, 0] = 0.4
    offset = np.full(3, 0.02)
    assert not are_distinct(places, places + offset, areas)
    assert are_distinct(places, places + limb, areas)
    assert not are_distinct(places, places + limb * (np.arange(400) < 4)[:, None], areas)
    assert are_distinct(places, places + 4 * offset, areas)
    # Where neither finds a partner anywhere, nothing tells them apart.
    assert not are_distinct(places, places + limb, np.zeros_like(areas))
    # Of rough maps, only what is farther away is elsewhere.
    assert not are_distinct(places, places + 0.7 * limb, areas, elsewhere=0.3)
    assert are_distinct(places, places + limb, areas, elsewhere=0.3)


@pytest.mark.parametrize(
    ("likeness", "followed"),
    [(MUCH_ALIKE + 1, ["limb", "elsewhere"]), (MUCH_ALIKE - 1, ["near", "limb", "elsewhere"])],
    ids=["alike", "unlike"],
)
def test_rough_maps_that_lead_to_a_known_one_are_not_followed_but_between_unlike_bodies(
    monkeypatch, likeness, followed
):
    limb = 0.5 * (np.arange(100) < 4)[:, None]
    starts = {"near": 0.05, "limb": limb, "again": limb, "elsewhere": 1.0, "same": 0.0}

    def following(hypotheses):
        yield from ()
        return [SimpleNamespace(hypothesis=hypothesis, score=2.0) for hypothesis in hypotheses]

    follow = SimpleNamespace(
        start=lambda images: np.zeros((100, 3)) + starts[images] * np.array([1.0, 0, 0]),
        apart=lambda first, second: np.linalg.norm(first - second, axis=1).mean(),
        source=SimpleNamespace(mass=np.full(100, 0.01)),
        all_steps=following,
    )
    best = SimpleNamespace(
        hypothesis=SimpleNamespace(is_doubtful=True, domains=None),
        registration=SimpleNamespace(positions=np.zeros((100, 3))),
        likeness=likeness,
        score=1.0,
    )

    def proposing(_domains):
        yield from ()
        return [SimpleNamespace(images=name) for name in starts]

    monkeypatch.setattr(proposers, "unrefined_hypotheses_steps", proposing)
    found = run(proposers.PROPOSERS[0].steps(Contest(follow), [best]))
    assert found[0] is best
    assert [candidate.hypothesis.images for candidate in found[1:]] == followed


@pytest.mark.parametrize(("score", "order"), [(0.5, ["limbs", "best"]), (1.5, ["best", "limbs"])])
def test_limbs_that_were_put_right_are_compared_with_what_seemed_to_exchange_them(monkeypatch, score, order):
    def returning(value):
        def steps(*_given, **_options):
            yield from ()
            return value

        return steps

    def candidate(origin, score):
        return SimpleNamespace(hypothesis=SimpleNamespace(origin=origin, domains=None), registration=None, score=score)

    follow = SimpleNamespace(x=None, y=None, vertex_maps=lambda _: None, steps=returning(candidate("limbs", score)))
    contest, candidates = Contest(follow), [candidate("best", 1.0)]
    monkeypatch.setattr(proposers, "map_hypotheses_steps", returning([candidates[0].hypothesis]))
    monkeypatch.setattr(proposers, "repaired_start_steps", returning(object()))
    found = run(proposers.PROPOSERS[1].steps(contest, candidates))
    assert [each.hypothesis.origin for each in found] == order
    monkeypatch.setattr(proposers, "repaired_start_steps", returning(None))
    assert run(proposers.PROPOSERS[1].steps(contest, candidates)) is candidates


@pytest.mark.parametrize(
    ("scores", "places", "chosen"),
    [
        ([0.0, 1.0, 2.0], [0, 1, 2], [0, 1, 2]),
        ([0.0, 1.0, 2.0], [0, 0, 2], [0, 2]),
        ([0.0, 1.0, 9.0], [0, 1, 2], [0, 1]),
        ([0.0, 1.0, 1.0, 1.0], [0, 1, 2, 3], [0, 1, 2]),
        ([2.0, 0.0, 6.0], [0, 1, 2], [0, 1]),
    ],
    ids=["all", "like", "worse", "few", "first"],
)
def test_other_maps_that_are_nearly_as_credible_as_the_first_are_contenders(scores, places, chosen):
    contest = Contest(SimpleNamespace(source=SimpleNamespace(mass=np.ones(5))))
    candidates = [
        SimpleNamespace(score=score, registration=SimpleNamespace(positions=np.full((5, 3), place, float)))
        for score, place in zip(scores, places, strict=True)
    ]
    assert contenders(contest, candidates) == [candidates[number] for number in chosen]


@pytest.mark.parametrize(
    ("likeness", "rises", "asked"),
    [
        (EVEN, 0.0, ["little", "much"]),
        (EVEN - 3, 0.0, ["much"]),  # little would not do
        (EVEN - 3, 3.0, ["much", "little"]),  # now it may
        (EVEN - 5, 0.0, []),
    ],
    ids=["likely", "unlikely", "risen", "hopeless"],
)
def test_only_what_may_make_the_map_likely_is_tried(likeness, rises, asked, monkeypatch):
    done = propose(monkeypatch, {"little": (1.0, 0.0), "much": (4.0, rises)})
    _, candidates = run(proposed_steps(contest_of(-np.inf), [candidate_of(likeness)]))
    assert done == asked
    assert candidates[0].likeness == likeness + rises * ("much" in asked)


def test_of_surfaces_that_end_somewhere_all_is_tried_as_parts_are_looked_for_from_there(monkeypatch):
    done = propose(monkeypatch, {"little": (1.0, 0.0), "much": (4.0, 0.0)})
    run(proposed_steps(contest_of(-np.inf, are_closed=False), [candidate_of(EVEN - 3)]))
    assert done == ["little", "much"]


def test_what_cannot_be_of_use_any_more_is_given_up(monkeypatch):
    done = propose(monkeypatch, {"little": (1.0, 0.0), "much": (4.0, 1.0)})
    with pytest.raises(MatchError, match="not enough alike"):
        run(proposed_steps(contest_of(30.0), [candidate_of(25.0)]))
    assert done == []
    with pytest.raises(MatchError, match="not enough alike"):
        run(proposed_steps(contest_of(30.0), [candidate_of(27.0)]))
    assert done == ["much"]


@pytest.mark.parametrize(
    ("likeness", "is_rough", "given_up"), [(30.0, False, False), (29.5, False, True), (29.5, True, False)]
)
def test_at_last_only_rough_maps_may_gain(likeness, is_rough, given_up):
    candidate = candidate_of(likeness)
    candidate.hypothesis = SimpleNamespace(is_rough=is_rough)
    with pytest.raises(MatchError, match="not enough alike") if given_up else nullcontext():
        contest_of(30.0).check_last([candidate])


@pytest.mark.parametrize(
    ("scores", "in_place", "likeness", "turned"),
    [
        ([0.0, 1.0], [0.9, 0.9], MUCH_ALIKE - 1, 0),
        ([0.0, 1.0], [0.1, 0.9], MUCH_ALIKE - 1, 1),
        ([0.0, 9.0], [0.1, 0.9], MUCH_ALIKE - 1, None),  # not credible
        ([0.0, 1.0], [0.1, 0.1], MUCH_ALIKE - 1, None),
        ([0.0, 1.0], [0.9, 0.9], MUCH_ALIKE + 1, None),  # tell front from back themselves
    ],
    ids=["best", "second", "worse", "none", "alike"],
)
def test_what_leaves_unlike_bodies_in_place_is_compared_with_a_half_turn(scores, in_place, likeness, turned):
    done = []

    def half_turned_steps(candidate):
        done.append(candidate)
        return SimpleNamespace(score=-1.0)
        yield

    candidates = [
        SimpleNamespace(score=score, in_place=each, likeness=likeness)
        for score, each in zip(scores, in_place, strict=True)
    ]
    follow = SimpleNamespace(half_turned_steps=half_turned_steps)
    (propose_turned,) = (each.steps for each in proposers.PROPOSERS if "turned" in each.steps.__name__)
    proposed = run(propose_turned(Contest(follow), candidates))
    assert done == ([] if turned is None else [candidates[turned]])
    assert [each.score for each in proposed] == [-1.0] * len(done) + scores
    assert run(propose_turned(Contest(follow, landmarks=SimpleNamespace()), candidates)) == candidates


def contest_of(least, *, are_closed=True):
    return Contest(SimpleNamespace(standing=0.0, are_closed=are_closed), least=least)


def candidate_of(likeness):
    return SimpleNamespace(likeness=likeness, in_place=0.0)


def propose(monkeypatch, named):
    """Put others in the place of all proposers, by name how far they say likeness may rise, and how far it does."""
    done = []

    def proposer(name, rise, rises):
        def steps(_contest, candidates):
            done.append(name)
            return [candidate_of(candidate.likeness + rises) for candidate in candidates]
            yield

        return Proposer(steps, rise)

    monkeypatch.setattr(proposers, "PROPOSERS", tuple(proposer(name, *each) for name, each in named.items()))
    return done
