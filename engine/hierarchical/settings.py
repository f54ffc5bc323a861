# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a match, with their meaning, defaults and ranges.

The add-on's properties mirror these fields by name, label, description and range.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Self, cast

import numpy as np

from ..runtime.errors import SettingsError


def setting(default: float, label: str, minimum: float, maximum: float, description: str) -> Any:  # noqa: ANN401
    """Declare a numeric field with all that an interface needs to show it."""
    metadata = {"label": label, "description": description, "minimum": minimum, "maximum": maximum}
    return field(default=default, metadata=metadata)


def choice(default: str, label: str, description: str, choices: dict[str, tuple[str, str]]) -> Any:  # noqa: ANN401
    """Declare a field that takes one of several words, each with its label and description."""
    return field(default=default, metadata={"label": label, "description": description, "choices": choices})


def switch(label: str, description: str) -> Any:  # noqa: ANN401
    """Declare a field that is on unless it is switched off."""
    return field(default=True, metadata={"label": label, "description": description})


@dataclass(frozen=True)
class CheckedSettings:
    """Settings whose values are checked against what their fields declare.

    Raises
    ------
    SettingsError
        If a number is out of its range, or a value none of its choices, or of another type.
    """

    def __post_init__(self) -> None:
        for own in fields(self):
            value, about = getattr(self, own.name), own.metadata
            if "choices" in about:
                if not isinstance(value, str) or value not in about["choices"]:
                    raise SettingsError(f"{about['label']} is {value!r}, but must be one of {list(about['choices'])}.")
            elif "minimum" in about:
                _check_number(value, about, whole=isinstance(own.default, int))
            elif "label" in about and not isinstance(value, (bool, np.bool_)):
                raise SettingsError(f"{about['label']} is {value!r}, but must be True or False.")

    @classmethod
    def checked(cls, settings: Self | None) -> Self:
        """Return settings as they were given, or the defaults for None.

        Raises
        ------
        SettingsError
            If they are others, or a dictionary.
        """
        if settings is None:
            return cls()
        if not isinstance(settings, cls):
            raise SettingsError(
                f"The settings are of the type {type(settings).__name__}. "
                f"Make settings of them first: {cls.__name__}(**settings)."
            )
        return settings


def _check_number(value: object, about: Mapping[str, Any], *, whole: bool) -> None:
    """Raise a `SettingsError` if a value is no number within its range, or should be `whole` and is not."""
    kinds = (int, np.integer) if whole else (int, float, np.integer, np.floating)
    if isinstance(value, bool) or not isinstance(value, kinds):
        wanted = "a whole number" if whole else "a number"
        raise SettingsError(f"{about['label']} is {value!r}, but must be {wanted}.")
    if not about["minimum"] <= cast("Any", value) <= about["maximum"]:
        raise SettingsError(
            f"{about['label']} is {value}, but must lie between {about['minimum']} and {about['maximum']}."
        )


