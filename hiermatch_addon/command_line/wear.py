# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand that fits what the source wears to the target."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..jobs.job import job_options
from ..jobs.transfer_job import TransferJob, TransferOptions
from ..properties.freshness import refresh
from ..properties.panel_state import state_of
from ..properties.summary import remember
from ..scene.garments import meshes_of
from ..transfers.options.wear import wear_settings
from ..transfers.retarget_properties import remember_transfer
from ..transfers.wear import WearTransfer
from .command import EXIT_CODES
from .console import drive
from .match import add_pair_arguments, add_result_options, load_pair, save_results, warn_if_nothing_is_written
from .options import add_options, chosen_options, given_options
from .reports import add_report_options, run_reported
from .retarget import NOT_OF_THE_MATCH

if TYPE_CHECKING:
    import argparse

    from .command import ExitCode
    from .console import Console
    from .reports import Report

__all__ = ["add_commands"]


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add it."""
    parser = commands.add_parser(
        "wear",
        help="fit clothes, hair and accessories of one body to another",
        description="Match the source with the target if they carry no match yet, and fit what the source wears: the "
        "objects of a collection, or else all that its armature moves. How each fits is kept on it.",
        usage="%(prog)s SOURCE TARGET --output FILE [--collection NAME] [options]",
        epilog=EXIT_CODES,
    )
    add_pair_arguments(parser)
    add_result_options(parser, "the target with its outfit")
    add_report_options(parser)
    add_options(parser, "wear", title="how it is fitted")
    add_options(parser, "match", without=NOT_OF_THE_MATCH, title="options of the match, if it has to be made")
    parser.set_defaults(run=_run)


def _run(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Fit and write."""
    warn_if_nothing_is_written(parsed, console)

    def work(report: Report) -> None:
        options = chosen_options("wear", given_options("wear", parsed))
        of_match = {k: v for k, v in given_options("match", parsed).items() if k not in NOT_OF_THE_MATCH}
        matching = chosen_options("match", of_match | ({"prefix": options.prefix} if options.prefix else {}))
        settings = TransferOptions(job_options(matching), options.prefix, refine=options.refine)
        console.progress(0.0, "Reading files")
        source, target = load_pair(parsed, report)
        items = meshes_of(options.collection, source, target) if options.collection else ()
        context = bpy.context
        job = TransferJob(context, source, [target], lambda: [WearTransfer(wear_settings(options, items))], settings)
        drive(job, context, console)
        carried = job.finish(context)
        outcome = carried[0].outcome
        if outcome is not None:
            names = (outcome.source, outcome.target)
            remember(state_of(context).summary, outcome.stored, names, matching.prefix, outcome.seconds)
        refresh(cast("bpy.types.Scene", context.scene))
        remember_transfer(context, carried)
        report.add_carried(carried)
        prefix = options.prefix if outcome is None else matching.prefix
        save_results(parsed, report, (source, target), prefix, console, clean=True)

    return run_reported(parsed, [parsed.source.path, parsed.target.path], console, work)
