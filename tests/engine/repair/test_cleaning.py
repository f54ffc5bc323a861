# SPDX-License-Identifier: GPL-3.0-or-later
"""From messy meshes to manifolds, and back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import TriangleMesh
from engine.repair.cleaning import clean
from tests.bodies import mirrored_body
from tests.messes import cut_along_seam, in_pieces, partly_turned, together, with_fin, without_disc, without_faces
from tests.shapes import creature, cylinder, icosphere, irregular, permuted, plane, rotation, torus


@pytest.fixture(scope="module")
def body():
    vertices, triangles, _ = creature(0.0, 11)
    return vertices, triangles


def cleaned(mesh):
    return clean(TriangleMesh(*mesh), "source")


def characteristic(mesh):
    return mesh.vertex_count - len(mesh.edges) + mesh.triangle_count


def volume(mesh):
    return np.linalg.det(mesh.vertices[mesh.triangles]).sum() / 6


def assert_manifold(mesh):
    """Every half-edge once, edges of one or two triangles, every vertex used and with a single fan."""
    tail, head = mesh.triangles.ravel(), np.roll(mesh.triangles, -1, axis=1).ravel()
    assert len(np.unique(tail * mesh.vertex_count + head)) == len(tail)
    assert len(np.unique(tail)) == mesh.vertex_count
    around = [[] for _ in range(mesh.vertex_count)]
    for corners in mesh.triangles.tolist():
        for i in range(3):
            around[corners[i]].append((corners[i - 2], corners[i - 1]))
    for pairs in around:
        following = dict(pairs)
        ends = set(following) - set(following.values())
        assert len(ends) <= 1
        start = at = ends.pop() if ends else pairs[0][0]
        steps = 0
        while at in following:
            at, steps = following[at], steps + 1
            if at == start:
                break
        assert steps == len(pairs)


def assert_leads_back(surface, tolerance=1e-12):
    """Check that vertices and points have the same positions on the clean parts and on the original."""
    original = surface.original
    random = np.random.default_rng(5)
    for number, piece in enumerate(surface.pieces):
        known = piece.original_vertices >= 0
        offsets = piece.mesh.vertices[known] - original.vertices[piece.original_vertices[known]]
        assert np.abs(offsets).max() <= tolerance
        kept = np.flatnonzero(piece.original_triangles >= 0)
        barycentric = random.dirichlet(np.ones(3), len(kept))
        triangles, there = piece.to_original(kept, barycentric)
        at = np.einsum("kc,kcd->kd", barycentric, piece.mesh.vertices[piece.mesh.triangles[kept]])
        back = np.einsum("kc,kcd->kd", there, original.vertices[original.triangles[triangles]])
        assert np.abs(at - back).max() <= tolerance
        members = np.flatnonzero(surface.vertex_parts == number)
        images = surface.vertex_images[members]
        assert np.abs(piece.mesh.vertices[images] - original.vertices[members]).max(initial=0) <= tolerance
    assert ((surface.vertex_parts < 0) == (surface.vertex_images < 0)).all()


def assert_like(surface, mesh):
    """Check that the main part is the surface of a closed clean mesh."""
    expected = TriangleMesh(*mesh)
    assert_manifold(surface.mesh)
    assert surface.mesh.is_closed
    assert characteristic(surface.mesh) == characteristic(expected)
    assert surface.mesh.area == pytest.approx(expected.area)
    assert volume(surface.mesh) == pytest.approx(volume(expected))


@pytest.mark.parametrize("shape", [icosphere(5), torus(20, 12), creature(0.5, 9)[:2], irregular(*icosphere(4))])
def test_clean_meshes_stay_as_they_are(shape):
    mesh = TriangleMesh(*shape)
    surface = clean(mesh)
    assert surface.mesh is mesh
    assert surface.notes == ()
    assert len(surface.pieces) == 1
    assert not surface.counts.inverted
    assert np.array_equal(surface.vertex_images, np.arange(mesh.vertex_count))
    assert not surface.vertex_parts.any()
    assert np.array_equal(surface.main.original_triangles, np.arange(mesh.triangle_count))
    assert_leads_back(surface, 0)


@pytest.mark.parametrize("shape", [plane(8), cylinder(16, 8)])
def test_large_openings_stay_open(shape):
    mesh = TriangleMesh(*shape)
    surface = clean(mesh, "target")
    assert surface.mesh is mesh
    assert len(surface.notes) == 1
    assert "large opening" in surface.notes[0]


def test_seams_are_closed(body):
    surface = cleaned(cut_along_seam(*body))
    assert_like(surface, body)
    assert_leads_back(surface)
    seam = surface.original.vertex_count - len(body[0])
    assert surface.mesh.vertex_count == len(body[0])
    assert surface.notes == (
        f"The source had {seam} duplicate vertices along open seams: they were welded for matching.",
    )
    # Either side of the seam has the same image.
    assert set(surface.vertex_images[-seam:]) <= set(surface.vertex_images[:-seam])


def test_seams_with_small_gaps_are_closed(body):
    edges = TriangleMesh(*body).edge_lengths
    gap = 0.002 * edges.min()
    surface = cleaned(cut_along_seam(*body, noise=gap))
    assert surface.mesh.is_closed
    assert characteristic(surface.mesh) == 2
    assert_manifold(surface.mesh)
    assert_leads_back(surface, 2 * gap)


def test_loose_triangles_are_put_together(body):
    surface = cleaned(in_pieces(*body))
    assert_like(surface, body)
    assert_leads_back(surface)
    assert len(surface.pieces) == 1


def test_surfaces_that_touch_stay_apart():
    left, triangles = cylinder(12, 6, height=1.0)
    sphere = icosphere(4)
    flat = sphere[0].copy()
    flat[:, 0] = flat[:, 0].clip(max=0.5)
    mirrored = flat * [-1, 1, 1] + [1, 0, 0], sphere[1][:, ::-1]
    surface = cleaned(together((flat, sphere[1]), mirrored))  # each vertex of the flat sides twice
    assert len(surface.pieces) == 2
    assert surface.notes == ("The source has 1 smaller part: it follows its surroundings.",)
    assert surface.mesh.is_closed
    assert surface.pieces[1].mesh.is_closed
    assert len(cleaned((left, triangles)).pieces) == 1


def test_fins_are_cut_off(body):
    messy = with_fin(*body)
    surface = cleaned(messy)
    assert_like(surface, body)
    assert_leads_back(surface)
    assert surface.notes[0] == "The source had 3 non-manifold edges: they were opened for matching."
    assert len(surface.pieces) == 2
    assert_manifold(surface.pieces[1].mesh)
    assert (surface.vertex_parts[: len(body[0])] == 0).all()
    assert (surface.vertex_parts[len(body[0]) :] == 1).all()


def test_inner_walls_are_cut_out():
    vertices, triangles = cylinder(16, 8, radius=1.0, height=2.0)
    ring = np.arange(16) * 9
    centres = len(vertices) + np.arange(3)
    discs = [
        np.stack([ring + level, np.roll(ring, -1) + level, np.full(16, centre)], axis=1)
        for level, centre in zip((8, 4, 0), centres, strict=True)
    ]
    discs[2] = discs[2][:, ::-1]
    vertices = np.concatenate([vertices, [[0, 0, 2.0], [0, 0, 1.0], [0, 0, 0.0]]])
    closed = np.concatenate([triangles, discs[0], discs[2]])
    surface = cleaned((vertices, np.concatenate([closed, discs[1]])))
    assert_like(
        surface, (vertices[[*range(len(vertices) - 2), -1]], np.where(closed == centres[2], centres[1], closed))
    )
    assert len(surface.pieces) == 2


def test_touching_vertices_are_separated():
    (upper, triangles), lower = icosphere(3), icosphere(3)[0]
    top = lower[:, 2].argmax()
    upper = upper - upper[upper[:, 2].argmin()] + lower[top]
    bottom = upper[:, 2].argmin()
    joined = triangles + len(lower)
    joined[joined == bottom + len(lower)] = top
    surface = cleaned((np.concatenate([lower, upper]), np.concatenate([triangles, joined])))
    assert len(surface.pieces) == 2
    for piece in surface.pieces:
        assert_manifold(piece.mesh)
        assert characteristic(piece.mesh) == 2
    assert "1 place where sheets touch in one vertex: it was separated" in surface.notes[0]


def test_faces_missing_around_a_vertex_are_put_back(body):
    """Every other triangle around a vertex: the others would hang on it by a corner each."""
    vertices, triangles = body
    degrees = np.bincount(triangles.ravel())
    middle = np.flatnonzero(degrees == 6)[40]
    around = np.flatnonzero((triangles == middle).any(axis=1))
    following = {}
    for face in around:
        corner = list(triangles[face]).index(middle)
        following[triangles[face][corner - 2]] = (triangles[face][corner - 1], face)
    at = next(iter(following))
    order = []
    for _ in range(6):
        at, face = following[at]
        order.append(face)
    surface = cleaned((vertices, np.delete(triangles, order[::2], axis=0)))
    assert surface.mesh.vertex_count == len(vertices)
    assert_like(surface, body)
    assert_leads_back(surface)
    assert surface.notes == ("The source had 3 small holes: they were closed for matching.",)


@pytest.mark.parametrize("part", [0.1, 0.25])
def test_a_body_without_many_of_its_faces_hangs_together(body, part):
    whole = TriangleMesh(*body)
    surface = cleaned(without_faces(*body, part))
    for piece in surface.pieces:
        assert_manifold(piece.mesh)
    assert_leads_back(surface)
    assert surface.mesh.area > 0.9 * whole.area
    # What is cut apart gets copies of its vertices.
    assert surface.mesh.vertex_count - (surface.main.original_vertices < 0).sum() < 1.1 * whole.vertex_count


def test_flakes_that_touch_in_a_vertex_are_no_gap():
    """Two triangles, each other's neighbours in a vertex only: their outlines are closed walks, too."""
    vertices, triangles = icosphere(4)
    flakes = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [-1, -1, 0]]) * 0.1 + [0, 0, 3]
    faces = np.array([[0, 1, 2], [0, 3, 4]]) + len(vertices)
    surface = cleaned((np.concatenate([vertices, flakes]), np.concatenate([triangles, faces])))
    assert [piece.mesh.triangle_count for piece in surface.pieces[1:]] == [1, 1]
    assert surface.main.mesh.triangle_count == len(triangles)


