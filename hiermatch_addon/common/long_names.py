# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that are no longer than Blender allows."""

from __future__ import annotations

import hashlib

import bpy

LONGEST_ID = bpy.types.ID.bl_rna.properties["name"].length_max - 1  # type: ignore[attr-defined]  # of a text
"""Bytes in the name of an object or an action, at most: 63 until Blender 4.5, 255 from 5.0 on."""

LONGEST_KEY = 63
"""Bytes in the name of a shape key, a vertex group or a custom property, at most."""


def shortened(name: str, longest: int, ending: str = "") -> str:
    """Return a name with an ending, in so many bytes at most.

    One that is too long is cut before the ending, where it gets a number made of the whole name, so that names that
    begin alike stay apart.
    """
    if len((name + ending).encode()) <= longest:
        return name + ending
    end = f"~{hashlib.blake2b(name.encode(), digest_size=2).hexdigest()}{ending}"
    return name.encode()[: longest - len(end.encode())].decode(errors="ignore") + end
