# SPDX-License-Identifier: GPL-3.0-or-later
"""The two sides of a stored match: which objects carry it, and whether they are still what was matched."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import bpy

from ..common.errors import ObjectError
from ..scene.character import Character, parts_of, positions_of, topology_of
from . import writing
from .linked_matches import move_linked

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ..scene.character import Side, SideReference

MIRRORED = "it was mirrored"
"""Why a match is out of date one of whose meshes has been turned over by a negative scale since."""

_NEEDED: Final = frozenset({"key", "role", "names", "topology", "points"})
_NEEDED_OF_SOURCE: Final = frozenset({"answers", "written", "notes"})
"""What is kept of every match on both sides, and on that of its source; without it, it is of a later version."""


@dataclass(frozen=True)
class Half:
    """What one of the two objects carries of a match.

    Attributes
    ----------
    obj : bpy.types.Object or Character
        The object, or the character of several.
    prefix : str
        What all names written start with.
    """

    obj: Side
    prefix: str

    @cached_property
    def kept(self) -> dict[str, Any]:
        """Its part of the stored match, as it is when this is asked for first."""
        found: dict[str, Any] = self._read.to_dict()
        return found

    @property
    def name(self) -> str:
        """The object's name when it was matched."""
        return str(self.kept["names"][self.role])

    @property
    def partner_name(self) -> str:
        """The other object's name then."""
        return str(self.kept["names"][self.partner_role])

    @property
    def key(self) -> str:
        """What both sides of the match carry; empty if the object carries none that this version can read."""
        needed = _NEEDED | _NEEDED_OF_SOURCE if self._read.get("role") == "source" else _NEEDED
        return str(self._read["key"]) if needed.issubset(self._read.keys()) else ""

    @property
    def role(self) -> str:
        """What the object was matched as: "source" or "target"."""
        return str(self._read["role"])

    @property
    def partner_role(self) -> str:
        """What the other object is."""
        return "target" if self.role == "source" else "source"

    @property
    def part_count(self) -> int:
        """Of how many parts the object was when it was matched."""
        return int(self._read.get("parts", 1))

    @property
    def part(self) -> int:
        """Which of these it carries the match as, or its first part."""
        return int(self._read.get("part", 0))

    @property
    def part_name(self) -> str:
        """What that part was called."""
        return str(self._read["part_name"])

    def is_of(self, key: str, role: str) -> bool:
        """Return whether it carries that side of a match."""
        return self.key == key and self.role == role

    def has_same_faces(self) -> bool:
        """Return whether stored vertex numbers still mean what they meant."""
        return topology_of(self.obj) == self._read["topology"]

    def staleness(self) -> str:
        """Return a sentence that says why the match is out of date on this side; empty if it is not."""
        if not self.has_same_faces():
            change = "it has other vertices or faces"
        elif (then := self._read.get("positions")) not in (None, "", now := positions_of(self.obj)):
            change = MIRRORED if then.split()[0] == now.split()[0] else "its vertices were moved"
        else:
            return ""
        return f'The match is out of date: "{self.obj.name}" was edited since ({change}). Match again.'

    @property
    def _read(self) -> Any:  # noqa: ANN401 - Blender's group of properties
        """What is kept, without a copy of it."""
        first = parts_of(self.obj)[0]
        return writing.kept(first, self.prefix) if first.type == "MESH" else {}


def check_fresh(halves: tuple[Half, Half]) -> None:
    """Make sure that neither mesh was edited since."""
    for half in halves:
        if stale := half.staleness():
            raise ObjectError(stale)


def is_mirrored(obj: bpy.types.Object) -> bool:
    """Tell whether an object is mirrored and was not when it was matched, or the other way round."""
    for prefix in _prefixes(obj):
        kept = writing.kept(obj, prefix)
        then = str(kept.get("positions") or "").split()
        if then and (str(kept.get("part", 0)) in then[1:]) != obj.matrix_world.is_negative:
            return True
    return False


def find_half(obj: Side, prefix: str = "") -> Half:
    """Find the match that an object carries, alone or as a part of a character.

    Parameters
    ----------
    obj : bpy.types.Object or Character
        The object; one part of a character is enough.
    prefix : str
        What the names that the match wrote start with; may be empty if there is one match only.

    Raises
    ------
    ObjectError
        If there is no such match, or several.
    """
    found = [half for name in _prefixes(obj) if prefix in ("", name) for half in _whole_half(obj, name)]
    if not found:
        if prefix:
            raise ObjectError(f'"{obj.name}" carries no match with the Prefix "{prefix}". Match it first.')
        raise ObjectError(f'"{obj.name}" carries no match. Match it first.')
    if len(found) > 1:
        prefixes = ", ".join(f'"{half.prefix}"' for half in found)
        raise ObjectError(f'"{obj.name}" carries several matches. Name the Prefix of one of them: {prefixes}.')
    return found[0]


def find_keyed(view_layer: bpy.types.ViewLayer, key: str, prefix: str, role: str, name: str) -> Half:
    """Find the object that carries one side of a match.

    Parameters
    ----------
    view_layer : bpy.types.ViewLayer
        Where to look.
    key, prefix : str
        Which match.
    role : str
        "source" or "target".
    name : str
        What the object was called; of several copies, the one that still has this name is meant.

    Raises
    ------
    ObjectError
        If there is none, or no telling which.
    """
    carriers = find_carriers(view_layer.objects, key, prefix, role)
    if not carriers:
        called = view_layer.objects.get(name)
        other = "target" if role == "source" else "source"
        others = [half.obj for half in find_carriers(view_layer.objects, key, prefix, other)]
        if called is not None and others != [called]:  # the other one may have the name by now
            raise ObjectError(
                f'"{name}" does not carry this match any more, because it was cleared or matched anew. '
                "Match the two again."
            )
        raise ObjectError(
            f'The {role} of this match, "{name}", was deleted, or renamed and cleared, or is not in the view layer '
            f'"{view_layer.name}". Bring it back, or match again.'
        )
    half = meant(carriers, name)
    if half is None:
        names = ", ".join(f'"{half.obj.name}"' for half in carriers)
        raise ObjectError(f"Several objects are copies of the {role} of this match: {names}. Match the two again.")
    return half


