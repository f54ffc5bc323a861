# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.symmetrise`, on a body in a pose and a meshing that are not symmetric."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from hiermatch.engine import ClosestPoints, Progress, SurfaceMap, TriangleMesh
from hiermatch.hiermatch_addon.common.side_names import flipped_name, partners, side_of
from hiermatch.hiermatch_addon.scene.deform_layer import read_weights, write_weights
from scipy.sparse import csr_array

from tests.addon.scenes import snapshot
from tests.addon.shape_keys import add_key, offsets_of, positions
from tests.bodies import mirrored_body


@pytest.fixture(scope="module")
def found():
    """The body, where its vertices are at rest (mirror images differ in the sign of y), and its true map to itself."""
    vertices, triangles, rest = mirrored_body(0.6, 9, seed=0)
    mesh = TriangleMesh(vertices.astype(np.float32), triangles)
    there = ClosestPoints(TriangleMesh(rest, triangles)).nearest(rest * [1, -1, 1])
    mirror = SurfaceMap.from_barycentric(mesh, there.triangles, there.barycentric)
    return mesh, rest, SimpleNamespace(source_to_target=mirror, quality=SimpleNamespace(confidence=1.0))


@pytest.fixture
def body(found, monkeypatch):
    """An object, and the rest positions of its vertices."""
    mesh, rest, symmetry = found

    def steps(_mesh):
        yield Progress(0.5, "Known already")
        return symmetry

    monkeypatch.setattr("hiermatch.hiermatch_addon.transfers.symmetrise.symmetry_map_steps", steps)
    data = bpy.data.meshes.new("Body")
    data.from_pydata(mesh.vertices.tolist(), [], mesh.triangles.tolist())
    obj = bpy.data.objects.new("Body", data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()
    return obj, rest


def symmetrise(**options):
    return bpy.ops.hiermatch.symmetrise(**options)


def add_legs(obj, rest):
    """Weights of a foreleg and the hind leg, good on the left (y > 0) only."""
    left = np.clip(-2 * rest[:, 2] - 0.4, 0, 1) * (rest[:, 0] > 0) * (rest[:, 1] > 0)
    spine = np.where(rest[:, 1] > 0, 1 - left, 0.3)
    wrong = 0.1 * (rest[:, 1] < 0)
    names = ["Leg.L", "Leg.R", "Spine"]
    write_weights(obj, names, csr_array(np.stack([left, wrong, spine], axis=1)))
    return left, spine


def test_weights_are_taken_to_the_other_side(body):
    obj, rest = body
    left, _ = add_legs(obj, rest)
    assert symmetrise() == {"FINISHED"}
    weights = read_weights(obj).toarray()
    right_side = rest[:, 1] < 0
    expected = np.clip(-2 * rest[:, 2] - 0.4, 0, 1) * (rest[:, 0] > 0) * right_side
    assert np.abs(weights[:, 1] - expected)[right_side].mean() < 0.02
    good = rest[:, 1] > 0.1
    np.testing.assert_allclose(weights[good, 0], left[good], atol=1e-6)
    assert np.abs(weights[(rest[:, 1] < -0.1) & (rest[:, 2] > 0), 2] - 1).mean() < 0.02
    assert [group.name for group in obj.vertex_groups] == ["Leg.L", "Leg.R", "Spine"]


def test_a_body_that_is_hardly_symmetric_is_named(body, found, capfd):
    obj, rest = body
    add_legs(obj, rest)
    symmetrise()
    assert "is hardly symmetric" not in capfd.readouterr().out
    found[2].quality.confidence = 0.4
    try:
        symmetrise()
    finally:
        found[2].quality.confidence = 1.0
    assert '"Body" is hardly symmetric' in capfd.readouterr().out


def test_the_other_direction(body):
    obj, rest = body
    add_legs(obj, rest)
    assert symmetrise(symmetrise_side="RIGHT") == {"FINISHED"}
    weights = read_weights(obj).toarray()
    far = np.abs(rest[:, 1]) > 0.1
    np.testing.assert_allclose(weights[far & (rest[:, 1] > 0), 0], 0.1, atol=0.02)
    np.testing.assert_allclose(weights[far & (rest[:, 1] > 0), 2], 0.3, atol=0.1)


def test_locked_groups_stay_and_missing_ones_are_made(body):
    obj, rest = body
    left, spine = add_legs(obj, rest)
    obj.vertex_groups["Spine"].lock_weight = True
    obj.vertex_groups.remove(obj.vertex_groups["Leg.R"])
    # Without names on both sides the object's X axis tells them apart: let it point to the left.
    obj.data.transform(((0, 1, 0, 0), (-1, 0, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)))
    obj.matrix_world = ((0, -1, 0, 0), (1, 0, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))
    bpy.context.view_layer.update()
    assert symmetrise() == {"FINISHED"}
    weights = read_weights(obj).toarray()
    names = [group.name for group in obj.vertex_groups]
    assert names == ["Leg.L", "Spine", "Leg.R"]
    np.testing.assert_allclose(weights[:, 1], spine, atol=1e-6)
    assert weights[:, 2].sum() == pytest.approx(left.sum(), rel=0.15)


def test_shape_keys_are_mirrored(body):
    obj, rest = body
    add_legs(obj, rest)
    bump = np.exp(-((rest - [0.45, 0.2, -0.9]) ** 2).sum(axis=1) / 0.05)[:, None]
    add_key(obj, "Kick.L", 0.1 * bump * [1, 0, 0]).slider_max = 2
    add_key(obj, "Both", 0.1 * bump * [1, 0, 0])
    add_key(obj, "Wrap to Other", bump * [1, 0, 0])
    assert symmetrise(symmetrise_weights=False) == {"FINISHED"}
    names = [key.name for key in obj.data.shape_keys.key_blocks]
    assert names == ["Basis", "Kick.L", "Both", "Wrap to Other", "Kick.R"]
    assert obj.data.shape_keys.key_blocks["Kick.R"].slider_max == 2
    np.testing.assert_allclose(offsets_of(obj, "Kick.L"), 0.1 * bump * [1, 0, 0], atol=1e-6)
    np.testing.assert_allclose(offsets_of(obj, "Wrap to Other"), bump * [1, 0, 0], atol=1e-6)
    made = np.linalg.norm(offsets_of(obj, "Kick.R"), axis=1)
    expected = 0.1 * np.exp(-((rest - [0.45, -0.2, -0.9]) ** 2).sum(axis=1) / 0.05)
    assert np.linalg.norm(made - expected) < 0.2 * np.linalg.norm(expected)
    both = np.linalg.norm(offsets_of(obj, "Both"), axis=1)
    assert np.linalg.norm(both - made - 0.1 * bump[:, 0]) < 0.2 * np.linalg.norm(expected)


def test_a_key_of_one_side_alone_gets_its_partner(body):
    obj, rest = body
    add_legs(obj, rest)
    add_key(obj, "Kick.L", np.full_like(rest, 0.1))
    assert symmetrise(symmetrise_weights=False) == {"FINISHED"}
    assert [key.name for key in obj.data.shape_keys.key_blocks] == ["Basis", "Kick.L", "Kick.R"]
    np.testing.assert_allclose(offsets_of(obj, "Kick.L"), 0.1, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(offsets_of(obj, "Kick.R"), axis=1), 0.1 * np.sqrt(3), rtol=0.02)


def test_locked_keys_stay_as_they_are(body):
    obj, rest = body
    add_legs(obj, rest)
    add_key(obj, "Kick.L", np.full_like(rest, 0.1))
    add_key(obj, "Kick.R", np.full_like(rest, 0.3)).lock_shape = True
    assert symmetrise() == {"FINISHED"}
    assert [key.name for key in obj.data.shape_keys.key_blocks] == ["Basis", "Kick.L", "Kick.R"]
    np.testing.assert_allclose(offsets_of(obj, "Kick.L"), 0.1, atol=1e-6)
    np.testing.assert_allclose(offsets_of(obj, "Kick.R"), 0.3, atol=1e-6)


def test_colors_of_vertices_and_corners(body):
    obj, rest = body
    add_legs(obj, rest)
    for domain in ("POINT", "CORNER"):
        attribute = obj.data.color_attributes.new(domain.title(), "FLOAT_COLOR", domain)
        at = np.arange(len(rest))
        if domain == "CORNER":
            at = np.array([loop.vertex_index for loop in obj.data.loops])
        values = np.where(rest[at, 1:2] > 0, [[1.0, 0.5, 0, 1]], [[0, 0, 1.0, 1]])
        attribute.data.foreach_set("color", values.astype(np.float32).ravel())
    assert symmetrise(symmetrise_weights=False) == {"FINISHED"}
    for domain in ("Point", "Corner"):
        attribute = obj.data.color_attributes[domain]
        flat = np.empty(4 * len(attribute.data), np.float32)
        attribute.data.foreach_get("color", flat)
        at = np.arange(len(rest))
        if domain == "Corner":
            at = np.array([loop.vertex_index for loop in obj.data.loops])
        off_middle = np.abs(rest[at, 1]) > 0.1  # there the wrong side shines through
        assert np.abs(flat.reshape(-1, 4) - [1, 0.5, 0, 1])[off_middle].max() < 0.1


def test_what_is_no_finite_number_is_left_out_and_does_not_spread(body, capfd):
    obj, rest = body
    add_legs(obj, rest)
    raised = 0.1 * (rest[:, 1:2] > 0) * [0, 0, 1]
    add_key(obj, "Lift", np.where(np.arange(len(rest))[:, None] == np.argmax(rest[:, 1]), np.nan, raised))
    add_key(obj, "Both", raised)
    add_key(obj, "On Lift", raised).relative_key = obj.data.shape_keys.key_blocks["Lift"]
    color = obj.data.color_attributes.new("Tint", "FLOAT_COLOR", "POINT")
    color.data[3].color[0] = np.nan
    assert symmetrise() == {"FINISHED"}
    assert np.isnan(offsets_of(obj, "Lift")).any(axis=1).sum() == 1
    assert np.isfinite(offsets_of(obj, "Both")).all()
    assert np.isfinite(offsets_of(obj, "On Lift")).all()
    assert offsets_of(obj, "Both")[rest[:, 1] < -0.1].max() > 0.05
    assert sum(np.isnan(point.color).any() for point in color.data) == 1
    notes = capfd.readouterr().out
    assert '"Lift", "On Lift" of "Body" was left out' in notes
    assert '"Tint" of "Body" was left out' in notes
    obj.shape_key_remove(obj.data.shape_keys.key_blocks["Both"])
    with pytest.raises(RuntimeError, match='"Lift", "On Lift" of "Body" was left out'):
        symmetrise(symmetrise_weights=False, symmetrise_colors=False)


def test_bad_input_changes_nothing(body):
    obj, rest = body
    for words, prepare in (
        ("carries nothing", lambda: None),
        ("shares its mesh", lambda: bpy.data.objects.new("Sharer", obj.data)),
    ):
        prepare()
        before = snapshot()
        with pytest.raises(RuntimeError, match=words):
            symmetrise()
        assert snapshot() == before
    with pytest.raises(RuntimeError, match="no object called"):
        symmetrise(object="Nobody")
    bpy.context.view_layer.objects.active = None
    with pytest.raises(RuntimeError, match="It is open"):
        symmetrise()
    assert len(positions(obj)) == len(rest)


def test_an_edit_meanwhile_ends_it(body):
    from hiermatch.hiermatch_addon.common.errors import ObjectError
    from hiermatch.hiermatch_addon.transfers.options.symmetrise import SymmetriseSettings
    from hiermatch.hiermatch_addon.transfers.symmetrise import SymmetriseJob

    obj, rest = body
    add_legs(obj, rest)
    job = SymmetriseJob(bpy.context, obj, SymmetriseSettings())
    while not job.advance(0):
        pass
    obj.data.vertices[0].co.x += 1
    with pytest.raises(ObjectError, match="edited meanwhile"):
        job.finish()
    obj.vertex_groups.clear()
    bpy.data.objects.remove(obj)
    with pytest.raises(ObjectError, match="deleted meanwhile"):
        job.advance(0)


def test_names_of_sides():
    pairs = {"Arm.L": "Arm.R", "hand_l": "hand_r", "LeftFoot": "RightFoot", "rig:LeftArm": "rig:RightArm"}
    for left, right in pairs.items():
        assert (flipped_name(left), flipped_name(right)) == (right, left)
        assert (side_of(left), side_of(right)) == (1, -1)
    for name in ("Spine", "lip_lower", "rig:Head"):
        assert flipped_name(name) == name
        assert side_of(name) == 0
    assert partners(["Arm.L", "Spine", "Arm.R", "Leg.R"]).tolist() == [2, 1, 0, -1]
