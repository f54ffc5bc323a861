# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys of an armature for motion that was computed for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ....engine import local_transforms, reduced_keys, rotation_channels, slopes_of
from ...scene.armatures import armature_of
from ...scene.motion.action_curves import rotation_channel
from ...scene.motion.motion_io import OBJECT, BoneKeys
from ...scene.motion.rigs import own_skeleton, rest_matrices

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ....engine import BonePairing, TransferredMotion
    from ...scene.motion.motion_io import ActionKeys

__all__ = ["LOCATION", "BoneChannels", "baked_keys", "bone_channels", "movers_of", "sparse_frames", "sparse_keys"]

SIDE_STEP = 0.05
"""Frames before and after a key at which its slopes are measured."""

LOCATION = 0.25
"""What a tolerance of one radian means for a location, in units of the rig's extent: about the length of a limb."""


@dataclass(frozen=True, eq=False)
class BoneChannels:
    """A channel of a bone in all poses that were computed, (f, c)."""

    bone: str
    channel: str
    values: NDArray[np.float64]
    coarseness: float


def bone_channels(armature: bpy.types.Object, found: TransferredMotion) -> list[BoneChannels]:
    """Make the channels of an armature's bones of its motion, in the rotation modes that the bones have."""
    bones = armature_of(armature).bones
    inherits = np.array([bone.use_inherit_rotation for bone in bones], bool)
    local = local_transforms(found.motion, rest_matrices(armature)[:, :3, :3], inherits)
    tree = own_skeleton(armature)
    extent = float(np.ptp(np.concatenate([tree.heads, tree.tails]), axis=0).max())
    channels = []
    for number, bone in enumerate(cast("bpy.types.Pose", armature.pose).bones):
        if found.moved[number]:
            values = rotation_channels(local.rotations[:, number], bone.rotation_mode)
            coarse = 0.5 if bone.rotation_mode == "QUATERNION" else 1.0  # a quaternion turns by half the angle
            channels.append(BoneChannels(bone.name, rotation_channel(bone.rotation_mode), values, coarse))
        if found.placed[number]:
            channels.append(BoneChannels(bone.name, "location", local.locations[:, number], LOCATION * extent))
    return channels


def baked_keys(
    channels: list[BoneChannels],
    frames: NDArray[np.float64],
    tolerance: float | None,
    keys: ActionKeys,
    movers: dict[str, list[str]],
) -> list[BoneKeys]:
    """Make keys of channels that were computed at frames (f,): at each of them, or few within a tolerance.

    Beyond them they go on as the source's bones that move them (`movers_of`), where these have keys.
    """
    made = []
    for channel in channels:
        slopes = slopes_of(frames, channel.values)
        kept = (
            np.arange(len(frames))
            if tolerance is None
            else reduced_keys(frames, channel.values, tolerance * channel.coarseness)
        )
        both = np.stack([slopes[kept]] * 2)
        cycle, beyond = _beyond(channel, movers.get(channel.bone, []), keys)
        made.append(
            BoneKeys(
                channel.bone,
                channel.channel,
                frames[kept],
                channel.values[kept],
                both,
                cycle=cycle,
                extrapolation=beyond,
            )
        )
    return made


def sparse_frames(keys: ActionKeys) -> NDArray[np.float64]:
    """Return all frames at which any bone has a key, (k,)."""
    times = list(keys.times.values())
    return np.unique(np.concatenate(times)) if times else keys.frames[:1]


