# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig for the target: the source's armature, copied, with its joints where they belong in the target."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, cast

import numpy as np

from ...engine import Progress, called_steps, is_posed, nearest_rotations, place_joints, rest_pose, within
from ..common.access import view_layer_of
from ..common.errors import NothingToCarryError, ObjectError
from ..common.phrases import counted, listed
from ..jobs.transfer import Transfer, TransferReport
from ..scene.armature_copy import copy_to, move_joints, repoint
from ..scene.armatures import bone_normals, find_armature, moving_armatures, read_rig
from ..scene.binding import bind, hang_in_place, lost_poses, made_rig, mark_made, replaced_remarks, unbind
from ..scene.bone_constraints import adapt_constraints, displaced_notes
from ..scene.character import parts_of
from ..scene.key_drivers import counterparts
from ..scene.motion.rigs import check_bones
from ..scene.pair import check_writable
from ..scene.posing.exercise import end_exercise, is_exercising
from ..scene.rest_action import make_rest_action, pose_bases

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import PlacedJoints, RestPose, Steps
    from ..jobs.transfer import Passage
    from ..scene.character import Side
    from .options.rig import RigSettings


class RigTransfer(Transfer):
    """Gives the target an armature like the source's; see `Transfer`.

    Parameters
    ----------
    settings : RigSettings
        How.

    Attributes
    ----------
    names : (b,) tuple of str
        Names of the bones.
    frames : (k, 3, 3) array of float
        Rotations that the whole target may be turned by against the source.
    placed : PlacedJoints or None
        The bones in the target, in world space; None as long as they are not placed.
    """

    label = "Rig"

    def __init__(self, settings: RigSettings) -> None:
        self._settings = settings
        self.names: tuple[str, ...] = ()
        self._normals: NDArray[np.float64] = np.empty((0, 3))
        self.frames: NDArray[np.float64] = np.empty((0, 3, 3))
        self.placed: PlacedJoints | None = None
        self._rest: RestPose | None = None
        self._notes: list[str] = []

    def read(self, _context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read the directions of the source's bones, and make sure that the target can be bound."""
        for part in parts_of(target):
            check_writable(part)
        armature = find_armature(source)
        if armature is None:
            raise NothingToCarryError(
                f'"{source.name}" has no armature, so there is no rig to fit. Give it an Armature modifier with its '
                "armature, or pick another Source."
            )
        rig = read_rig(source)
        if rig is None:
            raise ObjectError(
                f'No vertex of "{source.name}" is in a vertex group of a deforming bone of "{armature.name}", so it is '
                "not known what the bones belong to. Bind the Source to its armature with weights first."
            )
        check_bones(armature)
        others = [other.name for other in moving_armatures(source) if other != armature]
        if others:
            self._notes.append(
                f'"{source.name}" is moved by {listed(others)} as well as by "{armature.name}". Only the latter was '
                "fitted."
            )
        self.names = rig.names
        self._normals = bone_normals(armature)
        # The target stands as the source does: in the world, or each in the space of its object.
        stands = [parts_of(side)[0].matrix_world for side in (source, target)]
        turns = [np.array(matrix.to_3x3().normalized(), np.float64) for matrix in stands]
        self.frames = nearest_rotations(np.stack([np.eye(3), turns[1] @ np.linalg.inv(turns[0])]))

    def leave_rest_pose(self) -> None:
        """Make no rest pose: the target is brought to it otherwise."""
        self._settings = replace(self._settings, rest=False)

    def steps(self, passage: Passage) -> Steps[None]:
        """Place the joints, and find the rest pose."""
        rig, body = passage.rig, passage.pair.source
        if rig is None or passage.bone_names != self.names:
            raise ObjectError("The rig of the source was changed meanwhile. Nothing was written.")
        yield Progress(0.0, "Placing the joints")
        placing = called_steps(place_joints, rig, body, self._normals, self.frames)
        placed = self.placed = yield from within(placing, 0.0, 0.5)
        if not self._settings.rest or self._settings.pose == "REST":
            return
        yield Progress(0.5, "Finding the rest pose")
        posed = self._settings.pose == "POSED"
        if posed or (yield from within(called_steps(is_posed, rig, body, placed), 0.5, 0.6)):
            resting = called_steps(rest_pose, rig, body, placed, self.frames)
            self._rest = yield from within(resting, 0.6, 1.0)
        else:
            self._notes.append(
                "The target seems to be in its rest pose already, so none was made. If it is posed, set Pose to Posed."
            )

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Make the armature, or update the one made before, and bind the target to it."""
        model = cast("bpy.types.Object", find_armature(source))
        placed = cast("PlacedJoints", self.placed)
        first = parts_of(target)[0]
        made = self._made_before(target, model)
        armature = made or copy_to(context, model, f"{target.name} Rig", first)
        missing = move_joints(context, armature, self.names, placed)
        if made is None:
            self._notes += repoint(armature, counterparts(source, first, model, armature))
            mark_made(armature, model)
        elif missing:
            self._notes.append(f'"{armature.name}", which was made before, lacks {listed(missing)}.')
        adapt_constraints(model, armature)
        replaced: list[bpy.types.Object] = []
        if self._settings.bind:
            beside = self._kept_beside(target, model)
            if made is None:
                hang_in_place(armature, target, beside)
            self._notes += bind(target, armature, source, beside)
            replaced = unbind(target, armature, beside)
            self._notes += lost_poses(target, replaced)
        view_layer_of(context).update()
        self._notes += displaced_notes(armature) if made is None else []
        if not {group.name for part in parts_of(target) for group in part.vertex_groups} & set(self.names):
            self._notes.append(
                f'"{target.name}" has no weights for the bones of "{armature.name}" yet. Transfer the weights as well.'
            )
        bones = counted(len(self.names), "bone")
        done = [f'the rig "{armature.name}" with {bones}']
        if self._rest is not None:
            action = self._keep_rest(armature)
            done = [f'the rig "{armature.name}" with {bones} and the rest pose "{action}"']
        if made:
            done.append("updated")
        return TransferReport(", ".join(done), tuple(self._notes), tuple(replaced_remarks(target, replaced)))

    def _made_before(self, target: Side, model: bpy.types.Object) -> bpy.types.Object | None:
        """Return the armature that is to be updated, without test poses: with them what is written would be lost."""
        made = made_rig(target, model) if self._settings.existing == "UPDATE" else None
        if made is not None and is_exercising(made):
            end_exercise(made)
        return made

    def _kept_beside(self, target: Side, model: bpy.types.Object) -> list[bpy.types.Object] | None:
        """Return the armatures that are to move the target beside the new one; None for all."""
        if not self._settings.replace:
            return None
        made = made_rig(target, model) if self._settings.existing == "KEEP" else None
        return [] if made is None else [made]

    def _keep_rest(self, armature: bpy.types.Object) -> str:
        """Keep the rest pose as an action."""
        rest = cast("RestPose", self._rest)
        bases = pose_bases(armature, self.names, rest.turns, rest.posed_heads, rest.heads)
        action, notes = make_rest_action(armature, bases, show=self._settings.rest_shown)
        self._notes += notes
        return action.name
