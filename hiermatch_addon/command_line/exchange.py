# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommands that write the match of two meshes into a file, and bring it back."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

from ..properties.freshness import show_match
from ..storage.match_exchange import apply_match, collect_match
from ..storage.match_file import SUFFIXES, load_match, save_match
from .match import add_pair_arguments, load_pair, save_outputs
from .outputs import KINDS, output_argument
from .reports import add_report_options, run_reported

if TYPE_CHECKING:
    import argparse

    from .command import ExitCode
    from .console import Console
    from .reports import Report


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add both."""
    parser = commands.add_parser(
        "export",
        help="write the match that two meshes carry into a file",
        description="Write the match that two meshes of .blend files carry into an .npz or .json file.",
    )
    add_pair_arguments(parser)
    parser.add_argument("map", type=output_argument(SUFFIXES), metavar="MATCH", help="The .npz or .json to write.")
    parser.add_argument("--prefix", default="", metavar="TEXT", help="Which match; if empty, the only one.")
    add_report_options(parser)
    parser.set_defaults(run=_export)
    parser = commands.add_parser(
        "import",
        help="write the match that a file holds on two meshes",
        description="Write a match from an .npz or .json file on two meshes with the same vertices and faces, in "
        "whatever pose.",
    )
    add_pair_arguments(parser)
    parser.add_argument("map", type=Path, metavar="MATCH", help="The .npz or .json to read.")
    parser.add_argument(
        "--output",
        type=output_argument(KINDS),
        action="append",
        required=True,
        metavar="FILE",
        help="Where to write both; a .blend, or another kind for the target alone.",
    )
    parser.add_argument("--prefix", default="HM", metavar="TEXT", help="What all names start with. (default: HM)")
    add_report_options(parser)
    parser.set_defaults(run=_import)


def _export(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Read two meshes, and write their match."""

    def work(report: Report) -> None:
        source, target = load_pair(parsed, report)
        match = collect_match(source, target, parsed.prefix)
        report.add_match(match.stored)
        save_match(match, parsed.map.absolute())
        report.written.append(str(parsed.map.absolute()))

    return run_reported(parsed, [parsed.source.path, parsed.target.path], console, work)


def _import(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Read two meshes and their match, and write it on them."""

    def work(report: Report) -> None:
        match = load_match(parsed.map)
        source, target = load_pair(parsed, report)
        context = bpy.context
        stored = apply_match(context, source, target, match, parsed.prefix)
        show_match(context, stored, stored.names, parsed.prefix)
        report.add_match(stored)
        save_outputs(parsed, report, target, console, clean=False)

    return run_reported(parsed, [parsed.source.path, parsed.target.path, parsed.map], console, work)
