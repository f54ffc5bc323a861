# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts and loose vertices that follow the map of the main part."""

import numpy as np
import pytest

from engine import SurfacePoints, TriangleMesh, run
from engine.dense.components import component_alignment as part_placement
from engine.dense.components.component_maps import follow_steps
from engine.repair.cleaning import clean
from tests.messes import cut_along_seam, partly_turned, together
from tests.shapes import bent, compacted, creature, icosphere, permuted, plane, posed, rotation

LEFT_EYE, RIGHT_EYE = np.array([1.12, 0.12, 0.55]), np.array([1.12, -0.12, 0.55])


@pytest.fixture(scope="module")
def rest():
    _, triangles, vertices = creature(0.0, 13)
    return vertices, triangles


def ball(centre, radius, parts=4):
    vertices, triangles = icosphere(parts, radius)
    return vertices * [1, 1, 1.2] + centre, triangles  # an egg


def in_pose(mesh, pose):
    return posed(mesh[0], pose), mesh[1]


def followed(x_mesh, y_mesh, body_count, images=None):
    """Follow the true map of two meshes that both begin with the body, whose vertices correspond by index.

    `images`: for each vertex of the body in X, that in Y.
    """
    x, y = clean(TriangleMesh(*x_mesh)), clean(TriangleMesh(*y_mesh))
    images = np.arange(body_count) if images is None else images
    target = np.zeros(x.mesh.vertex_count, np.int64)
    known = x.main.original_vertices
    target[known >= 0] = y.vertex_images[images[known[known >= 0]]]
    return x, y, run(follow_steps(x, y, SurfacePoints.at_vertices(y.mesh, target)))


def assert_valid(result, y):
    assert np.isfinite(result.points.positions).all()
    assert (result.points.barycentric >= 0).all()
    assert np.allclose(result.points.barycentric.sum(axis=1), 1)
    assert (result.points.triangles >= 0).all()
    assert (result.points.triangles < y.original.triangle_count).all()
    assert ((result.confidence > 0) & (result.confidence <= 1)).all()


def test_the_map_of_a_mesh_to_itself_keeps_every_vertex(rest):
    loose = np.array([[0.0, 0, 0.3], [0, 0, 5.0]]), np.empty((0, 3), np.int64)
    mesh = together(rest, ball(LEFT_EYE, 0.05), ball(RIGHT_EYE, 0.05), loose)
    x, y, result = followed(mesh, mesh, len(rest[0]))
    assert_valid(result, y)
    assert np.abs(result.points.positions[:-2] - mesh[0][:-2]).max() < 1e-9
    assert np.array_equal(result.partners, [0, 1, 2])
    assert np.array_equal(result.confidence[: len(rest[0])], np.ones(len(rest[0])))
    assert (result.confidence[len(rest[0]) : -2] > 0.99).all()
    near, far = result.confidence[-2:]
    assert far < 0.01 < near
    distances = np.linalg.norm(x.mesh.vertices - mesh[0][-2], axis=1)
    assert np.linalg.norm(result.points.positions[-2] - mesh[0][-2]) <= distances.min() + 1e-12
    assert result.surroundings[-2] == distances.argmin()


def test_a_clean_mesh_needs_no_followers(rest):
    x, y, result = followed(rest, in_pose(rest, 0.5), len(rest[0]))
    assert_valid(result, y)
    assert np.allclose(result.points.positions, y.original.vertices)
    assert np.array_equal(result.surroundings, np.arange(len(rest[0])))
    assert (result.confidence == 1).all()
    assert np.array_equal(result.partners, [0])
    assert len(x.pieces) == 1