def sparse_keys(
    channels: list[BoneChannels],
    frames: NDArray[np.float64],
    keys: ActionKeys,
    movers: dict[str, list[str]],
    source: bpy.types.Object,
) -> list[BoneKeys]:
    """Make keys where the source's bones have theirs.

    Parameters
    ----------
    channels : list of BoneChannels
        Channels at 3 k frames: shortly before each of the k keys, at it, and shortly after it.
    frames : (k,) array of float
        Frames of the keys, of all bones.
    keys : ActionKeys
        Which bones have keys when.
    movers : dict
        For each bone of the target the source's bones that turn it, from `movers_of`.
    source : bpy.types.Object
        The source's armature.
    """
    made = []
    for channel in channels:
        names = movers[channel.bone] if channel.channel != "location" else _with_ancestors(movers[channel.bone], source)
        moving = [name for name in names if name in keys.times]
        times = np.unique(np.concatenate([keys.times[name] for name in moving])) if moving else frames[:1]
        rows = np.searchsorted(frames, times)
        before, at, after = (channel.values[3 * rows + step] for step in range(3))
        slopes = np.stack([(at - before) / SIDE_STEP, (after - at) / SIDE_STEP])
        if len(times) > 1 and np.abs(channel.values - channel.values[0]).max() < 1e-6:
            times, at, slopes = times[:1], at[:1], slopes[:, :1] * 0
        curved = {
            float(time): how
            for name in reversed(moving)
            for time, how in zip(keys.times[name], keys.interpolations[name], strict=True)
        }
        ways = [curved.get(float(time), ("BEZIER", "AUTO")) for time in times]
        cycle, beyond = _beyond(channel, moving, keys)
        made.append(BoneKeys(channel.bone, channel.channel, times, at, slopes, ways, cycle, beyond))
    return made


def _beyond(channel: BoneChannels, movers: list[str], keys: ActionKeys) -> tuple[dict[str, Any], str]:
    """Say how a channel goes on beyond its keys, as what moves it: how it is repeated, and else is extrapolated.

    A place goes on as places, and a rotation as rotations, where there are such.  What nothing with keys moves, as far
    as is known, such as what follows a goal, is repeated as anything is.
    """
    known = [name for name in movers if name in keys.times]

    def chosen(found: dict[tuple[str, str], Any], names: list[str]) -> Any:  # noqa: ANN401 - of either kind
        ways = [(how == "location", way) for name in names for (bone, how), way in found.items() if bone == name]
        alike = [way for of_place, way in ways if of_place == (channel.channel == "location")]
        return next(iter([*alike, *(way for _, way in ways)]), None)

    return chosen(keys.cycles, known or list(keys.times)) or {}, chosen(keys.extrapolations, known) or "CONSTANT"


def movers_of(pairing: BonePairing, rigs: tuple[bpy.types.Object, bpy.types.Object]) -> dict[str, list[str]]:
    """For each bone of the target that has partners the source's bones that turn it against what it hangs on."""
    sources, targets = (armature_of(rig).bones for rig in rigs)
    names = [[bone.name for bone in bones] for bones in (sources, targets)]
    partners: dict[str, list[str]] = {}
    for row in np.argsort(-pairing.scores, kind="stable"):
        partners.setdefault(names[1][pairing.targets[row]], []).append(names[0][pairing.sources[row]])
    movers = {}
    for name, own in partners.items():
        above = targets[name].parent
        while above is not None and above.name not in partners:
            above = above.parent
        held = partners[above.name] if above is not None else []
        found = list(own)
        for start in own:
            parent = sources[start].parent
            while parent is not None and parent.name not in held:
                found.append(parent.name)
                parent = parent.parent
        if above is None:
            found.append(OBJECT)
        # What holds it turns it as well where both have no partner in common above.
        shared = above is None or any(_hangs_on(sources[start], held) for start in own)
        movers[name] = list(dict.fromkeys(found if shared else [*found, *_with_ancestors(held, rigs[0])]))
    return movers


def _hangs_on(bone: bpy.types.Bone, names: list[str]) -> bool:
    return bone.name in names or any(parent.name in names for parent in bone.parent_recursive)


def _with_ancestors(names: list[str], rig: bpy.types.Object) -> list[str]:
    """Names of bones, and of all that they hang on."""
    bones = [armature_of(rig).bones[name] for name in names if name != OBJECT]
    above = [parent.name for bone in bones for parent in bone.parent_recursive]
    return list(dict.fromkeys([*names, *above]))
