# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters of several objects, such as body, hair, eyes and clothes on one rig: one surface, kept in parts.

One side of a match is a mesh object, or a `Character` of several.  What works on sides goes by their parts; a mesh
object is the only part of itself.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

import bpy
import numpy as np

from ...engine import Polygons, TriangleMesh
from ..common.access import mesh_of
from ..common.errors import ObjectError
from .attribute_io import read_polygons
from .mesh_io import position_digest, read_mesh, topology, vertex_positions

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

FITTED_TO: Final = "hiermatch_body"
"""Custom property of a fitted copy of clothes: the name of the body that it was fitted to, of which it is no part."""

_MATCHED_AS: Final = "hiermatch_part"
"""Custom property of the mesh of a part: what the part was called when it was matched, by which parts stay ordered."""

_SUCCESSOR: Final = "hiermatch_successor"
"""Custom property of an armature: the one that has taken its place, as a pointer that follows renaming."""


@dataclass(frozen=True)
class Character:
    """Mesh objects that are one surface together.

    Attributes
    ----------
    name : str
        What it is called: as its armature or collection, or else as its first part.
    parts : tuple of bpy.types.Object
        The mesh objects, in the order in which their vertices are numbered.
    left_out : frozenset of int
        Triangles, numbered through, that do not count as its surface: what hangs over it.
    """

    name: str
    parts: tuple[bpy.types.Object, ...]
    left_out: frozenset[int] = frozenset()


Side: TypeAlias = "bpy.types.Object | Character"
"""What is matched on one side."""


@dataclass(frozen=True)
class SideReference:
    """A side by which it is found again later in the session; unlike objects, it may be kept while Blender works.

    Attributes
    ----------
    name : str
        What it was called.
    parts : tuple of str and int
        What each of its parts was called, and by what number Blender knows it.
    """

    name: str
    parts: tuple[tuple[str, int], ...]

    @classmethod
    def of(cls, side: Side) -> SideReference:
        """Take what a side is known by."""
        return cls(side.name, tuple((part.name, part.session_uid) for part in parts_of(side)))

    def find(self) -> Side | None:
        """Look the side up again; None if a part of it is gone."""
        objects = bpy.data.objects
        found: dict[int, bpy.types.Object] = {}
        for name, uid in self.parts:
            obj = cast("bpy.types.Object | None", objects.get(name))
            if obj is not None and obj.session_uid == uid:
                found[uid] = obj
        if len(found) < len(self.parts):  # renamed, or gone: only then all objects of the file are looked through
            found = {obj.session_uid: obj for obj in objects}
        if any(uid not in found for _, uid in self.parts):
            return None
        parts = tuple(found[uid] for _, uid in self.parts)
        return parts[0] if len(parts) == 1 else Character(self.name, parts)

    def found(self) -> Side:
        """Look the side up again.

        Raises
        ------
        ObjectError
            If a part of it was deleted.
        """
        side = self.find()
        if side is None:
            raise ObjectError(f'"{self.name}" was deleted meanwhile. Nothing was written.')
        return side


@dataclass(frozen=True)
class ReadSide(SideReference):
    """A side that was read, and is to be as it was when something is written.

    Attributes
    ----------
    state : tuple of str
        What tells other vertices and faces.
    """

    state: tuple[str, str]

    @classmethod
    def of(cls, side: Side) -> ReadSide:
        """Take what a side is known by."""
        reference = SideReference.of(side)
        return cls(reference.name, reference.parts, (topology_of(side), positions_of(side)))

    def unchanged(self) -> Side:
        """Look the side up again.

        Raises
        ------
        ObjectError
            If it was deleted or edited since.
        """
        side = self.found()
        if (topology_of(side), positions_of(side)) != self.state:
            raise ObjectError(f'"{side.name}" was edited meanwhile. Nothing was written.')
        return side


def parts_of(side: Side) -> tuple[bpy.types.Object, ...]:
    """Return the mesh objects of a side."""
    return side.parts if isinstance(side, Character) else (side,)


