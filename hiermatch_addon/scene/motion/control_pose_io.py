# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses of a control rig: a copy at rest, posed by its controls so that bones turn as wanted."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from mathutils import Matrix

from ..armatures import armature_of
from .own_scene import own_scene

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import bpy
    from numpy.typing import NDArray

    from .own_scene import OwnScene

__all__ = ["Controls", "Switch", "at_rest", "leaders_of", "posed_controls", "set_switches"]

_STANDS = 1e-4
"""By how much a control may stand otherwise than it should, in radians and in units of the first bone's length."""

_LEARNS = 0.01
"""By what angle a control has to be turned for what hangs on it to show whether it is carried along, in radians."""

_CHANNELS = {
    "location": (0.0, 0.0, 0.0),
    "rotation_quaternion": (1.0, 0.0, 0.0, 0.0),
    "rotation_euler": (0.0, 0.0, 0.0),
    "rotation_axis_angle": (0.0, 0.0, 1.0, 0.0),
    "scale": (1.0, 1.0, 1.0),
}
"""What a pose bone is posed by, at rest."""


@dataclass(frozen=True)
class Switch:
    """A property of a bone that says whether constraints hold, and a value for it."""

    bone: str
    name: str
    value: float


@dataclass(frozen=True)
class Controls:
    """What moves deforming bones of a control rig.

    Attributes
    ----------
    turning : dict
        For each bone that is to be moved the control that turns it: itself, if nothing holds it.
    placed : tuple of str
        Those of the bones whose control also gets a place, as it carries most of the body.
    switches : tuple of Switch
        What has to be set for that.
    lost : tuple of str
        Bones without a control.
    """

    turning: dict[str, str]
    placed: tuple[str, ...] = ()
    switches: tuple[Switch, ...] = ()
    lost: tuple[str, ...] = ()


def set_switches(armature: bpy.types.Object, switches: Sequence[Switch]) -> list[str]:
    """Set properties, and return those that had another value, as a person reads them."""
    pose = cast("Any", armature.pose).bones
    changed = []
    for switch in switches:
        bone = pose[switch.bone]
        if float(bone[switch.name]) != switch.value:
            changed.append(f"{switch.name} ({switch.bone})")
            bone[switch.name] = type(bone[switch.name])(switch.value)
    if changed:
        armature.update_tag(refresh={"OBJECT", "DATA", "TIME"})
    return changed


