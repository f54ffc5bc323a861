# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes from files: which file and object an argument means, and how it gets into Blender."""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast
from uuid import uuid4

import bpy

from ..common.access import mesh_of, view_layer_of
from ..common.errors import ObjectError
from ..scene.character import armatures_above, parts_of, side_of
from .operator_errors import said_by

if TYPE_CHECKING:
    from collections.abc import Collection, Container, Iterable, Mapping, Sequence

    from ..scene.character import Side

_IMPORTERS: Final[dict[str, tuple[str, ...]]] = {
    ".obj": ("wm.obj_import",),
    ".ply": ("wm.ply_import",),
    ".stl": ("wm.stl_import",),
    ".fbx": ("import_scene.fbx", "wm.fbx_import"),
    ".glb": ("import_scene.gltf",),
    ".gltf": ("import_scene.gltf",),
    ".vrm": ("import_scene.vrm", "import_scene.gltf"),  # which is glTF with additions
}
"""For each kind of file the operators that read it, of which the first that this Blender has is taken."""

_KINDS = (".blend", *_IMPORTERS)


@dataclass(frozen=True)
class MeshArgument:
    """A mesh as it is named on the command line.

    Attributes
    ----------
    path : Path
        The file.
    name : str
        The object in it, or a collection; empty if there is only one mesh or character to choose.
    """

    path: Path
    name: str = ""

    def __str__(self) -> str:
        return f"{self.path}:{self.name}" if self.name else str(self.path)


def mesh_argument(text: str) -> MeshArgument:
    """Read FILE or FILE:NAME; both may contain colons.

    Raises
    ------
    argparse.ArgumentTypeError
        If it is no file of a known kind.
    """
    ends = [place for place, letter in enumerate(text) if letter == ":"]
    for end in (*ends, len(text)):
        path = Path(text[:end])
        if path.suffix.lower() in _KINDS:
            return MeshArgument(path, text[end + 1 :])
    raise argparse.ArgumentTypeError(f'"{text}" names no file that ends with {", ".join(_KINDS)}')


def load_meshes(
    arguments: Sequence[MeshArgument], *, whole: bool = True, last_first: bool = False
) -> tuple[list[Side], list[str]]:
    """Load meshes and characters, of one or several files, into one scene.

    The first .blend among the files is opened as a whole; all else is added to it.

    Parameters
    ----------
    arguments : sequence of MeshArgument
        Files, and what is meant in them: a mesh, an armature with all meshes that it moves, or a collection.
    whole : bool
        Whether a file of several meshes on one armature means all of them, if no name is given.
    last_first : bool
        Whether the last one is added first: of two things of one name that which is added later gets a number.

    Returns
    -------
    sides : list of bpy.types.Object or Character
        For each argument what it means.
    notes : list of str
        What should be known of the choice.

    Raises
    ------
    ObjectError
        If a file cannot be read, or which mesh is meant is open.
    """
    for argument in arguments:
        if not argument.path.is_file():
            raise ObjectError(f'There is no file "{argument.path}".')
    opened = next((one.path for one in arguments if one.path.suffix.lower() == ".blend"), None)
    _start(opened)
    objects = {obj: obj.name for obj in view_layer_of(bpy.context).objects}  # those of the opened file alone
    imported: dict[Path, dict[bpy.types.Object, str]] = {}
    found: list[Side] = []
    notes: list[str] = []
    for argument in reversed(arguments) if last_first else arguments:
        path = argument.path
        if opened is not None and path.samefile(opened):
            chosen = _named(argument, objects) or (whole and _only_character(argument, objects))
            chosen = chosen or _choose([obj for obj in objects if obj.type == "MESH"], argument)
        elif path.suffix.lower() == ".blend":
            chosen = _append(argument, whole=whole)
        else:
            if path.resolve() not in imported:
                imported[path.resolve()] = _import(path, {_bare(one.name) for one in arguments})
            chosen = _chosen_of_import(imported[path.resolve()], argument, notes, whole=whole)
        found.append(chosen)
    if last_first:
        found.reverse()
    context = bpy.context
    for obj in (part for side in found for part in parts_of(side)):
        if obj.mode != "OBJECT":
            view_layer_of(context).objects.active = obj
            bpy.ops.object.mode_set(mode="OBJECT")
    view_layer_of(context).update()
    return found, notes