def test_sheets_that_share_an_edge_and_its_ends_become_manifold():
    """A pinched body: pairing alone would leave an edge with four triangles between two vertices."""
    vertices, triangles = torus(12, 8)
    a, b = 0, 3  # across the tube from each other
    extra = np.array([[a, b, 1], [b, a, 2]])
    surface = cleaned((vertices, np.concatenate([triangles, extra, extra[:, ::-1][:1]])))
    for piece in surface.pieces:
        assert_manifold(piece.mesh)
    assert surface.mesh.area == pytest.approx(TriangleMesh(vertices, triangles).area, rel=0.1)


def test_inverted_normals_are_turned_out(body):
    vertices, triangles = body
    surface = cleaned((vertices, triangles[:, [0, 2, 1]]))
    assert surface.counts.inverted
    assert surface.notes == ("The normals of the source point inwards: they were read the other way round.",)
    assert np.array_equal(surface.mesh.triangles, triangles)
    assert_leads_back(surface)
    assert not cleaned(body).counts.inverted


@pytest.mark.parametrize("part", [0.05, 0.4])
def test_inconsistent_normals_are_made_to_agree(body, part):
    messy = partly_turned(*body, part)
    surface = cleaned(messy)
    assert_like(surface, body)
    assert_leads_back(surface)
    assert not surface.counts.inverted
    wrong = int((messy[1] != body[1]).any(axis=1).sum())
    assert surface.notes[0].startswith(f"The source had {wrong:,} faces with normals against their neighbours")
    inverted = cleaned((messy[0], messy[1][:, ::-1]))
    assert inverted.counts.inverted
    assert_like(inverted, body)


