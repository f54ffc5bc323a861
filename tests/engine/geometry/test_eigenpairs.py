# SPDX-License-Identifier: GPL-3.0-or-later
"""Eigenpairs of surfaces: known spectra, ARPACK beside ours, invariances, and meshes in a mess."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import subspace_angles
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import eigsh

from engine import HierMatchError, TriangleMesh
from engine.geometry.eigenpairs import eigenpairs, eigenpairs_steps
from engine.geometry.laplacian import LaplaceBeltrami, laplace_beltrami
from tests.shapes import compacted, creature, cylinder, icosphere, irregular, permuted, plane, rotation
from tests.steps import followed


def rectangle(count=40, width=1.0, height=1.0):
    vertices, triangles = plane(count, jitter=0.2)
    return TriangleMesh(vertices * [width, height, 1], triangles)


def rectangle_values(count, width=1.0, height=1.0):
    i, j = np.meshgrid(np.arange(200), np.arange(200))
    return np.sort((np.pi**2 * ((i / width) ** 2 + (j / height) ** 2)).ravel())[:count]


def flat_torus(n, m, width=1.0, height=1.3):
    """Operator of the rectangle with opposite sides glued: no mesh in space has these lengths."""
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
    a, b, c, d = (((i + p) % n) * m + (j + q) % m for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)))
    x, y = width / n, height / m
    diagonal = np.hypot(x, y)
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    lengths = np.repeat([[x, y, diagonal], [diagonal, x, y]], n * m, axis=0)
    return LaplaceBeltrami.from_lengths(triangles, lengths, n * m)


def arpack(operator, count):
    inverse = diags_array(1 / np.sqrt(operator.mass))
    matrix = csc_array(inverse @ operator.stiffness @ inverse)
    return np.sort(eigsh(matrix, count, sigma=-1 / operator.area, tol=0, return_eigenvectors=False))


def assert_sound(spectrum, operator, count):
    """Check what every result has to fulfil."""
    assert spectrum.complete
    assert len(spectrum) == count == spectrum.functions.shape[1]
    assert (np.diff(spectrum.values) >= 0).all()
    gram = spectrum.functions.T @ (spectrum.mass[:, None] * spectrum.functions)
    np.testing.assert_allclose(gram, np.eye(count), atol=1e-9)
    energies = spectrum.functions.T @ (operator.stiffness @ spectrum.functions)
    np.testing.assert_allclose(energies, np.diag(spectrum.values), atol=1e-5 * max(spectrum.values[-1], 1e-300))
    np.testing.assert_array_equal(spectrum.functions[operator.mass == 0], 0)


# --- known spectra


@pytest.mark.parametrize("count", [4, 16, 20, 50, 100])
def test_sphere(count):
    # count = 20, 50 end within a multiplet.
    spectrum = eigenpairs(TriangleMesh(*icosphere(25)), count)
    exact = np.concatenate([np.full(2 * degree + 1, degree * (degree + 1)) for degree in range(11)])[:count]
    assert spectrum.complete
    np.testing.assert_allclose(spectrum.values, exact, rtol=0.02, atol=1e-9)


def test_sphere_converges():
    errors = [abs(eigenpairs(TriangleMesh(*icosphere(n)), 9).values[1:4] - 2).max() for n in (8, 16)]
    assert errors[1] < 0.3 * errors[0]


def test_rectangle_with_free_boundary():
    spectrum = eigenpairs(rectangle(40, 1.0, 0.7), 30)
    np.testing.assert_allclose(spectrum.values, rectangle_values(30, 1.0, 0.7), rtol=0.02, atol=1e-9)


def test_flat_torus():
    spectrum = eigenpairs(flat_torus(48, 60), 40)
    i, j = np.meshgrid(np.arange(-20, 21), np.arange(-20, 21))
    exact = np.sort((4 * np.pi**2 * (i**2 + (j / 1.3) ** 2)).ravel())[:40]
    assert spectrum.complete
    np.testing.assert_allclose(spectrum.values, exact, rtol=0.02, atol=1e-9)


def test_flat_torus_to_the_last_digit():
    # On this grid the discrete eigenvalues are known too: those of two cycles.
    n, m, width, height = 40, 44, 1.0, 1.3
    first = (2 - 2 * np.cos(2 * np.pi * np.arange(n) / n)) * (n / width) ** 2
    second = (2 - 2 * np.cos(2 * np.pi * np.arange(m) / m)) * (m / height) ** 2
    exact = np.sort((first[:, None] + second).ravel())[:60]
    np.testing.assert_allclose(eigenpairs(flat_torus(n, m), 60).values[1:], exact[1:], rtol=1e-7)


def test_thin_strip():
    mesh = rectangle(36, 1.0, 0.01)
    spectrum = eigenpairs(mesh, 20)
    np.testing.assert_allclose(spectrum.values, rectangle_values(20, 1.0, 0.01), rtol=0.15, atol=1e-9)
    np.testing.assert_allclose(spectrum.values[:4], rectangle_values(4, 1.0, 0.01), rtol=0.01, atol=1e-9)


def test_long_tube():
    operator = laplace_beltrami(TriangleMesh(*cylinder(3, 1000, radius=1e-3, height=1.0)))
    exact = (2 - 2 * np.cos(np.pi * np.arange(30) / 1000)) * 1000**2  # a path of 1001 vertices, half mass at its ends
    np.testing.assert_allclose(eigenpairs(operator, 30).values, exact, rtol=1e-5, atol=1e-6)


# --- beside ARPACK


@pytest.mark.parametrize(
    "shape",
    [creature(1.0, 12)[:2], irregular(*creature(0.0, 9)[:2]), irregular(*plane(18)), cylinder(12, 60, height=30.0)],
    ids=["creature", "irregular", "plane", "tube"],
)
@pytest.mark.parametrize("count", [7, 60])
def test_as_arpack(shape, count):
    operator = laplace_beltrami(TriangleMesh(*shape))
    spectrum = eigenpairs(operator, count)
    assert_sound(spectrum, operator, count)
    np.testing.assert_allclose(spectrum.values[1:], arpack(operator, count)[1:], rtol=1e-6)


def test_functions_are_as_exact_as_one_needs():
    operator = laplace_beltrami(TriangleMesh(*creature(1.0, 12)[:2]))
    spectrum = eigenpairs(operator, 40)
    roots = np.sqrt(operator.mass)
    matrix = (operator.stiffness / roots[:, None] / roots).toarray()
    values, vectors = np.linalg.eigh(matrix)
    gap = np.diff(values[:41])
    for i in np.flatnonzero((gap[1:] > 0.01 * values[1:40]) & (gap[:-1] > 0.01 * values[1:40]))[:10] + 1:
        assert subspace_angles(spectrum.functions[:, [i]] * roots[:, None], vectors[:, [i]])[0] < 1e-3


# --- invariances


def test_scale_permutation_and_motion():
    vertices, triangles = creature(0.5, 10)[:2]
    spectrum = eigenpairs(TriangleMesh(vertices, triangles), 20)
    moved, shuffled, new = permuted(vertices @ rotation([3, 1, 2], 2.0).T - 7, triangles)
    other = eigenpairs(TriangleMesh(1e-3 * moved, shuffled), 20)
    np.testing.assert_allclose(other.values * 1e-6, spectrum.values, rtol=1e-6, atol=1e-12)
    # The signs too, as this shape has no symmetry.
    size = np.sqrt(spectrum.area)
    np.testing.assert_allclose(other.functions[new] * 1e-3 * size, spectrum.functions * size, atol=2e-2)


def test_poses_of_one_body_have_nearly_one_spectrum():
    first, second = (eigenpairs(TriangleMesh(*creature(pose, 14)[:2]), 15) for pose in (0.0, 1.0))
    np.testing.assert_allclose(first.values * first.area, second.values * second.area, rtol=0.1, atol=1e-9)


def test_the_same_input_gives_the_same_output():
    mesh = TriangleMesh(*creature(0.0, 10)[:2])
    first, second = eigenpairs(mesh, 25), eigenpairs(mesh, 25)
    np.testing.assert_array_equal(first.values, second.values)
    np.testing.assert_array_equal(first.functions, second.functions)


def test_signs_follow_the_cubic_moment():
    spectrum = eigenpairs(TriangleMesh(*creature(0.0, 10)[:2]), 25)
    moments = spectrum.mass @ spectrum.functions**3
    sizes = spectrum.mass @ abs(spectrum.functions) ** 3
    clear = abs(moments) > 1e-3 * sizes
    assert clear.sum() > 20
    assert (moments[clear] > 0).all()


def test_antisymmetric_functions_have_a_sign_too():
    # The second function of a strip is antisymmetric: only the values can tell.
    spectrum = eigenpairs(TriangleMesh(*plane(12)), 5)
    function = spectrum.functions[:, 1]
    peak = np.flatnonzero(abs(function) > 0.999 * abs(function).max())[0]
    assert function[peak] > 0


# --- few vertices, and meshes in a mess


@pytest.mark.parametrize("shape", [icosphere(1), plane(4)], ids=["icosahedron", "plane"])
def test_more_than_there_are(shape):
    mesh = TriangleMesh(*shape)
    operator = laplace_beltrami(mesh)
    spectrum = eigenpairs(mesh, 10_000)
    assert_sound(spectrum, operator, mesh.vertex_count)
    trace = (operator.stiffness.diagonal() / operator.mass).sum()
    assert spectrum.values.sum() == pytest.approx(trace)


@pytest.mark.parametrize("count", [0, -3])
def test_less_than_one(count):
    with pytest.raises(HierMatchError, match="At least one"):
        eigenpairs(TriangleMesh(*icosphere(1)), count)


def test_a_mess():
    vertices, triangles = irregular(*creature(1.0, 8)[:2], rounds=3, part=0.5)
    random = np.random.default_rng(0)
    doubled = triangles[random.integers(0, len(triangles), 40)]
    wings = np.stack([triangles[::50, 0], triangles[::50, 1], random.integers(0, len(vertices), len(triangles[::50]))])
    wings = wings.T[(np.roll(wings.T, 1, axis=1) != wings.T).all(axis=1)]
    vertices = vertices.copy()
    squashed = triangles[random.integers(0, len(triangles), 30)]
    vertices[squashed[:, 0]] = vertices[squashed[:, 1]]  # edges of length zero
    mesh = TriangleMesh(vertices, np.concatenate([triangles, doubled, wings]))
    operator = laplace_beltrami(mesh)
    spectrum = eigenpairs(mesh, 50)
    assert_sound(spectrum, operator, 50)
    np.testing.assert_allclose(spectrum.values[1:], arpack(operator, 50)[1:], rtol=1e-5)


@given(st.integers(0, 10_000))
@settings(max_examples=10, deadline=None)
def test_any_soup(seed):
    random = np.random.default_rng(seed)
    triangles = random.integers(0, 30, (40, 3))
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    vertices = random.standard_normal((30, 3))
    labels = TriangleMesh(vertices, triangles).component_labels[triangles[:, 0]]
    mesh = TriangleMesh(*compacted(vertices, triangles[labels == np.bincount(labels).argmax()]))
    count = min(10, mesh.vertex_count)
    assert_sound(eigenpairs(mesh, 10), laplace_beltrami(mesh), count)


# --- as a generator


def test_steps():
    operator = laplace_beltrami(TriangleMesh(*icosphere(12)))
    reports, spectrum = followed(eigenpairs_steps(operator, 30))
    fractions = [report.fraction for report in reports]
    assert len(fractions) > 8
    assert (np.diff(fractions) >= 0).all()
    assert max(fractions) <= 1
    np.testing.assert_array_equal(spectrum.values, eigenpairs(operator, 30).values)
