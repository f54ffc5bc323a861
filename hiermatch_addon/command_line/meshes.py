# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes from files: which file and object an argument means, and how it gets into Blender."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import bpy

from ..common.access import mesh_of, view_layer_of
from ..common.errors import ObjectError
from .operator_errors import said_by

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

__all__ = ["MeshArgument", "has_operator", "load_meshes", "mesh_argument"]

_IMPORTERS: Final[dict[str, tuple[str, ...]]] = {
    ".obj": ("wm.obj_import",),
    ".ply": ("wm.ply_import",),
    ".stl": ("wm.stl_import",),
    ".fbx": ("import_scene.fbx", "wm.fbx_import"),
    ".glb": ("import_scene.gltf",),
    ".gltf": ("import_scene.gltf",),
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
        The object in it; empty if there is only one mesh to choose.
    """

    path: Path
    name: str = ""

    def __str__(self) -> str:
        return f"{self.path}:{self.name}" if self.name else str(self.path)


def mesh_argument(text: str) -> MeshArgument:
    """Read FILE or FILE:OBJECT; both may contain colons.

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


def load_meshes(arguments: Sequence[MeshArgument]) -> tuple[list[bpy.types.Object], list[str]]:
    """Load meshes, of one or several files, into one scene.

    The first .blend among the files is opened as a whole; all else is added to it.

    Returns
    -------
    objects : list of bpy.types.Object
        For each argument its object.
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
    imported: dict[Path, list[bpy.types.Object]] = {}
    found: list[bpy.types.Object] = []
    notes: list[str] = []
    for argument in arguments:
        path = argument.path
        if path == opened:
            chosen = _choose(_scene_meshes(), argument)
        elif path.suffix.lower() == ".blend":
            chosen = _append(argument)
        else:
            if path not in imported:
                imported[path] = _import(path)
            chosen = _choose_largest(imported[path], argument, notes)
        found.append(chosen)
    context = bpy.context
    for obj in found:
        if obj.mode != "OBJECT":
            view_layer_of(context).objects.active = obj
            bpy.ops.object.mode_set(mode="OBJECT")
    view_layer_of(context).update()
    return found, notes


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


def _scene_meshes() -> list[bpy.types.Object]:
    return [obj for obj in view_layer_of(bpy.context).objects if obj.type == "MESH"]


def _import(path: Path) -> list[bpy.types.Object]:
    """Import a file and return its meshes."""
    name = next((name for name in _IMPORTERS[path.suffix.lower()] if has_operator(name)), None)
    if name is None:
        raise ObjectError(
            f'This Blender cannot read "{path.name}". Enable the add-on that imports {path.suffix} files, or convert '
            "the file."
        )
    group, _, operator = name.partition(".")
    before = set(bpy.data.objects)
    try:
        getattr(getattr(bpy.ops, group), operator)(filepath=str(path.resolve()))
    except RuntimeError as error:
        raise ObjectError(f'"{path}" cannot be read: {said_by(error)}') from error
    added = [obj for obj in bpy.data.objects if obj not in before]
    return [obj for obj in added if obj.type == "MESH" and len(mesh_of(obj).polygons)]


def _append(argument: MeshArgument) -> bpy.types.Object:
    """Append an object of another .blend, with its parents and what its modifiers use."""
    try:
        libraries: Any = bpy.data.libraries
        with libraries.load(str(argument.path.resolve()), link=False) as (there, here):
            names = [name for name in there.objects if argument.name in ("", name)]
            here.objects = list(names)
    except (OSError, RuntimeError) as error:
        raise ObjectError(f'"{argument.path}" cannot be opened: {said_by(error)}') from error
    if argument.name and not names:
        raise ObjectError(f'"{argument.path}" has no object called "{argument.name}".')
    loaded = cast("list[bpy.types.Object | None]", here.objects)
    meshes = {
        name: obj
        for name, obj in zip(names, loaded, strict=True)
        if obj is not None and obj.type == "MESH" and len(mesh_of(obj).polygons)
    }
    obj = _choose(meshes.values(), argument, tuple(meshes))
    _link(obj)
    return obj


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


def _choose_largest(meshes: Sequence[bpy.types.Object], argument: MeshArgument, notes: list[str]) -> bpy.types.Object:
    """Return the mesh that is named, or the one with the most vertices."""
    # A name that was taken in the scene has got a number.
    names = {obj: obj.name for obj in meshes}
    bare = {obj: obj.name.rpartition(".")[0] for obj in meshes}
    if argument.name:
        for called in (names, bare):
            for obj, name in called.items():
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
    raise ObjectError(_open_choice(argument, list(names.values())))


def _open_choice(argument: MeshArgument, names: Sequence[str]) -> str:
    """Say why no mesh could be chosen."""
    file = f'"{argument.path}"'
    if not names:
        return f"{file} holds no mesh with faces."
    listed = ", ".join(f'"{name}"' for name in names)
    if argument.name:
        return f'{file} has no mesh called "{argument.name}". It has {listed}.'
    return f"{file} holds {len(names)} meshes. Name one behind a colon: {listed}."
