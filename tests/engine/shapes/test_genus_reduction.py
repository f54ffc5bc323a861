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
from tests.shapes import compacted, creature, icosphere, torus

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


def test_chain_mail_stays_as_it_is():
    """A surface with many handles has them on purpose."""
    x, y = Shape(with_handles(7, 20)), Shape(with_handles(0))
    assert run(evened_steps(x, y)) == (x, y)


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
