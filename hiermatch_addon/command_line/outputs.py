# SPDX-License-Identifier: GPL-3.0-or-later
"""Results into files, by the ending of their names."""

from __future__ import annotations

import argparse
import tempfile
from os.path import realpath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import bpy

from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..common.file_writing import beside, check_place, check_whole
from ..common.phrases import listed
from ..scene.character import parts_of
from ..scene.motion.nla_strips import add_tracks
from ..scene.motion.rigs import rig_of
from ..scene.worn.fitted_copies import fitted_to
from .meshes import has_operator
from .operator_errors import said_by

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..scene.character import Side

_EXPORTERS: Final[dict[str, tuple[str, dict[str, Any]]]] = {
    ".obj": ("wm.obj_export", {"export_selected_objects": True, "apply_modifiers": False, "path_mode": "ABSOLUTE"}),
    ".ply": ("wm.ply_export", {"export_selected_objects": True, "apply_modifiers": False}),
    ".stl": ("wm.stl_export", {"export_selected_objects": True, "apply_modifiers": False}),
    ".fbx": ("export_scene.fbx", {"use_selection": True, "add_leaf_bones": False, "bake_anim": False}),
    ".glb": ("export_scene.gltf", {"use_selection": True, "export_format": "GLB", "export_animations": False}),
    ".gltf": (
        "export_scene.gltf",
        {"use_selection": True, "export_format": "GLTF_SEPARATE", "export_animations": False},
    ),
}
"""For each kind of file the operator that writes it, and with which options: what is selected, as it is."""

_MOVING: Final[dict[str, dict[str, Any]]] = {
    ".fbx": {"bake_anim": True, "bake_anim_use_nla_strips": True, "bake_anim_use_all_actions": False},
    ".glb": {"export_animations": True, "export_animation_mode": "NLA_TRACKS"},
    ".gltf": {"export_animations": True, "export_animation_mode": "NLA_TRACKS"},
}
"""For each kind of file that can hold motion its options for that: each track of the NLA editor is a clip."""

KINDS: Final = (".blend", *_EXPORTERS)
"""The kinds of files that can be written."""

MOVING_KINDS: Final = (".blend", *_MOVING)
"""Those of them that can hold motion."""


def output_argument(kinds: Sequence[str]) -> Callable[[str], Path]:
    """Make what reads the name of a file to write, of one of some kinds; of another, it raises an ArgumentTypeError."""

    def parse(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in kinds:
            raise argparse.ArgumentTypeError(f'"{text}" does not end with {", ".join(kinds)}')
        return path

    return parse


def save(
    path: Path,
    side: Side,
    clips: Sequence[bpy.types.Action] = (),
    along: Sequence[bpy.types.Object] = (),
) -> None:
    """Write the whole scene into a .blend, or a side with its armatures and clothes into another kind of file.

    There, `clips` of its armature go along, and what its armature plays otherwise; so do the objects that are `along`.

    Raises
    ------
    ObjectError
        If that fails; a file that was there before is still there then.
    """
    path = path.absolute()
    try:
        if path.suffix.lower() == ".blend":
            with beside(path) as temporary:
                bpy.ops.wm.save_as_mainfile(filepath=str(temporary), copy=True, check_existing=False)
                check_whole(temporary)
        else:
            _select(side, along)
            if clips:
                add_tracks(rig_of(side), clips)
            _export(path, moving=bool(clips))
    except RuntimeError as error:
        raise ObjectError(f'"{path}" cannot be written: {said_by(error)}') from error


def _select(side: Side, along: Sequence[bpy.types.Object]) -> None:
    """Select the objects of a side, the armatures that move them, what was fitted to them and what goes `along`.

    Of what was fitted that which is hidden stays out, as copies that were kept aside are.  So does an armature that
    gave way to another one: exporters do not see that its modifiers are switched off.

    Raises
    ------
    ObjectError
        If anything else cannot be selected.
    """
    layer, parts = view_layer_of(bpy.context), parts_of(side)
    movers = [obj.parent for obj in parts]
    live = [one for obj in parts for one in obj.modifiers if one.show_viewport or one.show_render]
    movers += [getattr(modifier, "object", None) for modifier in live]
    fitted = {item for body in (side, *parts) for item in fitted_to(body)}
    wanted = [*parts, *along, *(mover for mover in movers if mover is not None and mover.type == "ARMATURE")]
    layer.update()
    for other in list(layer.objects):
        if other in wanted:
            other.hide_set(state=False)
            if other.library is None:
                other.hide_viewport = other.hide_select = False
        other.select_set(other in wanted or other in fitted)
    if lost := [obj.name for obj in dict.fromkeys(wanted) if not obj.select_get()]:
        raise ObjectError(f"{listed(lost)} cannot be written while hidden. Show the collection in the Outliner.")
    layer.objects.active = parts[0]


def _export(path: Path, *, moving: bool) -> None:
    """Write what is selected into a folder beside the file, and move all that was written to its place.

    Of a symbolic link that is where it leads to.
    """
    path = Path(realpath(path))
    name, options = _EXPORTERS[path.suffix.lower()]
    options = options | (_MOVING[path.suffix.lower()] if moving else {})
    if path.suffix.lower() == ".gltf":  # its textures are files, which others in the same folder may have as well
        options["export_texture_dir"] = f"{path.stem} textures"
    if not has_operator(name):
        raise ObjectError(
            f'This Blender cannot write "{path.name}". Enable the add-on that exports {path.suffix} files, or write '
            "another kind."
        )
    group, _, operator = name.partition(".")
    check_place(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".hiermatch-") as folder:
            getattr(getattr(bpy.ops, group), operator)(filepath=str(Path(folder, path.name)), **options)
            written = sorted(filter(Path.is_file, Path(folder).rglob("*")), key=lambda one: one.name == path.name)
            if not Path(folder, path.name).is_file():
                raise ObjectError(f'"{path}" cannot be written: Blender\'s exporter wrote nothing.')
            for one in written:
                check_whole(one)
            for one in written:  # the file itself last: when it is there, all is there
                place = path.parent / one.relative_to(folder)
                place.parent.mkdir(exist_ok=True)
                one.replace(place)
    except OSError as error:
        raise ObjectError(f'"{path}" cannot be written: {error.strerror or error}. Choose another place.') from error