@pytest.mark.parametrize("mirrored", [False, True])
def test_eyes_find_the_eyes_at_their_place(rest, mirrored):
    x_mesh = together(rest, ball(LEFT_EYE, 0.05), ball(RIGHT_EYE, 0.05))
    # The other way round in the file, a little larger, in another pose, size and place.
    y_rest = together(rest, ball(RIGHT_EYE + 0.01, 0.06), ball(LEFT_EYE - 0.01, 0.055))
    vertices, triangles = in_pose(y_rest, 0.8)
    vertices = 3 * vertices @ rotation([1, 2, 3], 2.0).T + [5, 0, 0]
    if mirrored:
        vertices = vertices * [-1, 1, 1]
    x, y, result = followed(x_mesh, (vertices, triangles), len(rest[0]))
    assert_valid(result, y)
    assert y.counts.inverted == mirrored
    assert (result.partners[1:] > 0).all()
    count, eye = len(rest[0]), len(ball(LEFT_EYE, 0.05)[0])
    left, right = np.arange(count, count + eye), np.arange(count + eye, count + 2 * eye)
    truth = np.empty_like(vertices)
    truth[left], truth[right] = vertices[right], vertices[left]
    for vertices_of_eye in (left, right):
        errors = np.linalg.norm(result.points.positions - truth, axis=1)[vertices_of_eye]
        assert errors.max() < 0.3 * 3 * 0.06
    assert (result.confidence[count:] > 0.3).all()
    assert x.vertex_parts[left[0]] != x.vertex_parts[right[0]]


def test_an_eye_without_a_partner_goes_to_the_surface(rest):
    x_mesh = together(rest, ball(LEFT_EYE, 0.05), ball(RIGHT_EYE, 0.05))
    y_mesh = in_pose(together(rest, ball(RIGHT_EYE, 0.05)), 0.5)
    x, y, result = followed(x_mesh, y_mesh, len(rest[0]))
    assert_valid(result, y)
    count, eye = len(rest[0]), len(ball(LEFT_EYE, 0.05)[0])
    assert sorted(result.partners) == [0, 0, 1]
    left = np.arange(count, count + eye)
    assert (result.partners[x.vertex_parts[left]] == 0).all()
    assert (y.original.triangles[result.points.triangles[left]] < count).all()
    expected = posed(x.original.vertices[left], 0.5)
    assert np.linalg.norm(result.points.positions[left] - expected, axis=1).max() < 0.15
    assert (result.confidence[left] < 1).all()


@pytest.mark.parametrize("other", [ball(LEFT_EYE, 0.2), ball(LEFT_EYE, 0.01), ball([-1.3, 0, 0.1], 0.05)])
def test_parts_of_another_size_or_place_are_no_partners(rest, other):
    x, y, result = followed(together(rest, ball(LEFT_EYE, 0.05)), together(rest, other), len(rest[0]))
    assert_valid(result, y)
    assert np.array_equal(result.partners, [0, 0])
    assert len(x.pieces) == len(y.pieces) == 2


def test_parts_of_another_shape_are_no_partners(rest):
    vertices, triangles = ball([0, 0, 0], 0.08)
    bar = vertices * [2.0, 0.3, 0.3] + LEFT_EYE, triangles
    _, _, result = followed(together(rest, ball(LEFT_EYE, 0.08)), together(rest, bar), len(rest[0]))
    assert np.array_equal(result.partners, [0, 0])


def test_a_row_of_teeth_keeps_its_order(rest):
    places = LEFT_EYE + np.linspace([-0.3, 0.1, 0.2], [0.3, 0.1, 0.2], 7)
    x_mesh = together(rest, *(ball(place, 0.03, 2) for place in places))
    y_mesh = in_pose(together(rest, *(ball(place, 0.03, 2) for place in places[::-1])), 0.4)
    x, y, result = followed(x_mesh, y_mesh, len(rest[0]))
    count, tooth = len(rest[0]), len(ball(LEFT_EYE, 0.03, 2)[0])
    for number in range(7):
        mine = x.vertex_parts[count + number * tooth]
        its = y.vertex_parts[count + (6 - number) * tooth]
        assert result.partners[mine] == its


def test_loose_vertices_follow_their_limb(rest):
    vertices, triangles = rest
    shapes = TriangleMesh(vertices, triangles)
    chosen = np.arange(0, len(vertices), 7)
    hairs = vertices[chosen] + 0.02 * shapes.vertex_normals[chosen]
    x_mesh = together(rest, (hairs, np.empty((0, 3), np.int64)))
    y_mesh = in_pose(rest, 1.0)
    _, y, result = followed(x_mesh, y_mesh, len(vertices))
    assert_valid(result, y)
    errors = np.linalg.norm(result.points.positions[len(vertices) :] - y.original.vertices[chosen], axis=1)
    assert errors.max() < 0.06
    assert np.median(errors) < 0.01
    assert (result.confidence[len(vertices) :] > 0.9).all()


