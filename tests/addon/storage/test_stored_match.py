# SPDX-License-Identifier: GPL-3.0-or-later
"""A match as it is kept in the file."""

from __future__ import annotations

from dataclasses import fields, replace

import bpy
import numpy as np
import pytest
from hiermatch.engine import MatchQuality, SurfacePoints, TriangleMesh
from hiermatch.engine.dense.quality import overlap_sentence
from hiermatch.hiermatch_addon.scene.mesh_io import topology
from hiermatch.hiermatch_addon.storage.landmark_names import landmark_names
from hiermatch.hiermatch_addon.storage.linked_matches import linked_prefixes
from hiermatch.hiermatch_addon.storage.stored_match import Answer, CornerPoints, Quality, StoredMatch, Written

from tests.addon.scenes import add_blob

QUALITIES = (Quality(0.9, 0.1, 0.8, 0.01, None, 0.7, "Good."), Quality(0.8, 0.2, 0.7, 0.02, 1.5, 0.6, "Fair."))


def points(random, count):
    return CornerPoints(random.integers(0, 500, (count, 3)), random.dirichlet([1, 1, 1], count))


NAMES = ("direct", "mirrored", "turned 1", "turned 2")


def stored(count=5, answers=2, seed=4, **changes):
    random = np.random.default_rng(seed)
    made = StoredMatch(
        names=("Cat", "Lion"),
        topologies=("a", "b"),
        positions=("c", "d"),
        written=Written(use_modifiers=False, vertex_groups=True, match_colors=False, distortion=True, dense=True),
        source_points=points(random, count),
        answers=tuple(
            Answer(
                name,
                points(random, count),
                random.uniform(size=count),
                0.5 + k,
                0.8 - k,
                k == 0,
                0.25 * k,
                QUALITIES[k % 2],
            )
            for k, name in enumerate(NAMES[:answers])
        ),
        chosen=answers // 2,
        notes=("One thing.", "Another thing."),
    )
    return replace(made, **changes)


def same(one, other):
    """Compare dataclasses with arrays in them."""
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other)
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if hasattr(one, "__dataclass_fields__"):
        return type(one) is type(other) and all(same(vars(one)[name], vars(other)[name]) for name in vars(one))
    return type(one) is type(other) and one == other


@pytest.mark.parametrize("answers", [1, 2, 4])
@pytest.mark.parametrize("count", [1, 1024])
def test_comes_back_from_blender_as_it_was(count, answers):
    before = stored(count, answers)
    mesh = bpy.data.meshes.new("Keeper")
    mesh["source"], mesh["target"] = before.to_plain()
    after = StoredMatch.from_plain(mesh["source"].to_dict(), mesh["target"].to_dict())
    assert same(before, after)
    assert mesh["source"]["points"]["barycentric"].typecode == "d"
    assert mesh["source"]["points"]["corners"].typecode == "i"


def test_maps_that_were_not_made_have_no_quality():
    before = stored()
    before = replace(before, answers=(before.answers[0], replace(before.answers[1], quality=None)))
    assert same(StoredMatch.from_plain(*before.to_plain()), before)


def test_a_match_of_an_older_version_can_be_read():
    source, target = stored().to_plain()
    for side in (source, target):
        del side["positions"], side["swapped"]
    for name in ("confidence", "dense"):
        del source["written"][name]
    for answer in source["answers"].values():
        del answer["quality"]
    after = StoredMatch.from_plain(source, target)
    assert not after.written.dense
    assert not after.swapped
    assert after.key == stored().key


def test_without_notes():
    assert StoredMatch.from_plain(*stored(notes=()).to_plain()).notes == ()


def test_the_key_is_of_the_answers_and_the_objects():
    key = stored().key
    assert stored().key == key
    assert stored(chosen=0, swapped=True).key == key  # else a flipped or swapped match would not find itself
    others = [
        stored(seed=5),
        stored(answers=1),
        stored(names=("Cat", "Tiger")),
        stored(names=("CatL", "ion")),
        stored(topologies=("a", "c")),
    ]
    assert len({key, *(other.key for other in others)}) == len(others) + 1


