# SPDX-License-Identifier: GPL-3.0-or-later
"""The matching engine of HierMatch: NumPy and SciPy only, no Blender."""

from .errors import HierMatchError, MatchError, MeshError, SettingsError
from .mesh import TriangleMesh
from .progress import Progress, run
from .result import CoarseMatch, Level, MatchResult
from .settings import MatchSettings
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
    "SurfacePoints",
    "TriangleMesh",
    "run",
]
