# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine.dense.credibility import (
    ALL_ALIKE,
    CREDIBLE,
    DOUBTFUL,
    EVEN,
    LITTLE_RISE,
    MUCH_ALIKE,
    RISE,
    closeness,
    has_failed,
    is_clear_choice,
    is_less_alike,
    is_likely,
    is_placed,
    least_likeness,
    likeness,
    map_score,
    may_reach,
    place_credit,
    probability_chosen,
    probability_in_place,
    probability_right,
    probability_turned,
    registered_score,
    vertex_credibility,
)

TERMS = {"bijectivity": 0.2, "curvature": 0.5, "distances": 0.1, "rigidity": 0.05, "waves": 0.4}


@pytest.mark.parametrize("term", TERMS)
def test_a_map_with_a_smaller_term_is_more_credible(term):
    assert map_score(TERMS | {term: TERMS[term] / 2}) < map_score(TERMS)


def test_a_term_that_is_zero_is_as_good_as_a_tiny_one():
    assert map_score(TERMS | {"rigidity": 0.0}) == map_score(TERMS | {"rigidity": 1e-9})


def test_what_is_beside_the_terms_does_not_count():
    assert map_score(TERMS | {"commutator": 7.0}) == map_score(TERMS)


def test_gaps_that_are_halved_on_both_sides_are_worth_eight_doublings():
    near, far = (registered_score(-20.0, np.array(gaps)) for gaps in ([0.001, 0.002], [0.002, 0.004]))
    assert far - near == pytest.approx(8 * np.log(2))


def test_surfaces_that_meet_are_all_the_same():
    assert registered_score(-20.0, np.zeros(2)) == registered_score(-20.0, np.full(2, 1e-7))


def test_what_deforms_less_is_more_alike():
    assert likeness(-25.0, 0.5) - likeness(-25.0, 1.0) == pytest.approx(4 * np.log(2))
    assert np.isfinite(likeness(-25.0, 0.0))


def test_the_levels_of_decisions_are_probabilities():
    assert [probability_right(level) for level in (EVEN, CREDIBLE)] == pytest.approx([0.5, 0.965])
    assert [closeness(level) for level in (MUCH_ALIKE, ALL_ALIKE)] == pytest.approx([0.981, 0.99945])
    assert EVEN < CREDIBLE < MUCH_ALIKE < ALL_ALIKE


@pytest.mark.parametrize("confidence", [0.1, 0.3, 0.9])
def test_no_map_of_less_than_the_least_likeness_is_trusted_so_far(confidence):
    least = least_likeness(confidence)
    assert vertex_credibility(1.0, None, least - 0.01) < max(confidence, 0.1 + 1e-9)
    assert probability_right(least) == pytest.approx(confidence)


def test_with_landmarks_nothing_is_doubted():
    assert (probability_right(None), closeness(None), probability_chosen(None)) == (1, 1, 1)
    assert not is_less_alike(None, ALL_ALIKE)
    assert is_clear_choice(None)


def test_of_two_maps_that_are_as_good_one_is_right():
    assert probability_chosen(0.0) == 0.5
    assert not is_clear_choice(0.0)
    assert is_clear_choice(1.0)
    assert not is_clear_choice(0.99)


@pytest.mark.parametrize(
    ("orientation", "margin", "known"), [(0.5, 20.0, 30.0), (1.0, 0.0, 30.0), (1.0, 20.0, EVEN), (0.7, 0.3, 16.0)]
)
def test_vertices_are_trusted_no_more_than_the_map_as_a_whole(orientation, margin, known):
    whole = orientation * probability_chosen(margin) * probability_right(known)
    assert vertex_credibility(orientation, margin, known) == pytest.approx(min(whole, closeness(known)))
    assert vertex_credibility(1.0, None, None) == 1


@pytest.mark.parametrize(("orientation", "known"), [(-1.0, 30.0), (0.0, 30.0), (1.0, -100.0)])
def test_only_what_has_no_partner_is_not_trusted_at_all(orientation, known):
    assert vertex_credibility(orientation, None, known) == 0.1


def test_a_map_is_right_by_its_likeness_or_by_what_it_leaves_in_place():
    assert probability_right(EVEN, 0.0) == pytest.approx(0.5)
    assert probability_right(EVEN, 0.5) == pytest.approx(0.75)
    assert probability_right(-20.0, 0.9) == pytest.approx(0.9)
    assert is_likely(-20.0, 0.5)
    assert not is_likely(EVEN - 1, 0.1)
    assert is_placed(0.5)
    assert not is_placed(0.49)
    assert is_likely(None)


def test_a_map_has_failed_if_it_is_hardly_trusted_and_landmarks_do_not_lead_it():
    assert has_failed(EVEN, DOUBTFUL)
    assert has_failed(EVEN, 0.34)
    assert not has_failed(EVEN - 6, 0.35)
    assert not has_failed(None, 0.0)


def test_half_turns_are_not_in_place_and_poses_are():
    assert probability_in_place(-1 / 3) < 1e-6
    assert probability_in_place(0.95) > 0.95


def test_the_credit_of_a_place_divides_the_chances_of_other_maps():
    """A map that is not in place, with the same shape, is right as often as this one is wrong."""
    for in_place in (0.1, 0.5, 0.9):
        rest = np.exp(-place_credit(in_place))
        assert rest == pytest.approx(1 - in_place)
        credit = place_credit(in_place)
        assert registered_score(-9.0, (0.1, 0.1), credit) == registered_score(-9.0, (0.1, 0.1)) - credit


def test_a_half_turn_takes_away_from_what_stands_but_says_nothing_by_itself():
    assert probability_turned(0.95, 0.0) == 0
    assert probability_turned(0.95, 0.99) == pytest.approx(0.9 * probability_in_place(0.95))
    assert place_credit(probability_turned(1.0, 1.0)) == pytest.approx(np.log(10), rel=0.1)


def test_hope_ends_where_neither_can_become_likely():
    assert may_reach(EVEN, EVEN, 0.0)
    assert may_reach(EVEN, -20.0, probability_in_place(0.66))
    assert not may_reach(CREDIBLE, -20.0, 1.0)
    assert not may_reach(EVEN, EVEN - 6, probability_in_place(0.5))
    assert may_reach(EVEN, EVEN - RISE, 0.0)
    assert not may_reach(EVEN, EVEN - RISE, 0.0, LITTLE_RISE)