def test_the_nearest_corner_is_the_engines():
    random = np.random.default_rng(1)
    mesh = TriangleMesh(random.normal(size=(9, 3)), np.arange(9).reshape(3, 3))
    surface = SurfacePoints.from_barycentric(mesh, np.array([2, 0, 1, 1]), random.dirichlet([1, 1, 1], 4))
    assert CornerPoints.of(surface).nearest_vertices.tolist() == surface.nearest_vertices.tolist()


class TestTopology:
    def test_shape_and_material_do_not_matter(self):
        obj = add_blob("Blob")
        before = topology(obj.data)
        for vertex in obj.data.vertices:
            vertex.co *= 1.5
        obj.data.polygons[3].use_smooth = True
        assert topology(obj.data) == before
        assert topology(obj.data.copy()) == before

    def test_more_faces_turned_faces_and_other_ngons_matter(self):
        before = topology(add_blob("Blob").data)
        turned, loose = add_blob("Turned").data, add_blob("Loose").data
        turned.flip_normals()
        loose.vertices.add(1)
        quads, triangles = bpy.data.meshes.new("Quad"), bpy.data.meshes.new("Triangles")
        corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)]
        quads.from_pydata(corners, [], [(0, 1, 2, 3), (1, 4, 5)])
        triangles.from_pydata(corners, [], [(0, 1, 2), (3, 1, 4, 5)])  # the same corners in another rhythm
        meshes = (turned, loose, add_blob("Finer", 22, 14).data, quads, triangles)
        assert len({before, *map(topology, meshes)}) == 6


def test_all_of_the_engines_verdict_is_kept():
    assert [field.name for field in fields(Quality)] == [field.name for field in fields(MatchQuality)]
    verdict = MatchQuality(
        0.9, 0.1, 0.8, 0.01, None, 0.7, "Good.", source_coverage=0.6, likeness=12.5, pieces_alone=0.2
    )
    assert vars(Quality.from_plain(Quality.of(verdict).to_plain())) == vars(verdict)


def said(shares):
    return overlap_sentence(shares, credible=True)


def test_what_is_told_of_a_swapped_match_is_told_of_the_same_mesh():
    holes = "The {} had 3 small holes: they were closed for matching."
    match = stored(answers=1, notes=(holes.format("source"), "Nothing of any mesh."))
    quality = replace(match.answer.quality, source_coverage=0.5, coverage=1.0, sentence=said((0.5, 1.0)))
    match = match.with_answer(replace(match.answer, quality=quality))
    assert match.told == (quality, match.notes)
    seen, notes = replace(match, swapped=True).told
    assert (seen.source_coverage, seen.coverage) == (1.0, 0.5)
    assert seen.sentence == said((1.0, 0.5)) != quality.sentence
    assert seen.confidence == quality.confidence
    assert notes == (holes.format("target"), "Nothing of any mesh.")


def test_names_in_notes_stay_as_they_are():
    notes = ('Hide what "my source mesh" has not, as the source has.',)
    assert stored(notes=notes, swapped=True).told[1] == ('Hide what "my source mesh" has not, as the target has.',)


def test_what_a_later_version_keeps_beside_is_left_aside():
    match = stored()
    source, target = match.to_plain()
    for plain in (source, target, source["written"], *source["answers"].values()):
        plain["later"] = 1.0
    for answer in source["answers"].values():
        answer["quality"]["later"] = 1.0
    assert same(StoredMatch.from_plain(source, target), match)


def test_properties_of_others_are_no_names_and_no_matches():
    blob = add_blob("Blob")
    for name in ("HM Landmark Names", "hiermatch_linked"):
        for value in (1, "mine", {"a": {"b": 1}}):
            blob.data[name] = value
            assert landmark_names(blob) == {}
            assert linked_prefixes(blob) == ()
