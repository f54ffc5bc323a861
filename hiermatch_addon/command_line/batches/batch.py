# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand that works through a list of pairs, each in a process of its own."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...common.file_writing import check_place
from ..command import ExitCode, UsageError
from ..console import Console, interruptible
from ..options import add_options, given_options, option_names, quoted_names
from ..reports import add_least_confidence
from .ledger import Ledger, counts, summary_rows
from .manifest import COMMANDS, read_manifest, take_shard
from .workers import Ended, Task, run_tasks

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .manifest import Pair

_DESCRIPTION = """\
Work through the pairs of a manifest: a table (.csv) or .json with source, target, output, and any option of the
subcommand as further columns; paths are relative to the manifest.  Each pair runs in a Blender of its own.  What is
done stays done: the same command again goes on where it was interrupted.
"""


def add_commands(commands: Any) -> None:  # noqa: ANN401 - argparse's action of subparsers has no public type
    """Add it."""
    parser = commands.add_parser(
        "batch",
        help="work through a list of pairs",
        description=_DESCRIPTION,
        usage="%(prog)s MANIFEST [--jobs N] [--shard I/N] [options]",
    )
    parser.add_argument("manifest", type=Path, metavar="MANIFEST", help="The .csv or .json file.")
    group = parser.add_argument_group("how it is done")
    group.add_argument(
        "--do",
        choices=tuple(COMMANDS),
        default="match",
        help="What is done with pairs that have no command of their own. (default: %(default)s)",
    )
    group.add_argument("--jobs", type=_count, default=1, metavar="N", help="How many pairs at a time. (default: 1)")
    group.add_argument(
        "--timeout", type=_seconds, metavar="SECONDS", help="How long a pair may take before it is given up."
    )
    group.add_argument(
        "--shard",
        type=_shard,
        default=(1, 1),
        metavar="I/N",
        help="Take every N-th pair only, from the I-th on: for N machines that share the folder.",
    )
    group.add_argument("--retry-failed", action="store_true", help="Try the pairs again that have failed before.")
    group.add_argument(
        "--work", type=Path, metavar="FOLDER", help="Where reports are kept. (default: MANIFEST with .hiermatch behind)"
    )
    group.add_argument(
        "--summary", action="store_true", help="Do nothing but write the summary of all shards, as far as they are."
    )
    group.add_argument(
        "--strict", action="store_true", help="End with the exit code 3 if all is done and a match is doubtful."
    )
    add_least_confidence(group)
    group.add_argument("--quiet", action="store_true", help="Tell no progress, only errors.")
    known: set[str] = set()
    for command, (operator, *_) in COMMANDS.items():
        title = f"options of {command}, for all pairs unless their row says otherwise"
        add_options(parser, operator, without=known, title=title)
        known.update(option_names(operator))
    parser.set_defaults(run=_run)


def _run(parsed: argparse.Namespace, console: Console) -> ExitCode:
    """Run what is not done yet, and write the summary."""
    given = [item for operator, *_ in COMMANDS.values() for item in given_options(operator, parsed).items()]
    defaults = {name: quoted_names(value) if isinstance(value, tuple) else str(value) for name, value in given}
    pairs = read_manifest(parsed.manifest, defaults, parsed.do)
    folder = parsed.work or parsed.manifest.with_name(f"{parsed.manifest.name}.hiermatch")
    ledger, shard = Ledger(folder.absolute()), parsed.shard
    check_place(ledger.folder / "summary.csv")
    interrupted = False
    if not parsed.summary:
        pairs = take_shard(pairs, shard)
        try:
            with interruptible():
                _work_through(pairs, ledger, parsed, console)
        except KeyboardInterrupt:
            interrupted = True
            console.error("Interrupted. What is done stays done; the same command goes on from here.")
    # The options of the shards need not be given again.
    rows = summary_rows(ledger, pairs, parsed.least_confidence, any_options=parsed.summary)
    whole = parsed.summary or shard == (1, 1)
    path = ledger.write_summary(rows, "summary" if whole else f"summary-{shard[0]}-of-{shard[1]}")
    found = counts(rows)
    told = ", ".join(f"{number} {status}" for status, number in found.items() if number)
    console.say(f"{len(rows)} {'pair' if len(rows) == 1 else 'pairs'}: {told}. See {path}")
    if interrupted:
        return ExitCode.INTERRUPTED
    if found["failed"] or found["crashed"] or found["timeout"] or (found["pending"] and not parsed.summary):
        return ExitCode.PAIRS_FAILED
    return ExitCode.DOUBTFUL if parsed.strict and found["doubtful"] else ExitCode.DONE


def _work_through(pairs: Sequence[Pair], ledger: Ledger, parsed: argparse.Namespace, console: Console) -> None:
    """Run all pairs that have no report yet, or one that is not to count."""
    tasks = _tasks(pairs, ledger, parsed, console)
    before, ended = len(pairs) - len(tasks), 0
    events = run_tasks([task for task, _ in tasks.values()], parsed.jobs, parsed.timeout)
    try:
        for event in events:
            if isinstance(event, Ended):
                ended += 1
                _, pair = tasks[event.task.name]
                if event.lacking:
                    _leave(pair, tasks[event.lacking][1], ledger, console)
                else:
                    _close(pair, event, ledger, console)
            elif console.is_terminal:  # elsewhere the lines about what has ended are enough
                names = ", ".join(tasks[name][1].name for name in event)
                console.progress((before + ended) / len(pairs), f"{before + ended} of {len(pairs)}, at {names}")
    finally:
        events.close()  # type: ignore[attr-defined]  # a generator; ends the children


