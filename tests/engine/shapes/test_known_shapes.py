# SPDX-License-Identifier: GPL-3.0-or-later
import pickle

import numpy as np
import pytest

from engine import KnownShapes, MatchError, MatchSettings, Shape, TriangleMesh, match
from engine.matching import matching
from tests.shapes import icosphere

QUICK = MatchSettings(points=12, coarse_points=4, coarse_candidates=8, samples=48, hypotheses=2)
MORE = MatchSettings(points=10, coarse_points=4, coarse_candidates=8, samples=60, hypotheses=2, dense=False)


def egg(*scales, subdivisions=5):
    vertices, triangles = icosphere(subdivisions)
    return TriangleMesh(vertices * scales + 0.3 * vertices[:, :1] * vertices, triangles)


def test_a_match_of_known_shapes_is_the_same_to_the_last_bit(monkeypatch):
    source, target = egg(1, 2, 3), egg(1, 2, 4, subdivisions=6)
    known = KnownShapes()
    match(source, target, MORE, known=known)  # which takes other samples, and another spectrum
    assert len(known) == 2
    alone = match(source, target, QUICK)
    monkeypatch.setattr(matching, "prepared_steps", None)
    copies = [TriangleMesh(mesh.vertices, mesh.triangles) for mesh in (source, target)]
    again = match(*copies, QUICK, known=known)
    for name in "source_to_target", "target_to_source":
        first, second = getattr(alone, name), getattr(again, name)
        np.testing.assert_array_equal(first.triangles, second.triangles)
        np.testing.assert_array_equal(first.barycentric, second.barycentric)
        np.testing.assert_array_equal(first.confidence, second.confidence)
    np.testing.assert_array_equal(alone.target_points.positions, again.target_points.positions)
    assert alone.quality == again.quality
    assert alone.notes == again.notes


def test_it_knows_a_mesh_by_its_role_and_by_what_is_left_out():
    mesh, known = egg(1, 2, 3), KnownShapes()
    half = mesh.vertices[:, 2] > 0
    shape = Shape(mesh)
    known.keep(mesh, "source", None, shape)
    assert known.find(mesh, "source", None) is shape
    assert known.find(TriangleMesh(mesh.vertices, mesh.triangles), "source", None) is shape
    assert known.find(mesh, "target", None) is None
    assert known.find(mesh, "source", half) is None
    assert known.find(TriangleMesh(mesh.vertices + 1e-9, mesh.triangles), "source", None) is None
    assert known.find(TriangleMesh(mesh.vertices, mesh.triangles[:, [1, 2, 0]]), "source", None) is None


def test_its_memory_is_bounded_and_what_was_used_last_stays():
    meshes = [egg(1, 2, 3 + number) for number in range(4)]
    known = KnownShapes(1e9)
    for mesh in meshes:
        shape = Shape(mesh)
        list(shape.sample_steps(100))
        known.keep(mesh, "source", None, shape)
    known.trim()
    assert len(known) == 4
    known.find(meshes[0], "source", None)
    known.megabytes = 0.5  # one has 100 rows of 252 numbers of four bytes, and more
    known.trim()
    assert 1 <= len(known) < 4
    assert known.find(meshes[0], "source", None) is not None
    known.megabytes = 0.0
    known.trim()
    assert len(known) == 0


def test_its_memory_is_bounded_after_a_match_that_fails_as_well():
    known = KnownShapes(0.01)
    with pytest.raises(MatchError, match="no such vertex"):
        match(egg(1, 2, 3), egg(1, 2, 4), MORE, landmarks=[[0, 10**6]], known=known)
    assert len(known) == 0


def test_with_no_memory_nothing_is_kept():
    mesh, known = egg(1, 2, 3), KnownShapes(0)
    known.keep(mesh, "source", None, Shape(mesh))
    assert known.find(mesh, "source", None) is None


def test_what_is_sent_is_empty():
    mesh, known = egg(1, 2, 3), KnownShapes(7)
    known.keep(mesh, "source", None, Shape(mesh))
    sent = pickle.loads(pickle.dumps(known))  # noqa: S301 - our own
    assert (len(sent), sent.megabytes) == (0, 7)
    assert repr(known) == "<KnownShapes: 1, at most 7 MB>"
