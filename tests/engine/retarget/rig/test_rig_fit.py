# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import ClosestPoints, KnownShapes, MatchError, RigError, Shape, Skeleton, SurfaceMap, TriangleMesh, fit_rig
from engine.mesh.reflection import reflected_map, reflected_mesh
from engine.retarget.rig.bone_fit import skinned
from engine.runtime.progress import run
from engine.shapes.enclosing_surface import with_limbs_steps
from tests.engine.retarget.rig.test_bone_fit import pose
from tests.limbs import modular_creature
from tests.shapes import creature, permuted
from tests.skeletons import CONTROLS, creature_bones, creature_weights


class Pair:
    """The creature at rest, another meshing of it in a pose, and the true maps between them."""

    def __init__(self, resolution=9, other=11, angle=0.35, scale=1.0):
        self.names, parents, heads, tails = creature_bones()
        vertices, triangles, _ = creature(0.0, resolution)
        self.source, self.skeleton = TriangleMesh(vertices, triangles), Skeleton(parents, heads, tails)
        self.weights = creature_weights(vertices)
        rest, faces, _ = creature(0.0, other)
        rest, faces, _ = permuted(rest, faces)
        self.linear, self.translations = pose(self.skeleton, angle=angle, scale=scale, seed=5)
        self.true_weights = creature_weights(rest)
        posed = skinned(rest, self.true_weights, self.linear, self.translations)
        self.rest, self.target = TriangleMesh(rest, faces), TriangleMesh(posed, faces)
        self.maps = self.between(self.source.vertices, rest)

    def between(self, from_source, from_target):
        """Maps from points of both bodies at rest to the other mesh."""
        there, back = ClosestPoints(self.rest).nearest(from_source), ClosestPoints(self.source).nearest(from_target)
        return (
            SurfaceMap.from_barycentric(self.target, there.triangles, there.barycentric),
            SurfaceMap.from_barycentric(self.source, back.triangles, back.barycentric),
        )

    def fitted(self, maps, **options):
        return fit_rig(self.source, self.target, *maps, weights=self.weights, skeleton=self.skeleton, **options)

    def errors(self, maps):
        """Distance of where target_to_source leads from the truth, at rest."""
        return np.linalg.norm(maps[1].positions - self.maps[1].positions, axis=1)

    def true_heads(self):
        heads = np.einsum("bij,bj->bi", self.linear, self.skeleton.heads) + self.translations
        return heads[[name not in CONTROLS for name in self.names]]

    def heads(self, rig):
        return rig.heads[[name not in CONTROLS for name in self.names]]


@pytest.fixture(scope="module")
def pair():
    return Pair()


class PairInPieces(Pair):
    """The same with the source, or the target, put together from a trunk, head, legs and tail."""

    def __init__(self, source, target):
        self.names, parents, heads, tails = creature_bones()
        self.source, self.skeleton = source.mesh, Skeleton(parents, heads, tails)
        self.weights = creature_weights(source.rest)
        self.linear, self.translations = pose(self.skeleton, angle=0.35, seed=5)
        posed = skinned(target.mesh.vertices, creature_weights(target.rest), self.linear, self.translations)
        self.rest, self.target = target.mesh, TriangleMesh(posed, target.mesh.triangles)
        self.maps = self.between(source.rest, target.rest)


def slid_along(pair, by=0.06):
    """Maps that have slid along the body, as those of a matcher do on smooth limbs."""

    def moved(points):
        shift = np.stack([np.sin(3 * points[:, 2]), np.sin(4 * points[:, 0]), np.cos(3 * points[:, 0])], axis=1)
        return points + by * shift

    return pair.between(moved(pair.source.vertices), moved(pair.rest.vertices))


def test_from_the_true_maps_come_the_true_joints(pair):
    rig = pair.fitted(pair.maps, refine=False)
    assert np.linalg.norm(pair.heads(rig) - pair.true_heads(), axis=1).max() < 0.02
    assert rig.target_to_source is pair.maps[1]
    assert rig.source_to_target is pair.maps[0]
    on_target = ClosestPoints(pair.target).nearest(rig.posed).squared_distances
    assert np.sqrt(on_target).mean() < 0.02


