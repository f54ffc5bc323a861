# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on a match that things are carried across, and the doubts about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from ...engine import DOUBTFUL, open_ends
from ..common.phrases import listed
from ..scene.character import parts_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...engine import MatchQuality, TriangleMesh
    from ..scene.character import Side

GOOD: Final = 0.7
"""Confidence from which on a match is called good."""

_ENDS_OF_GARMENT = 2
"""A skirt has two open ends, trousers three, a shirt four; a bust or half a body is open where it was cut, once."""

_PARTNERED, _MISSED = 0.85, 0.75
"""One mesh is a part of the other if more of its area than the first has a partner, and less than the second of the
other's area: a body without its hands still has nine tenths of it."""

ANSWERS: Final = (
    ("LANDMARKS", "Match Again with Landmarks", "Write nothing, name corresponding places by clicks, and match again"),
    ("WRITE", "Write Anyway", "Carry everything across the match as it is; one Undo takes it back"),
    ("CANCEL", "Cancel", "Write nothing"),
)
"""What can be done about a match that is not to be trusted, as items of a menu of Blender's."""


@dataclass(frozen=True)
class Verdict:
    """What is known of a match.

    Attributes
    ----------
    confidence : float
        How far it can be trusted, 0 to 1.
    sentence : str
        The same for a person to read.
    advice : str
        What the two meshes look like, such as a garment and a body, and what to do then; empty if like two bodies.
    """

    confidence: float
    sentence: str
    advice: str = ""

    @classmethod
    def of(cls, quality: MatchQuality, advice: str = "") -> Verdict:
        """Take what matters of a quality."""
        return cls(float(quality.confidence), quality.sentence, advice)

    @property
    def doubtful(self) -> bool:
        """Whether it is better not to carry anything across the match."""
        return self.confidence < DOUBTFUL

    @property
    def said(self) -> str:
        """All of it in a line."""
        if self.advice:
            return f"Confidence {self.confidence:.0%}: {self.sentence} Note: {self.advice}"
        return f"Confidence {self.confidence:.0%}: {self.sentence}"


def advice_on(
    quality: MatchQuality,
    names: tuple[str, str],
    meshes: tuple[TriangleMesh, TriangleMesh],
    *,
    halves: tuple[bool, bool] = (False, False),
    hung: tuple[Sequence[str], Sequence[str]] = ((), ()),
) -> str:
    """Say what to do if one of two matched meshes looks like a garment for the other, or like a part of it.

    If the match is not to be trusted, objects that hang on bones come first: they are mostly weapons, shields or bags,
    which the other has not.

    Parameters
    ----------
    quality : MatchQuality
        How far the match can be trusted, and how much of either mesh has a partner.
    names : tuple of str
        What source and target are called.
    meshes : tuple of TriangleMesh
        The two.
    halves : tuple of bool
        Whether a Mirror modifier completes them, which is not applied.
    hung : tuple of sequence of str
        What the objects of either are called that hang on a single bone each.

    Returns
    -------
    str
        A sentence; empty if they look like two whole bodies.
    """
    half = next((name for name, is_half in zip(names, halves, strict=True) if is_half), None)
    if half is not None and quality.confidence < GOOD:
        return (
            f'"{half}" has a Mirror modifier, and was matched as the half that it is: if the match is wrong, apply the '
            "modifier, and match again."
        )
    for own, other in ((0, 1), (1, 0)):
        if hung[own] and quality.confidence < DOUBTFUL:
            return (
                f'What hangs on single bones of "{names[own]}": {listed(hung[own])}. Hide what "{names[other]}" has '
                "not, such as weapons, and match again."
            )
    shares = (quality.source_coverage, quality.coverage)
    for own, other in ((0, 1), (1, 0)):
        if shares[other] >= _MISSED:
            continue
        ends = open_ends(meshes[own])
        if ends >= _ENDS_OF_GARMENT and ends > open_ends(meshes[other]):
            return (
                f'"{names[own]}" is open at {ends} ends and looks like a garment for "{names[other]}": if it is '
                "one, fit it with Wear instead; if not, and the match is wrong, leave out of the other mesh what it "
                "lacks."
            )
        if shares[own] > _PARTNERED:
            return (
                f'"{names[own]}" looks like a part of "{names[other]}": if the match is wrong, name what it lacks '
                "under Leave Out, and match again."
            )
    return ""


def is_half(side: Side) -> bool:
    """Tell whether a Mirror modifier completes a part of a side: meshes are matched without it."""
    return any(modifier.type == "MIRROR" and modifier.show_viewport for p in parts_of(side) for modifier in p.modifiers)


def hung_on_bones(side: Side) -> list[str]:
    """Return the names of the parts of a side that hang on a single bone each, such as weapons, if others do not."""
    parts = parts_of(side)
    names = [part.name for part in parts if part.parent is not None and part.parent_type == "BONE"]
    return names if len(names) < len(parts) else []


def asymmetry_note(name: str, quality: MatchQuality) -> str:
    """Say that a mesh is hardly its own mirror image, by the quality of its left-right map; empty if it is."""
    if quality.confidence >= GOOD:
        return ""
    return (
        f'"{name}" is hardly symmetric, so that its mirror images are uncertain (confidence {quality.confidence:.0%}): '
        "check what was mirrored."
    )
