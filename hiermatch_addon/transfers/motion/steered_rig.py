# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion for a control rig: deforming bones get theirs by the controls that turn them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ....engine import Progress
from ...common.phrases import listed
from ...scene.armatures import armature_of, pose_of
from ...scene.motion.control_pose_io import posed_controls, set_switches
from ...scene.motion.control_rigs import (
    candidates_of,
    carriers,
    chosen_controls,
    tried_controls,
    with_carrier,
    worth_trying,
)
from ...scene.motion.holders import holds
from ...scene.motion.rigs import own_skeleton, rig_of
from .action_keys import BoneChannels

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ....engine import BonePairing, Steps, TransferredMotion
    from ...scene.character import SideReference
    from ...scene.motion.control_pose_io import Controls
    from ...scene.motion.control_rigs import Candidates

_AT_ONCE = 8
"""Groups of controls tried, or poses looked at, before Blender gets on with its own work: a fifth of a second for
Rigify's human.  A third of that is the copy of the rig that each lot needs."""

_AWAY = np.radians(10.0)
"""Mean angle by which a bone is turned otherwise than it should be from which on that is told."""


@dataclass(eq=False)
class SteeredRig:
    """A target whose bones follow controls.

    Attributes
    ----------
    controls : Controls
        What turns what.
    """

    controls: Controls
    _bases: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 4, 4)))
    _missed: dict[str, float] = field(default_factory=dict)

    def posed_steps(self, link: SideReference, found: TransferredMotion) -> Steps[None]:
        """Find out how the controls have to stand in each pose."""
        names = [bone.name for bone in armature_of(found_again(link)).bones]
        chosen = [names.index(name) for name in self.controls.turning]
        parts, start, count = [], 0, _AT_ONCE
        while start < len(found.motion):
            yield Progress(start / len(found.motion), "Posing controls")
            part = slice(start, start + count)
            turns, heads = found.motion.turns[part][:, chosen], found.motion.heads[part][:, chosen]
            bases, away, seen = posed_controls(found_again(link), self.controls, turns, heads)
            parts.append((bases, away))
            # As many next as should need so many looks.
            start, count = start + count, _AT_ONCE * len(seen) // int(seen.sum())
        self._bases = np.concatenate([bases for bases, _ in parts])
        missed = np.concatenate([away for _, away in parts]).mean(axis=0)
        self._missed = dict(zip(self.controls.turning, missed.tolist(), strict=True))

    def channels(self, armature: bpy.types.Object, plain: list[BoneChannels]) -> list[BoneChannels]:
        """Make the channels of the controls; bones without one that may be turned keep theirs (`plain`)."""
        pose = pose_of(armature).bones
        locked = {bone.name for bone in pose if any(bone.lock_rotation)}
        tree = own_skeleton(armature)
        made = [each for each in plain if each.bone in self.controls.lost and each.bone not in locked]
        for name, (control, bases) in self._by_control().items():
            made.append(BoneChannels.of_turns(pose[control], bases[:, :3, :3]))
            if name in self.controls.placed:
                made.append(BoneChannels.of_places(pose[control], bases[:, :3, 3], tree))
        return made

    def bases(self, plain: dict[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
        """Return the transforms of the controls in the first pose, and of bones without one."""
        found = {control: bases[0] for control, bases in self._by_control().values()}
        return {name: basis for name, basis in plain.items() if name in self.controls.lost} | found

    @property
    def placed(self) -> list[str]:
        """The controls that are moved, not only turned."""
        return [control for name, (control, _) in self._by_control().items() if name in self.controls.placed]

    def finished(self, armature: bpy.types.Object) -> tuple[str, ...]:
        """Set the switches that the controls need, and say so, and what does not follow."""
        said = []
        changed = set_switches(armature, self.controls.switches)
        if changed:
            said.append(
                f'{listed(changed)} of "{armature.name}" was set so that its bones follow the controls with keys.'
            )
        if self.controls.lost:
            said.append(f'No control turns {listed(self.controls.lost)} of "{armature.name}".')
        away = [name for name, angle in self._missed.items() if angle > _AWAY]
        if away:
            said.append(f'{listed(away)} of "{armature.name}" could not be turned as they should be by their controls.')
        return tuple(said)

    def _by_control(self) -> dict[str, tuple[str, NDArray[np.float64]]]:
        """For the first bone of each control the control and its transforms (f, 4, 4)."""
        found: dict[str, tuple[str, NDArray[np.float64]]] = {}
        known: set[str] = set()
        for number, (name, control) in enumerate(self.controls.turning.items()):
            if control not in known:
                known.add(control)
                found[name] = control, self._bases[:, number]
        return found


def is_steered(armature: bpy.types.Object, pairing: BonePairing) -> bool:
    """Tell whether constraints hold bones with partners."""
    pose = pose_of(armature).bones
    return any(holds(each) for number in np.unique(pairing.targets) for each in pose[int(number)].constraints)


def steered_steps(link: SideReference, found: TransferredMotion) -> Steps[SteeredRig | None]:
    """Find the controls of a target's bones; None if it has none, or needs none."""
    rig = found_again(link)
    names = [bone.name for bone in armature_of(rig).bones]
    moved, placed = ([names[number] for number in np.flatnonzero(each)] for each in (found.moved, found.rooted))
    tried = candidates_of(rig, moved)
    if tried is None:
        return None
    yield from _tried_steps(link, tried, worth_trying(rig, tried, moved), ())
    lost = chosen_controls(found_again(link), tried).lost
    for number, switch in enumerate(tried.switches):
        yield Progress(number / len(tried.switches), "Looking for controls")
        yield from _tried_steps(link, tried, worth_trying(found_again(link), tried, lost, switch), (switch,))
    chosen = chosen_controls(found_again(link), tried)
    if chosen.switches:  # what followed without them may not do so any more
        yield from _tried_steps(link, tried, worth_trying(found_again(link), tried, moved), chosen.switches)
        chosen = chosen_controls(found_again(link), tried, chosen.switches)
    yield from _tried_steps(link, tried, carriers(found_again(link), tried), chosen.switches)
    chosen = with_carrier(found_again(link), tried, chosen, placed)
    return SteeredRig(chosen) if any(name != control for name, control in chosen.turning.items()) else None


def _tried_steps(link: SideReference, tried: Candidates, names: list[str], switches: tuple) -> Steps[None]:  # type: ignore[type-arg]
    """Try controls, some at a time."""
    groups = tried.together(names)
    for start in range(0, len(groups), _AT_ONCE):
        yield Progress(start / len(groups), "Looking for controls")
        tried_controls(found_again(link), tried, groups[start : start + _AT_ONCE], switches)


def found_again(reference: SideReference) -> bpy.types.Object:
    """Look an armature up again.

    Raises
    ------
    ObjectError
        If it was deleted.
    """
    return rig_of(reference.found())
