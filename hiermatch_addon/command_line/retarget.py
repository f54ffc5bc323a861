# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand that carries what the source has to the target."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import bpy

from ..common.access import view_layer_of
from ..common.errors import DoubtfulMatchError
from ..jobs.match_job import job_options
from ..jobs.transfer_job import TransferJob, TransferOptions
from ..properties.freshness import refresh, show_match
from ..scene.pair import name_of
from ..transfers.options.retarget import chosen_transfers
from ..transfers.retarget_properties import remember_transfer
from .console import drive
from .match import add_pair_arguments, add_result_options, load_pair, save_results, warn_if_nothing_is_written
from .options import add_options, chosen_options, given_options
from .reports import add_report_options, run_reported

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from ..jobs.transfer import Transfer
    from ..jobs.transfer_job import Carried
    from ..scene.character import Side
    from ..transfers.motion.motion_job import MotionJob
    from .command import ExitCode
    from .console import Console
    from .reports import Report

    _Pair: TypeAlias = tuple[Side, Side]
    _Start: TypeAlias = Callable[[Any, _Pair, TransferOptions], TransferJob | MotionJob]

NOT_OF_THE_MATCH = frozenset({"prefix", "dense", "use_modifiers"})
"""Options of a match that retargeting decides itself, or has under the same name."""


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add it."""
    parser = commands.add_parser(
        "retarget",
        help="carry rig, weights, shape keys, UV maps and attributes from one mesh to another",
        description="Match the source with the target if they carry no match yet, and carry over what the source has.",
        usage="%(prog)s SOURCE TARGET --output FILE [--map FILE] [options]",
    )
    add_transfer_arguments(parser, "retarget", "what is carried over")
    parser.set_defaults(run=_run)


def add_transfer_arguments(
    parser: argparse.ArgumentParser, operator: str, title: str, what: str = "the target with its armature"
) -> None:
    """Add what a command takes that carries something over: `what` is written, by options of an operator."""
    add_pair_arguments(parser)
    add_result_options(parser, what)
    add_report_options(parser)
    add_options(parser, operator, title=title)
    add_options(parser, "match", without=NOT_OF_THE_MATCH, title="options of the match, if it has to be made")


def _run(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Retarget and write."""
    return run_transfers(
        parsed,
        console,
        "retarget",
        transferring(lambda options, _pair: chosen_transfers(options, options.prefix), optional=True),
    )


def transferring(make: Callable[[Any, tuple[Side, Side]], list[Transfer]], *, optional: bool) -> _Start:
    """Return what starts the job of transfers, which are made of an operator's options for a source and a target.

    Those that cannot be carried over are left out with a note if they are `optional`.
    """

    def start(options: Any, pair: tuple[Side, Side], how: TransferOptions) -> TransferJob:  # noqa: ANN401 - see `_Start`
        how = replace(how, optional=optional)
        return TransferJob(bpy.context, pair[0], [pair[1]], lambda: make(options, pair), how)

    return start


def run_transfers(
    parsed: argparse.Namespace,
    console: Console,
    operator: str,
    start: _Start,
    *,
    finish: Callable[[Report, _Pair, list[Carried], str], None] | None = None,
    choose: Callable[[Any, _Pair], _Pair] | None = None,
) -> ExitCode:
    """Carry something over and write all files that are wanted.

    Parameters
    ----------
    parsed : argparse.Namespace
        The arguments.
    console : Console
        Where to say how far it is.
    operator : str
        The operator whose options are among them.
    start : callable
        Starts the job: of the operator's options, for source and target, by some way between them.
    finish : callable, optional
        Writes the files in place of `save_results`, when all was carried over; its last argument is the match's prefix.
    choose : callable, optional
        Returns what of source and target is meant by the operator's options.
    """
    warn_if_nothing_is_written(parsed, console)

    def work(report: Report) -> None:
        options = chosen_options(operator, given_options(operator, parsed))
        of_match = {k: v for k, v in given_options("match", parsed).items() if k not in NOT_OF_THE_MATCH}
        matching = chosen_options("match", of_match | ({"prefix": options.prefix} if options.prefix else {}))
        settings = TransferOptions(
            job_options(matching),
            options.prefix,
            refine=options.refine,
            accept_doubtful=options.accept_doubtful,
        )
        console.progress(0.0, "Reading files")
        pair = load_pair(parsed, report)
        source, target = pair if choose is None else choose(options, pair)
        context = bpy.context
        job = start(options, (source, target), settings)
        try:
            drive(job, console)
        except DoubtfulMatchError:
            report.add_doubts(job.doubts)
            raise
        carried = job.finish(context)
        outcome = carried[0].outcome
        if outcome is not None:
            show_match(context, outcome.stored, outcome.stored.names, matching.prefix, outcome.seconds)
        refresh(cast("bpy.types.Scene", context.scene))
        layer = view_layer_of(context)
        panel = getattr(bpy.types, f"HIERMATCH_OT_{operator}").panel
        remember_transfer(context, panel, (name_of(layer, source), name_of(layer, target)), carried)
        report.add_carried(carried)
        prefix = options.prefix if outcome is None else matching.prefix
        if finish is not None:
            if outcome is not None:
                report.add_match(outcome.stored)
            finish(report, (source, target), carried, prefix)
            return
        save_results(parsed, report, (source, target), prefix, console, clean=True)

    read = [getattr(parsed, "pairs", None), parsed.source.path, parsed.target.path]
    return run_reported(parsed, [path for path in read if path is not None], console, work)