def _named(argument: MeshArgument, called: Mapping[bpy.types.Object, str]) -> Side | None:
    """Return the character whose armature or collection is named; None if a mesh has that name, or neither has.

    It is one of some objects, by what each of them is `called` in its file.
    """
    named = [obj for obj, name in called.items() if name == argument.name]
    if not argument.name or any(obj.type == "MESH" for obj in named):
        return None
    view_layer_of(bpy.context).update()
    for obj in named:
        if obj.type == "ARMATURE":
            return side_of(obj, view_layer_of(bpy.context))
    collection = bpy.data.collections.get(argument.name)
    held = collection is not None and any(obj in called for obj in collection.all_objects)
    return side_of(collection, view_layer_of(bpy.context)) if collection is not None and held else None


def has_operator(name: str) -> bool:
    """Tell whether this Blender has an operator."""
    group, _, operator = name.partition(".")
    described: Any = getattr(getattr(bpy.ops, group), operator)
    try:
        described.get_rna_type()
    except KeyError:
        return False
    return True


def _start(opened: Path | None) -> None:
    """Open a file, or begin an empty one."""
    if opened is None:
        bpy.ops.wm.read_homefile(use_empty=True)
        return
    try:
        # No script of a file is to run on a machine that works through many.
        bpy.ops.wm.open_mainfile(filepath=str(opened.resolve()), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise ObjectError(f'"{opened}" cannot be opened: {said_by(error)}') from error


def _import(path: Path, bare: Container[str]) -> dict[bpy.types.Object, str]:
    """Import a file and return its meshes with faces, and its armatures; not what only shows bones in the view.

    With each comes its name in the file, at least if that is a `bare` one but for a number.  Here it may have got
    another number, as the name was taken.
    """
    name = next((name for name in _IMPORTERS[path.suffix.lower()] if has_operator(name)), None)
    if name is None:
        raise ObjectError(
            f'This Blender cannot read "{path.name}". Enable the add-on that imports {path.suffix} files, or convert '
            "the file."
        )
    group, _, operator = name.partition(".")
    known = set(bpy.data.objects)
    before = {obj: obj.name for obj in known if obj.library is None and _bare(obj.name) in bare}
    _call(dict.fromkeys(before))
    try:
        getattr(getattr(bpy.ops, group), operator)(filepath=str(path.resolve()))
    except RuntimeError as error:
        raise ObjectError(f'"{path}" cannot be read: {said_by(error)}') from error
    called = {obj: obj.name for obj in bpy.data.objects if obj not in known}
    for names in (dict.fromkeys(called), before, called) if before else ():
        _call(names)
    added = [obj for obj in view_layer_of(bpy.context).objects if obj in called]
    poses = [obj.pose for obj in added if obj.type == "ARMATURE" and obj.pose is not None]
    shapes = {bone.custom_shape for pose in poses for bone in pose.bones}
    added = [obj for obj in added if obj not in shapes]
    return {
        obj: called[obj]
        for obj in added
        if obj.type == "ARMATURE" or (obj.type == "MESH" and len(mesh_of(obj).polygons))
    }


def _bare(name: str) -> str:
    """Return a name without the number that Blender gives those that are taken."""
    return re.sub(r"\.\d+$", "", name)


def _call(names: Mapping[bpy.types.Object, str | None]) -> None:
    """Give objects names; None stands for one that no file has."""
    for obj, name in names.items():
        obj.name = name or uuid4().hex


def _append(argument: MeshArgument, *, whole: bool) -> Side:
    """Append an object of another .blend, with its parents and what its modifiers use, or a whole character."""
    try:
        libraries: Any = bpy.data.libraries
        with libraries.load(str(argument.path.resolve()), link=False) as (there, here):
            names = list(there.objects)
            if argument.name and argument.name not in names and argument.name in there.collections:
                names, here.collections = [], [argument.name]
            here.objects = list(names)
    except (OSError, RuntimeError) as error:
        raise ObjectError(f'"{argument.path}" cannot be opened: {said_by(error)}') from error
    if here.collections:
        (collection,) = here.collections
        cast("bpy.types.Scene", bpy.context.scene).collection.children.link(collection)
        for obj in list(collection.all_objects):
            _link(obj)
        view_layer_of(bpy.context).update()
        return side_of(collection, view_layer_of(bpy.context))
    if argument.name and argument.name not in names:
        raise ObjectError(f'"{argument.path}" has no object called "{argument.name}".')
    loaded = cast("list[bpy.types.Object | None]", here.objects)
    found = {name: obj for name, obj in zip(names, loaded, strict=True) if obj is not None}
    meshes = {name: obj for name, obj in found.items() if obj.type == "MESH" and len(mesh_of(obj).polygons)}
    chosen = found.get(argument.name)
    mover = chosen if chosen is not None and chosen.type == "ARMATURE" else None
    if not argument.name and whole and len(meshes) != 1:
        mover = _only_mover(found.values())
    kept = [obj for obj in found.values() if mover in armatures_above(obj)] if mover else []
    kept = kept or [_choose(meshes.values(), argument, tuple(meshes))]
    for obj in kept:
        _link(obj)
    for obj in found.values():
        if not obj.users_collection:
            bpy.data.objects.remove(obj)
    view_layer_of(bpy.context).update()
    return side_of(mover or kept[0], view_layer_of(bpy.context))


def _only_mover(objects: Iterable[bpy.types.Object]) -> bpy.types.Object | None:
    """Return the only armature of some objects; None if there are more, or none."""
    armatures = [obj for obj in objects if obj.type == "ARMATURE"]
    return armatures[0] if len(armatures) == 1 else None


def _only_character(argument: MeshArgument, objects: Collection[bpy.types.Object]) -> Side | None:
    """Return what the only armature moves, if no name is given and it is not a matter of one mesh."""
    mover = _only_mover(objects)
    if argument.name or mover is None or sum(obj.type == "MESH" for obj in objects) == 1:
        return None
    return side_of(mover, view_layer_of(bpy.context))


def _link(obj: bpy.types.Object) -> None:
    """Put an object into the scene, with all that it depends on."""
    collection = cast("bpy.types.Scene", bpy.context.scene).collection
    needed = [obj]
    for one in needed:  # grows on the way
        if one.name not in collection.objects:
            collection.objects.link(one)
        used = [one.parent, *(getattr(modifier, "object", None) for modifier in one.modifiers)]
        needed += [other for other in used if other is not None and other not in needed]


def _choose(meshes: Iterable[bpy.types.Object], argument: MeshArgument, names: Sequence[str] = ()) -> bpy.types.Object:
    """Return the mesh that is named, or the only one; `names` are those in the file, if they are others now."""
    objects = list(meshes)
    names = names or [obj.name for obj in objects]
    if argument.name:
        for name, obj in zip(names, objects, strict=True):
            if name == argument.name:
                return obj
    elif len(objects) == 1:
        return objects[0]
    raise ObjectError(_open_choice(argument, names))


def _chosen_of_import(
    added: Mapping[bpy.types.Object, str], argument: MeshArgument, notes: list[str], *, whole: bool
) -> Side:
    """Return what is named of an import, or the character of the mesh with the most vertices."""
    bare = None if any(obj.type == "MESH" for obj in added) else _only_character(argument, added)
    found = _named(argument, added) or bare
    if found is not None:
        return found
    chosen = _choose_largest({obj: name for obj, name in added.items() if obj.type == "MESH"}, argument, notes)
    armature = next((obj for obj in added if obj.type == "ARMATURE" and obj in armatures_above(chosen)), None)
    if argument.name or armature is None or not whole:
        return chosen
    side = side_of(armature, view_layer_of(bpy.context))
    if len(parts_of(side)) > 1:
        notes[:] = [note for note in notes if f'"{chosen.name}"' not in note]
        notes.append(
            f'"{argument.path.name}" holds a character of {len(parts_of(side))} meshes on "{armature.name}", which was '
            "taken as a whole. Name a mesh behind a colon for it alone."
        )
    return side


def _choose_largest(
    meshes: Mapping[bpy.types.Object, str], argument: MeshArgument, notes: list[str]
) -> bpy.types.Object:
    """Return the mesh that is named, or the one with the most vertices."""
    if argument.name:
        for obj, name in meshes.items():
            if name == argument.name:
                return obj
    elif meshes:
        largest = max(meshes, key=lambda obj: len(mesh_of(obj).vertices))
        if len(meshes) > 1:
            notes.append(
                f'"{argument.path.name}" holds {len(meshes)} meshes. The largest was taken: "{largest.name}". '
                "Name another one behind a colon."
            )
        return largest
    raise ObjectError(_open_choice(argument, list(meshes.values())))


def _open_choice(argument: MeshArgument, names: Sequence[str]) -> str:
    """Say why no mesh could be chosen."""
    file = f'"{argument.path}"'
    if not names:
        return f"{file} holds no mesh with faces."
    listed = ", ".join(f'"{name}"' for name in names)
    if argument.name:
        return f'{file} has no mesh called "{argument.name}". It has {listed}.'
    return f"{file} holds {len(names)} meshes. Name one behind a colon: {listed}."
