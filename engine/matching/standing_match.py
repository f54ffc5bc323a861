# SPDX-License-Identifier: GPL-3.0-or-later
"""Matching of bodies of very different proportions by the ends of their limbs, as both stand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..dense.credibility import DOUBTFUL
from ..geometry.procrustes import alike_points, in_unit_spread
from ..runtime.arrays import Ints
from ..runtime.errors import MatchError
from ..runtime.progress import Steps, within
from ..shapes.borders import has_border
from ..shapes.enclosing_surface import both_joined_steps
from ..shapes.extremities import prominent_ends
from ..shapes.shape import Shape
from .result import MatchResult
from .shape_matching import MatchTask, matched_steps, sampled_steps

_HOPELESS = 0.1
"""Confidence of a match below which limbs are compared: chosen by hand.  More is found right otherwise, such as a man
laid onto a figure with a large head (0.25, tried once)."""

_ALONE = 0.2
"""Part of a body in pieces without a counterpart from which on its main part was taken for something else, such as a
head for all of a body, if the match is doubtful.  Without it, the knight of ``python -m tests.benchmarks.maker_rigs``
has no limb bone right on the Mesh2Motion man."""

_NOTE = "The shapes have little in common: the ends of their limbs were taken for the same where both stand alike."


def standing_match_steps(result: MatchResult, x: Shape, y: Shape, task: MatchTask) -> Steps[MatchResult | None]:
    """Match bodies anew, by the ends of their limbs, if a match as they are is hopeless, and they stand alike.

    Of a figure with a large head and short legs, and a realistic person, neither distances nor spectra agree, but where
    hands, feet and heads are does.  They are held together like landmarks, but nothing is taken for known by them: that
    such a map leaves things in place says half as much as else.

    Parameters
    ----------
    result : MatchResult
        What has been found otherwise.
    x, y : Shape
        The source and the target, with all their pieces.
    task : MatchTask
        What is wanted.

    Returns
    -------
    MatchResult or None
        The new one; None if there is none, or it is not more credible.
    """
    if task.landmarks is not None or _worth(result) >= _HOPELESS:
        return None
    x, y = yield from within(both_joined_steps(x, y), 0.0, 0.1)
    if has_border(x) or has_border(y):
        return None
    yield from within(sampled_steps(x, y, task.settings), 0.1, 0.2)
    pairs = standing_ends(x, y)[: task.settings.points]
    if not len(pairs):
        return None
    vertices = [s.vertices[s.samples.vertices[numbers]] for s, numbers in zip((x, y), pairs.T, strict=True)]
    task.clock.lap("limbs")
    try:
        task = replace(task, landmarks=np.column_stack(vertices), assumed=True)
        other = yield from within(matched_steps(x, y, task), 0.2, 1.0)
    except MatchError:
        return None
    if other.dense.quality.confidence <= _worth(result):
        return None
    return replace(other, notes=(*other.notes, _NOTE))


def _worth(result: MatchResult) -> float:
    """Tell the confidence of a match, if it is of all of the bodies or clear."""
    quality = result.dense.quality
    return 0.0 if quality.pieces_alone > _ALONE and quality.confidence < DOUBTFUL else quality.confidence


def standing_ends(x: Shape, y: Shape) -> Ints:
    """Pair the ends of limbs of two bodies that stand alike: those that lie on each other if both have one size.

    Parameters
    ----------
    x, y : Shape
        The bodies, with samples.

    Returns
    -------
    (k, 2) array of int
        Numbers of samples of X and of Y, four pairs at least; none if the bodies do not stand alike.  Their agreement
        is the correlation of all ends of limbs, measured from the centre of each body, of which those without a partner
        have none.
    """
    numbers = prominent_ends(x), prominent_ends(y)
    here, there = (
        in_unit_spread(shape.mesh.vertices, shape.mesh.vertex_areas)[shape.samples.vertices[n]]
        for shape, n in zip((x, y), numbers, strict=True)
    )
    first, second = alike_points([here], there).T
    return np.column_stack([numbers[0][first], numbers[1][second]])