@pytest.mark.parametrize("scale", [1.0, 25.0])
def test_maps_that_slid_become_better(scale):
    pair = Pair(scale=scale)
    maps = slid_along(pair)
    before = pair.errors(maps).mean()
    rig = pair.fitted(maps)
    assert pair.errors((rig.source_to_target, rig.target_to_source)).mean() < before / 2
    assert np.linalg.norm(pair.heads(rig) - pair.true_heads(), axis=1).mean() < 0.03 * scale
    assert rig.target_to_source.flipped_faces(pair.target, pair.source) < 0.01
    assert ((rig.target_to_source.confidence >= 0) & (rig.target_to_source.confidence <= 1)).all()


def test_better_maps_are_trusted_as_before_and_parts_beside_the_body_stay(pair):
    def beside(mesh):
        """A mesh with a small cube in front of it."""
        cube = 0.03 * np.array(list(np.ndindex(2, 2, 2))) + [2.2, 0.0, 0.4]
        sides = np.array([[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5], [2, 3, 7], [2, 7, 6]])
        rest = np.array([[0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
        faces = np.concatenate([sides, rest]) + mesh.vertex_count
        return TriangleMesh(np.concatenate([mesh.vertices, cube]), np.concatenate([mesh.triangles, faces]))

    bodies = beside(pair.source), beside(pair.target)
    maps = []
    for found, other in zip(slid_along(pair), reversed(bodies), strict=True):
        triangles = np.append(found.triangles, np.full(8, other.triangle_count - 1))
        barycentric = np.concatenate([found.barycentric, np.full((8, 3), 1 / 3)])
        confidence, partner = np.full(len(triangles), 0.3), np.arange(len(triangles)) % 50 > 0
        maps.append(SurfaceMap.from_barycentric(other, triangles, barycentric, confidence, partner))
    weights = csr_array(np.concatenate([pair.weights.toarray(), np.eye(len(pair.names))[[0] * 8]]))
    rig = fit_rig(*bodies, *maps, weights=weights, skeleton=pair.skeleton)
    for before, after in zip(maps, (rig.source_to_target, rig.target_to_source), strict=True):
        np.testing.assert_array_equal(after.confidence, before.confidence)
        np.testing.assert_array_equal(after.has_partner, before.has_partner)
        np.testing.assert_allclose(after.positions[-8:], before.positions[-8:])
        assert not np.allclose(after.positions[:-8], before.positions[:-8])


@pytest.mark.parametrize("in_pieces", [(True, False), (False, True), (True, True)])
def test_limbs_that_are_pieces_of_their_own_are_fitted_as_well(in_pieces):
    uncut = (9.0, 9.0, 9.0)
    cuts = [(0.45, 0.5, 0.8) if cut else uncut for cut in in_pieces]
    pair = PairInPieces(modular_creature(0.0, cuts=cuts[0]), modular_creature(0.0, 0.7, cuts=cuts[1]))
    maps = slid_along(pair, 0.03)
    before = pair.errors(maps).mean()
    rig = pair.fitted(maps)
    assert np.linalg.norm(pair.heads(rig) - pair.true_heads(), axis=1).max() < 0.03
    assert pair.errors((rig.source_to_target, rig.target_to_source)).mean() < before / 2
    images = pair.maps[0].positions
    assert np.linalg.norm(rig.registered - images, axis=1).mean() < 0.02
    assert np.linalg.norm(rig.posed - images, axis=1).mean() < 0.02


def test_what_a_match_prepared_is_taken_over_and_the_result_is_the_same(monkeypatch):
    cut = modular_creature(0.0, cuts=(0.45, 0.5, 0.8))
    pair = PairInPieces(cut, modular_creature(0.0, 0.7, cuts=(0.45, 0.5, 0.8)))
    maps, known = slid_along(pair, 0.03), KnownShapes()
    for mesh, name in ((pair.source, "source"), (pair.target, "target")):
        shape = Shape(mesh, name)
        run(with_limbs_steps(shape, name, np.arange(mesh.vertex_count)))
        known.keep(mesh, name, None, shape)
    anew = pair.fitted(maps)
    monkeypatch.setattr("engine.retarget.rig.rig_fit.clean", None)  # nothing is to be cleaned
    taken_over = pair.fitted(maps, known=known)
    assert np.array_equal(anew.heads, taken_over.heads)
    assert np.array_equal(anew.target_to_source.positions, taken_over.target_to_source.positions)


def test_it_is_the_same_each_time(pair):
    maps = slid_along(pair)
    first, second = pair.fitted(maps), pair.fitted(maps)
    np.testing.assert_array_equal(first.registered, second.registered)
    np.testing.assert_array_equal(first.target_to_source.barycentric, second.target_to_source.barycentric)


def test_a_rig_that_explains_nothing_leaves_the_maps(pair):
    """One bone for all cannot bend: the body would have to lie beside the target."""
    one = Skeleton(np.array([-1]), np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))
    weights = csr_array(np.ones((pair.source.vertex_count, 1)))
    bent = Pair(angle=1.3)
    rig = fit_rig(bent.source, bent.target, *bent.maps, weights=weights, skeleton=one)
    after = bent.errors((rig.source_to_target, rig.target_to_source)).mean()
    assert after < 0.05


def test_loose_parts_move_with_their_bones(pair):
    count = pair.source.vertex_count
    ball = pair.source.vertices[:4] * 0.05 + [1.5, 0, 0.38]
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]) + count
    source = TriangleMesh(np.concatenate([pair.source.vertices, ball]), np.concatenate([pair.source.triangles, faces]))
    head = pair.names.index("head")
    weights = np.concatenate([pair.weights.toarray(), np.eye(len(pair.names))[[head] * 4]])
    there = SurfaceMap.from_barycentric(
        pair.target,
        np.append(pair.maps[0].triangles, [0] * 4),
        np.concatenate([pair.maps[0].barycentric, np.full((4, 3), 1 / 3)]),
    )
    back = SurfaceMap.from_barycentric(source, pair.maps[1].triangles, pair.maps[1].barycentric)
    rig = fit_rig(source, pair.target, there, back, weights=csr_array(weights), skeleton=pair.skeleton, refine=False)
    expected = ball @ rig.linear[head].T + rig.translations[head]
    np.testing.assert_allclose(rig.registered[count:], expected, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda weights: weights[:-1], "need weights of the shape"),
        (lambda weights: -weights, "not negative"),
        (lambda weights: 0 * weights, "No bone moves"),
    ],
)
def test_weights_that_are_none_are_refused(pair, change, message):
    weights = csr_array(change(pair.weights.toarray()))
    with pytest.raises(RigError, match=message):
        fit_rig(pair.source, pair.target, *pair.maps, weights=weights, skeleton=pair.skeleton)


