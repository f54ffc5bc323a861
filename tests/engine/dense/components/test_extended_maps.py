# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of all vertices from those of main parts, and how far pieces beside these are to be trusted."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import SurfacePoints, TriangleMesh, run
from engine.dense.components.extended_maps import whole_maps_steps
from engine.dense.quality import judged_map
from engine.repair.cleaning import clean
from tests.messes import together
from tests.shapes import icosphere

BODY = icosphere(10)
EYES = np.array([[0.9, 0.5, 0.3], [0.9, -0.5, 0.3]])


def ball(centre, radius=0.1):
    vertices, triangles = icosphere(3, radius)
    return vertices + centre, triangles


def itself(mesh):
    """Each vertex of the main part at itself."""
    return SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count))


def mirrored(mesh):
    """Each vertex of the main part at the one nearest to its mirror image."""
    return SurfacePoints.at_vertices(mesh, cKDTree(mesh.vertices).query(mesh.vertices * [1, -1, 1])[1])


def whole(x, y, there, back, credibility=1.0):
    """Maps of all vertices, each trusted as what is known of it and the one back says."""
    judged = judged_map(x.mesh, y.mesh, there, back), judged_map(y.mesh, x.mesh, back, there)
    confidences = judged[0].confidence, judged[1].confidence
    return run(whole_maps_steps(x, y, there, back, confidences=confidences, credibility=credibility))


def maps(surface, there, back):
    return whole(surface, surface, there(surface.mesh), back(surface.mesh))


@pytest.fixture(scope="module")
def with_eyes():
    return clean(TriangleMesh(*together(BODY, *(ball(place) for place in EYES))))


def test_a_mesh_of_one_piece_is_trusted_as_its_map_is():
    surface = clean(TriangleMesh(*BODY))
    there, back = maps(surface, itself, mirrored)
    known = judged_map(surface.mesh, surface.mesh, itself(surface.mesh), mirrored(surface.mesh))
    np.testing.assert_array_equal(there.confidence, known.confidence)
    assert there.share == back.share == 1
    assert there.alone == 0


def test_pieces_that_lead_home_are_trusted(with_eyes):
    eyes = with_eyes.vertex_parts > 0
    for way in maps(with_eyes, itself, itself):
        assert np.abs(way.points.positions - with_eyes.original.vertices).max() < 1e-9
        assert way.confidence[eyes].min() > 0.99
        assert way.share == pytest.approx(1, abs=0.01)


def test_pieces_that_go_elsewhere_on_the_way_back_are_not(with_eyes):
    there, back = maps(with_eyes, itself, mirrored)
    eyes = with_eyes.vertex_parts > 0
    # Forth each eye goes to itself, back to the other.
    assert np.abs(there.points.positions - with_eyes.original.vertices)[eyes].max() < 1e-9
    assert np.linalg.norm(back.points.positions - with_eyes.original.vertices, axis=1)[eyes].min() > 0.5
    for way in (there, back):
        assert way.confidence[eyes].max() < 0.05


def test_pieces_count_by_their_area(with_eyes):
    found, _ = maps(with_eyes, itself, mirrored)
    areas = with_eyes.original.vertex_areas
    main = with_eyes.vertex_parts == 0
    of_all = np.average(found.confidence, weights=areas)
    assert found.share == pytest.approx(of_all / np.average(found.confidence[main], weights=areas[main]))
    assert found.share != 1


def test_what_has_no_partner_is_trusted_as_what_it_lies_on_is(with_eyes):
    bare = clean(TriangleMesh(*BODY))
    found, _ = whole(with_eyes, bare, itself(with_eyes.mesh), itself(bare.mesh))
    eyes = with_eyes.vertex_parts > 0
    assert found.alone > 0.01
    assert 0.05 < found.confidence[eyes].mean() < 0.95


def test_what_the_map_as_a_whole_is_worth_counts_for_pieces_too(with_eyes):
    same = itself(with_eyes.mesh)
    sure, doubtful = (whole(with_eyes, with_eyes, same, same, part)[0] for part in (1.0, 0.4))
    np.testing.assert_allclose(doubtful.confidence, 0.4 * sure.confidence)
    assert doubtful.share == pytest.approx(sure.share)
