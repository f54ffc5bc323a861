# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of the same pose are laid onto each other as rigid bodies, whatever one of them lacks."""

import numpy as np
import pytest

from engine import MatchSettings, TriangleMesh, match
from engine.dense.rough_maps.rigid_maps import rigid_maps
from tests.domains import domain
from tests.shapes import compacted, creature, icosphere, rotation

QUICK = MatchSettings(points=24, samples=128)
SPACING = np.sqrt(4 * np.pi / 492)  # of vertices of `lump` on the sphere
TURN = 2.5 * rotation([1.0, -2.0, 0.5], 1.9)


def lump(turn=0.0, missing=0.0, height=1.0):
    """A ball with bumps and without limbs, in a meshing of its own, that lacks a share of its triangles.

    Returns
    -------
    vertices, triangles
        The surface.
    rest : (n, 3) array of float
        The places of the vertices on the unit sphere: equal where they correspond.
    """
    sphere, triangles = icosphere(7)
    sphere = sphere @ rotation([0.3, 1.0, -0.6], turn).T
    heights = sphere[triangles].mean(axis=1) @ [0.6, -0.64, 0.48]
    kept = triangles[heights <= np.quantile(heights, 1 - missing)]
    sphere, kept = compacted(sphere, kept)
    bumps = np.array([[1.0, 0.2, 0.1], [-0.3, 1.0, 0.4], [0.1, -0.5, 1.0], [-0.7, -0.6, -0.5]])
    bumps /= np.linalg.norm(bumps, axis=1)[:, None]
    radius = 1 + height * np.exp(4 * (sphere @ bumps.T - 1)) @ [0.6, 0.35, -0.25, 0.3]
    return radius[:, None] * sphere * [1.2, 0.9, 0.8], kept, sphere


def gaps(images, rest_x, rest_y):
    """Mean distance on the sphere of images from where they belong, (n,) numbers of vertices."""
    return np.linalg.norm(rest_x - rest_y[images], axis=1).mean()


@pytest.mark.parametrize("missing", [0.0, 0.1, 0.25])
def test_a_part_is_found_on_the_whole_in_any_place_and_size(missing):
    (vertices, triangles, rest), (other, faces, other_rest) = lump(), lump(0.8, missing)
    x, y = domain(vertices, triangles), domain(other @ TURN.T + [5, -3, 1], faces)
    best = rigid_maps(x, y)[0]
    rest, other_rest = rest[x.vertices], other_rest[y.vertices]
    assert gaps(best.on_x, other_rest, rest) < 0.6 * SPACING
    kept = np.linalg.norm(rest[:, None] - other_rest, axis=2).min(axis=1) < SPACING
    assert np.linalg.norm(rest - other_rest[best.on_y], axis=1)[kept].mean() < 0.6 * SPACING
    best = rigid_maps(y, x)[0]
    assert gaps(best.on_y, other_rest, rest) < 0.6 * SPACING


def test_maps_are_distinct_and_few():
    x, y = domain(*icosphere(6)), domain(*icosphere(7))
    found = rigid_maps(x, y)
    assert len(found) == 2
    assert np.linalg.norm(y.places[found[0].on_y] - y.places[found[1].on_y], axis=1).mean() > 0.07


def test_bodies_that_are_bent_differently_are_no_rigid_ones():
    straight, other, bent = creature(0.0, 9), creature(0.0, 10, turn=1.0), creature(2.4, 9)
    assert rigid_maps(domain(*straight[:2]), domain(*other[:2]))
    assert not rigid_maps(domain(*straight[:2]), domain(*bent[:2]))


def test_a_few_vertices_are_enough():
    x, y = domain(*icosphere(1)), domain(*icosphere(6))
    for points in (*rigid_maps(x, y), *rigid_maps(y, x)):
        assert points.on_y.max() < max(len(x.vertices), len(y.vertices))


@pytest.mark.parametrize("missing", [0.06, 0.22])
def test_what_is_left_of_a_body_without_limbs_is_matched_with_the_whole(missing):
    """Its extremities and all distances are others, but it is where it was."""
    (vertices, triangles, rest), (other, faces, other_rest) = lump(height=0.5), lump(0.8, missing, 0.5)
    source, target = TriangleMesh(vertices, triangles), TriangleMesh(other @ TURN.T, faces)
    found = match(source, target, QUICK).target_to_source
    away = np.linalg.norm(found.transfer(rest) - other_rest, axis=1)
    assert away.mean() < 0.8 * SPACING
    assert away.max() < 3 * SPACING
