# SPDX-License-Identifier: GPL-3.0-or-later
"""Few keys instead of one in every frame, with a bound on what that changes."""

from __future__ import annotations

import numpy as np

from ...runtime.arrays import Floats, Ints
from ...runtime.errors import RigError


def reduced_keys(times: Floats, values: Floats, tolerance: float) -> Ints:
    """Choose keys between which cubic curves stay close to all values.

    The curves have the slopes of the values at the keys (`slopes_of`), as Bézier curves with handles at a third of the
    way do.  Where they are furthest from the values, a key is added, until none is further than the tolerance.

    Parameters
    ----------
    times : (f,) array of float
        Times, increasing.
    values : (f, c) array of float
        The channels of one bone; they get the same keys.
    tolerance : float
        Largest difference that may be left in any channel; 0 keeps all keys where values change.

    Returns
    -------
    (k,) array of int
        Which are keys; one is enough for what does not move.

    Raises
    ------
    RigError
        If there is not one row of finite values for each time, or times do not increase.
    """
    if values.ndim != 2 or len(values) != len(times) or not np.isfinite(values).all() or tolerance < 0:
        raise RigError("To reduce keys there should be one row of finite values for each time, and a tolerance.")
    if (np.diff(times) <= 0).any():
        raise RigError("To reduce keys each should come after the one before.")
    if len(times) <= 1 or np.abs(values - values[0]).max(initial=0.0) <= tolerance:
        return np.arange(min(len(times), 1))
    slopes = slopes_of(times, values)
    kept = [0, len(times) - 1]
    waiting = [(0, len(times) - 1)]
    while waiting:
        start, end = waiting.pop()
        if end - start < 2:
            continue
        inside = slice(start + 1, end)
        step = times[end] - times[start]
        t = ((times[inside] - times[start]) / step)[:, None]
        curve = (
            (1 + 2 * t) * (1 - t) ** 2 * values[start]
            + t**2 * (3 - 2 * t) * values[end]
            + step * (t * (1 - t) ** 2 * slopes[start] - t**2 * (1 - t) * slopes[end])
        )
        errors = np.abs(curve - values[inside]).max(axis=1)
        worst = int(errors.argmax())
        if errors[worst] > tolerance:
            middle = start + 1 + worst
            kept.append(middle)
            waiting += [(start, middle), (middle, end)]
    return np.array(sorted(kept), np.int64)


def slopes_of(times: Floats, values: Floats) -> Floats:
    """Change of values (f, c) per unit of time at each time (f,): of the parabola through it and both neighbors."""
    if len(times) < 2:
        return np.zeros_like(values)
    return np.gradient(values, times, axis=0, edge_order=2 if len(times) > 2 else 1)
