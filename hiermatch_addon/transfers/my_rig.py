# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig of one's own choice for the target: an armature that stands in the source, copied and fitted."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
from scipy.sparse import csr_array

from ...engine import (
    Columns,
    Skeleton,
    carry_standing_rig_steps,
    carry_weights_steps,
    moved_into,
    pair_bones,
    paired_weights,
    put_in,
    standing_share,
    standing_weights,
    within,
)
from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..common.phrases import counted, listed
from ..jobs.transfer import Transfer, TransferReport
from ..scene.armature_copy import copy_to, move_joints, repoint
from ..scene.armatures import armature_of, bone_normals, find_armature, moving_armatures, read_rig, read_skeleton
from ..scene.binding import bind, hang_in_place, lost_poses, replaced_remarks, unbind
from ..scene.bone_constraints import adapt_constraints, displaced_notes
from ..scene.character import parts_of, read_surface
from ..scene.deform_layer import check_weights_writable
from ..scene.key_drivers import counterparts
from ..scene.motion.rigs import check_armature
from ..scene.pair import check_writable, named_object
from .weight_groups import group_columns, locked_groups, write_groups

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import PlacedJoints, Steps
    from ..jobs.transfer import Passage
    from ..scene.character import Side
    from .options.my_rig import MyRigSettings

_STANDS = 0.5
"""Part of an armature's deforming bones that lies inside of a body from which on it stands there.  A human metarig that
was put to the joints of six of MakeHuman's people has 0.73 and more, one that was only moved there, in another pose,
0.34 at most (`standing_share`)."""

_MADE: Final = "hiermatch_my_rig"
"""Custom property of a fitted armature: the names of the one that it was copied from, and of the body, as JSON."""


def _made_before(context: bpy.types.Context, model: bpy.types.Object, target: Side) -> bpy.types.Object | None:
    """Find the armature of the file's own that was made of another one for a target before, if it is still there."""
    made, objects = json.dumps([model.name, target.name]), cast("Any", view_layer_of(context)).objects
    found = (obj for obj in objects if obj is not None and obj.type == "ARMATURE" and obj.get(_MADE) == made)
    return next((obj for obj in found if obj.library is None and obj.data.library is None), None)


def check_has_body(source: Side) -> None:
    """Make sure that the source is something in which an armature can stand.

    Raises
    ------
    ObjectError
        If it is an armature that moves no mesh.
    """
    if getattr(source, "type", "") == "ARMATURE":
        raise ObjectError(
            f'"{source.name}" moves no mesh, so nothing tells where in a body its joints belong. Choose as the '
            "Source a mesh in which it stands, and name the armature as the Rig."
        )


