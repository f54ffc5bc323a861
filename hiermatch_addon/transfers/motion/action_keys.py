# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys of an armature for motion that was computed for it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from ....engine import reduced_keys, rotation_channels, slopes_of
from ...scene.armatures import armature_of, pose_of
from ...scene.motion.action_curves import rotation_channel
from ...scene.motion.motion_io import BoneKeys
from ...scene.motion.rigs import local_poses, own_skeleton
from ...scene.motion.source_keys_io import OBJECT, Way, common_ways, key_frames

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ....engine import BonePairing, Skeleton, TransferredMotion
    from ...scene.motion.source_keys_io import ActionKeys, CurveKeys, Cycle

SIDE_STEP = 0.05
"""Frames before and after a key at which its slopes are measured."""

_DIGITS = 4
"""Digits of frames: keys are stored in single precision."""

_ALIKE = 0.01
"""Angle in radians up to which two rotations count as the same one: half a degree, which no one sees as a jump."""

_LOCATION = 0.25
"""What a tolerance of one radian means for a location, in units of the rig's extent: about the length of a limb."""


class Movers(NamedTuple):
    """The source's bones that turn a bone of the target against what it hangs on, and those that move it."""

    turning: list[str]
    moving: list[str]


@dataclass(frozen=True, eq=False)
class BoneChannels:
    """A channel of a bone in all poses that were computed, (f, c)."""

    bone: str
    channel: str
    values: NDArray[np.float64]
    coarseness: float

    @classmethod
    def of_turns(cls, bone: bpy.types.PoseBone, turns: NDArray[np.float64]) -> BoneChannels:
        """Make the channel of turns (f, 3, 3), in the rotation mode that the bone has."""
        mode = bone.rotation_mode
        coarseness = 0.5 if mode == "QUATERNION" else 1.0  # a quaternion turns by half the angle
        return cls(bone.name, rotation_channel(mode), rotation_channels(turns, mode), coarseness)

    @classmethod
    def of_places(cls, bone: bpy.types.PoseBone, places: NDArray[np.float64], tree: Skeleton) -> BoneChannels:
        """Make the channel of places (f, 3); `tree` are all bones."""
        return cls(bone.name, "location", places, _LOCATION * float(np.ptp(tree.joints, axis=0).max()))


def bone_channels(
    armature: bpy.types.Object, found: TransferredMotion, keys: ActionKeys, movers: dict[str, Movers]
) -> list[BoneChannels]:
    """Make the channels of an armature's bones of its motion, in the rotation modes that the bones have.

    If the source has keys of places, bones get them that stay where they are, too: another action may have moved them.
    """
    said = {name for name, each in movers.items() if any((one, "location") in keys.curves for one in each.turning)}
    local = local_poses(found.motion, armature)
    tree = own_skeleton(armature)
    channels = []
    for number, bone in enumerate(pose_of(armature).bones):
        if found.moved[number]:
            channels.append(BoneChannels.of_turns(bone, local.rotations[:, number]))
        if found.placed[number]:
            channels.append(BoneChannels.of_places(bone, local.locations[:, number], tree))
        elif bone.name in said and not bone.bone.use_connect:
            channels.append(BoneChannels.of_places(bone, np.zeros((len(found.motion), 3)), tree))
    return channels


def baked_frames(keys: ActionKeys) -> NDArray[np.float64]:
    """Return all whole frames of an action, and the ends of what is repeated, which may lie between them, (f,)."""
    ends = np.array([end for cycle in keys.cycles.values() for end in cycle.ends])
    first, last = (of(np.append(keys.frames, ends)) for of in (np.min, np.max))
    return np.unique(np.append(np.arange(np.floor(first), np.ceil(last) + 1), ends.round(_DIGITS)))


