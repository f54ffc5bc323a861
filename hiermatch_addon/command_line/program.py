# SPDX-License-Identifier: GPL-3.0-or-later
"""The command with its subcommands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...engine import HierMatchError
from . import exchange, match, motion, my_rig, retarget, symmetry, wear
from .batches import batch
from .command import ExitCode, UsageError
from .console import Console
from .options import Parser

if TYPE_CHECKING:
    from collections.abc import Sequence

_DESCRIPTION = """\
Find dense correspondence of two meshes in any pose, and carry rigs, weights, shape keys, UV maps, attributes and motion
across it.  FILE is a .blend, .obj, .ply, .stl, .fbx, .glb, .gltf or .vrm file.  FILE:NAME names a mesh in it, an
armature with all meshes that it moves, or a collection; without a name it is the only mesh of a .blend, or all that
its only armature moves, and of another file the mesh with the most vertices, with all others on its armature.
"""


def make_parser() -> Parser:
    """Make the parser of the whole command.

    Each subcommand leaves in `run` what runs it; `check` parses other arguments, for the rows of a batch.
    """
    parser = Parser(prog="blender --command hiermatch", description=_DESCRIPTION)
    commands = parser.add_subparsers(title="commands", dest="command", metavar="COMMAND", required=True)
    for module in (match, retarget, motion, my_rig, wear, symmetry, exchange, batch):
        module.add_commands(commands)
    parser.set_defaults(check=parser.parse_args)
    return parser


def main(arguments: Sequence[str], *, own_process: bool = False) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str
        What follows ``blender --command hiermatch``.
    own_process : bool
        Whether the process ends with it.

    Returns
    -------
    int
        The exit code.
    """
    try:
        parsed = make_parser().parse_args(list(arguments))
    except SystemExit as end:  # after --help
        return int(end.code or 0)
    except UsageError as error:
        Console(quiet=True, own_process=False).error(f"{error}\n{error.usage}".rstrip())
        return ExitCode.USAGE
    console = Console(quiet=parsed.quiet, own_process=own_process)
    try:
        return int(parsed.run(parsed, console))
    except UsageError as error:
        console.error(f"{error}\n{error.usage}".rstrip())
        return ExitCode.USAGE
    except HierMatchError as error:
        console.error(str(error))
        return ExitCode.FAILED
