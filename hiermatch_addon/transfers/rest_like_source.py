# SPDX-License-Identifier: GPL-3.0-or-later
"""A rest pose like the source's for the target: so the source's actions play on its new rig."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from ...engine import Progress, at_rest, length_ratio, rest_pose
from ..common.access import view_layer_of
from ..common.errors import NothingToCarryError
from ..common.phrases import listed
from ..jobs.transfer import Transfer, TransferReport
from ..scene.armature_copy import move_joints
from ..scene.armatures import bone_weights, find_armature
from ..scene.binding import made_rig, worn_with
from ..scene.posing.rest_mesh_io import bring_to_rest, plays_actions, why_not_to_rest
from ..scene.rest_action import keep_pose, pose_bases, was_kept
from ..storage.halves import moved_by_us

if TYPE_CHECKING:
    import bpy
    from mathutils import Matrix

    from ...engine import RestPose, Steps
    from ..jobs.transfer import Passage
    from ..scene.character import Side
    from .options.rig import RigSettings
    from .rig import RigTransfer


class RestLikeSource(Transfer):
    """Brings the target, with its new rig, to a rest pose like the source's; see `Transfer`.

    It is written last of all kinds: what others carry belongs to the pose that the target stood in.

    Parameters
    ----------
    settings : RigSettings
        How.
    rig : RigTransfer
        What places the joints in the pose that the target stands in.
    """

    label = "Rest Pose"

    def __init__(self, settings: RigSettings, rig: RigTransfer) -> None:
        self._settings, self._rig = settings, rig
        self._rest: RestPose | None = None
        self._ratio = 1.0

    def read(self, _context: bpy.types.Context, source: Side, _target: Side) -> None:
        """Find out whether it is wanted.

        Raises
        ------
        NothingToCarryError
            If it is not, or there is no rig: without words, since that is no news.
        """
        armature, settings = find_armature(source), self._settings
        if armature is None or not self._rig.names or not settings.bind:
            raise NothingToCarryError("")
        automatic = settings.like_source == "AUTO" and settings.pose != "REST" and plays_actions(armature)
        if not (automatic or settings.like_source == "ON"):
            raise NothingToCarryError("")
        self._rig.leave_rest_pose()

    def steps(self, passage: Passage) -> Steps[None]:
        """Find the rest pose."""
        placed, fitted = self._rig.placed, passage.rig
        if placed is None or fitted is None:
            return
        yield Progress(0.0, "Finding the rest pose")
        self._rest = rest_pose(fitted, passage.pair.source, placed, self._rig.frames)
        self._ratio = length_ratio(fitted, passage.pair.source, self._rest)

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Move the bones and the mesh, and keep how the target stood as an action."""
        model, rest = find_armature(source), self._rest
        placed = self._rig.placed
        armature = None if model is None else made_rig(target, model)
        if rest is None or placed is None or armature is None:
            return TransferReport("")
        names = self._rig.names
        weights = bone_weights(target, armature, names)
        reason = why_not_to_rest(target, armature, weights)
        if reason:
            return TransferReport(
                "", (f"The rest pose stays as it was, and the source's actions do not play as they should: {reason}.",)
            )
        first = not was_kept(armature)
        if first:  # later it has that size already
            _resize(context, armature, self._ratio)
        move_joints(context, armature, names, at_rest(placed, rest))
        with moved_by_us(target):
            bring_to_rest(target, weights, rest)
        remarks, notes = [], []
        if first:
            action = keep_pose(armature, f"{target.name} As It Was", self._bases(armature))
            remarks.append(
                f'"{target.name}" has the rest pose of "{source.name}" now, in which the actions of "{source.name}" '
                f'play. How it stood is kept as the action "{action.name}".'
            )
            if worn := worn_with(armature):
                notes.append(f'What "{target.name}" wears stands as before: {listed(worn)}. Fit it again by Wear.')
        view_layer_of(context).update()
        return TransferReport("a rest pose like the source's", tuple(notes), tuple(remarks))

    def _bases(self, armature: bpy.types.Object) -> dict[str, Matrix]:
        """Find the pose in which the target looks as it did."""
        rest = cast("RestPose", self._rest)
        back = rest.turns.transpose(0, 2, 1)
        return pose_bases(armature, self._rig.names, back, rest.heads, rest.posed_heads)


def _resize(context: bpy.types.Context, armature: bpy.types.Object, ratio: float) -> None:
    """Scale an armature object by how much larger its body is, so that steps grow with it; what hangs on it stays.

    Actions move bones in the units of the object.
    """
    children = {child: child.matrix_world.copy() for child in armature.children}
    matrix = armature.matrix_world.copy()
    for axis in range(3):
        for row in range(3):
            matrix[row][axis] *= ratio
    armature.matrix_world = matrix
    view_layer_of(context).update()
    for child, stood in children.items():
        local = child.matrix_basis
        child.matrix_parent_inverse = armature.matrix_world.inverted_safe() @ stood @ local.inverted_safe()
    view_layer_of(context).update()
