# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes that are fitted to other bodies: truths that are known, and what must not happen."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import ClosestPoints, MatchError, MeshError, SurfaceMap, TriangleMesh, run
from engine.mesh.reflection import reflected_map, reflected_mesh
from engine.retarget.wear.wearing import wear_steps
from engine.retarget.wear.worn_item import WornItem
from tests.shapes import icosphere, rotation

TURN = rotation([1.0, 2.0, -1.0], 1.1)


def ball(resolution=8, radius=1.0, centre=(0.0, 0.0, 0.0)):
    vertices, triangles = icosphere(resolution, radius)
    return TriangleMesh(vertices + np.array(centre), triangles)


def cap(mesh, height):
    """The part of a mesh above a height: cloth with a rim."""
    return mesh.submesh(mesh.vertices[:, 2] > height)[0]


def wear(source, images, items):
    """Fit items to the source itself when its vertices are moved."""
    target = TriangleMesh(images, source.triangles)
    return run(wear_steps(source, target, SurfaceMap.identity(target), images, items))


BODY = ball(9)
SHIRT, COAT = cap(ball(7, 1.05), -0.3), cap(ball(6, 1.12), -0.5)
BUTTON = ball(1, 0.04, (0.0, -1.1, 0.0))


def test_the_same_body_changes_nothing():
    fitted = wear(BODY, BODY.vertices, [WornItem(SHIRT), WornItem(COAT)])
    for item, one in zip((SHIRT, COAT), fitted, strict=True):
        np.testing.assert_allclose(one.positions, item.vertices, atol=1e-6)
        np.testing.assert_allclose(one.scales, 1, atol=1e-9)
        assert not one.pushed.any()
        np.testing.assert_allclose(one.places.sum(axis=1), 1)


def test_a_body_that_wears_nothing_has_nothing_to_be_fitted():
    assert wear(BODY, 2 * BODY.vertices, []) == []


def test_a_similar_body_gets_similar_clothes():
    def moved(points):
        return 2.5 * points @ TURN.T + np.array([3.0, -1.0, 2.0])

    fitted = wear(BODY, moved(BODY.vertices), [WornItem(SHIRT), WornItem(COAT, fit="LOOSE")])
    for item, one in zip((SHIRT, COAT), fitted, strict=True):
        np.testing.assert_allclose(one.positions, moved(item.vertices), atol=2e-5)
        np.testing.assert_allclose(one.rotations, np.broadcast_to(TURN, one.rotations.shape), atol=1e-5)


def test_clothes_of_a_wider_body_keep_their_distance_and_their_order():
    images = BODY.vertices * [1.5, 1.2, 1.0]
    shirt, coat = wear(BODY, images, [WornItem(SHIRT), WornItem(COAT)])
    assert shirt.clearance.min() > 0.02
    assert coat.clearance.min() > shirt.clearance.max()
    inner = ClosestPoints(TriangleMesh(shirt.positions, SHIRT.triangles))
    over = TriangleMesh(coat.positions, COAT.triangles)
    found = inner.nearest(over.vertices)
    feet = np.einsum("kc,kci->ki", found.barycentric, shirt.positions[SHIRT.triangles[found.triangles]])
    assert (np.einsum("ki,ki->k", over.vertices - feet, over.vertex_normals) > 0).all()


def test_of_two_items_that_one_is_inner_that_the_other_lies_over():
    """A jacket is close to the skin but for its hem, which hangs over a skirt; there the other body has a bump."""
    ring = ball(14, 1.06)
    skirt = ring.submesh(np.abs(ring.vertices[:, 2] + 0.45) < 0.35)[0]
    jacket = cap(ball(14, 1.03), -0.4)
    hem = jacket.vertices[:, 2] < -0.05
    jacket = TriangleMesh(jacket.vertices * np.where(hem, 1.09 / 1.03, 1.0)[:, None], jacket.triangles)
    bump = np.exp(-np.square(BODY.vertices - [0.0, -1.0, -0.25]).sum(axis=1) / 0.05)
    target = TriangleMesh(BODY.vertices * (1 + 0.2 * bump)[:, None], BODY.triangles)
    items = [WornItem(jacket), WornItem(skirt)]
    over, under = run(wear_steps(BODY, target, SurfaceMap.identity(target), BODY.vertices, items))
    below = TriangleMesh(under.positions, skirt.triangles)
    lying = jacket.vertices[:, 2] < -0.2
    assert under.pushed.max() > 0.05
    assert np.nanmin(above(below, over.positions[lying])) > 0


