# SPDX-License-Identifier: GPL-3.0-or-later
"""Places that correspond because landmarks do, by where they are in space."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from engine.dense.laid_start import laid_start
from engine.mesh.triangle_mesh import TriangleMesh
from engine.shapes.surface_samples import SurfaceSamples
from tests.shapes import creature, rotation

TIPS = ((1.4, 0, 0.3), (-1.3, 0, 0.2), (0.45, 0.2, -1.0), (0.45, -0.2, -0.9), (-0.5, 0.2, -1.2))
"""Near the ends of head, tail and three legs."""

REST, TRIANGLES, _ = creature(resolution=9)
AT_TIPS = cdist(TIPS, REST).argmin(axis=1)


def sampled(vertices, first=AT_TIPS, seed=0):
    """A surface whose samples begin with landmarks; all others follow in any order."""
    others = np.setdiff1d(np.random.default_rng(seed).permutation(len(vertices)), first)
    order = np.concatenate([first, np.random.default_rng(seed).permutation(others)])
    mesh = TriangleMesh(vertices, TRIANGLES)
    rows = cdist(vertices[order], vertices).astype(np.float32)
    return SimpleNamespace(mesh=mesh, samples=SurfaceSamples(mesh, order, rows, len(order)))


def places(start):
    """The vertices that are the places of a start, of either surface."""
    return start.source_distances.argmin(axis=1), start.target_distances.argmin(axis=1)


def test_places_correspond_between_bodies_of_other_proportions_and_poses():
    bodies = REST, creature(0.3, resolution=9)[0] * [0.8, 1.2, 1.4]
    here, there = places(laid_start(sampled(bodies[0]), sampled(bodies[1], seed=1), len(TIPS)))
    assert (here[: len(TIPS)] == AT_TIPS).all()
    assert (there[: len(TIPS)] == AT_TIPS).all()
    assert len(here) == len(TIPS) + 2 * 32
    wrong = np.linalg.norm(REST[here] - REST[there], axis=1)
    assert np.median(wrong) < 0.15
    assert np.quantile(wrong, 0.9) < 0.45


def test_how_the_surfaces_lie_in_space_does_not_matter():
    source, target = sampled(REST), sampled(creature(0.3, resolution=9)[0] * [0.8, 1.2, 1.4])
    turned = sampled(2.5 * target.mesh.vertices @ rotation([1.0, -2.0, 0.5], 2.1).T + [3.0, -7.0, 1.0])
    first, other = (places(laid_start(source, end, len(TIPS))) for end in (target, turned))
    assert np.mean(first[0] == other[0]) > 0.95
    assert np.mean(first[1] == other[1]) > 0.95


def test_landmarks_in_a_plane_tell_the_two_sides_of_it_apart():
    flat = cdist([(1.4, 0, 0.38), (-1.3, 0, 0.16), (0.4, 0, 0.35), (-0.4, 0, -0.28)], REST).argmin(axis=1)
    here, there = places(laid_start(sampled(REST, flat), sampled(REST * [0.8, 1.2, 1.4], flat, seed=1), len(flat)))
    sides = REST[here, 1], REST[there, 1]
    aside = np.abs(sides[0]) > 0.15
    assert aside.sum() > 10
    assert (np.sign(sides[0][aside]) == np.sign(sides[1][aside])).all()


@pytest.mark.parametrize("here", [(0, 1, 2), (2, 0, 2), (2, 2, 2)])
@pytest.mark.parametrize("there", [(0, 1, 2), (3, 3, 4), (3, 3, 3)])
def test_landmarks_may_be_at_one_place(here, there):
    ends = AT_TIPS[list(here)], AT_TIPS[list(there)]
    start = laid_start(sampled(REST, ends[0]), sampled(REST, ends[1]), 3)
    assert np.isfinite(start.source_distances).all()
    assert [list(place[:3]) for place in places(start)] == [list(end) for end in ends]


@pytest.mark.parametrize("count", [3, 5])
def test_small_surfaces_have_fewer_places(count):
    few = sampled(REST)
    few.samples = few.samples.first(count + 2)
    assert len(places(laid_start(few, sampled(REST), count))[0]) == count + 2 + 32
