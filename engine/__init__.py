# SPDX-License-Identifier: GPL-3.0-or-later
"""The matching engine of HierMatch: NumPy and SciPy only, no Blender."""

from .errors import HierMatchError, MatchError, MeshError, SettingsError
from .matching import match, match_steps
from .mesh import TriangleMesh
from .progress import Progress, run
from .result import CoarseMatch, Level, MatchResult
from .retrieval import Retrieval, RetrievalSettings, RetrievedMatch, retrieve, retrieve_steps
from .settings import MatchSettings
from .shape import Shape
from .surface import SurfacePoints
from .symmetry import SymmetryResult, find_symmetry, find_symmetry_steps

__all__ = [
    "CoarseMatch",
    "HierMatchError",
    "Level",
    "MatchError",
    "MatchResult",
    "MatchSettings",
    "MeshError",
    "Progress",
    "Retrieval",
    "RetrievalSettings",
    "RetrievedMatch",
    "SettingsError",
    "Shape",
    "SurfacePoints",
    "SymmetryResult",
    "TriangleMesh",
    "find_symmetry",
    "find_symmetry_steps",
    "match",
    "match_steps",
    "retrieve",
    "retrieve_steps",
    "run",
]
