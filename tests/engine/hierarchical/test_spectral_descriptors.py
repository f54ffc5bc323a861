# SPDX-License-Identifier: GPL-3.0-or-later
"""Kernel signatures and eigenfunction descriptors: analytic values, traces and invariances."""

import numpy as np
import pytest

from engine import HierMatchError, TriangleMesh
from engine.geometry.eigenpairs import eigenpairs
from engine.hierarchical.spectral_descriptors import (
    automatic_energies,
    eigenfunction_descriptor,
    heat_kernel_signatures,
    multiplets,
    wave_kernel_signatures,
)
from tests.shapes import creature, icosphere, permuted, plane, rotation, torus

SIGNATURES = {"heat": heat_kernel_signatures, "wave": wave_kernel_signatures}


@pytest.fixture(scope="module")
def poses():
    return [eigenpairs(TriangleMesh(*creature(pose, 14)[:2]), 80) for pose in (0.0, 1.0)]


@pytest.fixture(scope="module")
def sphere():
    return eigenpairs(TriangleMesh(*icosphere(16)), 81)


@pytest.mark.parametrize("signatures", SIGNATURES.values(), ids=SIGNATURES)
def test_all_points_of_a_sphere_are_alike(sphere, signatures):
    np.testing.assert_allclose(signatures(sphere), 1, atol=0.05)


def trace(spectrum, times):
    return np.exp(-np.outer(spectrum.values * spectrum.area, times)).sum(axis=0)


def test_heat_stays_on_a_sphere_as_it_should(sphere):
    times = np.array([0.01, 0.05, 0.2, 1.0])
    degrees = np.arange(40)[:, None]
    exact = ((2 * degrees + 1) * np.exp(-4 * np.pi * degrees * (degrees + 1) * times)).sum(axis=0)
    found = heat_kernel_signatures(sphere, times) * trace(sphere, times)
    np.testing.assert_allclose(found, np.broadcast_to(exact, found.shape), rtol=0.03)


@pytest.mark.parametrize("signatures", SIGNATURES.values(), ids=SIGNATURES)
def test_the_mean_is_one(poses, signatures):
    for spectrum in poses:
        np.testing.assert_allclose(spectrum.mass @ signatures(spectrum) / spectrum.area, 1, rtol=1e-9)
        assert signatures(spectrum).min() > 0


@pytest.mark.parametrize("signatures", SIGNATURES.values(), ids=SIGNATURES)
def test_poses_are_alike_and_points_are_not(poses, signatures):
    first, second = (np.log(signatures(spectrum)) for spectrum in poses)
    between_poses = np.linalg.norm(first - second, axis=1)
    random = np.random.default_rng(0).permutation(len(first))
    between_points = np.linalg.norm(first - first[random], axis=1)
    assert np.median(between_poses) < 0.25 * np.median(between_points)


@pytest.mark.parametrize("signatures", SIGNATURES.values(), ids=SIGNATURES)
def test_units_order_and_motion_do_not_matter(signatures):
    vertices, triangles = creature(0.3, 10)[:2]
    moved, shuffled, new = permuted(vertices @ rotation([0, 1, 2], 0.7).T + 3, triangles)
    one, other = (
        eigenpairs(mesh, 40) for mesh in (TriangleMesh(vertices, triangles), TriangleMesh(50 * moved, shuffled))
    )
    np.testing.assert_allclose(signatures(other)[new], signatures(one), rtol=2e-3)


def test_tips_keep_their_heat():
    vertices, triangles, rest = creature(0.0, 12)
    signatures = heat_kernel_signatures(eigenpairs(TriangleMesh(vertices, triangles), 80), np.array([0.02]))[:, 0]
    tail = np.linalg.norm(rest - [-1.3, 0, 0.16], axis=1).argmin()
    belly = np.linalg.norm(rest - [0, 0, -0.3], axis=1).argmin()
    assert signatures[tail] > 2 * signatures[belly]


def test_waves_of_one_energy_see_the_functions_of_that_energy():
    spectrum = eigenpairs(TriangleMesh(*plane(20)), 30)
    # A narrow band around the fourth eigenvalue, which is the only one there: (1, 1).
    logs = np.log(spectrum.values[1:] * spectrum.area)
    energies = logs[2] + np.linspace(-0.01, 0.01, 3)
    found = wave_kernel_signatures(spectrum, energies)[:, 1]
    np.testing.assert_allclose(found, spectrum.functions[:, 3] ** 2 * spectrum.area, atol=0.02)


def test_automatic_scales():
    energies = automatic_energies(100, 20)
    assert len(energies) == 20
    np.testing.assert_allclose(np.diff(energies), energies[1] - energies[0])
    assert energies[-1] < np.log(4 * np.pi * 100)


def test_eigenfunctions_are_comparable():
    for size in (1.0, 1e-3):
        vertices, triangles = plane(20)
        mesh = TriangleMesh(vertices * [2 * size, size, size], triangles)
        descriptor = eigenfunction_descriptor(eigenpairs(mesh, 12), 3)
        along = np.sqrt(2) * np.cos(np.pi * vertices[:, 0])
        assert min(abs(descriptor[:, 0] - sign * along).max() for sign in (-1, 1)) < 0.02
        np.testing.assert_allclose(mesh.vertex_areas @ descriptor**2 / mesh.area, 1, rtol=1e-9)


def test_constant_functions_are_no_descriptors():
    spectrum = eigenpairs(TriangleMesh(*icosphere(5)), 12)
    assert spectrum.zero_count == 1
    assert abs(eigenfunction_descriptor(spectrum, 3).mean(axis=0)).max() < 0.1


def test_multiplets():
    groups = multiplets(np.array([1.0, 1.02, 2.0, 3.0, 3.1, 3.2, 5.0]), 0.05)
    assert [group.tolist() for group in groups] == [[0, 1], [2], [3, 4, 5], [6]]
    assert [len(group) for group in multiplets(np.array([1.0, 1.02, 2.0]), 0.001)] == [1, 1, 1]
    assert multiplets(np.array([])) == []


def test_multiplets_of_known_shapes(sphere):
    assert [len(group) for group in multiplets(sphere.values[1:36])] == [3, 5, 7, 9, 11]
    tube = eigenpairs(TriangleMesh(*torus(40, 16)), 4)
    assert len(multiplets(tube.values[1:3])[0]) == 2


@pytest.mark.parametrize("count", [0, 81, 500])
def test_as_many_functions_as_there_are(sphere, count):
    with pytest.raises(HierMatchError, match="eigenfunctions"):
        eigenfunction_descriptor(sphere, count)
