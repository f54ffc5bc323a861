# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranking of bodies of several species, posed and meshed differently, against a query."""

import numpy as np
import pytest

from engine.matching.retrieval import RetrievalSettings, retrieve, retrieve_steps
from engine.mesh.triangle_mesh import TriangleMesh
from engine.runtime.errors import MatchError, SettingsError
from engine.runtime.progress import run
from engine.shapes.shape import Shape
from tests.bodies import relative_of_creature
from tests.shapes import icosphere, permuted, rotation, torus

SPECIES = {"short": {"legs": 0.5, "tail": 0.5}, "plain": {}, "long": {"legs": 1.5, "tail": 2.0}}
POSES = ((0.0, 11, 0.0), (0.7, 12, 0.5), (1.0, 11, 1.1))  # how far bent, meshing


@pytest.fixture(scope="module")
def shapes():
    """Three poses and meshings of three species, a torus and a ball: names and shapes."""
    bodies = [
        (name, TriangleMesh(*relative_of_creature(**species, pose=pose, resolution=resolution, turn=turn)))
        for pose, resolution, turn in POSES
        for name, species in SPECIES.items()
    ]
    bodies += [("torus", TriangleMesh(*torus())), ("ball", TriangleMesh(*icosphere(8)))]
    return [name for name, _ in bodies], [Shape(mesh) for _, mesh in bodies]


def without(things, i):
    return things[:i] + things[i + 1 :]


def test_the_same_species_in_other_poses_comes_first(shapes):
    names, bodies = shapes
    for i in range(9):
        found = retrieve(bodies[i], without(bodies, i))
        ranked = [without(names, i)[j] for j in found.order]
        assert ranked[:2] == [names[i]] * 2
        assert set(ranked[-2:]) == {"torus", "ball"}


def test_what_was_not_matched_is_ranked_by_its_bound_behind_what_was(shapes):
    names, bodies = shapes
    found = retrieve(bodies[0], bodies[1:], RetrievalSettings(matched=3))
    assert sorted(found.order.tolist()) == list(range(len(names) - 1))
    assert len(found.matches) == 3
    by_bound_only = np.isnan(found.scores)
    assert by_bound_only.sum() == len(names) - 4
    first, last = found.order[:3], found.order[3:]
    assert not by_bound_only[first].any()
    assert by_bound_only[last].all()
    assert (np.diff(found.scores[first]) >= 0).all()
    assert (np.diff(found.bounds[last]) >= 0).all()
    assert found.bounds[first].max() <= found.bounds[last].min()
    assert [match.shape for match in found.matches] == first.tolist()
    assert [match.score for match in found.matches] == found.scores[first].tolist()


def test_scores_are_the_distortion_of_the_matches(shapes):
    bodies = shapes[1]
    found = retrieve(bodies[0], [bodies[3]])
    match = found.matches[0]
    between = []
    for shape, points in ((bodies[0], match.source_points), (bodies[3], match.target_points)):
        vertices = points.nearest_vertices
        rows = np.concatenate([block for _, block in shape.solver.distances_in_blocks(vertices)])[:, vertices]
        between.append((rows + rows.T) / 2 / shape.scale)
    k = len(match.source_points)
    assert k == RetrievalSettings().points
    difference = (between[0] - between[1])[~np.eye(k, dtype=bool)]
    assert match.score == pytest.approx(np.sqrt(np.square(difference).mean()), rel=1e-3)


def test_the_order_of_the_list_does_not_matter(shapes):
    bodies = shapes[1]
    shuffle = np.random.default_rng(3).permutation(len(bodies) - 1)
    found = retrieve(bodies[0], bodies[1:])
    other = retrieve(bodies[0], [bodies[1:][i] for i in shuffle])
    np.testing.assert_array_equal(shuffle[other.order], found.order)
    np.testing.assert_array_equal(other.scores, found.scores[shuffle])
    np.testing.assert_array_equal(other.bounds, found.bounds[shuffle])


