# SPDX-License-Identifier: GPL-3.0-or-later
"""Short names of the types of arrays; what shape an array has is said where it is used."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
