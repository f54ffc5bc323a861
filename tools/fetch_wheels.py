# SPDX-License-Identifier: GPL-3.0-or-later
"""Fetch the SciPy wheels that travel in the extension, exactly those recorded in ``wheels.json``.

    python -m tools.fetch_wheels

pip downloads them, so its index, proxy, certificate and cache settings hold; every file is verified by its recorded
SHA-256.  Nothing is done for wheels that are there and right.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOCK = ROOT / "tools" / "wheels.json"
WHEELS = ROOT / "wheels"


class WheelError(Exception):
    """A wheel could not be had, or is not the one recorded."""


@dataclass(frozen=True)
class Wheel:
    """One locked wheel.

    Attributes
    ----------
    requirement : str
        What pip is asked for, such as ``scipy==1.15.3``.
    filename : str
        The whole name of the file, of the form ``project-version-python-abi-platform.whl``.
    sha256 : str
        Hash of the file, in hexadecimal.
    """

    requirement: str
    filename: str
    sha256: str

    def is_at(self, path: Path) -> bool:
        """Tell whether the file at `path` is this very wheel."""
        return path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == self.sha256


def read_lock(path: Path = LOCK) -> list[Wheel]:
    """Return the wheels recorded in the lock file at `path`."""
    lock = json.loads(path.read_text(encoding="utf-8"))
    requirement = f"{lock['project']}=={lock['version']}"
    return [Wheel(requirement, filename, sha256) for filename, sha256 in lock["sha256"].items()]


def fetch_wheels(lock: Path = LOCK, folder: Path = WHEELS) -> list[Path]:
    """Make sure that every wheel of `lock` is in `folder`, and return the paths of those that had to be downloaded.

    Raises
    ------
    WheelError
        If pip cannot download a wheel, or what it finds has not the recorded hash.  `folder` then holds no wrong file
        of that name.
    """
    missing = [wheel for wheel in read_lock(lock) if not wheel.is_at(folder / wheel.filename)]
    folder.mkdir(parents=True, exist_ok=True)
    return [_download(wheel, folder) for wheel in missing]


def _download(wheel: Wheel, folder: Path) -> Path:
    """Let pip download one wheel, into a temporary folder first so that an interruption leaves nothing half done."""
    target = folder / wheel.filename
    target.unlink(missing_ok=True)
    python, abi, platforms = wheel.filename.removesuffix(".whl").split("-")[-3:]
    with tempfile.TemporaryDirectory(dir=folder) as temporary:
        requirements = Path(temporary, "requirements.txt")
        requirements.write_text(f"{wheel.requirement} --hash=sha256:{wheel.sha256}\n", encoding="utf-8")
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check"]
        command += ["--no-deps", "--only-binary=:all:", "--require-hashes", "--requirement", str(requirements)]
        command += ["--implementation", "cp", "--python-version", python.removeprefix("cp"), "--abi", abi]
        command += ["--platform", platforms.split(".")[0], "--dest", temporary]
        finished = subprocess.run(command, check=False, capture_output=True, text=True)
        downloaded = Path(temporary, wheel.filename)
        if finished.returncode != 0:
            raise WheelError(f"{wheel.filename} could not be downloaded as recorded; pip says:\n{finished.stderr}")
        if not wheel.is_at(downloaded):
            raise WheelError(f"pip brought {sorted(p.name for p in downloaded.parent.iterdir())}, not {wheel.filename}")
        return downloaded.replace(target)


def main() -> int:
    """Fetch the wheels and say what was done."""
    parser = argparse.ArgumentParser(description="Fetch the SciPy wheels recorded in a lock file.")
    parser.add_argument("--lock", type=Path, default=LOCK, help="the lock file (default: tools/wheels.json)")
    parser.add_argument("--folder", type=Path, default=WHEELS, help="where the wheels go (default: wheels)")
    arguments = parser.parse_args()
    try:
        fetched = fetch_wheels(arguments.lock, arguments.folder)
    except WheelError as error:
        print(error, file=sys.stderr)
        return 1
    total = len(read_lock(arguments.lock))
    print(f"{total} wheels in {arguments.folder}: {len(fetched)} downloaded, {total - len(fetched)} there already.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
