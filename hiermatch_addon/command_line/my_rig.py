# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand that fits an armature that stands in the source, such as a metarig, into the target."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..common.phrases import listed
from ..scene.character import armatures_above
from ..transfers.my_rig import MyRigTransfer, check_has_body
from ..transfers.options.my_rig import my_rig_settings
from .match import save_results
from .retarget import add_transfer_arguments, run_transfers, transferring

if TYPE_CHECKING:
    import argparse

    from ..jobs.transfer import Transfer
    from ..jobs.transfer_job import Carried
    from ..scene.character import Side
    from .command import ExitCode
    from .console import Console
    from .reports import Report


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add it."""
    parser = commands.add_parser(
        "my-rig",
        help="fit an armature that stands in one body into another",
        description="Match the source with the target if they carry no match yet, and give the target a copy of an "
        "armature that stands in the source, with its joints where they belong in the target. Without --rig it is the "
        "only armature of the files that moves nothing.",
        usage="%(prog)s SOURCE TARGET --output FILE [--rig NAME] [options]",
    )
    written = "the target with its armature, and the fitted rig,"
    add_transfer_arguments(parser, "fit_my_rig", "which armature is fitted, and how", written)
    parser.set_defaults(run=_run)


def _run(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Fit and write."""
    known: set[bpy.types.Object] = set()

    def choose(options: Any, pair: tuple[Side, Side]) -> tuple[Side, Side]:  # noqa: ANN401 - stands for the operator
        check_has_body(pair[0])
        options.rig = options.rig or _only_idle()
        known.update(bpy.data.objects)
        return pair

    def finish(report: Report, pair: tuple[Side, Side], _carried: list[Carried], prefix: str) -> None:
        made = [obj for obj in bpy.data.objects if obj not in known and obj.type == "ARMATURE"]
        save_results(parsed, report, pair, prefix, console, clean=True, along=made)

    start = transferring(_transfers, optional=False)
    return run_transfers(parsed, console, "fit_my_rig", start, finish=finish, choose=choose)


def _transfers(options: Any, _pair: tuple[Side, Side]) -> list[Transfer]:  # noqa: ANN401 - stands for the operator
    """Make the transfer of the options."""
    return [MyRigTransfer(my_rig_settings(options))]


def _only_idle() -> str:
    """Return the name of the only armature that moves nothing.

    Raises
    ------
    ObjectError
        If there is none, or more.
    """
    objects = view_layer_of(bpy.context).objects
    busy = {armature for obj in objects if obj.type != "ARMATURE" for armature in armatures_above(obj)}
    idle = [obj.name for obj in objects if obj.type == "ARMATURE" and obj not in busy]
    if len(idle) > 1:
        raise ObjectError(f"Several armatures move nothing: {listed(sorted(idle))}. Name one by --rig.")
    if not idle:
        raise ObjectError(
            "There is no armature that moves nothing. The one to be fitted has to be in the file of the source; if it "
            "moves something, name it by --rig."
        )
    return idle[0]
