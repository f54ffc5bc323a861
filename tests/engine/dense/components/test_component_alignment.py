# SPDX-License-Identifier: GPL-3.0-or-later
"""A part laid onto its partner."""

import numpy as np
import pytest

from engine import SurfacePoints, TriangleMesh
from engine.dense.components.component_alignment import laid_steps
from engine.dense.components.component_pairs import contact_with, paired_parts
from engine.dense.components.similarity_field import Surroundings
from engine.runtime.progress import run
from tests.shapes import icosphere, rotation

BODY = TriangleMesh(*icosphere(8))
TURN, SCALE, SHIFT = rotation([1, 2, 3], 1.0), 2.5, np.array([5.0, 0, 1])
PLACE = np.array([1.5, 0.0, 0.0])


def moved(points, turn=TURN):
    return SCALE * points @ turn.T + SHIFT


def wedge():
    """A body without any symmetry, next to the ball."""
    vertices, triangles = icosphere(6)
    x, y, z = vertices.T
    bumps = 1 + 0.4 * np.exp(-4 * ((x - 0.6) ** 2 + (y - 0.8) ** 2)) + 0.2 * np.exp(-4 * ((z - 1) ** 2 + y**2))
    return TriangleMesh(vertices * bumps[:, None] * [0.2, 0.3, 0.4] + PLACE, triangles)


def swung(part, axis, angle):
    """Turn a part about an axis through where it touches the ball, beside what the surroundings do."""
    place = contact_with(np.linalg.norm(part.vertices, axis=1), part).place
    return TriangleMesh(place + (part.vertices - place) @ rotation(axis, angle).T, part.triangles)


def laid(part, partner, *, turn=TURN, thoroughly=False):
    """Lay a part beside one ball onto its partner beside another: where its vertices arrive, and the partner's size."""
    flip = int(np.sign(np.linalg.det(turn)))
    other = TriangleMesh(moved(BODY.vertices, turn), BODY.triangles[:, ::flip])
    around = Surroundings(BODY, other, SurfacePoints.at_vertices(other, np.arange(BODY.vertex_count)))
    contacts = [
        contact_with(np.linalg.norm(mesh.vertices - centre, axis=1), mesh)
        for mesh, centre in ((part, np.zeros(3)), (partner, SHIFT))
    ]
    (pair,) = paired_parts(
        ([part], contacts[:1]), ([partner], contacts[1:]), around, np.sqrt(other.area), np.array([False])
    )
    found = run(laid_steps(around, (part, partner, pair, thoroughly)))
    assert len(found) == part.vertex_count
    return SurfacePoints.from_barycentric(partner, found.triangles, found.barycentric).positions, pair


def errors_of(part, other, **how):
    """How far vertices of a part arrive from their own of a partner that is another pose of it, in its radii."""
    partner = TriangleMesh(moved(other.vertices), part.triangles)
    places, pair = laid(part, partner, **how)
    return np.linalg.norm(places - partner.vertices, axis=1) / pair.radius


@pytest.mark.parametrize("thoroughly", [False, True])
def test_a_copy_is_laid_exactly_onto_itself(thoroughly):
    assert errors_of(wedge(), wedge(), thoroughly=thoroughly).max() < 1e-6


@pytest.mark.parametrize("thoroughly", [False, True])
@pytest.mark.parametrize("axis", [(0, 1, 0), (0, 0, 1), (1, 0, 0)])
def test_a_part_that_has_swung_a_little_is_found(axis, thoroughly):
    assert errors_of(wedge(), swung(wedge(), axis, 0.1), thoroughly=thoroughly).max() < 0.01


def test_one_that_has_swung_further_is_found_if_that_is_tried():
    other = swung(wedge(), [0, 1, 0], 0.4)
    assert errors_of(wedge(), other).mean() > 0.05
    assert errors_of(wedge(), other, thoroughly=True).max() < 0.01


def test_a_mirrored_copy_is_laid_onto_what_it_is_the_mirror_image_of():
    part, mirror = wedge(), TURN * [-1, 1, 1]
    partner = TriangleMesh(moved(part.vertices, mirror), part.triangles[:, ::-1])
    places, pair = laid(part, partner, turn=mirror)
    errors = np.linalg.norm(places - moved(part.vertices, mirror), axis=1) / pair.radius
    assert errors.max() < 1e-6


def test_a_part_that_was_turned_over_is_found_if_that_is_tried():
    # A rod that is almost the same end for end.
    vertices, triangles = icosphere(8)
    thick = 1 + 0.25 * np.exp(-6 * (vertices[:, 2] - 0.8) ** 2)
    wide = np.stack([thick, thick, np.ones(len(thick))], axis=1) * [0.1, 0.15, 0.5]
    rod = TriangleMesh(vertices * wide + PLACE, triangles)
    over = swung(rod, [1, 0, 0], np.pi)
    assert errors_of(rod, over).mean() > 0.5
    assert errors_of(rod, over, thoroughly=True).mean() < 0.02


def test_another_meshing_of_the_same_part_fits_as_well():
    part, other = wedge(), swung(wedge(), [0, 1, 0], 0.2)
    order = np.random.default_rng(0).permutation(part.vertex_count)
    partner = TriangleMesh(moved(other.vertices)[order], np.argsort(order)[part.triangles])
    places, pair = laid(part, partner)
    assert np.linalg.norm(places - moved(other.vertices), axis=1).max() < 0.05 * pair.radius


def test_the_two_sides_of_a_thin_part_are_told_apart():
    # One that is bowed by several times its thickness, so that no rigid motion lays it onto the other.
    vertices, triangles = icosphere(10)
    plate = TriangleMesh(vertices * [0.3, 0.4, 0.006] + PLACE, triangles)
    bowed = plate.vertices + 0.06 * vertices[:, :1] ** 2 * [0, 0, 1]
    partner = TriangleMesh(moved(bowed), triangles)
    found, _ = laid(plate, partner)
    back = (found - SHIFT) @ TURN / SCALE
    middle = 0.06 * ((back[:, 0] - PLACE[0]) / 0.3) ** 2
    inner = np.abs(vertices[:, 2]) > 0.5
    same = np.sign(back[inner, 2] - middle[inner]) == np.sign(vertices[inner, 2])
    assert same.mean() > 0.95