def armatures_above(obj: bpy.types.Object) -> set[bpy.types.Object]:
    """Return the armatures that move an object, by modifiers or as what it hangs on, and those that move the latter."""
    found: set[bpy.types.Object] = set()
    link: bpy.types.Object | None = obj
    while link is not None:
        armatures = [getattr(modifier, "object", None) for modifier in link.modifiers if modifier.type == "ARMATURE"]
        found.update(armature for armature in (link, *armatures) if armature and armature.type == "ARMATURE")
        link = link.parent
    return found


def take_place(other: bpy.types.Object, armature: bpy.types.Object) -> None:
    """Record that an armature moves a character in the place of another one, so that either means this character.

    So do those in whose place that other one had come.
    """
    for owner in cast("Any", bpy.data.objects):
        if other in (owner, owner.get(_SUCCESSOR)):
            owner[_SUCCESSOR] = armature
    cast("Any", armature).pop(_SUCCESSOR, None)  # one that comes back


def successor(armature: bpy.types.Object) -> bpy.types.Object:
    """Return the armature that has taken the place of another one, or that one itself."""
    return cast("Any", armature).get(_SUCCESSOR) or armature


def is_of(obj: bpy.types.Object, chosen: bpy.types.ID) -> bool:
    """Tell whether an object is what is picked, or one of the same character."""
    if isinstance(chosen, bpy.types.Collection):
        return obj.name in chosen.all_objects
    own: Any = chosen
    rigs = armatures_above(own) | ({successor(own)} if own.type == "ARMATURE" else set())
    return obj == own or obj in own.children_recursive or not rigs.isdisjoint(armatures_above(obj))


def joined(name: str, parts: Iterable[bpy.types.Object]) -> Side:
    """Make a side of mesh objects: a character, or the only object itself.

    Parts are ordered by their names; those that are matched by what they were called then, so that the numbers of their
    vertices go on to mean the same when they are renamed.
    """
    ordered = tuple(sorted(dict.fromkeys(parts), key=_order))
    return ordered[0] if len(ordered) == 1 else Character(name, ordered)


def _order(part: bpy.types.Object) -> tuple[str, str]:
    owner: Any = part.data or part
    return owner.get(_MATCHED_AS, part.name), part.name


def keep_order(part: bpy.types.Object) -> None:
    """Let a part keep its place among others when it is renamed."""
    mesh: Any = mesh_of(part)
    if _MATCHED_AS not in mesh:
        mesh[_MATCHED_AS] = part.name


def forget_order(mesh: bpy.types.Mesh) -> None:
    """Undo `keep_order`."""
    owner: Any = mesh
    owner.pop(_MATCHED_AS, None)


def side_of(chosen: bpy.types.ID | Character, view_layer: bpy.types.ViewLayer) -> Side:
    """Return what is meant by something that was named or picked.

    Parameters
    ----------
    chosen : bpy.types.ID or Character
        A mesh object, which is meant alone; an armature, with all meshes that it moves; an empty, with all meshes
        that hang on it; or a collection, with all meshes in it.  Other objects, and armatures and empties without
        such meshes, are returned as they are.  What was fitted to a body is no part of that.
    view_layer : bpy.types.ViewLayer
        Where the parts are.  Those that are hidden, or have no faces, are left out.

    Raises
    ------
    ObjectError
        If a collection has no such meshes.
    """
    if isinstance(chosen, Character):
        return chosen
    shown = (obj for obj in view_layer.objects if _is_part(obj, view_layer))
    if isinstance(chosen, bpy.types.Collection):
        members = set(chosen.all_objects)
        parts = [obj for obj in shown if obj in members]
        if not parts:
            raise ObjectError(
                f'The collection "{chosen.name}" holds no mesh with faces that is shown in this view layer. Show its '
                "meshes, or choose another one."
            )
        return joined(chosen.name, parts)
    obj: Any = chosen
    shown = (part for part in shown if FITTED_TO not in cast("Any", part))
    if obj.type == "ARMATURE":
        rigs = {obj, successor(obj)}
        parts = [part for part in shown if not rigs.isdisjoint(armatures_above(part))]
        return joined(obj.name, parts) if parts else obj
    if obj.type == "EMPTY":
        below = set(obj.children_recursive)
        parts = [part for part in shown if part in below]
        return joined(obj.name, parts) if parts else obj
    return obj