def test_nothing_pokes_through_where_the_body_has_grown_a_bump():
    # The map knows nothing of the bump: it takes the body to itself, and the bump comes on top.
    images = BODY.vertices.copy()
    bump = np.exp(-np.square(BODY.vertices - [0.0, -0.6, 0.8]).sum(axis=1) / 0.02)
    target = TriangleMesh(images * (1 + 0.15 * bump)[:, None], BODY.triangles)
    item = WornItem(SHIRT)
    (fitted,) = run(wear_steps(BODY, target, SurfaceMap.identity(target), images, [item]))
    assert fitted.clearance.min() >= 0
    assert fitted.pushed.max() > 0.05
    far = np.linalg.norm(SHIRT.vertices - [0.0, -0.6, 0.8], axis=1) > 1.0
    assert fitted.pushed[far].max() < 0.01
    cloth = ClosestPoints(TriangleMesh(fitted.positions, SHIRT.triangles))
    top = target.vertices[[int(bump.argmax())]]
    found = cloth.nearest(top)
    foot = np.einsum("kc,kci->ki", found.barycentric, fitted.positions[SHIRT.triangles[found.triangles]])
    assert np.linalg.norm(foot) > np.linalg.norm(top)
    # Left alone it would.
    (left,) = run(wear_steps(BODY, target, SurfaceMap.identity(target), images, [WornItem(SHIRT, fit="LEAVE")]))
    assert left.clearance.min() < -0.03
    assert not left.pushed.any()


def above(mesh, points):
    """How far points (k, 3) are beyond a surface around the origin, seen from there; nan where there is none."""
    heights = np.full(len(points), np.nan)
    origin, first, second = mesh.vertices[mesh.triangles].transpose(1, 0, 2)
    first, second = first - origin, second - origin
    for number, point in enumerate(points):
        length = np.linalg.norm(point)
        solved = np.linalg.solve(
            np.stack([np.broadcast_to(point / length, origin.shape), -first, -second], axis=2), origin[..., None]
        )[..., 0]
        hit = (solved[:, 0] > 0) & (solved[:, 1:] >= 0).all(axis=1) & (solved[:, 1:].sum(axis=1) <= 1)
        if hit.any():
            heights[number] = length - solved[hit, 0].max()
    return heights


@pytest.mark.parametrize("seed", [0, 1])
def test_edges_of_a_rough_body_do_not_come_through_those_of_the_cloth(seed):
    rough = BODY.vertices * (1 + 0.15 * np.random.default_rng(seed).random(BODY.vertex_count))[:, None]
    target = TriangleMesh(rough, BODY.triangles)
    cloth = cap(TriangleMesh(ball(9, 1.03).vertices @ TURN.T, BODY.triangles), -0.3)
    (fitted,) = run(wear_steps(BODY, target, SurfaceMap.identity(target), BODY.vertices, [WornItem(cloth)]))
    worn = TriangleMesh(fitted.positions, cloth.triangles)
    for places in (rough, rough[BODY.triangles].mean(axis=1), rough[BODY.edges].mean(axis=1)):
        heights = above(worn, places[places[:, 2] > -0.2])
        assert np.isfinite(heights).mean() > 0.9
        assert np.nanmax(heights) <= 0


