# SPDX-License-Identifier: GPL-3.0-or-later
"""Skirts over legs of bodies that have no hips but them."""

import numpy as np
import pytest

from engine import TriangleMesh, WornItem, hanging_triangles
from engine.retarget.wear.wearing import dressed_steps
from engine.runtime.progress import run
from tests.shapes import cylinder, icosphere, rotation


def tube(low, high, radii, aside=0.0):
    """A tube about a line beside the z axis, open at both ends, of such radii below and above."""
    vertices, triangles = cylinder(24, 12, 1.0, high - low)
    along = vertices[:, 2:] / (high - low)
    vertices[:, :2] *= radii[0] + (radii[1] - radii[0]) * along
    return TriangleMesh(vertices + np.array([aside, 0.0, low]), triangles)


def ball(centre, size):
    vertices, triangles = icosphere(8)
    return TriangleMesh(vertices * size + np.array(centre), triangles)


TRUNK = ball((0.0, 0.0, 3.7), (0.8, 0.6, 1.5))
LEGS = [tube(-2.0, 1.2, (0.3, 0.35), aside) for aside in (-0.45, 0.45)]


def dressed(cloth, *others):
    """A body in cloth, and which of its triangles are that."""
    body = TriangleMesh.concatenated([cloth, *others])
    return body, np.arange(body.triangle_count) < cloth.triangle_count


def heights(mesh, chosen):
    return mesh.vertices[mesh.triangles[chosen]].mean(axis=1)[:, 2]


def turned(mesh):
    """The same elsewhere, in other units, cut open at every edge."""
    corners = mesh.triangles.ravel()
    vertices = 37.0 * mesh.vertices[corners] @ rotation([1.0, -2.0, 0.5], 0.8).T + [5.0, 0.0, -90.0]
    return TriangleMesh(vertices, np.arange(len(corners)).reshape(-1, 3))


def test_a_skirt_hangs_where_there_are_legs_in_it_and_is_the_hips_above():
    body, cloth = dressed(tube(0.3, 2.2, (0.95, 0.65)), TRUNK, *LEGS)
    for mesh in (body, turned(body)):
        hanging = hanging_triangles(mesh, cloth)
        assert not hanging[~cloth].any()
        assert hanging[cloth & (heights(body, slice(None)) < 0.8)].all()
        assert not hanging[cloth & (heights(body, slice(None)) > 2.0)].any()
    assert not hanging_triangles(body, np.zeros_like(cloth)).any()


def test_each_place_counts_alone():
    """A hood that holds things together, on one piece with a skirt."""
    skirt, hood = tube(0.3, 2.2, (0.95, 0.65)), tube(5.6, 6.6, (0.7, 0.7))
    seam = [skirt.vertex_count - 1, skirt.vertex_count - 2, skirt.vertex_count]
    robe = TriangleMesh.concatenated([skirt, hood])
    robe = TriangleMesh(robe.vertices, np.vstack([robe.triangles, seam]))
    horns = [tube(5.6, 6.6, (0.15, 0.15), aside) for aside in (-0.4, 0.4)]
    body, cloth = dressed(robe, TRUNK, *LEGS, *horns)
    hanging, high = hanging_triangles(body, cloth), heights(body, slice(None)) > 3
    assert hanging[cloth & (heights(body, slice(None)) < 0.8)].all()
    assert not hanging[high].any()


@pytest.mark.parametrize(
    "bodies",
    [
        (tube(0.3, 2.2, (0.95, 0.65)), TRUNK),  # no legs in it
        (tube(-1.0, 0.8, (0.55, 0.5), 0.45), TRUNK, *LEGS),  # around one leg
        (ball((0.0, 0.0, 1.2), (1.15, 0.9, 1.0)), TRUNK, *LEGS),  # closed below
    ],
)
def test_what_is_as_good_as_skin_does_not_hang(bodies):
    assert not hanging_triangles(*dressed(*bodies)).any()


def test_what_closes_a_skirt_above_is_within_the_body_that_it_hangs_on():
    skirt = tube(0.3, 2.2, (0.95, 0.65))
    top = np.flatnonzero(skirt.vertices[:, 2] > 2.19)
    middle = skirt.vertex_count
    lid = np.stack([top, np.roll(top, -1), np.full(len(top), middle)], axis=1)
    closed = TriangleMesh(np.vstack([skirt.vertices, [0.0, 0.0, 2.2]]), np.concatenate([skirt.triangles, lid]))
    whole, cloth = dressed(closed, TRUNK, *LEGS)
    seen = TriangleMesh(whole.vertices, whole.triangles[~hanging_triangles(whole, cloth)])
    assert seen.triangle_count < whole.triangle_count
    found = [run(dressed_steps(seen, [WornItem(closed)], whole=every)).buried.hidden for every in (whole, None)]
    assert middle in found[0]
    assert middle not in found[1]
