# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys that close an eye or a mouth, on heads whose openings are wider or narrower."""

import numpy as np
import pytest

from engine import MatchError, SurfaceMap, SurfacePoints, TriangleMesh, closings_kept_steps, run
from engine.repair.surface_nets import surface_net

WIDTH, DEPTH, STEP = 0.5, 0.2, 0.05


def smooth(values):
    values = np.clip(values, 0, 1)
    return values * values * (3 - 2 * values)


def ball(end=2.0):
    """A ball with a slot at the front (x > 0), which ends there, below the surface if that is less than 1."""
    axis = np.arange(-1.2, 1.2 + STEP, STEP)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    slot = np.maximum.reduce([np.abs(y + 0.001) - WIDTH / 2, DEPTH - x, np.abs(z) - 0.5, x - end])
    points, triangles = surface_net(-np.maximum(np.sqrt(x * x + y * y + z * z) - 1, -slot).astype(np.float32), 0.0)
    points = points * STEP + axis[0]
    mesh = TriangleMesh(points, triangles)
    volume = np.einsum("md,md->", points[triangles[:, 0]], mesh.triangle_normals * mesh.triangle_areas[:, None])
    return mesh if volume > 0 else TriangleMesh(points, triangles[:, ::-1])


@pytest.fixture(scope="module")
def head():
    """A ball with a slot at the front, and a lash on the upper lid: the mesh, and what is the lash."""
    points, triangles = ball().vertices, ball().triangles
    lash = np.array([[0.97, WIDTH / 2, z] for z in np.linspace(-0.2, 0.2, 9)])
    lash = np.concatenate([lash, lash + np.array([0.04, 0.0, 0.0])])
    strip = [(i, i + 1, i + 9) for i in range(8)] + [(i + 1, i + 10, i + 9) for i in range(8)]
    mesh = TriangleMesh(np.concatenate([points, lash]), np.concatenate([triangles, np.array(strip) + len(points)]))
    return mesh, np.arange(mesh.vertex_count) >= len(points)


def closing(mesh):
    """A key by which the upper lid comes down, but for a twentieth of the opening."""
    x, y, _ = mesh.vertices.T
    down = 0.95 * WIDTH * smooth((x - DEPTH) / 0.6) * smooth((0.8 - y) / 0.5) * (y > 0)
    return np.stack([0 * x, -down, 0 * x], axis=1)


@pytest.fixture(scope="module")
def blink(head):
    """A key that closes the slot."""
    return closing(head[0])


def wider(head, by):
    """The same head with another opening, and the maps between both."""
    x, y, z = head[0].vertices.T
    stretched = np.sign(y) * (by - 1) * WIDTH / 2 * smooth((1 - np.abs(y)) / 0.7)
    target = TriangleMesh(np.stack([x, y + stretched, z], axis=1), head[0].triangles)
    return target, (SurfaceMap.identity(target), SurfaceMap.identity(head[0]))


def gaps(head, moved):
    """How far the lids are apart where they are closed in the source: the lower edge of the upper from the lower."""
    x, y, z = head[0].vertices.T
    lids = (np.abs(np.abs(y) - WIDTH / 2) < 0.6 * STEP) & (x > 0.85) & (np.abs(z) < 0.35) & ~head[1]
    upper, lower = (np.flatnonzero(lids & side) for side in (y > 0, y < 0))
    found = []
    for vertex in upper:
        below = lower[np.hypot(x[lower] - x[vertex], z[lower] - z[vertex]) < 0.3 * STEP]
        found.extend(moved[vertex, 1] - moved[below, 1])
    assert len(found) > 10
    return np.array(found)


@pytest.mark.parametrize("by", [0.8, 1.3])
def test_lids_meet_on_an_eye_of_another_height(head, blink, by):
    target, maps = wider(head, by)
    height = np.mean(gaps(head, target.vertices))
    np.testing.assert_allclose(height, by * WIDTH, rtol=0.1)
    left = np.mean(gaps(head, head[0].vertices + blink)) / WIDTH
    before = gaps(head, target.vertices + blink) / height - left
    assert np.abs(before).mean() > 0.2
    (kept,) = run(closings_kept_steps(head[0], [blink], maps, target, [blink]))
    after = gaps(head, target.vertices + kept) / height - gaps(head, head[0].vertices + blink) / WIDTH
    assert np.abs(after).max() < 0.05
    still = ~blink.any(axis=1)
    assert not kept[still].any()


