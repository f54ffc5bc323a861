# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairing the bones of rigs as a piece of work: matching where needed, fitting, comparing, and writing at last."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING, cast

import bpy

from ...engine import Progress, fit_rig_steps, match_steps, pair_bones, within
from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..common.side_names import side_of
from ..properties.bone_pairs import held_pairs, write_pairing
from ..scene.armatures import armature_of
from ..scene.motion.rigged_body import bound_meshes, check_armature, in_own_spaces, object_rotation, read_body, rig_of
from ..scene.pair import check_pair
from ..storage.stored_map import find_maps
from .job import MatchJob
from .stepped_job import SteppedJob
from .transfer_job import carry_fresh_match

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...engine import BonePairing, Steps, SurfaceMap
    from ..scene.motion.rigged_body import RiggedBody
    from ..storage.vertex_maps import StoredMaps
    from .job import JobOptions, Outcome

__all__ = ["PairedRigs", "PairingJob", "RigLink", "found_again"]

_MATCHED, _FITTED = 0.5, 0.95
"""Where on the progress bar of two rigs a match, and the fitting of the rig, end."""

_EXCHANGED = 0.5
"""Part of the pairs with sides in their names from which on, if they contradict, the match may be mirrored."""


@dataclass(frozen=True)
class RigLink:
    """An armature that is looked up again and again: its number in this session and its name."""

    uid: int
    name: str

    @classmethod
    def of(cls, armature: bpy.types.Object) -> RigLink:
        """Make a link to an armature."""
        return cls(armature.session_uid, armature.name)


def found_again(link: RigLink) -> bpy.types.Object:
    """Look an object up again.

    Raises
    ------
    ObjectError
        If it was deleted.
    """
    found = next((obj for obj in bpy.data.objects if obj.session_uid == link.uid), None)
    if found is None:
        raise ObjectError(f'"{link.name}" was deleted meanwhile. Nothing was written.')
    return found


@dataclass(frozen=True)
class PairedRigs:
    """What became of two rigs.

    Attributes
    ----------
    source, target : str
        Names of the armatures.
    pairs, bones : int
        Number of pairs, and of the target's bones that are in one.
    outcome : Outcome or None
        The match, if it was made (and written) on the way.
    notes : tuple of str
        What is to be known.
    seconds : float
        How long it took until here since the job began.
    """

    source: str
    target: str
    pairs: int
    bones: int
    outcome: Outcome | None
    notes: tuple[str, ...]
    seconds: float


class _Leg:
    """The way from one rig to another."""

    def __init__(
        self,
        context: bpy.types.Context,
        source: bpy.types.Object,
        target: bpy.types.Object,
        options: JobOptions,
        *,
        keep: bool,
    ) -> None:
        self.rigs = tuple(RigLink.of(rig_of(obj)) for obj in (source, target))
        rigs = [found_again(link) for link in self.rigs]
        for rig in rigs:
            check_armature(rig, written=False)
        if rigs[0] == rigs[1]:
            raise ObjectError(f'Source and Target are both "{rigs[0].name}". Choose two different armatures.')
        meshes = [bound_meshes(context, obj) for obj in (source, target)]
        for obj in (mesh for each in meshes for mesh in each):
            if obj.mode != "OBJECT":
                raise ObjectError(
                    f'"{obj.name}" is in {obj.mode.replace("_", " ").title()}. Switch to Object Mode first.'
                )
        self.stored: StoredMaps | None = None
        self.refined = False
        self.match: MatchJob | None = None
        for one, other in product(*meshes):
            if carry_fresh_match(one, other, ""):
                found = find_maps(one, other, "")
                self.stored, self.refined, meshes = found.maps, found.refined, [[one], [other]]
                break
        else:
            if keep and len(meshes[0]) == len(meshes[1]) == 1:
                check_pair(view_layer_of(context), meshes[0][0], meshes[1][0])
                self.match = MatchJob(context, meshes[0][0], meshes[1][0], options)
        self.bodies: tuple[RiggedBody, ...] = tuple(read_body(context, each) for each in meshes)
        if not self.bodies[0].weights.nnz:
            raise ObjectError(
                f'No vertex of "{meshes[0][0].name}" is in a vertex group of a deforming bone of "{rigs[0].name}", so '
                "it is open what the bones belong to. Bind the Source to its armature with weights first."
            )
        self.held = held_pairs(cast("bpy.types.Scene", context.scene), *rigs)
        turns = [object_rotation(rig) for rig in rigs]
        self.frames = (turns[1] @ turns[0].T)[None]
        self.settings = options.settings
        self.pairing: BonePairing | None = None


