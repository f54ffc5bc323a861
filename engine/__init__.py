# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine of HierMatch: NumPy and SciPy only, no Blender."""

from .dense.densify import DenseMatch, densify, densify_steps
from .dense.quality import MatchQuality
from .hierarchical.settings import MatchSettings
from .hierarchical.sparse_result import CoarseMatch, Level
from .matching.matching import match, match_steps
from .matching.result import MatchResult
from .matching.retrieval import Retrieval, RetrievalSettings, RetrievedMatch, retrieve, retrieve_steps
from .matching.symmetry import SymmetryResult, find_symmetry, find_symmetry_steps
from .matching.symmetry_map import symmetry_map, symmetry_map_steps
from .mesh.closest_points import ClosestPoints
from .mesh.polygons import Polygons
from .mesh.surface_map import SurfaceMap
from .mesh.surface_points import SurfacePoints
from .mesh.triangle_mesh import TriangleMesh
from .retarget.morphing import in_between
from .retarget.rig.fitted_rig import FittedRig
from .retarget.rig.joint_placement import PlacedJoints, place_joints
from .retarget.rig.rest_pose import RestPose, rest_pose
from .retarget.rig.rig_fit import fit_rig, fit_rig_steps
from .retarget.rig.skeleton import Skeleton
from .retarget.values.deformation_gradients import LocalFrames, bone_frames, surface_frames
from .retarget.values.shape_key_transfer import carry_offsets_steps
from .retarget.values.symmetrising import Symmetriser
from .retarget.values.uv_transfer import CarriedUVs, carry_uvs_steps
from .retarget.weights.skin_weights import carried as carry_weights
from .retarget.weights.weight_transfer import CarriedWeights, carry_weights_steps
from .retarget.wrapping import WrappedSurface, wrap_steps
from .runtime.errors import HierMatchError, MatchError, MeshError, RigError, SettingsError
from .runtime.progress import Progress, run
from .runtime.worker import use_processes
from .shapes.shape import Shape

__all__ = [
    "CarriedUVs",
    "CarriedWeights",
    "ClosestPoints",
    "CoarseMatch",
    "DenseMatch",
    "FittedRig",
    "HierMatchError",
    "Level",
    "LocalFrames",
    "MatchError",
    "MatchQuality",
    "MatchResult",
    "MatchSettings",
    "MeshError",
    "PlacedJoints",
    "Polygons",
    "Progress",
    "RestPose",
    "Retrieval",
    "RetrievalSettings",
    "RetrievedMatch",
    "RigError",
    "SettingsError",
    "Shape",
    "Skeleton",
    "SurfaceMap",
    "SurfacePoints",
    "Symmetriser",
    "SymmetryResult",
    "TriangleMesh",
    "WrappedSurface",
    "bone_frames",
    "carry_offsets_steps",
    "carry_uvs_steps",
    "carry_weights",
    "carry_weights_steps",
    "densify",
    "densify_steps",
    "find_symmetry",
    "find_symmetry_steps",
    "fit_rig",
    "fit_rig_steps",
    "in_between",
    "match",
    "match_steps",
    "place_joints",
    "rest_pose",
    "retrieve",
    "retrieve_steps",
    "run",
    "surface_frames",
    "symmetry_map",
    "symmetry_map_steps",
    "use_processes",
    "wrap_steps",
]
