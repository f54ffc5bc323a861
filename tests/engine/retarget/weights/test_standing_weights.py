# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np
import pytest

from engine import RigError, standing_weights
from tests.people import HANGING, at_rest_in, person


@pytest.fixture(scope="module")
def hanging():
    """Somebody whose arms hang beside the trunk."""
    return at_rest_in(person(resolution=20, fingers=False), HANGING)


def test_weights_are_shares(hanging):
    weights = standing_weights(hanging.mesh, hanging.rig.skeleton, np.ones(len(hanging.rig.names), bool))
    np.testing.assert_allclose(np.asarray(weights.sum(axis=1)).ravel(), 1.0)
    assert weights.data.min() > 0


def test_like_those_that_were_painted(hanging):
    painted = hanging.rig.weights
    moving = np.asarray(painted.sum(axis=0)).ravel() > 0
    weights = standing_weights(hanging.mesh, hanging.rig.skeleton, moving)
    areas = hanging.mesh.vertex_areas / hanging.mesh.area
    assert areas @ np.minimum(painted.toarray(), weights.toarray()).sum(axis=1) > 0.7
    arms = [number for number, name in enumerate(hanging.rig.names) if "arm" in name]
    on_arms = painted.toarray()[:, arms].sum(axis=1) > 0.99
    assert weights.toarray()[on_arms][:, arms].sum(axis=1).mean() > 0.95


def test_what_does_not_deform_moves_nothing(hanging):
    deforming = np.zeros(len(hanging.rig.names), bool)
    deforming[:3] = True
    weights = standing_weights(hanging.mesh, hanging.rig.skeleton, deforming)
    assert not weights[:, 3:].nnz
    with pytest.raises(RigError, match="No bone deforms"):
        standing_weights(hanging.mesh, hanging.rig.skeleton, np.zeros(len(hanging.rig.names), bool))