@pytest.mark.parametrize("closed", [True, False])
def test_what_has_no_skin_below_it_any_more_is_told(closed):
    # A long body, and one that ends halfway, in a stump or in a hole.
    long = TriangleMesh(BODY.vertices * [0.3, 0.3, 1.0], BODY.triangles)
    ends = long.vertices * [1.0, 1.0, 0.2] if closed else long.vertices
    above = long.vertices[:, 2] > 0
    short = TriangleMesh(np.where(above[:, None], long.vertices, ends), long.triangles)
    if not closed:
        short = short.submesh(above)[0]
    boot = long.submesh(long.vertices[:, 2] < -0.3)[0]
    boot, shirt = (
        TriangleMesh(each.vertices + 0.02 * each.vertex_normals, each.triangles)
        for each in (boot, long.submesh(long.vertices[:, 2] > 0.3)[0])
    )
    places = ClosestPoints(short).nearest(long.vertices)
    there = SurfaceMap.from_barycentric(short, places.triangles, places.barycentric)
    hanging, worn = run(wear_steps(long, short, there, long.vertices, [WornItem(boot), WornItem(shirt)]))
    assert hanging.bare.mean() > 0.5
    assert not worn.bare.any()
    (kept,) = wear(long, long.vertices * [2.0, 1.5, 1.2], [WornItem(boot)])
    assert not kept.bare.any()


def test_a_margin_is_kept():
    (fitted,) = wear(BODY, BODY.vertices, [WornItem(SHIRT, margin=0.08)])
    assert fitted.clearance.min() > 0.07
    (before,) = wear(BODY, BODY.vertices, [WornItem(SHIRT)])
    assert before.clearance.min() < 0.06


def test_a_large_margin_is_no_lack_of_skin():
    shirt = cap(ball(9, 1.02), 0.0)
    (fitted,) = wear(BODY, BODY.vertices, [WornItem(shirt, margin=0.3)])
    assert np.median(fitted.clearance) > 0.28
    assert not fitted.bare.any()


def similarity_error(before, after):
    """How far points are from being a similar image of others, and how many times as large they are."""
    x, y = before - before.mean(axis=0), after - after.mean(axis=0)
    left, values, right = np.linalg.svd(y.T @ x)
    scale = values.sum() / np.square(x).sum()
    return np.abs(scale * x @ (left @ right).T - y).max(), scale


def test_buttons_stay_rigid_and_on_the_cloth():
    both = TriangleMesh.concatenated([SHIRT, BUTTON])
    count = SHIRT.vertex_count
    images = BODY.vertices * [1.6, 1.2, 1.0]
    (fitted,) = wear(BODY, images, [WornItem(both)])
    assert (fitted.pieces[:count] == -1).all()
    assert (fitted.pieces[count:] == 0).all()
    error, scale = similarity_error(BUTTON.vertices, fitted.positions[count:])
    assert error < 1e-6
    assert 1 < scale < 1.6
    cloth = ClosestPoints(TriangleMesh(fitted.positions[:count], SHIRT.triangles))
    gap = np.sqrt(cloth.nearest(fitted.positions[count:]).squared_distances)
    assert gap.max() < 0.15
    (soft,) = wear(BODY, images, [WornItem(both, find_rigid=False)])
    assert (soft.pieces == -1).all()


