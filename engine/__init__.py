# SPDX-License-Identifier: GPL-3.0-or-later
"""The matching engine of HierMatch: NumPy and SciPy only, no Blender."""

from .closest_points import ClosestPoints
from .dense_match import DenseMatch, densify, densify_steps
from .errors import HierMatchError, MatchError, MeshError, RigError, SettingsError
from .fitted_rig import FittedRig
from .matching import match, match_steps
from .mesh import TriangleMesh
from .progress import Progress, run
from .quality import MatchQuality
from .result import CoarseMatch, Level, MatchResult
from .retrieval import Retrieval, RetrievalSettings, RetrievedMatch, retrieve, retrieve_steps
from .rig_fit import fit_rig, fit_rig_steps
from .settings import MatchSettings
from .shape import Shape
from .skeleton import Skeleton
from .surface import SurfacePoints
from .surface_map import SurfaceMap
from .symmetry import SymmetryResult, find_symmetry, find_symmetry_steps
from .symmetry_map import symmetry_map, symmetry_map_steps

__all__ = [
    "ClosestPoints",
    "CoarseMatch",
    "DenseMatch",
    "FittedRig",
    "HierMatchError",
    "Level",
    "MatchError",
    "MatchQuality",
    "MatchResult",
    "MatchSettings",
    "MeshError",
    "Progress",
    "Retrieval",
    "RetrievalSettings",
    "RetrievedMatch",
    "RigError",
    "SettingsError",
    "Shape",
    "Skeleton",
    "SurfaceMap",
    "SurfacePoints",
    "SymmetryResult",
    "TriangleMesh",
    "densify",
    "densify_steps",
    "find_symmetry",
    "find_symmetry_steps",
    "fit_rig",
    "fit_rig_steps",
    "match",
    "match_steps",
    "retrieve",
    "retrieve_steps",
    "run",
    "symmetry_map",
    "symmetry_map_steps",
]
