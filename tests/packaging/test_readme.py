# SPDX-License-Identifier: GPL-3.0-or-later
"""The README names things that exist, and its calls are right."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")

# Folders that the commands make; everything else that the README names is in the repository.
MADE = (".venv", ".envs", "build/")

# What the README's engine call expects to be there: a body without symmetry, finer as source than as target.
BODY = """
import numpy as np
from scipy.spatial import ConvexHull

def body(count):
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, np.pi * (1 + 5**0.5) * k
    sphere = np.stack([np.sqrt(1 - z**2) * np.cos(turn), np.sqrt(1 - z**2) * np.sin(turn), z], axis=1)
    hull = ConvexHull(sphere)
    triangles = hull.simplices.copy()
    a, b, c = (sphere[triangles[:, i]] for i in range(3))
    flipped = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) < 0
    triangles[flipped] = triangles[flipped][:, ::-1]
    limbs = [((1.0, 0.2, 0.1), 2.0, 14.0), ((-0.3, 1.0, -0.2), 1.4, 10.0), ((-0.5, -0.8, 0.3), 1.0, 18.0)]
    axes = [np.array(axis) / np.linalg.norm(axis) for axis, _, _ in limbs]
    radius = 1 + sum(r * np.exp(s * (sphere @ axis - 1)) for axis, (_, r, s) in zip(axes, limbs))
    return sphere * radius[:, None], triangles

vertices_1, triangles_1 = body(1500)
vertices_2, triangles_2 = body(1100)
"""

CHECK = """
assert result.source_points.positions.shape == result.target_points.positions.shape == (64, 3)
assert result.point_distortion.shape == (64,)
assert result.coarse.proven in (True, False)
"""


def code(containing):
    (block,) = (text for text in re.findall(r"```python\n(.*?)```", README, re.DOTALL) if containing in text)
    return block


def test_goals_are_in_the_makefile():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    goals = set(re.findall(r"make ([a-z][a-z-]*)", " ".join(re.findall(r"`[^`]*`|```.*?```", README, re.DOTALL))))
    assert {"demo", "test", "package"} <= goals
    assert goals <= set(makefile.split(".PHONY: ")[1].splitlines()[0].split())


def test_files_are_in_the_repository():
    named = set(re.findall(r"`([\w.]+(?:/[\w.]*)+)`", README))
    assert "tools/wheels.json" in named
    assert [name for name in named if not name.startswith(MADE) and not (ROOT / name).exists()] == []


@pytest.mark.slow
def test_engine_call_runs(tmp_path):
    script = tmp_path / "call.py"
    script.write_text(BODY + code("from engine import") + CHECK, encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    run = subprocess.run([sys.executable, script], check=False, capture_output=True, text=True, env=environment)
    assert run.returncode == 0, run.stderr


def test_operator_is_called_by_its_name_and_options():
    """Against the sources, because the call itself is tried in the installed extension."""
    call = code("import bpy")
    match = re.search(r"bpy\.ops\.(hiermatch\.match)\((.*)\)", call)
    assert match is not None
    sources = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "hiermatch_addon").rglob("*.py"))
    assert f'bl_idname = "{match[1]}"' in sources
    assert set(re.findall(r"(\w+)=", match[2])) == {"source", "target", "points"}


def test_versions_agree_with_the_manifest():
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert f"({manifest['blender_version_min'].removesuffix('.0')} and later)" in README
