# SPDX-License-Identifier: GPL-3.0-or-later
"""Half-edges of one edge, and which of them belong together."""

import numpy as np
import pytest

from engine.mesh.connectivity.halfedges import (
    following,
    group_half_edges,
    pair_half_edges,
    repeated_triangles,
    triangle_slots,
)
from tests.shapes import creature, icosphere, irregular, plane, rotation, torus


@pytest.mark.parametrize("shape", [icosphere(4), plane(6), irregular(*torus(12, 8)), creature(0.0, 9)[:2]])
def test_groups_and_pairs_are_those_of_a_dictionary(shape):
    vertices, triangles = shape
    edges = {}
    for half_edge in range(3 * len(triangles)):
        a, b = (triangles[half_edge // 3, (half_edge + shift) % 3] for shift in (0, 1))
        edges.setdefault((min(a, b), max(a, b)), []).append(half_edge)
    groups = group_half_edges(triangles, len(vertices))
    found = [list(part) for part in np.split(groups.order, groups.starts[1:])]
    assert found == [edges[edge] for edge in sorted(edges)]
    assert np.array_equal(groups.counts, [len(part) for part in found])
    twins = pair_half_edges(vertices, triangles, groups)
    for part in found:
        assert list(twins[part]) == (part[::-1] if len(part) == 2 else [-1])


def test_half_edges_are_numbered_by_corner():
    triangles = np.array([[4, 7, 9], [1, 2, 3]])
    half_edges = np.arange(6)
    assert triangle_slots(triangles, half_edges, 0).tolist() == [4, 7, 9, 1, 2, 3]
    assert triangle_slots(triangles, half_edges, 1).tolist() == [7, 9, 4, 2, 3, 1]
    assert triangle_slots(triangles, half_edges, 2).tolist() == [9, 4, 7, 3, 1, 2]
    assert following(half_edges).tolist() == [1, 2, 0, 4, 5, 3]


def test_repeated_triangles_are_found_whichever_way_round():
    vertices, triangles = icosphere(2)
    for copies in (triangles[:1], triangles[:3, ::-1], np.roll(triangles[[4, 4, 4]], 1, axis=1)):
        both = np.concatenate([triangles, copies])
        repeated = repeated_triangles(both, group_half_edges(both, len(vertices)))
        assert np.array_equal(np.flatnonzero(repeated), len(triangles) + np.arange(len(copies)))
    pillow = np.array([[0, 1, 2], [2, 1, 0]])
    assert repeated_triangles(pillow, group_half_edges(pillow, 3)).tolist() == [False, True]


def book(angles, turned=()):
    """Pages at angles about the z axis, from 0 to the first; those turned look the other way."""
    pages = np.stack([np.cos(angles), np.sin(angles), np.full(len(angles), 0.5)], axis=1)
    vertices = np.concatenate([[[0, 0, 0], [0, 0, 1.0]], pages])
    triangles = [(1, 0, 2 + i) if i in turned else (0, 1, 2 + i) for i in range(len(angles))]
    return vertices @ rotation([1, 2, 3], 1.0).T, np.array(triangles)


def partners(vertices, triangles):
    twins = pair_half_edges(vertices, triangles, group_half_edges(triangles, len(vertices)))
    edge = np.array([3 * t for t in range(len(triangles))])
    return np.where(twins[edge] >= 0, twins[edge] // 3, -1).tolist()


def test_the_flattest_pages_belong_together():
    assert partners(*book(np.radians([0, 170, 90]), turned={1})) == [1, 0, -1]
    assert partners(*book(np.radians([0, 90, 175, 275]), turned={2, 3})) == [2, 3, 0, 1]
    assert partners(*book(np.radians([0, 20, 180, 200]), turned={1, 2})) == [2, 3, 0, 1]


def test_agreement_comes_before_flatness():
    assert partners(*book(np.radians([0, 170, 90]), turned={2})) in ([2, -1, 0], [-1, 2, 1])
    assert partners(*book(np.radians([0, 170, 120]), turned={2})) == [2, -1, 0]


def test_pages_that_disagree_are_paired_only_if_flat():
    assert partners(*book(np.radians([0, 170, 70]))) == [1, 0, -1]
    assert partners(*book(np.radians([0, 60, 80]))) == [-1, -1, -1]


def test_an_edge_of_very_many_triangles_is_left_open():
    assert partners(*book(np.linspace(0, 6, 65), turned=set(range(0, 65, 2)))) == [-1] * 65


def test_what_hangs_together_elsewhere_comes_first():
    """A fin that continues one side of a ridge more evenly than the other side does."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, -1], [0.5, -1, -1], [0.5, -0.5, 0.6], [-0.5, 0, -1.5]])
    triangles = np.array([[0, 1, 2], [1, 0, 3], [1, 0, 4], [0, 2, 5], [0, 5, 3]])
    assert partners(vertices, triangles)[:3] == [1, 0, -1]
    assert partners(vertices, triangles[:3]) == [2, -1, 0]
