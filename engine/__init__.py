# SPDX-License-Identifier: GPL-3.0-or-later
"""The matching engine of HierMatch: NumPy and SciPy only, no Blender."""

from .errors import HierMatchError, MatchError, MeshError, SettingsError
from .matching import match, match_steps
from .mesh import TriangleMesh
from .progress import Progress, run
from .result import CoarseMatch, Level, MatchResult
from .settings import MatchSettings
from .shape import Shape
from .surface import SurfacePoints

__all__ = [
    "CoarseMatch",
    "HierMatchError",
    "Level",
    "MatchError",
    "MatchResult",
    "MatchSettings",
    "MeshError",
    "Progress",
    "SettingsError",
    "Shape",
    "SurfacePoints",
    "TriangleMesh",
    "match",
    "match_steps",
    "run",
]
