# SPDX-License-Identifier: GPL-3.0-or-later
"""Carrying motion from one armature to others as a piece of work: pairing where needed, computing, writing at last."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np
from mathutils import Matrix

from ....engine import Motion, MotionSettings, Progress, transfer_motion_steps, within
from ...common.errors import ObjectError
from ...common.phrases import counted, listed
from ...jobs.stepped_job import SteppedJob
from ...jobs.transfer import TransferReport
from ...jobs.transfer_job import Carried
from ...properties.bone_pairs import pairing_notes, pairing_of, rows_of
from ...scene.armatures import armature_of, pose_of
from ...scene.character import SideReference
from ...scene.motion.action_curves import scaled_bones
from ...scene.motion.auto_keying import key_automatically
from ...scene.motion.control_rigs import driven_bones
from ...scene.motion.holders import acts, is_carried
from ...scene.motion.motion_io import (
    current_motion,
    evaluated_frames,
    grows,
    needs_evaluation,
    object_places,
    posed_at,
    set_pose,
    turned_above,
    with_object,
    write_action,
)
from ...scene.motion.nla_strips import copy_strips
from ...scene.motion.rigs import check_armature, local_poses, object_rotation, own_skeleton, rig_of, two_rigs
from ...scene.motion.source_keys_io import read_keys
from .action_keys import (
    SIDE_STEP,
    Movers,
    baked_frames,
    baked_keys,
    bone_channels,
    keys_suffice,
    movers_of,
    sparse_frames,
    sparse_keys,
)
from .bone_pairs import pairing_job
from .steered_rig import found_again, is_steered, steered_steps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ....engine import BonePairing, Steps, TransferredMotion
    from ...jobs.transfer_job import TransferJob, TransferOptions
    from ...jobs.verdict import Verdict
    from ...scene.character import Side
    from ...scene.motion.motion_io import BoneKeys
    from ...scene.motion.source_keys_io import ActionKeys
    from ..options.motion import MotionPlan
    from .bone_pairs import BonePairTransfer
    from .steered_rig import SteeredRig

_PAIRED = 0.6
"""Where on the progress bar pairing ends, if it is needed."""

_CHUNK, _EVALUATED_CHUNK = 240, 4
"""Frames read at once: from curves, and by letting Blender play them, which takes much longer."""

_FEW = 0.5
"""A source has few keys if they are at fewer than this part of its frames."""


class MotionJob(SteppedJob):
    """Carries motion from one armature to several others.

    Nothing is written before `finish`.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    source : bpy.types.Object or Character
        An armature, or what it moves.
    targets : sequence of bpy.types.Object or Character
        Others.
    plan : MotionPlan
        What is carried over.
    options : TransferOptions
        How bodies are matched whose rigs are not paired yet.

    Attributes
    ----------
    progress : Progress
        How far the work is.

    Raises
    ------
    HierMatchError
        If the objects do not allow it.
    """

    def __init__(
        self,
        context: bpy.types.Context,
        source: Side,
        targets: Sequence[Side],
        plan: MotionPlan,
        options: TransferOptions,
    ) -> None:
        self._begun, self._plan = time.perf_counter(), plan
        named: dict[bpy.types.Object, Side] = {}
        for target in targets:  # of several meshes of one rig the first
            named.setdefault(two_rigs(source, target, written=True)[1], target)
        self._source, self._targets = SideReference.of(rig_of(source)), [SideReference.of(rig) for rig in named]
        scene = cast("bpy.types.Scene", context.scene)
        self._scene = scene.name
        waiting = []
        for rig, target in named.items():
            if rows_of(scene, rig_of(source), rig):
                _check_channels(rig, pairing_of(scene, rig_of(source), rig))
            else:
                waiting.append((target, rig.session_uid))
        self._pairing: TransferJob | None = None
        self._pairs: dict[int, BonePairTransfer] = {}
        if waiting:
            self._pairing, made = pairing_job(context, source, [target for target, _ in waiting], options)
            self._pairs = {uid: one for (_, uid), one in zip(waiting, made, strict=True)}
        # By numbers of rigs, which may be renamed meanwhile.
        self._found: dict[tuple[int, str], list[BoneKeys]] = {}
        self._poses: dict[int, TransferredMotion] = {}
        self._steered: dict[int, SteeredRig] = {}
        self._fixed: dict[int, list[str]] = {}
        self._filled: list[str] = []
        super().__init__()

    def close(self) -> None:
        """Drop the work, and a pairing that is being made."""
        super().close()
        if self._pairing is not None:
            self._pairing.close()

    @property
    def doubts(self) -> list[tuple[str, Verdict]]:
        """See `TransferJob.doubts`."""
        return [] if self._pairing is None else self._pairing.doubts

    def accept(self) -> None:
        """See `TransferJob.accept`."""
        if self._pairing is not None:
            self._pairing.accept()

    def finish(self, context: bpy.types.Context) -> list[Carried]:
        """Write the actions or poses of all targets.

        Raises
        ------
        HierMatchError
            If an armature or an action has changed since it was read.
        """
        if not self._done:
            raise RuntimeError("The work has not come to its end yet.")
        source, *rigs = self._rigs()
        for rig in rigs:
            check_armature(rig, written=True)
        actions = [self._action(name) for name in self._plan.actions]
        paired = iter(self._pairing.finish(context) if self._pairing is not None else ())
        done = []
        for rig in rigs:
            before = next(paired) if rig.session_uid in self._pairs else None
            notes: list[str] = []
            made = {action.name: self._write(rig, action, notes, alone=len(actions) == 1) for action in actions}
            steered = self._steered.get(rig.session_uid)
            remarks = () if steered is None else steered.finished(rig)
            if not actions:
                notes += _set_pose(cast("bpy.types.Scene", context.scene), rig, self._poses[rig.session_uid], steered)
            metas = copy_strips(source, rig, made) if self._plan.strips else []
            if metas:
                notes.append(f"In the place of meta strips the strips within them were copied: {listed(metas)}.")
            moved = [row.target for row in rows_of(cast("bpy.types.Scene", context.scene), source, rig) if row.source]
            if steered is not None:
                moved = [name for name in moved if name in steered.controls.lost]
            played = not actions or (self._plan.assign and len(actions) == 1)
            notes += _notes(source, rig, actions, moved, played=played and steered is None)
            notes += self._left_out(cast("bpy.types.Scene", context.scene), source, rig)
            report = TransferReport(_said(made), tuple(notes), remarks)
            seconds = time.perf_counter() - self._begun
            if before is None:
                done.append(Carried(rig.name, None, (report,), seconds))
            else:
                reports = (*before.reports, report)
                done.append(replace(before, target=rig.name, reports=reports, seconds=seconds))
        return done

    def _left_out(self, scene: bpy.types.Scene, source: bpy.types.Object, rig: bpy.types.Object) -> list[str]:
        """Say what was not carried to a target."""
        notes = []
        if self._plan.left_out:
            notes.append(
                f'Actions that move only the object "{source.name}", and none of its bones, were left out: '
                f"{listed(self._plan.left_out)}."
            )
        if fixed := self._fixed.get(rig.session_uid):
            notes.append(
                "Bones that are connected do not move away from what they hang on, as those of the source do: "
                f'{listed(fixed)} of "{rig.name}". To carry that as well disconnect them (Armature > Parent > '
                "Disconnect Bone in Edit Mode)."
            )
        if self._filled:
            notes.append(
                f"All frames of {listed(self._filled)} were computed: with keys only where the source has some "
                f'"{rig.name}" would move otherwise in between.'
            )
        found = [
            keys for (number, _), all_keys in self._found.items() if number == rig.session_uid for keys in all_keys
        ]
        if stopped := list(dict.fromkeys(keys.bone for keys in found if keys.stops)):
            notes.append(
                f'{listed(stopped)} of "{rig.name}" will stay beyond the last key, where the source turns on: '
                "quaternions do not go on as Euler angles do. Give these bones the rotation modes that those of "
                "the source have, and carry it again."
            )
        return notes + pairing_notes(scene, source, rig)

    def _write(
        self, rig: bpy.types.Object, action: bpy.types.Action, notes: list[str], *, alone: bool
    ) -> bpy.types.Action:
        """Write a target's action, and note what is kept of one that was made before."""
        keys, assign = self._found[rig.session_uid, action.name], self._plan.assign and alone
        made, kept = write_action(rig, action, keys, assign=assign)
        notes += kept
        return made

    def _rigs(self) -> list[bpy.types.Object]:
        return [found_again(link) for link in (self._source, *self._targets)]

    def _action(self, name: str) -> bpy.types.Action:
        """Look an action up again."""
        action = bpy.data.actions.get(name)
        if action is None:
            raise ObjectError(f'The action "{name}" was deleted meanwhile. Nothing was written.')
        return action

    def _check(self) -> None:
        self._rigs()

    def _all_steps(self) -> Steps[None]:
        """Pair what is not paired, read each motion once, and compute it for each target."""
        begin = 0.0
        if self._pairing is not None:
            while not self._pairing.advance(0.0):
                yield Progress(_PAIRED * self._pairing.progress.fraction, self._pairing.progress.label)
            begin = _PAIRED
        pairings = [self._pairing_of(link) for link in self._targets]
        works = self._plan.actions or ("",)
        for number, name in enumerate(works):
            start, end = (begin + (1 - begin) * (number + step) / len(works) for step in range(2))
            steps = self._action_steps(name, pairings) if name else self._pose_steps(pairings)
            yield from within(steps, start, end)

    def _pairing_of(self, target: SideReference) -> BonePairing:
        """Return the pairs of one target: from the table, or just made."""
        rig = found_again(target)
        if rig.session_uid not in self._pairs:
            return pairing_of(bpy.data.scenes[self._scene], found_again(self._source), rig)
        pairing = cast("BonePairing", self._pairs[rig.session_uid].pairing)
        _check_channels(rig, pairing)
        return pairing

    def _pose_steps(self, pairings: list[BonePairing]) -> Steps[None]:
        """Carry the pose of the moment over."""
        motion, turn = current_motion(found_again(self._source)), object_rotation(found_again(self._source))
        for link, pairing in zip(self._targets, pairings, strict=True):
            steps = _transfer_steps(motion, turn, pairing, link, MotionSettings(hands=self._plan.settings.hands))
            found = self._poses[_number(link)] = yield from steps
            self._keep_fixed(link, found)
            steered = yield from steered_steps(link, found)
            if steered is not None:
                self._steered[_number(link)] = steered
                yield from steered.posed_steps(link, found)

    def _action_steps(self, name: str, pairings: list[BonePairing]) -> Steps[None]:
        """Carry an action over."""
        keys = read_keys(self._action(name), found_again(self._source))
        movers = [
            movers_of(pairing, (found_again(self._source), found_again(link)))
            for link, pairing in zip(self._targets, pairings, strict=True)
        ]
        sparse = self._is_sparse(name, keys)
        if any(self._needs_keys(link, pairing) for link, pairing in zip(self._targets, pairings, strict=True)):
            sparse = False
        if sparse and not self._keys_suffice(name, keys, movers):
            sparse = False
            self._filled += [name] if self._plan.keys == "SOURCE" else []
        frames, first = sparse_frames(keys) if sparse else baked_frames(keys), np.floor(keys.frames[0])
        sampled = (frames[:, None] + np.array([-SIDE_STEP, 0, SIDE_STEP])).ravel() if sparse else frames
        motion, turn = yield from within(self._reading_steps(name, sampled, first), 0.0, 0.5)
        settings = self._plan.settings
        if sparse:
            settings = MotionSettings(stride=settings.stride, in_place=settings.in_place, rate=settings.rate)
        count, times = len(self._targets), (sampled - keys.frames[0]) / (np.ptp(keys.frames) or 1.0)
        for number, (link, pairing) in enumerate(zip(self._targets, pairings, strict=True)):
            start, end = (0.5 + 0.5 * (number + step) / count for step in range(2))
            found = yield from within(_transfer_steps(motion, turn, pairing, link, settings, times=times), start, end)
            self._keep_fixed(link, found)
            channels = bone_channels(found_again(link), found, keys, movers[number])
            if _number(link) not in self._steered:
                steered = yield from steered_steps(link, found)
                if steered is not None:
                    self._steered[_number(link)] = steered
            if _number(link) in self._steered:
                yield from self._steered[_number(link)].posed_steps(link, found)
                channels = self._steered[_number(link)].channels(found_again(link), channels)
            if sparse:
                made = sparse_keys(channels, frames, keys, movers[number])
            else:
                tolerance = None if self._plan.keys == "ALL" else self._plan.tolerance
                made = baked_keys(channels, frames, tolerance, keys, movers[number])
            self._found[_number(link), name] = made

    def _keep_fixed(self, link: SideReference, found: TransferredMotion) -> None:
        """Keep the names of bones that cannot be moved as those of the source are."""
        names = [bone.name for bone in armature_of(found_again(link)).bones]
        known = self._fixed.setdefault(_number(link), [])
        known += [names[number] for number in np.flatnonzero(found.fixed) if names[number] not in known]

    def _is_sparse(self, name: str, keys: ActionKeys) -> bool:
        """Tell whether the target is to get keys where the source has them."""
        plan, found = self._plan, len(sparse_frames(keys))
        if plan.settings.feet or plan.settings.hands or plan.keys in {"ALL", "REDUCED"} or not found:
            return False
        if plan.keys == "SOURCE":
            return True
        count = np.ceil(keys.frames[1]) - np.floor(keys.frames[0]) + 1
        evaluated = needs_evaluation(found_again(self._source), self._action(name))
        return found < _FEW * count and not keys.modified and not evaluated

    def _keys_suffice(self, name: str, keys: ActionKeys, movers: list[dict[str, Movers]]) -> bool:
        """Tell whether all targets move as the source does by keys where that has its keys."""
        settings = self._plan.settings
        carried = is_carried(found_again(self._source), self._action(name))
        return not carried and all(keys_suffice(keys, each, in_place=settings.in_place) for each in movers)

    def _needs_keys(self, link: SideReference, pairing: BonePairing) -> bool:
        """Tell whether a target moves rightly only where it has keys: by controls, or by bones that hang elsewhere."""
        rig = found_again(link)
        return is_steered(rig, pairing) or pairing.comes_apart(*map(own_skeleton, (found_again(self._source), rig)))

    def _reading_steps(
        self, name: str, frames: NDArray[np.float64], first: float
    ) -> Steps[tuple[Motion, NDArray[np.float64]]]:
        """Read the source's poses in frames (f,), some at a time, and the way of its object from the first frame on.

        Returns them, and how the object is turned in the world in that frame, (3, 3).
        """
        parts, places = [], []
        evaluated = needs_evaluation(found_again(self._source), self._action(name))
        carried = is_carried(found_again(self._source), self._action(name))
        size = _EVALUATED_CHUNK if evaluated else _CHUNK
        for start in range(0, len(frames), size):
            yield Progress(start / len(frames), "Reading motion")
            rig, action, some = found_again(self._source), self._action(name), frames[start : start + size]
            own = object_places(action, rig, some)
            poses, found = evaluated_frames(action, rig, some) if evaluated else (posed_at(action, rig, some), own)
            parts.append(poses)
            places.append(found if carried else own)
        ways = np.concatenate(places)
        start_place = ways[np.searchsorted(frames, first)]
        if not carried:
            start_place = object_places(self._action(name), found_again(self._source), np.array([first]))[0]
        turn = np.array(Matrix(start_place.tolist()).to_quaternion().to_matrix(), np.float64)
        return with_object(Motion.joined(parts), ways, start_place), turn


