# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks as text, to keep them apart from the meshes and to bring them to other files."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.errors import ObjectError
from ..common.file_reading import BAD_FILE, parsed_json
from ..scene.character import own_positions, topology_of
from .landmarks import Landmark

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ..scene.character import Side

_FORMAT = "HierMatch landmarks"
_VERSION = 1

_NEAR = 0.01
"""How far from where it was a vertex may be on a mesh that was changed, in diagonals of its bounding box."""

_ROLES = ("source", "target")


def landmarks_to_text(source: Side, target: Side, landmarks: Sequence[Landmark]) -> str:
    """Write landmarks as JSON: for each its vertices and where these are in the objects' own space.

    Both objects have to be in Object Mode.
    """
    text: dict[str, Any] = {"format": _FORMAT, "version": _VERSION}
    positions = {}
    for role, obj in zip(_ROLES, (source, target), strict=True):
        positions[role] = own_positions(obj)
        text[role] = {"name": obj.name, "vertices": len(positions[role]), "faces": topology_of(obj)}
    text["landmarks"] = [
        {"number": landmark.number, "use": landmark.use, "name": landmark.name}
        | {
            role: {"vertex": vertex, "position": positions[role][vertex].tolist()}
            for role, vertex in zip(_ROLES, (landmark.source, landmark.target), strict=True)
        }
        for landmark in landmarks
    ]
    return json.dumps(text, indent=1)


def landmarks_from_text(text: str, source: Side, target: Side) -> tuple[list[Landmark], list[str]]:
    """Read landmarks from JSON.

    Parameters
    ----------
    text : str
        What `landmarks_to_text` wrote.
    source, target : bpy.types.Object or Character
        The meshes, in Object Mode.  If their vertices are not numbered as they were, those are taken that are where
        the landmarks were.

    Returns
    -------
    landmarks : list of Landmark
        The landmarks on these meshes.
    notes : list of str
        What should be known.

    Raises
    ------
    ObjectError
        If the text is no such file, or a mesh has no vertex where a landmark was.
    """
    try:
        data = parsed_json(text)
        known = data["format"] == _FORMAT and data["version"] <= _VERSION
        rows = [(int(row["number"]), bool(row["use"]), str(row.get("name", ""))) for row in data["landmarks"]]
        sides = [[_place(row[role]) for row in data["landmarks"]] for role in _ROLES]
        digests = [str(data[role]["faces"]) for role in _ROLES]
        if any(len(dict(places)) < len(places) for places in sides):
            raise ValueError("a vertex has two landmarks")
    except BAD_FILE as error:
        raise ObjectError(
            "This is no file of landmarks, or it is damaged. Choose one that Save Landmarks has written."
        ) from error
    if not known:
        raise ObjectError("This file of landmarks is of a newer version of HierMatch. Update the extension.")
    notes: list[str] = []
    columns = []
    for obj, places, digest in zip((source, target), sides, digests, strict=True):
        columns.append(_vertices(obj, places, notes, same=topology_of(obj) == digest))
    return [
        Landmark(number, there, back, use, name)
        for (number, use, name), there, back in zip(rows, *columns, strict=True)
    ], notes


def _place(plain: Any) -> tuple[int, tuple[float, float, float]]:  # noqa: ANN401 - whatever the file holds
    x, y, z = (float(number) for number in plain["position"])
    return int(plain["vertex"]), (x, y, z)


def _vertices(
    obj: Side, places: Sequence[tuple[int, tuple[float, float, float]]], notes: list[str], *, same: bool
) -> list[int]:
    """Find the vertices of landmarks on one mesh."""
    vertices = [vertex for vertex, _ in places]
    positions = own_positions(obj)
    if same and all(0 <= vertex < len(positions) for vertex in vertices):
        return vertices
    found = _nearest(obj, positions, np.array([place for _, place in places], np.float64).reshape(-1, 3))
    notes.append(
        f'"{obj.name}" has other vertices or faces than when the landmarks were saved. They were put on the vertices '
        "where they had been."
    )
    return found


def _nearest(obj: Side, positions: NDArray[np.float64], places: NDArray[np.float64]) -> list[int]:
    reach = _NEAR * float(np.linalg.norm(np.ptp(positions, axis=0)))
    found: list[int] = []
    for number, place in enumerate(places, start=1):
        distances = np.linalg.norm(positions - place, axis=1)
        nearest = int(distances.argmin())
        if not distances[nearest] <= reach or nearest in found:
            raise ObjectError(
                f'"{obj.name}" has no vertex of its own where landmark {number} of the file was. '
                "The file was saved for another mesh. Choose the right Source and Target."
            )
        found.append(nearest)
    return found
