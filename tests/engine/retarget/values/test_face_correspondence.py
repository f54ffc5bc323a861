# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of one mesh on another."""

from __future__ import annotations

import numpy as np

from engine import SurfaceMap
from engine.mesh.closest_points import FoundPoints
from engine.retarget.values.charts import cut_into_sheets
from engine.retarget.values.face_correspondence import FacePlaces
from tests.faces import closest_map, grid, triangulated, tube


def test_seats_are_under_the_centres():
    source, target = grid(5, 4), grid(7, 9)
    image = triangulated(*source[:2])
    places = FacePlaces(image, target[1], closest_map(target[0], image))
    centres = target[1].face_means(target[0][target[1].corner_vertices])
    np.testing.assert_allclose(places.centres, centres, atol=1e-12)
    np.testing.assert_allclose(places.centres, centres, atol=1e-12)
    np.testing.assert_allclose(places.reaches, np.hypot(1 / 14, 1 / 18))
    np.testing.assert_array_equal(places.confidence, 1)


def test_samples_belong_to_their_faces():
    source = grid(5, 4)
    image = triangulated(*source[:2])
    samples = FacePlaces(image, source[1], SurfaceMap.identity(image)).samples
    np.testing.assert_array_equal(source[1].triangle_faces[samples.triangles], samples.faces)
    assert np.bincount(samples.faces).tolist() == [5] * 20


def test_corners_keep_to_the_side_of_a_cut_where_the_centre_is():
    vertices, faces, uvs = tube(12, 4)
    image = triangulated(vertices, faces)
    sheets = cut_into_sheets(image, faces, uvs, 1e-6)
    found = FacePlaces(image, faces, SurfaceMap.identity(image)).on_sheets(sheets)
    assert not found.is_beyond.any()
    np.testing.assert_allclose(sheets.at(found.triangles, found.barycentric), uvs, atol=1e-12)


def test_a_face_may_be_seated_elsewhere():
    vertices, faces, uvs = grid(6, 4)
    right = np.arange(24) % 6 >= 3
    image = triangulated(vertices, faces)
    sheets = cut_into_sheets(image, faces, uvs + 5 * right[faces.corner_faces, None], 1e-6)
    places = FacePlaces(image, faces, SurfaceMap.identity(image))
    before = places.on_sheets(sheets)
    seats = places.seated_beside(sheets, places.seats, np.array([2]), np.array([3]))
    assert sheets.labels[seats.triangles[2]] == sheets.labels[seats.triangles[3]]
    whole, part = places.on_sheets(sheets, seats), places.on_sheets(sheets, seats, before)
    np.testing.assert_array_equal(whole.triangles, part.triangles)
    np.testing.assert_array_equal(whole.offsets, part.offsets)
    # Its outer corners lie beyond the border of the other sheet now, its inner ones on it.
    np.testing.assert_array_equal(np.flatnonzero(whole.is_beyond), [8, 11])
    np.testing.assert_allclose(whole.offsets[8], [-1 / 6, 0, 0], atol=1e-12)
    assert isinstance(whole.seats, FoundPoints)
