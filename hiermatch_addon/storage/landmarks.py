# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks of a pair of meshes: corresponding vertices that the user names.

The two vertices of a landmark have the same number.  A mesh may have landmarks in common with several others: its own
then serve with all of them, each as far as the other mesh has the same number.  So a new one gets a number that no mesh
of the file has, also none that lost its partner: else it would be one with that mesh, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..common.errors import ObjectError
from ..scene.character import parts_of, vertex_ranges
from ..scene.pair import check_writable
from . import landmark_layer
from .landmark_names import landmark_names, name_landmark

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from ..scene.character import Side

Mark = tuple[int, bool]
"""The vertex of a landmark on one mesh, and whether the landmark is on."""

_MOST = 4096
"""So many landmarks a mesh can have."""


@dataclass(frozen=True)
class Landmark:
    """A pair of corresponding vertices.

    Attributes
    ----------
    number : int
        By which the two vertices are known, from 1.
    source, target : int
        The vertices.
    use : bool
        Whether a match is to keep to it.
    name : str
        What the user calls it; may be empty.
    """

    number: int
    source: int
    target: int
    use: bool = True
    name: str = ""


def find_landmarks(source: Side, target: Side) -> list[Landmark]:
    """Return what landmarks two meshes have in common, in the order of their numbers."""
    there, back = read_marks(source), read_marks(target)
    names = landmark_names(target) | landmark_names(source)
    return [
        Landmark(number, vertex, back[number][0], use and back[number][1], names.get(number, ""))
        for number, (vertex, use) in there.items()
        if number in back
    ]


def landmark_array(landmarks: Iterable[Landmark]) -> NDArray[np.int64] | None:
    """Return the landmarks that are on as the engine wants them, (k, 2); None if there are none."""
    pairs = [(landmark.source, landmark.target) for landmark in landmarks if landmark.use]
    return np.array(pairs, np.int64) if pairs else None


def add_landmarks(source: Side, target: Side, pairs: Iterable[tuple[int, int]], name: str = "") -> list[Landmark]:
    """Let vertices of the source and of the target correspond.

    A vertex has one landmark only: where one of the two has one already, that landmark moves.

    Parameters
    ----------
    source, target : bpy.types.Object or Character
        The objects, both in Object Mode or in Edit Mode.
    pairs : iterable of (int, int)
        Vertices of the source and of the target.
    name : str
        What the new landmarks are called; may be empty.

    Returns
    -------
    list of Landmark
        The new landmarks.

    Raises
    ------
    ObjectError
        If a mesh cannot be written to, or has all the landmarks that it can have.
    """
    _check_writable(source, target)
    there, back = read_marks(source), read_marks(target)
    taken = landmark_layer.numbers_in_file()
    added = []
    for pair in pairs:
        number = _number_for(pair, there, back, taken)
        for marks, vertex in zip((there, back), pair, strict=True):
            for other in [other for other, (place, _) in marks.items() if place == vertex]:
                del marks[other]
            marks[number] = (vertex, True)
        for obj in (source, target):
            name_landmark(obj, number, name)  # or it would have that of one of the same number that is gone
        added.append(Landmark(number, *pair, name=name))
    write_marks(source, there)
    write_marks(target, back)
    return added


def remove_landmark(source: Side, target: Side, number: int) -> None:
    """Remove a landmark from both meshes.

    Raises
    ------
    ObjectError
        If there is none of that number, or a mesh cannot be written to.
    """
    _check_number(source, target, number)
    for obj in (source, target):
        write_marks(obj, {other: mark for other, mark in read_marks(obj).items() if other != number})
        name_landmark(obj, number, "")


def changed_for_others(side: Side, before: dict[int, Mark], pair: tuple[Side, Side]) -> list[str]:
    """Return the names of meshes beside a pair that have landmarks which a side of it no longer has as `before`."""
    now, own = read_marks(side), {part.data for each in pair for part in parts_of(each)}
    changed = {number for number, mark in before.items() if now.get(number) != mark}
    others = [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.data not in own] if changed else []
    return [obj.name for obj in others if changed & landmark_layer.read_marks(obj).keys()]


