# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings in the order and groups in which they are read, and which of them matter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from .properties import SETTING_NAMES, setting_of

if TYPE_CHECKING:
    from .properties import MatchOptions

APART: Final = ("points", "dense")
"""The settings that stand apart from all others, where they are seen first."""

_GROUPS: Final[dict[str, tuple[str, ...]]] = {
    "Metric and Descriptor": (
        "metric",
        "diffusion_time",
        "descriptor",
        "comparison",
        "histogram_bins",
        "eigenfunctions",
        "eigenpairs",
        "linear_weight",
        "quadratic_weight",
    ),
    "Coarse Match": ("coarse_points", "coarse_candidates", "constraint", "hypotheses", "node_limit"),
    "Refinement": ("samples", "neighbourhood", "settle"),
}
"""Settings of the engine that are named nowhere here come first, in a group without a name."""

# The sign of an eigenfunction is arbitrary; histograms tell which signs are consistent.
_WITH_HISTOGRAMS = ("histogram", "eigenfunctions")

# The flat solver has no coarse step; only the limit of the exact search is its own, too.
_OF_COARSE_STEP = ("coarse_points", "coarse_candidates", "constraint", "hypotheses", "neighbourhood")


def _matters(name: str, options: MatchOptions) -> bool:
    """Return whether a setting changes anything, as the others are."""
    metric, descriptor = setting_of(options, "metric"), setting_of(options, "descriptor")
    solver = setting_of(options, "solver")
    conditions = {
        "diffusion_time": metric == "diffusion",
        "comparison": descriptor in _WITH_HISTOGRAMS,
        "histogram_bins": descriptor in _WITH_HISTOGRAMS,
        "eigenfunctions": descriptor == "eigenfunctions",
        "eigenpairs": metric == "diffusion" or descriptor != "histogram",
        "settle": solver == "hierarchical",
        **dict.fromkeys(_OF_COARSE_STEP, solver != "flat"),
    }
    return bool(conditions.get(name, True))


def shown_groups(options: MatchOptions) -> list[tuple[str, list[str]]]:
    """List the settings that matter, but for those of `APART`.

    Parameters
    ----------
    options : MatchOptions
        The settings as they are.

    Returns
    -------
    list of (str, list of str)
        Title and names of each group; the title of the first, if it is not named above, is empty.
    """
    grouped = {name for names in _GROUPS.values() for name in names}
    others = [name for name in SETTING_NAMES if name not in (*grouped, *APART)]
    groups: list[tuple[str, Any]] = [("", others), *_GROUPS.items()]
    shown = [(title, [name for name in names if _matters(name, options)]) for title, names in groups]
    return [(title, names) for title, names in shown if names]
