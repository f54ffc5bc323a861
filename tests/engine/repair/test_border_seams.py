# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces that one surface was cut into, and pieces that only end near each other."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.mesh.connectivity.halfedges import group_half_edges
from engine.repair.border_seams import seam_partners
from engine.repair.cleaning import clean
from tests.messes import halves_apart, partly_turned, together, without_faces
from tests.shapes import compacted, creature, cylinder, plane


def partners(vertices, triangles):
    """Pairs of vertices that face each other, (k, 2)."""
    found = seam_partners(vertices, triangles, group_half_edges(triangles, len(vertices)))
    moved = np.flatnonzero(found != np.arange(len(found)))
    return np.stack([found[moved], moved], axis=1)


def halves(gap, noise=0.0):
    """Two halves of the creature, front and rear, that were never merged; and how many vertices it had."""
    vertices, triangles, _ = creature(0.0, 9)
    count = len(vertices)
    vertices, triangles = halves_apart(vertices, triangles, gap)
    return vertices + noise * np.random.default_rng(0).standard_normal(vertices.shape), triangles, count


@pytest.mark.parametrize(("gap", "noise"), [(0.01, 0.0), (0.03, 0.0), (0.0, 0.01)])
@pytest.mark.parametrize("turned", [False, True])
def test_halves_that_were_not_merged_are_one_surface(gap, noise, turned):
    vertices, triangles, count = halves(gap, noise)
    before = triangles
    if turned:
        triangles = np.where((triangles >= count).any(axis=1)[:, None], triangles[:, ::-1], triangles)
        triangles = partly_turned(vertices, triangles, 0.1)[1]
    surface = clean(TriangleMesh(vertices, triangles), "source")
    assert len(surface.pieces) == 1
    assert surface.mesh.area == pytest.approx(TriangleMesh(vertices, before).area, rel=0.05)
    assert len(surface.mesh.edges) == 3 * surface.mesh.triangle_count / 2  # closed
    assert any("joined with the other border" in note for note in surface.notes)


@pytest.mark.parametrize("part", [0.1, 0.2])
def test_both_sides_of_a_shell_stay_apart_though_both_have_holes(part):
    vertices, triangles, _ = creature(0.0, 12)
    mesh = TriangleMesh(vertices, triangles)
    inner = vertices - 0.02 * mesh.vertex_normals
    outer_faces = without_faces(vertices, triangles, part, seed=1)[1]
    inner_faces = without_faces(vertices, triangles[:, ::-1], part, seed=2)[1]
    assert not len(partners(*together((vertices, outer_faces), (inner, inner_faces))))


def test_halves_far_apart_are_pieces():
    vertices, triangles, _ = halves(0.4)
    assert not len(partners(vertices, triangles))


def stacked(upper, lower, gap):
    """One tube above another."""
    above = lower[0][:, 2].max() - upper[0][:, 2].min() + gap
    return together((upper[0] + [0.01, 0, above], upper[1]), lower)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_borders_of_other_spacings_are_joined(scale):
    """A head with more vertices around its neck than the trunk, and a little to the side."""
    vertices, triangles = stacked(cylinder(40, 12, 0.5, 1.0), cylinder(31, 12, 0.5, 2.0), 0.02)
    found = partners(scale * vertices, triangles)
    assert 20 < len(found) <= 31
    assert len(np.unique(found)) == found.size
    surface = clean(TriangleMesh(scale * vertices, triangles))
    assert len(surface.pieces) == 1
    edges = np.sort(surface.mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 1).sum() == 71  # the outer ends; no slits in between


@pytest.mark.parametrize("gap", [-0.2, 0.2])
def test_a_shirt_over_trousers_or_far_above_stays_apart(gap):
    assert not len(partners(*stacked(cylinder(40, 12, 0.51, 1.0), cylinder(40, 12, 0.5, 1.0), gap)))


def test_two_layers_that_end_together_stay_apart():
    sheet = plane(15)
    vertices, triangles = together(sheet, (sheet[0] + [0, 0, 0.01], sheet[1]))
    assert not len(partners(vertices, triangles))


def test_small_pieces_are_not_joined():
    large, small = plane(15), plane(4, 0.05)
    assert not len(partners(*together(large, (small[0] + [1.001, 0.5, 0], small[1]))))


def test_a_border_that_lies_along_a_part_of_another_is_joined_only_if_all_of_it_does():
    large, small = plane(30, 2.0), plane(15, 1.0)
    assert not len(partners(*together(large, (small[0] + [2.001, 0.5, 0], small[1]))))
    patch = (large[0] > 0.6).all(axis=1, where=[True, True, False]) & (large[0] < 1.4).all(axis=1)
    inside = patch[large[1]].all(axis=1)
    cut = together((large[0], large[1][~inside]), compacted(large[0] + [0, 0, 0.005], large[1][inside]))
    assert len(partners(*cut)) > 20


def test_a_sleeve_is_joined_with_what_it_stands_on():
    vertices, triangles = plane(30, 2.0)
    outside = np.linalg.norm(vertices[triangles].mean(axis=1)[:, :2] - 1, axis=1) > 0.3
    sleeve = cylinder(24, 8, 0.32, 1.0)
    standing = sleeve[0] - [-1, -1, sleeve[0][:, 2].min() - 0.01], sleeve[1]
    mesh = together((vertices, triangles[outside]), standing)
    assert len(partners(*mesh)) > 10
    assert len(clean(TriangleMesh(*mesh)).pieces) == 1


def test_closed_surfaces_have_no_borders():
    vertices, triangles, _ = creature(0.0, 9)
    assert not len(partners(*together((vertices, triangles), (np.add(vertices, [3, 0, 0]), triangles))))
