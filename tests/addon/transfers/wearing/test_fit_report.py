# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of a fitted item."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hiermatch.engine import FittedItem
from hiermatch.hiermatch_addon.transfers.wearing.fit_report import done, doubt
from scipy.sparse import csr_array


def fitted(*, confidence=1.0, bare=0, through=0.0):
    """An item of ten vertices, of which so many have no skin below them."""
    zeros, turns = np.zeros(10), np.broadcast_to(np.eye(3), (10, 3, 3))
    return FittedItem(
        positions=np.zeros((10, 3)),
        rotations=turns,
        scales=zeros + 1,
        places=csr_array((10, 4)),
        pieces=np.full(10, -1),
        clearance=zeros,
        pushed=zeros,
        confidence=zeros + confidence,
        bare=np.arange(10) < bare,
        through=through,
    )


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, ""),
        ({"bare": 1}, ""),  # a collar at an open neck
        ({"bare": 6}, '"Boots" should be checked: the body ends below 60% of it.'),
        (
            {"bare": 6, "through": 0.02, "confidence": 0.1},
            (
                '"Boots" should be checked: what is below still shows through 2.0% of it, the match is uncertain below '
                "100% of it, the body ends below 60% of it."
            ),
        ),
    ],
)
def test_what_is_doubtful_is_said(given, said):
    assert doubt("Boots", fitted(**given)) == said


@pytest.mark.parametrize(
    ("is_body", "said"),
    [
        (False, '"Boots" was fitted: pushed 100% of it out of what is below.'),
        (True, '"Boots" was fitted: laid onto the skin of the other body.'),
    ],
)
def test_what_is_the_skin_itself_is_not_said_to_be_pushed_out_of_it(is_body, said):
    pushed = replace(fitted(), pushed=np.ones(10))
    assert done("Boots", pushed, is_body=is_body) == said
