# SPDX-License-Identifier: GPL-3.0-or-later
"""Values at points, edges, faces and corners, carried from mesh to mesh."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MatchError, run
from engine.retarget.values.attribute_transfer import Crossing, carry_values_steps
from tests.faces import closest_map, grid, triangulated, tube


def crossing(source, target):
    """Two meshes, each (vertices, polygons, ...), that lie upon each other."""
    meshes = [triangulated(*side[:2]) for side in (source, target)]
    there, back = closest_map(source[0], meshes[1]), closest_map(target[0], meshes[0])
    return Crossing(*meshes, source[1], target[1], there, back)


def carry(values, domain, way, **options):
    return run(carry_values_steps(values, domain, way, **options)).values


def count(domain, side):
    faces = side[1]
    return {
        "POINT": len(side[0]),
        "EDGE": len(faces.edges),
        "FACE": faces.face_count,
        "CORNER": faces.corner_count,
    }[domain]


@pytest.mark.parametrize("domain", ["POINT", "EDGE", "FACE", "CORNER"])
@pytest.mark.parametrize("kind", [np.float32, np.int32, bool, np.bytes_])
@pytest.mark.parametrize("width", [(), (3,)])
def test_the_same_mesh_gets_the_same_values(domain, kind, width):
    side = tube(9, 5)
    shape = (count(domain, side), *width)
    values = np.random.default_rng(4).integers(0, 2 if kind is bool else 50, shape).astype(kind)
    carried = carry(values, domain, crossing(side, side))
    assert carried.dtype == values.dtype
    if kind is np.bytes_:
        np.testing.assert_array_equal(carried, values)
        return
    if domain == "FACE" and kind is np.float32:
        return  # a mean over samples, some of which are on the sides of a bent face
    np.testing.assert_allclose(carried, values, atol=1e-5)


@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
def test_smooth_values_are_interpolated(domain):
    source, target = grid(5, 4), grid(7, 9)
    slope = np.array([[1.0, 2], [-3, 1], [0, 1]])
    at = [side[0] if domain == "POINT" else side[0][side[1].corner_vertices] for side in (source, target)]
    carried = carry(at[0] @ slope, domain, crossing(source, target))
    np.testing.assert_allclose(carried, at[1] @ slope, atol=1e-12)


def test_corners_of_a_face_take_one_side_of_a_jump():
    source, target = grid(8, 8), grid(6, 6)
    colors = (source[1].face_means(source[2])[:, 0] > 0.5)[source[1].corner_faces].astype(np.float32)
    carried = carry(colors[:, None] * [1, 0.5, 0, 1], "CORNER", crossing(source, target))
    expected = (target[1].face_means(target[2])[:, 0] > 0.5)[target[1].corner_faces]
    np.testing.assert_allclose(carried, expected[:, None] * [1, 0.5, 0, 1], atol=1e-9)


@pytest.mark.parametrize("kind", [np.int32, bool])
def test_faces_take_what_most_of_them_lies_on(kind):
    source, target = grid(16, 16), grid(5, 5)
    values = (source[1].face_means(source[2])[:, 0] > 0.5).astype(kind)
    carried = carry(values, "FACE", crossing(source, target))
    centres = target[1].face_means(target[2])[:, 0]
    clear = abs(centres - 0.5) > 0.1
    np.testing.assert_array_equal(carried[clear], (centres > 0.5)[clear])


def test_a_face_takes_the_mean_of_numbers():
    source, target = grid(40, 40), grid(5, 5)
    carried = carry(source[1].face_means(source[2]), "FACE", crossing(source, target))
    np.testing.assert_allclose(carried, target[1].face_means(target[2]), atol=0.02)


def test_truth_values_at_points_divide_in_the_middle():
    source, target = grid(4, 4), grid(40, 1)
    carried = carry(source[0][:, 0] > 0.6, "POINT", crossing(source, target))
    x = target[0][:, 0]
    np.testing.assert_array_equal(carried[abs(x - 0.625) > 1e-6], (x > 0.625)[abs(x - 0.625) > 1e-6])


def test_marks_at_points_stay_single():
    source, target = grid(4, 4), grid(9, 9)
    values = np.zeros(25)
    values[[6, 18]] = [0.5, 1.0]
    carried = carry(values, "POINT", crossing(source, target), marks=True)
    assert sorted(carried[carried > 0]) == [0.5, 1.0]
    assert np.linalg.norm(target[0][carried == 1] - source[0][18]) < 0.08


def test_rotations_are_never_mixed():
    source, target = grid(4, 4), grid(9, 9)
    turns = np.random.default_rng(5).normal(size=(25, 4)).astype(np.float32)
    carried = carry(turns, "POINT", crossing(source, target), blended=False)
    assert {tuple(row) for row in carried.tolist()} <= {tuple(row) for row in turns.tolist()}


@pytest.mark.parametrize("domain", ["POINT", "EDGE", "FACE", "CORNER"])
@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64, np.longdouble])
def test_what_is_not_mixed_keeps_its_precision(domain, kind):
    side = tube(9, 5)
    values = np.random.default_rng(5).normal(size=(count(domain, side), 2)).astype(kind)
    if kind is np.longdouble:
        values = values.astype(np.float64).astype(kind)  # no whole numbers are as long
    carried = carry(values, domain, crossing(side, side), blended=False)
    assert carried.dtype == kind
    np.testing.assert_array_equal(carried, values)


def test_marked_edges_are_traced_and_others_are_not():
    source, target = grid(8, 8), grid(8, 4)
    way = crossing(source, target)
    middle = abs(source[0][source[1].edges][:, :, 0] - 0.5).max(axis=1) < 1e-9
    carried = carry(middle, "EDGE", way)
    assert carried.dtype == bool
    assert carried.sum() == 4
    assert carry(np.full(len(middle), 0.25), "EDGE", way).tolist() == [0.25] * len(target[1].edges)
    assert carry(-middle.astype(float), "EDGE", way).min() == -1
    assert carry(7 * middle.astype(int), "EDGE", way).max() == 7


def test_no_edges_on_one_side():
    side = grid(2, 2)
    assert carry(np.zeros(len(side[1].edges), bool), "EDGE", crossing(side, side)).sum() == 0


def test_values_that_are_no_numbers_become_zero():
    side = grid(2, 2)
    values = np.ones(9)
    values[4] = np.nan
    assert carry(values, "POINT", crossing(side, side))[4] == 0


@pytest.mark.parametrize("domain", ["POINT", "EDGE", "FACE", "CORNER"])
def test_too_few_values(domain):
    side = grid(2, 2)
    with pytest.raises(MatchError, match="one value for each"):
        carry(np.zeros(3), domain, crossing(side, side))