def rename_landmark(source: Side, target: Side, number: int, name: str) -> None:
    """Name a landmark; an empty name takes its name away.

    Raises
    ------
    ObjectError
        If there is none of that number, or a mesh cannot be written to.
    """
    _check_number(source, target, number)
    for obj in (source, target):
        name_landmark(obj, number, name)


def switch_landmark(source: Side, target: Side, number: int, *, use: bool) -> None:
    """Switch a landmark on or off.

    Raises
    ------
    ObjectError
        If there is none of that number, or a mesh cannot be written to.
    """
    _check_number(source, target, number)
    for obj in (source, target):
        marks = read_marks(obj)
        marks[number] = (marks[number][0], use)
        write_marks(obj, marks)


def clear_landmarks(source: Side, target: Side) -> int:
    """Remove what landmarks two meshes have in common; return how many there were.

    Raises
    ------
    ObjectError
        If a mesh cannot be written to.
    """
    _check_writable(source, target)
    common = {landmark.number for landmark in find_landmarks(source, target)}
    for obj in (source, target):
        write_marks(obj, {number: mark for number, mark in read_marks(obj).items() if number not in common})
        for number in common:
            name_landmark(obj, number, "")
    return len(common)


def _number_for(pair: tuple[int, int], there: dict[int, Mark], back: dict[int, Mark], taken: set[int]) -> int:
    """Choose the number of a landmark: one that a vertex of it has, else one that neither mesh has.

    It is none of those `taken` in the file as long as there are others.
    """
    for marks, vertex in zip((there, back), pair, strict=True):
        for number, (place, _) in marks.items():
            if place == vertex:
                return number
    free = [number for number in range(1, _MOST + 1) if number not in there and number not in back]
    if not free:
        raise ObjectError(f"A mesh can have {_MOST} landmarks. Remove some first.")
    return min(free, key=taken.__contains__)


def read_marks(side: Side) -> dict[int, Mark]:
    """Return the landmarks of a side by their numbers; their vertices are counted through all parts."""
    marks: dict[int, Mark] = {}
    for part, start, _ in _bounds(side):
        for number, (vertex, use) in landmark_layer.read_marks(part).items():
            marks.setdefault(number, (vertex + start, use))
    return dict(sorted(marks.items()))


def write_marks(side: Side, marks: dict[int, Mark]) -> None:
    """Let these be the landmarks of a side."""
    for part, start, end in _bounds(side):
        inside = {number: (vertex - start, use) for number, (vertex, use) in marks.items() if start <= vertex < end}
        if inside != landmark_layer.read_marks(part):
            landmark_layer.write_marks(part, inside)


def _bounds(side: Side) -> list[tuple[bpy.types.Object, int, float]]:
    """Return for each part the number of its first vertex, and of the one after its last.

    The last part has no end: in Edit Mode a mesh may have more vertices than Object Mode knows of.
    """
    parts, ranges = parts_of(side), vertex_ranges(side)
    ends = [*(own.stop for own in ranges[:-1]), np.inf]
    return [(part, own.start, end) for part, own, end in zip(parts, ranges, ends, strict=True)]


def select_on_side(side: Side, vertices: Iterable[int]) -> None:
    """Select some vertices of a side, counted through all parts, and nothing else of it; see `select_vertices`."""
    chosen = tuple(vertices)
    for part, start, end in _bounds(side):
        landmark_layer.select_vertices(part, [vertex - start for vertex in chosen if start <= vertex < end])


def _check_writable(*sides: Side) -> None:
    for side in sides:
        for part in parts_of(side):
            check_writable(part)
            landmark_layer.check_layer(part)


def _check_number(source: Side, target: Side, number: int) -> None:
    _check_writable(source, target)
    if number not in {landmark.number for landmark in find_landmarks(source, target)}:
        raise ObjectError(f'"{source.name}" and "{target.name}" have no landmark {number} in common.')
