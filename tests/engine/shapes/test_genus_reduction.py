# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts that touch are parted, where only one of two shapes hangs together."""

import numpy as np
import pytest

from engine import MatchSettings, Shape, TriangleMesh, match
from engine.geometry.handle_loops import genus, shortest_handle_loop_steps
from engine.repair.cleaning import clean
from engine.runtime.progress import run
from engine.shapes.genus_reduction import cut_along, evened_steps
from tests.engine.geometry.test_handle_loops import with_handles
from tests.messes import bridged
from tests.shapes import capsule_surface, compacted, creature, icosphere, irregular, torus

QUICK = MatchSettings(points=12, samples=100, hypotheses=2)


def test_a_cut_torus_is_a_tube_with_two_lids():
    mesh = TriangleMesh(*torus(48, 20))
    part = clean(mesh).main
    loop = run(shortest_handle_loop_steps(mesh))
    cut = cut_along(part, loop)
    assert genus(cut.mesh) == 0
    assert cut.mesh.is_closed
    assert cut.mesh.vertex_count == mesh.vertex_count + len(loop) + 2
    lids = cut.original_triangles < 0
    assert lids.sum() == 2 * len(loop)
    assert cut.mesh.triangle_areas[~lids].sum() == pytest.approx(mesh.area)
    assert cut.mesh.triangle_areas[lids].sum() == pytest.approx(2 * 10 * np.sin(np.pi / 10) * 0.35**2, rel=1e-6)
    # The lids look outwards, to either side.
    normals = cut.mesh.triangle_normals[lids]
    np.testing.assert_allclose(np.abs(normals @ normals[0]), 1, atol=1e-6)
    assert normals.sum(axis=0) == pytest.approx(0, abs=1e-6)
    known = cut.original_vertices >= 0
    np.testing.assert_array_equal(cut.mesh.vertices[known], mesh.vertices[cut.original_vertices[known]])
    counts = np.bincount(cut.original_vertices[known], minlength=mesh.vertex_count)
    np.testing.assert_array_equal(np.flatnonzero(counts == 2), np.sort(loop))


@pytest.mark.parametrize("loop", [[], [0, 1], [0, 5, 17, 30]])
def test_what_is_no_loop_of_edges_is_not_cut(loop):
    assert cut_along(clean(TriangleMesh(*torus())).main, np.array(loop, int)) is None


def test_a_loop_that_parts_the_surface_is_not_cut():
    ball = TriangleMesh(*icosphere(4))
    ring = ball.triangles[(ball.triangles == 100).any(axis=1)]
    assert cut_along(clean(ball).main, ring[0]) is None


@pytest.mark.parametrize(("handles", "others"), [(1, 0), (3, 0), (3, 2)])
def test_the_shape_with_more_handles_is_cut(handles, others):
    x, y = Shape(with_handles(handles)), Shape(with_handles(others))
    for first, second, name, other in ((x, y, "source", "target"), (y, x, "target", "source")):
        evened = run(evened_steps(first, second))
        assert genus(evened[0].mesh) == genus(evened[1].mesh) == others
        kept, cut = (second, evened[0]) if name == "source" else (first, evened[1])
        assert kept in evened
        said = f"The {name} hangs together where the {other} does not"
        assert cut.surface.cleaned.notes[-1].startswith(said)


@pytest.mark.parametrize("handles", [0, 1])
def test_shapes_with_equal_handles_stay_as_they_are(handles):
    x, y = Shape(with_handles(handles)), Shape(with_handles(handles))
    assert run(evened_steps(x, y)) == (x, y)


@pytest.mark.parametrize("stretched", [(1, 1, 1), (1, 1, 1.5)])
def test_a_ring_stays_a_ring_however_it_is_built_and_meshed(stretched):
    """The same handle on both: what they are without it is not more alike."""
    vertices, triangles = torus(48, 20)
    x, y = Shape(TriangleMesh(vertices * stretched, triangles)), Shape(TriangleMesh(*irregular(*torus(60, 24))))
    assert run(evened_steps(x, y)) == (x, y)


