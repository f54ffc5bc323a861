# SPDX-License-Identifier: GPL-3.0-or-later
"""The manifest, and what is in the zips."""

import json
import subprocess
import tomllib
import zipfile
from pathlib import Path

import pytest

from tools.build_package import PackageError, build_with_wheels, build_without_wheels, validate
from tools.fetch_wheels import LOCK, read_lock

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))


def contents(path):
    """Return every file of a zip by its name."""
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_manifest_is_valid():
    assert "Success" in validate(ROOT)


def test_validation_refuses_a_wrong_manifest(tmp_path):
    text = (ROOT / "blender_manifest.toml").read_text(encoding="utf-8")
    (tmp_path / "__init__.py").touch()
    (tmp_path / "blender_manifest.toml").write_text(text.replace('"Mesh"', '"NotATag"'), encoding="utf-8")
    with pytest.raises(PackageError, match="NotATag"):
        validate(tmp_path)


def test_manifest_and_project_name_one_version():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert (MANIFEST["id"], MANIFEST["version"]) == (project["name"], project["version"])


def test_manifest_lists_the_locked_wheels():
    assert MANIFEST["wheels"] == [f"./wheels/{wheel.filename}" for wheel in read_lock()]


def test_every_platform_has_a_wheel_for_every_python(packed_names):
    assert {name.replace("_", "-") for name in packed_names} == set(MANIFEST["platforms"])
    for platform, names in packed_names.items():
        wheels = [name for name in names if name.endswith(".whl")]
        assert sorted(name.split("-")[2] for name in wheels) == ["cp311", "cp313"], platform


def test_scipy_is_the_version_the_engine_is_tested_with():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    lock = json.loads(LOCK.read_text(encoding="utf-8"))
    assert lock["project"] == "scipy"
    assert f"scipy=={lock['version']}" in project["dependency-groups"]["dev"]


def test_zips_hold_the_runtime_and_nothing_else(packed_names):
    """Every source file of the two packages, the demo cats, the root's own files, the platform's wheels."""
    sources = {
        path.relative_to(ROOT).as_posix()
        for package in ("engine", "hiermatch_addon")
        for path in (ROOT / package).rglob("*.py")
    }
    assert "engine/mesh/triangle_mesh.py" in sources
    sources.add("hiermatch_addon/demo/demo_cats.npz")
    for names in packed_names.values():
        wheels = {name for name in names if name.startswith("wheels/")}
        assert names - wheels == sources | {"__init__.py", "blender_manifest.toml", "LICENSE"}
        assert {f"./{name}" for name in wheels} <= set(MANIFEST["wheels"])


def test_numpy_never_travels(packed_names):
    assert not [name for names in packed_names.values() for name in names if "numpy" in name.lower()]


def test_zips_are_valid(packages):
    for path in packages.values():
        assert "Success" in validate(path)


def test_building_twice_gives_the_same_content(package, tmp_path):
    again = next(path for path in build_with_wheels(tmp_path) if path.name == package.name)
    assert contents(again) == contents(package)


def test_old_zips_do_not_survive_a_build(tmp_path):
    (tmp_path / "hiermatch-0.0.1.zip").touch()
    (tmp_path / "notes.zip").touch()
    built = build_without_wheels(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"notes.zip", *(path.name for path in built)}


def test_package_without_wheels_differs_by_the_wheels_only(package, tmp_path):
    (bare,) = build_without_wheels(tmp_path)
    full, without = contents(package), contents(bare)
    assert set(full) - set(without) == {name for name in full if name.startswith("wheels/")}
    assert all(full[name] == data for name, data in without.items() if name != "blender_manifest.toml")
    manifest = tomllib.loads(without["blender_manifest.toml"].decode())
    assert manifest == {name: value for name, value in MANIFEST.items() if name != "wheels"}


def test_repository_keeps_no_wheel_or_zip():
    git = ["git", "-C", str(ROOT), "ls-files"]
    listed = subprocess.run(git, check=False, capture_output=True, text=True)
    if listed.returncode != 0:
        pytest.skip("not a git checkout")
    assert not [name for name in listed.stdout.split() if name.endswith((".whl", ".zip"))]