class MyRigTransfer(Transfer):
    """Fits an armature that stands in the source into the target; see `Transfer`.

    Parameters
    ----------
    settings : MyRigSettings
        Which, and how.
    """

    label = "Rig"

    def __init__(self, settings: MyRigSettings) -> None:
        self._settings = settings
        self._names: tuple[str, ...] = ()
        self._deforming: NDArray[np.bool_] = np.zeros(0, bool)
        self._normals: NDArray[np.float64] = np.empty((0, 3))
        self._stands: Skeleton | None = None
        self._placed: PlacedJoints | None = None
        self._frames: NDArray[np.float64] = np.eye(3)[None]
        self._space: NDArray[np.float64] = np.eye(4)
        self._held: NDArray[np.bool_] = np.zeros(0, bool)
        self._before: csr_array = csr_array((0, 0))
        self._weights: csr_array | None = None
        self._remarks: list[str] = []

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read the bones as they stand in the source, and make sure that the target can be bound if it is to be."""
        armature = self._armature()
        check_armature(armature, written=False)
        if armature in moving_armatures(source):
            raise ObjectError(
                f'"{armature.name}" moves "{source.name}". To give a target the rig that moves the source, use '
                "Retarget with Rig on."
            )
        bones = armature_of(armature).bones
        self._names = tuple(bone.name for bone in bones)
        self._deforming = np.array([bone.use_deform for bone in bones], bool)
        if not self._deforming.any():
            self._deforming[:] = True
        self._normals = bone_normals(armature)
        stands = [np.array(parts_of(side)[0].matrix_world.to_quaternion().to_matrix()) for side in (source, target)]
        self._frames = np.stack([np.eye(3), stands[1] @ stands[0].T])
        self._space = np.array(parts_of(target)[0].matrix_world, np.float64)
        self._stands = self._standing(context, armature, source)
        if self._settings.bind:
            self._read_weights(armature, source, target)

    def steps(self, passage: Passage) -> Steps[None]:
        """Place the joints, and compute weights if they are wanted."""
        pair, skeleton = passage.pair, cast("Skeleton", self._stands)
        maps = pair.source_to_target, pair.target_to_source
        placing = carry_standing_rig_steps(
            pair.source,
            pair.target,
            *maps,
            skeleton=skeleton,
            normals=self._normals,
            frames=self._frames,
            space=self._space,
        )
        placed = self._placed = yield from within(placing, 0.0, 0.5 if self._settings.bind else 1.0)
        rig = passage.rig
        if not self._settings.bind or rig is None:
            return
        carrying = carry_weights_steps(rig.weights, pair.source, pair.target, pair.target_to_source)
        carried = yield from within(carrying, 0.5, 0.8)
        fitted = Skeleton(skeleton.parents, placed.heads, placed.tails)
        near = standing_weights(pair.target, fitted, self._deforming)
        found = pair_bones(rig, pair.source, pair.target, fitted, near, frames=self._frames)
        handed = paired_weights(carried.weights, pair.target.vertices, found, rig.skeleton, fitted)
        columns = Columns(self._held, self._deforming, self._deforming, yielding=True)
        self._weights = put_in(self._before, handed, columns, limit=self._settings.limit)

    def check(self) -> None:
        """Make sure that the armature is as it was."""
        model = self._armature()
        if tuple(bone.name for bone in armature_of(model).bones) != self._names:
            raise ObjectError(f'The bones of "{model.name}" were changed meanwhile. Nothing was written.')

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Copy the armature, or take the copy of before, move its bones, and bind the target if that is wanted."""
        model, first = self._armature(), parts_of(target)[0]
        before = _made_before(context, model, target)
        armature = before or copy_to(context, model, f"{model.name} {target.name}", first)
        cast("Any", armature)[_MADE] = json.dumps([model.name, target.name])
        missing = move_joints(context, armature, self._names, cast("PlacedJoints", self._placed))
        places = counterparts(source, first, find_armature(source), find_armature(target))
        notes = repoint(armature, {**places, model: armature, armature_of(model): armature_of(armature)})
        adapt_constraints(model, armature)
        if missing:
            notes.append(f'"{armature.name}", which was made before, lacks {listed(missing)}.')
        done = [f'the rig "{armature.name}" with {counted(len(self._names), "bone")}', *(["updated"] if before else [])]
        if self._weights is not None:
            done.append(self._write_weights(target))
            if armature.parent is None:
                hang_in_place(armature, target, ())
            notes += bind(target, armature, source, ())
            replaced = unbind(target, armature, ())
            notes += lost_poses(target, replaced)
            self._remarks += replaced_remarks(target, replaced)
        elif armature not in moving_armatures(target):
            self._remarks.append(
                f'"{armature.name}" moves nothing yet. Generate its control rig, or bind "{target.name}" to it.'
            )
        view_layer_of(context).update()
        notes += displaced_notes(armature)
        return TransferReport(", ".join(done), tuple(notes), tuple(self._remarks))

    def _armature(self) -> bpy.types.Object:
        """Find the armature that is meant."""
        if not self._settings.name:
            raise ObjectError("Which armature is to be fitted is open. Name one as the Rig.")
        armature = named_object(self._settings.name)
        if armature.type != "ARMATURE":
            raise ObjectError(f'"{armature.name}" is not an armature. Name one as the Rig.')
        return armature

    def _standing(self, context: bpy.types.Context, armature: bpy.types.Object, source: Side) -> Skeleton:
        """Return the bones as they stand in the source; one that stands elsewhere is moved there first."""
        bones = read_skeleton(armature)
        body = read_surface(source, context.evaluated_depsgraph_get(), use_modifiers=False)
        if standing_share(bones, body, self._deforming) >= _STANDS:
            return bones
        moved = moved_into(bones, body, self._deforming, np.array([0.0, 0, 1]))
        if standing_share(moved, body, self._deforming) < _STANDS:
            raise ObjectError(
                f'"{armature.name}" does not stand in "{source.name}": most of its bones lie outside, also if it is '
                "moved there and scaled. Move its joints into that body in Edit Mode first."
            )
        self._remarks.append(f'"{armature.name}" did not stand in "{source.name}", so it was moved there and scaled.')
        return moved

    def _read_weights(self, armature: bpy.types.Object, source: Side, target: Side) -> None:
        """Read what binding needs."""
        for part in parts_of(target):
            check_writable(part)
            check_weights_writable(part)
        if read_rig(source) is None:
            raise ObjectError(
                f'"{source.name}" has no weights that could be handed to the bones of "{armature.name}". Switch Bind '
                "with Weights off, and bind the target by Blender's automatic weights afterwards."
            )
        locked = locked_groups(target)
        self._held = np.array([name in locked for name in self._names], bool)
        self._before = group_columns(target, self._names)

    def _write_weights(self, target: Side) -> str:
        """Write the groups of the bones that move something, and return what to say of it."""
        weights = cast("csr_array", self._weights).tocsc()
        written = np.flatnonzero((np.diff(weights.indptr) > 0) & ~self._held)
        write_groups(target, [self._names[number] for number in written], weights[:, written].tocsr())
        return counted(len(written), "vertex group")
