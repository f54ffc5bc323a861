# SPDX-License-Identifier: GPL-3.0-or-later
"""One person, and the way to others whose vertices are numbered alike."""

import pytest

from engine import SurfaceMap, fit_rig, pair_bones
from tests.people import person


@pytest.fixture(scope="session")
def someone():
    """A person at rest with arms stretched out."""
    return person(resolution=24, fingers=False)


@pytest.fixture(scope="session")
def paired(someone):
    """Pair the person's bones with those of a rig in the same body, in whatever pose it rests."""
    fits = {}

    def pair(body, rig, **options):
        if id(body) not in fits:
            maps = SurfaceMap.identity(body.mesh), SurfaceMap.identity(someone.mesh)
            names = {"weights": someone.rig.weights, "skeleton": someone.rig.skeleton, "refine": False}
            fits[id(body)] = body, fit_rig(someone.mesh, body.mesh, *maps, **names)
        return pair_bones(fits[id(body)][1], someone.mesh, body.mesh, rig.skeleton, rig.weights, **options)

    return pair
