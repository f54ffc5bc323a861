# SPDX-License-Identifier: GPL-3.0-or-later
"""The left-right map of a surface for every vertex."""

from __future__ import annotations

from ..dense.densify import densify_steps
from ..dense.quality import DenseMatch
from ..hierarchical.settings import MatchSettings
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.background import can_go_beside
from ..runtime.progress import Steps, at_once, within
from ..shapes.shape import Shape, shape_steps
from .symmetry import find_symmetry_steps


@can_go_beside
def symmetry_map_steps(surface: TriangleMesh | Shape, settings: MatchSettings | None = None) -> Steps[DenseMatch]:
    """Map every vertex of a surface to its mirror image on the same surface.

    Parameters
    ----------
    surface : TriangleMesh or Shape
        The surface, in any pose.
    settings : MatchSettings, optional
        How the sparse symmetry is searched, see `find_symmetry`.

    Returns
    -------
    DenseMatch
        The map in `source_to_target`, and its inverse in `target_to_source`: if it mirrors, the same map once more.

    Raises
    ------
    MatchError
        If the surface has too few vertices for the points.
    MeshError, SettingsError
        If the surface is none, as its arrays, or the settings are others, as a dictionary.

    See Also
    --------
    find_symmetry : the sparse symmetry, how symmetric the surface is, and its axis.
    """
    settings = MatchSettings.checked(settings)
    shape = yield from within(shape_steps(surface), 0.0, 0.05)
    symmetry = yield from within(find_symmetry_steps(shape, settings, alternatives=0), 0.05, 0.4)
    steps = densify_steps(shape, shape, symmetry.source_points, symmetry.target_points)
    return (yield from within(steps, 0.4, 1.0))


symmetry_map = at_once(symmetry_map_steps)
