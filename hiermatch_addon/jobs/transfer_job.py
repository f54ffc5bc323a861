# SPDX-License-Identifier: GPL-3.0-or-later
"""Carrying things from one mesh to others as a piece of work: matching where needed, computing, and writing at last."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...engine import HierMatchError, Progress, fit_rig_steps, within
from ..common.access import view_layer_of
from ..common.errors import DoubtfulMatchError, NothingToCarryError, ObjectError, SharedMeshError
from ..properties.preferences import shape_memory
from ..scene.armatures import armature_of, find_armature, read_rig
from ..scene.character import SideReference, positions_of, read_surface, topology_of, whole
from ..scene.deform_layer import reading_once
from ..scene.pair import check_pair, check_side, is_own
from ..scene.posing.before_after import show_after
from ..storage.halves import find_common
from ..storage.linked_matches import keep_linked, kept_linked
from ..storage.stored_map import find_maps, keep_refined
from ..storage.vertex_maps import MapPair, StoredMaps
from .match_job import MatchJob
from .prepared_shapes import known_shapes
from .stepped_job import SteppedJob
from .transfer import Passage, TransferReport
from .verdict import Verdict, advice_on, hung_on_bones, is_half

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import bpy

    from ...engine import Steps, TriangleMesh
    from ..scene.armatures import SourceRig
    from ..scene.character import Side
    from ..storage.stored_match import Quality, StoredMatch
    from .match_job import JobOptions, Outcome
    from .transfer import Transfer

_MATCHED, _FITTED = 0.5, 0.85
"""Where on a target's part of the progress bar a match, and the fitting of the rig, end."""


@dataclass(frozen=True)
class TransferOptions:
    """How the way from the source to each target is found.

    Attributes
    ----------
    match : JobOptions
        How two objects are matched that carry no match yet, or one that is out of date.
    prefix : str
        What the names of the match to use start with; may be empty if the two carry one match only.
    refine : bool
        Whether the map is refined with the source's rig, for what goes better with one.
    optional : bool
        Whether what cannot be carried over is left out with a note, if anything else can be.
    accept_doubtful : bool
        Whether to go on, too, if a match is not to be trusted.
    asks : bool
        Whether to wait then until somebody has called `accept`; else that is an error.
    """

    match: JobOptions
    prefix: str = ""
    refine: bool = True
    optional: bool = False
    accept_doubtful: bool = False
    asks: bool = False


@dataclass(frozen=True)
class Carried:
    """What became of one target.

    Attributes
    ----------
    target : str
        Its name.
    outcome : Outcome or None
        The match, if it was made (and written) on the way.
    reports : tuple of TransferReport
        One for each transfer, those that were left out last.
    seconds : float
        How long it took until here since the job began.
    verdict : Verdict or None
        How far the match can be trusted; None if that is not known, as of a match of an older version.
    """

    target: str
    outcome: Outcome | None
    reports: tuple[TransferReport, ...]
    seconds: float
    verdict: Verdict | None = None

    @property
    def done(self) -> str:
        """What was carried over, or found out."""
        done = [report.done for report in self.reports if report.done]
        return ", ".join(done) if done else "nothing"

    @property
    def carries(self) -> bool:
        """Whether something was carried over, and not only found out."""
        return not self.reports or any(report.carries for report in self.reports)


