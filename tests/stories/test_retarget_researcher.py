# SPDX-License-Identifier: GPL-3.0-or-later
"""A researcher's story: two arrays of vertices and triangles, a skeleton with weights, and the engine alone."""

import numpy as np
import pytest

from engine import (
    MatchSettings,
    Skeleton,
    TriangleMesh,
    bone_frames,
    carry_offsets_steps,
    carry_weights,
    fit_rig,
    match,
    run,
    surface_frames,
)
from engine.retarget.rig.bone_fit import skinned
from tests.engine.retarget.rig.test_bone_fit import pose
from tests.shapes import creature, permuted
from tests.skeletons import CONTROLS, creature_bones, creature_weights


@pytest.mark.slow
def test_a_creature_is_matched_and_rigged_with_arrays_only():
    # X at rest, with a rig; Y: other vertices, in a pose, turned and ten times as large.
    names, parents, heads, tails = creature_bones()
    rest_x, faces_x, _ = creature(0.0, 12)
    rest_y, faces_y, _ = creature(0.0, 13)
    rest_y, faces_y, _ = permuted(rest_y, faces_y)
    skeleton = Skeleton(parents, heads, tails)
    weights = creature_weights(rest_x)
    linear, translations = pose(skeleton, angle=0.25, scale=10.0, seed=2)
    x = TriangleMesh(rest_x, faces_x)
    y = TriangleMesh(skinned(rest_y, creature_weights(rest_y), linear, translations), faces_y)

    # The correspondence, both ways, and the rig in the other body.
    result = match(x, y, MatchSettings(points=32, samples=128))
    assert result.quality.orientation > 0.9
    rig = fit_rig(x, y, result.source_to_target, result.target_to_source, weights=weights, skeleton=skeleton)
    true_heads = np.einsum("bij,bj->bi", linear, heads) + translations
    moving = [number for number, name in enumerate(names) if name not in CONTROLS]
    errors = np.linalg.norm(rig.heads - true_heads, axis=1)[moving] / np.sqrt(y.area)
    assert errors.mean() < 0.02

    # Weights, and the offsets of a shape key, for every vertex of Y.
    carried = carry_weights(weights, rig.target_to_source)
    np.testing.assert_allclose(np.asarray(carried.sum(axis=1)).ravel(), 1, atol=1e-9)
    assert np.abs((carried - creature_weights(rest_y)).toarray()).sum(axis=1).mean() < 0.15
    key = 0.1 * np.maximum(rest_x[:, :1], 0) * [0.0, 0.0, 1.0]
    frames = bone_frames(rig, surface_frames(x, rig.source_to_target.positions))
    (offsets,) = run(carry_offsets_steps(key[None], frames, y, rig.target_to_source))
    true_key = 0.1 * np.maximum(rest_y[:, :1], 0) * [0.0, 0.0, 1.0]
    turned = np.einsum("nij,nj->ni", _linear_at(creature_weights(rest_y), linear), true_key)
    assert np.linalg.norm(offsets - turned) < 0.25 * np.linalg.norm(turned)


def _linear_at(weights, linear):
    """Linear part of the skinning at each vertex, (n, 3, 3)."""
    return (weights @ linear.reshape(-1, 9)).reshape(-1, 3, 3)