def _number(link: SideReference) -> int:
    """Return the number of an armature in this session."""
    return found_again(link).session_uid


def _transfer_steps(
    motion: Motion,
    turn: NDArray[np.float64],
    pairing: BonePairing,
    link: SideReference,
    settings: MotionSettings,
    *,
    times: NDArray[np.float64] | None = None,
) -> Steps[TransferredMotion]:
    """Compute the motion of one target from that of a source which is turned so in the world, (3, 3)."""
    rig = found_again(link)
    ups = np.array([turn[2], object_rotation(rig)[2]])  # the world's z axis in their spaces
    connected = np.array([bone.use_connect for bone in armature_of(rig).bones], bool)
    steps = transfer_motion_steps(
        motion, pairing, own_skeleton(rig), settings, ups=ups, connected=connected, times=times
    )
    return (yield from steps)


def _said(made: dict[str, bpy.types.Action]) -> str:
    """Say what a target has got."""
    if len(made) == 1:
        (action,) = made.values()
        return f'the action "{action.name}"'
    return counted(len(made), "action") if made else "the pose"


def _check_channels(rig: bpy.types.Object, pairing: BonePairing) -> None:
    """Make sure that the rotations of all bones with partners may be changed; controls of others are sought later.

    Raises
    ------
    ObjectError
        If some are locked.
    """
    bones = pose_of(rig).bones
    paired = [bones[int(number)] for number in np.unique(pairing.targets)]
    locked = [bone.name for bone in paired if any(cast("Any", bone.lock_rotation))]
    if locked and not is_steered(rig, pairing):
        raise ObjectError(
            f'The rotation of {listed(locked)} of "{rig.name}" is locked. Unlock it (in the sidebar: Item), or clear '
            "these bones in the table of pairs."
        )


