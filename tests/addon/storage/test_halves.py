# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects carry a match, and what it costs to find out."""

from __future__ import annotations

from functools import partial
from timeit import repeat

from hiermatch.hiermatch_addon.storage.halves import find_carriers, find_half, is_mirrored
from hiermatch.hiermatch_addon.storage.writing import MARKER


def shortest(call):
    """Seconds of a call, at best."""
    return min(repeat(call, number=20, repeat=10)) / 20


def test_the_points_of_a_match_are_not_read_to_find_it(dense_pair):
    """Crowds are of many objects with one mesh, which are looked at whenever they move."""
    source = dense_pair[0]
    source.data[MARKER]["HM"]["kept"]["answers"] = bytes(5_000_000)  # as of very many points
    whole = shortest(source.data[MARKER].to_dict)
    assert shortest(partial(is_mirrored, source)) < whole / 3
    assert shortest(partial(find_carriers, [source], find_half(source).key, "HM", "source")) < whole / 3
