# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel remembers of the match that was written last."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .properties import HIERMATCH_PG_summary
    from .stored_match import StoredMatch

__all__ = ["remember"]


def remember(
    summary: HIERMATCH_PG_summary, stored: StoredMatch, names: tuple[str, str], prefix: str, seconds: float
) -> None:
    """Fill the summary.

    Parameters
    ----------
    summary : HIERMATCH_PG_summary
        What to fill.
    stored : StoredMatch
        The match.
    names : tuple of str
        What the objects that were matched as source and target are called now.
    prefix : str
        What all names written start with.
    seconds : float
        How long the match took; zero if that is not known.
    """
    answer = stored.answer
    summary.points = len(answer.point_distortion)
    summary.source, summary.target = names[::-1] if stored.swapped else names
    summary.swapped = stored.swapped
    summary.distortion = answer.distortion
    summary.worst_distortion = float(answer.point_distortion.max())
    summary.proven, summary.gap = answer.proven, answer.gap
    summary.orientation = answer.orientation
    summary.has_mirrored, summary.mirrored = len(stored.answers) > 1, stored.mirrored
    summary.stretch = answer.quality.distortion if answer.quality else 0.0
    summary.verdict = answer.quality.sentence if answer.quality else ""
    summary.confidence = answer.quality.confidence if answer.quality else 0.0
    summary.seconds = seconds
    summary.notes = "\n".join(stored.notes)
    summary.prefix, summary.key = prefix, stored.key
