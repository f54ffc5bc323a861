# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings in the order and groups in which they are read, and which of them matter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from .properties import SETTING_NAMES, setting_of

if TYPE_CHECKING:
    from .properties import MatchOptions

__all__ = ["shown_groups"]

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


def _matters(name: str, options: MatchOptions) -> bool:
    """Return whether a setting changes anything, as the others are."""
    metric, descriptor = setting_of(options, "metric"), setting_of(options, "descriptor")
    if name == "diffusion_time":
        return bool(metric == "diffusion")
    if name in ("comparison", "histogram_bins"):
        return descriptor in _WITH_HISTOGRAMS
    if name == "eigenfunctions":
        return bool(descriptor == "eigenfunctions")
    if name == "eigenpairs":
        return bool(metric == "diffusion" or descriptor != "histogram")
    if name == "settle":
        return bool(setting_of(options, "solver") == "hierarchical")
    if name in _GROUPS["Coarse Match"] and name != "node_limit":
        return bool(setting_of(options, "solver") != "flat")
    return True


def shown_groups(options: MatchOptions) -> list[tuple[str, list[str]]]:
    """List the settings that matter, but for the number of points, which stands apart.

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
    others = [name for name in SETTING_NAMES if name not in grouped and name != "points"]
    groups: list[tuple[str, Any]] = [("", others), *_GROUPS.items()]
    shown = [(title, [name for name in names if _matters(name, options)]) for title, names in groups]
    return [(title, names) for title, names in shown if names]
