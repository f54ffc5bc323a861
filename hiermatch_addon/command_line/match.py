# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand that matches two meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..jobs.match_job import MatchJob, job_options
from ..properties.freshness import show_match
from ..scene.character import parts_of
from ..scene.pair import is_own
from ..storage import writing
from ..storage.linked_matches import kept_linked
from ..storage.match_exchange import collect_match
from ..storage.match_file import SUFFIXES, save_match
from .console import Console, drive
from .meshes import load_meshes, mesh_argument
from .options import add_options, chosen_options, given_options
from .outputs import KINDS, output_argument, save
from .reports import Report, add_report_options, run_reported

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from ..scene.character import Side
    from .command import ExitCode


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add it."""
    parser = commands.add_parser(
        "match",
        help="match two meshes",
        description="Find corresponding points of two meshes, whatever their pose, and write them on both.",
        usage="%(prog)s SOURCE TARGET [--output FILE] [--map FILE] [options]",
    )
    add_pair_arguments(parser)
    add_result_options(parser)
    add_report_options(parser)
    add_options(parser, "match")
    parser.set_defaults(run=_run)


def add_pair_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the two meshes."""
    parser.add_argument("source", type=mesh_argument, metavar="SOURCE", help="FILE or FILE:NAME of the source.")
    parser.add_argument("target", type=mesh_argument, metavar="TARGET", help="FILE or FILE:NAME of the target.")


def add_result_options(parser: argparse.ArgumentParser, what: str = "the target with its armature") -> None:
    """Add where results are written."""
    group = parser.add_argument_group("what is written")
    add_output_option(group, what)
    group.add_argument(
        "--map",
        type=output_argument(SUFFIXES),
        metavar="FILE",
        help="Write the correspondence into an .npz or .json as well.",
    )


def add_output_option(group: Any, what: str, kinds: Sequence[str] = KINDS) -> None:  # noqa: ANN401 - as above
    """Add where the scene, or the target, is written."""
    named = f"{', '.join(kinds[1:-1])} or {kinds[-1]}"
    group.add_argument(
        "--output",
        type=output_argument(kinds),
        action="append",
        default=[],
        metavar="FILE",
        help=f"Write the whole scene into a .blend, or {what} into a {named}; may be given several times.",
    )


def warn_if_nothing_is_written(parsed: argparse.Namespace, console: Console) -> None:
    """Say before the work that nothing will be left of it."""
    if not (parsed.output or getattr(parsed, "map", None) or parsed.report):
        console.say("Nothing will be written: name a file by --output, --map or --report.")


def load_pair(parsed: argparse.Namespace, report: Report) -> tuple[Side, Side]:
    """Load source and target."""
    # What goes on has the names of the target's file; but options of some commands name actions and objects of the
    # source's.
    target_first = parsed.command not in {"motion", "my-rig", "wear"}
    (source, target), notes = load_meshes([parsed.source, parsed.target], last_first=target_first)
    report.add_object("source", parsed.source, source)
    report.add_object("target", parsed.target, target)
    report.add_notes(notes)
    return source, target


def save_results(
    parsed: argparse.Namespace,
    report: Report,
    pair: tuple[Side, Side],
    prefix: str,
    console: Console,
    *,
    clean: bool = False,
    along: Sequence[bpy.types.Object] = (),
) -> None:
    """Write all files that are wanted of a pair that carries a match now, and describe the match.

    A `clean` target carries what was transferred into files other than a .blend, but no colors, groups and attributes
    of the match, which an engine or a renderer would take for its own.
    """
    both_own = is_own(pair[0]) and is_own(pair[1])
    match = collect_match(*pair, prefix) if both_own else kept_linked(*pair, prefix)
    if match is not None:
        report.add_match(match.stored)
    elif parsed.map is not None:
        report.add_notes([f'"{parsed.map}" was not written: of two meshes of other files no match is kept.'])
    if match is not None and parsed.map is not None:
        console.progress(1.0, f"Writing {parsed.map}")
        save_match(match, parsed.map.absolute())
        report.written.append(str(parsed.map.absolute()))
    save_outputs(parsed, report, pair[1], console, clean=clean, along=along)


def save_outputs(
    parsed: argparse.Namespace,
    report: Report,
    target: Side,
    console: Console,
    *,
    clean: bool,
    clips: Sequence[bpy.types.Action] = (),
    along: Sequence[bpy.types.Object] = (),
) -> None:
    """Write the scene and the target into all files that are wanted; see `save_results` and `save`."""
    for path in sorted(parsed.output, key=lambda output: output.suffix.lower() != ".blend"):
        console.progress(1.0, f"Writing {path}")
        if clean and path.suffix.lower() != ".blend":
            for part in parts_of(target):
                for written in writing.prefixes(part) if part.type == "MESH" else ():
                    writing.clear(part, written)
        save(path, target, clips, along)
        report.written.append(str(path.absolute()))


def _run(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Match and write."""
    warn_if_nothing_is_written(parsed, console)

    def work(report: Report) -> None:
        options = chosen_options("match", given_options("match", parsed))
        settings = job_options(options)
        console.progress(0.0, "Reading files")
        source, target = load_pair(parsed, report)
        context = bpy.context
        job = MatchJob(context, source, target, settings)
        drive(job, console)
        outcome = job.finish()
        show_match(context, outcome.stored, outcome.stored.names, options.prefix, outcome.seconds)
        save_results(parsed, report, (source, target), options.prefix, console)

    return run_reported(parsed, [parsed.source.path, parsed.target.path], console, work)