def _set_pose(
    scene: bpy.types.Scene, rig: bpy.types.Object, found: TransferredMotion, steered: SteeredRig | None
) -> list[str]:
    """Pose an armature as computed: bones with partners, or what turns them, only. Say what is to be known."""
    bones = pose_of(rig).bones
    local = local_poses(found.motion, rig)
    bases = {}
    for number, bone in enumerate(bones):
        if found.moved[number]:
            basis = np.eye(4)
            basis[:3, :3] = local.rotations[0, number]
            basis[:3, 3] = local.locations[0, number] if found.placed[number] else bone.location
            bases[bone.name] = basis
    placed = [bone.name for number, bone in enumerate(bones) if found.moved[number] and found.placed[number]]
    if steered is not None:
        bases = steered.bases(bases)
        placed = [*(name for name in placed if name in bases), *steered.placed]
    set_pose(rig, bases)
    notes = []
    switches = () if steered is None else steered.controls.switches
    if not key_automatically(scene, rig, bases, dict.fromkeys(placed), [(one.bone, one.name) for one in switches]):
        notes.append(
            f'Auto Keying set no keys: "{rig.name}" plays an action of another file. Make it local, or let it play '
            "another one."
        )
    return notes


def _notes(
    source: bpy.types.Object,
    target: bpy.types.Object,
    actions: list[bpy.types.Action],
    moved: list[str],
    *,
    played: bool,
) -> list[str]:
    """Say what is to be known of a target, and of how it stands if it has got a pose, or plays its new action."""
    notes = []
    held = [
        bone.name
        for bone in pose_of(target).bones
        if bone.name in moved and any(acts(constraint) for constraint in bone.constraints)
    ]
    if held:
        notes.append(
            f'Constraints hold {listed(held)} of "{target.name}", so they may not follow the new motion. Mute them to '
            "see it."
        )
    driven = driven_bones(target)
    if turned_so := [name for name in dict.fromkeys(moved) if name in driven]:
        notes.append(
            f'Drivers turn {listed(turned_so)} of "{target.name}", which therefore do not follow the new motion. Mute '
            "them to see it."
        )
    if played:
        turned = turned_above(target, moved)
        if turned:
            notes.append(
                f"Bones without a pair that are not at rest turn all that hangs on them: {listed(turned)} of "
                f'"{target.name}". Clear their pose (Pose > Clear Transform) unless that is wanted.'
            )
    growing = [action.name for action in actions if grows(action, source)]
    if growing:
        notes.append(f'{listed(growing)} changes the size of the object "{source.name}", too. That was left out.')
    scaled = list(dict.fromkeys(name for action in actions for name in scaled_bones(action, source)))
    if scaled:
        notes.append(f'The sizes that bones of "{source.name}" get were left out: {listed(scaled)}.')
    return notes
