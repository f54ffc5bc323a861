# SPDX-License-Identifier: GPL-3.0-or-later
"""Geodesic distances: exact answers on shapes that unroll, invariances, and meshes in a mess."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import HierMatchError, MeshError, TriangleMesh
from engine.geometry.geodesics import GeodesicSolver
from tests.shapes import (
    cone,
    creature,
    cylinder,
    icosphere,
    irregular,
    permuted,
    plane,
    plane_with_hole,
    plane_with_slit,
    rotation,
    subdivided,
    torus,
)

MEAN_GOAL_REGULAR, MEAN_GOAL_IRREGULAR = 0.005, 0.011


def geodesic_distances(mesh, sources):
    return GeodesicSolver(mesh).distances(sources)


def relative_errors(distances, exact):
    return np.abs(distances - exact)[exact > 0] / exact[exact > 0]


def straight(mesh, sources):
    return np.linalg.norm(mesh.vertices[sources][:, None] - mesh.vertices, axis=2)


def some_vertices(mesh, count=12, seed=0):
    return np.random.default_rng(seed).choice(mesh.vertex_count, count, replace=False)


# --- exact answers


@pytest.mark.parametrize(
    "shape",
    [plane(20), plane(21, jitter=0.2), plane(20, jitter=0.45, seed=1)],
    ids=["grid", "jittered", "very jittered"],
)
def test_exact_on_a_plane(shape):
    mesh = TriangleMesh(*shape)
    sources = np.arange(mesh.vertex_count)
    errors = relative_errors(geodesic_distances(mesh, sources), straight(mesh, sources))
    assert np.mean(errors) < 1e-3
    assert np.mean(errors < 1e-9) > 0.4


def test_exact_on_a_plane_of_needles():
    mesh = TriangleMesh(*irregular(*plane(15)))
    sources = some_vertices(mesh, 40)
    errors = relative_errors(geodesic_distances(mesh, sources), straight(mesh, sources))
    assert np.mean(errors) < MEAN_GOAL_IRREGULAR


def around_corners(points, source, corners, blocked):
    """Shortest paths among obstacles: straight, or around a sequence of the given corners."""
    lengths = np.linalg.norm(corners - source, axis=1)
    lengths[[blocked(source, corner) for corner in corners]] = np.inf
    for _ in corners:
        for i, corner in enumerate(corners):
            for j, other in enumerate(corners):
                if not blocked(other, corner):
                    lengths[i] = min(lengths[i], lengths[j] + np.linalg.norm(corner - other))
    result = []
    for point in points:
        ways = [
            length + np.linalg.norm(point - c)
            for length, c in zip(lengths, corners, strict=True)
            if not blocked(c, point)
        ]
        result.append(min(ways, default=np.inf) if blocked(source, point) else np.linalg.norm(point - source))
    return np.array(result)


def crosses_square(low, high):
    """Whether a segment passes through the inside of the square [low, high]^2: clip it to the square."""

    def blocked(p, q):
        start, end = 0.0, 1.0
        for a, b in zip(p, q, strict=True):
            if abs(b - a) < 1e-12:
                if not low + 1e-9 < a < high - 1e-9:
                    return False
            else:
                near, far = sorted(((low - a) / (b - a), (high - a) / (b - a)))
                start, end = max(start, near), min(end, far)
        return end - start > 1e-9

    return blocked


def crosses_slit(end):
    """Whether a segment crosses x = 1/2 below y = end."""

    def blocked(p, q):
        if (p[0] - 0.5) * (q[0] - 0.5) >= -1e-12:
            return False
        part = (0.5 - p[0]) / (q[0] - p[0])
        return p[1] + part * (q[1] - p[1]) < end - 1e-9

    return blocked


def test_around_a_hole():
    mesh = TriangleMesh(*plane_with_hole(20, 0.3, 0.6))
    corners = np.array([[0.3, 0.3], [0.6, 0.3], [0.6, 0.6], [0.3, 0.6]])
    sources = some_vertices(mesh, 15)
    flat = mesh.vertices[:, :2]
    exact = np.stack([around_corners(flat, flat[s], corners, crosses_square(0.3, 0.6)) for s in sources])
    errors = relative_errors(geodesic_distances(mesh, sources), exact)
    assert (exact > 1.01 * straight(mesh, sources)).mean() > 0.1
    assert errors.mean() < MEAN_GOAL_REGULAR
    assert errors.max() < 0.05


def test_around_a_slit():
    mesh = TriangleMesh(*plane_with_slit(20, 0.6))
    flat = mesh.vertices[:, :2].copy()
    # Take the two sides of the cut apart, so that the straight line knows them.
    left = np.flatnonzero((abs(flat[:, 0] - 0.5) < 1e-9) & (flat[:, 1] < 0.6 - 1e-9))
    copies = left >= 21 * 21
    flat[left[~copies], 0] -= 1e-5
    flat[left[copies], 0] += 1e-5
    sources = np.append(some_vertices(mesh, 12), [left[0], left[-1]])
    exact = np.stack([around_corners(flat, flat[s], np.array([[0.5, 0.6]]), crosses_slit(0.6)) for s in sources])
    errors = relative_errors(geodesic_distances(mesh, sources), exact)
    assert (exact > 1.01 * straight(mesh, sources)).mean() > 0.1
    assert errors[np.isfinite(errors)].mean() < MEAN_GOAL_REGULAR


def great_circle(mesh, sources):
    return np.arctan2(
        np.linalg.norm(np.cross(mesh.vertices[sources][:, None], mesh.vertices), axis=2),
        mesh.vertices[sources] @ mesh.vertices.T,
    )


def unrolled_cylinder(mesh, sources):
    angle, z = np.arctan2(mesh.vertices[:, 1], mesh.vertices[:, 0]), mesh.vertices[:, 2]
    turn = np.abs(angle[sources][:, None] - angle)
    return np.hypot(np.minimum(turn, 2 * np.pi - turn), z[sources][:, None] - z)


def unrolled_cone(mesh, sources):
    """A cone of radius 1 and height 1 unrolls to a sector: the angle about the axis shrinks by the square root of 2."""
    angle = np.arctan2(mesh.vertices[:, 1], mesh.vertices[:, 0])
    slant = 2**0.5 * (1 - mesh.vertices[:, 2])
    turn = np.abs(angle[sources][:, None] - angle)
    turn = np.minimum(turn, 2 * np.pi - turn) / 2**0.5
    ours = slant[sources][:, None]
    return np.sqrt(np.maximum(ours**2 + slant**2 - 2 * ours * slant * np.cos(turn), 0))


SMOOTH = {
    "sphere": (lambda k: icosphere(8 * k), great_circle),
    "cylinder": (lambda k: cylinder(24 * k, 8 * k), unrolled_cylinder),
    "cone": (lambda k: cone(24 * k, 10 * k), unrolled_cone),
}


@pytest.mark.parametrize(("make", "exact"), SMOOTH.values(), ids=SMOOTH)
def test_smooth_shapes_are_met_and_approached(make, exact):
    means = []
    for refinement in (1, 2, 4):
        mesh = TriangleMesh(*make(refinement))
        sources = some_vertices(mesh, 30)
        means.append(relative_errors(geodesic_distances(mesh, sources), exact(mesh, sources)).mean())
    assert means[1] < MEAN_GOAL_REGULAR
    # The needles around the apex of the cone get thinner with refinement, so there little is left to gain.
    assert means[2] < max(0.6 * means[0], 1e-3)


@pytest.mark.parametrize(("make", "exact"), SMOOTH.values(), ids=SMOOTH)
def test_irregular_smooth_shapes(make, exact):
    """Cutting a mesh into needles does not change its surface, so its first vertices keep their exact distances."""
    vertices, triangles = make(2)
    mesh, cut = TriangleMesh(vertices, triangles), TriangleMesh(*irregular(vertices, triangles))
    sources = some_vertices(mesh, 20)
    distances = geodesic_distances(cut, sources)[:, : mesh.vertex_count]
    assert relative_errors(distances, exact(mesh, sources)).mean() < MEAN_GOAL_IRREGULAR


@pytest.mark.parametrize(
    ("shape", "goal"),
    [
        (creature(1.0, 14)[:2], MEAN_GOAL_REGULAR),
        (irregular(*creature(1.0, 11)[:2]), MEAN_GOAL_IRREGULAR),
        (torus(30, 14), MEAN_GOAL_REGULAR),
    ],
    ids=["creature", "irregular creature", "torus"],
)
def test_curved_shapes_agree_with_their_refinement(shape, goal):
    mesh, fine = TriangleMesh(*shape), TriangleMesh(*subdivided(*shape, 4))
    sources = some_vertices(mesh, 8)
    reference = geodesic_distances(fine, sources)[:, : mesh.vertex_count]
    assert relative_errors(geodesic_distances(mesh, sources), reference).mean() < goal


def test_graded_meshes():
    """Edges a hundred times shorter at one end than at the other, as on a face beside a floor."""
    vertices, triangles = plane(25, jitter=0.2)
    vertices = vertices**3
    mesh = TriangleMesh(vertices, triangles)
    sources = some_vertices(mesh, 30)
    errors = relative_errors(geodesic_distances(mesh, sources), straight(mesh, sources))
    assert errors.mean() < MEAN_GOAL_IRREGULAR


# --- a metric


def test_symmetric_and_triangle_inequality():
    mesh = TriangleMesh(*creature(0.7, 12)[:2])
    sources = some_vertices(mesh, 60)
    between = geodesic_distances(mesh, sources)[:, sources]
    assert np.all(between.diagonal() == 0)
    assert relative_errors(between.T, between).mean() < MEAN_GOAL_REGULAR
    detour = (between[:, :, None] + between[None]).min(axis=1)
    assert relative_errors(detour, between).mean() < MEAN_GOAL_REGULAR


def test_never_shorter_than_the_straight_line():
    for shape in (creature(1.0, 12)[:2], irregular(*torus(16, 8), rounds=4), icosphere(5), plane(12)):
        mesh = TriangleMesh(*shape)
        sources = some_vertices(mesh, 40)
        assert (geodesic_distances(mesh, sources) >= straight(mesh, sources) * (1 - 1e-9)).all()


def test_bending_the_creature_keeps_distances():
    posed, triangles, rest = creature(1.0, 14)
    assert np.linalg.norm(posed - rest, axis=1).max() > 0.3
    sources = some_vertices(TriangleMesh(rest, triangles), 100)
    before, after = (geodesic_distances(TriangleMesh(vertices, triangles), sources) for vertices in (rest, posed))
    assert relative_errors(after, before).mean() < 0.03


# --- rows and blocks


def test_rows_do_not_depend_on_company():
    mesh = TriangleMesh(*creature(0.3, 14)[:2])
    solver = GeodesicSolver(mesh)
    sources = np.concatenate([some_vertices(mesh, 200), [3, 3]])
    together = solver.distances(sources)
    assert together.shape == (202, mesh.vertex_count)
    assert np.array_equal(together[-1], together[-2])
    for row in (0, 57, 199):
        assert np.array_equal(solver.distances(sources[[row]])[0], together[row])
        assert np.array_equal(geodesic_distances(mesh, [sources[row]])[0], together[row])
    blocks = list(solver.distances_in_blocks(sources))
    assert sum(len(block) > 0 for _, block in blocks) > 1
    assert sum(len(block) == 0 for _, block in blocks) > 1  # where one may stop
    assert [first for first, _ in blocks] == np.cumsum([0, *(len(block) for _, block in blocks[:-1])]).tolist()
    assert np.array_equal(np.concatenate([block for _, block in blocks]), together)


def test_no_sources():
    mesh = TriangleMesh(*plane(4))
    assert geodesic_distances(mesh, []).shape == (0, 16)
    assert list(GeodesicSolver(mesh).distances_in_blocks([])) == []


@pytest.mark.parametrize(
    ("sources", "message"),
    [
        ([0, 16], "Source 1 .* vertex 16.* 0 to 15"),
        ([-1], "Source 0 .* vertex -1"),
        ([0.5], "list of vertex indices, not an array of float64"),
        ([[0, 1]], r"shape \(1, 2\)"),
        (3, r"shape \(\)"),
    ],
)
def test_bad_sources_are_named(sources, message):
    solver = GeodesicSolver(TriangleMesh(*plane(4)))
    for call in (solver.distances, lambda s: next(solver.distances_in_blocks(s))):
        with pytest.raises(MeshError, match=message) as caught:
            call(sources)
        assert isinstance(caught.value, HierMatchError)


# --- invariances

SHAPES = {
    "grid": plane(12),
    "jittered": plane(12, jitter=0.4),
    "slit": plane_with_slit(10, 0.6),
    "sphere": icosphere(5),
    "cylinder": cylinder(16, 8),
    "torus": torus(18, 9),
    "needles": irregular(*icosphere(4)),
    "creature": creature(1.0, 10)[:2],
}


@given(st.sampled_from(sorted(SHAPES)), st.integers(0, 10**6))
@settings(max_examples=60, deadline=None)
def test_order_of_vertices_and_triangles_does_not_matter(name, seed):
    vertices, triangles = SHAPES[name]
    mesh = TriangleMesh(vertices, triangles)
    shuffled, turned, new = permuted(vertices, triangles, seed)
    sources = some_vertices(mesh, 10, seed)
    expected = geodesic_distances(mesh, sources)
    found = geodesic_distances(TriangleMesh(shuffled, turned), new[sources])[:, new]
    assert np.allclose(found, expected, rtol=1e-9, atol=1e-9)


@given(
    st.sampled_from(sorted(SHAPES)),
    st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda axis: np.linalg.norm(axis) > 0.1),
    st.floats(-4, 4),
    st.tuples(*[st.floats(-10, 10)] * 3),
    st.floats(-6, 6),
)
@settings(max_examples=60, deadline=None)
def test_motion_and_scale_do_not_matter(name, axis, angle, shift, exponent):
    vertices, triangles = SHAPES[name]
    mesh = TriangleMesh(vertices, triangles)
    moved = TriangleMesh(10**exponent * (vertices @ rotation(axis, angle).T + shift), triangles)
    sources = some_vertices(mesh, 10)
    expected = geodesic_distances(mesh, sources)
    assert np.allclose(geodesic_distances(moved, sources) / 10**exponent, expected, rtol=1e-9, atol=1e-9)


def test_reflection_and_flipped_faces_do_not_matter():
    for vertices, triangles in SHAPES.values():
        sources = np.arange(0, len(vertices), 9)
        expected = geodesic_distances(TriangleMesh(vertices, triangles), sources)
        inside_out = TriangleMesh(vertices * [-1, 1, 1], triangles)
        assert np.allclose(geodesic_distances(inside_out, sources), expected, rtol=1e-9)
        mixed = np.where(np.arange(len(triangles))[:, None] % 3 == 0, triangles[:, ::-1], triangles)
        assert np.allclose(geodesic_distances(TriangleMesh(vertices, mixed), sources), expected, rtol=1e-9)


# --- mess


def test_other_components_are_unreachable_and_loose_vertices_too():
    sphere, flat = icosphere(3), plane(6)
    n, m = len(sphere[0]), len(flat[0])
    mesh = TriangleMesh(
        np.concatenate([sphere[0], flat[0] + 5, [[9.0, 9, 9]]]), np.concatenate([sphere[1], flat[1] + n])
    )
    distances = geodesic_distances(mesh, [0, n, n + m])
    assert np.isfinite(distances[0, :n]).all()
    assert np.isinf(distances[0, n:]).all()
    assert np.isfinite(distances[1, n : n + m]).all()
    assert np.isinf(distances[1, :n]).all()
    assert distances[2, -1] == 0
    assert np.isinf(distances[2, :-1]).all()


def test_a_loose_source_alone():
    vertices, triangles = plane(4)
    distances = geodesic_distances(TriangleMesh([*vertices, [9, 9, 9]], triangles), [16])
    assert distances[0, 16] == 0
    assert np.isinf(distances[0, :16]).all()


def check_sane(mesh):
    """Nothing is NaN, infinite exactly between components, and between the straight line and the path over edges."""
    sources = np.arange(0, mesh.vertex_count, max(1, mesh.vertex_count // 40))
    distances = geodesic_distances(mesh, sources)
    labels = mesh.component_labels
    assert np.array_equal(np.isfinite(distances), labels[sources][:, None] == labels)
    direct = straight(mesh, sources)
    scale = np.sqrt(mesh.area)
    assert (distances >= direct * (1 - 1e-9) - 1e-9 * scale).all()
    assert (distances[np.arange(len(sources)), sources] == 0).all()
    a, b = mesh.edges.T
    with np.errstate(invalid="ignore"):
        jump = np.abs(distances[:, a] - distances[:, b])
    assert not (jump > 1.04 * mesh.edge_lengths + 1e-7 * scale).any()
    return distances


def flattened(vertices, triangles, part, seed):
    """Move vertices onto a neighbour: triangles without area and edges without length."""
    random = np.random.default_rng(seed)
    vertices = vertices.copy()
    chosen = triangles[random.random(len(triangles)) < part]
    vertices[chosen[:, 0]] = vertices[chosen[:, 1]]
    return vertices, triangles


def with_caps(vertices, triangles):
    """Put a vertex exactly on one side of every third triangle: flat caps beside a half of the triangle."""
    cut = np.arange(len(triangles)) % 3 == 0
    a, b, c = triangles[cut].T
    new = len(vertices) + np.arange(len(a))
    pieces = [np.stack(corners, axis=1) for corners in ((a, new, c), (new, b, c), (b, new, a))]
    return np.concatenate([vertices, (vertices[a] + vertices[b]) / 2]), np.concatenate([triangles[~cut], *pieces])


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("part", [0.02, 0.3, 0.9])
def test_edges_without_length(seed, part):
    check_sane(TriangleMesh(*flattened(*torus(20, 10), part, seed)))


def test_flat_caps_let_paths_through():
    vertices, triangles = plane(14, jitter=0.3)
    mesh = TriangleMesh(*with_caps(vertices, triangles))
    assert (mesh.triangle_areas < 1e-12).sum() > 50
    distances = check_sane(mesh)
    sources = np.arange(0, mesh.vertex_count, mesh.vertex_count // 40)
    assert relative_errors(distances, straight(mesh, sources)).mean() < 0.02


def test_needles():
    random = np.random.default_rng(0)
    vertices, triangles = irregular(*icosphere(4), rounds=6, part=0.5)
    check_sane(TriangleMesh(vertices, triangles))
    check_sane(TriangleMesh(vertices * [1, 1, 1e-7], triangles))
    check_sane(TriangleMesh(vertices * [1, 1, 1e6], triangles))
    check_sane(TriangleMesh(vertices + random.normal(0, 0.2, vertices.shape), triangles))


def test_edges_of_many_triangles():
    """A book: pages that share one spine.  Every page lies flat with every other."""
    count, pages = 9, 5
    vertices, triangles = plane(count)
    all_vertices, all_triangles, spine = [vertices], [triangles], np.flatnonzero(vertices[:, 0] == 0)
    for page in range(1, pages):
        turned = vertices @ rotation([0, 1, 0], -2 * np.pi * page / pages).T
        renumber = np.arange(len(vertices)) + page * len(vertices)
        renumber[spine] = spine
        all_vertices.append(turned)
        all_triangles.append(renumber[triangles])
    vertices = np.concatenate(all_vertices)
    mesh = TriangleMesh(vertices, np.concatenate(all_triangles))
    check_sane(mesh)
    sources = np.arange(count * count)
    distances = geodesic_distances(mesh, sources)[:, 2 * count * count :]
    flat = all_vertices[0]
    exact = np.linalg.norm(flat[:, None] * [1, 1, 0] - flat * [-1, 1, 0], axis=2)
    page = distances[:, : count * count]
    inside = np.isfinite(page)
    assert relative_errors(page[inside], exact[inside]).mean() < 0.03


def test_any_soup_of_triangles():
    for seed in range(20):
        random = np.random.default_rng(seed)
        count = int(random.integers(4, 60))
        triangles = np.array([random.choice(count, 3, replace=False) for _ in range(2 * count)])
        scale = 10.0 ** random.integers(-3, 3, (count, 1))
        mesh = TriangleMesh(random.normal(size=(count, 3)) * scale, triangles)
        distances = geodesic_distances(mesh, np.arange(count))
        assert not np.isnan(distances).any()
        assert (distances >= straight(mesh, np.arange(count)) - 1e-9 * mesh.edge_lengths.max()).all()
        labels = mesh.component_labels
        assert np.array_equal(np.isfinite(distances), labels[:, None] == labels)


def test_one_triangle():
    mesh = TriangleMesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    assert np.allclose(geodesic_distances(mesh, [0, 1, 2]), [[0, 3, 4], [3, 0, 5], [4, 5, 0]])


def test_a_long_strip():
    """More bands than 16 bits can count."""
    count = 40_000
    vertices = np.stack([np.repeat(np.arange(count), 2), np.tile([0, 1], count), np.zeros(2 * count)], axis=1)
    corner = 2 * np.arange(count - 1)
    triangles = np.concatenate(
        [np.stack([corner, corner + 2, corner + 1], axis=1), np.stack([corner + 1, corner + 2, corner + 3], axis=1)]
    )
    distances = geodesic_distances(TriangleMesh(vertices.astype(float), triangles), [0])[0]
    exact = np.linalg.norm(vertices, axis=1)
    assert relative_errors(distances, exact).max() < 1e-3
