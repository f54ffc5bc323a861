# SPDX-License-Identifier: GPL-3.0-or-later
"""The most credible ways in which one surface may overlap with another, on coarse surfaces."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.best_distinct import best_distinct
from ...runtime.arrays import Floats
from ...runtime.progress import Progress, Steps, within
from .consistent_sets import PLANS, Together, consistent_sets
from .oriented_patches import OrientedPatches
from .overlap_score import overlap_score
from .part_registration import FAST, REST, Fit, Marks, Round, placed, register_parts
from .part_surface import PartSurface
from .patch_candidates import compatibilities, patch_candidates

_LAID, PATCHES = 160, 300
"""Patches of the surface that is laid onto the other, and of that one."""

_HEATS = (1, None), (4, 25), (len(FAST), 12)
"""Up to which round registrations go on, and how many of them: the best so far, or all.  Where a right way was among
the starts, for 36 sides of pairs of PARTIALSMAL, one was among the best eleven after the first round, and of the best
nine after the fourth."""

_REGROWN, _POLISHED, _KEPT = (6, 4), 4, 8
"""How many of the best fits that differ are grown again: of those before the last rounds, in which a right one whose
limbs lie wrongly is strained most, and of all; how many are registered once more, and how many are returned.  Chosen
for 40 pairs of PARTIALSMAL, ten of PFARM and 22 of TOSCA and FAUST; see `docs/tried.md`."""

_SAME = 0.05
"""Median distance of the vertices in either overlap, in units of length, up to which two fits are the same."""

_BAD_GAP, _BAD_STRAIN, _STRAIN_SMOOTHING = 0.02, 0.25, 4e-4
"""Distance to its match, and elastic energy by area, that are as bad as each other; and how long the latter spreads."""

_LEAST_MEMBERS = 16
"""Vertices in an overlap from which on it is grown again."""

_BEYOND = 0.03
"""How much sooner than from other landmarks a fit grows again from its better half, whose vertices lie close."""

_LABEL = "Looking for what the surfaces share"


@dataclass(frozen=True, eq=False)
class CoarsePair:
    """Two surfaces, and coarse ones that stand for them.

    Attributes
    ----------
    surfaces, coarse : pair of PartSurface
        In full resolution, and coarse.
    patches : pair of OrientedPatches
        `PATCHES` of either.
    """

    surfaces: tuple[PartSurface, PartSurface]
    coarse: tuple[PartSurface, PartSurface]
    patches: tuple[OrientedPatches, OrientedPatches]

    def turned(self) -> CoarsePair:
        """Return the pair the other way round."""
        return CoarsePair(self.surfaces[::-1], self.coarse[::-1], self.patches[::-1])


@dataclass(frozen=True, eq=False)
class ScoredFit:
    """A registration of coarse surfaces, and how credible it is, larger for more, see `overlap_score`."""

    fit: Fit
    score: float


def overlap_fits_steps(pair: CoarsePair) -> Steps[list[ScoredFit]]:
    """Lay the first surface of a pair onto the second in many ways, and return the most credible ones, best first."""
    source, target = pair.coarse
    yield Progress(0.0, _LABEL)
    starts = yield from within(_starts_steps(pair), 0.0, 0.3)
    before: list[ScoredFit] = []
    fits: list[ScoredFit] = []
    done, begin = 0, 0.3
    for rounds, most in _HEATS:
        order = sorted(range(len(fits)), key=lambda number: -fits[number].score)[:most]
        starts = [replace(starts[one], positions=fits[one].fit.positions) for one in order] or starts
        before, fits = fits, []
        for number, start in enumerate(starts):
            fits.append(_followed(source, target, start, FAST[done:rounds], done))
            yield Progress(begin + 0.55 / len(_HEATS) * (number + 1) / len(starts), _LABEL)
        done, begin = rounds, begin + 0.55 / len(_HEATS)
    best = list(fits)
    for improved, among, most in (
        (regrown, before, _REGROWN[0]),
        (regrown, best, _REGROWN[1]),
        (_polished, best, _POLISHED),
    ):
        for each in _distinct(among, most):
            best.append(improved(source, target, each))
            begin += 0.15 / (sum(_REGROWN) + _POLISHED)
            yield Progress(begin, _LABEL)
    return _distinct(best, _KEPT)


@dataclass(frozen=True, eq=False)
class _Start:
    """How a coarse surface may be laid onto another, n vertices.

    Attributes
    ----------
    positions : (n, 3) array of float
        Where its vertices are.
    marks : Marks
        What says so.
    from_marks : (n,) array of float, optional
        Distances from these, if they are only in a piece of it.
    """

    positions: Floats
    marks: Marks
    from_marks: Floats | None


def _followed(
    source: PartSurface, target: PartSurface, start: _Start, rounds: tuple[Round, ...], done: int
) -> ScoredFit:
    """Register coarse surfaces from a start."""
    marks, from_marks = start.marks, start.from_marks
    fit = register_parts(source, target, start.positions, rounds, marks=marks, from_marks=from_marks, done=done)
    return scored_fit(source, target, fit)


def _starts_steps(pair: CoarsePair) -> Steps[list[_Start]]:
    """Place the first coarse surface by sets of patches that go together."""
    here, there = pair.surfaces
    coarse = pair.coarse[0]
    patches = pair.patches[0].first(_LAID), pair.patches[1]
    candidates = patch_candidates(*patches)
    together = Together(compatibilities(candidates, pair.surfaces, patches), candidates.first)
    yield Progress(0.5, _LABEL)
    shares = np.bincount(patches[0].paths.argmin(axis=0), here.mass, len(patches[0])) / here.area
    nearest = cKDTree(coarse.vertices).query(here.vertices[patches[0].vertices])[1]
    starts: list[_Start] = []
    for number, plan in enumerate(PLANS):
        for each in consistent_sets(candidates, together, patches, shares, plan):
            first, second = candidates.first[each.members], candidates.second[each.members]
            paths = patches[0].paths[first][:, coarse.ids]
            marks = Marks(nearest[first], there.vertices[patches[1].vertices[second]], each.weights.astype(np.float64))
            positions, marks = placed(coarse, marks, candidates.rotations[each.members], paths)
            starts.append(_Start(positions, marks, paths.min(axis=0) if np.isfinite(plan.radius) else None))
        yield Progress(0.5 + (number + 1) / (2 * len(PLANS)), _LABEL)
    return starts


def scored_fit(source: PartSurface, target: PartSurface, fit: Fit) -> ScoredFit:
    """Give a registration its score."""
    return ScoredFit(fit, overlap_score(source, target, fit))


def _distinct(fits: Iterable[ScoredFit], most: int) -> list[ScoredFit]:
    """Keep the best of fits that are the same, so many at most, best first."""
    ranked = sorted(fits, key=lambda fit: -fit.score)
    return best_distinct(ranked, lambda one, other: not _are_same(one.fit, other.fit), most)


def _are_same(first: Fit, second: Fit) -> bool:
    """Say whether two registrations bring what overlaps to the same places."""
    either = first.members | second.members
    apart = np.linalg.norm(first.positions[either] - second.positions[either], axis=1)
    return not len(apart) or float(np.median(apart)) <= _SAME


def _polished(source: PartSurface, target: PartSurface, scored: ScoredFit) -> ScoredFit:
    """Register once more, all the way from stiff to soft."""
    return scored_fit(source, target, register_parts(source, target, scored.fit.positions, REST))


def regrown(source: PartSurface, target: PartSurface, scored: ScoredFit) -> ScoredFit:
    """Register again from the half of the overlap that fits best, so that what lies wrongly is let go.

    Parameters
    ----------
    source, target : PartSurface
        The surfaces.
    scored : ScoredFit
        A registration of the first to the second; if hardly anything overlaps, it is returned.
    """
    fit = scored.fit
    if fit.members.sum() < _LEAST_MEMBERS:
        return scored
    strain = source.smoothed(fit.energies / source.mass, _STRAIN_SMOOTHING)
    bad = fit.there.gaps / _BAD_GAP + np.maximum(strain, 0) / _BAD_STRAIN
    good = np.flatnonzero(fit.members & (bad <= np.median(bad[fit.members])))
    paths = source.paths(good)
    marks = Marks(good, target.vertices[fit.there.images[good]], source.mass[good])
    positions, marks = placed(source, marks, fit.rotations[good], paths)
    from_marks = paths.min(axis=0) + _BEYOND
    return scored_fit(
        source, target, register_parts(source, target, positions, FAST, marks=marks, from_marks=from_marks)
    )