class _Leg:
    """The way to one target."""

    def __init__(
        self, context: bpy.types.Context, source: Side, target: Side, options: TransferOptions, *, writes: bool
    ) -> None:
        self.reference, self.name = SideReference.of(target), target.name
        self.source: TriangleMesh  # as the match knows it, once there is one
        self.stored: StoredMaps | None = None
        self.refined = False
        self.prefix = options.prefix
        self.quality: Quality | None = None
        self.kept: StoredMatch | None = None  # if one of both keeps it alone
        self.verdict: Verdict | None = None
        both_own = is_own(source) and is_own(target)
        if carry_fresh_match(source, target, options.prefix):
            found = find_maps(source, target, options.prefix)
            self.stored, self.refined, self.prefix = found.maps, found.refined, found.source.prefix
            self.quality = found.quality
        elif not both_own and (kept := kept_linked(source, target, options.prefix)) is not None:
            self.stored, self.refined, self.quality = kept.maps, kept.stored.answer.refined, kept.stored.answer.quality
            self.kept = kept.stored
        self.match: MatchJob | None = None
        if self.stored is None:
            written = is_own(source), writes
            self.match = MatchJob(context, source, target, _with_maps(options.match), writes=written)
            self.prefix = options.match.prefix
        self.mesh = read_surface(target, context.evaluated_depsgraph_get(), use_modifiers=False)
        self.is_half, self.hung = is_half(target), hung_on_bones(target)
        self.state = _state(target)
        self.transfers: list[Transfer] = []
        self.left_out: list[TransferReport] = []
        self.better: StoredMaps | None = None
        self._optional = options.optional

    def read(self, context: bpy.types.Context, source: Side, target: Side, made: list[Transfer]) -> None:
        """Read what is to be carried over.

        Raises
        ------
        HierMatchError
            If something cannot be, or, of optional kinds, none can; or if the target shares its mesh.
        """
        errors = []
        for transfer in made:
            try:
                transfer.read(context, source, target)
            except SharedMeshError:  # what is carried in part would be of no use, and is soon carried as a whole
                raise
            except HierMatchError as error:
                errors.append((transfer.label, error))
            else:
                self.transfers.append(transfer)
        if errors and not (self._optional and self.transfers):
            raise errors[0][1]
        for label, reason in errors:
            if not str(reason):
                continue
            said = (f"{label} left out: {reason}",)
            absent = isinstance(reason, NothingToCarryError)
            self.left_out.append(TransferReport("", remarks=said) if absent else TransferReport("", notes=said))


def carry_fresh_match(source: Side, target: Side, prefix: str) -> bool:
    """Tell whether two sides carry one dense match at least that is not out of date."""
    found = [pair for pair in find_common(source, target) if prefix in ("", pair[0].prefix)]
    fresh = [pair for pair in found if not any(half.staleness() for half in pair)]
    return bool(fresh) and any(half.kept.get("written", {}).get("dense") for pair in fresh for half in pair)


def _with_maps(options: JobOptions) -> JobOptions:
    """Return the options of a match that things can be carried across: dense, and of the meshes' own vertices."""
    return replace(options, use_modifiers=False, settings=replace(options.settings, dense=True))


def _state(side: Side) -> tuple[str, ...]:
    """Describe the vertices and faces of a side, and the bones of what moves it."""
    armature = find_armature(side)
    bones = () if armature is None else tuple(bone.name for bone in armature_of(armature).bones)
    return topology_of(side), positions_of(side), *bones


