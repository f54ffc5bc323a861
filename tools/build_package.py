# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the extension zips with Blender's own packaging command and validate them.

    python -m tools.build_package                    one zip per platform, SciPy inside, into build/package
    python -m tools.build_package --without-wheels   for a Blender that has its own SciPy, into build/package-no-wheels

The command comes with the bpy wheel, so that no Blender is needed.
"""

from __future__ import annotations

import argparse
import importlib.util
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from .fetch_wheels import ROOT, WheelError, fetch_wheels

MANIFEST = "blender_manifest.toml"
# Below Blender's folder of scripts: the packaging command, and the tags that the extensions site knows.
BLENDER_EXT = "addons_core/bl_pkg/cli/blender_ext.py"
TAGS = "modules/_bpy_internal/extensions/tags.py"


class PackageError(Exception):
    """Blender's packaging command refused something."""


def build_with_wheels(output: Path) -> list[Path]:
    """Build one zip per platform of the manifest into the folder `output`, and return their paths."""
    fetch_wheels()
    return _build(ROOT, output, split=True)


def build_without_wheels(output: Path) -> list[Path]:
    """Build one zip without any wheel into the folder `output`, and return its path in a list."""
    with tempfile.TemporaryDirectory() as temporary:
        stage = Path(temporary, "source")
        shutil.copytree(ROOT, stage, ignore=shutil.ignore_patterns(".*", "build", "tests", "wheels"))
        manifest = stage / MANIFEST
        text = manifest.read_text(encoding="utf-8")
        manifest.write_text(re.sub(r"^wheels = \[.*?^\]\n", "", text, flags=re.MULTILINE | re.DOTALL), encoding="utf-8")
        if "wheels" in tomllib.loads(manifest.read_text(encoding="utf-8")):
            raise PackageError(f"The list of wheels in {MANIFEST} is not written as this tool expects it.")
        return _build(stage, output, split=False)


def validate(path: Path) -> str:
    """Validate a zip or a source folder, its tags too, and return what Blender's command says.

    Raises
    ------
    PackageError
        If it is not valid.
    """
    return _blender_ext("validate", f"--valid-tags={_bpy_scripts() / TAGS}", str(path))


def _build(source: Path, output: Path, *, split: bool) -> list[Path]:
    """Build and validate; old zips of this extension are removed first, so that those found afterwards are new."""
    output.mkdir(parents=True, exist_ok=True)
    for old in output.glob("hiermatch-*.zip"):
        old.unlink()
    options = ["--split-platforms"] if split else []
    _blender_ext("build", f"--source-dir={source}", f"--output-dir={output}", *options)
    zips = sorted(output.glob("hiermatch-*.zip"))
    for path in zips:
        validate(path)
    return zips


def _bpy_scripts() -> Path:
    """Return the folder of Blender's scripts inside the bpy wheel, without the cost of importing it."""
    spec = importlib.util.find_spec("bpy")
    if spec is None or not spec.submodule_search_locations:
        raise PackageError("The Python that runs this has no bpy: use `make package`.")
    (scripts,) = Path(spec.submodule_search_locations[0]).glob("[0-9]*/scripts")
    return scripts


def _blender_ext(*arguments: str) -> str:
    command = [sys.executable, str(_bpy_scripts() / BLENDER_EXT), *arguments]
    finished = subprocess.run(command, check=False, capture_output=True, text=True)
    said = finished.stdout + finished.stderr
    if finished.returncode != 0:
        raise PackageError(f"Blender's packaging command refused to {' '.join(arguments)}:\n{said}")
    return said


def main() -> int:
    """Build the zips and list them."""
    parser = argparse.ArgumentParser(description="Build and validate the extension zips.")
    parser.add_argument("--without-wheels", action="store_true", help="leave SciPy out, for a Blender that has its own")
    parser.add_argument("--output-dir", type=Path, help="where the zips go, replacing older ones")
    arguments = parser.parse_args()
    build = build_without_wheels if arguments.without_wheels else build_with_wheels
    default = ROOT / "build" / ("package-no-wheels" if arguments.without_wheels else "package")
    try:
        zips = build(arguments.output_dir or default)
    except (PackageError, WheelError) as error:
        print(error, file=sys.stderr)
        return 1
    for path in zips:
        print(f"{path.stat().st_size / 1e6:6.1f} MB  {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