def baked_keys(
    channels: list[BoneChannels],
    frames: NDArray[np.float64],
    tolerance: float | None,
    keys: ActionKeys,
    movers: dict[str, Movers],
) -> list[BoneKeys]:
    """Make keys of channels that were computed at frames (f,): at each whole one, or few within a tolerance.

    Beyond them they go on as the source's bones that move them (`movers_of`), where these have keys.  What is repeated
    has its first and last key where that has it.
    """
    made = []
    for channel in channels:
        beyond = _beyond(channel, movers.get(channel.bone, Movers([], [])), keys)
        used = frames == frames.round()
        if beyond.cycle is not None:
            used = beyond.repeats(frames) & (used | np.isin(frames, np.round(beyond.cycle.ends, _DIGITS)))
        times, values = frames[used], channel.values[used]
        slopes = slopes_of(times, values)
        kept = (
            np.arange(len(times)) if tolerance is None else reduced_keys(times, values, tolerance * channel.coarseness)
        )
        both = np.stack([slopes[kept]] * 2)
        made.append(beyond.bounded(BoneKeys(channel.bone, channel.channel, times[kept], values[kept], both)))
    return made


def sparse_frames(keys: ActionKeys) -> NDArray[np.float64]:
    """Return all frames at which any bone has a key, (k,)."""
    frames = key_frames([curve for curves in keys.curves.values() for curve in curves])
    return frames if len(frames) else keys.frames[:1]


def keys_suffice(keys: ActionKeys, movers: dict[str, Movers], *, in_place: bool) -> bool:
    """Tell whether a target moves as the source does by keys where that has its keys.

    It does not where what moves a bone together goes in different ways from key to key, or turns far in between.

    Parameters
    ----------
    keys : ActionKeys
        The source's keys.
    movers : dict
        For each bone of the target what moves it, from `movers_of`.
    in_place : bool
        Whether an even way is taken out.
    """
    for each in movers.values():
        if common_ways(_curves_of("rotation", each, keys), eased=True) is None:
            return False
        moved = [curve for name in each.turning for curve in keys.curves.get((name, "location"), ())]
        gets_place = OBJECT in each.turning or any(curve.moves for curve in moved)
        if gets_place and common_ways(_curves_of("location", each, keys), eased=not in_place) is None:
            return False
    return True


