# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of the vertex groups and attributes that are a match's own, and none of the artist's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..common.access import mesh_of
from . import writing
from .landmark_layer import LANDMARKS

if TYPE_CHECKING:
    import bpy

__all__ = ["written_names"]


def written_names(obj: bpy.types.Object) -> set[str]:
    """Return the names of all that matches wrote on an object and recorded there, and of what keeps its landmarks."""
    mesh: Any = mesh_of(obj)
    if not writing.is_marked(mesh):
        return {LANDMARKS}
    return {LANDMARKS} | {name for record in mesh[writing.MARKER].to_dict().values() for name in record["written"]}
