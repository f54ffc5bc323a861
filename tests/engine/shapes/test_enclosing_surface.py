# SPDX-License-Identifier: GPL-3.0-or-later
"""One surface around all pieces of a body."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import Shape, TriangleMesh
from engine.geometry.handle_loops import genus
from engine.mesh.closest_points import ClosestPoints
from engine.mesh.surface_points import SurfacePoints
from engine.repair.cleaning import clean
from engine.runtime.progress import run
from engine.shapes import enclosing_surface
from engine.shapes.enclosing_surface import with_limbs_steps
from tests.limbs import modular_creature
from tests.messes import together
from tests.shapes import creature, icosphere, permuted, rotation, wire_box


def joined(mesh):
    return run(with_limbs_steps(Shape(mesh, "source"), "source", np.arange(mesh.vertex_count))).surface


@pytest.fixture(scope="module")
def body():
    return modular_creature()


@pytest.fixture(scope="module")
def surface(body):
    return joined(body.mesh)


def whole():
    vertices, triangles, _ = creature(0.0, 10)
    return TriangleMesh(vertices, triangles)


def closeness(mesh, points):
    """Distances of points from a mesh, over the root of the area of the creature."""
    return np.sqrt(ClosestPoints(mesh).nearest(points).squared_distances) / 2.48


def test_it_is_the_surface_of_the_whole_body(surface):
    mesh = surface.mesh
    assert mesh.is_closed
    assert mesh.component_count == 1
    assert genus(mesh) == 0
    assert mesh.area == pytest.approx(whole().area, rel=0.05)
    assert closeness(whole(), mesh.vertices).max() < 0.02
    assert closeness(mesh, whole().vertices).max() < 0.02
    assert any("made of 7 pieces" in note for note in surface.cleaned.notes)
    assert not any("opening" in note or "smaller part" in note for note in surface.cleaned.notes)


def test_there_and_back_leads_home(surface, body):
    every = np.arange(body.mesh.vertex_count)
    assert (surface.cleaned.vertex_parts == 0).all()
    back = surface.on_original(surface.cleaned.main.places(every))
    away = np.linalg.norm(back.positions - body.mesh.vertices[every], axis=1) / 2.48
    assert np.median(away) < 0.004
    assert away.max() < 0.03  # beneath the trunk
    # The nearest vertices lie no farther than the spacing of either mesh.
    near = body.mesh.vertices[surface.vertices] - surface.mesh.vertices
    assert (np.linalg.norm(near, axis=1) / 2.48).max() < 0.05


def test_a_map_of_it_is_one_of_all_vertices(surface, body):
    identity = SurfacePoints.at_vertices(surface.mesh, np.arange(surface.mesh.vertex_count))
    every = np.arange(body.mesh.vertex_count)
    triangles, barycentric = surface.cleaned.images_of(every, identity, surface.mesh)
    images = SurfacePoints.from_barycentric(surface.mesh, triangles, barycentric)
    assert (np.linalg.norm(images.positions - body.mesh.vertices, axis=1) / 2.48).max() < 0.03


def test_pieces_that_are_inside_out_do_not_matter(body, surface):
    triangles = body.mesh.triangles.copy()
    for piece in (0, 2, 5):
        turned = body.pieces[triangles[:, 0]] == piece
        triangles[turned] = triangles[turned][:, ::-1]
    other = joined(TriangleMesh(body.mesh.vertices, triangles))
    assert closeness(surface.mesh, other.mesh.vertices).max() < 0.005


def test_order_place_and_size_do_not_matter(body, surface):
    vertices, triangles, _ = permuted(body.mesh.vertices, body.mesh.triangles)
    turn = rotation([1.0, 2, 3], 1.0)
    other = joined(TriangleMesh(1000 * vertices @ turn.T + 700, triangles))
    back = (other.mesh.vertices - 700) @ turn / 1000
    assert closeness(surface.mesh, back).max() < 0.01
    assert np.median(closeness(surface.mesh, back)) < 0.002


def test_gaps_are_bridged(body):
    vertices = body.mesh.vertices.copy()
    for piece in range(1, 7):
        own = body.pieces == piece
        away = vertices[own].mean(axis=0) - vertices[body.pieces == 0].mean(axis=0)
        vertices[own] += 0.2 * away / np.linalg.norm(away)
    found = joined(TriangleMesh(vertices, body.mesh.triangles))
    assert found.mesh.component_count == 1
    assert found.cleaned.main.shown.triangle_count == body.mesh.triangle_count
    assert (closeness(found.mesh, vertices) < 0.02).mean() > 0.98


def test_seen_in_a_mirror_it_stands_for_the_mirrored_body(surface, body):
    mirrored = surface.reflected()
    back = mirrored.on_original(mirrored.cleaned.main.places(np.arange(body.mesh.vertex_count)))
    away = np.linalg.norm(back.positions - body.mesh.vertices * [-1, 1, 1], axis=1) / 2.48
    assert np.median(away) < 0.004
    assert mirrored.mesh.vertices == pytest.approx(surface.mesh.vertices * [-1, 1, 1])


def test_limbs_are_separate_but_eyes_and_clothes_are_not(body):
    vertices, triangles, _ = creature(0.0, 10)
    mesh = TriangleMesh(vertices, triangles)
    middle = abs(vertices[:, 0]) < 0.4
    coat = vertices + 0.03 * mesh.vertex_normals, triangles[middle[triangles].all(axis=1)]
    ball, faces = icosphere(3)
    eye = 0.06 * ball + [1.2, 0.1, 0.5], faces
    clothed = clean(TriangleMesh(*together((vertices, triangles), coat, eye)))
    assert not clothed.limbs.any()
    assert np.array_equal(clean(body.mesh).limbs, body.pieces > 0)


def test_eyes_stay_pieces_of_their_own(body):
    ball, faces = icosphere(3)
    eyes = [(0.06 * ball + [1.2, side, 0.5], faces) for side in (-0.1, 0.1)]
    found = joined(TriangleMesh(*together((body.mesh.vertices, body.mesh.triangles), *eyes)))
    assert len(found.cleaned.pieces) == 3
    count = body.mesh.vertex_count
    assert np.array_equal(found.cleaned.vertex_parts > 0, np.arange(count + 2 * len(ball)) >= count)
    assert {"The source has 2 smaller parts: they follow their surroundings."} <= set(found.cleaned.notes)


def test_small_parts_of_a_finger_belong_to_the_body_but_an_eye_of_their_size_does_not(body):
    ball, faces = icosphere(4)
    tip = body.mesh.vertices[body.mesh.vertices[:, 0].argmax()]
    parts = [(ball * [0.05, 0.035, 0.035] + tip + [0.03 + 0.08 * number, 0, 0], faces) for number in range(4)]
    eye = ball * 0.035 + tip - [0.1, 0, 0], faces
    mesh = TriangleMesh(*together((body.mesh.vertices, body.mesh.triangles), *parts, eye))
    count = body.mesh.vertex_count
    of_body = np.arange(mesh.vertex_count) < count + 4 * len(ball)
    assert clean(mesh).limbs[count:].tolist() == of_body[count:].tolist()
    surface = joined(mesh)
    assert surface.mesh.vertices[:, 0].max() == pytest.approx(mesh.vertices[:, 0].max(), abs=0.03)


def test_thin_parts_of_a_finger_and_the_balls_between_them_are_all_joined(body):
    ball, faces = icosphere(4)
    tip = body.mesh.vertices[body.mesh.vertices[:, 0].argmax()]
    places = tip + np.arange(8)[:, None] * [0.03, 0, 0]
    sizes = [(0.016, 0.012, 0.012), (0.02, 0.008, 0.008)]
    finger = [(ball * sizes[number % 2] + place, faces) for number, place in enumerate(places)]
    mesh = TriangleMesh(*together((body.mesh.vertices, body.mesh.triangles), *finger))
    surface = joined(mesh)
    assert surface.mesh.component_count == 1
    assert surface.mesh.vertices[:, 0].max() == pytest.approx(places[-1, 0], abs=0.03)
    assert (surface.cleaned.vertex_parts == 0).all()


def test_a_mesh_in_one_piece_has_no_limbs():
    shape = Shape(whole())
    assert not shape.surface.cleaned.limbs.any()
    assert run(with_limbs_steps(shape, "source", np.arange(5))) is shape


def test_a_shape_is_joined_only_once(body):
    shape, every = Shape(body.mesh), np.arange(body.mesh.vertex_count)
    joined_shape = run(with_limbs_steps(shape, "source", every))
    assert run(with_limbs_steps(shape, "source", every)) is joined_shape
    # Seen in a mirror it is another one.
    other = run(with_limbs_steps(shape.reflected(), "source", every))
    assert other.mesh.vertices[:, 0].min() == pytest.approx(-joined_shape.mesh.vertices[:, 0].max(), abs=0.02)


def test_only_what_is_asked_for_is_joined(body):
    shape = Shape(body.mesh)
    assert run(with_limbs_steps(shape, "source", np.flatnonzero(body.pieces == 0))) is shape
    other = run(with_limbs_steps(shape, "source", np.flatnonzero(body.pieces == 3)[:2]))
    assert (other.surface.cleaned.vertex_parts == 0).all()
    # What does not exist is refused elsewhere, in words.
    assert run(with_limbs_steps(shape, "source", np.array([-1, 10**6]))) is shape


def test_sheets_have_no_inside():
    """A floor beside a body in two pieces is not a part of it."""
    vertices, triangles, _ = creature(0.0, 10)
    ahead = vertices[:, 0] > 0.1
    front, rear = (triangles[keep[triangles].all(axis=1)] for keep in (ahead, ~ahead))
    floor = np.array([[-2.0, -2, -1.5], [2, -2, -1.5], [2, 2, -1.5], [-2, 2, -1.5]]), np.array([[0, 1, 2], [0, 2, 3]])
    found = joined(TriangleMesh(*together((vertices, front), (vertices, rear), floor)))
    assert found.mesh.vertices[:, 2].min() > -1.3
    nearest = cKDTree(found.mesh.vertices).query(vertices)[0]
    assert np.median(nearest) / 2.48 < 0.02


def test_what_is_too_far_away_stays_a_piece(body):
    vertices = body.mesh.vertices.copy()
    vertices[body.pieces == 2] += [0.0, 0.0, -3.0]
    found = joined(TriangleMesh(vertices, body.mesh.triangles))
    assert len(found.cleaned.pieces) == 2
    assert np.array_equal(found.cleaned.vertex_parts, (body.pieces == 2).astype(int))
    assert any("made of 6 pieces" in note for note in found.cleaned.notes)


def test_scattered_pieces_are_not_joined(body):
    vertices = body.mesh.vertices + np.arange(7)[body.pieces, None] * [0.0, 0.0, 3.0]
    shape = Shape(TriangleMesh(vertices, body.mesh.triangles))
    assert run(with_limbs_steps(shape, "source", np.arange(len(vertices)))) is shape


def test_what_holds_two_parts_of_a_body_together_belongs_to_it_though_most_of_it_lies_in_them():
    ball, faces = icosphere(12)
    box = ball / np.abs(ball).max(axis=1, keepdims=True)
    halves = [(box * [1, 1, 1.5] + [0, 0, 1.79 * side], faces) for side in (-1, 1)]  # farther apart than is bridged
    waist = box * [0.9, 0.9, 0.39], faces
    mesh = TriangleMesh(*together(*halves, waist))
    assert not clean(mesh).limbs[-1]
    found = joined(mesh)
    assert found.mesh.component_count == 1
    assert (found.cleaned.vertex_parts == 0).all()
    # Without it they stay apart.
    assert (joined(TriangleMesh(*together(*halves))).cleaned.vertex_parts > 0).any()


def test_a_frame_of_wire_is_as_what_it_encloses():
    ball, faces = icosphere(12)
    box = ball / np.abs(ball).max(axis=1, keepdims=True)
    halves = [(box * [1, 1, 1.5] + [0, 0, 2.6 * side], faces) for side in (-1, 1)]
    wires = wire_box(4, 0.05, (1.8, 1.8, 2.4))
    found = joined(TriangleMesh(*together(*halves, wires)))
    assert (found.cleaned.vertex_parts == 0).all()
    assert genus(found.mesh) == 0
    height = found.mesh.vertices[:, 2]
    assert (height.min(), height.max()) == pytest.approx((-4.1, 4.1), abs=0.1)
    # Nothing of it is within the frame.
    middle = found.mesh.vertices[np.abs(height) < 0.8]
    assert np.abs(middle[:, :2]).max(axis=1).min() > 0.8


def test_where_next_to_nothing_is_inside_pieces_stay_as_they_are(body, monkeypatch):
    # Of scattered sheets a speck may be inside, whose area says nothing of theirs.
    vertices, triangles = icosphere(1)
    monkeypatch.setattr(enclosing_surface, "surface_net", lambda *_: (1e-6 * vertices, triangles))
    surface = joined(body.mesh)
    assert surface.cleaned.vertex_parts.max() > 0
    assert surface.mesh.area < whole().area
