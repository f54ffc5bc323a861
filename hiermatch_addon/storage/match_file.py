# SPDX-License-Identifier: GPL-3.0-or-later
"""A correspondence as a file of its own, NPZ or JSON: plain numbers and texts, nothing that could be executed.

Both kinds hold the same: a header and arrays with names.  In an NPZ the header is JSON text in the array ``header``;
in a JSON file it is the object ``header`` beside the object ``arrays``, whose arrays are lists.  What each name means
is written in `docs/command-line.md`.
"""

from __future__ import annotations

import io
import json
from dataclasses import dataclass, replace
from itertools import chain, repeat, zip_longest
from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine import DIRECT, MIRRORED, HierMatchError
from ..common.errors import ObjectError
from ..common.file_reading import BAD_FILE, parsed_json
from ..common.file_writing import write_whole
from ..common.long_names import LONGEST_KEY
from .checked_arrays import MAPS, CheckedArrays
from .stored_match import Answer, CornerPoints, Quality, StoredMatch, Written

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from .vertex_maps import StoredMaps

    _Read = tuple[Any, Mapping[str, NDArray[Any]], int]  # header, arrays, and bytes of the largest that is not yet read

FORMAT = "hiermatch-match"
"""What the header of every such file says it is."""

VERSION = 1
"""Of the format; files of a later one are refused."""

SUFFIXES = (".npz", ".json")
"""How the names of such files end."""

_LARGEST_HEADER = 1 << 24
"""Bytes that a header may have, 16 MB: that of a match has some thousand, and notes may be long."""

_LARGEST = 1 << 31
"""Blender keeps no whole number as large as that; no number of a match, of whatever kind, comes near it."""

_PLACE = 24
"""Bytes in the largest array of a file for each vertex: three numbers of double precision."""


@dataclass(frozen=True, eq=False)
class MatchFile:
    """What such a file holds.

    Attributes
    ----------
    stored : StoredMatch
        The match as the meshes keep it.  Topologies may be empty, if the file was made by something that does not
        know them.
    counts : tuple of int
        How many vertices source and target have.
    maps : StoredMaps or None
        The dense maps of the answer that is written, if it has any.
    others : tuple of StoredMaps or None
        Those of the other answers, in their order, as far as they were made.
    kind : str
        "match", or "symmetry" for a mesh that was matched with itself; such a file has no points.
    """

    stored: StoredMatch
    counts: tuple[int, int]
    maps: StoredMaps | None
    others: tuple[StoredMaps | None, ...] = ()
    kind: str = "match"


def save_match(match: MatchFile, path: Path) -> None:
    """Write a match into a file, of which there is never only a part.

    Raises
    ------
    ObjectError
        If its name ends with neither .npz nor .json, or the file cannot be written.
    """
    if _kind_of(path) == ".json":
        lists = {name: array.tolist() for name, array in _arrays(match).items()}
        content = json.dumps({"header": _header(match), "arrays": lists}, allow_nan=False).encode()
    else:
        content = packed_match(match)
    write_whole(path, content)


def packed_match(match: MatchFile) -> bytes:
    """Return what an NPZ file of a match holds."""
    buffer = io.BytesIO()
    text = np.frombuffer(json.dumps(_header(match), allow_nan=False).encode(), np.uint8)
    named: dict[str, Any] = {"header": text, **_arrays(match)}
    np.savez_compressed(buffer, **named)
    return buffer.getvalue()


def unpacked_match(content: bytes) -> MatchFile:
    """Undo `packed_match`.

    Raises
    ------
    ObjectError
        If it was not made by that.
    """
    return _checked("kept match", _read_npz, content)


def load_match(path: Path) -> MatchFile:
    """Read a match from a file.

    Raises
    ------
    ObjectError
        If there is no such file, it is damaged, or it holds something else.
    """
    read = _read_json if _kind_of(path) == ".json" else _read_npz
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ObjectError(f'"{path}" cannot be read: {error.strerror or error}.') from error
    return _checked(path.name, read, content)


def _checked(name: str, read: Callable[[bytes], _Read], content: bytes) -> MatchFile:
    """Make a match of what a file holds, if it is one."""
    try:
        header, arrays, largest = read(content)
        if not isinstance(header, dict) or header.get("format") != FORMAT:
            raise ObjectError(f'"{name}" is no match that HierMatch has exported. Choose another file.')
        if header.get("version") != VERSION:
            raise ObjectError(f'"{name}" was exported by a later version of HierMatch. Update the add-on.')
        if largest > _LARGEST_HEADER + _PLACE * max(int(header[role]["vertices"]) for role in ("source", "target")):
            raise ValueError("it holds more than a match of such meshes does")
        return _match_of(header, arrays)
    except HierMatchError:
        raise
    except BAD_FILE as error:
        raise ObjectError(f'"{name}" is damaged or no match file: {error}. Export the match again.') from error


def _kind_of(path: Path) -> str:
    kind = path.suffix.lower()
    if kind not in SUFFIXES:
        raise ObjectError(f'"{path.name}" is no name for a match file. Let it end with .npz or .json.')
    return kind


def _read_npz(content: bytes) -> _Read:
    """Read the header; the arrays are read when they are asked for."""
    archive = np.load(io.BytesIO(content), allow_pickle=False)
    sizes = {member.filename: member.file_size for member in archive.zip.infolist()}
    if sizes["header.npy"] > _LARGEST_HEADER:
        raise ValueError("its header is too large")
    return parsed_json(archive["header"].tobytes().decode()), archive, max(sizes.values())


def _read_json(content: bytes) -> _Read:
    plain = parsed_json(content.decode("utf-8-sig"))
    return plain["header"], {name: np.array(values) for name, values in plain["arrays"].items()}, 0


