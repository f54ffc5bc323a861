# SPDX-License-Identifier: GPL-3.0-or-later
"""Benchmarks: what they measure is printed, or drawn, and docs/results.md says what came of it.

Products of matrices keep to one core, so that times are those of one; this has to be said before NumPy is there.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
