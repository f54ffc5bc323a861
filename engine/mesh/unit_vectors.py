# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors scaled to length one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["unit_vectors"]


def unit_vectors(vectors: NDArray[np.float64], least: float = 0.0) -> NDArray[np.float64]:
    """Scale vectors (n, d) to length one; those that are no longer than `least` become zero."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > least)
