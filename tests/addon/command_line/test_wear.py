# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `wear`."""

from __future__ import annotations

import bpy
from hiermatch.hiermatch_addon.command_line.meshes import MeshArgument, load_meshes
from hiermatch.hiermatch_addon.command_line.program import main

from tests.addon.garments import add_item
from tests.addon.rigs import add_armature


def test_a_wardrobe_is_fitted_and_goes_along_into_another_file(dense_pair, tmp_path, capsys):
    closet = bpy.data.collections.new("Closet")
    bpy.context.scene.collection.children.link(closet)
    closet.objects.link(add_item(dense_pair[0], "Shirt", 0.02))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "pair.blend"))
    arguments = [f"{tmp_path / 'pair.blend'}:{name}" for name in ("Source", "Target")]
    arguments += ["--no-refine", f"--output={tmp_path / 'out.glb'}"]
    assert main(["wear", *arguments, "--collection=Closet"]) == 0
    (shirt,), _ = load_meshes([MeshArgument(tmp_path / "out.glb", "Shirt on Target")])
    assert len(shirt.data.vertices) > 100
    assert main(["wear", *arguments, "--collection=Drawer"]) == 1
    assert 'no collection called "Drawer"' in capsys.readouterr().err
    assert main(["wear", *arguments, "--collection=Closet", "--wear-result=key"]) == 1
    assert "Write a .blend, or make fitted copies" in capsys.readouterr().err


def test_items_are_left_out_of_a_source_of_several_objects(dense_pair, tmp_path, capsys):
    rig = add_armature("Rig")
    shirt = add_item(dense_pair[0], "Shirt", 0.02)
    for obj in (dense_pair[0], shirt):
        matrix = obj.matrix_world.copy()
        obj.parent, obj.matrix_world = rig, matrix
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "pair.blend"))
    arguments = [f"{tmp_path / 'pair.blend'}:{name}" for name in ("Rig", "Target")]
    arguments += ["--no-refine", f"--output={tmp_path / 'out.blend'}"]
    assert main(["wear", *arguments]) == 1
    assert "No clothes" in capsys.readouterr().err
    assert main(["wear", *arguments, "--items=Shirt, Scarf"]) == 1
    assert 'no object called "Scarf"' in capsys.readouterr().err
    assert main(["wear", *arguments, '--items=Shirt, "Scarf, red']) == 2
    assert "do not stand around whole names" in capsys.readouterr().err
    assert main(["wear", *arguments, "--items=Shirt", '--items="Scarf, red",Shirt']) == 1
    assert 'no object called "Scarf, red"' in capsys.readouterr().err
    assert main(["wear", *arguments, "--items=Shirt"]) == 0
    fitted = bpy.data.objects["Shirt on Target"]
    assert fitted["hiermatch_body"] == "Target"
