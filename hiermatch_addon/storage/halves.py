# SPDX-License-Identifier: GPL-3.0-or-later
"""The two sides of a stored match: which objects carry it, and whether they are still what was matched."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy

from ..common.access import mesh_of
from ..common.errors import ObjectError
from ..scene.mesh_io import position_digest, topology
from . import writing

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["Half", "find_again", "find_carriers", "find_common", "find_half", "find_keyed"]


@dataclass(frozen=True)
class Half:
    """What one of the two objects carries of a match.

    Attributes
    ----------
    obj : bpy.types.Object
        The object.
    prefix : str
        What all names written start with.
    kept : dict
        Its part of the stored match.
    """

    obj: bpy.types.Object
    prefix: str
    kept: dict[str, Any]

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
        """What both sides of the match carry."""
        return str(self.kept["key"])

    @property
    def role(self) -> str:
        """What the object was matched as: "source" or "target"."""
        return str(self.kept["role"])

    @property
    def partner_role(self) -> str:
        """What the other object is."""
        return "target" if self.role == "source" else "source"

    def has_same_faces(self) -> bool:
        """Return whether stored vertex numbers still mean what they meant."""
        return topology(mesh_of(self.obj)) == self.kept["topology"]

    def staleness(self) -> str:
        """Return a sentence that says why the match is out of date on this side; empty if it is not."""
        if not self.has_same_faces():
            change = "it has other vertices or faces"
        elif self.kept.get("positions") not in (None, "", position_digest(mesh_of(self.obj))):
            change = "its vertices were moved"
        else:
            return ""
        return f'The match is out of date: "{self.obj.name}" was edited since ({change}). Match again.'


def find_half(obj: bpy.types.Object, prefix: str = "") -> Half:
    """Find the match that an object carries.

    Parameters
    ----------
    obj : bpy.types.Object
        The object.
    prefix : str
        What the names that the match wrote start with; may be empty if there is one match only.

    Raises
    ------
    ObjectError
        If there is no such match, or several.
    """
    candidates = [Half(obj, name, writing.kept(obj, name)) for name in _prefixes(obj) if prefix in ("", name)]
    found = [half for half in candidates if half.kept]
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
        if name in view_layer.objects:
            raise ObjectError(
                f'"{name}" does not carry this match any more, because it was cleared or matched anew. '
                "Match the two again."
            )
        raise ObjectError(
            f'The {role} of this match, "{name}", was deleted or is not in the view layer "{view_layer.name}". '
            "Bring it back, or match again."
        )
    named = [half for half in carriers if half.obj.name == name] if len(carriers) > 1 else carriers
    if not named:
        names = ", ".join(f'"{half.obj.name}"' for half in carriers)
        raise ObjectError(f"Several objects are copies of the {role} of this match: {names}. Match the two again.")
    return named[0]


def find_carriers(objects: Iterable[bpy.types.Object], key: str, prefix: str, role: str) -> list[Half]:
    """Find all of some objects that carry one side of a match: the object that was matched, and its copies."""
    return [
        Half(obj, prefix, kept)
        for obj in objects
        if prefix in _prefixes(obj)
        and (kept := writing.kept(obj, prefix))
        and (kept["key"], kept["role"]) == (key, role)
    ]


def find_again(uids: tuple[int, int], names: tuple[str, str], prefix: str, key: str) -> tuple[Half, Half]:
    """Find the two sides of a match again that some work has begun with.

    Parameters
    ----------
    uids : tuple of int
        By which Blender knows the two objects in this session.
    names : tuple of str
        What they were called when the work began.
    prefix, key : str
        Which match.

    Raises
    ------
    ObjectError
        If one of them is gone, or does not carry the match any more.
    """
    halves = []
    for uid, name in zip(uids, names, strict=True):
        obj = next((obj for obj in bpy.data.objects if obj.session_uid == uid), None)
        half = None if obj is None else Half(obj, prefix, writing.kept(obj, prefix))
        if half is None or not half.kept or half.key != key:
            raise ObjectError(f'"{name}" was deleted, cleared or matched anew meanwhile. Nothing was written.')
        halves.append(half)
    return halves[0], halves[1]


def find_common(one: bpy.types.Object, other: bpy.types.Object) -> list[tuple[Half, Half]]:
    """Find the matches of two objects with one another: for each its two sides, in the order of the objects."""
    pairs = []
    for prefix in _prefixes(one):
        half, partner = Half(one, prefix, writing.kept(one, prefix)), Half(other, prefix, _kept(other, prefix))
        if half.kept and partner.kept and (half.key, half.role) == (partner.key, partner.partner_role):
            pairs.append((half, partner))
    return pairs


def _prefixes(obj: bpy.types.Object) -> tuple[str, ...]:
    return writing.prefixes(obj) if obj.type == "MESH" else ()


def _kept(obj: bpy.types.Object, prefix: str) -> dict[str, Any]:
    return writing.kept(obj, prefix) if obj.type == "MESH" else {}