class TransferJob(SteppedJob):
    """Carries things from one source to several targets.

    Between two calls of `advance` Blender may do anything, so the job holds no references to its objects but looks
    them up again, and ends with an error if they are not what they were.  Nothing is written before `finish`.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    source : bpy.types.Object or Character
        What is carried from.
    targets : sequence of bpy.types.Object or Character
        Where it is carried to.
    make : callable
        Makes the transfers for one target.
    options : TransferOptions
        How the way is found.
    writes : bool
        Whether the meshes of the targets are written to.  If not, they may be another file's.

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
        make: Callable[[], list[Transfer]],
        options: TransferOptions,
        *,
        writes: bool = True,
    ) -> None:
        self._start = time.perf_counter()
        self._options, self._accepted, self._writes = options, options.accept_doubtful, writes
        depsgraph = context.evaluated_depsgraph_get()
        view_layer = view_layer_of(context)
        check_side(view_layer, source, writable=False)
        for target in targets:
            check_pair(view_layer, source, target, writes=(False, writes))
        self._source, self._source_name, self._source_state = SideReference.of(source), source.name, _state(source)
        self._mesh: TriangleMesh = read_surface(source, depsgraph, use_modifiers=False)
        self._is_half, self._hung = is_half(source), hung_on_bones(source)
        every = whole(source)
        self._whole = self._mesh if every == source else read_surface(every, depsgraph, use_modifiers=False)
        self._legs: list[_Leg] = []
        with reading_once():
            for target in targets:
                leg = _Leg(context, source, target, options, writes=writes)
                leg.read(context, source, target, make())
                self._legs.append(leg)
            wanted = any(transfer.uses_rig for leg in self._legs for transfer in leg.transfers)
            self._rig: SourceRig | None = read_rig(source) if wanted else None
        self._known = known_shapes(shape_memory(context))
        super().__init__()

    def close(self) -> None:
        """Drop the work, and the matches that are being made."""
        super().close()
        for leg in self._legs:
            if leg.match is not None:
                leg.match.close()

    def finish(self, context: bpy.types.Context) -> list[Carried]:
        """Write everything, target after target.

        Raises
        ------
        HierMatchError
            If an object has changed since it was read.
        """
        if not self._done:
            raise RuntimeError("The work has not come to its end yet.")
        view_layer = view_layer_of(context)
        source, targets = self._objects()
        check_side(None, source, writable=False)
        for target in targets:
            check_side(view_layer, target, writable=self._writes)
        for obj, state in ((source, self._source_state), *zip(targets, (leg.state for leg in self._legs), strict=True)):
            if _state(obj) != state:
                raise ObjectError(f'"{obj.name}" was edited meanwhile. Nothing was written.')
        for transfer in (transfer for leg in self._legs for transfer in leg.transfers):
            transfer.check()
        carried = []
        for leg, target in zip(self._legs, targets, strict=True):
            if self._writes:
                show_after(target)  # else what is switched on again now would be so once more later
            outcome = self._write_match(context, leg, source, target)
            reports = (*(transfer.write(context, source, target) for transfer in leg.transfers), *leg.left_out)
            carried.append(Carried(target.name, outcome, reports, time.perf_counter() - self._start, leg.verdict))
        return carried

    def _write_match(self, context: bpy.types.Context, leg: _Leg, source: Side, target: Side) -> Outcome | None:
        """Write the match if it is new, and the better maps.

        A source carries one match of a prefix only: with several targets, the new matches are used but not kept.  Those
        of a body that is another file's are kept on the other one alone.
        """
        outcome = None
        if not (is_own(source) and is_own(target)):
            self._keep_linked(leg, source, target)
            return None
        if leg.match is not None:
            if len(self._legs) > 1:
                return None
            outcome = leg.match.finish()
        if leg.better is not None:
            keep_refined(context, source, target, leg.prefix, leg.better)
        return outcome

    def _keep_linked(self, leg: _Leg, source: Side, target: Side) -> None:
        """Keep a match with a body of another file on the other one, if it is new or has become better."""
        stored = leg.kept if leg.match is None else leg.match.stored()
        if stored is None or (leg.match is None and leg.better is None):
            return
        maps = leg.stored if leg.better is None else leg.better
        if maps is not None:
            prefix = leg.prefix or self._options.match.prefix
            keep_linked(source, target, stored if leg.better is None else stored.as_refined(), maps, prefix)

    def _check(self) -> None:
        self._objects()

    def _all_steps(self) -> Steps[None]:
        """Go all ways, one after another."""
        count = len(self._legs)
        for number, leg in enumerate(self._legs):
            yield from within(self._leg_steps(leg), number / count, (number + 1) / count)

    def _leg_steps(self, leg: _Leg) -> Steps[None]:
        """Find the way to one target, and compute what is carried there."""
        begin = 0.0
        if leg.match is not None:
            while not leg.match.advance(0.0):
                yield Progress(_MATCHED * leg.match.progress.fraction, leg.match.progress.label)
            leg.stored, leg.quality, begin = leg.match.maps, leg.match.quality, _MATCHED
        if leg.stored is None:
            raise ObjectError(
                f'The match of "{self._source_name}" and "{leg.name}" has no dense map. Match them with Dense Map on.'
            )
        leg.source = self._whole if leg.stored.of_target.leads_beyond(self._mesh) else self._mesh
        self._judge(leg)
        while self.doubts:
            yield Progress(begin, "Waiting for an answer")
        passage = Passage(leg.stored.between(leg.source, leg.mesh))
        if not all(transfer.mirrors for transfer in leg.transfers):
            self._check_sides(leg.name, passage.pair)
        if self._rig is not None and any(transfer.uses_rig for transfer in leg.transfers):
            passage = yield from within(self._fitted_steps(leg, passage, self._rig), begin, _FITTED)
            begin = _FITTED
        share = (1 - begin) / max(len(leg.transfers), 1)
        for number, transfer in enumerate(leg.transfers):
            start = begin + number * share
            yield Progress(start, transfer.label)
            yield from within(transfer.steps(passage), start, start + share, transfer.label)

    def _check_sides(self, target: str, pair: MapPair) -> None:
        """Make sure that a match keeps left and right, before the work is done that would be of no use.

        Raises
        ------
        ObjectError
            If it does not.
        """
        if pair.source_to_target.mirrors(pair.source, pair.target):
            raise ObjectError(
                f'The match exchanges left and right between "{self._source_name}" and "{target}", and clothes and '
                "motion cannot be carried across it. Press Use Mirrored Match once more, or match again."
            )

    @property
    def doubts(self) -> list[tuple[str, Verdict]]:
        """Targets whose match is not to be trusted and that nobody has accepted, and what is said of each."""
        found = [(leg.name, leg.verdict) for leg in self._legs if leg.verdict is not None and leg.verdict.doubtful]
        return [] if self._accepted else found

    def accept(self) -> None:
        """Go on with matches that are not to be trusted."""
        self._accepted = True

    def _judge(self, leg: _Leg) -> None:
        """Say how far a match can be trusted.

        Raises
        ------
        DoubtfulMatchError
            If it cannot, and nobody wants it all the same.
        """
        if leg.quality is None:
            return
        names, meshes, halves = (self._source_name, leg.name), (leg.source, leg.mesh), (self._is_half, leg.is_half)
        advice = advice_on(leg.quality, names, meshes, halves=halves, hung=(self._hung, leg.hung))
        verdict = leg.verdict = Verdict.of(leg.quality, advice)
        if verdict.doubtful and not (self._accepted or self._options.asks):
            raise DoubtfulMatchError(
                f'The match of "{self._source_name}" and "{leg.name}" is doubtful, and nothing was written. '
                f"{verdict.said} Add landmarks and match again, or set Accept Doubtful to write it all the same."
            )

    def _fitted_steps(self, leg: _Leg, passage: Passage, rig: SourceRig) -> Steps[Passage]:
        """Fit the source's rig into the target, and take the better maps that come with it."""
        refine = self._options.refine and not leg.refined
        there, back = passage.pair.source_to_target, passage.pair.target_to_source
        fitted = yield from fit_rig_steps(
            leg.source,
            leg.mesh,
            there,
            back,
            weights=rig.weights,
            skeleton=rig.skeleton,
            refine=refine,
            known=self._known,
        )
        if refine:
            leg.better = StoredMaps.of(fitted.source_to_target, fitted.target_to_source)
        pair = MapPair(leg.source, leg.mesh, fitted.source_to_target, fitted.target_to_source)
        return Passage(pair, fitted, rig.names)

    def _objects(self) -> tuple[Side, list[Side]]:
        """Look the objects up again."""
        return self._source.found(), [leg.reference.found() for leg in self._legs]