def test_the_map_leads_back_through_every_mess(rest):
    count = len(rest[0])
    loose = np.array([[0.0, 0, 0.4]]), np.empty((0, 3), np.int64)
    x_mesh = together(rest, ball(LEFT_EYE, 0.05), loose)
    y_mesh = in_pose(together(rest, ball(LEFT_EYE, 0.05)), 0.6)
    _, _, plain = followed(x_mesh, y_mesh, count)

    messy_x = partly_turned(*cut_along_seam(*x_mesh), 0.2)
    messy_y = partly_turned(*cut_along_seam(*y_mesh, axis=1), 0.2, seed=1)
    vertices, triangles, new_y = permuted(*messy_y, 3)
    x, y, result = followed(messy_x, (vertices, triangles), count, new_y[:count])
    assert_valid(result, y)
    assert np.abs(result.points.positions[: len(x_mesh[0])] - plain.points.positions).max() < 1e-6
    copies = np.arange(len(x_mesh[0]), len(messy_x[0]))
    assert np.array_equal(x.vertex_parts[copies], np.zeros(len(copies)))


def test_a_few_triangles_are_enough_to_follow():
    body = icosphere(1)
    loose = np.array([[0.0, 0, 1.5]]), np.empty((0, 3), np.int64)
    mesh = together(body, ball([0, 1.3, 0], 0.1, 1), loose)
    _, y, result = followed(mesh, (mesh[0] * 2, mesh[1]), len(body[0]))
    assert_valid(result, y)
    assert np.array_equal(result.partners, [0, 1])
    assert np.allclose(result.points.positions[:-1], 2 * mesh[0][:-1])


def limb(start, end, width):
    """A part along a line, thicker at its start and flat, so that no turn about the line brings it onto itself."""
    vertices, triangles = icosphere(6)
    start, end = np.asarray(start, float), np.asarray(end, float)
    along = (end - start) / np.linalg.norm(end - start)
    side = np.cross(along, [0, 0, 1])
    side /= np.linalg.norm(side)
    x, y, z = vertices.T
    sizes = width * (1.3 - 0.5 * x), 0.6 * width * np.where(z > 0, 1, 0.4)
    across = np.outer(sizes[0] * y, side) + np.outer(sizes[1] * z, np.cross(along, side))
    return (start + end) / 2 + np.outer(x * np.linalg.norm(end - start) / 2, along) + across, triangles


def swung(points, joint, axis, angle):
    return (points - joint) @ rotation(axis, angle).T + joint


TRUNK = icosphere(10)[0] * [0.5, 0.5, 1.0], icosphere(10)[1]
SHOULDER, ELBOW, WRIST = np.array([0.45, 0, 0.3]), np.array([1.1, 0, 0.3]), np.array([1.7, 0, 0.3])


def in_parts(*more):
    """A trunk, and beside it an upper arm and a forearm that are parts of their own, and others."""
    return together(TRUNK, limb(SHOULDER - [0.05, 0, 0], ELBOW, 0.12), limb(ELBOW - [0.05, 0, 0], WRIST, 0.1), *more)


def arm_swung(vertices, counts, shoulder, elbow):
    """Swing the arm at the shoulder and at the elbow; what is beyond the forearm in the file goes with it."""
    first, second = counts
    vertices = vertices.copy()
    vertices[second:] = swung(vertices[second:], ELBOW, [0, 1, 0.3], elbow)
    vertices[first:] = swung(vertices[first:], SHOULDER, [0, 1, -0.5], shoulder)
    return vertices


@pytest.mark.parametrize(("shoulder", "elbow"), [(0.4, 0.5), (-0.9, 1.2), (1.0, -1.4)])
def test_a_forearm_follows_the_upper_arm_that_is_a_part_as_well(shoulder, elbow):
    vertices, triangles = in_parts()
    trunk, arm = len(TRUNK[0]), len(limb(SHOULDER, ELBOW, 1)[0])
    moved = arm_swung(vertices, (trunk, trunk + arm), shoulder, elbow)
    order = np.r_[:trunk, trunk + arm : trunk + 2 * arm, trunk : trunk + arm]  # the forearm first in the file
    back = np.argsort(order)
    _, y, result = followed((vertices, triangles), (moved[order], back[triangles]), trunk)
    assert_valid(result, y)
    errors = np.linalg.norm(result.points.positions - moved, axis=1)
    assert (result.partners[1:] > 0).all()
    assert errors[trunk:].max() < 0.02
    assert (result.confidence[trunk:] > 0.3).all()


