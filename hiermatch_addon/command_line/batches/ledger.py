# SPDX-License-Identifier: GPL-3.0-or-later
"""The ledger of a batch: one report for each pair, in one folder, that outlives every interruption."""

from __future__ import annotations

import argparse
import csv
import io
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ...common.file_reading import BAD_FILE
from ...common.file_writing import write_whole
from ..reports import FORMAT, STATUSES, as_json, confidence_of, file_state

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .manifest import Pair
    from .workers import Ended

_COLUMNS = (
    "row",
    "name",
    "command",
    "source",
    "target",
    "output",
    "status",
    "doubtful",
    "seconds",
    "confidence",
    "distortion",
    "sentence",
    "alternatives",
    "error",
    "report",
)
"""Of the summary."""

_PENDING: Final = {"status": "pending", "doubtful": False, "seconds": None, "error": ""}
"""Stands for the report of a pair that has none."""


class Ledger:
    """The folder with the reports.

    Parameters
    ----------
    folder : Path
        Where they are.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def report_path(self, pair: Pair) -> Path:
        """Return where the report of a pair is to be."""
        return self.folder / f"{pair.stem}.json"

    def found_path(self, pair: Pair) -> Path:
        """Return where the report of a pair is, if there is one: maybe where it was to be formerly."""
        path, former = self.report_path(pair), self._former_path(pair)
        return former if former.is_file() and not path.is_file() else path

    def _former_path(self, pair: Pair) -> Path:
        return self.folder / f"{pair.former[0]}.json"

    def forget(self, pair: Pair) -> None:
        """Remove the report of a pair."""
        for path in (self.report_path(pair), self._former_path(pair)):
            path.unlink(missing_ok=True)

    def log_path(self, pair: Pair) -> Path:
        """Return where all that is kept that Blender printed about a pair."""
        return self.folder / f"{pair.stem}.log"

    def report_of(self, pair: Pair, *, any_options: bool = False) -> dict[str, Any] | None:
        """Return the report of a pair; None if there is none, or the pair or its files are others since.

        With `any_options` the pair may have been done with other options.  A damaged report counts as none.
        """
        try:
            report = json.loads(self.found_path(pair).read_text(encoding="utf-8"))
            _told(report)
            return self._if_current(report, pair, any_options=any_options)
        except (OSError, *BAD_FILE):
            return None

    def _if_current(self, report: dict[str, Any], pair: Pair, *, any_options: bool) -> dict[str, Any] | None:
        if report.get("format") != FORMAT:
            return None
        if report.get("key") not in (pair.key, pair.former[1]) and not any_options:
            return None
        if report.get("status") not in STATUSES or report["status"] == "interrupted":
            return None
        inputs = report.get("inputs", [])
        if inputs and list(map(_unplaced, inputs)) != _inputs(pair):
            return None
        written = [*pair.outputs, *filter(None, [pair.map])] if report["status"] == "done" else []
        return report if all(Path(path).is_file() for path in written) else None

    def fail(self, pair: Pair, ended: Ended | None, error: str, *, lacking: str = "") -> None:
        """Write the report that a child did not write itself, also of one that was not begun for lack of another."""
        status = "failed" if ended is None else "timeout" if ended.timeout else "crashed"
        report = {
            "format": FORMAT,
            "version": 1,
            "command": pair.command,
            "key": pair.key,
            "status": status,
            "exit_code": None if ended is None else ended.code,
            "error": error,
            "doubtful": False,
            "seconds": 0.0 if ended is None else round(ended.seconds, 3),
            "inputs": [] if ended is None else [file_state(path) for path in pair.inputs],
            "objects": {},
            "match": None,
            "carried": [],
            "notes": [],
            "written": [],
        } | ({"lacking": lacking} if lacking else {})
        write_whole(self.report_path(pair), as_json(report))

    def write_summary(self, rows: Sequence[dict[str, Any]], name: str) -> Path:
        """Write a summary as CSV and as JSON, and return where the first is."""
        text = io.StringIO()
        table = csv.DictWriter(text, _COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows({column: "" if row[column] is None else row[column] for column in _COLUMNS} for row in rows)
        path = self.folder / f"{name}.csv"
        write_whole(path, text.getvalue().encode(errors="backslashreplace"))
        plain = {"format": "hiermatch-summary", "version": 1, "counts": counts(rows), "pairs": list(rows)}
        write_whole(path.with_suffix(".json"), as_json(plain))
        return path


def _inputs(pair: Pair) -> list[dict[str, Any]]:
    """Return by what the files of source and target are recognised as unchanged, wherever they are."""
    try:
        return [_unplaced(file_state(path)) for path in pair.inputs]
    except argparse.ArgumentTypeError:
        return []


def _unplaced(state: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in state.items() if name != "path"}


def summary_rows(
    ledger: Ledger, pairs: Sequence[Pair], least_confidence: float, *, any_options: bool = False
) -> list[dict[str, Any]]:
    """Return a line for each pair; those without a report are "pending".  See `Ledger.report_of`.

    Those below the least confidence are doubtful, whichever it was when they were done.
    """
    rows = []
    for pair in pairs:
        told = _told(ledger.report_of(pair, any_options=any_options) or _PENDING)
        confidence = told["confidence"]
        rows.append(
            {
                "row": pair.number,
                "name": pair.name,
                "command": pair.command,
                "source": pair.source,
                "target": pair.target,
                "output": "|".join(pair.outputs),
                **told,
                "doubtful": confidence is not None and confidence < least_confidence,
                "report": str(ledger.found_path(pair)),
            }
        )
    return rows


def _told(report: dict[str, Any]) -> dict[str, Any]:
    """Return what a summary tells of a report; of a damaged one that raises one of `BAD_FILE`."""
    match = report.get("match") or {}
    quality = match.get("quality") or {}
    confidence = confidence_of(match, report.get("carried", ()))
    return {
        "status": report["status"],
        "doubtful": bool(report["doubtful"]),
        "seconds": report["seconds"],
        "confidence": None if confidence is None else float(confidence),
        "distortion": match.get("distortion"),
        "sentence": quality.get("sentence", ""),
        "alternatives": len(match["alternatives"]) if "alternatives" in match else None,
        "error": report["error"],
    }


def counts(rows: Sequence[dict[str, Any]]) -> dict[str, int]:
    """Count the pairs by what became of them."""
    found = dict.fromkeys(("done", "failed", "crashed", "timeout", "pending", "doubtful"), 0)
    for row in rows:
        found[row["status"]] += 1
        found["doubtful"] += bool(row["doubtful"])
    return found
