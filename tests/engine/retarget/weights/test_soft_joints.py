# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of a body in one piece, after one in plates."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import ClosestPoints, SurfaceMap, TriangleMesh
from engine.mesh.connectivity.welded_parts import WeldedParts
from engine.retarget.weights.soft_joints import with_soft_joints
from tests.shapes import cylinder

SIZE = 7.0


def limb(along=40):
    """A limb along z."""
    vertices, triangles = cylinder(24, along, radius=0.3, height=3.0)
    return SIZE * vertices, triangles


def plates(cuts, gap=0.04):
    """The same, cut into plates with gaps between them, each moved by a bone of its own."""
    vertices, triangles = limb(60)
    ends = [0, *cuts, 3.0]
    found, weights = [], []
    for number, (low, high) in enumerate(pairwise(ends)):
        part = vertices.copy()
        part[:, 2] = SIZE * (low + gap + (high - low - 2 * gap) * part[:, 2] / (3 * SIZE))
        found.append(part)
        weights += [number] * len(part)
    faces = np.concatenate([triangles + number * len(vertices) for number in range(len(found))])
    rows = np.arange(len(weights))
    return TriangleMesh(np.concatenate(found), faces), csr_array((np.ones(len(rows)), (rows, weights)))


def carried(source, weights, target):
    found = ClosestPoints(source).nearest(target.vertices)
    there = SurfaceMap.from_barycentric(source, found.triangles, found.barycentric)
    hard = csr_array(weights[source.triangles[found.triangles, found.barycentric.argmax(axis=1)]])
    return hard, with_soft_joints(hard, WeldedParts.of(target), WeldedParts.of(source), there)


@pytest.mark.parametrize("cuts", [[1.5], [0.8, 1.9]])
def test_weights_pass_over_gradually_at_joints_alone(cuts):
    source, weights = plates(cuts)
    target = TriangleMesh(*limb())
    hard, soft = (one.toarray() for one in carried(source, weights, target))
    np.testing.assert_allclose(soft.sum(axis=1), 1)
    one, other = target.edges.T
    steps = [np.abs(one_of[one] - one_of[other]).sum(axis=1).max() for one_of in (hard, soft)]
    assert steps[0] == 2
    assert steps[1] < 0.6
    z = target.vertices[:, 2] / SIZE
    away = np.abs(z[:, None] - cuts).min(axis=1)
    np.testing.assert_array_equal(soft[away > 0.35], hard[away > 0.35])
    order = np.argsort(z, kind="stable")
    assert (np.diff(soft[order, 0].reshape(-1, 24).mean(axis=1)) <= 1e-9).all()


def test_a_bent_joint_is_not_torn():
    source, weights = plates([1.5])
    target = TriangleMesh(*limb())
    turn = np.array([[1, 0, 0], [0, 0.5, -np.sqrt(0.75)], [0, np.sqrt(0.75), 0.5]])
    joint = SIZE * np.array([0, 0, 1.5])
    stretch = []
    for rows in carried(source, weights, target):
        bent = rows.toarray()[:, 1:]
        posed = (1 - bent) * target.vertices + bent * ((target.vertices - joint) @ turn.T + joint)
        stretch.append((TriangleMesh(posed, target.triangles).edge_lengths / target.edge_lengths).max())
    assert stretch[1] < 0.6 * stretch[0]


def test_short_plates_keep_their_middle():
    source, weights = plates([1.4, 1.5, 1.6], gap=0.01)
    hard, soft = (one.toarray() for one in carried(source, weights, TriangleMesh(*limb(120))))
    assert (hard.max(axis=0) == 1).all()
    assert (soft.max(axis=0) == 1).all()


def test_plates_stay_plates():
    """What is in separate pieces may turn apart."""
    source, weights = plates([1.5])
    target = TriangleMesh(source.vertices * [1.1, 1.1, 1.0], source.triangles)
    hard, soft = carried(source, weights, target)
    np.testing.assert_array_equal(hard.toarray(), soft.toarray())


def test_what_was_painted_hard_stays_hard():
    """The source is in one piece: its weights are as its maker wanted them."""
    source = TriangleMesh(*limb(60))
    upper = (source.vertices[:, 2] > 1.5 * SIZE).astype(int)
    weights = csr_array((np.ones(len(upper)), (np.arange(len(upper)), upper)))
    hard, soft = carried(source, weights, TriangleMesh(*limb()))
    np.testing.assert_array_equal(hard.toarray(), soft.toarray())
