# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys of a source's action: where they are, how its curves go from one to the next, and how they go on beyond them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from ..armatures import pose_of
from .action_curves import bone_curves, frame_range, object_curves, rotation_channel

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

OBJECT = ""
"""What stands among names of bones for the object itself, which carries them all."""

_STILL = 1e-6
"""Difference of values up to which a curve moves nothing: rounding of what is written by single precision."""

_FAR = {"rotation_euler": 2.0, "rotation_axis_angle": 2.0, "rotation_quaternion": 0.9}
"""Change of a number from one key to the next, in radians or of a quaternion, from which on keys alone do not say how a
rotation goes: by 2 radians Euler angles and quaternions differ by two degrees in between, and what turns by more than
half a turn would turn back.  A quaternion that turns so far changes by 0.9 or more."""

_CYCLE = (
    "mode_before",
    "cycles_before",
    "mode_after",
    "cycles_after",
    "use_restricted_range",
    "frame_start",
    "frame_end",
    "blend_in",
    "blend_out",
    "use_influence",
    "influence",
)


class Way(NamedTuple):
    """How a curve goes from a key to the next, in Blender's words; `back` is how far it shoots over if it does."""

    interpolation: str = "BEZIER"
    easing: str = "AUTO"
    back: float = 0.0


_PLAIN = ("CONSTANT", "LINEAR", "BEZIER")
"""Interpolations that parts of a segment have as the whole has them."""

_OWN = Way("")
"""A way that other curves cannot go by keys of their own: only further keys make them go so."""


class Cycle(NamedTuple):
    """Settings of a modifier that repeats curves, and the frames that it repeats."""

    settings: dict[str, Any]
    ends: tuple[float, float]


@dataclass(frozen=True, eq=False)
class CurveKeys:
    """Keys of one curve.

    Attributes
    ----------
    frames : (k,) array of float
        When.
    kinds : list of Way or None
        All ways that it goes; None for staying at a value until the next key.
    ways : (k,) array of int
        Which of them it goes from each key.
    goes_on : bool
        Whether it moves on beyond its keys.
    """

    frames: NDArray[np.float64]
    kinds: list[Way | None]
    ways: NDArray[np.int64]
    goes_on: bool

    @property
    def moves(self) -> bool:
        """Whether its values differ."""
        return self.goes_on or any(self.kinds[way] is not None for way in np.unique(self.ways[:-1]))

    def codes(self, frames: NDArray[np.float64], table: dict[Way | None, int]) -> NDArray[np.int64]:
        """Return how it goes from each of some frames, which its own are among, to the next: by numbers of a table."""
        numbers = np.searchsorted(self.frames, frames[:-1], side="right") - 1
        inside = (numbers >= 0) & (numbers < len(self.frames) - 1)
        found = np.full(len(numbers), table[_OWN if self.goes_on else None])
        numbers, starts, ends = numbers[inside], frames[:-1][inside], frames[1:][inside]
        whole = (self.frames[numbers] == starts) & (self.frames[numbers + 1] == ends)
        known = np.array([table.setdefault(kind, len(table)) for kind in self.kinds], np.int64)
        plain = np.array([kind is None or kind.interpolation in _PLAIN for kind in self.kinds], bool)
        ways = self.ways[numbers]
        found[inside] = np.where(whole | plain[ways], known[ways], table[_OWN])
        return found


@dataclass(frozen=True, eq=False)
class ActionKeys:
    """Where an action has its keys.

    Attributes
    ----------
    frames : (2,) array of float
        First and last frame.
    curves : dict
        For each bone and channel in which it is moved or turned the keys of its curves; for the object itself those of
        `OBJECT`.
    cycles : dict
        For each bone and channel that has one how its curves are repeated.
    extrapolations : dict
        For each bone and channel how its curves go on beyond the keys.
    modified : bool
        Whether more than keys and cycles says how a curve goes, such as a Noise modifier.
    """

    frames: NDArray[np.float64]
    curves: dict[tuple[str, str], list[CurveKeys]]
    cycles: dict[tuple[str, str], Cycle]
    extrapolations: dict[tuple[str, str], str]
    modified: bool


def read_keys(action: bpy.types.Action, armature: bpy.types.Object) -> ActionKeys:
    """Read where an action has its keys of what moves and turns an armature's bones, and itself."""
    curves: dict[tuple[str, str], list[CurveKeys]] = {}
    cycles: dict[tuple[str, str], Cycle] = {}
    extrapolations: dict[tuple[str, str], str] = {}
    modified = False
    bones = pose_of(armature).bones
    whole = ((OBJECT, channel, curve) for channel, curve in object_curves(action, armature))
    for bone, channel, curve in chain(bone_curves(action, armature), whole):
        owner = armature if bone == OBJECT else bones[bone]
        if channel not in {"location", rotation_channel(owner.rotation_mode)}:
            continue
        live = [modifier for modifier in curve.modifiers if not modifier.mute]
        modified |= any(modifier.type != "CYCLES" for modifier in live)
        repeated = [modifier for modifier in live if modifier.type == "CYCLES"]
        keys = _curve_keys(curve, channel, repeated=bool(repeated))
        curves.setdefault((bone, channel), []).append(keys)
        extrapolations.setdefault((bone, channel), curve.extrapolation)
        for modifier in repeated if len(keys.frames) else ():
            ends = float(keys.frames[0]), float(keys.frames[-1])
            cycles.setdefault((bone, channel), Cycle({name: getattr(modifier, name) for name in _CYCLE}, ends))
    return ActionKeys(np.array(frame_range(action, armature), np.float64), curves, cycles, extrapolations, modified)