class PairingJob(SteppedJob):
    """Pairs the bones of one rig with those of others.

    Nothing is written before `finish`.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    source : bpy.types.Object
        An armature, or a mesh that it moves.
    targets : sequence of bpy.types.Object
        Others.
    match : JobOptions
        How bodies are matched that carry no match yet.

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
        source: bpy.types.Object,
        targets: Sequence[bpy.types.Object],
        match: JobOptions,
    ) -> None:
        self._begun = time.perf_counter()
        options = replace(match, use_modifiers=False, settings=replace(match.settings, dense=True))
        keep = len(targets) == 1
        self._legs = [_Leg(context, source, target, options, keep=keep) for target in targets]
        self._view_layer = view_layer_of(context)
        super().__init__()

    def close(self) -> None:
        """Drop the work, and the matches that are being made."""
        super().close()
        for leg in self._legs:
            if leg.match is not None:
                leg.match.close()

    def pairing(self, number: int) -> BonePairing:
        """Return the pairs that were found for one target, in the armatures' own spaces."""
        return cast("BonePairing", self._legs[number].pairing)

    def finish(self, context: bpy.types.Context) -> list[PairedRigs]:
        """Write the tables, and the match if there is a new one.

        Raises
        ------
        HierMatchError
            If an object has changed since it was read.
        """
        if not self._done:
            raise RuntimeError("The work has not come to its end yet.")
        found = [self._checked(leg) for leg in self._legs]
        done = []
        for leg, rigs in zip(self._legs, found, strict=True):
            outcome = leg.match.finish(view_layer_of(context)) if leg.match is not None else None
            pairing = cast("BonePairing", leg.pairing)
            write_pairing(cast("bpy.types.Scene", context.scene), rigs[0], rigs[1], pairing)
            notes = tuple(_notes(leg, pairing))
            counts = len(pairing), len(set(pairing.targets.tolist()))
            done.append(
                PairedRigs(rigs[0].name, rigs[1].name, *counts, outcome, notes, time.perf_counter() - self._begun)
            )
        return done

    def _checked(self, leg: _Leg) -> list[bpy.types.Object]:
        """Look the armatures up again and make sure that they have the bones that were read."""
        rigs = [found_again(link) for link in leg.rigs]
        for rig, body in zip(rigs, leg.bodies, strict=True):
            if tuple(bone.name for bone in armature_of(rig).bones) != body.names:
                raise ObjectError(f'The bones of "{rig.name}" were changed meanwhile. Nothing was written.')
        return rigs

    def _check(self, view_layer: bpy.types.ViewLayer) -> None:
        self._view_layer = view_layer
        for leg in self._legs:
            self._checked(leg)

    def _all_steps(self) -> Steps[None]:
        """Pair the rigs, one after another."""
        count = len(self._legs)
        for number, leg in enumerate(self._legs):
            yield from within(self._leg_steps(leg), number / count, (number + 1) / count)

    def _leg_steps(self, leg: _Leg) -> Steps[None]:
        """Match, fit the rig, and compare the bones."""
        source, target = leg.bodies
        maps: tuple[SurfaceMap, SurfaceMap]
        if leg.match is not None:
            while not leg.match.advance(self._view_layer, 0.0):
                yield Progress(_MATCHED * leg.match.progress.fraction, leg.match.progress.label)
            leg.stored = leg.match.maps
        if leg.stored is not None:
            pair = leg.stored.between(source.mesh, target.mesh)
            maps = pair.source_to_target, pair.target_to_source
        else:
            result = yield from within(match_steps(source.mesh, target.mesh, leg.settings), 0.0, _MATCHED)
            if result.source_to_target is None or result.target_to_source is None:
                raise ObjectError("The two bodies could not be matched vertex by vertex, so their bones stay unpaired.")
            maps = result.source_to_target, result.target_to_source
        fit = fit_rig_steps(
            source.mesh,
            target.mesh,
            *maps,
            weights=source.weights,
            skeleton=source.skeleton,
            refine=not leg.refined,
        )
        fitted = yield from within(fit, _MATCHED, _FITTED)
        yield Progress(_FITTED, "Pairing bones")
        pairing = pair_bones(
            fitted,
            source.mesh,
            target.mesh,
            target.skeleton,
            target.weights,
            fixed=leg.held[0],
            alone=leg.held[1],
            frames=leg.frames,
        )
        if not len(pairing):
            raise ObjectError(
                f'No bone of "{leg.rigs[1].name}" moves what one of "{leg.rigs[0].name}" moves. Check the match, and '
                "that both meshes have weights."
            )
        leg.pairing = in_own_spaces(pairing, *(found_again(link) for link in leg.rigs))


def _notes(leg: _Leg, pairing: BonePairing) -> list[str]:
    """Say what is to be known: names of sides that contradict."""
    sides = [
        (side_of(leg.bodies[0].names[source]), side_of(leg.bodies[1].names[target]))
        for source, target in zip(pairing.sources, pairing.targets, strict=True)
    ]
    told = [one * other for one, other in sides if one * other]
    if told and sum(each < 0 for each in told) > _EXCHANGED * len(told):
        said = (
            f'By their names, left bones of "{leg.rigs[0].name}" are paired with right ones of "{leg.rigs[1].name}". '
            "If that is wrong, the match is mirrored: flip it, and pair the bones again."
        )
        return [said]
    return []
