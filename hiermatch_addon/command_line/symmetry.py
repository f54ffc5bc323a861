# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand that matches a mesh with its own mirror image, and makes what it carries symmetric."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ...engine import DIRECT, symmetry_map_steps
from ..common.access import mesh_of, view_layer_of
from ..common.errors import ObjectError
from ..common.phrases import listed
from ..scene.character import parts_of
from ..scene.mesh_io import position_digest, read_mesh, topology
from ..scene.pair import check_object
from ..storage.match_file import MatchFile, save_match
from ..storage.stored_match import Answer, CornerPoints, Quality, StoredMatch, Written
from ..storage.vertex_maps import StoredMaps
from ..transfers.options.symmetrise import symmetrise_settings
from ..transfers.symmetrise import SymmetriseJob
from .console import drive
from .match import add_result_options, save_outputs
from .meshes import load_meshes, mesh_argument
from .options import add_options, chosen_options, given_options
from .reports import add_report_options, run_reported

if TYPE_CHECKING:
    import argparse

    from ...engine import DenseMatch
    from .command import ExitCode
    from .console import Console
    from .reports import Report


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add it."""
    parser = commands.add_parser(
        "symmetry",
        help="find the left-right map of a mesh, and make what it carries symmetric",
        description="Match a mesh with its own mirror image, in any pose, and judge this left-right map.  With --map "
        "it is written; with --output, what the mesh carries is made symmetric and written.",
        usage="%(prog)s MESH [--output FILE] [--map FILE] [options]",
    )
    parser.add_argument("mesh", type=mesh_argument, metavar="MESH", help="FILE or FILE:OBJECT.")
    add_result_options(parser, "the mesh with its armature")
    add_report_options(parser)
    add_options(parser, "symmetrise", title="what is made symmetric")
    parser.set_defaults(run=_run)


def _run(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Find the map, or symmetrise, or both."""

    def work(report: Report) -> None:
        console.progress(0.0, "Reading files")
        (side,), notes = load_meshes([parsed.mesh], whole=False)
        obj, *others = parts_of(side)
        if others:
            raise ObjectError(
                f'"{side.name}" has several meshes, of which one is taken at a time. Name it behind a colon: '
                f"{listed([obj.name, *(other.name for other in others)])}."
            )
        report.add_object("mesh", parsed.mesh, obj)
        report.add_notes(notes)
        context = bpy.context
        check_object(view_layer_of(context), obj)
        job = None
        if parsed.output:
            settings = symmetrise_settings(chosen_options("symmetrise", given_options("symmetrise", parsed)))
            job = SymmetriseJob(context, obj, settings)
        if job is None:
            _tell_map(parsed, report, obj, _found(obj, console))
        else:
            drive(job, console)
            _tell_map(parsed, report, obj, job.found)
            made = job.finish()
            report.carried.append({"target": obj.name, "done": [made.done]})
            report.add_notes(made.notes)
        save_outputs(parsed, report, obj, console, clean=False)

    return run_reported(parsed, [parsed.mesh.path], console, work)


def _tell_map(parsed: argparse.Namespace, report: Report, obj: bpy.types.Object, found: DenseMatch) -> None:
    """Describe the left-right map, and write it if that is wanted."""
    quality = Quality.of(found.quality)
    report.match = {"points": 0, "orientation": quality.orientation, "quality": dict(vars(quality))}
    if parsed.map is not None:
        save_match(_as_file(obj, found, quality), parsed.map.absolute())
        report.written.append(str(parsed.map.absolute()))


def _found(obj: bpy.types.Object, console: Console) -> DenseMatch:
    """Find the left-right map."""
    steps = symmetry_map_steps(read_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=False))
    while True:
        try:
            now = next(steps)
        except StopIteration as stop:
            found: DenseMatch = stop.value
            return found
        console.progress(now.fraction, now.label)


def _as_file(obj: bpy.types.Object, found: DenseMatch, quality: Quality) -> MatchFile:
    """Write a map of a mesh to itself as a match without points."""
    mesh = mesh_of(obj)
    none = CornerPoints(np.empty((0, 3), np.int64), np.empty((0, 3)))
    written = Written(
        use_modifiers=False, vertex_groups=False, match_colors=False, distortion=False, confidence=False, dense=True
    )
    stored = StoredMatch(
        names=(obj.name, obj.name),
        topologies=(topology(mesh), topology(mesh)),
        positions=(position_digest(mesh), position_digest(mesh)),
        written=written,
        source_points=none,
        answers=(
            Answer(
                DIRECT,
                none,
                np.empty(0),
                quality.distortion,
                quality.orientation,
                proven=False,
                gap=1.0,
                quality=quality,
            ),
        ),
        chosen=0,
        notes=(),
    )
    count = len(mesh.vertices)
    maps = StoredMaps.of(found.source_to_target, found.target_to_source)
    return MatchFile(stored, (count, count), maps, kind="symmetry")
