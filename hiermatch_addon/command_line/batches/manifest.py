# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of pairs of a batch, from a CSV or JSON file."""

from __future__ import annotations

import argparse
import codecs
import csv
import hashlib
import io
import json
import os
from dataclasses import dataclass
from os.path import normcase, normpath, realpath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...common.errors import ObjectError
from ...common.file_reading import parsed_json
from ..command import UsageError
from ..meshes import mesh_argument
from ..options import option_names, quoted_names, to_arguments
from ..retarget import NOT_OF_THE_MATCH

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

COMMANDS = {
    "match": ("match",),
    "retarget": ("retarget", "match"),
    "motion": ("retarget_action", "match"),
    "my-rig": ("fit_my_rig", "match"),
    "wear": ("wear", "match"),
}
"""For each subcommand that a batch can run, the operators whose options it takes; the first of a name counts."""

_FIXED = ("name", "command", "source", "target", "output", "map")
"""Columns that are no options."""

_OF_BONES = ("pairs", "write_pairs")
"""Options of `motion` that are no columns."""

_LISTED = {"items": quoted_names, "output": "|".join}
"""Columns with several names or files: how a list of them in a .json is written in a table."""


@dataclass(frozen=True)
class Pair:
    """A row of the manifest.

    Attributes
    ----------
    number : int
        Which row, from 1.
    name : str
        What the pair is called, in messages and in the name of its report.
    command : str
        The subcommand.
    source, target : str
        FILE or FILE:NAME, the file as an absolute path.
    outputs : tuple of str
        The files to write, absolute.
    map : str
        Where to write the correspondence, absolute; empty if nowhere.
    options : tuple
        Name and value of each option that is given, sorted.
    folder : str
        The manifest's folder, absolute.
    """

    number: int
    name: str
    command: str
    source: str
    target: str
    outputs: tuple[str, ...]
    map: str
    options: tuple[tuple[str, str], ...]
    folder: str

    @property
    def inputs(self) -> list[Path]:
        """The files of source and target, each once.

        Raises
        ------
        argparse.ArgumentTypeError
            If one is no file of a known kind.
        """
        return list(dict.fromkeys(mesh_argument(text).path for text in (self.source, self.target)))

    @property
    def written(self) -> tuple[str, ...]:
        """All files that it writes, each by the one path that all ways to it have in common."""
        return tuple(map(_plain_path, (*self.outputs, *([self.map] if self.map else []))))

    @property
    def read(self) -> tuple[str, ...]:
        """All files that it reads, as far as they are of a known kind, as in `written`."""
        return tuple(filter(None, (_path_in(text) for text in (self.source, self.target))))

    @property
    def key(self) -> str:
        """A text that is the same as long as the same is to be done with the same files."""
        return self._key(self._below)

    @property
    def stem(self) -> str:
        """What the files about the pair are called: after it, and so that no two are called alike."""
        return self._stem(self._below)

    @property
    def former(self) -> tuple[str, str]:
        """The stem and the key that it had when all paths counted as absolute: reports of then still count."""
        return self._stem(str), self._key(str)

    def _stem(self, shown: Callable[[str], str]) -> str:
        readable = "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in self.name)
        return f"{readable[:60]}-{_digest(self._work(shown), 4)}"

    def _key(self, shown: Callable[[str], str]) -> str:
        return _digest([*self._work(shown), self.options], 16)

    def _work(self, shown: Callable[[str], str]) -> list[Any]:
        """Return what is to be done with which files, these as they are to be shown."""
        outputs = tuple(map(shown, self.outputs))
        return [self.command, shown(self.source), shown(self.target), outputs, shown(self.map)]

    def _below(self, path: str) -> str:
        """Return a path below the manifest's folder as seen from there: other machines may have it elsewhere."""
        for folder in (self.folder, normpath(self.folder)):
            if path.startswith(folder + os.sep):
                return path[len(folder) + 1 :].replace(os.sep, "/")
        return path

    def arguments(self) -> list[str]:
        """Return the subcommand with its arguments.

        Raises
        ------
        UsageError
            If an option is not one of the subcommand's, or its value cannot be one.
        """
        if self.command not in COMMANDS:
            raise UsageError(f'command is "{self.command}", but must be one of {", ".join(COMMANDS)}')
        if not (self.source and self.target):
            raise UsageError("source or target is empty")
        arguments = [self.command, self.source, self.target]
        arguments += [f"--output={path}" for path in self.outputs]
        arguments += [f"--map={self.map}"] if self.map else []
        for name, value in self.options:
            operator = _operator_of(self.command, name)
            if operator is None:
                raise UsageError(f"{name} is no option of {self.command}")
            arguments += to_arguments(operator, name, value)
        return arguments