def by_a_map_that_slid_on_one_side(items, bump=0.0, *, remeshed=False):
    """Fit items from a ball to one of other proportions, whose map is turned by up to 0.2 where x is positive.

    With a bump it is one on that side alone; if it is remeshed, no vertex of it is the mirror image of another.
    """

    def taken(points):
        angle = 0.2 * np.clip(points[:, 0], 0, None)
        x, y, z = points.T
        turned = np.stack([x, y * np.cos(angle) - z * np.sin(angle), y * np.sin(angle) + z * np.cos(angle)], axis=1)
        out = bump * np.exp(-np.square(turned - [1.0, 0.0, 0.0]).sum(axis=1) / 0.5)
        return turned * [1.3, 0.9, 1.1] * (1 + out)[:, None]

    fine = ball(12)
    if remeshed:
        fine = TriangleMesh(fine.vertices @ TURN.T, fine.triangles)
    back = np.exp(-np.square(fine.vertices - [1.0, 0.0, 0.0]).sum(axis=1) / 0.5)
    target = TriangleMesh(fine.vertices * [1.3, 0.9, 1.1] * (1 + bump * back)[:, None], fine.triangles)
    images = taken(BODY.vertices)
    found = ClosestPoints(target).nearest(images)
    source_to_target = SurfaceMap.from_barycentric(target, found.triangles, found.barycentric)
    return run(wear_steps(BODY, target, source_to_target, images, items)), target


def mirrored_away(item, fitted):
    """How far each vertex is from where its partner's mirror image in the plane x = 0 is."""
    partners = cKDTree(item.vertices).query(item.vertices * [-1, 1, 1])[1]
    return np.linalg.norm(fitted[partners] * [-1, 1, 1] - fitted, axis=1)


@pytest.mark.parametrize("remeshed", [False, True])
def test_symmetric_items_stay_symmetric_on_a_symmetric_body(remeshed):
    pocket = ball(1, 0.04, (0.7, -0.85, 0.0))
    (shirt, with_pocket), _ = by_a_map_that_slid_on_one_side(
        [WornItem(SHIRT), WornItem(TriangleMesh.concatenated([COAT, pocket]))], remeshed=remeshed
    )
    assert mirrored_away(SHIRT, shirt.positions).max() < 0.01
    coat = with_pocket.positions[: COAT.vertex_count]
    assert mirrored_away(COAT, coat).max() < 0.01
    assert min(shirt.clearance.min(), with_pocket.clearance.min()) > 0
    # The pocket is as far from the coat as it was.
    gaps = [
        np.linalg.norm(
            ClosestPoints(TriangleMesh(cloth, COAT.triangles)).nearest(worn.mean(axis=0)[None]).squared_distances
        )
        for cloth, worn in ((COAT.vertices, pocket.vertices), (coat, with_pocket.positions[COAT.vertex_count :]))
    ]
    assert np.sqrt(gaps[1]) == pytest.approx(np.sqrt(gaps[0]), abs=0.02)


def test_two_items_that_are_mirror_images_are_so_afterwards_and_as_large():
    form = ball(2, 0.1)
    shape = form.vertices * [1.0, 0.6, 0.3] + 0.5 * form.vertices[:, [1, 2, 0]]
    right = TriangleMesh(shape + np.array([0.8, 0.2, 0.7]), form.triangles)
    left = TriangleMesh(right.vertices * [-1, 1, 1], form.triangles[:, ::-1])
    fitted, _ = by_a_map_that_slid_on_one_side([WornItem(each, fit="RIGID") for each in (right, left)])
    positions = np.concatenate([each.positions for each in fitted])
    assert mirrored_away(TriangleMesh.concatenated([right, left]), positions).max() < 0.01
    shape = shape - shape.mean(axis=0)
    found = fitted[0].positions - fitted[0].positions.mean(axis=0)
    size = np.linalg.norm(found) / np.linalg.norm(shape)
    np.testing.assert_allclose(found @ found.T, size**2 * shape @ shape.T, atol=1e-6)


def lump():
    """A body that is not symmetric in any plane, nearly a ball at its equator."""
    form = ball(14)
    bumps = [([0.3, 0.5, 0.8], 0.5), ([-0.6, 0.2, 0.8], 0.3), ([0.4, -0.3, -0.9], 0.4), ([-0.3, 0.6, -0.7], 0.6)]
    grown = 1 + sum(high * np.exp(-np.square(form.vertices - place).sum(axis=1) / 0.2) for place, high in bumps)
    return TriangleMesh(form.vertices * grown[:, None], form.triangles)


LUMP = lump()


