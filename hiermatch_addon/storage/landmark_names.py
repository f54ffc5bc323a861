# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of landmarks, such as "Nose": kept on all meshes of both sides, by the landmarks' numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from ..common.access import group_of, mesh_of
from ..scene.character import parts_of

if TYPE_CHECKING:
    from ..scene.character import Side

_NAMES: Final = "HM Landmark Names"
"""Custom property of the mesh."""


def landmark_names(side: Side) -> dict[int, str]:
    """Return the names of a side's landmarks, by their numbers; those without a name are not there."""
    found: dict[int, str] = {}
    for part in parts_of(side):
        names = group_of(mesh_of(part), _NAMES).items()
        found |= {int(number): str(name) for number, name in names if number.isdecimal()}
    return found


def name_landmark(side: Side, number: int, name: str) -> None:
    """Name a landmark of a side; an empty name takes its name away."""
    for part in parts_of(side):
        mesh: Any = mesh_of(part)
        names = landmark_names(part)
        if names.get(number, "") == name:
            continue
        names.pop(number, None)
        if name:
            names[number] = name
        if names:
            mesh[_NAMES] = {str(key): text for key, text in sorted(names.items())}
        else:
            del mesh[_NAMES]