def test_normals_of_a_cut_body_are_turned_out(body):
    vertices, triangles = body
    legless = triangles[(vertices[triangles].mean(axis=1)[:, 2] > -0.4)]
    surface = cleaned((vertices, legless[:, ::-1]))
    assert surface.counts.inverted
    assert_manifold(surface.mesh)
    assert len(surface.mesh.boundary_edges)
    assert any("4 large openings" in note for note in surface.notes)


def test_a_sheet_keeps_its_side():
    vertices, triangles = plane(10, jitter=0.2)
    vertices = vertices + np.random.default_rng(0).normal(0, 0.01, vertices.shape)
    for sheet in (triangles, triangles[:, ::-1]):
        surface = cleaned((vertices, sheet))
        assert not surface.counts.inverted
        assert np.array_equal(surface.mesh.triangles, sheet)
        turned = cleaned(partly_turned(vertices, sheet, 0.2))
        assert np.allclose(turned.mesh.triangle_normals, surface.mesh.triangle_normals)


def test_a_one_sided_surface_is_cut_open():
    around, across = 30, 4
    angle, offset = np.meshgrid(2 * np.pi * np.arange(around) / around, np.linspace(-0.3, 0.3, across), indexing="ij")
    out = 1 + offset * np.cos(angle / 2)
    vertices = np.stack([out * np.cos(angle), out * np.sin(angle), offset * np.sin(angle / 2)], axis=-1).reshape(-1, 3)
    triangles = []
    for i in range(around):
        for j in range(across - 1):
            a, b = i * across + j, i * across + j + 1
            c, d = ((i + 1) * across + k if i < around - 1 else across - 1 - k for k in (j, j + 1))
            triangles += [(a, c, b), (b, c, d)]
    surface = cleaned((vertices, np.array(triangles)))
    assert "only one side" in " ".join(surface.notes)
    assert_manifold(surface.mesh)
    assert_leads_back(surface)
    assert surface.mesh.triangle_count == len(triangles)
    assert characteristic(surface.mesh) == 1


