# SPDX-License-Identifier: GPL-3.0-or-later
"""Dense meshes are registered once more, with more details than what was matched has."""

import numpy as np
import pytest

from engine import MatchSettings, Shape, TriangleMesh, match
from engine.dense import densify as dense_match
from engine.registration import fine_registration as polishing
from engine.runtime.progress import run
from tests.shapes import creature, subdivided

QUICK = MatchSettings(points=12, samples=100, hypotheses=2)
COARSE, FINER = 500, 1500


@pytest.fixture(scope="module")
def bodies():
    """A body at rest and, in another meshing, bent, both dense; and the rest positions of both."""
    found = []
    for vertices, triangles, rest in (creature(0.0, 9)[:3], creature(0.8, 9, turn=0.7)[:3]):
        found.append((TriangleMesh(*subdivided(vertices, triangles, 2)), subdivided(rest, triangles, 2)[0]))
    return found


@pytest.fixture(autouse=True)
def _few_vertices(monkeypatch):
    monkeypatch.setattr(polishing, "_VERTICES", FINER)


def shapes(bodies):
    return [Shape(mesh, proxy_vertices=COARSE) for mesh, _ in bodies]


def mean_errors(result, bodies):
    (x, rest_x), (y, rest_y) = bodies
    there = np.linalg.norm(rest_x - result.source_to_target.transfer(rest_y), axis=1) / np.sqrt(x.area)
    back = np.linalg.norm(rest_y - result.target_to_source.transfer(rest_x), axis=1) / np.sqrt(y.area)
    return there.mean(), back.mean()


def test_the_finer_surface_lies_between_the_mesh_and_what_was_matched(bodies):
    shape = shapes(bodies)[0]
    finer, _ = run(polishing.finer_surfaces_steps(shape.surface, shape.surface))
    mesh = finer.proxy.mesh
    assert shape.mesh.vertex_count < mesh.vertex_count < bodies[0][0].vertex_count / 2
    assert finer.coarse.mesh is shape.mesh
    assert len(finer.coarse.points) == mesh.vertex_count
    gaps = np.linalg.norm(finer.coarse.points.positions - mesh.vertices, axis=1)
    assert gaps.mean() < 0.2 * shape.mesh.edge_lengths.mean()
    nearest = np.linalg.norm(mesh.vertices[finer.coarse.vertices] - shape.mesh.vertices, axis=1)
    assert nearest.max() < 2 * mesh.edge_lengths.max()


def test_a_mesh_that_is_not_dense_is_registered_as_it_is(bodies, monkeypatch):
    monkeypatch.setattr(polishing, "_VERTICES", 10**6)
    shape = shapes(bodies)[0]
    finer, _ = run(polishing.finer_surfaces_steps(shape.surface, shape.surface))
    assert finer.proxy.is_identity
    assert finer.coarse is shape.surface.proxy


def test_details_come_nearer_to_the_truth(bodies, monkeypatch):
    polished = mean_errors(match(*shapes(bodies), QUICK), bodies)
    monkeypatch.setattr(dense_match, "_POLISHED", 100)
    plain = mean_errors(match(*shapes(bodies), QUICK), bodies)
    assert polished[0] < plain[0]
    assert polished[1] < plain[1]
    assert max(polished) < 0.012


def test_with_too_many_vertices_nothing_is_registered_once_more(bodies, monkeypatch):
    monkeypatch.setattr(dense_match, "_POLISHED", bodies[1][0].vertex_count - 1)
    monkeypatch.setattr(polishing, "register_steps", lambda *_, **__: pytest.fail("registered"))
    result = match(*shapes(bodies), QUICK)
    assert np.isfinite(result.source_to_target.positions).all()


def test_landmarks_are_held_while_details_are_registered(bodies, monkeypatch):
    (_, rest_x), (_, rest_y) = bodies
    pairs = np.array([(v, np.linalg.norm(rest_y - rest_x[v], axis=1).argmin()) for v in (10, 500, 2000)])
    held, steps = [], polishing.register_steps

    def recorded(source, target, *given, ties, **others):
        registration = yield from steps(source, target, *given, ties=ties, **others)
        held.append(np.linalg.norm(ties.evaluate @ registration.positions - ties.places, axis=1).max())
        return registration

    monkeypatch.setattr(polishing, "register_steps", recorded)
    result = match(*shapes(bodies), QUICK, landmarks=pairs)
    assert len(held) == 2
    assert max(held) < 1e-6
    np.testing.assert_array_equal(result.source_to_target.nearest_vertices[pairs[:, 0]], pairs[:, 1])
    np.testing.assert_array_equal(result.target_to_source.nearest_vertices[pairs[:, 1]], pairs[:, 0])
