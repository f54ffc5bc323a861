# SPDX-License-Identifier: GPL-3.0-or-later
"""Handles of surfaces whose topology is known, and the loops around them."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.geometry.handle_loops import genus, shortest_handle_loop_steps
from engine.runtime.progress import run
from tests.messes import bridged
from tests.shapes import (
    capsule_surface,
    compacted,
    creature,
    cylinder,
    icosphere,
    irregular,
    permuted,
    plane,
    plane_with_hole,
    rotation,
    torus,
)


def with_handles(count, parts=10):
    """Make a sphere with tubes through its inside."""
    vertices, triangles = icosphere(parts)
    random = np.random.default_rng(1)
    free = np.ones(len(vertices), bool)
    for _ in range(count):
        first = random.choice(np.flatnonzero(free))
        second = np.where(free, np.linalg.norm(vertices + vertices[first], axis=1), np.inf).argmin()
        vertices, triangles = bridged(vertices, triangles, first, second)
        for vertex in (first, second):
            free &= np.linalg.norm(vertices - vertices[vertex], axis=1) > 0.5
    return TriangleMesh(*compacted(vertices, triangles))


def shortest_loop(mesh):
    return run(shortest_handle_loop_steps(mesh))


def length(mesh, loop):
    return np.linalg.norm(mesh.vertices[loop] - mesh.vertices[np.roll(loop, -1)], axis=1).sum()


@pytest.mark.parametrize(
    ("shape", "handles"),
    [
        (icosphere(4), 0),
        (plane(5), 0),
        (plane_with_hole(), 0),
        (cylinder(), 0),
        (creature(0.5, 7)[:2], 0),
        (torus(), 1),
        (irregular(*torus()), 1),
    ],
)
def test_the_genus(shape, handles):
    assert genus(TriangleMesh(*shape)) == handles


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_each_tube_is_a_handle(count):
    assert genus(with_handles(count)) == count


@pytest.mark.parametrize("shape", [(48, 20), (60, 40)])
def test_the_loop_around_a_torus(shape):
    """Edges are chords: a little shorter than the circle."""
    mesh = TriangleMesh(*torus(*shape))
    loop = shortest_loop(mesh)
    chords = 2 * shape[1] * np.sin(np.pi / shape[1]) * 0.35
    assert length(mesh, loop) == pytest.approx(chords, rel=1e-6)
    assert len(np.unique(loop)) == len(loop) == shape[1]


def test_numbering_place_and_size_do_not_matter():
    mesh = with_handles(2)
    vertices, triangles = permuted(mesh.vertices, mesh.triangles)[:2]
    moved = TriangleMesh(30 * vertices @ rotation([1, 2, 3], 1.0).T + 7, triangles)
    ours, theirs = (
        length(mesh, shortest_loop(mesh)),
        length(moved, shortest_loop(moved)),
    )
    assert theirs == pytest.approx(30 * ours, rel=1e-6)


def test_the_loop_is_one_of_edges():
    mesh = with_handles(3)
    loop = shortest_loop(mesh)
    sides = np.sort(np.stack([loop, np.roll(loop, -1)], axis=1), axis=1)
    known = set(map(tuple, mesh.edges.tolist()))
    assert all(tuple(side) in known for side in sides.tolist())
    assert length(mesh, loop) < 3.5  # a tube, and not the way through it: that is longer than the ball is wide


def test_a_handle_of_an_open_surface():
    vertices, triangles = icosphere(10)
    middle = [np.linalg.norm(vertices - place, axis=1).argmin() for place in ([0, 0, 1], [0, 0, -1])]
    vertices, triangles = bridged(vertices, triangles, *middle)
    whole = TriangleMesh(*compacted(vertices, triangles))
    cut = TriangleMesh(*compacted(vertices, triangles[(vertices[triangles][:, :, 0] < 0.8).all(axis=1)]))
    assert len(cut.boundary_edges)
    assert genus(cut) == 1
    assert length(cut, shortest_loop(cut)) == pytest.approx(length(whole, shortest_loop(whole)))


def test_a_loop_may_go_through_what_closes_an_opening():
    """What is no surface hardly counts: a ring is cut along its outside, though the way around its tube is shorter."""
    mesh = TriangleMesh(*torus(48, 20))
    away = np.linalg.norm(mesh.vertices[:, :2], axis=1)
    outermost = away > away.max() - 1e-9
    loop = run(shortest_handle_loop_steps(mesh, outermost))
    np.testing.assert_array_equal(np.sort(loop), np.flatnonzero(outermost))


def test_what_touches_is_parted_rather_than_the_hole_beside_it_closed():
    """An arm lies on a trunk with most of its length, and leaves a small hole at the shoulder, in creases all round."""
    arm = ((-1, 0, 0.5), (-0.5, 0, 0.34), 0.14, 0.16), ((-0.5, 0, 0.34), (1, 0, 0.34), 0.16, 0.16)
    trunk = ((-1, 0, 0), (1, 0, 0), 0.2, 0.2), ((-1, 0, 0), (-1, 0, 0.5), 0.14, 0.14)
    mesh = TriangleMesh(*capsule_surface((*trunk, *arm), [(-1.4, -0.4, -0.4), (1.4, 0.4, 0.9)], 40))
    assert genus(mesh) == 1
    places = mesh.vertices[shortest_loop(mesh)]
    assert np.ptp(places[:, 0]) > 1.5  # the hole is a fifth of that
    assert np.abs(places[:, 2] - 0.19).max() < 0.05
