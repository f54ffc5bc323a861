# SPDX-License-Identifier: GPL-3.0-or-later
"""Two sampled shapes, and all terms of the distortion between their samples."""

from __future__ import annotations

import copy

import numpy as np
from scipy.spatial.distance import cdist

from ..geometry.orientation import orientation_agreement, signed_areas
from ..runtime.arrays import TINY, Bools, Floats, Ints, squared_differences
from ..runtime.progress import Steps
from ..shapes.shape import Shape
from ..shapes.surface_distances import EmbeddedDistances, PointDistances, SurfaceDistances
from .descriptors import distance_histograms, earth_movers_distance
from .diffusion import automatic_time, diffusion_places, positive_values
from .problem import MatchingProblem
from .settings import MatchSettings
from .sign_sequences import SignSequence, consistent_sequences_steps
from .spectral_descriptors import (
    automatic_energies,
    eigenfunction_descriptor,
    heat_kernel_signatures,
    multiplets,
    wave_kernel_signatures,
)

# Weight of the orientation term beside those of descriptors and of distances, the larger of which is one usually.  Its
# mean square difference of signed areas is about 0.5 between unrelated places, the descriptors' earth mover's distance
# some hundredths.
_ORIENTATION_WEIGHT = 0.1

# Mean of the linear term between all samples, to which descriptors without a unit of length are scaled: what the earth
# mover's distance of geodesic histograms has on ordinary shapes.
_TYPICAL_DIFFERENCE = 0.1

# Root mean square distance between samples to which diffusion distances, whose size depends on the time, are scaled:
# about that of geodesic distances in units of sqrt(area).
_TYPICAL_DISTANCE = 1.0

# Eigenvalues that differ by less than this part may have changed places.
_NEAR = 0.1