def by_a_map_that_slides_up_and_down(items):
    """Fit items from a lump to itself by a map that is right but for waves along its equator."""
    x, y, z = LUMP.vertices.T
    slid = LUMP.vertices + np.outer(0.1 * np.cos(7 * np.arctan2(y, x)) * np.exp(-8 * z**2), [0.0, 0.0, 1.0])
    found = ClosestPoints(LUMP).nearest(slid)
    source_to_target = SurfaceMap.from_barycentric(LUMP, found.triangles, found.barycentric)
    images = source_to_target.positions
    return run(wear_steps(LUMP, LUMP, source_to_target, images, [WornItem(item) for item in items]))


def test_what_stands_for_skin_follows_the_map_less_than_what_lies_on_it():
    belt = LUMP.submesh(np.abs(LUMP.vertices[:, 2]) < 0.3)[0]
    on_skin = TriangleMesh(belt.vertices + 0.01 * belt.vertex_normals, belt.triangles)
    waves = [
        np.abs(each.positions[:, 2] - item.vertices[:, 2]).max()
        for item in (belt, on_skin)
        for each in by_a_map_that_slides_up_and_down([item])
    ]
    assert waves[1] > 0.06
    assert waves[0] < 0.75 * waves[1]


def test_parts_that_a_body_was_cut_into_stay_together():
    upper, lower = (LUMP.submesh(side)[0] for side in (LUMP.vertices[:, 2] > -0.1, LUMP.vertices[:, 2] < 0.1))
    gaps, partners = cKDTree(lower.vertices).query(upper.vertices)
    both = np.flatnonzero(gaps == 0)
    one, other = by_a_map_that_slides_up_and_down([upper, lower])
    apart = np.linalg.norm(one.positions[both] - other.positions[partners[both]], axis=1)
    assert len(both) > 20
    assert apart.max() < 0.004


def test_parts_that_a_body_was_cut_into_are_pushed_together():
    upper, lower = (BODY.submesh(side)[0] for side in (BODY.vertices[:, 2] > -0.1, BODY.vertices[:, 2] < 0.1))
    x, _, z = BODY.vertices.T
    ridge = 0.05 * np.exp(-np.square(z - 0.12 * x) / 0.02)
    target = TriangleMesh(BODY.vertices * (1 + ridge)[:, None], BODY.triangles)
    steps = wear_steps(BODY, target, SurfaceMap.identity(target), BODY.vertices, [WornItem(upper), WornItem(lower)])
    one, other = run(steps)
    gaps, partners = cKDTree(lower.vertices).query(upper.vertices)
    both = np.flatnonzero(gaps == 0)
    assert len(both) > 20
    assert one.pushed[both].max() > 0.03
    np.testing.assert_allclose(one.positions[both], other.positions[partners[both]], atol=1e-5)


def test_items_follow_what_a_body_has_on_one_side_alone():
    (shirt,), _ = by_a_map_that_slid_on_one_side([WornItem(SHIRT)], bump=0.4)
    assert mirrored_away(SHIRT, shirt.positions).max() > 0.2


def test_what_is_named_rigid_is():
    images = BODY.vertices * [1.6, 1.2, 1.0]
    named = SHIRT.vertices[:, 0] > 0.7
    part, whole = wear(BODY, images, [WornItem(SHIRT, rigid=named), WornItem(SHIRT, fit="RIGID")])
    assert similarity_error(SHIRT.vertices[named], part.positions[named])[0] < 1e-6
    assert similarity_error(SHIRT.vertices[~named], part.positions[~named])[0] > 0.05
    assert similarity_error(SHIRT.vertices, whole.positions)[0] < 1e-6


def test_what_is_named_rigid_and_does_not_fit_is_said_to_show_what_is_below():
    images = BODY.vertices * [1.6, 1.2, 1.0]
    shirt, button = wear(BODY, images, [WornItem(SHIRT, fit="RIGID"), WornItem(BUTTON)])
    assert shirt.through > 0.1
    assert (shirt.clearance < -0.01).mean() == pytest.approx(shirt.through, abs=0.05)
    assert button.through == 0