def _tasks(
    pairs: Sequence[Pair], ledger: Ledger, parsed: argparse.Namespace, console: Console
) -> dict[str, tuple[Task, Pair]]:
    """Make the tasks of all pairs that are to be run: by name the task and the pair.

    One that reads what another is to write is run after that one, even if it was done before, and not at all if that
    one has failed.
    """
    tasks: dict[str, tuple[Task, Pair]] = {}
    writers: dict[str, str] = {}
    failed: dict[str, Pair] = {}
    known = 0
    for pair in pairs:
        after = frozenset(writers[path] for path in pair.read if path in writers)
        report = None if after else ledger.report_of(pair)
        if report is not None and (report["status"] == "done" or not (parsed.retry_failed or "lacking" in report)):
            known += 1
            failed |= dict.fromkeys(pair.written if report["status"] != "done" else (), pair)
            continue
        if other := next((failed[path] for path in pair.read if path in failed), None):
            _leave(pair, other, ledger, console)
            failed |= dict.fromkeys(pair.written, pair)
            continue
        try:
            arguments = _checked_arguments(pair, parsed.check)
        except UsageError as error:
            ledger.fail(pair, None, f"{error}.")
            console.error(f"{pair.name}: {error}.")
            failed |= dict.fromkeys(pair.written, pair)
            continue
        told = [f"--report={ledger.report_path(pair)}", f"--report-key={pair.key}"]
        told.append(f"--least-confidence={parsed.least_confidence}")
        if pair.command != "match" and "accept_doubtful" not in dict(pair.options):
            told.append("--accept-doubtful")  # one bad pair of many is looked at later: the summary names it
        ledger.forget(pair)  # else that of a former run would stand for a crashed one
        tasks[pair.stem] = Task(pair.stem, [*arguments, *told], ledger.log_path(pair), after), pair
        writers |= dict.fromkeys(pair.written, pair.stem)
    if known:
        console.say(f"{known} of {len(pairs)} pairs are known already.")
    return tasks


def _leave(pair: Pair, other: Pair, ledger: Ledger, console: Console) -> None:
    """Say that a pair was not begun, because another one, whose file it reads, came to nothing."""
    if ledger.report_of(other) is None:
        return  # that one is still to be done, and so is this one
    error = f'It was not begun: it reads what "{other.name}" writes, and that failed.'
    ledger.fail(pair, None, error, lacking=other.name)
    console.error(f"{pair.name}: failed. {error}")


def _checked_arguments(pair: Pair, check: Callable[[list[str]], object]) -> list[str]:
    """Return the arguments of a child, of which it is sure that they are some."""
    arguments = pair.arguments()
    if pair.command != "match" and not pair.written:  # what is left of a match is its report
        raise UsageError("output is empty, so nothing would be left of the work. Name the file to write")
    check(arguments)
    if set(pair.written) & set(pair.read):
        raise UsageError("it would write over its own source or target")  # and never be known as done
    return arguments


def _close(pair: Pair, ended: Ended, ledger: Ledger, console: Console) -> None:
    """Make sure that there is a report of a child that has ended, and tell what became of it."""
    report = ledger.report_of(pair)
    log = ledger.log_path(pair)
    if report is None and not ended.timeout and ended.code == ExitCode.INTERRUPTED:
        return  # somebody else has ended it: it is still to be done
    if report is None:
        if ended.timeout:
            error = f"It was ended after {ended.seconds:.0f} s, because its time was over."
        elif ended.code < 0:
            error = f"Its Blender was ended by the signal {-ended.code}; out of memory, perhaps. See {log}."
        else:
            error = f"Its Blender has ended with the exit code {ended.code} and left no report. See {log}."
        ledger.fail(pair, ended, error)
        report = ledger.report_of(pair)
    status, error = (report["status"], report["error"]) if report else ("pending", "Its files were changed meanwhile.")
    if status == "done":
        doubt = ", doubtful" if report and report["doubtful"] else ""
        console.say(f"{pair.name}: done in {ended.seconds:.1f} s{doubt}")
    else:
        console.error(f"{pair.name}: {status}. {error}")


def _count(text: str) -> int:
    if not (text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f'"{text}" is no positive whole number')
    return int(text)


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not seconds > 0:
        raise argparse.ArgumentTypeError(f'"{text}" is no positive number of seconds')
    return seconds


def _shard(text: str) -> tuple[int, int]:
    first, slash, count = text.partition("/")
    if not (slash and first.isdecimal() and count.isdecimal() and 1 <= int(first) <= int(count)):
        raise argparse.ArgumentTypeError(f'"{text}" is not such as 3/20')
    return int(first), int(count)
