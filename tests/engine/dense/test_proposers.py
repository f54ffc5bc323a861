# SPDX-License-Identifier: GPL-3.0-or-later
"""Which candidates are compared; what each proposer proposes is tested where all are asked, with the registration."""

from types import SimpleNamespace

import numpy as np
import pytest

from engine.dense.proposers import Contest, are_distinct, contenders


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