def test_a_tight_item_follows_more_closely_than_a_loose_one():
    waves = 1 + 0.06 * np.sin(9 * BODY.vertices[:, 2])
    images = BODY.vertices * waves[:, None]
    tight, loose = wear(BODY, images, [WornItem(SHIRT, fit="TIGHT"), WornItem(SHIRT, fit="LOOSE")])
    assert tight.clearance.std() < loose.clearance.std()
    painted = np.where(SHIRT.vertices[:, 0] > 0, 1.0, -1.0)
    (mixed,) = wear(BODY, images, [WornItem(SHIRT, tightness=painted)])
    right, left = SHIRT.vertices[:, 0] > 0.2, SHIRT.vertices[:, 0] < -0.2
    assert mixed.clearance[right].std() < mixed.clearance[left].std()


def test_a_hole_in_the_body_does_no_harm():
    source = BODY.submesh(BODY.vertices[:, 2] < 0.9)[0]
    images = source.vertices * [1.3, 1.3, 1.0]
    (fitted,) = wear(source, images, [WornItem(SHIRT)])
    assert np.isfinite(fitted.positions).all()
    assert fitted.pushed.max() < 0.05
    assert np.abs(fitted.positions - SHIRT.vertices * [1.3, 1.3, 1.0]).max() < 0.08


def test_meshes_that_do_not_belong_together_are_refused():
    with pytest.raises(MeshError, match="Match them again"):
        run(wear_steps(BODY, BODY, SurfaceMap.identity(BODY), BODY.vertices[:-1], [WornItem(SHIRT)]))


def test_nothing_is_worn_across_a_map_to_the_mirror_image():
    other = reflected_mesh(BODY)
    led = reflected_map(other, SurfaceMap.identity(BODY))
    with pytest.raises(MatchError, match="exchanges left and right"):
        run(wear_steps(BODY, other, led, led.positions, [WornItem(SHIRT)]))


def test_folds_that_one_body_has_alone_do_not_shrink_a_rigid_piece():
    """As where eye sockets and a mouth are closed on the other body: skin goes together, the head is as large."""
    glasses = ball(2, 0.06, (0.0, -1.1, 0.0))
    front = np.linalg.norm(BODY.vertices - [0.0, -1.0, 0.0], axis=1)
    pocket = front < 0.25
    inwards = BODY.vertices * (1 - 0.6 * np.where(pocket, 1 - front / 0.25, 0.0))[:, None]
    source = TriangleMesh(inwards, BODY.triangles)
    (fitted,) = run(wear_steps(source, BODY, SurfaceMap.identity(BODY), BODY.vertices, [WornItem(glasses)]))
    assert (fitted.pieces == 0).all()
    error = abs(similarity_error(glasses.vertices, fitted.positions)[1] - 1)
    assert error < 0.04
    assert error < 0.5 * abs(fitted.scales.mean() - 1)


def test_an_item_that_is_cut_open_at_every_edge_is_fitted_as_a_whole():
    loose = TriangleMesh(SHIRT.vertices[SHIRT.triangles.ravel()], np.arange(3 * SHIRT.triangle_count).reshape(-1, 3))
    images = BODY.vertices * [1.5, 1.2, 1.0]
    tight = np.where(SHIRT.vertices[:, 0] > 0, 1.0, 0.0)
    left = SHIRT.vertices[:, 1] > 0.5
    (whole,) = wear(BODY, images, [WornItem(SHIRT, tightness=tight, left=left)])
    corners = SHIRT.triangles.ravel()
    (opened,) = wear(BODY, images, [WornItem(loose, tightness=tight[corners], left=left[corners])])
    for name in ("positions", "rotations", "clearance", "pieces"):
        np.testing.assert_allclose(getattr(opened, name), getattr(whole, name)[corners], atol=1e-6)
    assert opened.places.shape == (len(corners), BODY.vertex_count)
    assert opened.through == whole.through