def test_maps_of_other_meshes_are_refused(pair):
    few = SurfaceMap.identity(TriangleMesh(np.eye(3), [[0, 1, 2]]))
    for maps in ((few, pair.maps[1]), (pair.maps[0], few)):
        with pytest.raises(MatchError, match="one of 3 vertices"):
            fit_rig(pair.source, pair.target, *maps, weights=csr_array(pair.weights), skeleton=pair.skeleton)


def test_across_a_map_to_the_mirror_image_all_is_mirrored(pair):
    """The target seen in a mirror, and the same map: the rig that comes of it is the other one, seen in the mirror."""
    maps, flip = slid_along(pair), np.diag([-1.0, 1.0, 1.0])
    direct = pair.fitted(maps)
    target = reflected_mesh(pair.target)
    seen = reflected_map(target, maps[0]), maps[1]
    rig = fit_rig(pair.source, target, *seen, weights=pair.weights, skeleton=pair.skeleton)
    assert (rig.handedness, direct.handedness) == (-1, 1)
    np.testing.assert_allclose(rig.heads, direct.heads @ flip, atol=1e-6)
    np.testing.assert_allclose(rig.rotations, flip @ direct.rotations, atol=1e-6)
    np.testing.assert_allclose(rig.posed, direct.posed @ flip, atol=1e-6)
    np.testing.assert_allclose(rig.registered, direct.registered @ flip, atol=1e-6)
    np.testing.assert_allclose(rig.source_to_target.positions, direct.source_to_target.positions @ flip, atol=1e-6)
    np.testing.assert_allclose(rig.target_to_source.positions, direct.target_to_source.positions, atol=1e-6)