@dataclass(frozen=True)
class MatchSettings(CheckedSettings):
    """Settings of `match`; the defaults need no tuning across units, scale and resolution.

    Each field's metadata holds ``label`` and ``description``, and ``minimum`` and ``maximum`` of a number or
    ``choices`` of a word.

    Raises
    ------
    SettingsError
        If a value is out of its range or contradicts another.
    """

    points: int = setting(64, "Points", 3, 1024, "How many points of the source are matched at the finest level")
    coarse_points: int = setting(
        10, "Coarse Points", 3, 24, "How many points are matched exactly, by branch and bound, before all others"
    )
    coarse_candidates: int = setting(
        24, "Coarse Candidates", 3, 100, "How many points of the target the coarse points may be matched to"
    )
    solver: str = choice(
        "hierarchical",
        "Solver",
        "How the points are matched",
        {
            "hierarchical": ("Hierarchical", "Some points exactly, then more and more, level by level"),
            "flat": ("Flat", "All points at once, exactly: for comparison, and for some 30 points at most"),
            "gmds": (
                "Generalized Multidimensional Scaling",
                "From the coarse match, points move over the target by their distances alone: for comparison",
            ),
        },
    )
    dense: bool = switch(
        "Dense Map",
        "Find the corresponding point for every vertex of both meshes. "
        "The matched points then lie where this map takes them",
    )
    settle: bool = switch(
        "Settle",
        "At last let the points leave the samples of the target and come to rest between its "
        "vertices (hierarchical solver without a dense map)",
    )
    metric: str = choice(
        "geodesic",
        "Metric",
        "What distances between points of a surface are kept",
        {
            "geodesic": ("Geodesic", "Length of the shortest path on the surface, by fast marching"),
            "diffusion": (
                "Diffusion",
                "How differently heat spreads from two points: less affected by holes and touching parts",
            ),
        },
    )
    diffusion_time: float = setting(
        0.0,
        "Diffusion Time",
        0.0,
        10.0,
        "How long heat spreads for diffusion distances, in units of the surface area; 0 chooses by the shape",
    )
    descriptor: str = choice(
        "histogram",
        "Descriptor",
        "By what a point is recognised, beside its distances to the other points",
        {
            "histogram": ("Distance Histograms", "How many places lie how far away, in the chosen metric"),
            "heat_kernel": ("Heat Kernel Signatures", "How much heat stays at the point, over time"),
            "wave_kernel": ("Wave Kernel Signatures", "How strongly the point vibrates, over frequency"),
            "eigenfunctions": (
                "Laplace-Beltrami Eigenfunctions",
                "Values of the lowest vibrations of the surface, with every consistent choice of their signs",
            ),
        },
    )
    comparison: str = choice(
        "earth_mover",
        "Comparison",
        "How histograms are compared",
        {
            "earth_mover": ("Earth Mover's", "How far the mass of one has to be moved to make the other"),
            "bin_to_bin": ("Bin to Bin", "The difference in each bin by itself"),
        },
    )
    constraint: str = choice(
        "injective",
        "Constraint",
        "How points and candidates of the coarse step are to correspond",
        {
            "injective": ("Injective", "Each point gets a candidate of its own; candidates may stay unused"),
            "bijective": ("Bijective", "As many candidates as points, and each is used"),
        },
    )
    linear_weight: float = setting(
        1.0, "Descriptor Weight", 0.0, 1000.0, "How much the differences of descriptors count"
    )
    quadratic_weight: float = setting(
        1.0, "Distance Weight", 0.0, 1000.0, "How much the differences of distances between points count"
    )
    neighbourhood: int = setting(
        20,
        "Neighbourhood",
        2,
        200,
        "Among how many of the target samples around its present match each point looks for a better one",
    )
    samples: int = setting(
        256,
        "Samples",
        16,
        4096,
        "How many samples of each surface describe it; the points are matched to the samples of the target. "
        "With a dense map three quarters as many are taken, and at least twice as many as points",
    )
    hypotheses: int = setting(
        6,
        "Hypotheses",
        1,
        32,
        "How many distinct coarse matchings are followed up before the best is chosen. "
        "Nearly symmetric shapes have several that are almost equally good. With a dense map half as many are taken",
    )
    histogram_bins: int = setting(
        32, "Histogram Bins", 4, 256, "Number of bins of the distance histograms that describe a point"
    )
    eigenfunctions: int = setting(6, "Eigenfunctions", 2, 10, "How many of the lowest eigenfunctions describe a point")
    eigenpairs: int = setting(
        100,
        "Eigenpairs",
        10,
        500,
        "How many eigenpairs of the Laplace-Beltrami operator make up diffusion distances and kernel signatures",
    )
    node_limit: int = setting(
        100_000,
        "Search Limit",
        1,
        1_000_000_000,
        "After how many nodes the exact search stops with the best matching so far and a bound on the optimum",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        # The flat solver has no coarse points, and a bijective match as many candidates as points.
        offered = self.solver != "flat" and self.constraint != "bijective"
        if offered and self.coarse_candidates < self.coarse_points:
            raise SettingsError(
                f"{self.coarse_points} Coarse Points need at least as many Coarse Candidates, "
                f"not {self.coarse_candidates}."
            )


SETUPS: dict[str, tuple[str, dict[str, str]]] = {
    "a": ("Geodesic Histograms", {"metric": "geodesic", "descriptor": "histogram"}),
    "b": ("Diffusion Histograms", {"metric": "diffusion", "descriptor": "histogram"}),
    "c": ("Heat Kernel Signatures", {"metric": "diffusion", "descriptor": "heat_kernel"}),
    "d": ("Laplace-Beltrami Eigenfunctions", {"metric": "geodesic", "descriptor": "eigenfunctions"}),
}
"""The four setups of figure 2 of the paper: for each a name, and the settings that make it."""
