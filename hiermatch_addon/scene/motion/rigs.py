# SPDX-License-Identifier: GPL-3.0-or-later
"""Armatures between which motion goes: which one is meant, whether it can be used, and how it stands in the world."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....engine import BonePairing, Skeleton, local_transforms
from ...common.errors import ObjectError
from ..armatures import armature_of, find_armature, read_skeleton

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ....engine import LocalTransforms, Motion
    from ..character import Side


def rig_of(side: Side) -> bpy.types.Object:
    """Return the armature object that is meant by itself or by what it moves.

    Raises
    ------
    ObjectError
        If there is none.
    """
    bare = getattr(side, "type", "") == "ARMATURE"
    armature = side if bare else find_armature(side)
    if armature is None:
        raise ObjectError(f'"{side.name}" has no armature. Choose an armature, or a mesh with an Armature modifier.')
    return armature  # type: ignore[return-value]  # a character is no armature


def two_rigs(source: Side, target: Side, *, written: bool) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Return the armatures of two sides, and make sure that they can be used; see `check_armature`."""
    rigs = rig_of(source), rig_of(target)
    check_armature(rigs[0], written=False)
    check_armature(rigs[1], written=written)
    if rigs[0] == rigs[1]:
        raise ObjectError(f'Source and Target are both "{rigs[0].name}". Choose two different armatures.')
    return rigs


def check_bones(armature: bpy.types.Object) -> None:
    """Make sure that the bones of an armature can be read.

    Raises
    ------
    ObjectError
        If not; the message says why and what to do.
    """
    if armature.mode == "EDIT":
        raise ObjectError(f'The armature "{armature.name}" is in Edit Mode. Switch to Object Mode first.')
    if not len(armature_of(armature).bones):
        raise ObjectError(f'The armature "{armature.name}" has no bones.')
    if abs(np.linalg.det(np.array(armature.matrix_world.to_3x3(), np.float64))) <= np.finfo(float).tiny:
        raise ObjectError(f'The armature "{armature.name}" has a scale of zero. Set its scale first.')


def check_armature(armature: bpy.types.Object, *, written: bool) -> None:
    """Make sure that an armature can be read, and keys or poses of it can be written.

    Raises
    ------
    ObjectError
        If not; the message says why and what to do.
    """
    check_bones(armature)
    if armature.matrix_world.is_negative:
        raise ObjectError(
            f'The armature "{armature.name}" is mirrored by its scale. Apply that first (Object > Apply > Scale).'
        )
    if written and armature.library is not None:
        raise ObjectError(
            f'The armature "{armature.name}" is linked from another file and cannot be animated here. Make a library '
            "override of its character first (Object > Library Override > Make)."
        )
    if written and armature.override_library is not None and armature.override_library.is_system_override:
        raise ObjectError(
            f'The armature "{armature.name}" is a library override that cannot be edited. Make it editable first '
            "(Object > Library Override > Make)."
        )
    if written and armature.animation_data is not None and armature.animation_data.use_tweak_mode:
        raise ObjectError(
            f'A strip of "{armature.name}" is being tweaked in the NLA editor, which holds its action. Leave the tweak '
            "mode there first (Tab)."
        )


def object_rotation(armature: bpy.types.Object) -> NDArray[np.float64]:
    """Return how an object is turned in the world, (3, 3), without its scale."""
    return np.array(armature.matrix_world.to_quaternion().to_matrix(), np.float64)


def rest_matrices(armature: bpy.types.Object) -> NDArray[np.float64]:
    """Return axes and head of each bone at rest, in the armature's own space, (b, 4, 4)."""
    return np.array([bone.matrix_local for bone in armature_of(armature).bones], np.float64).reshape(-1, 4, 4)


def local_poses(motion: Motion, armature: bpy.types.Object) -> LocalTransforms:
    """Return the transforms of an armature's bones against their parents, as Blender keeps them, in poses of it."""
    bones = armature_of(armature).bones
    inherits, local = (
        np.array([getattr(bone, f"use_{name}") for bone in bones], bool)
        for name in ("inherit_rotation", "local_location")
    )
    return local_transforms(motion, rest_matrices(armature)[:, :3, :3], inherits, local)


def own_skeleton(armature: bpy.types.Object) -> Skeleton:
    """Read the bones at rest in the armature's own space."""
    return read_skeleton(armature, np.eye(4))


def in_own_spaces(
    pairing: BonePairing, turns: tuple[NDArray[np.float64], NDArray[np.float64]], matrix: NDArray[np.float64]
) -> BonePairing:
    """Bring pairs that were found in the world into the armatures' own spaces, where they hold wherever these stand.

    Parameters
    ----------
    pairing : BonePairing
        The pairs.
    turns : (3, 3) array of float, twice
        How source and target are turned in the world.
    matrix : (4, 4) array of float
        The target's space in the world.
    """
    inverse = np.linalg.inv(matrix)
    return BonePairing(
        pairing.sources,
        pairing.targets,
        pairing.scores,
        turns[1].T @ pairing.rotations @ turns[0],
        pairing.places @ inverse[:3, :3].T + inverse[:3, 3],
        turns[1].T @ pairing.upright @ turns[0],
    )