def test_loose_vertices_are_in_no_part(body):
    vertices, triangles = body
    surface = cleaned((np.concatenate([np.zeros((2, 3)), vertices]), triangles + 2))
    assert np.array_equal(surface.vertex_parts[:2], [-1, -1])
    assert_like(surface, body)
    assert_leads_back(surface)
    assert surface.notes == ("The source has 2 loose vertices: they follow their surroundings.",)


def test_repeated_faces_are_left_out(body):
    vertices, triangles = body
    turned, rolled = triangles[:5, ::-1], np.roll(triangles[5:8], 1, axis=1)
    surface = cleaned((vertices, np.concatenate([triangles, turned, rolled, rolled])))
    assert_like(surface, body)
    assert np.array_equal(surface.main.original_triangles, np.arange(len(triangles)))
    assert surface.notes == ("The source had 11 repeated faces: they were left out.",)


def test_needles_and_faces_without_area_survive(body):
    vertices, triangles = body
    a, b, c = triangles[0]
    needle = 1e-9 * vertices[c] + (1 - 1e-9) * vertices[a]
    on_edge = (vertices[a] + vertices[b]) / 2
    new = len(vertices)
    other = np.flatnonzero(((triangles == a) | (triangles == b)).sum(axis=1) == 2)
    other = other[other != 0][0]
    d = np.setdiff1d(triangles[other], [a, b])[0]
    pieces = [(new, b, c), (a, b, new), (a, new, c), (b, a, new + 1), (a, d, new + 1), (d, b, new + 1)]
    kept = np.delete(triangles, [0, other], axis=0)
    mesh = TriangleMesh(np.concatenate([vertices, [needle, on_edge]]), np.concatenate([kept, pieces]))
    assert mesh.triangle_areas.min() < 1e-15
    surface = clean(mesh)
    assert surface.mesh is mesh
    assert_manifold(mesh)


