# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of a command, as JSON for other programs; `docs/command-line.md` describes them."""

from __future__ import annotations

import argparse
import json
import math
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

from ...engine import HierMatchError
from ..common.access import mesh_of
from ..common.errors import ObjectError
from ..common.file_writing import check_place, write_whole
from ..scene.character import parts_of
from ..storage.match_file import SUFFIXES
from .command import ExitCode
from .console import Console, interruptible

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..jobs.transfer_job import Carried
    from ..jobs.verdict import Verdict
    from ..scene.character import Side
    from ..storage.stored_match import StoredMatch
    from .meshes import MeshArgument

FORMAT = "hiermatch-report"
"""What every report says it is."""

_VERSION = 1

STATUSES = ("done", "failed", "crashed", "timeout", "interrupted")
"""What can become of a command; a crash and a timeout are told by the batch that started it."""

_LEAST_CONFIDENCE = 0.5


@dataclass
class Report:
    """What is known so far.

    Attributes
    ----------
    command : str
        Which one.
    key : str
        By what a batch recognises it; empty outside of one.
    least_confidence : float
        Below it a match is doubtful.
    inputs : list of dict
        Path, size and time of each file that is read, as it was before.
    objects : dict
        For each role, such as "source", what was loaded.
    match : dict or None
        What was found.
    carried : list of dict
        What was carried over.
    notes : list of str
        What should be known.
    written : list of str
        The files.
    """

    command: str
    key: str = ""
    least_confidence: float = _LEAST_CONFIDENCE
    inputs: list[dict[str, Any]] = field(default_factory=list)
    objects: dict[str, dict[str, Any]] = field(default_factory=dict)
    match: dict[str, Any] | None = None
    carried: list[dict[str, Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    written: list[str] = field(default_factory=list)
    _begin: float = field(default_factory=time.perf_counter)

    @property
    def doubtful(self) -> bool:
        """Whether something was found or carried by a match with dense maps that are not to be trusted."""
        confidence = confidence_of(self.match, self.carried)
        return confidence is not None and confidence < self.least_confidence

    def add_object(self, role: str, argument: MeshArgument, obj: Side) -> None:
        """Say what was loaded."""
        meshes = [mesh_of(part) for part in parts_of(obj) if part.type == "MESH"]
        self.objects[role] = {
            "file": str(argument.path),
            "object": obj.name,
            "vertices": sum(len(mesh.vertices) for mesh in meshes),
            "faces": sum(len(mesh.polygons) for mesh in meshes),
        }

    def add_match(self, stored: StoredMatch) -> None:
        """Say what was found."""
        answer, (quality, notes) = stored.answer, stored.told
        self.match = {
            "points": len(answer.point_distortion),
            "distortion": answer.distortion,
            "worst_distortion": float(answer.point_distortion.max()),
            "orientation": answer.orientation,
            "proven": answer.proven,
            "gap": answer.gap,
            "answer": answer.name,
            "alternatives": [other.name for other in stored.answers[1:]],
            "refined": answer.refined,
            "quality": None if quality is None else dict(vars(quality)),
        }
        self.add_notes(notes)

    def add_carried(self, carried: Sequence[Carried]) -> None:
        """Say what was carried over."""
        for one in carried:
            done = [part.done for part in one.reports if part.done]
            confidence = None if one.verdict is None else one.verdict.confidence
            self.carried.append({"target": one.target, "done": done, "confidence": confidence})
            for part in one.reports:
                self.add_notes((*part.notes, *part.remarks))

    def add_doubts(self, doubts: Sequence[tuple[str, Verdict]]) -> None:
        """Say for which targets nothing was carried over, and how little their matches can be trusted."""
        self.carried += [{"target": name, "done": [], "confidence": one.confidence} for name, one in doubts]

    def add_notes(self, notes: Sequence[str]) -> None:
        """Add what should be known, once."""
        self.notes += [note for note in notes if note not in self.notes]

    def to_plain(self, code: ExitCode, error: str) -> dict[str, Any]:
        """Return all of it, with how it ended."""
        status = {ExitCode.FAILED: "failed", ExitCode.INTERRUPTED: "interrupted"}.get(code, "done")
        return {
            "format": FORMAT,
            "version": _VERSION,
            "command": self.command,
            "key": self.key,
            "status": status,
            "exit_code": int(code),
            "error": error,
            "doubtful": self.doubtful,
            "seconds": round(time.perf_counter() - self._begin, 3),
            "inputs": self.inputs,
            "objects": self.objects,
            "match": self.match,
            "carried": self.carried,
            "notes": self.notes,
            "written": self.written,
            "blender": bpy.app.version_string,
        }


def add_report_options(parser: argparse.ArgumentParser) -> None:
    """Add what all commands that do one thing have in common."""
    group = parser.add_argument_group("what is told")
    group.add_argument("--report", metavar="FILE.json", help='Write what became of it; "-" is the standard output.')
    group.add_argument("--report-key", default="", metavar="TEXT", help="A text that the report repeats.")
    group.add_argument(
        "--strict", action="store_true", help="End with the exit code 3 if the match is doubtful; it is written anyway."
    )
    add_least_confidence(group)
    group.add_argument("--quiet", action="store_true", help="Tell no progress, only errors.")


def add_least_confidence(group: Any) -> None:  # noqa: ANN401 - argparse's groups have no public type
    """Add what a doubtful match is."""
    group.add_argument(
        "--least-confidence",
        type=_share,
        default=_LEAST_CONFIDENCE,
        metavar="X",
        help="Below it, 0 to 1, or 0%% to 100%%, a dense match is called doubtful. (default: %(default)s)",
    )


def _share(text: str) -> float:
    try:
        number = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    except ValueError:
        number = math.nan
    if not 0 <= number <= 1:
        raise argparse.ArgumentTypeError(f'"{text}" is not from 0 to 1; for one half, write 0.5 or 50%')
    return number


def confidence_of(match: dict[str, Any] | None, carried: Sequence[dict[str, Any]]) -> float | None:
    """Return the least confidence that a report knows of, from its match and what was carried; None if it has none."""
    known = [(match or {}).get("quality") or {}, *carried]
    return min((one["confidence"] for one in known if one.get("confidence") is not None), default=None)


def as_json(plain: dict[str, Any]) -> bytes:
    """Return the content of a file; of names of files that are no UTF-8 what is none stays escaped."""
    return (json.dumps(plain, indent=1, ensure_ascii=False) + "\n").encode(errors="backslashreplace")


def file_state(path: Path) -> dict[str, Any]:
    """Return by what a file is recognised as unchanged; size and time are None if there is none."""
    try:
        found = path.stat()
    except OSError:
        return {"path": str(path), "size": None, "mtime_ns": None}
    return {"path": str(path), "size": found.st_size, "mtime_ns": found.st_mtime_ns}


def run_reported(
    parsed: argparse.Namespace, inputs: Sequence[Path], console: Console, work: Callable[[Report], None]
) -> ExitCode:
    """Do the work of a command, and tell what became of it in every case.

    Parameters
    ----------
    parsed : argparse.Namespace
        The command's arguments.
    inputs : sequence of Path
        The files that are read, meshes in the order of the command; all others that the arguments name are written,
        which is made sure of first.
    console : Console
        Where to write.
    work : callable
        Does it, and fills the report.

    Raises
    ------
    ObjectError
        If the report would be written over a file that is read, or into one with a result.
    """
    reported = [] if parsed.report in {None, "-"} else [Path(parsed.report)]
    outputs, others = _outputs(parsed, inputs)
    _check_kept([], reported, inputs)
    for path in (*outputs, *others):
        _check_distinct([path, *reported])
    report = Report(parsed.command, parsed.report_key, parsed.least_confidence)
    report.inputs = [file_state(path.absolute()) for path in dict.fromkeys(inputs)]
    code, error = ExitCode.DONE, ""
    try:
        with interruptible() as interruption:
            _check_distinct([*outputs, *others])
            _check_kept(outputs, others, inputs)
            for path in (*outputs, *others, *reported):
                check_place(path)
            work(report)
        if parsed.strict and report.doubtful:
            code = ExitCode.DOUBTFUL
    except (HierMatchError, KeyboardInterrupt) as failure:
        code, error = ExitCode.FAILED, str(failure)
        if isinstance(failure, KeyboardInterrupt) or interruption.happened:
            code, error = ExitCode.INTERRUPTED, "Interrupted. What was not finished was not written."
    except Exception as failure:
        _write(parsed.report, report.to_plain(ExitCode.FAILED, f"Unexpected error: {failure!r}"), console)
        raise
    for note in report.notes:
        console.say(note)
    if error:
        console.error(error)
    else:
        console.say(_told(report))
    try:
        _write(parsed.report, report.to_plain(code, error), console)
    except HierMatchError as failure:
        console.error(str(failure))
        return ExitCode.FAILED
    return code


def _check_kept(outputs: Sequence[Path], others: Sequence[Path], inputs: Sequence[Path]) -> None:
    """Make sure that no file is written over that is read, unless what was read gets there again.

    So it does in the .blend that is opened as a whole, and of the target in its own file, by the outputs, not by
    the `others`.

    Raises
    ------
    ObjectError
        If one would be.
    """
    opened = next((read for read in inputs if read.suffix.lower() == ".blend"), None)
    meshes = [read for read in inputs if read.suffix.lower() not in SUFFIXES]
    for number, path in enumerate((*outputs, *others)):
        over = [read for read in inputs if _is_same(path, read)]
        again = opened in over or (over == meshes[-1:] and path.suffix.lower() != ".blend")
        if over and not (again and number < len(outputs)):
            raise ObjectError(f'"{path}" is read as well, and would be lost. Write to another file.')


def _check_distinct(paths: Sequence[Path]) -> None:
    """Make sure that no two results go into one file, of which the last alone would be left.

    Raises
    ------
    ObjectError
        If two would.
    """
    for number, path in enumerate(paths):
        if any(_is_same(path, other) for other in paths[:number]):
            raise ObjectError(f'"{path}" is to be written twice. Give each result a file of its own.')


def _is_same(path: Path, other: Path) -> bool:
    """Tell whether two paths lead to one file."""
    try:
        return path.samefile(other)
    except OSError:
        return path.resolve() == other.resolve()


def _outputs(parsed: argparse.Namespace, inputs: Sequence[Path]) -> tuple[list[Path], list[Path]]:
    """Return the files that a command is to write, beside the report: results, and others; it may read some of them."""
    named = [getattr(parsed, name, None) for name in ("map", "write_pairs")]
    others = [path for path in named if path is not None and not any(path is read for read in inputs)]
    return list(getattr(parsed, "output", ())), others


def _write(where: str | None, plain: dict[str, Any], console: Console) -> None:
    """Write a report, if one is wanted."""
    if where is None:
        return
    if where == "-":
        console.result(as_json(plain).decode())
    else:
        write_whole(Path(where).absolute(), as_json(plain))


def _told(report: Report) -> str:
    """Return what became of it in a line for a person."""
    parts = []
    if report.match is not None:
        if report.match["points"]:
            parts.append(f"matched {report.match['points']} points")
        if report.match["quality"] is not None:
            parts.append(f"confidence {report.match['quality']['confidence']:.0%}")
            parts.append(report.match["quality"]["sentence"].rstrip("."))
    parts += [f"carried {', '.join(one['done']) or 'nothing'}" for one in report.carried]
    parts += [f"wrote {path}" for path in report.written]
    return f"Done: {'; '.join(parts)}." if parts else "Done."