def read_manifest(path: Path, defaults: Mapping[str, str], command: str) -> list[Pair]:
    """Read all pairs.

    Parameters
    ----------
    path : Path
        A .json file, or else a table with a line of names and commas, semicolons or tabs between the columns.
    defaults : dict
        Options of the pairs that do not say otherwise; those that a pair's subcommand does not have are left out.
    command : str
        The subcommand of the pairs that do not name one.

    Raises
    ------
    ObjectError
        If it cannot be read, has unknown columns, two pairs write the same file, or one what another before it reads.
    """
    try:
        text = _decoded(path.read_bytes())
        rows, common = _json_rows(text) if path.suffix.lower() == ".json" else (_table_rows(text), {})
    except OSError as error:
        raise ObjectError(f'"{path}" cannot be read: {error.strerror or error}.') from error
    except (ValueError, csv.Error) as error:
        raise ObjectError(f'"{path}" is no manifest: {error}. See the manual page for its format.') from error
    known = {*_FIXED, *(name for operators in COMMANDS.values() for one in operators for name in option_names(one))}
    unknown = sorted({name for row in (*rows, common) for name in row} - known)
    if of_bones := [name for name in unknown if name in _OF_BONES]:
        raise ObjectError(
            f"A batch pairs the bones of each row by itself: remove the column {', '.join(of_bones)} from "
            f'"{path.name}", and run rows that need a file of pairs one by one, by "motion".'
        )
    if unknown:
        raise ObjectError(
            f'"{path.name}" has columns that are no options: {", ".join(unknown)}. Rename or remove them.'
        )
    if of_pairs := [name for name in _FIXED if name in common]:
        raise ObjectError(
            f'"{path.name}" has {", ".join(of_pairs)} among the options for all pairs. Write that into each pair.'
        )
    if not rows:
        raise ObjectError(f'"{path.name}" lists no pairs.')
    folder, defaults = path.absolute().parent, {**common, **defaults}
    pairs = [_pair(number, row, defaults, command, folder) for number, row in enumerate(rows, start=1)]
    _check_outputs(pairs)
    return pairs


def take_shard(pairs: Sequence[Pair], shard: tuple[int, int]) -> list[Pair]:
    """Return every n-th pair, from the i-th on; all shards together are all pairs, each once.

    Raises
    ------
    ObjectError
        If a pair of any shard reads what one of another writes: shards do not wait for each other.
    """
    first, step = shard
    writers = {path: pair.number for pair in pairs for path in pair.written}
    for pair in pairs:
        for path in pair.read:
            if path in writers and (pair.number - writers[path]) % step:
                raise ObjectError(
                    f'Row {pair.number} of the manifest reads "{path}", which row {writers[path]} writes, and shards '
                    "do not wait for each other. Put such rows into a manifest of their own, and run it without shards."
                )
    return list(pairs[first - 1 :: step])


def _decoded(content: bytes) -> str:
    """Return the text of a file as editors and spreadsheets write it, with any kind of line ends."""
    wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        text = content.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError('it is not in UTF-8; save it again, in a spreadsheet as "CSV UTF-8"') from error
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _table_rows(text: str) -> list[dict[str, str]]:
    head = next((line for line in text.split("\n") if line.strip()), "")
    reader = csv.reader(io.StringIO(text), delimiter=max(",;\t", key=head.count), strict=True)
    filled = ([cell.strip() for cell in cells] for cells in reader if any(cell.strip() for cell in cells))
    names = [name.replace("-", "_") for name in next(filled, [])]
    rows = []
    for cells in filled:
        if len(cells) != len(names):
            raise ValueError(f"line {reader.line_num} has another number of columns than the first one")
        if any(cell and not name for name, cell in zip(names, cells, strict=True)):
            raise ValueError(f"line {reader.line_num} has something in a column that has no name")
        rows.append({name: cell for name, cell in zip(names, cells, strict=True) if name})
    for name in ("source", "target"):
        if names and name not in names:
            raise ValueError(
                f'it has no column "{name}". Its first line has to name them, such as source,target,output'
            )
    for name in filter(None, names):
        if names.count(name) > 1:
            raise ValueError(f'it has several columns "{name}"')
    return rows