class Pair:
    """Two sampled shapes, and the terms of the distortion between their samples.

    Parameters
    ----------
    source, target : Shape
        The shapes X and Y, sampled; with their spectra if `needs_spectrum` says so.
    settings : MatchSettings
        Metric, descriptor and weights.
    landmarks : int
        How many of the first samples of X are known to correspond to the first of Y, one to one.

    Attributes
    ----------
    source_distances : (S, S) array of float
        d_X between the samples of X.
    target_distances : (T, T) array of float
        d_Y between the samples of Y.
    target_metric : PointDistances
        d_Y between points anywhere on Y.
    linear : (S, T) array of float
        d_F between every sample of X and every sample of Y, weighted.
    """

    def __init__(self, source: Shape, target: Shape, settings: MatchSettings, landmarks: int = 0) -> None:
        self.source, self.target, self.settings, self.landmarks = source, target, settings, landmarks
        self.source_distances, self.target_distances, self.target_metric = _metric(source, target, settings)
        self._descriptor = settings.linear_weight * self._sign_free(settings.descriptor)
        self.linear = self._descriptor

    @staticmethod
    def needs_spectrum(settings: MatchSettings) -> bool:
        """Say whether the shapes need eigenpairs of the Laplace-Beltrami operator."""
        return settings.metric == "diffusion" or settings.descriptor != "histogram"

    def _sign_free(self, descriptor: str) -> Floats:
        """Compare the samples by a descriptor; in place of eigenfunctions, by histograms, which need no signs."""
        if descriptor in ("heat_kernel", "wave_kernel"):
            return _scaled(_signature_difference(*self._signatures(descriptor)))
        if descriptor not in ("histogram", "eigenfunctions"):
            raise NotImplementedError(f"The descriptor {descriptor!r} is not compared here yet.")
        bins, reach = self.settings.histogram_bins, max(self.source_distances.max(), self.target_distances.max())
        first = distance_histograms(self.source_distances, self.source.samples.cell_areas, bins, reach)
        second = distance_histograms(self.target_distances, self.target.samples.cell_areas, bins, reach)
        if self.settings.comparison == "bin_to_bin":
            return _scaled(cdist(first, second, "cityblock"))
        return earth_movers_distance(first, second, reach / bins)

    def _signatures(self, descriptor: str) -> list[Floats]:
        """Kernel signatures of the samples of both shapes, (S, d) and (T, d)."""
        spectra = self.source.spectrum, self.target.spectrum
        if descriptor == "heat_kernel":
            signatures = [heat_kernel_signatures(spectrum) for spectrum in spectra]
        else:  # at the same energies, whichever has fewer eigenpairs
            energies = automatic_energies(min(map(len, spectra)))
            signatures = [wave_kernel_signatures(spectrum, energies) for spectrum in spectra]
        shapes = self.source, self.target
        return [of[shape.samples.vertices] for of, shape in zip(signatures, shapes, strict=True)]

    def variants_steps(self, count: int) -> Steps[list[Pair]]:
        """Find the pair with each of the most consistent sign sequences of eigenfunctions.

        Parameters
        ----------
        count : int
            How many, at most.

        Returns
        -------
        list of Pair
            For any other descriptor the pair alone.
        """
        if self.settings.descriptor != "eigenfunctions":
            return [self]
        k = self.settings.eigenfunctions
        source, target = (
            eigenfunction_descriptor(s.spectrum, k)[s.samples.vertices] for s in (self.source, self.target)
        )
        groups = self._groups(k)
        sequences = yield from consistent_sequences_steps(source, target, self._descriptor, groups, count)
        return [self._with(source, target, sequence) for sequence in sequences]

    def _groups(self, count: int) -> list[list[int]]:
        """Group eigenfunctions of which some may have changed places, as eigenvalues of either shape are near."""
        begin = [
            {int(group[0]) for group in multiplets(spectrum.values[spectrum.zero_count :][:count], _NEAR)}
            for spectrum in (self.source.spectrum, self.target.spectrum)
        ]
        parts = np.split(np.arange(count), sorted(begin[0] & begin[1])[1:])
        return [part.tolist() for part in parts]

    def _with(self, source: Floats, target: Floats, sequence: SignSequence) -> Pair:
        variant = copy.copy(self)
        difference = np.sqrt(squared_differences(source, sequence.apply(target)))
        variant.linear = self.settings.linear_weight * _scaled(difference)
        return variant

    def problem(self, points: int, candidates: int | None = None, extra: Floats | None = None) -> MatchingProblem:
        """Match the first `points` samples of X to the first `candidates` samples of Y (all by default).

        `extra`, (points, T), is added to the linear term.

        Matches that contradict a landmark are forbidden in a problem of some candidates, which is meant for an exact
        search.  Among all candidates, where the relaxed solver could not work with infinity, they cost more than could
        ever be gained by them.
        """
        linear = self.linear[:points, :candidates]
        linear = linear if extra is None else linear + extra
        source, target = self.source_distances[:points, :points], self.target_distances[:candidates, :candidates]
        weight = self.settings.quadratic_weight
        if self.landmarks:
            farthest = max(float(source.max()), float(target.max()))
            most = 1 + float(np.abs(linear).max()) + 2 * points * weight * farthest**2
            linear = np.where(self._contradicting(*linear.shape), most if candidates is None else np.inf, linear)
        return MatchingProblem(linear, source, target, weight)

    def _contradicting(self, points: int, candidates: int) -> Bools:
        """Find the matches of a landmark with anything but its partner, and of other points with a partner."""
        rows, columns = np.arange(points)[:, None], np.arange(candidates)
        of_landmark = (rows < self.landmarks) | (columns < self.landmarks)
        return of_landmark & (rows != columns)

    def orientation_term(self, coarse: Ints, sign: int) -> Floats:
        """Penalise matches that do not keep (sign 1) or do not mirror (sign -1) the surface, (S, T).

        Seen from corresponding points, the directions to the coarse points turn the same way.  The term compares the
        signed areas of all pairs of these directions; it is what tells the front of a flat body from its back, which
        distances cannot.
        """
        first = signed_areas(self.source.samples.directions[:, : len(coarse)])
        second = sign * signed_areas(self.target.samples.directions[:, coarse])
        weight = _ORIENTATION_WEIGHT * max(self.settings.linear_weight, self.settings.quadratic_weight)
        return weight * squared_differences(first, second) / first.shape[1]

    def orientation(self, assignment: Ints) -> float:
        """Mean agreement of orientation at the matched points, see `orientation_agreement`."""
        count = len(assignment)
        return float(
            orientation_agreement(
                self.source.samples.directions[:count, :count],
                self.target.samples.directions[np.ix_(assignment, assignment)],
            ).mean()
        )


def _metric(source: Shape, target: Shape, settings: MatchSettings) -> tuple[Floats, Floats, PointDistances]:
    """Distances between the samples of each shape in the chosen metric, and the metric on the whole target."""
    if settings.metric == "geodesic":
        return source.samples.distances, target.samples.distances, SurfaceDistances(target)
    # One time, and one scale, for both shapes.
    time = settings.diffusion_time or (automatic_time(source.spectrum) + automatic_time(target.spectrum)) / 2
    least = min(float(positive_values(shape.spectrum)[0]) for shape in (source, target))
    places = [diffusion_places(shape.spectrum, time, least) for shape in (source, target)]
    sampled = (own[shape.samples.vertices] for own, shape in zip(places, (source, target), strict=True))
    first, second = (cdist(own, own) for own in sampled)
    scale = _TYPICAL_DISTANCE / np.sqrt((np.square(first).mean() + np.square(second).mean()) / 2)
    return first * scale, second * scale, EmbeddedDistances(target.mesh, places[1] * scale)


def _scaled(difference: Floats) -> Floats:
    """Scale differences without a unit to those of histograms, so that one lambda serves all descriptors."""
    mean = difference.mean()
    return difference * (_TYPICAL_DIFFERENCE / mean) if mean > 0 else difference


def _signature_difference(first: Floats, second: Floats) -> Floats:
    """Compare kernel signatures (s, d) and (t, d) by their logarithms, because they span decades: (s, t)."""
    return cdist(*(np.log(np.maximum(signature, TINY)) for signature in (first, second)), "cityblock")
