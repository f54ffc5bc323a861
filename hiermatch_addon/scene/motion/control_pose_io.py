# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses of a control rig: a copy at rest, posed by its controls so that bones turn as wanted."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from mathutils import Matrix
from scipy.spatial.transform import Rotation

from ..armatures import armature_of, pose_of
from .own_scene import own_scene

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import bpy
    from numpy.typing import NDArray

    from .own_scene import OwnScene

_STANDS = 1e-4
"""By how much a control may stand otherwise than it should, in radians and in units of the first bone's length."""

_LOOKED_AT = 16
"""Every how many poses Blender is asked how controls stand: if twice as expected, they do so in between.  The more, the
faster, and the later it is seen what holds a control in some poses only.  By `control_rig` of the benchmarks a minute
of Rigify's human takes 2 s with 16, 4 s with 8, and 20 s with 1."""

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
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Find the poses of controls in which the bones turn as wanted.

    How a control has to be turned follows from what carries it.  That is seen in the first pose, and looked at again
    every few poses.  Around those where a control stood otherwise than expected, all are looked at.

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
        By what angle each bone points elsewhere in the end, in radians; the larger of those of the poses before and
        after that were looked at, if it was not.
    seen : (f,) array of bool
        Which poses were looked at.
    """
    with at_rest(armature, controls.switches) as alone:
        stage = _Stage(alone, controls)
        wished, axes = stage.wished(turns, heads), stage.axes(turns)
        bases, missed = stage.expected(wished), np.zeros(turns.shape[:2])
        seen = np.zeros(len(turns), bool)

        def is_expected(frame: int) -> bool:
            """Pose the controls, and tell whether they stand as expected by now."""
            learnt = stage.pose(bases[frame], wished[frame])
            bases[frame], missed[frame], seen[frame] = stage.bases(), _angles(stage.now(), axes[frame]), True
            if learnt:
                bases[frame + 1 :] = stage.expected(wished[frame + 1 :])
            return stage.are_same(bases[frame], stage.expected(wished[frame : frame + 1])[0])

        looked_at = sorted({*range(0, len(turns), _LOOKED_AT), len(turns) - 1})
        expected = [is_expected(frame) for frame in looked_at]
        for (first, was), (last, will) in pairwise(zip(looked_at, expected, strict=True)):
            missed[first + 1 : last] = np.maximum(missed[first], missed[last])
            for frame in range(first + 1, last) if not (was and will) else ():
                is_expected(frame)
    return bases[:, stage.number_of], missed, seen


class _Stage:
    """Controls of an armature at rest that are posed together.

    All are set at once, each as if what carries it stood already where it will.  That is looked at, and done again
    until it is true: at once where it is known what carries a control, and once more for each above it where not.

    Attributes
    ----------
    number_of : list of int
        For each bone that is turned its control, of those that there are.
    """

    def __init__(self, alone: OwnScene, controls: Controls) -> None:
        self._alone, armature = alone, alone.armature
        self._pose: Any = pose_of(armature).bones
        turned = list(controls.turning.values())
        self._bones, self._names = list(controls.turning), list(dict.fromkeys(turned))
        self._first = [turned.index(name) for name in self._names]
        self._placed = np.array([self._bones[first] in controls.placed for first in self._first])
        number = {name: i for i, name in enumerate(self._names)}
        self.number_of = [number[name] for name in turned]
        above = (leaders_of(armature, name)[1:] for name in self._names)
        self._carriers = _Carriers([[number[each] for each in names if each in number] for names in above])
        self._unit = armature_of(armature).bones[self._names[0]].length
        self._starts, self._rest = alone.places(self._names), alone.places(self._bones)

    def wished(self, turns: NDArray[np.float64], heads: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where controls should stand, (f, c, 4, 4), for turns (f, k, 3, 3) of bones, and their heads."""
        found = np.tile(self._starts, (len(turns), 1, 1, 1))
        turns, heads = turns[:, self._first], heads[:, self._first]
        arms = self._starts[:, :3, 3] - self._rest[self._first, :3, 3]
        found[..., :3, :3] = turns @ self._starts[:, :3, :3]
        found[..., :3, 3] = heads + np.einsum("fcij,cj->fci", turns, arms)
        return found

    def expected(self, wished: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the transforms of controls (f, c, 4, 4) with which they stand there by all that is known by now."""
        found = np.zeros_like(wished)
        carried = self._carriers.turned(self._turned(wished)) @ self._starts[:, :3, :3]
        moved = wished[..., :3, 3] - self._starts[:, :3, 3]
        found[..., :3, :3] = carried.swapaxes(-2, -1) @ wished[..., :3, :3]
        found[..., :3, 3] = np.where(self._placed[:, None], np.einsum("fcji,fcj->fci", carried, moved), 0)
        found[..., 3, 3] = 1
        return found

    def axes(self, turns: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where bones point that are turned so, (f, k, 3)."""
        return np.einsum("fkij,kj->fki", turns, self._rest[:, :3, 1])

    def now(self) -> NDArray[np.float64]:
        """Return where the bones point, (k, 3)."""
        return self._alone.places(self._bones)[:, :3, 1]

    def bases(self) -> NDArray[np.float64]:
        """Return the transforms of the controls, (c, 4, 4)."""
        return np.array([self._pose[name].matrix_basis for name in self._names], np.float64)

    def are_same(self, bases: NDArray[np.float64], others: NDArray[np.float64]) -> bool:
        """Tell whether controls stand in the same way."""
        moved = np.linalg.norm(bases[:, :3, 3] - others[:, :3, 3], axis=1) / self._unit
        # As much for what carries them.
        return max(_apart(bases[:, :3, :3], others[:, :3, :3]).max(), moved.max()) <= 2 * _STANDS

    def pose(self, bases: NDArray[np.float64], wished: NDArray[np.float64]) -> bool:
        """Pose the controls, (c, 4, 4), first as expected; tell whether anything was learnt about what carries them."""
        for name, basis, place in zip(self._names, bases, self._placed, strict=True):
            self._set(name, Matrix(basis.tolist()), place)
        learnt = False
        for _ in range(self._carriers.most):
            self._alone.update()
            now = self._alone.places(self._names)
            apart = _apart(now[:, :3, :3], wished[:, :3, :3]).max()
            shifted = np.linalg.norm(now[:, :3, 3] - wished[:, :3, 3], axis=1)[self._placed] / self._unit
            if max(apart, shifted.max(initial=0)) <= _STANDS:
                break
            turned = self._turned(now)
            learnt |= self._carriers.learn(turned, self._carried(now))
            # How what carries each has still to be turned back, to where it is from where it should be.
            back = self._carriers.turned(turned) @ self._carriers.turned(self._turned(wished)).transpose(0, 2, 1)
            for name, place, stands, wanted, each in zip(self._names, self._placed, now, wished, back, strict=True):
                matrix = np.eye(4)
                matrix[:3, :3] = each @ wanted[:3, :3]
                matrix[:3, 3] = wanted[:3, 3] if place else stands[:3, 3]
                self._set(name, self._alone.basis(self._pose[name], Matrix(matrix.tolist())), place)
        return learnt

    def _turned(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how controls that stand there are turned against their rest, (..., c, 3, 3)."""
        return places[..., :3, :3] @ self._starts[:, :3, :3].transpose(0, 2, 1)

    def _carried(self, now: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how what carries each control is turned now, (c, 3, 3)."""
        return self._turned(now[:, :3, :3] @ self.bases()[:, :3, :3].transpose(0, 2, 1))

    def _set(self, name: str, basis: Matrix, place: np.bool_) -> None:
        """Pose a control; it stays where it is if it gets no place."""
        bone = self._pose[name]
        bone.matrix_basis = basis
        if not place:
            bone.location = (0, 0, 0)
        bone.scale = (1, 1, 1)


class _Carriers:
    """What controls are carried by: one above, nothing, or something between two of these.

    Limbs that keep their direction are carried by nothing, or by the hips; a neck may go half with the chest.

    Parameters
    ----------
    above : sequence of c lists of int
        For each control those that may carry it, the nearest first.
    """

    def __init__(self, above: Sequence[list[int]]) -> None:
        self._above = above
        self.most = 2 + max(map(len, above), default=0)
        """How often controls are posed at most until each stands where it should."""
        self._first = np.array([each[0] if each else -1 for each in above], np.int64)
        self._second, self._share = self._first.copy(), np.zeros(len(above))

    def turned(self, turns: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how what carries each control is turned, (..., c, 3, 3), if they are turned so themselves."""
        nothing = np.broadcast_to(np.eye(3), (*turns.shape[:-3], 1, 3, 3))
        turns = np.concatenate([turns, nothing], axis=-3)  # the last one
        found = turns[..., self._first, :, :]
        shared = self._share > 0
        if shared.any():
            way = _way(found[..., shared, :, :], turns[..., self._second[shared], :, :])
            part = Rotation.from_rotvec((self._share[shared, None] * way).reshape(-1, 3)).as_matrix()
            found[..., shared, :, :] = found[..., shared, :, :] @ part.reshape(*way.shape, 3)
        return found

    def learn(self, turns: NDArray[np.float64], carried: NDArray[np.float64]) -> bool:
        """Note what carries controls that are not carried (c, 3, 3) as expected, and tell whether any was found."""
        found = False
        for number in np.flatnonzero(_apart(carried, self.turned(turns)) > _STANDS):
            others = [*self._above[number], -1]
            ends = np.concatenate([turns, np.eye(3)[None]])[others]
            ways, way = _way(ends[:, None], ends[None]), _way(ends, carried[number])
            lengths = np.square(ways).sum(axis=2)
            shares = ((ways * way[:, None]).sum(axis=2) / np.maximum(lengths, _STANDS**2)).clip(0, 1)
            errors = np.linalg.norm(shares[..., None] * ways - way[:, None], axis=2)
            # One alone, if that is enough.
            errors = np.where(shares * np.sqrt(lengths) > _STANDS, errors + _STANDS, errors)
            first, second = np.unravel_index(errors.argmin(), errors.shape)
            if errors[first, second] <= 2 * _STANDS:
                found = True
                self._first[number], self._second[number] = others[first], others[second]
                self._share[number] = shares[first, second]
        return found


def leaders_of(armature: bpy.types.Object, name: str, inputs: dict[str, set[str]] | None = None) -> list[str]:
    """Return a bone and all bones that it hangs on or follows, in the order in which they are met.

    What moves it by drivers counts as well if these `inputs` are given.
    """
    pose, found = pose_of(armature).bones, [name]
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


def _angles(axes: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles between axes (k, 3)."""
    return np.arccos((axes * others).sum(axis=1).clip(-1, 1))


def _apart(rotations: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return small angles between rotations (k, 3, 3): exact to single precision, as a trace is not."""
    return np.linalg.norm(rotations - others, axis=(1, 2)) / np.sqrt(2)


def _way(start: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return by what rotations turn into others, (..., 3, 3): axes times angles in radians, (..., 3)."""
    between = np.asarray(start.swapaxes(-2, -1) @ end)
    return Rotation.from_matrix(between.reshape(-1, 3, 3)).as_rotvec().reshape(between.shape[:-1])
