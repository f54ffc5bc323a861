# SPDX-License-Identifier: GPL-3.0-or-later
"""Which parts belong together."""

import numpy as np
import pytest

from engine import SurfacePoints, TriangleMesh
from engine.dense.components.component_pairs import contact_with, paired_parts
from engine.dense.components.similarity_field import Surroundings
from tests.shapes import icosphere, rotation

BODY = icosphere(8)
PLACES = np.array([[1.2, 0, 0], [0, 1.2, 0], [0, 0, 1.2], [-1.2, 0, 0]])
SIZES = np.array([0.1, 0.1, 0.15, 0.2])


def egg(place, size):
    vertices, triangles = icosphere(4, size)
    return TriangleMesh(vertices * [1, 1, 1.3] + place, triangles)


def moved(mesh, turn, scale, shift):
    return TriangleMesh(scale * mesh.vertices @ turn.T + shift, mesh.triangles)


def pairs_of(x_parts, y_parts, *, turn=None, scale=1.0, shift=(0, 0, 0), large=False):
    """Pair parts around a ball that is moved by a similarity."""
    turn = np.eye(3) if turn is None else turn
    body = TriangleMesh(*BODY)
    other = moved(body, turn, scale, shift)
    here = Surroundings(body, other, SurfacePoints.at_vertices(other, np.arange(body.vertex_count)))
    there = Surroundings(other, body, SurfacePoints.at_vertices(body, np.arange(body.vertex_count)))
    contacts = [
        [contact_with(around.nearest(part.vertices)[0], part) for part in parts]
        for around, parts in ((here, x_parts), (there, y_parts))
    ]
    flags = np.full(len(x_parts), large)
    return paired_parts((x_parts, contacts[0]), (y_parts, contacts[1]), here, np.sqrt(other.area), flags)


@pytest.fixture(scope="module")
def parts():
    return [egg(place, size) for place, size in zip(PLACES, SIZES, strict=True)]


def test_contact_is_where_a_part_is_nearest():
    part = egg(np.array([0, 0, 2.0]), 0.5)
    heights = part.vertices[:, 2]
    contact = contact_with(heights - 1.0, part)
    assert contact.gap == pytest.approx(heights.min() - 1.0)
    assert heights[contact.vertices].max() < np.sort(heights)[len(heights) // 3]
    assert heights.argmin() in contact.vertices
    np.testing.assert_allclose(contact.place, part.vertices[contact.vertices].mean(axis=0))


def test_what_lies_on_its_surroundings_touches_them_everywhere():
    part = egg(np.zeros(3), 0.5)
    contact = contact_with(np.full(part.vertex_count, 0.3), part)
    np.testing.assert_array_equal(contact.vertices, np.arange(part.vertex_count))


@pytest.mark.parametrize("large", [False, True])
def test_parts_in_another_order_find_themselves(parts, large):
    order = [2, 0, 3, 1]
    pairs = pairs_of(parts, [parts[number] for number in order], large=large)
    assert [(pair.part, order[pair.partner]) for pair in pairs] == [(number, number) for number in range(4)]
    for pair in pairs:
        assert pair.ratio == pytest.approx(1)
        np.testing.assert_allclose(pair.centres[0], pair.centres[1], atol=1e-9)


def test_what_is_known_of_a_pair_is_that_of_the_motion_around_it(parts):
    turn, scale, shift = rotation([1, 2, 3], 1.0), 2.5, np.array([5.0, 0, 1])
    others = [moved(part, turn, scale, shift) for part in parts]
    pairs = pairs_of(parts, others[::-1], turn=turn, scale=scale, shift=shift)
    assert [(pair.part, pair.partner) for pair in pairs] == [(0, 3), (1, 2), (2, 1), (3, 0)]
    for pair in pairs:
        part = parts[pair.part]
        assert pair.ratio == pytest.approx(scale)
        for found in pair.rotations:
            np.testing.assert_allclose(found, turn, atol=1e-6)
        np.testing.assert_allclose(pair.centres[0], PLACES[pair.part], atol=1e-9)
        np.testing.assert_allclose(pair.centres[1], scale * turn @ pair.centres[0] + shift, atol=1e-9)
        np.testing.assert_allclose(
            pair.joint, scale * turn @ part.vertices[pair.touching].mean(axis=0) + shift, atol=1e-6
        )


def test_the_radius_is_the_root_mean_square_distance_from_the_centre():
    (pair,) = pairs_of([TriangleMesh(icosphere(20, 0.1)[0] + PLACES[0], icosphere(20)[1])], [egg(PLACES[0], 0.1)])
    rough = egg(np.zeros(3), 0.1)
    fine = rough.vertices[rough.triangles].mean(axis=1)
    truth = np.sqrt(np.average(np.square(fine).sum(axis=1), weights=rough.triangle_areas))
    assert pair.radius == pytest.approx(truth, rel=0.03)
    assert pair.ratio == pytest.approx(pair.radius / 0.1, rel=0.01)


def test_a_part_without_a_partner_in_its_place_stays_alone(parts):
    pairs = pairs_of(parts, parts[:2])
    assert [(pair.part, pair.partner) for pair in pairs] == [(0, 0), (1, 1)]
    assert [(pair.part, pair.partner) for pair in pairs_of(parts[:2], parts[1:])] == [(1, 0)]


@pytest.mark.parametrize(("factor", "paired"), [(0.4, False), (0.7, True), (1.5, True), (2.5, False)])
def test_partners_are_of_like_size(factor, paired):
    pairs = pairs_of([egg(PLACES[0], 0.2)], [egg(PLACES[0], 0.2 * factor)])
    assert len(pairs) == paired
    assert all(pair.ratio == pytest.approx(factor) for pair in pairs)


def test_partners_are_of_like_shape():
    ball = TriangleMesh(icosphere(4, 0.2)[0] + PLACES[0], icosphere(4)[1])
    needle = TriangleMesh(icosphere(4, 0.2)[0] * [0.1, 0.1, 1.5] + PLACES[0], icosphere(4)[1])
    assert len(pairs_of([ball], [ball])) == len(pairs_of([needle], [needle])) == 1
    assert pairs_of([ball], [needle]) == []


@pytest.mark.parametrize(("layers", "paired"), [(3, True), (6, False)])
def test_partners_are_of_like_area(layers, paired):
    """A ball, and one of layers: of the same size and shape."""
    vertices, triangles = icosphere(4, 0.2)
    places = [(1 + 0.001 * number) * vertices + PLACES[0] for number in range(layers)]
    corners = [triangles + number * len(vertices) for number in range(layers)]
    layered = TriangleMesh(np.concatenate(places), np.concatenate(corners))
    assert len(pairs_of([TriangleMesh(places[0], triangles)], [layered])) == paired


def test_as_many_pairs_as_possible_are_made():
    # The second could go with either; the first only with what is nearer to the second.
    here = [egg(np.array([1.2, 0.0, 0]), 0.1), egg(np.array([1.2, 0.25, 0]), 0.1)]
    there = [egg(np.array([1.2, 0.22, 0]), 0.1), egg(np.array([1.2, 0.5, 0]), 0.1)]
    pairs = pairs_of(here, there)
    assert [(pair.part, pair.partner) for pair in pairs] == [(0, 0), (1, 1)]


@pytest.mark.parametrize(("here", "there"), [(0, 0), (2, 0), (0, 2)])
def test_of_no_parts_there_are_no_pairs(parts, here, there):
    assert pairs_of(parts[:here], parts[:there]) == []
