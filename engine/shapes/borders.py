# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders of surfaces, where something may have been cut off."""

from __future__ import annotations

from .shape import Shape

_LEAST_BORDER = 0.1
"""Length of a border, in sqrt(area), from which on something may have been cut off a surface: around a hand."""


def longest_border(shape: Shape) -> float:
    """Measure the longest border of a surface, in sqrt(area): faces that are missing here and there make short ones."""
    return float(shape.mesh.border_lengths.max(initial=0)) / shape.scale


def has_border(shape: Shape) -> bool:
    """Say whether something may have been cut off a surface, which is open there."""
    return longest_border(shape) > _LEAST_BORDER
