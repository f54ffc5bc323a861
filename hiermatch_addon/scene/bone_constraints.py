# SPDX-License-Identifier: GPL-3.0-or-later
"""Constraints of bones whose settings hold for one shape of the armature only, set right for another.

A constraint that leaves its bone alone in the source's rest pose is to leave it alone in the new one too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..common.phrases import listed
from .armatures import armature_of, pose_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy
    from mathutils import Vector

_DISPLACED = 0.02
"""A bone counts as moved if an end of it is away from rest by more than this part of its length: less is the tolerance
of Blender's IK solver."""

_NEUTRAL = 1e-3
"""How far the matrix of a constraint that does nothing may be from the identity."""

_LENGTHS = {"STRETCH_TO": ("rest_length",), "LIMIT_DISTANCE": ("distance",), "FLOOR": ("offset",)}
"""Settings that are lengths, whatever space the constraint works in."""

_ENDS = tuple(f"{end}_{axis}" for end in ("min", "max") for axis in "xyz")
"""Names of ranges, which are lengths as well where they are of locations in a bone's own space."""

_LOCAL = ("LOCAL", "LOCAL_WITH_PARENT", "LOCAL_OWNER_ORIENT")


def adapt_constraints(source: bpy.types.Object, armature: bpy.types.Object) -> None:
    """Set angles and lengths in the constraints of an armature that was copied from `source` and changed in shape."""
    for bone in pose_of(armature).bones:
        model = pose_of(source).bones.get(bone.name)
        if model is None:
            continue
        growth = _growth(armature, source, bone.name)
        for constraint, before in zip(bone.constraints, model.constraints, strict=False):
            if constraint.type == before.type:
                _adapt((armature, constraint), (source, before), bone.name, growth)


def displaced_bones(armature: bpy.types.Object) -> list[str]:
    """Return the bones of an evaluated armature that its constraints or drivers move away from rest."""
    found = []
    for bone in pose_of(armature).bones:
        rest = armature_of(armature).bones[bone.name]
        ends = ((bone.head, rest.head_local), (bone.tail, rest.tail_local))
        if max((now - then).length for now, then in ends) > _DISPLACED * rest.length:
            found.append(bone.name)
    return found


def displaced_notes(armature: bpy.types.Object) -> list[str]:
    """Return what to say of bones of an evaluated armature that its constraints or drivers move away from rest."""
    displaced = displaced_bones(armature)
    said = (
        f'Constraints or drivers move {listed(displaced)} of "{armature.name}" away from rest, and the target '
        "with them. Check them."
    )
    return [said] if displaced else []


def _adapt(new: tuple[bpy.types.Object, Any], old: tuple[bpy.types.Object, Any], name: str, growth: float) -> None:
    """Set one constraint of a bone right, given with its armature, as is the one that it was copied from."""
    (armature, constraint), (source, before) = new, old
    if constraint.type == "IK" and constraint.pole_target is not None:
        turned = _pole_angle(armature, constraint, name), _pole_angle(source, before, name)
        if None not in turned:
            angle = before.pole_angle + cast("float", turned[0]) - cast("float", turned[1])
            constraint.pole_angle = (angle + np.pi) % (2 * np.pi) - np.pi
    elif constraint.type in _LENGTHS:
        _grow(constraint, before, _LENGTHS[constraint.type], growth)
    elif constraint.type == "LIMIT_LOCATION" and constraint.owner_space in _LOCAL:
        _grow(constraint, before, _ENDS, growth)
    elif constraint.type == "TRANSFORM":
        if constraint.map_to == "LOCATION" and constraint.owner_space in _LOCAL:
            _grow(constraint, before, [f"to_{end}" for end in _ENDS], growth)
        looked_at = constraint.subtarget if constraint.target == armature else ""
        if constraint.map_from == "LOCATION" and constraint.target_space in _LOCAL and looked_at:
            _grow(constraint, before, [f"from_{end}" for end in _ENDS], _growth(armature, source, looked_at))
    elif constraint.type == "CHILD_OF" and _leaves_alone(source, before):
        constraint.set_inverse_pending = True


def _grow(constraint: Any, before: Any, names: Iterable[str], growth: float) -> None:  # noqa: ANN401 - of any type
    """Set lengths of a constraint to those that it had before, so many times as large."""
    for name in names:
        setattr(constraint, name, growth * getattr(before, name))


def _growth(armature: bpy.types.Object, source: bpy.types.Object, name: str) -> float:
    """Return how many times as long a bone is as in the armature before; as long, if one of them lacks it."""
    all_bones = [armature_of(each).bones for each in (armature, source)]
    if any(name not in bones for bones in all_bones):
        return 1.0
    length, before = (bones[name].length for bones in all_bones)
    return length / max(before, 1e-12)


def _leaves_alone(armature: bpy.types.Object, constraint: Any) -> bool:  # noqa: ANN401
    """Tell whether a Child Of constraint to a bone of its own armature does nothing at rest."""
    if constraint.target != armature or constraint.subtarget not in armature_of(armature).bones:
        return False
    place = armature_of(armature).bones[constraint.subtarget].matrix_local
    # Whether the inverse is one in the armature's space or in the world is up to Blender's version.
    effects = (np.array(matrix @ constraint.inverse_matrix) for matrix in (place, armature.matrix_world @ place))
    return any(np.allclose(effect, np.eye(4), atol=_NEUTRAL) for effect in effects)


def _pole_angle(armature: bpy.types.Object, constraint: Any, name: str) -> float | None:  # noqa: ANN401
    """Find the pole angle with which a chain stays as it is at rest; None if that cannot be told."""
    bones = armature_of(armature).bones
    last = bones[name] if constraint.use_tail else bones[name].parent
    if last is None:
        return None
    first = last
    count = constraint.chain_count or len(bones)
    while first.parent is not None and count > 1:
        first, count = first.parent, count - 1
    pole = _pole(armature, constraint)
    if pole is None:
        return None
    start, axis = first.head_local, first.tail_local - first.head_local
    normal = (last.tail_local - start).cross(pole - start)
    across = normal.cross(axis)
    x_axis = first.matrix_local.to_3x3().col[0]
    if across.length < 1e-9 * axis.length**3:
        return None
    angle = x_axis.angle(across, 0.0)
    return -angle if x_axis.cross(across).dot(axis) < 0 else angle


def _pole(armature: bpy.types.Object, constraint: Any) -> Vector | None:  # noqa: ANN401
    """Where the pole of an IK constraint is at rest, in the armature's space."""
    target = constraint.pole_target
    if target is None:
        return None
    if target == armature and constraint.pole_subtarget in armature_of(armature).bones:
        return armature_of(armature).bones[constraint.pole_subtarget].head_local
    return armature.matrix_world.inverted_safe() @ target.matrix_world.translation
