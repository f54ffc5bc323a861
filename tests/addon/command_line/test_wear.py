# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `wear`."""

from __future__ import annotations

import json

import bpy
from hiermatch.hiermatch_addon.command_line.meshes import MeshArgument, load_meshes
from hiermatch.hiermatch_addon.command_line.program import main

from tests.addon.garments import add_item
from tests.addon.rigs import add_armature
from tests.addon.scenes import QUICK


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


def test_a_body_of_a_library_is_dressed_as_long_as_nothing_is_written_on_it(dense_pair, tmp_path, capsys):
    add_item(dense_pair[0], "Shirt", 0.02)
    library, report = str(tmp_path / "bodies.blend"), tmp_path / "report.json"
    bpy.data.libraries.write(library, {dense_pair[1]}, fake_user=True)
    bpy.data.objects.remove(dense_pair[1])
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = ["Target"]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "pair.blend"))
    arguments = [f"{tmp_path / 'pair.blend'}:{name}" for name in ("Source", "Target")]
    arguments += ["--no-refine", "--items=Shirt", f"--output={tmp_path / 'out.blend'}"]
    arguments += [f"--{name.replace('_', '-')}={value}" for name, value in QUICK.items() if name != "dense"]
    assert main(["wear", *arguments, "--wear-hide=key"]) == 1
    assert "is linked from" in capsys.readouterr().err
    arguments += ["--accept-doubtful", f"--output={tmp_path / 'out.glb'}", f"--map={tmp_path / 'map.npz'}"]
    assert main(["wear", *arguments, f"--report={report}"]) == 0
    assert bpy.data.objects["Shirt on Target"]["hiermatch_body"] == "Target"
    assert 'map.npz" was not written' in capsys.readouterr().err
    assert (tmp_path / "out.glb").is_file()
    assert 0 < json.loads(report.read_text())["carried"][0]["confidence"] <= 1


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
