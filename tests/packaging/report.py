# SPDX-License-Identifier: GPL-3.0-or-later
"""What the report of `installed_match.py` must say, whichever Blender wrote it."""

import json
from pathlib import Path

import pytest

from tests.packaging.environments import ROOT
from tools.fetch_wheels import read_lock

WRITTEN = {
    "HM Match",
    "HM Distortion",
    "HM Distortion Value",
    "HM Confidence",
    "HM Map Vertex 1",
    "HM Map Vertex 2",
    "HM Map Vertex 3",
    "HM Map Weights",
    "HM Map Confidence",
}

SCRIPT = ROOT / "tests" / "packaging" / "installed_match.py"


def assert_retargeted(report):
    """Assert that the walking cat has what the standing one has, and that its leg moves without its head."""
    assert report["status"] == ["FINISHED"]
    assert report["bones"] == 27
    assert report["bound"] < 1e-4
    assert report["weight_error"] < 0.15
    leg, head = report["moved"]
    assert leg > 0.05
    assert head < 0.01
    assert report["keys"] == ["Basis", "Well Fed", "Big Nose"]
    assert report["uvs"] == ["UVMap"]
    assert report["notes"] == ""


def assert_matched(path, scipy_below=None):
    """Assert that a match was written to both objects and its points are where they belong, and return the report.

    `scipy_below` is the folder that SciPy must have come from, of the version that is packed.
    """
    report = json.loads(path.read_text(encoding="utf-8"))
    assert report["status"] == ["FINISHED"]
    for groups, attributes in zip(report["groups"], report["attributes"], strict=True):
        assert list(groups) == [f"HM.{number:03d}" for number in range(1, 25)]
        assert all(1 <= group["vertices"] <= 3 for group in groups.values())
        assert [group["weight"] for group in groups.values()] == pytest.approx([1.0] * 24, abs=1e-3)
        assert set(attributes) >= WRITTEN
    # Of the creature's diagonal; its limbs are 0.2 and more apart, so that no limb is taken for another.
    assert report["mean_error"] < 0.05
    # The dense map hits the same places everywhere, as it is read from the file, and is known to fit only these meshes.
    dense = report["dense"]
    assert dense["verdict"].endswith(".")
    assert 0.5 < dense["confidence"] <= 1
    for way in dense["ways"]:
        assert way["mean_error"] < 0.05
        low, high = way["confidence"]
        assert 0 <= low < high <= 1
    untouched, edited = dense["stale"]
    assert untouched == ""
    assert 'The match is out of date: "Target" was edited since' in edited
    assert report["demo"]["status"] == [["FINISHED"]] * 3
    written, left = report["demo"]["groups"]
    assert written - left == 16
    assert_retargeted(report["retarget"])
    # The add-on must not leak its packages to the top level, where Blender reports a policy violation.
    assert report["leaked_modules"] == []
    if scipy_below is not None:
        assert Path(report["scipy"]["file"]).resolve().is_relative_to(scipy_below.resolve())
        assert f"scipy=={report['scipy']['version']}" in {wheel.requirement for wheel in read_lock()}
    return report
