# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine of HierMatch: NumPy and SciPy only, no Blender."""

from .dense.credibility import DOUBTFUL
from .dense.densify import densify, densify_steps
from .dense.quality import DenseMatch, MatchQuality, exchanged_sentence
from .geometry.geodesics import GeodesicSolver
from .geometry.procrustes import nearest_rotations, nearest_similarity
from .geometry.voronoi_labels import nearest_regions
from .hierarchical.settings import SETUPS, MatchSettings
from .hierarchical.sparse_result import CoarseMatch, Level
from .matching.followed_pairs import followed_share
from .matching.matching import match, match_steps
from .matching.refinement import distortion_after, placed_by_map, refine_map, refine_map_steps
from .matching.result import DIRECT, MIRRORED, MatchResult
from .matching.retrieval import Retrieval, RetrievalSettings, RetrievedMatch, retrieve, retrieve_steps
from .matching.symmetry import SymmetryResult, find_symmetry, find_symmetry_steps
from .matching.symmetry_map import symmetry_map, symmetry_map_steps
from .mesh.closest_points import ClosestPoints
from .mesh.polygons import Polygons
from .mesh.surface_map import SurfaceMap
from .mesh.surface_points import SurfacePoints
from .mesh.triangle_mesh import TriangleMesh
from .retarget.limbs.limb_tips import RiggedBody, paired_limb_tips
from .retarget.morphing import in_between
from .retarget.motion.bone_pairing import BonePairing, pair_bones
from .retarget.motion.key_reduction import reduced_keys, slopes_of
from .retarget.motion.motion_transfer import MotionSettings, TransferredMotion, transfer_motion, transfer_motion_steps
from .retarget.motion.paired_weights import paired_weights
from .retarget.motion.posed_motion import LocalTransforms, Motion, local_transforms, motion_of_matrices, posed_motion
from .retarget.motion.rotation_channels import rotation_channels, rotation_matrices
from .retarget.open_ends import open_ends
from .retarget.rig.fitted_rig import FittedRig
from .retarget.rig.humanoid import humanoid_bones
from .retarget.rig.joint_placement import PlacedJoints, place_joints
from .retarget.rig.rest_pose import RestPose, at_rest, is_posed, length_ratio, rest_pose, unposed
from .retarget.rig.rig_fit import fit_rig, fit_rig_steps
from .retarget.rig.skeleton import Skeleton
from .retarget.rig.standing_rig import carry_standing_rig, carry_standing_rig_steps, moved_into, standing_share
from .retarget.values.attribute_transfer import Crossing, Domain, carry_values_steps
from .retarget.values.closings import closings_kept_steps
from .retarget.values.corner_transfer import carry_normals, turned_normals
from .retarget.values.deformation_gradients import LocalFrames, bone_frames, evened_frames, surface_frames
from .retarget.values.edge_tracing import CarriedValues
from .retarget.values.face_correspondence import FacePlaces
from .retarget.values.face_transfer import carry_face_values
from .retarget.values.shape_key_transfer import Scaling, carry_offsets_steps
from .retarget.values.symmetrising import Symmetriser
from .retarget.values.uv_transfer import CarriedUVs, carry_uvs_steps
from .retarget.wear.body_ends import continues_body, ends_at_joint
from .retarget.wear.handed_weights import handed_weights, shares_below_steps
from .retarget.wear.hanging_cloth import hanging_triangles
from .retarget.wear.item_bones import bones_of_items, moved_with_items
from .retarget.wear.key_following import follow_keys_steps
from .retarget.wear.pose_lifting import lift_for_poses_steps
from .retarget.wear.pose_mending import MendedWeights, WeightedItem, mend_weights_steps
from .retarget.wear.wearing import wear_steps
from .retarget.wear.worn_item import FittedItem, WornItem
from .retarget.weights.skin_weights import carried as carry_weights
from .retarget.weights.skin_weights import row_shares, row_sums, with_rows
from .retarget.weights.standing_weights import standing_weights
from .retarget.weights.weight_transfer import CarriedWeights, Columns, carry_weights_steps, put_in
from .retarget.wrapping import WrappedSurface, kept_in_place, wrap_steps
from .runtime.background import Background, called_steps
from .runtime.errors import HierMatchError, MatchError, MeshError, RigError, SettingsError
from .runtime.progress import Preview, Progress, Steps, run, within
from .runtime.worker import call_background, close_helpers, use_processes
from .shapes.known_shapes import KnownShapes
from .shapes.shape import Shape
from .shapes.surface_distances import distances_to_vertices_steps

