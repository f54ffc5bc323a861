# SPDX-License-Identifier: GPL-3.0-or-later
"""What no match can be made of: it is refused in words, before the work."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from engine import (
    ClosestPoints,
    GeodesicSolver,
    MatchError,
    MatchSettings,
    MeshError,
    RetrievalSettings,
    SettingsError,
    Shape,
    SurfaceMap,
    TriangleMesh,
    find_symmetry,
    match,
    match_steps,
    nearest_regions,
    refine_map,
    retrieve,
    symmetry_map,
)
from tests.shapes import creature, plane

QUICK = MatchSettings(points=40, samples=200, dense=False)


@pytest.fixture(scope="module")
def body():
    """A body."""
    return TriangleMesh(*creature(0.0, resolution=8)[:2])


@pytest.mark.parametrize(
    "given",
    [
        lambda mesh: symmetry_map(mesh.vertices),
        lambda mesh: Shape(mesh.vertices),
        lambda mesh: GeodesicSolver(mesh.vertices),
        lambda mesh: ClosestPoints(mesh.vertices),
        lambda mesh: nearest_regions(mesh.vertices, [0]),
        lambda mesh: refine_map(Shape(mesh), mesh, SurfaceMap.identity(mesh), [[0, 0]]),
    ],
)
def test_no_mesh_is_refused_in_the_same_words_everywhere(body, given):
    with pytest.raises(MeshError, match=r"is of the type (ndarray|Shape).*TriangleMesh\(vertices, triangles\)"):
        given(body)


@pytest.mark.parametrize("settings", [{"points": 40}, "quick", RetrievalSettings(), MatchSettings()], ids=str)
def test_settings_of_something_else_are_refused_in_the_same_words_everywhere(body, settings):
    mesh = body
    entries = {
        MatchSettings: (partial(match, mesh, mesh), partial(find_symmetry, mesh), partial(symmetry_map, mesh)),
        RetrievalSettings: (partial(retrieve, mesh, [mesh]),),
    }
    for kind, functions in entries.items():
        for function in functions if not isinstance(settings, kind) else ():
            with pytest.raises(
                SettingsError, match=rf"type {type(settings).__name__}.*{kind.__name__}\(\*\*settings\)"
            ):
                function(settings)


def test_what_is_no_pair_is_refused_in_words(body):
    mesh, mask = body, np.zeros(body.vertex_count, bool)
    for pairs in [[0, 1], [2]], [[0, 1, 2]], [[0.5, 1.0]]:
        with pytest.raises(MatchError, match="Landmarks should be pairs"):
            match(mesh, mesh, QUICK, landmarks=pairs)
        with pytest.raises(MatchError, match="Landmarks should be pairs"):
            refine_map(mesh, mesh, SurfaceMap.identity(mesh), pairs)
    for excluded in None, mask, (mask,), 3:
        with pytest.raises(MatchError, match="left out should be a pair"):
            match(mesh, mesh, QUICK, excluded=excluded)
        with pytest.raises(MatchError, match="left out should be a pair"):
            refine_map(mesh, mesh, SurfaceMap.identity(mesh), [[0, 0]], excluded=excluded)


@pytest.mark.parametrize("settings", [replace(QUICK, dense=True), QUICK])
def test_what_has_too_few_vertices_is_refused_before_the_work(body, settings):
    small = TriangleMesh(*plane(3))
    told = []
    with pytest.raises(MatchError, match="12 points cannot be matched: the source has only 9 vertices"):
        told.extend(each.fraction for each in match_steps(small, body, replace(settings, points=12)))
    assert max(told, default=0) <= 0.06


def test_one_shape_or_some_that_come_in_turn_are_a_list(body):
    settings = RetrievalSettings(points=20, samples=40)
    for shapes in body, [body], (each for each in [body]):
        assert retrieve(body, shapes, settings).order.tolist() == [0]


def test_no_alternatives_are_none_however_few_are_asked_for(body):
    assert find_symmetry(body, replace(QUICK, points=20, samples=60), alternatives=-1).alternatives == ()


def test_a_word_is_no_array():
    with pytest.raises(SettingsError, match="must be one of"):
        MatchSettings(metric=np.array(["geodesic", "diffusion"]))
