# SPDX-License-Identifier: GPL-3.0-or-later
"""What says whether a matching of some samples is right, on all samples."""

import numpy as np
import pytest

from engine import Shape, TriangleMesh
from engine.hierarchical.lifted_samples import curvature_agreement, mean_orientation, sample_misfits
from engine.runtime.progress import run
from tests.shapes import creature

COUNT = 8


@pytest.fixture(scope="module")
def shape():
    made = Shape(TriangleMesh(*creature(0.5, 11)[:2]))
    run(made.sample_steps(40))
    return made


def test_the_identity_fits_everywhere(shape):
    same = np.arange(40)
    misfits = sample_misfits(shape, shape, same[:COUNT], 1)
    for found in misfits:
        np.testing.assert_allclose(found.diagonal(), 0, atol=1e-6)
        np.testing.assert_array_equal(found.argmin(axis=1), same)
    assert mean_orientation(shape, shape, same[:COUNT], same) == pytest.approx(1, abs=1e-6)
    assert curvature_agreement(shape, shape, same) == pytest.approx(1)


def test_in_a_mirror_sides_fit_only_if_they_are_reversed(shape):
    same, mirror = np.arange(40), shape.reflected()
    kept, reversed_ = (sample_misfits(shape, mirror, same[:COUNT], sign) for sign in (1, -1))
    np.testing.assert_allclose(reversed_.all.diagonal(), 0, atol=1e-6)
    np.testing.assert_allclose(kept.distances, reversed_.distances)
    assert kept.all.diagonal().mean() > 0.001
    assert mean_orientation(shape, mirror, same[:COUNT], same) == pytest.approx(-1, abs=1e-6)


def test_a_wrong_matching_neither_fits_nor_bends_alike(shape):
    images = np.random.default_rng(0).permutation(40)
    misfits = sample_misfits(shape, shape, images[:COUNT], 1)
    assert misfits.distances[np.arange(COUNT), images[:COUNT]].mean() > 0.05
    assert curvature_agreement(shape, shape, images) < 0.5