def vertex_count(side: Side) -> int:
    """Return how many vertices a side has."""
    return sum(len(mesh_of(part).vertices) for part in parts_of(side))


def vertex_ranges(side: Side) -> list[slice]:
    """Return for each part of a side which of all vertices are its own."""
    return _ranges([len(mesh_of(part).vertices) for part in parts_of(side)])


def corner_ranges(side: Side) -> list[slice]:
    """Return for each part of a side which of all corners of faces are its own."""
    return _ranges([len(mesh_of(part).loops) for part in parts_of(side)])


def face_ranges(side: Side) -> list[slice]:
    """Return for each part of a side which of all faces are its own."""
    return _ranges([len(mesh_of(part).polygons) for part in parts_of(side)])


def edge_ranges(side: Side) -> list[slice]:
    """Return for each part of a side which of all edges are its own."""
    return _ranges([len(mesh_of(part).edges) for part in parts_of(side)])


def read_surface(side: Side, depsgraph: bpy.types.Depsgraph, *, use_modifiers: bool) -> TriangleMesh:
    """Read all parts of a side as one surface, as they stand in the world; see `read_mesh`.

    What is left out of a character is there only with modifiers, which may number triangles anew.
    """
    mesh = TriangleMesh.concatenated(
        [read_mesh(part, depsgraph, use_modifiers=use_modifiers) for part in parts_of(side)]
    )
    if use_modifiers or not isinstance(side, Character) or not side.left_out:
        return mesh
    return TriangleMesh(mesh.vertices, np.delete(mesh.triangles, sorted(side.left_out), axis=0))


def whole(side: Side) -> Side:
    """Return a side with what is left out of it."""
    return replace(side, left_out=frozenset()) if isinstance(side, Character) else side


def read_faces(side: Side) -> Polygons:
    """Read the faces of all parts of a side, numbered through; see `read_polygons`."""
    found = [read_polygons(mesh_of(part)) for part in parts_of(side)]
    if len(found) == 1:
        return found[0]

    vertices, corners, edges = (ranges(side) for ranges in (vertex_ranges, corner_ranges, edge_ranges))

    def stacked(name: str, ranges: list[slice]) -> NDArray[np.int64]:
        return np.concatenate([getattr(one, name) + own.start for one, own in zip(found, ranges, strict=True)])

    starts = [one.starts[:-1] + own.start for one, own in zip(found, corners, strict=True)]
    return Polygons(
        np.concatenate([*starts, [corners[-1].stop]]),
        stacked("corner_vertices", vertices),
        stacked("edges", vertices),
        stacked("corner_edges", edges),
        stacked("triangle_corners", corners),
    )


def own_positions(side: Side) -> NDArray[np.float64]:
    """Read the vertices of all parts, each in the space of its own object, (n, 3)."""
    return np.concatenate([vertex_positions(mesh_of(part)) for part in parts_of(side)]).astype(np.float64)


def topology_of(side: Side) -> str:
    """Return a text that is the same as long as vertices and faces of all parts are numbered and connected alike."""
    return _digest([topology(mesh_of(part)) for part in parts_of(side)])


def positions_of(side: Side) -> str:
    """Return a text that is the same as long as no vertex of a part moves within its object, and none is mirrored."""
    parts = parts_of(side)
    mirrored = [str(number) for number, part in enumerate(parts) if part.matrix_world.is_negative]
    return " ".join([_digest([position_digest(mesh_of(part)) for part in parts]), *mirrored])


def _digest(texts: list[str]) -> str:
    if len(texts) == 1:
        return texts[0]
    return hashlib.blake2b("\0".join(texts).encode(), digest_size=16).hexdigest()


def _ranges(counts: list[int]) -> list[slice]:
    return [slice(int(start), int(end)) for start, end in pairwise(np.cumsum([0, *counts]))]


def _is_part(obj: bpy.types.Object | None, view_layer: bpy.types.ViewLayer) -> bool:
    """Tell whether an object is a mesh with faces that is shown."""
    if obj is None or obj.type != "MESH":  # None: it is being removed
        return False
    return bool(len(mesh_of(obj).polygons)) and obj.visible_get(view_layer=view_layer)
