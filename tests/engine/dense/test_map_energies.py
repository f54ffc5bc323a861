# SPDX-License-Identifier: GPL-3.0-or-later
from types import SimpleNamespace

import numpy as np
import pytest

from engine.dense.functional_maps import FunctionalMaps, PointMaps, fit_functional_maps
from engine.dense.map_energies import curvature_terms, distance_term, map_orientation, rigidity_term, spectral_terms
from tests.domains import domain
from tests.shapes import creature, rotation


def at_vertices(x, y):
    """Point maps between samples that are the same vertices."""
    number = np.full((2, x.shape.mesh.vertex_count), -1)
    number[0, x.vertices], number[1, y.vertices] = np.arange(len(x.vertices)), np.arange(len(y.vertices))
    points = PointMaps(number[1, x.vertices], number[0, y.vertices])
    assert min(points.on_y.min(), points.on_x.min()) >= 0
    return points


# Fewer vertices than fine samples: all are samples, so that any two shapes of one meshing have the same ones.
@pytest.fixture(scope="module")
def body():
    return domain(*creature(0.0, 9)[:2])


@pytest.fixture(scope="module")
def bent():
    return domain(*creature(1.0, 9)[:2])


@pytest.fixture(scope="module")
def reflected(body):
    mesh = body.shape.mesh
    return domain(mesh.vertices * [1, -1, 1] + 3, mesh.triangles[:, ::-1])


def fitted(x, y, points, size=40):
    return fit_functional_maps(x.fine_basis, y.fine_basis, points, size)


def test_the_identity_has_no_defect(body):
    points = at_vertices(body, body)
    maps = fitted(body, body, points)
    assert all(value < 1e-12 for value in spectral_terms(body, body, maps).values())
    assert curvature_terms(body, body, points) == {"curvature": 0, "waves": 0}
    assert rigidity_term(body, body, points, 40) == pytest.approx(1e-3)  # the least there is
    assert map_orientation(body, body, points, maps) == 1


def test_spectral_terms_follow_their_definitions(body, bent):
    rng = np.random.default_rng(0)
    p, q = rng.standard_normal((2, 12, 12))
    terms = spectral_terms(body, bent, FunctionalMaps(p, q))
    a, b, unit = np.diag(body.values[:12]), np.diag(bent.values[:12]), np.eye(12)
    assert terms["bijectivity"] == pytest.approx(np.linalg.norm(p @ q - unit) ** 2 / 12)
    commutators = np.linalg.norm(p @ b - a @ p) ** 2 + np.linalg.norm(q @ a - b @ q) ** 2
    assert terms["commutator"] == pytest.approx(commutators / (np.linalg.norm(a) ** 2 + np.linalg.norm(b) ** 2))


def test_a_bent_copy_keeps_orientation_and_a_reflected_one_does_not(body, bent, reflected):
    for other, sign in ((bent, 1), (reflected, -1)):
        points = at_vertices(body, other)
        assert sign * map_orientation(body, other, points, fitted(body, other, points)) > 0.8


def test_every_term_prefers_the_truth_to_a_wrong_map(body, bent):
    true = at_vertices(body, bent)
    rng = np.random.default_rng(1)
    wrong = PointMaps(rng.permutation(true.on_y), rng.permutation(true.on_x))
    for measure in (
        lambda points: curvature_terms(body, bent, points)["curvature"],
        lambda points: curvature_terms(body, bent, points)["waves"],
        lambda points: distance_term(body, bent, points),
        lambda points: rigidity_term(body, bent, points, 40),
        *(
            lambda points, name=name: spectral_terms(body, bent, fitted(body, bent, points))[name]
            for name in ("bijectivity", "commutator")
        ),
    ):
        assert measure(true) < 0.6 * measure(wrong)


def test_distances_do_not_change_under_the_identity(body):
    same = PointMaps(np.arange(len(body.vertices)), np.arange(len(body.vertices)))
    assert distance_term(body, body, same) < 1e-3


def test_changes_of_distances_are_close_to_measured_ones(body, bent):
    rng = np.random.default_rng(2)
    near = np.linalg.norm(bent.places[:, None] - bent.places, axis=2).argsort(axis=1)[:, :4]
    points = PointMaps(*(near[np.arange(len(near)), rng.integers(0, 4, len(near))] for _ in range(2)))
    changes = []
    for x, y, images in ((body, bent, points.on_y), (bent, body, points.on_x)):
        ends = y.vertices[images[:40]]
        measured = y.shape.solver.distances(ends)[:, ends] / y.shape.scale
        changes.append(np.abs(x.shape.samples.distances[:40, :40] - measured).mean())
    assert distance_term(body, bent, points) == pytest.approx(np.mean(changes), abs=0.01)


def test_rigid_motions_are_rigid_and_reflections_are_not(body, reflected):
    mesh = body.shape.mesh
    moved = domain(40 * mesh.vertices @ rotation([1.0, 1.0, 0.0], 2.0).T + 7, mesh.triangles)
    still = rigidity_term(body, body, at_vertices(body, body), 40)
    assert rigidity_term(body, moved, at_vertices(body, moved), 40) == pytest.approx(still)
    assert rigidity_term(body, reflected, at_vertices(body, reflected), 40) > 50 * still


def test_both_directions_count_alike(body, bent):
    points = at_vertices(body, bent)
    back = PointMaps(points.on_x, points.on_y)
    assert distance_term(body, bent, points) == pytest.approx(distance_term(bent, body, back))
    assert rigidity_term(body, bent, points, 40) == pytest.approx(rigidity_term(bent, body, back, 40))
    assert curvature_terms(body, bent, points) == pytest.approx(curvature_terms(bent, body, back))


def test_maps_of_constants_alone_have_no_defect():
    constants = SimpleNamespace(values=np.zeros(1))
    assert set(spectral_terms(constants, constants, FunctionalMaps(np.eye(1), np.eye(1))).values()) == {0.0}