def figure(elbow, hand, turn=0.0):
    """Make somebody whose arms end at places, where they grow together with what is there."""
    parts = [((0, 0, 0.9), (0, 0, 1.35), 0.17, 0.17), ((0, 0, 1.5), (0, 0, 1.8), 0.08, 0.14)]
    for side in ([1, 1, 1], [-1, 1, 1]):
        hip, foot, shoulder, *arm = np.array([(0.12, 0, 0.85), (0.2, 0, 0.1), (0.18, 0, 1.38), elbow, hand]) * side
        parts += [(hip, foot, 0.1, 0.07), (shoulder, arm[0], 0.07, 0.06), (*arm, 0.055, 0.055)]
    return TriangleMesh(*capsule_surface(parts, [[-1, -0.4, -0.1], [1, 0.4, 2.1]], 16, turn))


def test_a_body_that_touches_itself_elsewhere_is_cut_on_both_sides():
    """Hands on the hips are two handles, hands at the head two others."""
    hips, head = figure((0.62, 0, 1.15), (0.24, 0, 0.9)), figure((0.55, 0, 1.5), (0.2, 0, 1.78), turn=0.5)
    assert genus(hips) == genus(head) == 2
    x, y = run(evened_steps(Shape(hips), Shape(head)))
    assert genus(x.mesh) == genus(y.mesh) < 2
    for shape, name, other in ((x, "source", "target"), (y, "target", "source")):
        note = f"The {name} hangs together where the {other} does not: it was cut open there for matching."
        assert shape.surface.cleaned.notes == (note,)


def test_hands_on_the_hips_stay_there_if_they_are_so_in_both():
    shapes = tuple(Shape(figure((0.62, 0, 1.15), (0.24, 0, 0.9), turn)) for turn in (0.0, 0.6))
    assert run(evened_steps(*shapes)) == shapes


def test_one_surface_matched_to_itself_is_not_cut():
    ring = Shape(TriangleMesh(*torus()))
    assert all(shape is ring for shape in run(evened_steps(ring, ring)))


def test_chain_mail_stays_as_it_is():
    """A surface with many handles has them on purpose."""
    x, y, z = Shape(with_handles(7, 20)), Shape(with_handles(0)), Shape(with_handles(7, 18))
    assert run(evened_steps(x, y)) == (x, y)
    assert run(evened_steps(x, z)) == (x, z)


def test_a_dense_surface_is_cut_where_its_proxy_would_be():
    vertices, triangles = icosphere(31)
    middle = [np.linalg.norm(vertices - place, axis=1).argmin() for place in ([0, 0, 1], [0, 0, -1])]
    mesh = TriangleMesh(*compacted(*bridged(vertices, triangles, *middle)))
    x, _ = run(evened_steps(Shape(mesh), Shape(TriangleMesh(*icosphere(6)))))
    assert not x.surface.proxy.is_identity
    assert genus(x.mesh) == genus(x.surface.cleaned.mesh) == 0
    assert x.surface.cleaned.mesh.area == pytest.approx(mesh.area, rel=1e-2)


def test_feet_that_touch_are_matched_as_feet():
    """A tube between two legs is a short cut; without it the map is that of the body that it was put on."""
    source, (vertices, triangles, rest) = creature(0.0, 9), creature(0.8, 9, turn=0.7)
    legs = [np.linalg.norm(rest - place, axis=1).argmin() for place in ([0.45, 0.08, -0.75], [0.45, -0.08, -0.75])]
    touching = TriangleMesh(*compacted(*bridged(vertices, triangles, *legs)))
    used = np.unique(bridged(vertices, triangles, *legs)[1])
    result = match(TriangleMesh(*source[:2]), touching, QUICK)
    assert result.notes[0].startswith("The target hangs together where the source does not")
    gaps = np.linalg.norm(result.source_to_target.transfer(rest[used]) - source[2], axis=1) / np.sqrt(touching.area)
    assert gaps.mean() < 0.012
    gaps = np.linalg.norm(result.target_to_source.transfer(source[2]) - rest[used], axis=1) / np.sqrt(touching.area)
    assert gaps.mean() < 0.012
    assert len(result.target_to_source) == touching.vertex_count
