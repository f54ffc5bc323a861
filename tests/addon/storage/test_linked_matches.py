# SPDX-License-Identifier: GPL-3.0-or-later
"""Matches that a target keeps alone."""

from __future__ import annotations

from functools import partial
from timeit import repeat

from hiermatch.hiermatch_addon.storage.linked_matches import forget_linked, has_linked, linked_prefixes

from tests.addon.scenes import add_blob

PROPERTY = "hiermatch_linked"


def test_the_matches_are_not_read_to_tell_that_there_are_some():
    """Clear asks at each redraw whether there are any, and they may have many megabytes."""
    obj = add_blob("Target")
    assert not has_linked(obj)
    obj.data[PROPERTY] = {"HM": bytes(10_000_000), "Other": bytes(1)}
    assert has_linked(obj)
    whole = min(repeat(obj.data[PROPERTY].to_dict, number=1, repeat=5))
    assert min(repeat(partial(has_linked, obj), number=1, repeat=5)) < whole / 3
    forget_linked(obj, "HM")
    assert linked_prefixes(obj) == ("Other",)