def meant(carriers: Sequence[Half], name: str) -> Half | None:
    """Return which of what carries one side of a match is meant; None if there is no telling.

    That is the one that has the name of what was matched; else the only one, or any of those that have the same mesh.
    """
    named = [half for half in carriers if half.obj.name == name]
    meshes = {tuple(part.data for part in parts_of(half.obj)) for half in carriers}
    return named[0] if named else carriers[0] if len(meshes) == 1 else None


def find_carriers(objects: Iterable[bpy.types.Object], key: str, prefix: str, role: str) -> list[Half]:
    """Find what of some objects carries one side of a match: the object that was matched, and its copies.

    The parts of a character are one carrier; of copies of a part, the one that still has its name is taken.
    """
    found = [half for obj in objects if (half := Half(obj, prefix)).is_of(key, role)]
    whole = [half for half in found if half.part_count == 1]
    character = _assembled([half for half in found if half.part_count > 1])
    return whole if character is None else [*whole, character]


def find_again(references: tuple[SideReference, SideReference], prefix: str, key: str) -> tuple[Half, Half]:
    """Find the two sides of a match again that some work has begun with.

    Parameters
    ----------
    references : tuple of SideReference
        What the two sides are known by.
    prefix, key : str
        Which match.

    Raises
    ------
    ObjectError
        If one of them is gone, or does not carry the match any more.
    """
    halves = []
    for reference in references:
        side = reference.find()
        half = None if side is None else _half(side, prefix)
        if half is None or half.key != key:
            raise ObjectError(
                f'"{reference.name}" was deleted, cleared or matched anew meanwhile. Nothing was written.'
            )
        halves.append(half)
    return halves[0], halves[1]


def find_common(one: Side, other: Side) -> list[tuple[Half, Half]]:
    """Find the matches of two sides with one another: for each its two halves, in the order of the sides."""
    pairs = []
    for prefix in _prefixes(one):
        half, partner = _half(one, prefix), _half(other, prefix)
        if half is not None and partner is not None and (half.key, half.role) == (partner.key, partner.partner_role):
            pairs.append((half, partner))
    return pairs


def find_match(one: Side, other: Side, prefix: str = "") -> tuple[Half, Half]:
    """Find the match of two sides with one another: its two halves, in the order of the sides.

    Raises
    ------
    ObjectError
        If there is none with that prefix, or, without one, there are several; or a mesh was edited since.
    """
    pair = f'"{one.name}" and "{other.name}"'
    found = [halves for halves in find_common(one, other) if prefix in ("", halves[0].prefix)]
    if not found:
        of_prefix = f' with the Prefix "{prefix}"' if prefix else ""
        raise ObjectError(f"{pair} carry no match with one another{of_prefix}. Match them first.")
    if len(found) > 1:
        prefixes = ", ".join(f'"{half.prefix}"' for half, _ in found)
        raise ObjectError(f"{pair} carry several matches. Name the Prefix of one of them: {prefixes}.")
    check_fresh(found[0])
    return found[0]


def in_order(one: Half, other: Half) -> tuple[Half, Half]:
    """Put what was matched as the source first."""
    return (one, other) if one.role == "source" else (other, one)


def _half(side: Side, prefix: str) -> Half | None:
    """Return what all parts of a side carry of one match, in their order; None if they do not carry all of one."""
    halves = [Half(part, prefix) for part in parts_of(side)]
    known = {(half.key, half.part_count, half.key and half.role) for half in halves}
    if len(known) > 1 or not halves[0].key or [half.part for half in halves] != list(range(halves[0].part_count)):
        return None
    return Half(side, prefix)


def _whole_half(side: Side, prefix: str) -> list[Half]:
    """Return what a side carries of a match, or the character that it is a part of; nothing if it carries none."""
    half = Half(parts_of(side)[0], prefix)
    if not half.key:
        return []
    if half.part_count == 1:
        return [half]
    character = _half(side, prefix)
    return [character] if character else find_carriers(bpy.data.objects, half.key, prefix, half.role)


def _assembled(halves: list[Half]) -> Half | None:
    """Put the parts of a character together; None if one is missing."""
    chosen: dict[int, Half] = {}
    for half in halves:
        if half.part not in chosen or half.obj.name == half.part_name:
            chosen[half.part] = half
    if not chosen or len(chosen) < halves[0].part_count:
        return None
    first = chosen[0]
    parts = tuple(part for number in sorted(chosen) for part in parts_of(chosen[number].obj))
    return Half(Character(first.name, parts), first.prefix)


def _prefixes(side: Side) -> tuple[str, ...]:
    first = parts_of(side)[0]
    return writing.prefixes(first) if first.type == "MESH" else ()


@contextmanager
def moved_by_us(side: Side) -> Iterator[None]:
    """Keep the matches of a side up to date while its vertices are moved without another meaning, as by a pose."""
    halves = [half for prefix in _prefixes(side) if (half := _half(side, prefix)) is not None]
    fresh = [half.prefix for half in halves if not half.staleness()]
    before = positions_of(side)
    yield
    move_linked(side, before)
    for prefix in fresh:
        for part in parts_of(side):
            writing.change_kept(part, prefix, positions=positions_of(side))
