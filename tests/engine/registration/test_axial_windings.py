# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs that are wound about their axes, and the other way."""

import numpy as np
import pytest

from engine import Progress, TriangleMesh, run
from engine.geometry.laplacian import laplace_beltrami
from engine.registration.axial_twists import Untwisted, Winding
from engine.registration.axial_windings import local_costs, wound_steps
from engine.registration.deformable import DeformableSurface
from engine.registration.registration import Registration, register_steps
from engine.runtime.parallel_map import here_steps
from tests.shapes import icosphere

FULL = 2 * np.pi


def blade():
    """A flat, pointed body along x, much wider than it is thick."""
    vertices, triangles = icosphere(16)
    return TriangleMesh(vertices * [1, 0.2, 0.07], triangles)


@pytest.fixture(scope="module")
def straight():
    mesh = blade()
    return DeformableSurface(mesh, laplace_beltrami(mesh))


def end(surface, side):
    """Vertices of one end."""
    return np.flatnonzero(side * surface.vertices[:, 0] > 0.1 * np.ptp(surface.vertices[:, 0]))


def wound(surface, side, most=FULL):
    """Positions of all vertices, where one end is wound about the axis and right at its tip."""
    x, y, z = surface.vertices.T
    angles = most * np.clip((side * x / np.abs(x).max() - 0.3) / 0.4, 0, 1)
    return np.stack([x, np.cos(angles) * y - np.sin(angles) * z, np.sin(angles) * y + np.cos(angles) * z], axis=1)


class Laid:
    """Stands for a registration that leaves the source where it is, and counts how often it was asked for."""

    def __init__(self, source, target):
        self.source, self.target, self.count = source, target, 0

    def __call__(self, starts, _):
        return here_steps(lambda _, positions: self.steps(positions), None, starts)

    def steps(self, positions):
        self.count += 1
        yield Progress(1.0, "Fitting the surfaces")
        on_target = self.target.search.moved(self.target.vertices).nearest(positions)
        on_source = self.source.search.moved(positions).nearest(self.target.vertices)
        elastic = self.source.elastic
        energy = elastic.energy(positions, elastic.rotations(positions, 0.03))
        misfit = float(self.source.mass @ on_target.squared_distances)
        return Registration(positions, on_target, on_source, energy, misfit, (0.0, 0.0))


@pytest.mark.parametrize("side", [1, -1])
def test_a_limb_is_wound_otherwise_where_that_costs_less(side, straight):
    limb = end(straight, side)
    laid = Laid(straight, straight)
    untwisted = Untwisted(wound(straight, side), [Winding(limb, [straight.vertices[limb]])])
    found = run(wound_steps(laid, straight, straight, untwisted))
    np.testing.assert_array_equal(found.positions, straight.vertices)
    assert laid.count == 2


def test_a_limb_stays_as_it_is_where_the_other_way_costs_more(straight):
    limb = end(straight, 1)
    untwisted = Untwisted(straight.vertices, [Winding(limb, [wound(straight, 1)[limb]])])
    found = run(wound_steps(Laid(straight, straight), straight, straight, untwisted))
    np.testing.assert_array_equal(found.positions, straight.vertices)


def test_each_limb_is_chosen_for_itself(straight):
    first, second = end(straight, 1), end(straight, -1)
    laid = Laid(straight, straight)
    otherwise = [Winding(first, [straight.vertices[first]]), Winding(second, [wound(straight, -1)[second]])]
    found = run(wound_steps(laid, straight, straight, Untwisted(wound(straight, 1), otherwise)))
    np.testing.assert_array_equal(found.positions, straight.vertices)
    assert laid.count == 3


def test_the_best_of_several_ways_is_taken(straight):
    first, second = end(straight, 1), end(straight, -1)
    laid = Laid(straight, straight)
    ways = [wound(straight, 1, -FULL)[first], straight.vertices[first]]
    otherwise = [Winding(first, ways), Winding(second, [wound(straight, -1)[second]])]
    found = run(wound_steps(laid, straight, straight, Untwisted(wound(straight, 1), otherwise)))
    np.testing.assert_array_equal(found.positions, straight.vertices)
    assert laid.count == 4


def test_nothing_is_registered_twice_where_nothing_else_might_be_meant(straight):
    laid = Laid(straight, straight)
    run(wound_steps(laid, straight, straight, Untwisted(straight.vertices, [])))
    assert laid.count == 1


def test_costs_of_all_vertices_are_energy_and_misfits_both_ways(straight):
    moved = straight.vertices * [1.02, 0.9, 1.1]
    registration = run(Laid(straight, straight).steps(moved))
    laid = straight.search.moved(moved).vertex_normals
    here, there = (moved, laid, straight.curvatures), (straight.vertices, straight.normals, straight.curvatures)
    misfit = 0.0
    for found, own, others in (registration.on_target, here, there), (registration.on_source, there, here):
        corners = straight.triangles[found.triangles]
        places, normals, curvatures = (
            np.square((found.barycentric[:, :, None] * other[corners]).sum(axis=1) - mine).sum(axis=1)
            for mine, other in zip(own, others, strict=True)
        )
        misfit += straight.mass @ (places + 0.11**2 * (normals + np.minimum(curvatures, 0.04)))
    costs = local_costs(straight, straight, registration)
    assert costs.sum() == pytest.approx(registration.energy + 320 * misfit, rel=1e-9)


def test_a_round_limb_costs_more_where_its_elbow_lies_on_the_wrong_side():
    vertices, triangles = icosphere(16)
    x, y, z = (vertices * [1, 0.12, 0.12]).T
    elbow = np.exp(-np.square(x / 0.1)) * np.clip(y / 0.12, 0, None) ** 2
    mesh = TriangleMesh(np.stack([x, y + 0.02 * elbow, z], axis=1), triangles)
    arm = DeformableSurface(mesh, laplace_beltrami(mesh))
    turned = Laid(arm, arm)
    wrong = run(turned.steps(arm.vertices * [1, -1, -1]))
    costs = local_costs(arm, arm, wrong)
    distances = 320 * (wrong.misfit + arm.mass @ wrong.on_source.squared_distances)
    assert wrong.energy < 1e-9
    assert costs.sum() > 4 * distances
    assert costs[np.abs(x) < 0.25].sum() > 0.7 * costs.sum()


def test_costs_are_where_the_surface_is_wound(straight):
    costs = local_costs(straight, straight, run(Laid(straight, straight).steps(wound(straight, 1))))
    x = straight.vertices[:, 0]
    assert costs[x > 0].sum() > 0.99 * costs.sum() > 0


def test_winding_the_other_way_is_better_after_a_registration_too(straight):
    """The registration does not undo a full turn by itself: that is what the other way is tried for."""
    limb = end(straight, 1)

    def register(starts, stage):
        return here_steps(lambda _, start: register_steps(straight, straight, start, (stage,)), None, starts)

    def error(found):
        return straight.mass @ np.linalg.norm(found.positions - straight.vertices, axis=1)

    start = wound(straight, 1)
    kept = error(run(wound_steps(register, straight, straight, Untwisted(start, []))))
    other = Untwisted(start, [Winding(limb, [straight.vertices[limb]])])
    assert kept > 0.005
    assert error(run(wound_steps(register, straight, straight, other))) < 0.1 * kept
