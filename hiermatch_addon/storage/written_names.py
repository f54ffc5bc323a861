# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of the vertex groups and attributes that are a match's own, and none of the artist's."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..common.access import mesh_of
from . import writing
from .landmark_layer import LANDMARKS

if TYPE_CHECKING:
    import bpy


def written_names(obj: bpy.types.Object) -> set[str]:
    """Return the names of all that matches wrote on an object and recorded there, and of what keeps its landmarks."""
    records = writing.records_of(mesh_of(obj)).values()
    return {LANDMARKS} | {name for record in records for name in record["written"]}
