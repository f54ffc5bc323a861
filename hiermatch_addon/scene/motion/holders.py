# SPDX-License-Identifier: GPL-3.0-or-later
"""Influences on bones and armatures beside curves of their own: constraints that act, drivers, parents, deltas."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from .action_curves import every_curve, moves, playing, slot_curves, slot_for

if TYPE_CHECKING:
    from collections.abc import Iterator

_LEAVING = ("FLOOR", "LIMIT_DISTANCE", "LIMIT_LOCATION", "LIMIT_ROTATION", "LIMIT_SCALE", "MAINTAIN_VOLUME")
"""Types of constraints that leave a bone to its own curves within limits, and take no place from anything else."""


def acts(constraint: Any, action: bpy.types.Action | None = None) -> bool:  # noqa: ANN401 - the stubs know the base
    """Tell whether a constraint of an object, or of one of its bones, does anything, or may do so in some frame.

    Parameters
    ----------
    constraint : bpy.types.Constraint
        The constraint.
    action : bpy.types.Action, optional
        What the object is to play, beside what it plays.
    """
    owner = constraint.id_data
    if constraint.mute or constraint.influence > 0:
        return not constraint.mute
    played = [bpy.data.actions[name] for name in playing(owner)] + ([] if action is None else [action])
    curves = [curve for each in played for curve in every_curve(each)]
    curves += () if owner.animation_data is None else owner.animation_data.drivers
    return any(curve.data_path == f"{constraint.path_from_id()}.influence" for curve in curves)


def holds(constraint: Any) -> bool:  # noqa: ANN401 - see above
    """Tell whether a constraint acts and gives its bone a place or a direction of its own."""
    return constraint.type not in _LEAVING and acts(constraint)


def is_carried(armature: bpy.types.Object, action: bpy.types.Action) -> bool:
    """Tell whether more moves an armature as a whole than curves of its place and rotation.

    Constraints and drivers do, delta curves of the action, and a parent that is moved.
    """
    deltas = (each for each in slot_curves(action, slot_for(action, armature)) if each.data_path.startswith("delta_"))
    return any(moves(curve) for curve in deltas) or any(
        any(acts(constraint, action) for constraint in each.constraints)
        or _is_driven(each)
        or each.parent_type in {"BONE", "VERTEX", "VERTEX_3"}
        or (each != armature and bool(playing(each)))
        for each in _with_parents(armature)
    )


def _with_parents(obj: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Go through an object and all that it hangs on."""
    above: bpy.types.Object | None = obj
    while above is not None:
        yield above
        above = above.parent


def _is_driven(obj: bpy.types.Object) -> bool:
    """Tell whether drivers move an object as a whole."""
    drivers = () if obj.animation_data is None else obj.animation_data.drivers
    places = ("location", "rotation_", "delta_")
    return any(not curve.mute and curve.data_path.startswith(places) for curve in drivers)