def posed_controls(
    armature: bpy.types.Object,
    controls: Controls,
    turns: NDArray[np.float64],
    heads: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Find the poses of controls in which the bones turn as wanted, pose after pose.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    controls : Controls
        What turns what.
    turns : (f, k, 3, 3) array of float
        How each bone of `controls.turning`, in that order, is turned against its rest, in the armature's space.
    heads : (f, k, 3) array of float
        Where it is; this counts only for those that get a place.

    Returns
    -------
    bases : (f, k, 4, 4) array of float
        The transform of each control against its parent.
    missed : (f, k) array of float
        By what angle each bone points elsewhere in the end, in radians.
    """
    names = list(controls.turning)
    bases = np.tile(np.eye(4), (*turns.shape[:2], 1, 1))
    missed = np.zeros(turns.shape[:2])
    with at_rest(armature, controls.switches) as alone:
        pose = cast("bpy.types.Pose", alone.armature.pose).bones
        rest, stage = alone.places(names), _Stage(alone, controls)
        for frame in range(len(turns)):
            stage.pose(stage.wished(turns[frame], heads[frame], rest[:, :3, 3]))
            now = alone.places(names)
            turned = now[:, :3, :3] @ np.linalg.inv(rest[:, :3, :3])
            axes = [np.einsum("kij,kj->ki", each, rest[:, :3, 1]) for each in (turned, turns[frame])]
            missed[frame] = np.arccos((axes[0] * axes[1]).sum(axis=1).clip(-1, 1))
            for number, name in enumerate(names):
                bases[frame, number] = np.array(pose[controls.turning[name]].matrix_basis)
    return bases, missed


class _Stage:
    """Controls of an armature at rest that are posed together.

    All are set at once, each as if those that it follows stood already where they will.  That is looked at, and done
    again until it is true: at once where a control is carried by the one above, and once more for each that is not.
    """

    def __init__(self, alone: OwnScene, controls: Controls) -> None:
        self._alone, armature = alone, alone.armature
        self._names = list(dict.fromkeys(controls.turning.values()))
        turned = list(controls.turning.values())
        self._first = [turned.index(name) for name in self._names]
        self._placed = [list(controls.turning)[first] in controls.placed for first in self._first]
        number = {name: i for i, name in enumerate(self._names)}
        above = [[number[each] for each in leaders_of(armature, name)[1:] if each in number] for name in self._names]
        self._leaders = np.array([each[0] if each else -1 for each in above], np.int64)
        self._most = 2 + max((len(each) for each in above), default=0)
        self._unit = armature_of(armature).bones[self._names[0]].length
        self._starts = alone.places(self._names)

    def wished(
        self, turns: NDArray[np.float64], heads: NDArray[np.float64], rest: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return where controls (c, 4, 4) should stand for turns (k, 3, 3) of bones, and heads (k, 3), also at rest."""
        found = self._starts.copy()
        turns, heads, rest = turns[self._first], heads[self._first], rest[self._first]
        found[:, :3, :3] = turns @ self._starts[:, :3, :3]
        found[:, :3, 3] = heads + np.einsum("cij,cj->ci", turns, self._starts[:, :3, 3] - rest)
        return found

    def pose(self, wished: NDArray[np.float64]) -> None:
        """Pose the controls, (c, 4, 4)."""
        pose: Any = cast("bpy.types.Pose", self._alone.armature.pose).bones
        before = None
        for _ in range(self._most):
            now = self._alone.places(self._names)
            # How each has still to be turned back, to where it stands from where it should.
            back = now[:, :3, :3] @ wished[:, :3, :3].transpose(0, 2, 1)
            turned = _apart(back, np.eye(3))
            if before is not None:
                self._release(before, back, turned <= _STANDS)
            shifted = np.linalg.norm(now[:, :3, 3] - wished[:, :3, 3], axis=1)[self._placed] / self._unit
            if max(turned.max(), shifted.max(initial=0)) <= _STANDS:
                break
            before = back
            for bone, leader, place, stands, wanted in zip(
                (pose[name] for name in self._names), self._leaders, self._placed, now, wished, strict=True
            ):
                matrix = np.eye(4)
                matrix[:3, :3] = wanted[:3, :3] if leader < 0 else back[leader] @ wanted[:3, :3]
                matrix[:3, 3] = wanted[:3, 3] if place else stands[:3, 3]
                bone.matrix_basis = self._alone.basis(bone, Matrix(matrix.tolist()))
                if not place:
                    bone.location = (0, 0, 0)
                bone.scale = (1, 1, 1)
            self._alone.update()

    def _release(self, before: NDArray[np.float64], back: NDArray[np.float64], stands: NDArray[np.bool_]) -> None:
        """Note which controls did not turn with the one above, as those of limbs that keep their direction.

        `before` and `back` are how each had to be turned back, (c, 3, 3), when they were set and after that.
        """
        leaders = self._leaders
        # Of those without one any number will do: they stay without.
        stayed = (_apart(before[leaders], np.eye(3)) > _LEARNS) & (_apart(back, before[leaders]) <= _STANDS)
        self._leaders = np.where(stayed & stands[leaders], -1, leaders)


def leaders_of(armature: bpy.types.Object, name: str, inputs: dict[str, set[str]] | None = None) -> list[str]:
    """Return a bone and all bones that it hangs on or follows, in the order in which they are met.

    What moves it by drivers counts as well if these `inputs` are given.
    """
    pose, found = cast("bpy.types.Pose", armature.pose).bones, [name]
    for each in found:
        bone = pose[each]
        targets = [] if bone.parent is None else [bone.parent.name]
        targets += () if inputs is None else inputs.get(each, ())
        for constraint in cast("Any", bone.constraints):
            holders = (constraint, *getattr(constraint, "targets", ()))
            targets += [each.subtarget for each in holders if getattr(each, "target", None) == armature]
            if getattr(constraint, "pole_target", None) == armature:
                targets.append(constraint.pole_subtarget)
        found += [target for target in dict.fromkeys(targets) if target in pose and target not in found]
    return found


@contextmanager
def at_rest(armature: bpy.types.Object, switches: Sequence[Switch]) -> Iterator[OwnScene]:
    """Lend the copy of an armature at rest, without action, with switches set, in a scene of its own."""
    with own_scene(armature) as alone:
        pose = cast("Any", alone.armature.pose).bones
        for channel, rest in _CHANNELS.items():
            pose.foreach_set(channel, np.tile(np.array(rest, np.float32), len(pose)))
        set_switches(alone.armature, switches)
        alone.update()
        yield alone


def _apart(rotations: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return small angles between rotations (k, 3, 3): exact to single precision, as a trace is not."""
    return np.linalg.norm(rotations - others, axis=(1, 2)) / np.sqrt(2)
