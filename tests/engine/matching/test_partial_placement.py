# SPDX-License-Identifier: GPL-3.0-or-later
"""Where on a body its part may belong."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import Shape, TriangleMesh
from engine.matching.partial_placement import _Carrier, part_placements_steps
from engine.runtime.progress import run
from tests.shapes import compacted, creature


def sampled(vertices, triangles):
    shape = Shape(TriangleMesh(vertices, triangles))
    run(shape.sample_steps(200, 64))
    return shape.limited(200, 64)


@pytest.fixture(scope="module")
def bodies():
    """The creature at rest, and its front half in another pose and meshing, each with its places at rest."""
    vertices, triangles, rest = creature(0.0, 9)
    whole = sampled(vertices, triangles), rest
    vertices, triangles, rest = creature(0.8, 9, turn=0.7)
    vertices, triangles = compacted(np.hstack([vertices, rest]), triangles[rest[triangles, 0].min(axis=1) > 0])
    return whole, (sampled(vertices[:, :3], triangles), vertices[:, 3:])


def errors(whole, part, images):
    """How far each sample of the part is, at rest, from the sample of the whole that it goes to."""
    (shape, rest), (other, other_rest) = whole, part
    return np.linalg.norm(rest[shape.samples.vertices[images]] - other_rest[other.samples.vertices], axis=1)


def test_the_best_way_is_where_the_part_belongs(bodies):
    whole, part = bodies
    best = run(part_placements_steps(whole[0], part[0], 4))[0]
    spacing = cKDTree(whole[1][whole[0].samples.vertices]).query(part[1])[0].mean()
    assert np.median(errors(whole, part, best)) < 3 * spacing


def test_ways_differ(bodies):
    whole, part = bodies
    found = run(part_placements_steps(whole[0], part[0], 6))
    assert len(found) == 6
    distances = whole[0].samples.distances
    for number, images in enumerate(found):
        for other in found[:number]:
            assert distances[images, other].mean() > 0.05


def test_size_and_place_of_either_do_not_matter(bodies):
    whole, part = bodies
    expected = run(part_placements_steps(whole[0], part[0], 1))[0]
    mesh = part[0].mesh
    moved = sampled(1000 * mesh.vertices + [5.0, -3.0, 100.0], mesh.triangles)
    found = run(part_placements_steps(whole[0], moved, 1))[0]
    np.testing.assert_array_equal(found, expected)


def test_of_each_size_many_matchings_are_carried_over_that_differ_in_units_of_the_part(bodies, monkeypatch):
    """Variations of the best few would leave no room for others."""
    tried: dict[float, list[np.ndarray]] = {}
    carried = _Carrier.carried

    def noted(self, images, unit):
        tried.setdefault(unit, []).append(images)
        return carried(self, images, unit)

    monkeypatch.setattr(_Carrier, "carried", noted)
    (whole, _), (part, _) = bodies
    run(part_placements_steps(whole, part, 1))
    distances = whole.samples.distances
    assert min(tried) < 0.6 < max(tried) == 1
    for unit, found in tried.items():
        assert len(found) > 20
        apart = [distances[one, other].mean() for number, one in enumerate(found) for other in found[:number]]
        assert 0.05 * unit < min(apart) < 0.13 * unit
