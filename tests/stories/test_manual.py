# SPDX-License-Identifier: GPL-3.0-or-later
"""A reader's story: the scripts of the manual, as they stand there, one after the other."""

import importlib.util
import re
from pathlib import Path

import pytest

from tests.stories.blender_session import blender_session

ROOT = Path(__file__).resolve().parents[2]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="Blender as a module is not installed"),
]


def scripts(page, containing="bpy.ops"):
    """The blocks of a page that call Blender, or contain something else."""
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    return [block for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if containing in block]


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """A rigged creature, Hero or Cat, and others in poses, with the names that the pages use, in a saved file."""
    with blender_session() as bpy:
        from tests.addon.rigs import add_rigged, add_target

        monkeypatch.chdir(tmp_path)
        hero, _ = add_rigged("Hero")
        names = ("Scan", "LOD1")
        for name, part in zip(names, (0.4, -0.4), strict=True):
            add_target(hero, name, part=part)
        crowd = bpy.data.collections.new("Crowd")
        crowd.objects.link(bpy.data.objects["LOD1"])
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "file.blend"))
        yield bpy


def test_scripts(scene, tmp_path, capsys):
    for block in scripts("scripts"):
        exec(block.replace("407", "12"), {})  # noqa: S102 - the page's own, but for meshes that are numbered alike
    assert (tmp_path / "hero_scan.npz").exists()
    assert "LOD1" in capsys.readouterr().out
    assert "HM Map Weights" in scene.data.objects["Scan"].data.attributes


def test_retargeting(scene):
    metarig = scene.data.objects["Hero Rig"].copy()  # a rig that stands in the source without moving it
    metarig.name = "metarig"
    scene.context.collection.objects.link(metarig)
    (block,) = scripts("retargeting")
    exec(block, {})  # noqa: S102 - the page's own
    assert "Wrap to Scan" in scene.data.objects["Hero"].data.shape_keys.key_blocks


def test_steering(scene, tmp_path):
    for name, new in (("Hero", "Cat"), ("Scan", "Lion")):
        obj = scene.data.objects[name]
        obj.name = new
        obj.vertex_groups.new(name={"Cat": "Collar", "Lion": "Mane"}[new]).add([0, 1, 2], 1.0, "REPLACE")
    (block,) = scripts("steering")
    exec(block.replace("4711", "121"), {})  # noqa: S102 - the page's own, but for a mesh with fewer vertices
    assert (tmp_path / "landmarks.json").exists()
    assert "HM Checker" in scene.data.objects["Lion"].data.color_attributes


def test_symmetric_tools(scene):
    (block,) = scripts("symmetric-tools")
    exec(block, {})  # noqa: S102 - the page's own
    assert scene.data.objects["Hero"].vertex_groups


def test_the_engine_alone():
    from engine import TriangleMesh
    from tests.shapes import creature
    from tests.skeletons import creature_bones, creature_weights

    rest, faces, _ = creature(0.0, 8)
    posed, _, _ = creature(0.3, 8)
    _, parents, heads, tails = creature_bones()
    names = {
        "source": TriangleMesh(rest, faces),
        "target": TriangleMesh(posed, faces),
        "weights": creature_weights(rest),
    }
    names |= {"parents": parents, "heads": heads, "tails": tails, "offsets": 0.01 * rest[None]}
    (retargeting,) = scripts("retargeting", "from engine")
    exec(retargeting, names)  # noqa: S102 - the page's own
    assert names["rig"].heads.shape == heads.shape
    (symmetric,) = scripts("symmetric-tools", "from engine")
    exec(symmetric, names)  # noqa: S102 - the page's own
    assert len(names["mirror"].nearest_vertices) == len(rest)