__all__ = [
    "DIRECT",
    "DOUBTFUL",
    "MIRRORED",
    "SETUPS",
    "Background",
    "BonePairing",
    "CarriedUVs",
    "CarriedValues",
    "CarriedWeights",
    "ClosestPoints",
    "CoarseMatch",
    "Columns",
    "Crossing",
    "DenseMatch",
    "Domain",
    "FacePlaces",
    "FittedItem",
    "FittedRig",
    "GeodesicSolver",
    "HierMatchError",
    "KnownShapes",
    "Level",
    "LocalFrames",
    "LocalTransforms",
    "MatchError",
    "MatchQuality",
    "MatchResult",
    "MatchSettings",
    "MendedWeights",
    "MeshError",
    "Motion",
    "MotionSettings",
    "PlacedJoints",
    "Polygons",
    "Preview",
    "Progress",
    "RestPose",
    "Retrieval",
    "RetrievalSettings",
    "RetrievedMatch",
    "RigError",
    "RiggedBody",
    "Scaling",
    "SettingsError",
    "Shape",
    "Skeleton",
    "Steps",
    "SurfaceMap",
    "SurfacePoints",
    "Symmetriser",
    "SymmetryResult",
    "TransferredMotion",
    "TriangleMesh",
    "WeightedItem",
    "WornItem",
    "WrappedSurface",
    "at_rest",
    "bone_frames",
    "bones_of_items",
    "call_background",
    "called_steps",
    "carry_face_values",
    "carry_normals",
    "carry_offsets_steps",
    "carry_standing_rig",
    "carry_standing_rig_steps",
    "carry_uvs_steps",
    "carry_values_steps",
    "carry_weights",
    "carry_weights_steps",
    "close_helpers",
    "closings_kept_steps",
    "continues_body",
    "densify",
    "densify_steps",
    "distances_to_vertices_steps",
    "distortion_after",
    "ends_at_joint",
    "evened_frames",
    "exchanged_sentence",
    "find_symmetry",
    "find_symmetry_steps",
    "fit_rig",
    "fit_rig_steps",
    "follow_keys_steps",
    "followed_share",
    "handed_weights",
    "hanging_triangles",
    "humanoid_bones",
    "in_between",
    "is_posed",
    "kept_in_place",
    "length_ratio",
    "lift_for_poses_steps",
    "local_transforms",
    "match",
    "match_steps",
    "mend_weights_steps",
    "motion_of_matrices",
    "moved_into",
    "moved_with_items",
    "nearest_regions",
    "nearest_rotations",
    "nearest_similarity",
    "open_ends",
    "pair_bones",
    "paired_limb_tips",
    "paired_weights",
    "place_joints",
    "placed_by_map",
    "posed_motion",
    "put_in",
    "reduced_keys",
    "refine_map",
    "refine_map_steps",
    "rest_pose",
    "retrieve",
    "retrieve_steps",
    "rotation_channels",
    "rotation_matrices",
    "row_shares",
    "row_sums",
    "run",
    "shares_below_steps",
    "slopes_of",
    "standing_share",
    "standing_weights",
    "surface_frames",
    "symmetry_map",
    "symmetry_map_steps",
    "transfer_motion",
    "transfer_motion_steps",
    "turned_normals",
    "unposed",
    "use_processes",
    "wear_steps",
    "with_rows",
    "within",
    "wrap_steps",
]