def test_what_has_no_partner_follows_the_part_that_it_is_next_to():
    button = ball((ELBOW + WRIST) / 2 + [0, 0.09, 0], 0.02, 2)
    loose = (ELBOW + WRIST)[None] / 2 + [0, -0.1, 0.02], np.empty((0, 3), np.int64)
    vertices, triangles = in_parts(button, loose)
    trunk, arm = len(TRUNK[0]), len(limb(SHOULDER, ELBOW, 1)[0])
    bare, its_triangles = in_parts()
    moved = arm_swung(vertices, (trunk, trunk + arm), 0.8, 1.2)
    x, y, result = followed((vertices, triangles), (moved[: len(bare)], its_triangles), trunk)
    assert_valid(result, y)
    others = np.arange(len(bare), len(vertices))
    assert (y.original.triangles[result.points.triangles[others]] >= trunk + arm).all()
    assert np.linalg.norm(result.points.positions[others] - moved[others], axis=1).max() < 0.08
    assert result.partners[x.vertex_parts[others[0]]] == 0
    areas = np.array([piece.mesh.area for piece in x.pieces])
    assert result.alone == pytest.approx(areas[-1] / areas.sum())


def tail(bend):
    """A thin, flat part behind the trunk, bent upwards or downwards from its root on."""
    vertices, triangles = icosphere(10)
    x, y, z = vertices.T
    along, taper = 0.9 * (x + 1), 0.15 * (1 - 0.3 * x)
    height = taper * z * np.where(z > 0, 0.7, 0.3)
    radius = 1 / bend
    bent = np.stack(
        [(radius - height) * np.sin(along / radius), taper * y, radius - (radius - height) * np.cos(along / radius)], 1
    )
    return [-0.4, 0, -0.3] + bent * [-1, 1, 1], triangles


@pytest.mark.parametrize(("before", "after"), [(0.2, 1.0), (0.9, -0.2), (-0.5, 0.5)])
def test_a_tail_that_is_bent_otherwise_is_deformed(before, after):
    vertices, triangles = together(TRUNK, tail(before))
    moved = together(TRUNK, tail(after))[0]
    trunk = len(TRUNK[0])
    _, y, result = followed((vertices, triangles), (moved, triangles), trunk)
    assert_valid(result, y)
    errors = np.linalg.norm(result.points.positions - moved, axis=1)[trunk:]
    assert np.array_equal(result.partners, [0, 1])
    assert errors.mean() < 0.04  # the tail is 1.8 long
    assert errors.max() < 0.15


def test_legs_that_cross_keep_to_their_hips():
    hips = np.array([[0.0, 0.14, -0.8], [0.0, -0.14, -0.8]])
    legs = [limb(np.add(hip, [0, 0, 0.05]), np.add(hip, [0.01, 0, -1.2]), 0.1) for hip in hips]
    vertices, triangles = together(TRUNK, *legs)
    moved, trunk, count = vertices.copy(), len(TRUNK[0]), len(legs[0][0])
    for number, (hip, angle) in enumerate(zip(hips, (-0.6, 0.6), strict=True)):
        its = slice(trunk + number * count, trunk + (number + 1) * count)
        moved[its] = swung(moved[its], hip, [1, 0.2, 0], angle)
    order = np.r_[:trunk, trunk + count : trunk + 2 * count, trunk : trunk + count]
    back = np.argsort(order)
    _, y, result = followed((vertices, triangles), (moved[order], back[triangles]), trunk)
    assert_valid(result, y)
    centres = [moved[trunk + number * count :][:count].mean(axis=0) for number in (0, 1)]
    assert centres[0][1] < centres[1][1]  # they cross
    assert np.linalg.norm(result.points.positions - moved, axis=1)[trunk:].max() < 0.02


