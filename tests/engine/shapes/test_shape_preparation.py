# SPDX-License-Identifier: GPL-3.0-or-later
"""Two shapes prepared at once, and what other processes are sent of shapes."""

import pickle

import numpy as np
import pytest

from engine import Shape, TriangleMesh
from engine.dense.spectral_domain import MapDomain
from engine.runtime.blas_threads import one_thread
from engine.runtime.progress import run
from engine.shapes.shape_preparation import Wanted, prepared_shapes_steps, spectra_apart_steps
from tests.shapes import creature, icosphere, irregular, permuted, plane, rotation

WANTED = Wanted(40, 12, 20)


def meshes():
    return TriangleMesh(*creature(0.5, 9)[:2]), TriangleMesh(*irregular(*icosphere(7), seed=2))


def one_after_the_other(mesh, wanted=WANTED):
    shape = Shape(mesh)
    run(shape.sample_steps(wanted.samples, wanted.measured))
    with one_thread():
        run(shape.spectrum_steps(wanted.eigenpairs))
    return shape


def assert_same(first, second, wanted=WANTED):
    first, second = (shape.limited(wanted.samples, wanted.measured) for shape in (first, second))
    np.testing.assert_array_equal(first.samples.vertices, second.samples.vertices)
    np.testing.assert_array_equal(first.samples.rows, second.samples.rows)
    np.testing.assert_array_equal(first.spectrum.functions, second.spectrum.functions)


def test_both_have_what_they_would_have_one_after_the_other():
    shapes = [Shape(mesh) for mesh in meshes()]
    run(prepared_shapes_steps(*shapes, WANTED))
    for shape, mesh in zip(shapes, meshes(), strict=True):
        assert_same(shape, one_after_the_other(mesh))


def test_what_they_have_is_not_computed_again():
    shapes = [Shape(mesh) for mesh in meshes()]
    run(prepared_shapes_steps(*shapes, WANTED))
    spectra = [shape.spectrum for shape in shapes]
    assert list(prepared_shapes_steps(*shapes, WANTED)) == []
    assert [shape.spectrum for shape in shapes] == spectra
    more = Wanted(50, 20, 20)
    run(prepared_shapes_steps(*shapes, more))
    for shape, mesh in zip(shapes, meshes(), strict=True):
        assert_same(shape, one_after_the_other(mesh, more), more)


def test_eigenpairs_may_not_be_wanted():
    shapes = [Shape(mesh) for mesh in meshes()]
    run(prepared_shapes_steps(*shapes, Wanted(30)))
    assert [len(shape.samples) for shape in shapes] == [30, 30]
    with pytest.raises(RuntimeError, match="spectrum"):
        shapes[0].spectrum  # noqa: B018


def test_one_shape_may_be_both():
    shape = Shape(meshes()[0])
    run(prepared_shapes_steps(shape, shape, WANTED))
    assert_same(shape, one_after_the_other(meshes()[0]))


def test_what_is_sent_is_the_same_as_long_as_nothing_changes():
    shape = one_after_the_other(meshes()[0])
    sent = shape.lean()
    assert sent.is_sent_once
    assert not shape.is_sent_once
    assert shape.lean() is sent
    assert sent.lean() is sent
    run(shape.sample_steps(60, 30))
    more = shape.lean()
    assert more is not sent
    assert (len(sent.samples.rows), len(more.samples.rows)) == (12, 30)
    run(shape.spectrum_steps(25))
    assert shape.lean() is not more


def test_what_arrives_elsewhere_says_the_same_of_the_surface():
    shape = one_after_the_other(meshes()[0]).limited(40, 12)
    sent = MapDomain(shape, 20)
    arrived = pickle.loads(pickle.dumps(sent))  # noqa: S301 - our own
    assert not hasattr(arrived.shape, "original")
    for name in "functions", "vertices", "signatures", "patches", "curvature", "gradients", "places":
        np.testing.assert_array_equal(getattr(arrived, name), getattr(sent, name))
    np.testing.assert_array_equal(arrived.shape.samples.distances, sent.shape.samples.distances)


# --- spectra


def apart(first, second):
    return run(spectra_apart_steps(Shape(first), Shape(second)))


def test_spectra_of_one_surface_do_not_depend_on_units_place_and_order():
    vertices, triangles = plane(12, jitter=0.3)
    moved = 50 * vertices @ rotation((1, 2, 3), 1.0).T + [3.0, 1.0, -2.0]
    assert apart(TriangleMesh(vertices, triangles), TriangleMesh(*permuted(moved, triangles)[:2])) < 1e-6


def test_spectra_of_rectangles_differ_as_their_eigenvalues_do():
    """Those of a rectangle with sides a and b are pi^2 (m^2 / a^2 + n^2 / b^2), for all m and n from 0 on."""
    vertices, triangles = plane(50)
    m, n = np.mgrid[:30, :30].reshape(2, -1)
    first, second = (np.sort(np.square(m) / side + np.square(n) * side)[1:31] for side in (1.0, 3.0))  # of area one
    long = TriangleMesh(vertices * [3.0, 1.0, 1.0], triangles)
    found = apart(TriangleMesh(vertices, triangles), long)
    assert found == pytest.approx(np.abs(np.log(first / second)).mean(), rel=0.05)


def test_the_spectrum_of_a_surface_with_few_vertices_is_compared_as_far_as_it_goes():
    octahedron = TriangleMesh(*icosphere(1))
    assert apart(octahedron, octahedron) == 0.0
