# SPDX-License-Identifier: GPL-3.0-or-later
"""Matched points judged one by one, and a match refined around them."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.operators.steering.landmark_picking import selected_vertices
from hiermatch.hiermatch_addon.storage.landmarks import add_landmarks, find_landmarks
from hiermatch.hiermatch_addon.storage.stored_map import find_maps

from tests.addon.scenes import QUICK, add_blob, snapshot, values_of, weights_of


def steering():
    return bpy.context.scene.hiermatch_steering


def groups(obj):
    return [group.name for group in obj.vertex_groups]


class TestList:
    def test_it_is_filled_by_a_match_and_emptied(self, sparse_pair):
        rows = steering().pairs
        assert sorted(row.number for row in rows) == list(range(1, 13))
        for row in rows:
            for obj, vertex in zip(sparse_pair, (row.source, row.target), strict=True):
                weights = weights_of(obj)[row.name]
                assert weights[vertex] == max(weights.values())
        bpy.ops.hiermatch.clear()
        assert not len(steering().pairs)

    def test_it_follows_a_swap(self, dense_pair):
        bpy.ops.hiermatch.swap()
        before = {row.number: (row.source, row.target) for row in steering().pairs}
        bpy.ops.hiermatch.swap()
        assert {row.number: (row.target, row.source) for row in steering().pairs} == before
        assert len(before) == 24
        assert dense_pair

    def test_an_edited_mesh_has_none(self, sparse_pair):
        sparse_pair[0].data.vertices.add(1)
        bpy.ops.hiermatch.swap()
        assert not len(steering().pairs)


class TestPairs:
    def test_lock_and_unlock(self, sparse_pair):
        row = steering().pairs[0]
        expected = (row.source, row.target)
        bpy.ops.hiermatch.lock_pair()
        (landmark,) = find_landmarks(*sparse_pair)
        assert (landmark.source, landmark.target) == expected
        assert [row.locked for row in steering().pairs] == [True] + [False] * 11
        bpy.ops.hiermatch.lock_pair()
        assert not find_landmarks(*sparse_pair)
        assert not any(row.locked for row in steering().pairs)

    def test_select(self, sparse_pair):
        number = steering().pairs[3].number
        bpy.ops.hiermatch.select_pair(number=number)
        assert steering().pair_index == 3
        for obj in sparse_pair:
            obj.select_set(state=True)
        bpy.context.view_layer.objects.active = sparse_pair[0]
        bpy.ops.object.mode_set(mode="EDIT")
        row = steering().pairs[3]
        assert [selected_vertices(obj) for obj in sparse_pair] == [[row.source], [row.target]]

    def test_remove(self, sparse_pair):
        before = [weights_of(obj) for obj in sparse_pair]
        bpy.ops.hiermatch.remove_pair(number=5)
        bpy.ops.hiermatch.remove_pair(number=2)
        for obj, weights in zip(sparse_pair, before, strict=True):
            assert weights_of(obj) == {name: w for name, w in weights.items() if name not in ("HM.002", "HM.005")}
        assert sorted(row.number for row in steering().pairs) == [1, 3, 4, 6, 7, 8, 9, 10, 11, 12]
        bpy.ops.hiermatch.clear()
        assert not groups(sparse_pair[0])

    def test_removed_points_stay_away(self, dense_pair):
        bpy.ops.hiermatch.swap()
        bpy.ops.hiermatch.swap()
        before = {row.number: (row.source, row.target) for row in steering().pairs}
        bpy.ops.hiermatch.remove_pair(number=5)
        bpy.ops.hiermatch.flip()
        assert len(groups(dense_pair[0])) == 23
        assert "HM.005" not in groups(dense_pair[1])
        after = {row.number: (row.source, row.target) for row in steering().pairs}
        assert sorted(after) == [number for number in range(1, 25) if number != 5]
        assert all(after[number][0] == before[number][0] for number in after)
        assert any(after[number][1] != before[number][1] for number in after)

    def test_the_two_may_be_named_the_other_way_round(self, dense_pair):
        row = steering().pairs[0]
        expected = (row.source, row.target)
        bpy.ops.hiermatch.lock_pair(source="Target", target="Source", number=row.number)
        (landmark,) = find_landmarks(*dense_pair)
        assert (landmark.source, landmark.target) == expected

    def test_of_another_pair_than_the_picked_one(self, dense_pair):
        bodies = [add_blob("One"), add_blob("Other")]
        bpy.context.scene.hiermatch.source, bpy.context.scene.hiermatch.target = bodies
        bpy.ops.hiermatch.match(**QUICK)
        names = {"source": "Source", "target": "Target"}
        weights = [weights_of(obj)["HM.003"] for obj in dense_pair]
        before = [weights_of(obj) for obj in bodies]
        bpy.ops.hiermatch.lock_pair(**names, number=3)
        (landmark,) = find_landmarks(*dense_pair)
        for vertex, of_point in zip((landmark.source, landmark.target), weights, strict=True):
            assert of_point[vertex] == max(of_point.values())
        bpy.ops.hiermatch.remove_pair(**names, number=3)
        assert [weights_of(obj) for obj in bodies] == before
        assert "HM.003" not in groups(dense_pair[0])
        with pytest.raises(RuntimeError, match="no such matched point"):
            bpy.ops.hiermatch.lock_pair(**names, number=3)
        with pytest.raises(RuntimeError, match="no such matched point"):  # which the list does not show
            bpy.ops.hiermatch.lock_pair(**names)

    def test_no_such_point(self, sparse_pair):
        assert sparse_pair
        before = snapshot()
        for operator in ("lock_pair", "select_pair", "remove_pair"):
            with pytest.raises(RuntimeError, match="no such matched point"):
                getattr(bpy.ops.hiermatch, operator)(number=99)
        assert snapshot() == before


class TestRefine:
    def test_not_around_landmarks_that_are_all_switched_off(self, dense_pair):
        assert dense_pair
        bpy.ops.hiermatch.lock_pair(number=1)
        bpy.context.scene.hiermatch.use_landmarks = False
        before = snapshot()
        with pytest.raises(RuntimeError, match="Use Landmarks is off"):
            bpy.ops.hiermatch.refine()
        assert snapshot() == before

    def test_around_a_landmark(self, dense_pair):
        source, target = dense_pair
        found = find_maps(source, target).maps.of_source
        vertex = 100
        place = int(found.corners[vertex, found.weights[vertex].argmax()])
        co = np.array([v.co for v in target.data.vertices])
        beside = int(np.argsort(np.linalg.norm(co - co[place], axis=1))[6])
        add_landmarks(source, target, [(vertex, beside)])
        colors = values_of(target.data.attributes["HM Match"])
        assert bpy.ops.hiermatch.refine() == {"FINISHED"}
        after = find_maps(source, target).maps
        assert after.of_source.corners[vertex, after.of_source.weights[vertex].argmax()] == beside
        assert after.of_source.weights[vertex].max() == 1
        assert (values_of(target.data.attributes["HM Match"]) != colors).any()
        summary = bpy.context.scene.hiermatch.summary
        assert not summary.stale
        assert not summary.proven
        assert summary.verdict
        assert len(groups(source)) == 24
        assert summary.answers == "direct\nmirrored"

    def test_of_a_pair_that_was_swapped(self, dense_pair):
        add_landmarks(*dense_pair, [(100, 110)])
        bpy.ops.hiermatch.swap()
        bpy.ops.hiermatch.refine()
        maps = find_maps(*dense_pair).maps
        assert maps.of_source.corners[100, maps.of_source.weights[100].argmax()] == 110
        assert maps.of_target.corners[110, maps.of_target.weights[110].argmax()] == 100
        assert bpy.context.scene.hiermatch.summary.source == "Target"

    def test_what_cannot_be_refined(self, dense_pair):
        before = snapshot()
        with pytest.raises(RuntimeError, match="no landmarks that are on"):
            bpy.ops.hiermatch.refine()
        assert snapshot() == before
        add_landmarks(*dense_pair, [(100, 110)])
        dense_pair[0].data.vertices[3].co.x += 1
        with pytest.raises(RuntimeError, match="out of date"):
            bpy.ops.hiermatch.refine()

    def test_without_a_dense_map_or_a_match(self, sparse_pair):
        add_landmarks(*sparse_pair, [(100, 110)])
        with pytest.raises(RuntimeError, match="no dense map to refine"):
            bpy.ops.hiermatch.refine()
        bpy.ops.hiermatch.clear()
        with pytest.raises(RuntimeError, match="no match to refine"):
            bpy.ops.hiermatch.refine()