def test_a_leg_with_its_knee_bent_finds_the_straight_one():
    hip = np.array([0.0, 0.2, -0.8])
    vertices, triangles = together(TRUNK, limb(np.add(hip, [0, 0, 0.05]), np.add(hip, [0.01, 0, -1.6]), 0.1))
    moved, trunk = vertices.copy(), len(TRUNK[0])
    knee = hip - [0, 0, 0.8]
    below = np.clip((knee[2] - moved[trunk:, 2]) / 0.2 + 0.5, 0, 1)
    x, z = moved[trunk:, 0], moved[trunk:, 2] - knee[2]
    angle = 1.6 * below
    moved[trunk:, 0], moved[trunk:, 2] = (
        np.cos(angle) * x + np.sin(angle) * z,
        np.cos(angle) * z - np.sin(angle) * x + knee[2],
    )
    _, y, result = followed((vertices, triangles), (moved, triangles), trunk)
    assert_valid(result, y)
    assert np.array_equal(result.partners, [0, 1])
    assert np.linalg.norm(result.points.positions - moved, axis=1)[trunk:].mean() < 0.15  # the leg is 1.65 long


@pytest.mark.parametrize("turn", [1.5, -2.4])
def test_an_arm_may_be_turned_about_itself(turn):
    vertices, triangles = together(TRUNK, limb(SHOULDER - [0.05, 0, 0], ELBOW, 0.12))
    moved, trunk = vertices.copy(), len(TRUNK[0])
    moved[trunk:] = swung(swung(moved[trunk:], SHOULDER, [1, 0, 0], turn), SHOULDER, [0, 1, 0.2], 0.6)
    _, y, result = followed((vertices, triangles), (moved, triangles), trunk)
    assert_valid(result, y)
    assert np.linalg.norm(result.points.positions - moved, axis=1)[trunk:].max() < 0.02


def clothes(vertices, triangles, worn):
    """What lies just above some triangles of a body, where its vertices are now."""
    lifted = vertices + 0.03 * TriangleMesh(vertices, triangles).vertex_normals
    return compacted(lifted, triangles[worn])


@pytest.mark.parametrize("most", [10_000, 100])  # deformed, or too large for that
def test_clothes_follow_the_body_that_wears_them(rest, most, monkeypatch):
    monkeypatch.setattr(part_placement, "_DEFORMED", (40, most))
    vertices, triangles = rest
    worn = (vertices[triangles][:, :, 0].min(axis=1) > -0.2) & (vertices[triangles][:, :, 2].max(axis=1) < 0.25)
    poses = [posed(vertices, pose) for pose in (-0.8, 1.2)]
    x_mesh, y_mesh = (together((pose, triangles), clothes(pose, triangles, worn)) for pose in poses)
    _, y, result = followed(x_mesh, y_mesh, len(vertices))
    assert_valid(result, y)
    assert np.array_equal(result.partners, [0, 1])
    errors = np.linalg.norm(result.points.positions - y_mesh[0], axis=1)[len(vertices) :]
    assert errors.mean() < 0.025  # the legs are 0.7 long
    assert errors.max() < 0.2


def test_a_sleeve_on_an_arm_that_is_folded_finds_the_one_on_the_straight_arm():
    """Its extent is less than half of what it was; the surface is as large as before."""
    vertices, triangles = icosphere(16)
    vertices = vertices * [3.0, 0.2, 0.2]
    folded = bent(vertices - [-0.5, 0, 0], np.array([1.0, 0, 0]), np.array([0, 0, 1.0]), 1.0, 3.0)
    worn = np.abs(vertices[triangles][:, :, 0]).max(axis=1) < 2.5
    x_mesh, y_mesh = (together((now, triangles), clothes(now, triangles, worn)) for now in (vertices, folded))
    _, y, result = followed(x_mesh, y_mesh, len(vertices))
    assert_valid(result, y)
    assert np.array_equal(result.partners, [0, 1])
    assert np.linalg.norm(result.points.positions - y_mesh[0], axis=1)[len(vertices) :].mean() < 0.05


def test_clothes_are_no_partner_of_a_floor(rest):
    """Of like size, and not far away; but what lies on a body goes where that goes."""
    vertices, triangles = rest
    worn = (vertices[triangles][:, :, 0].min(axis=1) > -0.2) & (vertices[triangles][:, :, 2].max(axis=1) < 0.25)
    flat, faces = plane(12, 0.9)
    floor = flat - [0.1, 0.45, 0.9], faces
    x_mesh = together(rest, clothes(vertices, triangles, worn))
    _, y, result = followed(x_mesh, together(rest, floor), len(vertices))
    assert_valid(result, y)
    assert np.array_equal(result.partners, [0, 0])
    assert np.linalg.norm(result.points.positions - x_mesh[0], axis=1).max() < 0.06
