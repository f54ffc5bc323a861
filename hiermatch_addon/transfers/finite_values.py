# SPDX-License-Identifier: GPL-3.0-or-later
"""Values that are no finite numbers, as files may hold them: what has some is left out, and all else is carried."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.errors import ObjectError
from ..common.phrases import listed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..scene.character import Side


def without_broken(values: dict[str, NDArray[Any]], source: Side) -> list[str]:
    """Take out of named arrays of a source's those with values that are not finite; return what is to be said of it.

    Raises
    ------
    ObjectError
        If none is left.
    """
    notes = leave_out_broken(values, source)
    if notes and not values:
        raise ObjectError(notes[0])
    return notes


def leave_out_broken(values: dict[str, NDArray[Any]], side: Side) -> list[str]:
    """Take out of named arrays of a side's those with values that are not finite; return what is to be said of it."""
    broken = [name for name, held in values.items() if not np.isfinite(held).all()]
    for name in broken:
        del values[name]
    said = (
        f'{listed(broken)} of "{side.name}" was left out, because of values that are not finite numbers. Repair them.'
    )
    return [said] if broken else []