def sparse_keys(
    channels: list[BoneChannels], frames: NDArray[np.float64], keys: ActionKeys, movers: dict[str, Movers]
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
        For each bone of the target what moves it, from `movers_of`.
    """
    made = []
    for channel in channels:
        curves = _curves_of(channel.channel, movers[channel.bone], keys)
        times = key_frames(curves) if curves else frames
        ways = common_ways(curves, eased=True) or [Way("LINEAR")] * len(times)
        beyond = _beyond(channel, movers[channel.bone], keys)
        if beyond.cycle is not None:
            ways = [way for way, used in zip(ways, beyond.repeats(times), strict=True) if used]
            times = times[beyond.repeats(times)]
        rows = np.searchsorted(frames, times)
        before, at, after = (channel.values[3 * rows + step] for step in range(3))
        slopes = np.stack([(at - before) / SIDE_STEP, (after - at) / SIDE_STEP])
        if len(times) > 1 and np.abs(channel.values - channel.values[0]).max() < 1e-6:
            times, at, slopes, ways = times[:1], at[:1], slopes[:, :1] * 0, ways[:1]
        made.append(beyond.bounded(BoneKeys(channel.bone, channel.channel, times, at, slopes, ways)))
    return made


def _channels_of(channel: str, movers: Movers, keys: ActionKeys) -> list[tuple[str, str]]:
    """Return the source's channels by which one moves: a rotation by rotations, a place by all above as well."""
    is_place = channel == "location"
    names = movers.moving if is_place else movers.turning
    return [each for name in names for each in keys.curves if each[0] == name and (is_place or each[1] != "location")]


def _curves_of(channel: str, movers: Movers, keys: ActionKeys) -> list[CurveKeys]:
    """Return the curves of these."""
    return [curve for each in _channels_of(channel, movers, keys) for curve in keys.curves[each]]


class _Beyond(NamedTuple):
    """How a channel goes on beyond its keys: how it is repeated, else extrapolated; and whether it stops wrongly."""

    cycle: Cycle | None
    extrapolation: str
    stops: bool

    def repeats(self, frames: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Tell which frames (f,) are among those that are repeated."""
        first, last = np.round(cast("Cycle", self.cycle).ends, _DIGITS)
        return (frames.round(_DIGITS) >= first) & (frames.round(_DIGITS) <= last)

    def bounded(self, keys: BoneKeys) -> BoneKeys:
        """Let keys go on so."""
        cycle, stops = ({} if self.cycle is None else self.cycle.settings), self.stops and len(keys.frames) > 1
        sides = ("mode_before", "mode_after")
        if cycle and stops and _ends_alike(keys):  # an offset of whole turns is none
            cycle = cycle | {side: cycle[side].replace("_OFFSET", "") for side in sides}
            stops = False
        return replace(keys, cycle={} if stops else cycle, extrapolation=self.extrapolation, stops=stops)


def _ends_alike(keys: BoneKeys) -> bool:
    """Tell whether the first and the last key of a rotation are the same one."""
    first, last = keys.values[[0, -1]]
    if keys.channel == "rotation_quaternion":
        return bool(abs(first @ last) > 1 - _ALIKE**2 / 8)
    return bool((np.cos(first - last) > 1 - _ALIKE**2 / 2).all())


def _beyond(channel: BoneChannels, movers: Movers, keys: ActionKeys) -> _Beyond:
    """Say how a channel goes on beyond its keys, as what moves it.

    A place goes on as places, where there are such.  What nothing with keys moves, as far as is known, such as what
    follows a goal, is repeated if all is.  A quaternion does not go on as an Euler angle does, nor the other way round.
    """
    own, is_place = _channels_of(channel.channel, movers, keys), channel.channel == "location"
    alike = sorted(own or keys.curves, key=lambda each: (each[1] == "location") != is_place)
    extrapolation = next((keys.extrapolations[each] for each in alike if own), "CONSTANT")
    moving = [each for each in alike if any(curve.moves for curve in keys.curves[each])]
    cycles = [keys.cycles[each] for each in moving if each in keys.cycles]
    together = len(cycles) == len(moving) and len({cycle.ends for cycle in cycles}) == 1
    cycle = cycles[0] if together else None
    kinds = {what == "rotation_quaternion" for _, what in moving if what != "location"}
    if is_place or kinds <= {channel.channel == "rotation_quaternion"}:
        return _Beyond(cycle, extrapolation, stops=False)
    if cycle is not None:
        offset = "REPEAT_OFFSET" in (cycle.settings["mode_before"], cycle.settings["mode_after"])
        return _Beyond(cycle, "CONSTANT", stops=offset)
    goes_on = any(curve.goes_on for each in own for curve in keys.curves[each] if each not in keys.cycles)
    return _Beyond(None, "CONSTANT", stops=goes_on)


def movers_of(pairing: BonePairing, rigs: tuple[bpy.types.Object, bpy.types.Object]) -> dict[str, Movers]:
    """For each bone of the target that has partners the source's bones that turn and move it."""
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
        turning = list(dict.fromkeys(found if shared else [*found, *_with_ancestors(held, rigs[0])]))
        movers[name] = Movers(turning, _with_ancestors(turning, rigs[0]))
    return movers


def _hangs_on(bone: bpy.types.Bone, names: list[str]) -> bool:
    return bone.name in names or any(parent.name in names for parent in bone.parent_recursive)


def _with_ancestors(names: list[str], rig: bpy.types.Object) -> list[str]:
    """Names of bones, and of all that they hang on."""
    bones = [armature_of(rig).bones[name] for name in names if name != OBJECT]
    above = [parent.name for bone in bones for parent in bone.parent_recursive]
    return list(dict.fromkeys([*names, *above]))
