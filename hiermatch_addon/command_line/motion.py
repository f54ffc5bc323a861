# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand that carries motion from one rig to another."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import bpy

from ..properties.bone_pairs import load_pairs, save_pairs
from ..scene.motion.action_curves import actions_of, playing
from ..scene.motion.carried_action_io import carried_before
from ..scene.motion.rigs import rig_of, two_rigs
from ..transfers.motion.motion_job import MotionJob
from ..transfers.options.motion import motion_plan
from .match import add_output_option, add_pair_arguments, save_outputs
from .options import add_options
from .outputs import MOVING_KINDS
from .reports import add_report_options
from .retarget import NOT_OF_THE_MATCH, run_transfers

if TYPE_CHECKING:
    import argparse

    from ..jobs.transfer_job import Carried, TransferOptions
    from ..scene.character import Side
    from .command import ExitCode
    from .console import Console
    from .reports import Report


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add it."""
    parser = commands.add_parser(
        "motion",
        help="carry actions from one rig to another, whatever its bones are called",
        description="Pair the bones of two rigs by the surface that they move, if they are not paired yet, and carry "
        "actions of the source's over. Bodies that carry no match yet are matched first.",
        usage="%(prog)s SOURCE TARGET --output FILE [--action NAME] [options]",
    )
    add_pair_arguments(parser)
    group = parser.add_argument_group("what is written")
    add_output_option(group, "the target with its armature and new clips", MOVING_KINDS)
    group.add_argument("--write-pairs", type=Path, metavar="FILE.json", help="Write the pairs of bones as well.")
    add_report_options(parser)
    add_options(parser, "retarget_action", title="what is carried over")
    parser.add_argument(
        "--pairs",
        type=Path,
        metavar="FILE.json",
        help="Pairs of bones that were written before. With them, neither side needs a mesh.",
    )
    add_options(parser, "match", without=NOT_OF_THE_MATCH, title="options of the match, if it has to be made")
    parser.set_defaults(run=_run)


def _run(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Carry motion over and write."""
    names: list[str] = []

    def start(options: Any, pair: tuple[Side, Side], how: TransferOptions) -> MotionJob:  # noqa: ANN401 - the operator
        scene, rigs = cast("bpy.types.Scene", bpy.context.scene), two_rigs(*pair, written=True)
        if parsed.pairs is not None:
            load_pairs(scene, *rigs, parsed.pairs)
        if parsed.source.path.suffix.lower() != ".blend":
            options.action = _as_numbered(options.action, rigs[0])
        plan = motion_plan(scene, options, rigs[0])
        names.extend(plan.actions)
        return MotionJob(bpy.context, pair[0], [pair[1]], plan, how)

    def finish(report: Report, pair: tuple[Side, Side], _carried: list[Carried], _prefix: str) -> None:
        scene, rigs = cast("bpy.types.Scene", bpy.context.scene), (rig_of(pair[0]), rig_of(pair[1]))
        if parsed.write_pairs is not None:
            save_pairs(scene, *rigs, parsed.write_pairs.absolute())
            report.written.append(str(parsed.write_pairs.absolute()))
        made = [carried_before(rigs[1], bpy.data.actions[name]) for name in names]
        clips = [action for action in made if action is not None]
        save_outputs(parsed, report, pair[1], console, clean=True, clips=clips)

    return run_transfers(parsed, console, "retarget_action", start, finish=finish)


def _as_numbered(text: str, rig: bpy.types.Object) -> str:
    """Return what a text names actions of an imported rig by, as they are called here.

    Where the target's file has an action of that name, Blender has given the imported one a number.
    """
    called: dict[str, str] = {}
    for names in ([action.name for action in actions_of(rig)], playing(rig)):  # what it plays is certainly its own
        called |= {name.rpartition(".")[0]: name for name in names if name.rpartition(".")[2].isdecimal()}
        called |= dict(zip(names, names, strict=True))
    parts = [text] if text in called else text.split(";")
    return ";".join(called.get(part.strip(), part) for part in parts)
