# SPDX-License-Identifier: GPL-3.0-or-later
"""Which weights a fitted item gets."""

from __future__ import annotations

import numpy as np
from hiermatch.hiermatch_addon.transfers.options.wear import WearSettings
from hiermatch.hiermatch_addon.transfers.wearing.item_weights import (
    ItemWeights,
    chosen_weights,
    in_columns,
    replaced,
    within_limit,
)
from scipy.sparse import csr_array

OLD = {"arm", "hand", "skirt"}
SKIN = csr_array(np.array([[0.25, 0.75], [1.0, 0.0], [0.5, 0.5]]))


def own(names, rows, locked=()):
    return ItemWeights(tuple(names), csr_array(np.array(rows, float)), frozenset(locked))


def rows(weights, *names):
    return in_columns(weights, names).toarray()


def test_weights_in_bones_that_the_other_rig_has_are_kept():
    item = own(["arm", "hand", "Seam"], [[1, 0, 0.3], [0.5, 0.5, 0], [0, 1, 1]])
    found = chosen_weights(item, ["arm", "hand"], SKIN, OLD, WearSettings())
    np.testing.assert_array_equal(rows(found, "arm", "hand"), rows(item, "arm", "hand"))
    assert found.lost == ()


def test_a_rig_with_other_names_gives_those_of_its_skin():
    item = own(["arm", "hand"], [[1, 0], [0.5, 0.5], [0, 1]])
    found = chosen_weights(item, ["upper", "lower"], SKIN, OLD, WearSettings())
    np.testing.assert_allclose(rows(found, "upper", "lower"), SKIN.toarray())
    assert found.lost == ("arm", "hand")
    kept = chosen_weights(item, ["upper", "lower"], SKIN, OLD, WearSettings(weights="OWN"))
    assert kept.lost == ()


def test_what_bones_moved_that_are_lacking_is_moved_by_the_skin():
    item = own(["arm", "skirt"], [[1, 0], [0.5, 0.5], [0.8, 0.2]])
    found = chosen_weights(item, ["arm", "leg"], SKIN, OLD, WearSettings())
    np.testing.assert_allclose(rows(found, "arm", "leg"), [[1, 0], [1, 0], [0.9, 0.1]])
    assert found.lost == ("skirt",)


def test_limit_and_locked_groups():
    item = own(["arm", "hand"], [[0.6, 0.4], [0.5, 0.5], [0.2, 0.8]])
    limited = chosen_weights(item, ["arm", "hand"], SKIN, OLD, WearSettings(limit=1))
    assert ((rows(limited, "arm", "hand") > 0).sum(axis=1) == 1).all()
    np.testing.assert_allclose(rows(limited, "arm", "hand").sum(axis=1), 1)
    limited = chosen_weights(item, ["arm", "hand"], SKIN, OLD, WearSettings(weights="OWN", limit=1))
    np.testing.assert_allclose(rows(limited, "arm", "hand").max(axis=1), 1)
    locked = own(["arm", "hand"], [[0.6, 0.4], [0.5, 0.5], [0.2, 0.8]], ["arm"])
    found = chosen_weights(locked, ["arm", "hand"], SKIN, OLD, WearSettings(weights="SKIN"))
    np.testing.assert_allclose(rows(found, "arm")[:, 0], [0.6, 0.5, 0.2])
    # Where the skin has nothing in the others there is nothing to make up a whole.
    np.testing.assert_allclose(rows(found, "hand")[:, 0], [0.4, 0, 0.8])


def test_what_was_mended_is_limited_as_well():
    item = own(["arm", "hand", "Seam"], [[0.6, 0.4, 0.7], [0.5, 0.5, 0], [1, 0, 0.2]])
    found = within_limit(item, ["arm", "hand"], WearSettings(limit=1))
    np.testing.assert_allclose(rows(found, "arm", "hand")[[0, 2]], [[1, 0], [1, 0]])
    np.testing.assert_allclose(rows(found, "Seam"), rows(item, "Seam"))
    assert within_limit(item, ["arm", "hand"], WearSettings()) is item


def test_mended_weights_come_in_where_they_changed():
    item = own(["arm", "Seam"], [[1, 0.3], [1, 0.5], [1, 0]])
    mended = csr_array(np.array([[0.5, 0.5], [0.5, 0.5], [0.5, 0.5]]))
    found = replaced(item, ["arm", "leg"], mended, np.array([True, False, False]))
    np.testing.assert_allclose(rows(found, "arm", "leg", "Seam"), [[0.5, 0.5, 0.3], [1, 0, 0.5], [1, 0, 0]])
    locked = own(["arm", "Seam"], [[1, 0.3], [1, 0.5], [1, 0]], ["arm"])
    assert replaced(locked, ["arm", "leg"], mended, np.ones(3, bool)) is locked


def test_what_was_handed_over_leaves_weights_in_other_bones_alone():
    item = own(["arm", "skirt"], [[1, 0], [0.8, 0.2], [0.8, 0.2]])
    found = chosen_weights(item, ["upper", "lower", "skirt"], padded(SKIN), {"arm"}, WearSettings(), handed=True)
    np.testing.assert_allclose(rows(found, "skirt").ravel(), [0, 0.2, 0.2])
    np.testing.assert_allclose(rows(found, "upper", "lower"), SKIN.toarray() * [[1], [0.8], [0.8]])
    assert found.lost == ("arm",)


def padded(weights):
    """Weights with a column of zeros more."""
    return csr_array(np.hstack([weights.toarray(), np.zeros((weights.shape[0], 1))]))
