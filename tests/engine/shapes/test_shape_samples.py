# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples of a shape: distances from the first are measured, and from the others estimated."""

import numpy as np
import pytest

from engine import Shape, TriangleMesh
from engine.runtime.progress import run
from tests.shapes import creature, icosphere, irregular, subdivided

COUNT, MEASURED = 60, 12


def sampled(mesh, *asked):
    """Make a shape that was asked for samples in turn."""
    shape = Shape(mesh)
    for each in asked:
        run(shape.sample_steps(*each))
    return shape


def meshes():
    return {
        "creature": TriangleMesh(*creature(0.5, 11)[:2]),
        "sphere": TriangleMesh(*irregular(*icosphere(9), seed=2)),
        "grid": TriangleMesh(*subdivided(*icosphere(1), 9)),
    }


@pytest.fixture(params=meshes())
def mesh(request):
    return meshes()[request.param]


def test_the_first_are_measured_and_the_others_estimated(mesh):
    shape = sampled(mesh, (COUNT, MEASURED)).limited(COUNT, MEASURED)
    assert (len(shape.samples), shape.samples.measured) == (COUNT, MEASURED)
    true = shape.solver.distances(shape.samples.vertices) / shape.scale
    np.testing.assert_allclose(shape.samples.rows[:MEASURED], true[:MEASURED], rtol=1e-6)
    errors = shape.samples.rows[MEASURED:] - true[MEASURED:]
    assert abs(errors.mean()) < 0.008
    assert np.abs(errors).mean() < 0.02
    lengths = shape.solver.path_lengths(shape.samples.vertices) / shape.scale
    assert (lengths > true - 1e-9).all()
    assert np.abs(lengths - true).mean() > 1.5 * np.abs(errors).mean()  # what is gained by comparing them


def test_distances_between_samples_are_measured_where_they_can_be(mesh):
    shape = sampled(mesh, (COUNT, MEASURED)).limited(COUNT, MEASURED)
    between = shape.samples.distances
    np.testing.assert_array_equal(between, between.T)
    np.testing.assert_array_equal(between.diagonal(), 0)
    measured = shape.samples.rows[:MEASURED, shape.samples.vertices[MEASURED:]]
    np.testing.assert_array_equal(between[:MEASURED, MEASURED:], measured)


def test_what_was_asked_for_before_does_not_matter(mesh):
    alone = sampled(mesh, (COUNT, MEASURED)).limited(COUNT, MEASURED)
    others = [(30,), (COUNT + 5, 40)], [(COUNT + 20,)], [(25, 2), (COUNT, 50)]
    for before in others:
        shape = sampled(mesh, *before, (COUNT, MEASURED))
        view = shape.limited(COUNT, MEASURED)
        np.testing.assert_array_equal(view.samples.vertices, alone.samples.vertices)
        np.testing.assert_array_equal(view.samples.rows, alone.samples.rows)
        assert view.samples.measured == MEASURED
        run(shape.sample_steps(COUNT))
        assert shape.limited(COUNT).samples.measured == COUNT
        np.testing.assert_array_equal(shape.limited(COUNT).samples.rows, sampled(mesh, (COUNT,)).samples.rows)


def test_fewer_of_the_estimated_ones_are_the_first_of_them(mesh):
    shape = sampled(mesh, (COUNT, MEASURED)).limited(COUNT, MEASURED)
    for count, measured in ((30, MEASURED), (8, 8)):
        fewer = shape.limited(count)
        assert (len(fewer.samples), fewer.samples.measured) == (count, measured)
        np.testing.assert_array_equal(fewer.samples.rows, shape.samples.rows[:count])


def test_other_samples_of_a_shape_with_estimates_are_measured():
    shape = sampled(TriangleMesh(*creature(0.5, 11)[:2]), (COUNT, MEASURED)).limited(COUNT, MEASURED)
    other = shape.starting_with(np.array([5, 9]))
    run(other.sample_steps(20))
    assert other.samples.measured == len(other.samples) == 20
    np.testing.assert_allclose(
        other.samples.rows, other.solver.distances(other.samples.vertices) / other.scale, rtol=1e-6
    )


def test_of_few_vertices_all_are_measured():
    mesh = TriangleMesh(*icosphere(1))
    shape = sampled(mesh, (200, 100))
    assert shape.limited(200, 100) is shape
    assert len(shape.samples) == shape.samples.measured == mesh.vertex_count
