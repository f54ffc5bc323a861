# SPDX-License-Identifier: GPL-3.0-or-later
"""Matching of open surfaces that have about the same spectrum: those are one shape, of which nothing is missing."""

from __future__ import annotations

from dataclasses import replace

from ..dense.credibility import ALL_ALIKE
from ..runtime.errors import MatchError
from ..runtime.progress import Steps, within
from ..shapes.shape import Shape
from ..shapes.shape_preparation import spectra_apart_steps
from .partial_match import is_as_alike
from .result import MatchResult
from .shape_matching import MatchTask, matched_steps

_SAME_SPECTRUM = 0.1
"""How far spectra are apart at most if surfaces are matched as they are first, see `spectra_apart_steps`: of the 40
pairs of parts of ``python -m tests.benchmarks.overlap_pairs`` 5 have as little, two cuts of one kind around the same
place of two persons 0.02 to 0.08 (both tried once)."""


def alike_match_steps(x: Shape, y: Shape, task: MatchTask) -> Steps[MatchResult | None]:
    """Match open surfaces as they are if they have about the same spectrum, unless they might still be parts.

    Parameters
    ----------
    x, y : Shape
        The source and the target.
    task : MatchTask
        What is wanted.

    Returns
    -------
    MatchResult or None
        The match, if the surfaces are so much alike by it that nothing of them can be missing.
    """
    if (yield from within(spectra_apart_steps(x, y), 0.0, 0.1)) > _SAME_SPECTRUM:
        return None
    try:
        strict = replace(task, least=ALL_ALIKE, least_softly=ALL_ALIKE)
        result = yield from within(matched_steps(x, y, strict), 0.1, 1.0)
    except MatchError:
        return None
    return result if is_as_alike(result, ALL_ALIKE) else None  # a rough map may fall short at last
