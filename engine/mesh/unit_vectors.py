# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors scaled to length one."""

from __future__ import annotations

import numpy as np

from ..runtime.arrays import Floats


def unit_vectors(vectors: Floats, least: float = 0.0) -> Floats:
    """Scale vectors (n, d) to length one; those that are no longer than `least` become zero."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > least)
