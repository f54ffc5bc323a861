# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys of a source's action: where they are, how its curves go from one to the next, and how they go on beyond them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain, pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from .action_curves import bone_curves, frame_range, object_curves, rotation_channel

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

__all__ = ["OBJECT", "ActionKeys", "CurveKeys", "Cycle", "Way", "common_ways", "key_frames", "read_keys"]

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
    ways : list of Way or None
        How it goes on from each; None where it stays at its value until the next.
    goes_on : bool
        Whether it moves on beyond its keys.
    """

    frames: NDArray[np.float64]
    ways: list[Way | None]
    goes_on: bool

    @property
    def moves(self) -> bool:
        """Whether its values differ."""
        return self.goes_on or any(way is not None for way in self.ways[:-1])

    def way(self, start: float, end: float) -> Way | None:
        """Return how it goes from one frame to another, between which it has no keys; None if it does not move."""
        number = int(np.searchsorted(self.frames, start, side="right")) - 1
        if number < 0 or number >= len(self.frames) - 1:
            return _OWN if self.goes_on and end < np.inf else None
        way = self.ways[number]
        whole = self.frames[number] == start and self.frames[number + 1] == end
        return way if way is None or whole or way.interpolation in _PLAIN else _OWN


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
    bones = cast("bpy.types.Pose", armature.pose).bones
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
    points = list(curve.keyframe_points)
    ways: list[Way | None] = [_way(*both, far=_FAR.get(channel, np.inf)) for both in pairwise(points)]
    moves = any(way is not None for way in ways)
    ends = ((points[0], -1), (points[-1], 1)) if points else ()
    away = any(abs(curve.evaluate(point.co[0] + step) - point.co[1]) > _STILL for point, step in ends)
    ways += [_named(point) for point in points[-1:]]
    return CurveKeys(np.array([point.co[0] for point in points], np.float64), ways, away or (repeated and moves))


def _way(point: Any, after: Any, far: float) -> Way | None:  # noqa: ANN401 - keys, whose type differs
    """Say how a curve goes from one key to the next."""
    way, change = _named(point), after.co[1] - point.co[1]
    heights = [after.co[1]]
    if way.interpolation == "BEZIER":
        heights += [point.handle_right[1], after.handle_left[1]]
    if way.interpolation != "ELASTIC" and max(abs(height - point.co[1]) for height in heights) <= _STILL:
        return None
    # How far an elastic one swings is a length, which other axes do not have.
    return _OWN if way.interpolation == "ELASTIC" or (way != Way("CONSTANT") and abs(change) > far) else way


def _named(point: Any) -> Way:  # noqa: ANN401 - see above
    """Return what a key says of how the curve goes on from it."""
    kind = point.interpolation
    return Way(kind) if kind in _PLAIN else Way(kind, point.easing, point.back if kind == "BACK" else 0.0)


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
    frames, found = key_frames(curves), list[Way]()
    for start, end in pairwise([*frames.tolist(), np.inf]):
        ways = {curve.way(start, end) for curve in curves} - {None}
        if end == np.inf:
            last = [curve.ways[-1] for curve in curves if len(curve.frames) and curve.frames[-1] == start]
            found.append(next((way for way in last if way is not None), Way()))
        elif ways == {Way("LINEAR"), Way("BEZIER")}:
            found.append(Way())  # with slopes that are measured
        elif len(ways) > 1 or _OWN in ways or not (eased or ways <= {Way(kind) for kind in _PLAIN}):
            return None
        else:
            found.append(cast("Way", next(iter(ways), Way())))
    return found
