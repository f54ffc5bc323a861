# SPDX-License-Identifier: GPL-3.0-or-later
"""An artist's story: a character is matched, the file is closed, opened again, and the match is used and corrected."""

from __future__ import annotations

import importlib.util

import pytest

from tests.stories.blender_session import blender_session

pytestmark = pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="Blender as a module is not installed")


@pytest.fixture
def bpy():
    """Blender with the extension and an empty file."""
    with blender_session() as module:
        yield module


@pytest.mark.slow
def test_a_match_is_kept_used_and_told_to_be_out_of_date(bpy, tmp_path):
    from hiermatch.hiermatch_addon.common.errors import ObjectError
    from hiermatch.hiermatch_addon.properties import freshness

    from tests.addon.scenes import maps_of
    from tools import demo_truth

    def pair():
        state = bpy.context.scene.hiermatch
        return state.source, state.target

    # Two cats in different poses, units and axes are matched.
    bpy.ops.hiermatch.add_demo_pair(source_vertices=1500, target_vertices=1200)
    state = bpy.context.scene.hiermatch
    state.points, state.samples = 32, 128
    names = [obj.name for obj in pair()]
    bpy.ops.hiermatch.match(source=names[0], target=names[1], points=32, samples=128)
    assert state.summary.verdict
    assert state.summary.confidence > 0.5
    maps = maps_of(*pair())
    for way, domain, image in (
        (maps.source_to_target, maps.source, maps.target),
        (maps.target_to_source, maps.target, maps.source),
    ):
        assert way.orientation(domain, image) > 0.9
    errors = demo_truth.match_errors(*pair(), bpy.context.evaluated_depsgraph_get())
    assert errors.direct.mean() < 0.05

    # The file is saved and opened another day; the cats get other names.  The map is still there, without matching.
    path = str(tmp_path / "cats.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    for obj, name in zip(pair(), ("Tom", "Tiger"), strict=True):
        obj.name = name
    again = maps_of(*pair())
    assert (again.target_to_source.corners == maps.target_to_source.corners).all()
    assert (again.target_to_source.barycentric == maps.target_to_source.barycentric).all()

    # The other way round, and back.
    bpy.ops.hiermatch.swap()
    assert (bpy.context.scene.hiermatch.summary.source, pair()[0].name) == ("Tiger", "Tiger")
    swapped = maps_of(*pair())
    assert (swapped.source_to_target.corners == maps.target_to_source.corners).all()
    bpy.ops.hiermatch.swap()

    # One cat is edited: the match says so, until it is made again.
    tiger = pair()[1]
    tiger.data.vertices[0].co *= 1.01
    freshness.refresh(bpy.context.scene)
    assert 'The match is out of date: "Tiger" was edited since' in bpy.context.scene.hiermatch.summary.stale
    with pytest.raises(ObjectError, match="out of date"):
        maps_of(*pair())
    bpy.ops.hiermatch.match(source="Tom", target="Tiger", points=32, samples=128)
    assert not bpy.context.scene.hiermatch.summary.stale
    assert maps_of(*pair())

    # In the end everything is taken away.
    bpy.ops.hiermatch.clear()
    for obj in pair():
        assert not [name for name in obj.data.attributes.keys() if name.startswith("HM ")]  # noqa: SIM118
        assert not obj.vertex_groups.keys() or not obj.vertex_groups.keys()[0].startswith("HM.")
        assert "hiermatch" not in obj.data
