# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a match, with their meaning, defaults and ranges.

The add-on's properties mirror these fields by name, label, description and range.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

from .errors import SettingsError

__all__ = ["MatchSettings"]


def _setting(default: float, label: str, minimum: float, maximum: float, description: str) -> Any:  # noqa: ANN401
    """Declare a numeric field with all that an interface needs to show it."""
    metadata = {"label": label, "description": description, "minimum": minimum, "maximum": maximum}
    return field(default=default, metadata=metadata)


@dataclass(frozen=True)
class MatchSettings:
    """Settings of `match`; the defaults need no tuning across units, scale and resolution.

    Raises
    ------
    SettingsError
        If a value is out of its range or contradicts another.
    """

    points: int = _setting(64, "Points", 3, 1024, "How many points of the source are matched at the finest level")
    coarse_points: int = _setting(
        10, "Coarse Points", 3, 24, "How many points are matched exactly, by branch and bound, before all others"
    )
    coarse_candidates: int = _setting(
        24, "Coarse Candidates", 3, 100, "How many points of the target the coarse points may be matched to"
    )
    quadratic_weight: float = _setting(
        1.0,
        "Distance Weight",
        0.0,
        1000.0,
        "How much the differences of distances between points count beside the differences of their descriptors",
    )
    neighbourhood: int = _setting(
        20,
        "Neighbourhood",
        2,
        200,
        "Among how many of the target samples around its present match each point looks for a better one",
    )
    samples: int = _setting(
        512,
        "Samples",
        16,
        4096,
        "How many samples of each surface describe it; the points are matched to the samples of the target. "
        "At least twice as many as points are taken",
    )
    hypotheses: int = _setting(
        6,
        "Hypotheses",
        1,
        32,
        "How many distinct coarse matchings are followed up before the best is chosen. "
        "Nearly symmetric shapes have several that are almost equally good",
    )
    histogram_bins: int = _setting(
        32, "Histogram Bins", 4, 256, "Number of bins of the distance histograms that describe a point"
    )
    node_limit: int = _setting(
        100_000,
        "Search Limit",
        1,
        1_000_000_000,
        "After how many nodes the exact search stops with the best matching so far and a bound on the optimum",
    )

    def __post_init__(self) -> None:
        for setting in fields(self):
            value, low, high = getattr(self, setting.name), setting.metadata["minimum"], setting.metadata["maximum"]
            if not low <= value <= high:
                raise SettingsError(f"{setting.metadata['label']} is {value}, but must lie between {low} and {high}.")
        if self.coarse_candidates < self.coarse_points:
            raise SettingsError(
                f"{self.coarse_points} Coarse Points need at least as many Coarse Candidates, "
                f"not {self.coarse_candidates}."
            )