def test_degenerate_poles_are_welded():
    """Each pole of many a sphere is a ring of vertices in one place, with triangles that have no area."""
    vertices, triangles = cylinder(12, 8, radius=1.0, height=np.pi)
    z = vertices[:, 2].copy()
    vertices[:, :2] *= np.sin(z).clip(min=0)[:, None]
    vertices[z > 3.14, :2] = vertices[z == 0, :2] = 0
    vertices[:, 2] = -np.cos(z)
    surface = cleaned((vertices, triangles))
    assert_manifold(surface.mesh)
    assert surface.mesh.is_closed
    assert characteristic(surface.mesh) == 2
    assert "24 degenerate faces" in " ".join(surface.notes)


@pytest.mark.parametrize("radius", [0.06, 0.1])
def test_holes_are_filled(body, radius):
    hole = body[0][np.abs(body[0] - [0, -0.28, 0]).sum(axis=1).argmin()]
    messy = without_disc(*body, hole, radius)
    assert len(messy[1]) < len(body[1])
    surface = cleaned(messy)
    assert_manifold(surface.mesh)
    assert surface.mesh.is_closed
    assert characteristic(surface.mesh) == 2
    assert_leads_back(surface)
    assert surface.notes[0] == "The source had 1 small hole: it was closed for matching."
    filled = np.flatnonzero(surface.main.original_triangles < 0)
    assert (surface.main.original_vertices < 0).sum() == 1
    # A point in the hole goes to its rim.
    triangles, barycentric = surface.main.to_original(filled, np.full((len(filled), 3), 1 / 3))
    original = surface.original
    there = np.einsum("kc,kcd->kd", barycentric, original.vertices[original.triangles[triangles]])
    asked = surface.mesh.vertices[surface.mesh.triangles[filled]].mean(axis=1)
    rim = surface.mesh.vertices[surface.mesh.triangles[filled][:, :2]]
    assert (np.linalg.norm(there - asked, axis=1) <= np.linalg.norm(rim.mean(axis=1) - asked, axis=1) + 1e-9).all()
    assert np.allclose(barycentric.sum(axis=1), 1)


def test_a_limb_that_is_cut_off_stays_open(body):
    vertices, triangles = body
    middles = vertices[triangles].mean(axis=1)
    leg = (middles[:, 2] < -0.5) & (middles[:, 0] > 0) & (middles[:, 1] > 0)
    surface = cleaned((vertices, triangles[~leg]))
    assert_manifold(surface.mesh)
    assert characteristic(surface.mesh) == 1
    assert not surface.counts.inverted
    assert "The source has 1 large opening: the surface ends there." in surface.notes
    assert_leads_back(surface)


def test_parts_are_sorted_by_area(body):
    eye = icosphere(3, 0.05)
    tooth = icosphere(2, 0.02)
    messy = together((tooth[0] + [1.2, 0, 0.4], tooth[1]), body, (eye[0] + [1.1, 0.1, 0.5], eye[1][:, ::-1]))
    surface = cleaned(messy)
    assert_like(surface, body)
    assert_leads_back(surface)
    assert [piece.mesh.triangle_count for piece in surface.pieces[1:]] == [len(eye[1]), len(tooth[1])]
    assert np.array_equal(np.bincount(surface.vertex_parts), [len(body[0]), len(eye[0]), len(tooth[0])])
    assert [piece.turned.all() for piece in surface.pieces] == [False, True, False]
    assert all(volume(piece.mesh) > 0 for piece in surface.pieces[1:])


@pytest.mark.parametrize(("size", "main"), [(0.8, "body"), (1.5, "body"), (3.0, "sheet")])
def test_a_closed_body_is_the_main_part_unless_what_is_open_is_twice_as_large(size, main):
    ball = icosphere(6)
    side = np.sqrt(size * TriangleMesh(*ball).area)
    sheet = plane(12, side)
    surface = cleaned(together((sheet[0] + [0, 0, 1.5], sheet[1]), ball))
    assert len(surface.mesh.vertices) == len((ball if main == "body" else sheet)[0])
    assert_leads_back(surface)