def test_a_body_that_is_cut_open_at_every_edge_is_dressed_as_a_whole():
    """Files for games are made so; inside and outside are known all the same, and what pokes through is seen."""
    images = BODY.vertices.copy()
    bump = np.exp(-np.square(BODY.vertices - [0.0, -0.6, 0.8]).sum(axis=1) / 0.02)
    grown = images * (1 + 0.15 * bump)[:, None]
    corners = BODY.triangles.ravel()
    cut = np.arange(len(corners)).reshape(-1, 3)
    fitted = []
    for kept, triangles in ((slice(None), BODY.triangles), (corners, cut)):
        body, target = TriangleMesh(BODY.vertices[kept], triangles), TriangleMesh(grown[kept], triangles)
        fitted += run(wear_steps(body, target, SurfaceMap.identity(target), images[kept], [WornItem(SHIRT)]))
    whole, opened = fitted
    assert whole.pushed.max() > 0.05
    assert opened.clearance.min() >= 0
    np.testing.assert_allclose(opened.positions, whole.positions, atol=0.02)


def solid(low, high, radius):
    """A closed cylinder of many triangles."""
    vertices, triangles = icosphere(10)
    height = vertices[:, 2]
    side = np.linalg.norm(vertices[:, :2], axis=1)
    # The rounder thirds of a sphere become the flat ends.
    flat = np.abs(height) > 0.7
    rim = np.sqrt(1 - 0.7**2)
    wide = np.where(flat, side / rim, 1.0) * radius / np.maximum(side, 1e-9)
    points = np.column_stack([vertices[:, :2] * wide[:, None], height.clip(-0.7, 0.7) / 1.4 + 0.5])
    return TriangleMesh(points * [1, 1, high - low] + [0, 0, low], triangles)


@pytest.mark.parametrize("trousers_first", [False, True])
def test_ends_of_clothes_that_are_the_body_stay_within_it(trousers_first):
    """A character of a closed jacket and closed trousers that go up into it becomes a narrower body of one piece."""
    jacket, trousers = solid(0.0, 2.0, 0.5), solid(-2.0, 0.2, 0.45)
    first = jacket.vertex_count
    body = TriangleMesh(
        np.concatenate([jacket.vertices, trousers.vertices]),
        np.concatenate([jacket.triangles, trousers.triangles + first]),
    )
    target = solid(-2.0, 2.0, 0.4)
    images = body.vertices * [0.78, 0.78, 1.0]
    images[first:] *= [1.1, 1.1, 1.0]
    places = ClosestPoints(target).nearest(images)
    there = SurfaceMap.from_barycentric(target, places.triangles, places.barycentric)
    items = [jacket, trousers]
    order = [1, 0] if trousers_first else [0, 1]
    made = run(wear_steps(body, target, there, images, [WornItem(items[number]) for number in order]))
    fitted = [made[order.index(number)] for number in range(2)]
    for item, one, end in zip(items, fitted, (0.0, 0.2), strict=True):
        inner = (np.abs(item.vertices[:, 2] - end) < 1e-6) & (np.linalg.norm(item.vertices[:, :2], axis=1) < 0.3)
        assert inner.any()
        np.testing.assert_allclose(one.positions[inner, 2], end, atol=0.1)
        around = np.linalg.norm(one.positions[:, :2], axis=1)
        assert around.max() < 0.46  # it was pushed out over the other by more than that
        outer = (np.linalg.norm(item.vertices[:, :2], axis=1) > 0.44) & (np.abs(np.abs(item.vertices[:, 2]) - 1) < 0.7)
        assert around[outer].min() > 0.39
    # Whatever comes first, the jacket is over the trousers.
    over = (jacket.vertices[:, 2] > 0.02) & (jacket.vertices[:, 2] < 0.2)
    assert over.any()
    under = ClosestPoints(TriangleMesh(fitted[1].positions, trousers.triangles))
    found = under.nearest(fitted[0].positions[over])
    corners = trousers.triangles[found.triangles]
    feet = np.einsum("kc,kci->ki", found.barycentric, fitted[1].positions[corners])
    assert (np.linalg.norm(fitted[0].positions[over, :2], axis=1) >= np.linalg.norm(feet[:, :2], axis=1) - 1e-3).all()


