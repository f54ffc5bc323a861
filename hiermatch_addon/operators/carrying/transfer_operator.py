# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Common base of the operators that carry something from a source to targets."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import bpy

from ...common.access import view_layer_of, window_manager_of
from ...common.redraw import redraw_sidebars
from ...common.translated_text import translated
from ...jobs.job_operator import JobOperator
from ...jobs.match_job import job_options
from ...jobs.running import start_soon
from ...jobs.transfer_job import TransferJob, TransferOptions
from ...panels.question import draw_question
from ...properties.freshness import refresh, show_match
from ...properties.panel_state import progress_of, state_of
from ...properties.summary import pick_named
from ...scene.pair import lacking_meshes, name_of
from ...storage.writing import LONGEST_PREFIX
from ...transfers.retarget_properties import remember_transfer
from ..pair_operator import NamedPair, pick_sides

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...jobs.transfer import Transfer
    from ...jobs.transfer_job import Carried
    from ...jobs.verdict import Verdict
    from ...scene.character import Side
    from ...transfers.motion.motion_job import MotionJob


_MENU_WIDTH = 64
"""Letters in a line of the menu that asks."""


class TransferOperator(NamedPair, JobOperator):
    """To be inherited from before `bpy.types.Operator`; what is carried says `_transfers`."""

    target: bpy.props.StringProperty(
        name="Target",
        description="Name of the object to carry to; if empty, the one picked in the panel or else all other "
        "selected meshes",
        options={"SKIP_SAVE"},
    )
    targets: bpy.props.CollectionProperty(
        name="Targets",
        description="Names of several objects to carry to",
        type=bpy.types.OperatorFileListElement,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    prefix: bpy.props.StringProperty(
        name="Prefix",
        description="What the names start with that the match to use wrote; if empty, the one match that the "
        "objects carry",
        maxlen=LONGEST_PREFIX,
        options={"SKIP_SAVE"},
    )
    refine: bpy.props.BoolProperty(
        name="Refine with Rig",
        description="If the source has a rig, fit it into the target and make the map of the match better with it, "
        "once for each match. It takes some seconds, and weights, joints and shape keys gain much",
        default=True,
    )
    accept_doubtful: bpy.props.BoolProperty(
        name="Accept Doubtful",
        description="Write the result also if the match is not to be trusted, with a confidence below 30 percent. "
        "In a window you are asked",
        options={"SKIP_SAVE"},
    )

    doing = "Carrying over"
    cancelled = "It was cancelled. Nothing was written"
    panel = "HIERMATCH_PT_retarget"
    optional = False

    _writes = True  # whether anything is written on the targets themselves
    _left_out = ""  # which parts of the source's own character, as a sentence
    _named = False  # whether a script says which objects
    _asks = False  # whether there is somebody to be asked about a doubtful match

    def _transfers(self) -> list[Transfer]:
        """Make the transfers for one target, of the operator's options."""
        raise NotImplementedError

    @classmethod
    def _lacking(cls, context: bpy.types.Context) -> str:
        return lacking_meshes(view_layer_of(context))

    def _start(self, context: bpy.types.Context) -> TransferJob | MotionJob:
        """Read all objects."""
        state = state_of(context)
        self._named = bool(self.source and (self.target or len(self.targets)))
        source, targets = self._pick(context)
        match = replace(job_options(state), prefix=self.prefix or state.prefix)
        options = TransferOptions(
            match,
            self.prefix,
            refine=self.refine,
            optional=self.optional,
            accept_doubtful=self.accept_doubtful,
            asks=self._asks,
        )
        job = self._make_job(context, source, targets, options)
        # So that Adjust Last Operation repeats it with the same ones, whatever is selected by then.
        self.source = name_of(view_layer_of(context), source)
        self.targets.clear()
        for target in targets:
            self.targets.add().name = name_of(view_layer_of(context), target)
        return job

    def _make_job(
        self, context: bpy.types.Context, source: Side, targets: list[Side], options: TransferOptions
    ) -> TransferJob | MotionJob:
        """Make the job that carries."""
        return TransferJob(context, source, targets, self._transfers, options, writes=self._writes)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Do it in slices, and ask about a match that is not to be trusted."""
        self._asks = True
        return super().invoke(context, event)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Go on with the work, but for as long as it is open whether to write what is doubtful."""
        job = cast("TransferJob | MotionJob", self._job)
        doubts = job.doubts
        progress = progress_of(context)
        if not doubts or progress.cancel or (event.type == "ESC" and event.value == "PRESS"):
            return super().modal(context, event)
        if not progress.question:
            self._ask(context, doubts)
        if progress.answer == "WRITE":
            self.accept_doubtful = True  # Adjust Last Operation does not ask again
            job.accept()
            progress.question = progress.answer = ""
        elif progress.answer == "LANDMARKS":
            self.cancel(context)
            self.report(
                {"INFO"}, translated("Nothing was written. Name corresponding places by clicks, and match again")
            )
            start_soon(context, "hiermatch.guide_me")
            return {"CANCELLED"}
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """End the run, and take the question back."""
        progress_of(context).question = progress_of(context).answer = ""
        super().cancel(context)

    def _ask(self, context: bpy.types.Context, doubts: list[tuple[str, Verdict]]) -> None:
        """Ask in a menu under the mouse; the panel asks the same, for as long as there is no answer."""
        progress = progress_of(context)
        lines = [f'The match with "{target}" is doubtful. {verdict.said}' for target, verdict in doubts]
        progress.question, progress.answer = "\n".join(lines), ""

        def draw(menu: bpy.types.UIPopupMenu, _context: bpy.types.Context) -> None:
            draw_question(cast("Any", menu).layout, lines, _MENU_WIDTH)

        if not bpy.app.background:  # where a menu would bring Blender down
            window_manager_of(context).popup_menu(draw, title=translated("The match is doubtful"), icon="ERROR")
        redraw_sidebars(window_manager_of(context))

    def _finish(self, context: bpy.types.Context, job: TransferJob | MotionJob) -> set[OperatorReturnItems]:
        """Write, remember and report."""
        carried = job.finish(context)
        scene = cast("bpy.types.Scene", context.scene)
        if self._named and len(carried) == 1:
            pick_named(scene, self.source, self.targets[0].name)
        for made in (one.outcome for one in carried if one.outcome is not None):
            prefix = self.prefix or state_of(context).prefix
            show_match(context, made.stored, made.stored.names, prefix, made.seconds)
        refresh(scene)
        remember_transfer(context, self.panel, (self.source, self.targets[-1].name), carried, self._left_out)
        self._report(carried)
        return {"FINISHED"}

    def _report(self, carried: list[Carried]) -> None:
        """Say what was done for each target, and what is to be known."""
        if self._left_out:
            self.report({"INFO"}, translated(self._left_out))
        reports = [report for one in carried for report in one.reports]
        for note in dict.fromkeys(note for report in reports for note in report.notes):
            self.report({"WARNING"}, translated(note))
        for remark in dict.fromkeys(remark for report in reports for remark in report.remarks):
            self.report({"INFO"}, translated(remark))
        for one in carried:
            carried_to = f'Carried to "{one.target}" in {one.seconds:.1f} s: {one.done}'
            found_for = f'Found for "{one.target}" in {one.seconds:.1f} s: {one.done}'
            self.report({"INFO"}, translated(carried_to if one.carries else found_for))
            if one.verdict is not None:
                self.report({"WARNING" if one.verdict.doubtful else "INFO"}, translated(one.verdict.said))

    def _pick(self, context: bpy.types.Context) -> tuple[Side, list[Side]]:
        """Find the source and the targets: by name, else as picked in the panel, else as selected.

        Raises
        ------
        ObjectError
            If a name is unknown, or the selection leaves open what is meant.
        """
        names = [item.name for item in self.targets] or ([self.target] if self.target else [])
        source, targets, self._left_out = pick_sides(context, self.source, names)
        return source, targets