def test_meshes_and_shapes_with_more_samples_give_the_same(shapes):
    bodies = shapes[1]
    fresh = [TriangleMesh(s.mesh.vertices, s.mesh.triangles) for s in bodies[:4]]
    found = retrieve(fresh[0], fresh[1:])
    run(bodies[2].sample_steps(300))
    other = retrieve(bodies[0], bodies[1:4])
    np.testing.assert_array_equal(found.order, other.order)
    np.testing.assert_allclose(found.bounds, other.bounds, rtol=1e-6)
    assert found.scores[0] == other.scores[0]


def test_position_size_and_vertex_order_do_not_matter(shapes):
    bodies = shapes[1]
    mesh = bodies[4].mesh
    turned = 0.0254 * mesh.vertices @ rotation([1, 1, 0.3], 2.0).T - [4, 5, 6]
    vertices, triangles, _ = permuted(turned, mesh.triangles, seed=2)
    found = retrieve(bodies[0], [bodies[4]])
    other = retrieve(bodies[0], [TriangleMesh(vertices, triangles)])
    assert other.bounds[0] == pytest.approx(found.bounds[0], rel=1e-5)
    assert other.scores[0] == pytest.approx(found.scores[0], rel=1e-5)


def test_a_shape_is_at_distance_zero_from_itself_and_the_bound_is_symmetric(shapes):
    bodies = shapes[1]
    found = retrieve(bodies[5], bodies)
    assert found.order[0] == 5
    assert found.bounds[5] == pytest.approx(0, abs=1e-6)
    assert found.scores[5] == pytest.approx(0, abs=1e-9)
    back = retrieve(bodies[1], [bodies[5]])
    assert back.bounds[0] == pytest.approx(found.bounds[1])


def test_the_bound_holds_for_a_correspondence_that_keeps_areas():
    """Two poses of one mesh: the identity of the vertices is such a correspondence, up to some stretching."""
    first, second = (Shape(TriangleMesh(*relative_of_creature(pose=pose, resolution=11))) for pose in (0.0, 1.0))
    # Many samples, because the bound of few contains how differently they fall.
    settings = RetrievalSettings(signature_samples=400, matched=1)
    found = retrieve(first, [second], settings)
    weights = first.mesh.vertex_areas / first.mesh.area
    everywhere = np.arange(first.mesh.vertex_count)
    rows = [
        np.concatenate([block for _, block in shape.solver.distances_in_blocks(everywhere)]) / shape.scale
        for shape in (first, second)
    ]
    assert found.bounds[0] < np.sqrt(weights @ np.square(rows[0] - rows[1]) @ weights)


def test_progress_rises_and_the_work_can_be_dropped(shapes):
    bodies = shapes[1]
    meshes = [TriangleMesh(s.mesh.vertices, s.mesh.triangles) for s in bodies[:3]]
    fractions = [progress.fraction for progress in retrieve_steps(meshes[0], meshes[1:])]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
    dropped = retrieve_steps(meshes[0], meshes[1:])
    next(dropped)
    dropped.close()
    with pytest.raises(StopIteration):
        next(dropped)


def test_an_empty_list_and_small_meshes_are_refused_in_words(shapes):
    body = shapes[1][0]
    small = TriangleMesh(*icosphere(1))
    with pytest.raises(MatchError, match="no shapes to compare with"):
        retrieve(body, [])
    with pytest.raises(MatchError, match="the shape 2 of the list has only 12 vertices"):
        retrieve(body, [body, small])
    with pytest.raises(MatchError, match="query has only 12 vertices"):
        retrieve(small, [body])


def test_settings_are_checked():
    with pytest.raises(SettingsError, match="Matched Shapes is 0"):
        RetrievalSettings(matched=0)
    with pytest.raises(SettingsError, match="at least as many Samples"):
        RetrievalSettings(points=50, samples=40)
    assert RetrievalSettings(points=5).match.coarse_points == 5