def test_trousers_that_come_out_of_a_closed_jacket_are_not_pushed_over_it():
    skin = ball(9).vertices * [0.3, 0.3, 2.2]
    body = TriangleMesh(skin, ball(9).triangles)
    jacket, trousers = solid(0.0, 2.0, 0.5), solid(-2.0, 0.0, 0.45)
    # The trousers come up a little.
    item = TriangleMesh(trousers.vertices + np.array([0, 0, -0.02]), trousers.triangles)
    images = body.vertices.copy()
    low = body.vertices[:, 2] < -0.2
    images[low] += [0.0, 0.0, 0.15]
    fitted = run(wear_steps(body, body, SurfaceMap.identity(body), images, [WornItem(jacket), WornItem(item)]))
    around = np.linalg.norm(fitted[1].positions[:, :2], axis=1)
    assert around.max() < 0.49


def prism(low, high, radius, sides=12, *, rings=6, middle=True):
    """A closed cylinder whose ends are fans of large triangles, around their middles or a corner."""
    angles = 2 * np.pi * np.arange(sides) / sides
    around = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    walls = [np.column_stack([around, np.full(sides, z)]) for z in np.linspace(low, high, rings)]
    ends = np.array([[0.0, 0.0, low], [0.0, 0.0, high]])
    corners, following = np.arange(sides), (np.arange(sides) + 1) % sides
    triangles = []
    for ring in range(rings - 1):
        a, b = ring * sides + corners, ring * sides + following
        triangles += [np.stack([a, b, b + sides], axis=1), np.stack([a, b + sides, a + sides], axis=1)]
    last, centre = (rings - 1) * sides, rings * sides
    if not middle:
        fan = np.stack([np.zeros(sides - 2, int), corners[1:-1], corners[2:]], axis=1)
        return TriangleMesh(np.concatenate(walls), np.concatenate([*triangles, fan[:, ::-1], last + fan]))
    triangles.append(np.stack([following, corners, np.full(sides, centre)], axis=1))
    triangles.append(np.stack([last + corners, last + following, np.full(sides, centre + 1)], axis=1))
    return TriangleMesh(np.concatenate([*walls, ends]), np.concatenate(triangles))


@pytest.mark.parametrize("middle", [True, False])
def test_a_hem_is_not_pushed_away_by_the_large_triangles_that_close_it(middle):
    jacket, trousers = prism(0.0, 2.0, 0.5, middle=middle), prism(-2.0, 0.0, 0.5, middle=middle)
    body = TriangleMesh(
        np.concatenate([jacket.vertices, trousers.vertices]),
        np.concatenate([jacket.triangles, trousers.triangles + jacket.vertex_count]),
    )
    target = solid(-2.0, 2.0, 0.5)
    images = body.vertices * [0.95, 0.95, 1.0]
    places = ClosestPoints(target).nearest(images)
    there = SurfaceMap.from_barycentric(target, places.triangles, places.barycentric)
    for item, one in zip(
        (jacket, trousers),
        run(wear_steps(body, target, there, images, [WornItem(jacket), WornItem(trousers)])),
        strict=True,
    ):
        hem = (np.abs(item.vertices[:, 2]) < 0.1) & (np.linalg.norm(item.vertices[:, :2], axis=1) > 0.4)
        around = np.linalg.norm(one.positions[hem, :2], axis=1)
        assert around.min() > 0.49
        assert around.max() < 0.53, around.max()
