# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a body another one shows, and how a piece of it grows to that."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import Shape, SurfaceMap, SurfacePoints, TriangleMesh
from engine.matching.covered_parts import _Fitter, best_and_rivals, continued, covered_parts_steps
from engine.runtime.progress import run
from tests.shapes import compacted, creature, cylinder

FRONT = 0.0


def part_of(vertices, triangles, rest, kept):
    """Shape of the triangles all of whose places at rest (m, 3, 3) are kept, and its places at rest."""
    both, faces = compacted(np.hstack([vertices, rest]), triangles[kept(rest[triangles])])
    return Shape(TriangleMesh(both[:, :3], faces)), both[:, 3:]


@pytest.fixture(scope="module")
def bodies():
    """The creature at rest, and its front half in another pose and meshing."""
    vertices, triangles, rest = creature(0.0, 9)
    part = part_of(*creature(0.8, 9, turn=0.7), lambda corners: corners[:, :, 0].min(axis=1) > FRONT)
    return (Shape(TriangleMesh(vertices, triangles)), rest), part


def to_anywhere(shape, image):
    """Map everything to one place, as if nothing were known."""
    points = SurfacePoints.at_vertices(image.mesh, np.zeros(shape.mesh.vertex_count, np.int64))
    return SurfaceMap(points, np.ones(len(points)), image.mesh.vertex_count)


def test_what_the_part_shows_is_found_without_a_hint(bodies):
    (whole, rest), (part, _) = bodies
    found = run(covered_parts_steps(whole, part, (to_anywhere(whole, part), to_anywhere(part, whole))))
    assert [piece.score for piece in found] == sorted(piece.score for piece in found)
    areas, true = whole.mesh.vertex_areas, rest[:, 0] > FRONT
    covered = found[0].covered
    assert areas @ (covered & true) > 0.85 * (areas @ (covered | true))
    assert found[0].is_new
    for number, piece in enumerate(found):  # none is much the same as a better one
        for other in found[:number]:
            assert areas @ (piece.covered & other.covered) < 0.8 * (areas @ (piece.covered | other.covered))


def test_what_two_pieces_have_in_common_is_seen_by_their_areas():
    tube = Shape(TriangleMesh(*cylinder(24, 40, 0.2, 2.0)))
    fitter, heights = _Fitter(tube, tube), tube.mesh.vertices[:, 2] - tube.mesh.vertices[:, 2].min()
    everything, nothing, half = heights < 3, heights < 0, heights < 1
    assert fitter.common_part(everything, everything) == pytest.approx(1)
    assert fitter.common_part(half, everything) == pytest.approx(1 / 2, abs=0.03)
    assert fitter.common_part((heights > 0.5) & (heights < 1.5), half) == pytest.approx(1 / 3, abs=0.03)
    assert fitter.common_part(half, ~half) == 0
    assert fitter.common_part(nothing, half) == fitter.common_part(nothing, nothing) == 0


def true_map(rest, image, image_rest):
    """Map every vertex to the one that is nearest to it at rest."""
    points = SurfacePoints.at_vertices(image.mesh, cKDTree(image_rest).query(rest)[1])
    return SurfaceMap(points, np.ones(len(points)), image.mesh.vertex_count)


def test_what_leads_to_where_the_known_map_does_is_not_new(bodies):
    (whole, rest), (part, part_rest) = bodies
    maps = true_map(rest, part, part_rest), true_map(part_rest, whole, rest)
    assert not run(covered_parts_steps(whole, part, maps))[0].is_new


def test_where_nothing_is_missing_no_piece_fits_better(bodies):
    (whole, rest), _ = bodies
    same, same_rest = part_of(*creature(0.8, 9, turn=0.7), lambda corners: corners[:, :, 0].min(axis=1) > -np.inf)
    maps = true_map(rest, same, same_rest), true_map(same_rest, whole, rest)
    assert run(covered_parts_steps(whole, same, maps)) == []


def test_where_no_piece_may_be_as_alike_as_it_has_to_be_none_is_followed(bodies):
    (whole, rest), (part, part_rest) = bodies
    maps = true_map(rest, part, part_rest), true_map(part_rest, whole, rest)
    assert run(covered_parts_steps(whole, part, maps))
    assert run(covered_parts_steps(whole, part, maps, 1000.0)) == []


def test_on_a_surface_too_small_to_tell_nothing_is_found():
    whole, part = (Shape(TriangleMesh(*cylinder(12, along, 0.2, 1.0))) for along in (12, 6))
    assert run(covered_parts_steps(whole, part, (to_anywhere(whole, part), to_anywhere(part, whole)))) == []


def test_a_piece_grows_along_the_surface_by_what_overhangs():
    """Of a tube, the lower half lies; the upper one hangs on it, and lies anywhere."""
    tube = Shape(TriangleMesh(*cylinder(24, 40, 0.2, 2.0)))
    heights = tube.mesh.vertices[:, 2] - tube.mesh.vertices[:, 2].min()
    overhanging = heights > 1.0
    places = tube.mesh.vertices.copy()
    places[overhanging] = tube.mesh.vertices[heights.argmin()]
    grown = continued(tube, tube, places, overhanging, 1.0)
    assert grown[overhanging & (heights < 1.9)].all()
    half = continued(tube, tube, places, overhanging, 0.5)
    assert not half[heights > 1.7].any()
    assert half[overhanging & (heights < 1.4)].all()


@pytest.mark.parametrize("all_of_it", [False, True])
def test_what_does_not_overhang_or_is_nowhere_grows_nothing(all_of_it):
    tube = Shape(TriangleMesh(*cylinder(12, 10)))
    overhanging = np.full(tube.mesh.vertex_count, all_of_it)
    assert not continued(tube, tube, tube.mesh.vertices, overhanging, 1.0).any()


def ways(*spots):
    """Ways to take three places to spots on a line."""
    return np.array([[[spot, 0.0, 0.0]] * 3 for spot in spots])


def test_the_best_ways_are_chosen_and_a_different_one_though_others_like_the_best_are_better():
    scores = np.array([-4.0, -3.0, -2.0, -5.0, 9.0])
    assert best_and_rivals(scores, ways(0.01, 0.02, 1.0, 0.0, 2.0), 2, 4.0) == [3, 0, 2]


def test_a_way_that_is_much_worse_than_the_best_is_no_rival():
    scores = np.array([-5.0, -4.0, 1.0])
    assert best_and_rivals(scores, ways(0.0, 0.01, 1.0), 2, 5.0) == [0, 1]


def test_rivals_differ_from_one_another_and_are_few():
    scores = np.arange(6.0)
    assert best_and_rivals(scores, ways(0.0, 1.0, 1.01, 2.0, 3.0, 4.0), 1, 100.0) == [0, 1, 3]


def test_fewer_ways_than_are_looked_for_are_all_chosen():
    assert best_and_rivals(np.array([2.0, 1.0]), ways(0.0, 0.0), 6, 1.0) == [1, 0]
    assert best_and_rivals(np.zeros(0), np.zeros((0, 3, 3)), 6, 1.0) == []