@pytest.mark.parametrize(("unit", "its_unit"), [(100.0, 1.0), (1.0, 0.01)])
def test_units_of_length_do_not_matter(head, blink, unit, its_unit):
    target, maps = wider(head, 1.3)
    (kept,) = run(closings_kept_steps(head[0], [blink], maps, target, [blink]))
    source, other = (
        TriangleMesh(size * mesh.vertices, mesh.triangles) for size, mesh in ((unit, head[0]), (its_unit, target))
    )
    maps = SurfaceMap.identity(other), SurfaceMap.identity(source)
    (again,) = run(closings_kept_steps(source, [unit * blink], maps, other, [its_unit * blink]))
    np.testing.assert_allclose(again / its_unit, kept, atol=1e-6)


def test_a_lash_goes_as_far_as_its_lid(head, blink):
    target, maps = wider(head, 1.3)
    (kept,) = run(closings_kept_steps(head[0], [blink], maps, target, [blink]))
    farther = kept[:, 1] / np.where(blink[:, 1] < 0, blink[:, 1], 1)
    lid = (np.linalg.norm(head[0].vertices - [0.97, WIDTH / 2, 0], axis=1) < 0.1) & ~head[1] & (blink[:, 1] < 0)
    assert farther[lid].mean() > 1.15
    np.testing.assert_allclose(farther[head[1]].mean(), farther[lid].mean(), rtol=0.03)


def test_on_the_same_head_nothing_changes(head, blink):
    maps = (SurfaceMap.identity(head[0]),) * 2
    np.testing.assert_allclose(run(closings_kept_steps(head[0], [blink], maps, head[0], [blink]))[0], blink, atol=1e-9)


def test_keys_that_close_nothing_stay_as_they_are(head, blink):
    target, maps = wider(head, 1.3)
    flat = -0.9 * head[0].vertices * [0, 0, 1]  # brings skin together, with the head between
    keys = np.stack([-blink, 0.3 * blink, flat, 0 * blink])
    np.testing.assert_array_equal(run(closings_kept_steps(head[0], keys, maps, target, keys)), keys)


def test_on_a_head_without_the_opening_keys_stay_as_they_are(head, blink):
    mesh = head[0]
    corners = np.tile(mesh.triangles[0], (mesh.vertex_count, 1))
    lost = SurfacePoints.from_corners(mesh, corners, np.tile([1.0, 0.0, 0.0], (mesh.vertex_count, 1)))
    maps = SurfaceMap.from_points(mesh, lost), SurfaceMap.identity(mesh)
    np.testing.assert_array_equal(run(closings_kept_steps(mesh, [blink], maps, mesh, [blink]))[0], blink)


def test_what_comes_together_out_of_sight_stays_as_it_is():
    mouth = ball(0.8), np.zeros(0, bool)
    target, maps = wider(mouth, 1.3)
    inside = closing(mouth[0]) * (np.linalg.norm(mouth[0].vertices, axis=1) < 0.95)[:, None]
    assert inside.any()
    np.testing.assert_array_equal(run(closings_kept_steps(mouth[0], [inside], maps, target, [inside]))[0], inside)


def test_what_does_not_belong_together_is_refused(head, blink):
    target, maps = wider(head, 1.3)
    few = TriangleMesh(np.eye(3), [[0, 1, 2]])
    with pytest.raises(MatchError, match="should have the shapes"):
        run(closings_kept_steps(head[0], [blink], maps, target, [blink[1:]]))
    with pytest.raises(MatchError, match="one of 3 vertices"):
        run(closings_kept_steps(head[0], [blink], (maps[0], SurfaceMap.identity(few)), target, [blink]))
    with pytest.raises(MatchError, match="one of 3 vertices"):
        run(closings_kept_steps(head[0], [blink], (SurfaceMap.identity(few), maps[1]), target, [blink]))
