# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys as arrays of offsets."""

from __future__ import annotations

import numpy as np


def positions(obj):
    """Vertices of a mesh, (n, 3)."""
    flat = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", flat)
    return flat.reshape(-1, 3).astype(float)


def add_key(obj, name, offsets):
    """Add a shape key that moves the vertices by offsets (n, 3)."""
    if obj.data.shape_keys is None:
        obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name=name, from_mix=False)
    key.value = 0  # which is one in some versions
    key.data.foreach_set("co", (positions(obj) + offsets).astype(np.float32).ravel())
    return key


def offsets_of(obj, name, base="Basis"):
    """By how much a shape key moves the vertices, (n, 3)."""
    blocks = obj.data.shape_keys.key_blocks
    found = []
    for key in (blocks[name], blocks[base]):
        flat = np.empty(3 * len(key.data), np.float32)
        key.data.foreach_get("co", flat)
        found.append(flat.reshape(-1, 3).astype(float))
    return found[0] - found[1]
