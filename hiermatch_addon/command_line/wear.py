# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand that fits what the source wears to the target."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..common.errors import ObjectError
from ..jobs.transfer_job import TransferJob
from ..scene.character import parts_of
from ..scene.worn.garments import meshes_of, undressed
from ..transfers.options.wear import wear_settings
from ..transfers.wearing.wear_transfer import WearTransfer
from .retarget import add_transfer_arguments, run_transfers

if TYPE_CHECKING:
    import argparse

    from ..jobs.transfer import Transfer
    from ..jobs.transfer_job import TransferOptions
    from ..scene.character import Side
    from .command import ExitCode
    from .console import Console


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add it."""
    parser = commands.add_parser(
        "wear",
        help="fit clothes, hair and accessories of one body to another",
        description="Match the source with the target if they carry no match yet, and fit what the source wears: the "
        "objects that are named, or those of a collection, or else, if the source is one mesh, all others that its "
        "armature moves. Of a source that is an armature or a collection, what is not an item is the body. How each "
        "fits is kept on it.",
        usage="%(prog)s SOURCE TARGET --output FILE [--items NAME,NAME,... | --collection NAME] [options]",
    )
    add_transfer_arguments(parser, "wear", "how it is fitted", "the target with its armature and outfit")
    parser.set_defaults(run=_run)


def _run(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Fit and write."""

    def choose(options: Any, pair: tuple[Side, Side]) -> tuple[Side, Side]:  # noqa: ANN401 - as below
        if options.wear_result == "KEY" and any(path.suffix.lower() != ".blend" for path in parsed.output):
            raise ObjectError(
                "A shape key fits the items where the source wears them, so they are no part of the target's file. "
                "Write a .blend, or make fitted copies."
            )
        return _undressed_pair(options, pair)

    def start(options: Any, pair: tuple[Side, Side], how: TransferOptions) -> TransferJob:  # noqa: ANN401 - as below
        writes = options.wear_hide != "NONE"  # else the body may be another file's
        return TransferJob(bpy.context, pair[0], [pair[1]], lambda: _transfers(options), how, writes=writes)

    return run_transfers(parsed, console, "wear", start, choose=choose)


def _undressed_pair(options: Any, pair: tuple[Side, Side]) -> tuple[Side, Side]:  # noqa: ANN401 - as below
    """Find the items by name, and leave them out of a source of several objects."""
    source, target = pair
    if options.collection and not options.items:
        bodies = [*parts_of(target), *(parts_of(source) if len(parts_of(source)) == 1 else ())]
        options.items = meshes_of(options.collection, *bodies)
    return undressed(source, options.items, bpy.context.evaluated_depsgraph_get()), target


def _transfers(options: Any) -> list[Transfer]:  # noqa: ANN401 - stands for the operator
    """Make the transfer of the options."""
    return [WearTransfer(wear_settings(options, options.items))]
