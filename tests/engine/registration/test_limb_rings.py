# SPDX-License-Identifier: GPL-3.0-or-later
"""Forked limbs, and the rings around their prongs."""

import numpy as np
import pytest

from engine import Shape, TriangleMesh, run
from engine.geometry.laplacian import laplace_beltrami
from engine.registration.deformable import DeformableSurface
from engine.registration.limb_rings import forked_limbs
from tests.bodies import forked
from tests.shapes import rotation


def forks_of(mesh):
    made = Shape(mesh)
    run(made.sample_steps(150))
    return forked_limbs(made, DeformableSurface(mesh, laplace_beltrami(mesh)))


@pytest.fixture(scope="module")
def winged():
    return TriangleMesh(*forked(stem=0.06))


def test_a_limb_that_forks_is_found_with_both_prongs_and_its_stem(winged):
    (limb,) = forks_of(winged)
    x, y, _ = winged.vertices[limb.vertices].T
    outer = winged.vertices[:, 0] > 0.6
    assert np.isin(np.flatnonzero(outer), limb.vertices).all()
    assert y.min() < -0.3
    assert y.max() > 0.3
    assert x.min() > 0.05  # nothing of the trunk


def test_rings_lie_on_both_prongs_up_to_the_fork(winged):
    (limb,) = forks_of(winged)
    y = winged.vertices[:, 1]
    middles = [abs(ring.weights @ y[ring.vertices]) for ring in limb.rings]
    both = [(y[ring.vertices] > 0.1).any() and (y[ring.vertices] < -0.1).any() for ring in limb.rings]
    fork = both.index(False)
    assert fork >= 4
    assert max(middles) < 0.02
    assert limb.radii[:fork].max() > 3 * np.median(limb.radii[fork:])


def test_limbs_on_a_stout_body_are_no_fork():
    assert forks_of(TriangleMesh(*forked(stem=0.2))) == []


def test_order_of_the_vertices_and_motion_do_not_matter(winged):
    (limb,) = forks_of(winged)
    order = np.random.default_rng(0).permutation(winged.vertex_count)
    turned = 3 * winged.vertices[order] @ rotation([1, 2, 3], 1.0).T + [5, 0, 1]
    (other,) = forks_of(TriangleMesh(turned, np.argsort(order)[winged.triangles]))
    same = np.isin(order[other.vertices], limb.vertices)
    assert same.mean() > 0.95
    assert len(other.vertices) == pytest.approx(len(limb.vertices), rel=0.05)
