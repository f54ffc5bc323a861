# SPDX-License-Identifier: GPL-3.0-or-later
"""Pythons that have Blender as a module, the NumPy that this Blender ships, and nothing more: above all no SciPy."""

import platform
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# How the name of the zip for this machine ends.
PLATFORM = {
    ("Linux", "x86_64"): "linux_x64",
    ("Darwin", "arm64"): "macos_arm64",
    ("Darwin", "x86_64"): "macos_x64",
    ("Windows", "AMD64"): "windows_x64",
}[platform.system(), platform.machine()]

NUMPY_OF_BLENDER = {"4.2.23": "1.24.3", "4.5.15": "1.26.4", "5.0.1": "1.26.4"}


def python_with_bpy(version: str) -> Path:
    """Return the interpreter of ``.envs/bpy-VERSION``, made on first use (some 400 MB to download) and kept."""
    folder = ROOT / ".envs" / f"bpy-{version}"
    python = folder / "bin" / "python"
    requirements = [f"bpy=={version}", f"numpy=={NUMPY_OF_BLENDER[version]}"]
    stamp = folder / "installed"
    if not (stamp.is_file() and stamp.read_text(encoding="utf-8").split() == requirements):
        subprocess.run([sys.executable, "-m", "venv", "--clear", "--without-pip", str(folder)], check=True)
        # The pip of the development environment is the pinned one.
        pip = [sys.executable, "-m", "pip", "--python", str(folder), "--disable-pip-version-check", "install"]
        subprocess.run([*pip, "--quiet", *requirements], check=True)
        stamp.write_text("\n".join(requirements), encoding="utf-8")
    return python
