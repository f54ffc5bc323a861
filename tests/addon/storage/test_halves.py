# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects carry a match, and what it costs to find out."""

from __future__ import annotations

from functools import partial
from timeit import repeat

import bpy
import pytest
from hiermatch.hiermatch_addon.properties.freshness import refresh
from hiermatch.hiermatch_addon.scene.character import joined, parts_of
from hiermatch.hiermatch_addon.storage.halves import find_carriers, find_common, find_half, is_mirrored
from hiermatch.hiermatch_addon.storage.writing import MARKER

from tests.addon.scenes import QUICK, add_blob


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


def test_renamed_parts_of_a_character_keep_their_order_and_their_match():
    body, hair, target = (add_blob(name) for name in ("Body", "Hair", "Target"))
    hair.location.z, target.location.x = 2, 4
    bpy.context.view_layer.update()
    bpy.ops.hiermatch.match(source="Body + Hair", target="Target", **QUICK)
    hair.name = "A Wig"
    side = joined("Hero", [body, hair])
    assert parts_of(side) == (body, hair)
    ((half, partner),) = find_common(side, target)
    assert (half.role, partner.role) == ("source", "target")
    assert not half.staleness()
    bpy.ops.hiermatch.match(source="Body + A Wig", target="Target", **QUICK)
    assert parts_of(joined("Hero", [body, hair])) == (body, hair)
    bpy.ops.hiermatch.clear(object="Body + A Wig")
    assert parts_of(joined("Hero", [body, hair])) == (hair, body)
    assert not body.data.keys()


@pytest.mark.parametrize(
    ("side", "lacking"),
    [(side, field) for side in ("Source", "Target") for field in ("key", "role", "names", "topology", "points")]
    + [("Source", field) for field in ("answers", "written", "notes")],
)
def test_what_lacks_what_this_version_needs_is_no_match(lacking, side, dense_pair):
    """As a later version may keep it."""
    source, target = dense_pair
    del bpy.data.objects[side].data[MARKER]["HM"]["kept"][lacking]
    refresh(bpy.context.scene)
    assert "out of date" in bpy.context.scene.hiermatch.summary.stale
    assert not find_common(source, target)
    for run in (bpy.ops.hiermatch.refine, bpy.ops.hiermatch.flip, partial(bpy.ops.hiermatch.show, view="CHECKER")):
        with pytest.raises(RuntimeError, match="match"):
            run()
    assert bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK) == {"FINISHED"}
    assert find_common(source, target)