def _header(match: MatchFile) -> dict[str, Any]:
    """Return all that is no array."""
    stored = match.stored
    sides = {
        role: {"name": name, "vertices": count, "topology": topology, "positions": positions}
        for role, name, count, topology, positions in zip(
            ("source", "target"), stored.names, match.counts, stored.topologies, stored.positions, strict=True
        )
    }
    answers = []
    for answer in stored.answers:
        plain = {"name": answer.name} | answer.to_plain()
        plain.pop("point_distortion")
        answers.append(plain)
    return {
        "format": FORMAT,
        "version": VERSION,
        "kind": match.kind,
        **sides,
        "answers": answers,
        "chosen": stored.chosen,
        "written": {name: value for name, value in vars(stored.written).items() if isinstance(value, bool)},
        "notes": list(stored.notes),
        "left_out": list(stored.left_out),
    }


def _arrays(match: MatchFile) -> dict[str, NDArray[Any]]:
    """Return the arrays by name; for those of answers that are not written see `_start`."""
    stored = match.stored
    arrays = _point_arrays("source_points", stored.source_points)
    for place, (number, maps) in enumerate(zip_longest(stored.order, (match.maps, *match.others))):
        start, answer = _start(place), stored.answers[number]
        arrays |= _point_arrays(f"{start}target_points", answer.target_points)
        arrays[f"{start}point_distortion"] = np.asarray(answer.point_distortion, np.float64)
        if maps is not None:
            for name, vertex_map in zip(MAPS, (maps.of_source, maps.of_target), strict=True):
                arrays[f"{start}{name}_corners"] = vertex_map.corners
                arrays[f"{start}{name}_weights"] = vertex_map.weights
                arrays[f"{start}{name}_confidence"] = vertex_map.confidence
                if not vertex_map.has_partner.all():
                    arrays[f"{start}{name}_partner"] = vertex_map.has_partner.astype(np.int32)
    return arrays


def _start(place: int) -> str:
    """Return what names of arrays of an answer start with, by its place in `StoredMatch.order`."""
    return "" if place == 0 else "other_" if place == 1 else f"other_{place}_"


def _point_arrays(name: str, points: CornerPoints) -> dict[str, NDArray[Any]]:
    return {
        f"{name}_corners": points.corners.astype(np.int32),
        f"{name}_barycentric": points.barycentric.astype(np.float64),
    }


def _match_of(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> MatchFile:
    """Make the match of what was read, every number of which is looked at first."""
    sides = (header["source"], header["target"])
    n, m = counts = (int(sides[0]["vertices"]), int(sides[1]["vertices"]))
    read = CheckedArrays(arrays)
    chosen, described = int(header.get("chosen", header.get("mirrored", 0))), header["answers"]
    usual = chain((DIRECT, MIRRORED), repeat(""))  # what a file says nothing of
    names = [str(plain.get("name", name)) for plain, name in zip(described, usual, strict=False)]
    if not (
        0 <= chosen < len(names) == len(set(names)) and all(0 < len(name.encode()) <= LONGEST_KEY for name in names)
    ):
        raise ValueError("it has not the answers that it names")
    order = (chosen, *(number for number in range(len(names)) if number != chosen))
    kind, source_points = str(header.get("kind", "match")), read.points("source_points", n)
    if kind == "match" and not len(source_points.corners):
        raise ValueError("it has no points")
    answers: dict[int, Answer] = {}
    for place, number in enumerate(order):
        start = _start(place)
        points = read.points(f"{start}target_points", m)
        distortion = read.numbers(f"{start}point_distortion", (len(source_points.corners),))
        if len(points.corners) != len(distortion):
            raise ValueError("source and target have not as many points")
        answers[number] = _answer(names[number], described[number], points, distortion)
    maps, *others = (read.maps(_start(place), counts) for place in range(len(order)))
    written: dict[str, Any] = {name: bool(value) for name, value in header["written"].items()}
    stored = StoredMatch(
        names=(str(sides[0]["name"]), str(sides[1]["name"])),
        topologies=(str(sides[0].get("topology", "")), str(sides[1].get("topology", ""))),
        positions=(str(sides[0].get("positions", "")), str(sides[1].get("positions", ""))),
        written=replace(Written(**written), dense=maps is not None, excluded=("", "")),
        source_points=source_points,
        answers=tuple(answers[number] for number in sorted(answers)),
        chosen=chosen,
        notes=tuple(str(note) for note in header.get("notes", ())),
        left_out=tuple(int(number) for number in header.get("left_out", ())),
    )
    if not set(stored.left_out) <= set(range(len(source_points.corners))):
        raise ValueError("points were left out that it does not have")
    return MatchFile(stored, counts, maps, tuple(others), kind)


def _answer(name: str, plain: Mapping[str, Any], points: CornerPoints, distortion: NDArray[np.float64]) -> Answer:
    quality = plain.get("quality")
    if quality is not None:
        known = {name: str(value) if name == "sentence" else _finite(value) for name, value in quality.items()}
        quality = Quality.from_plain(known)
    return Answer(
        name,
        points,
        distortion,
        _finite(plain["distortion"]),
        _finite(plain["orientation"]),
        bool(plain["proven"]),
        _finite(plain["gap"]),
        quality,
        bool(plain.get("refined", False)),
    )


def _finite(value: Any) -> float:  # noqa: ANN401 - whatever JSON holds
    """Return a number that JSON and Blender can hold, also as a whole number."""
    number = float(value)
    if not abs(number) < _LARGEST:
        raise ValueError(f"{number} is no finite number, or too large")
    return number
