# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.transfer_weights`, across a match that the objects carry."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.operators.carrying.transfers import HIERMATCH_OT_transfer_weights
from hiermatch.hiermatch_addon.scene.deform_layer import read_weights, write_weights
from scipy.sparse import csr_array


def heights(obj):
    """From 0 at the bottom of an object to 1 at its top, (n,)."""
    z = np.array([vertex.co.z for vertex in obj.data.vertices])
    return (z - z.min()) / np.ptp(z)


def test_weights_cross_a_stored_match(dense_pair):
    source, target = dense_pair
    high = heights(source)
    write_weights(source, ["high", "low"], csr_array(np.stack([high, 1 - high], axis=1)))
    matched = [group.name for group in target.vertex_groups]
    assert bpy.ops.hiermatch.transfer_weights(source="Source", target="Target") == {"FINISHED"}
    assert [group.name for group in target.vertex_groups] == [*matched, "high", "low"]
    weights = read_weights(target).toarray()[:, [target.vertex_groups.find(name) for name in ("high", "low")]]
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-5)
    assert abs(weights[:, 0] - heights(target)).mean() < 0.05


def test_a_source_without_weights_is_told_and_nothing_changes(dense_pair):
    _, target = dense_pair
    matched = [group.name for group in target.vertex_groups]
    with pytest.raises(RuntimeError, match="no vertex groups"):
        bpy.ops.hiermatch.transfer_weights(source="Source", target="Target")
    assert [group.name for group in target.vertex_groups] == matched


def test_every_option_is_named_and_described():
    properties = bpy.ops.hiermatch.transfer_weights.get_rna_type().properties
    for about in properties:
        if about.identifier.startswith("weight_"):
            assert about.name
            assert about.description
            assert not about.description.endswith(".")
    assert not HIERMATCH_OT_transfer_weights.bl_description.endswith(".")