def test_a_floor_is_not_the_main_part(body):
    floor = np.array([[-9.0, -9, -1.5], [9, -9, -1.5], [9, 9, -1.5], [-9, 9, -1.5]]), np.array([[0, 1, 2], [0, 2, 3]])
    surface = cleaned(together(body, floor))
    assert_like(surface, body)
    assert_leads_back(surface)


def test_thousands_of_crumbs_are_in_no_part():
    random = np.random.default_rng(0)
    crumbs = random.normal(size=(300, 1, 3)) * 3 + random.normal(size=(300, 3, 3)) * 0.01
    surface = cleaned(together(icosphere(3), (crumbs.reshape(-1, 3), np.arange(900).reshape(-1, 3))))
    assert len(surface.pieces) == 257
    assert (surface.vertex_parts < 0).sum() == 3 * 44
    assert "300 smaller parts" in surface.notes[-1]


def everything_wrong(seed=0):
    """Make a mesh with each fault at once."""
    vertices, triangles, _ = mirrored_body(0.6, 11, seed=seed)
    mesh = without_disc(vertices, triangles, vertices[np.abs(vertices - [0, -0.28, 0]).sum(axis=1).argmin()], 0.1)
    mesh = with_fin(*mesh, first=int(mesh[0][:, 0].argmin()))
    mesh = cut_along_seam(*mesh)
    mesh = partly_turned(*mesh, 0.2, seed)
    eye = icosphere(3, 0.05)
    mesh = together(mesh, (eye[0] + [1.1, 0.1, 0.5], eye[1]), (np.array([[0.0, 0, 3]]), np.empty((0, 3), np.int64)))
    return mesh[0], np.concatenate([mesh[1], mesh[1][:4], np.roll(mesh[1][7:9], 1, axis=1)])


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 100), scale=st.sampled_from([1e-3, 1.0, 250.0]))
def test_order_position_and_scale_do_not_matter(seed, scale):
    mesh = everything_wrong()
    surface = cleaned(mesh)
    vertices, triangles, new = permuted(*mesh, seed)
    random = np.random.default_rng(seed)
    vertices = scale * (vertices @ rotation(random.normal(size=3), random.uniform(0, 6)).T + random.normal(size=3))
    other = cleaned((vertices, triangles))
    assert len(other.pieces) == len(surface.pieces)
    for one, two in zip(surface.pieces, other.pieces, strict=True):
        assert one.mesh.vertex_count == two.mesh.vertex_count
        assert one.mesh.triangle_count == two.mesh.triangle_count
        assert two.mesh.area == pytest.approx(scale**2 * one.mesh.area)
    assert volume(other.mesh) == pytest.approx(scale**3 * volume(surface.mesh), rel=1e-6)
    assert np.array_equal(other.vertex_parts[new], surface.vertex_parts)
    assert other.notes == surface.notes
    assert_leads_back(other, 1e-9 * scale)


def test_everything_at_once_is_cured():
    surface = cleaned(everything_wrong())
    for piece in surface.pieces:
        assert_manifold(piece.mesh)
    assert surface.mesh.is_closed
    assert characteristic(surface.mesh) == 2
    assert volume(surface.mesh) > 0
    assert len(surface.notes) == 7
    assert all(note.startswith("The source ha") and note.endswith(".") for note in surface.notes)


def test_the_original_is_not_changed():
    vertices, triangles = everything_wrong()
    before = vertices.copy(), triangles.copy()
    surface = cleaned((vertices, triangles))
    assert np.array_equal(surface.original.vertices, before[0])
    assert np.array_equal(surface.original.triangles, before[1])


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_any_triangles_become_manifolds(data):
    count = data.draw(st.integers(4, 9))
    corners = st.permutations(range(count)).map(lambda order: order[:3])
    triangles = np.array(data.draw(st.lists(corners, min_size=1, max_size=30)))
    vertices = np.random.default_rng(data.draw(st.integers(0, 5))).normal(size=(count, 3))
    surface = cleaned((vertices, triangles))
    for piece in surface.pieces:
        assert_manifold(piece.mesh)
        assert np.isfinite(piece.mesh.vertices).all()
    assert_leads_back(surface)
