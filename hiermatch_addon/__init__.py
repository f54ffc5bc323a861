# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blender side of HierMatch: everything that touches ``bpy``."""

from __future__ import annotations

from .registration import register, unregister

__all__ = ["register", "unregister"]
