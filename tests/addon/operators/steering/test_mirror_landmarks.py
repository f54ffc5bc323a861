# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.mirror_landmarks`."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import pytest
from hiermatch.engine import Progress
from hiermatch.hiermatch_addon.jobs import landmark_mirroring
from hiermatch.hiermatch_addon.storage.landmarks import add_landmarks, find_landmarks
from mathutils import Vector
from scipy.spatial import cKDTree

from tests.addon.scenes import add_symmetric_pair


def mirrored(mesh):
    """Take each vertex to the one that is nearest to its mirror image."""
    images = cKDTree(mesh.vertices).query(mesh.vertices * [1, -1, 1])[1]
    yield Progress(0.5, "Looking")
    return as_map(images)


def as_map(images, confidence=1.0):
    """Stand for a left-right map."""
    return SimpleNamespace(
        source_to_target=SimpleNamespace(nearest_vertices=images), quality=SimpleNamespace(confidence=confidence)
    )


class TestMirror:
    @pytest.mark.parametrize("confidence", [0.98, 0.4])
    def test_meshes_that_are_hardly_symmetric_are_named(self, monkeypatch, capfd, confidence):
        def unsure(mesh):
            found = yield from mirrored(mesh)
            return as_map(found.source_to_target.nearest_vertices, confidence)

        monkeypatch.setattr(landmark_mirroring, "symmetry_map_steps", unsure)
        pair = add_symmetric_pair()
        state = bpy.context.scene.hiermatch
        state.source, state.target = pair
        add_landmarks(*pair, [tuple(max(o.data.vertices, key=lambda vertex: vertex.co.y).index for o in pair)])
        bpy.ops.hiermatch.mirror_landmarks()
        said = capfd.readouterr().out
        assert ("is hardly symmetric" in said) == (confidence < 0.5)
        bpy.ops.hiermatch.mirror_landmarks()
        assert "Nothing to mirror" in capfd.readouterr().out

    def test_to_the_other_side(self, monkeypatch):
        monkeypatch.setattr(landmark_mirroring, "symmetry_map_steps", mirrored)
        pair = add_symmetric_pair()
        state = bpy.context.scene.hiermatch
        state.source, state.target = pair
        left = [max(obj.data.vertices, key=lambda vertex: vertex.co.y).index for obj in pair]
        top = [max(obj.data.vertices, key=lambda vertex: vertex.co.z).index for obj in pair]
        add_landmarks(*pair, [tuple(left), tuple(top)])
        bpy.ops.hiermatch.mirror_landmarks()
        landmarks = find_landmarks(*pair)
        assert len(landmarks) == 3
        for obj, vertex, before in zip(pair, (landmarks[2].source, landmarks[2].target), left, strict=True):
            place = obj.data.vertices[before].co * Vector((1, -1, 1))
            assert (obj.data.vertices[vertex].co - place).length < 1e-3
        bpy.ops.hiermatch.mirror_landmarks()
        assert find_landmarks(*pair) == landmarks

    def test_what_contradicts_the_match_is_left_out(self, dense_pair, monkeypatch):
        def turned(mesh):
            """Mirror the source, and turn the target, which has more vertices, upside down."""
            signs = [1, -1, 1] if mesh.vertex_count == len(dense_pair[0].data.vertices) else [1, -1, -1]
            centre = mesh.vertices.mean(axis=0)
            images = cKDTree(mesh.vertices).query((mesh.vertices - centre) * signs + centre)[1]
            yield Progress(0.5, "Looking")
            return as_map(images)

        monkeypatch.setattr(landmark_mirroring, "symmetry_map_steps", turned)
        high = [max(obj.data.vertices, key=lambda vertex: vertex.co.y + 0.6 * vertex.co.z).index for obj in dense_pair]
        add_landmarks(*dense_pair, [tuple(high)])
        bpy.ops.hiermatch.mirror_landmarks()
        assert len(find_landmarks(*dense_pair)) == 1
        monkeypatch.setattr(landmark_mirroring, "symmetry_map_steps", mirrored)
        bpy.ops.hiermatch.mirror_landmarks()
        assert len(find_landmarks(*dense_pair)) == 2

    def test_nothing_to_mirror(self, pair):
        assert pair
        with pytest.raises(RuntimeError, match="no landmarks in common"):
            bpy.ops.hiermatch.mirror_landmarks()