def _json_rows(text: str) -> tuple[list[dict[str, str]], dict[str, str]]:
    """Return the pairs, and the options of all of them."""
    plain = parsed_json(text)
    if isinstance(plain, dict) and (unknown := sorted(set(plain) - {"options", "pairs"})):
        raise ValueError(f'it has {", ".join(unknown)} beside "options" and "pairs"')
    pairs = plain.get("pairs") if isinstance(plain, dict) else plain
    common = plain.get("options", {}) if isinstance(plain, dict) else {}
    if not isinstance(pairs, list) or not all(isinstance(pair, dict) for pair in [*pairs, common]):
        raise ValueError('it must be a list of objects, or an object with such a list called "pairs"')
    rows = [
        {name.replace("-", "_"): _text(name, value) for name, value in row.items() if value is not None}
        for row in (*pairs, common)
    ]
    return rows[:-1], rows[-1]


def _text(name: str, value: Any) -> str:  # noqa: ANN401 - whatever JSON holds
    if name in _LISTED and isinstance(value, list) and all(isinstance(one, str) for one in value):
        return _LISTED[name](value)
    if isinstance(value, dict | list):
        raise ValueError(f"{value} is neither a text nor a number")  # noqa: TRY004 - told like all that is wrong in a file
    return str(value).strip()


def _pair(number: int, row: Mapping[str, str], defaults: Mapping[str, str], command: str, folder: Path) -> Pair:
    """Make a pair of a row, with the paths relative to a folder."""
    command = row.get("command") or command
    outputs = tuple(normpath(folder / part.strip()) for part in row.get("output", "").split("|") if part.strip())
    options = {name: value for name, value in defaults.items() if _operator_of(command, name) is not None}
    options |= {name: value for name, value in row.items() if name not in _FIXED and value}
    source, target = (str(folder / row[name]) if row.get(name) else "" for name in ("source", "target"))
    written = normpath(folder / row["map"]) if row.get("map") else ""
    named = outputs[0] if outputs else written
    name = Path(named).stem if named else f"{Path(source).stem}-{Path(target).stem}"
    return Pair(
        number=number,
        name=row.get("name") or name,
        command=command,
        source=source,
        target=target,
        outputs=outputs,
        map=written,
        options=tuple(sorted(options.items())),
        folder=str(folder),
    )


def _digest(plain: list[Any], size: int) -> str:
    return hashlib.blake2b(json.dumps(plain).encode(), digest_size=size).hexdigest()


def _operator_of(command: str, name: str) -> str | None:
    """Return the operator that an option of a subcommand belongs to; None if it has no such option."""
    for number, operator in enumerate(COMMANDS.get(command, ())):
        own = number == 0
        if name in option_names(operator) and (own or name not in NOT_OF_THE_MATCH):
            return operator
    return None


def _check_outputs(pairs: Sequence[Pair]) -> None:
    """Make sure that no two pairs write the same, nor over what one has read, and that each has its own report.

    A pair may read what one before it writes.
    """
    writers: dict[str, int] = {}
    readers: dict[str, int] = {}
    for pair in pairs:
        for written in set(pair.written) - set(pair.read):  # one that writes over its own fails alone
            if written in readers:
                raise ObjectError(
                    f'Row {pair.number} of the manifest writes over "{written}", which row {readers[written]} reads. '
                    "Give it another output."
                )
        readers |= dict.fromkeys(pair.read, pair.number)
        for written in (*pair.written, pair.stem):
            if written in writers:
                same = pair.name if written == pair.stem else written
                raise ObjectError(
                    f"Rows {writers[written]} and {pair.number} of the manifest write the same, "
                    f'"{same}". Give each pair an output of its own, or a name if it has none.'
                )
            writers[written] = pair.number


def _plain_path(path: str | Path) -> str:
    """Return what all ways to write a path come to, through links, or in small letters where these do not matter."""
    return normcase(realpath(path))


def _path_in(text: str) -> str:
    """Return the path of FILE or FILE:NAME; empty if it is no file of a known kind, which its own row will tell."""
    try:
        return _plain_path(mesh_argument(text).path)
    except argparse.ArgumentTypeError:
        return ""
