# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples as a value: it does not change while a sampler goes on, and serves the reflected surface as well."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from engine import Shape, TriangleMesh
from engine.geometry.geodesics import GeodesicSolver
from engine.mesh.reflection import reflected_mesh
from engine.runtime.progress import run
from engine.shapes.surface_samples import SurfaceSampler
from tests.shapes import icosphere, irregular

VERTICES, TRIANGLES = irregular(*icosphere(4), seed=2)
MESH = TriangleMesh(VERTICES * [1, 1.4, 2] + 0.2 * VERTICES[:, :1] * VERTICES[:, 1:2], TRIANGLES)


@pytest.fixture
def sampler():
    made = SurfaceSampler(MESH, GeodesicSolver(MESH))
    run(made.steps(12))
    return made


def test_what_was_taken_does_not_change_while_more_is(sampler):
    before = sampler.taken
    rows = before.rows.copy()
    run(sampler.steps(20))
    assert (len(before), len(sampler.taken)) == (12, 20)
    np.testing.assert_array_equal(before.rows, rows)
    np.testing.assert_array_equal(sampler.taken.first(12).vertices, before.vertices)
    np.testing.assert_array_equal(sampler.taken.first(12).rows, rows)
    with pytest.raises(FrozenInstanceError):
        before.measured = 3


def test_of_two_that_take_samples_in_turn_neither_takes_any_from_the_other():
    shape, other = Shape(MESH), Shape(MESH)
    run(other.sample_steps(40))
    few, many = shape.sample_steps(12), shape.sample_steps(40)
    next(few), next(few)  # has measured its own, and not kept them yet
    for steps in many, few:
        for _ in steps:
            pass
    assert not shape.lacks(40)
    np.testing.assert_array_equal(shape.limited(40).samples.rows, other.samples.rows)


def test_cells_cover_the_surface_and_distances_are_those_of_the_rows(sampler):
    taken = sampler.taken
    assert taken.cell_areas.sum() == pytest.approx(1)
    np.testing.assert_allclose(taken.distances, taken.rows[:, taken.vertices], atol=0.02)
    np.testing.assert_array_equal(taken.distances, taken.distances.T)


def test_in_a_mirror_distances_stay_and_directions_turn_the_other_way(sampler):
    taken = sampler.taken
    other = taken.on(reflected_mesh(MESH))
    assert other.rows is taken.rows
    np.testing.assert_array_equal(other.distances, taken.distances)

    def turns(samples):
        u = samples.directions
        return u[:, :-1, 0] * u[:, 1:, 1] - u[:, :-1, 1] * u[:, 1:, 0]

    np.testing.assert_allclose(turns(other), -turns(taken), atol=1e-9)


def test_a_sampler_of_the_reflected_surface_goes_on_from_where_the_first_one_is(sampler):
    mirror = reflected_mesh(MESH)
    other = sampler.on(mirror, GeodesicSolver(mirror))
    assert not other.lacks(12)
    run(other.steps(20))
    run(sampler.steps(20))
    np.testing.assert_array_equal(other.taken.vertices, sampler.taken.vertices)
    np.testing.assert_allclose(other.taken.rows, sampler.taken.rows, rtol=1e-6)


def test_shapes_that_differ_in_their_samples_share_the_rest():
    shape = Shape(MESH)
    run(shape.sample_steps(20))
    run(shape.spectrum_steps(10))
    few, own = shape.limited(8), shape.starting_with(np.array([3, 5]))
    for other in (few, own):
        assert other.laplace is shape.laplace
        assert other.spectrum is shape.spectrum
        assert other.solver is shape.solver
    assert (len(few.samples), len(own.samples)) == (8, 0)
    run(few.sample_steps(15))  # more than it was limited to
    assert (len(few.samples), few.samples.measured, len(shape.samples)) == (15, 15, 20)
    np.testing.assert_array_equal(few.samples.vertices, shape.samples.vertices[:15])
