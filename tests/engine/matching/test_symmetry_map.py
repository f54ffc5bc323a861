# SPDX-License-Identifier: GPL-3.0-or-later
"""The dense left-right map of a posed body whose mirror images are known."""

import numpy as np
import pytest

from engine import MatchSettings, TriangleMesh, symmetry_map
from engine.matching.symmetry_map import symmetry_map_steps
from tests.bodies import mirrored_body
from tests.steps import followed

QUICK = MatchSettings(points=40, samples=200)


@pytest.fixture(scope="module")
def body():
    vertices, triangles, rest = mirrored_body(0.6, 11, seed=0)
    return TriangleMesh(vertices, triangles), rest


@pytest.fixture(scope="module")
def watched(body):
    """What the computation yields on the way, and returns."""
    return followed(symmetry_map_steps(body[0], QUICK))


@pytest.fixture(scope="module")
def mirrored(watched):
    return watched[1]


def test_every_vertex_goes_to_its_mirror_image(body, mirrored):
    mesh, rest = body
    for found in (mirrored.source_to_target, mirrored.target_to_source):
        gap = np.linalg.norm(found.transfer(rest) - rest * [1, -1, 1], axis=1) / np.sqrt(mesh.area)
        assert gap.mean() < 0.015
        assert gap.max() < 0.15
        assert found.orientation(mesh, mesh) < -0.9


def test_twice_the_map_is_nearly_the_identity(body, mirrored):
    mesh, rest = body
    found = mirrored.source_to_target
    gap = np.linalg.norm(found.transfer(found.transfer(rest)) - rest, axis=1) / np.sqrt(mesh.area)
    assert gap.mean() < 0.02


def test_the_map_is_its_own_inverse(body, mirrored):
    assert len(mirrored.target_to_source) == body[0].vertex_count
    np.testing.assert_allclose(mirrored.target_to_source.positions, mirrored.source_to_target.positions, atol=1e-12)


def test_progress_rises(watched):
    fractions = [report.fraction for report in watched[0]]
    assert fractions == sorted(fractions)
    assert fractions[0] >= 0
    assert fractions[-1] <= 1


def test_a_leg_that_is_shorter_than_its_partner_still_belongs_to_it():
    vertices, triangles, rest = mirrored_body(0.6, 11, seed=0)
    straight, _, _ = mirrored_body(0.0, 11, seed=0)
    leg = (straight[:, 0] > 0.2) & (straight[:, 1] < 0) & (straight[:, 2] < -0.5)
    top = vertices[leg][straight[leg, 2].argmax()]
    vertices = vertices.copy()
    vertices[leg] = top + 0.85 * (vertices[leg] - top)
    mesh = TriangleMesh(vertices, triangles)
    gap = np.linalg.norm(symmetry_map(mesh, QUICK).source_to_target.transfer(rest) - rest * [1, -1, 1], axis=1)
    assert gap.mean() < 0.02 * np.sqrt(mesh.area)
    assert gap.max() < 0.2 * np.sqrt(mesh.area)
