# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors about the input: which there are, and who raises them."""

import pickle

import numpy as np
import pytest

from engine import MatchSettings, Skeleton, TriangleMesh
from engine.hierarchical.problem import MatchingProblem
from engine.runtime import errors
from engine.runtime.errors import HierMatchError, MatchError, MeshError, RigError, SettingsError

KINDS = (MeshError, SettingsError, MatchError, RigError)


@pytest.mark.parametrize("kind", KINDS)
def test_each_is_about_the_input_and_about_nothing_else(kind):
    assert issubclass(kind, HierMatchError)
    assert issubclass(kind, ValueError)
    assert not any(issubclass(kind, other) for other in KINDS if other is not kind)


def test_these_are_all():
    assert {value for value in vars(errors).values() if isinstance(value, type)} == {HierMatchError, *KINDS}
    assert set(HierMatchError.__subclasses__()) >= set(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_they_come_from_other_processes_as_they_are(kind):
    copy = pickle.loads(pickle.dumps(kind("The mesh has no faces.")))  # noqa: S301 -- made here
    assert type(copy) is kind
    assert str(copy) == "The mesh has no faces."


@pytest.mark.parametrize(
    ("kind", "make"),
    [
        (MeshError, lambda: TriangleMesh([[0, 0, 0]], [[0, 0, 0]])),
        (SettingsError, lambda: MatchSettings(points=0)),
        (MatchError, lambda: MatchingProblem(np.zeros((3, 2)), np.zeros((3, 3)), np.zeros((2, 2)))),
        (RigError, lambda: Skeleton([0], [[0, 0, 0]], [[0, 0, 1]])),
    ],
)
def test_they_are_raised_in_sentences(kind, make):
    with pytest.raises(kind) as caught:
        make()
    message = str(caught.value)
    assert not message[0].islower()
    assert message.endswith(".")