def _curve_keys(curve: Any, channel: str, *, repeated: bool) -> CurveKeys:  # noqa: ANN401 - Blender's types differ
    """Read the keys of one curve."""
    points = curve.keyframe_points
    frames, values = _read(points, "co", 2).T
    right, left = (_read(points, f"handle_{side}", 2)[:, 1] for side in ("right", "left"))
    named = np.concatenate([_read(points, name, 1) for name in ("interpolation", "easing", "back")], axis=1)
    names = [_names(points, name) for name in ("interpolation", "easing")]
    kinds, numbers = np.unique(named, axis=0, return_inverse=True)
    ways = [_way(names[0][int(kind)], names[1][int(easing)], float(back)) for kind, easing, back in kinds]
    said = np.array([way.interpolation for way in ways], str)[numbers.reshape(-1)][:-1]
    found = numbers.reshape(-1) + 2
    changes = np.abs(np.diff(values))
    heights = np.maximum(np.abs(right[:-1] - values[:-1]), np.abs(left[1:] - values[:-1]))
    still = np.where(said == "BEZIER", np.maximum(changes, heights), changes) <= _STILL
    # How far an elastic one swings is a length, which other axes do not have.
    found[:-1][still] = 0
    found[:-1][(said == "ELASTIC") | ((said != "CONSTANT") & (changes > _FAR.get(channel, np.inf)))] = 1
    ends = ((0, -1), (-1, 1)) if len(frames) else ()
    away = any(abs(curve.evaluate(frames[end] + step) - values[end]) > _STILL for end, step in ends)
    return CurveKeys(frames, [None, _OWN, *ways], found, away or (repeated and bool(found[:-1].any())))


def _read(points: Any, name: str, width: int) -> NDArray[np.float64]:  # noqa: ANN401 - see above
    """Read a member of all keys of a curve, (k, width)."""
    is_named = points[0].bl_rna.properties[name].type == "ENUM" if len(points) else False
    values = np.empty(len(points) * width, np.int32 if is_named else np.float32)
    points.foreach_get(name, values)
    return values.reshape(-1, width).astype(np.float64)


def _names(points: Any, name: str) -> dict[int, str]:  # noqa: ANN401 - see above
    """Return what the numbers of a member of keys mean."""
    items = points[0].bl_rna.properties[name].enum_items if len(points) else ()
    return {item.value: item.identifier for item in items}


def _way(kind: str, easing: str, back: float) -> Way:
    """Return what a key says of how the curve goes on from it, without what means nothing for that."""
    return Way(kind) if kind in _PLAIN else Way(kind, easing, back if kind == "BACK" else 0.0)


def key_frames(curves: Sequence[CurveKeys]) -> NDArray[np.float64]:
    """Return all frames at which curves have keys, (k,)."""
    return np.unique(np.concatenate([np.zeros(0), *(curve.frames for curve in curves)]))


def common_ways(curves: Sequence[CurveKeys], *, eased: bool) -> list[Way] | None:
    """Say how what several curves move together goes on from each of their keys.

    Parameters
    ----------
    curves : sequence of CurveKeys
        What moves it.
    eased : bool
        Whether it moves by nothing else, so that it may be eased as they are.

    Returns
    -------
    list of Way or None
        One for each of the `key_frames`; None if they do not go in one way, so that keys alone cannot say it.
    """
    frames = key_frames(curves)
    table: dict[Way | None, int] = {None: 0, _OWN: 1}
    columns = np.array([curve.codes(frames, table) for curve in curves], np.int64).reshape(
        len(curves), max(len(frames) - 1, 0)
    )
    kinds, numbers = np.unique(columns, axis=1, return_inverse=True)
    ways = list(table)
    together = [_together({ways[number] for number in kind} - {None}, eased=eased) for kind in kinds.T]
    if None in together:
        return None
    last = [curve.kinds[curve.ways[-1]] for curve in curves if len(curve.frames) and curve.frames[-1] == frames[-1]]
    found = [cast("Way", together[number]) for number in numbers.reshape(-1)]
    return found + [next((way for way in last if way is not None), Way())] * (len(frames) > 0)


def _together(ways: set[Way | None], *, eased: bool) -> Way | None:
    """Return the way that all of some together are, if there is one."""
    if ways <= {Way("LINEAR"), Way()}:
        return Way("LINEAR") if ways == {Way("LINEAR")} else Way()  # with slopes that are measured
    (way, *others) = ways
    return way if not others and way != _OWN and (eased or way == Way("CONSTANT")) else None
