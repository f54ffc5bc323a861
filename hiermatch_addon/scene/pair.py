# SPDX-License-Identifier: GPL-3.0-or-later
"""The two objects or characters to match, and the checks that they can be matched."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy
import numpy as np

from ..common.access import mesh_of, view_layer_of
from ..common.errors import ObjectError, SharedMeshError
from ..common.phrases import listed
from ..common.translated_text import translated
from .character import Character, armatures_above, joined, parts_of, side_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .character import Side

_PLUS = " + "
"""What stands between the names of several objects."""


def find_pair(
    context: bpy.types.Context,
    names: tuple[str, str] = ("", ""),
    picked: tuple[bpy.types.ID | Character | None, bpy.types.ID | Character | None] = (None, None),
) -> tuple[Side, Side]:
    """Find source and target: by name, else as picked, else as selected.

    Of what is selected, the source is what hangs on the rig of the active object, or the active object alone if it has
    none; the target is the rest.

    Raises
    ------
    ObjectError
        If a name is unknown, or the selection leaves open which two are meant.
    """
    layer = view_layer_of(context)
    source, target = (
        named_side(layer, name) if name else None if pick is None else side_of(pick, layer)
        for name, pick in zip(names, picked, strict=True)
    )
    active = layer.objects.active
    taken = () if target is None else parts_of(target)
    if source is None and active is not None and active.select_get() and active not in taken:
        source = active_side(context, without=target) or active
    if source is None:
        source = _only(selected_meshes(context, without=target), "Source")
    if target is None:
        target = _only(selected_targets(context, source)[0], "Target")
    return source, target


def named_object(name: str) -> bpy.types.Object:
    """Return the object of that name.

    Raises
    ------
    ObjectError
        If there is none.
    """
    obj = _called(name)
    if obj is None:
        raise ObjectError(f'There is no object called "{name}".')
    return obj


def _called(name: str) -> bpy.types.Object | None:
    """Return the object of that name, or of that full name, see `name_of`."""
    every = bpy.data.objects
    return every.get(name) or next((obj for obj in every if obj.name_full == name), None)


def named_side(view_layer: bpy.types.ViewLayer, name: str) -> Side:
    """Return what is meant by the name of an object or, if there is none of that name, of a collection.

    Several objects are named with " + " between their names.

    Raises
    ------
    ObjectError
        If there is neither, or it holds no meshes.
    """
    obj = _called(name)
    if obj is not None:
        return side_of(obj, view_layer)
    if name in bpy.data.collections:
        return side_of(bpy.data.collections[name], view_layer)
    sides = [side_of(obj, view_layer) for obj in _listed_objects(name.split(_PLUS))]
    return joined(sides[0].name, [part for side in sides for part in parts_of(side)])


def _listed_objects(pieces: Sequence[str]) -> list[bpy.types.Object]:
    """Return the objects whose names, one after the other, were split up; a name of several pieces goes before others.

    Raises
    ------
    ObjectError
        If there is none of a name.
    """
    for count in range(len(pieces), 0, -1):
        obj = _called(_PLUS.join(pieces[:count]))
        if obj is not None:
            return [obj, *_listed_objects(pieces[count:])]
    return [named_object(pieces[0])] if pieces else []


def name_of(view_layer: bpy.types.ViewLayer, side: Side) -> str:
    """Return the name by which `named_side` finds a side again.

    Of objects that have one name, those of other files are called by their full names: "Cube [other.blend]".
    """
    if isinstance(side, Character):
        try:
            same = named_side(view_layer, side.name) == side
        except ObjectError:
            same = False
        return side.name if same else _PLUS.join(name_of(view_layer, part) for part in side.parts)
    return side.name if bpy.data.objects.get(side.name) == side else side.name_full


def selected_meshes(context: bpy.types.Context, without: Side | None = None) -> list[bpy.types.Object]:
    """Return the selected mesh objects except for those of one side."""
    apart = () if without is None else parts_of(without)
    return [obj for obj in view_layer_of(context).objects.selected if obj.type == "MESH" and obj not in apart]


def active_side(context: bpy.types.Context, without: Side | None = None) -> Side | None:
    """Return what is active: with a rig, all that is selected of what hangs on the rig; of an armature alone, all.

    So it is with an empty and what hangs on that.  None if nothing is active, or it is nothing of these, or part of the
    side `without`.
    """
    active = view_layer_of(context).objects.active
    if active is None or (without is not None and active in parts_of(without)):
        return None
    if active.type == "EMPTY":
        below = set(active.children_recursive)
        parts = [obj for obj in selected_meshes(context, without) if obj in below]
        found = joined(active.name, parts) if parts else side_of(active, view_layer_of(context))
        return None if found == active else found
    if active.type not in ("MESH", "ARMATURE"):
        return None
    rig = armatures_above(active)
    parts = [obj for obj in selected_meshes(context, without) if not rig.isdisjoint(armatures_above(obj))]
    if active.type == "ARMATURE":
        return joined(active.name, parts) if parts else side_of(active, view_layer_of(context))
    return joined(_rig_name(active), [active, *parts])


def selected_targets(context: bpy.types.Context, source: Side) -> tuple[list[Side], list[bpy.types.Object]]:
    """Return what is selected and may be a target, and the meshes that are parts of the source's own character.

    The latter hang on the armature that moves the source, as clothes, hair and eyes do.  What hangs on another rig is
    one target, and so are meshes without a rig that have the same topmost parent, or fill a collection of their own.

    Raises
    ------
    ObjectError
        If there are parts only.
    """
    own = parts_of(source)
    rig = {armature for part in own for armature in armatures_above(part)}
    meshes: list[bpy.types.Object] = []
    parts: list[bpy.types.Object] = []
    for obj in selected_meshes(context, without=source):
        (meshes if rig.isdisjoint(armatures_above(obj)) else parts).append(obj)
    targets = _grouped(context, meshes, own)
    for obj in view_layer_of(context).objects.selected:
        if obj.type == "ARMATURE" and obj not in rig and not any(obj in armatures_above(mesh) for mesh in meshes):
            targets.append(side_of(obj, view_layer_of(context)))
    targets += _held_by_empties(context, {*own, *rig, *meshes})
    same = parts or [part for part in own if len(own) > 1 and part.select_get()]
    if same and not targets:
        raise ObjectError(
            f'All that is selected is moved by the same rig as "{own[0].name}": {_names(same)}. Select a mesh of '
            "another character, or pick the part as the Target in the panel if it is meant."
        )
    return targets, parts


def _held_by_empties(context: bpy.types.Context, apart: set[bpy.types.Object]) -> list[Side]:
    """Return what hangs on selected empties, unless something of that is selected itself, or one of those `apart`."""
    layer = view_layer_of(context)
    selected = {obj for obj in layer.objects.selected if obj.type in ("MESH", "ARMATURE")}
    below = {obj: set(obj.children_recursive) for obj in layer.objects.selected if obj.type == "EMPTY"}
    below = {obj: held for obj, held in below.items() if held.isdisjoint(selected) and held.isdisjoint(apart)}
    outer = [obj for obj in below if not any(obj in held for held in below.values())]
    return [side for obj in outer if (side := side_of(obj, layer)) != obj]


def _grouped(
    context: bpy.types.Context, meshes: Sequence[bpy.types.Object], own: Sequence[bpy.types.Object]
) -> list[Side]:
    """Put meshes together that are one character, in the order of the first of each; `own` are the source's."""
    groups: list[tuple[set[bpy.types.ID], str, list[bpy.types.Object]]] = []
    for obj in meshes:
        holders, name = _holders(context, obj, meshes, own)
        met = [group for group in groups if not group[0].isdisjoint(holders)]
        for also, _, _ in met:
            holders |= also
        together = [part for _, _, parts in met for part in parts]
        groups = [group for group in groups if group not in met]
        groups.append((holders, met[0][1] if met else name, [*together, obj]))
    return [joined(name, found) for _, name, found in groups]


def _holders(
    context: bpy.types.Context,
    obj: bpy.types.Object,
    meshes: Sequence[bpy.types.Object],
    own: Sequence[bpy.types.Object],
) -> tuple[set[bpy.types.ID], str]:
    """Return what holds an object together with others: its armatures, else its topmost parent, else a collection."""
    holders: set[bpy.types.ID] = set(armatures_above(obj))
    if holders:
        return holders, _rig_name(obj)
    top = obj
    while top.parent is not None:
        top = top.parent
    if top != obj or any(other.parent == obj for other in meshes):
        return {top}, top.name
    root = cast("bpy.types.Scene", context.scene).collection
    for collection in obj.users_collection:
        held = {other for other in collection.all_objects if other.type == "MESH" and other.visible_get()}
        if collection != root and held <= set(meshes) and held.isdisjoint(own):
            return {collection}, collection.name
    return {obj}, obj.name


def _rig_name(obj: bpy.types.Object) -> str:
    """Name the character that an object is of: as the first armature that is found from it, else as itself."""
    found = sorted(armature.name for armature in armatures_above(obj))
    return found[0] if found else obj.name


def left_out_note(source: Side, parts: Sequence[bpy.types.Object]) -> str:
    """Say that selected parts of the source's own character were left out."""
    return f'What the rig of "{source.name}" moves as well was left alone: {_names(parts)}.'


def _names(objects: Sequence[bpy.types.Object]) -> str:
    return listed(sorted(obj.name for obj in objects))


def _only(candidates: Sequence[Side], role: str) -> Side:
    """Return the only candidate for a role."""
    if len(candidates) != 1:
        found = "no other mesh is selected" if not candidates else f"{len(candidates)} other meshes are selected"
        raise ObjectError(
            f"It is open which mesh is the {role}: {found}. "
            "Select exactly two meshes (the active one is the Source), or pick Source and Target in the panel."
        )
    return candidates[0]


def check_pair(
    view_layer: bpy.types.ViewLayer | None, source: Side, target: Side, *, writes: tuple[bool, bool] = (True, True)
) -> None:
    """Make sure that two sides can be matched, and those written to that it `writes`; see `check_object`.

    Raises
    ------
    ObjectError
        If one of them, or both together, cannot; the message says why and what to do.
    """
    if source == target:
        raise ObjectError(f'Source and Target are both "{source.name}". Choose two different objects.')
    for side, writable in zip((source, target), writes, strict=True):
        check_side(view_layer, side, writable=writable)
    for mine in parts_of(source):
        for other in parts_of(target):
            if mine == other:
                raise ObjectError(
                    f'"{mine.name}" belongs to both Source and Target. Choose two characters that share no object.'
                )
            if mine.data == other.data:
                raise ObjectError(
                    f'"{mine.name}" and "{other.name}" share the same mesh data. Give one of them its own first '
                    "(Object > Relations > Make Single User > Object & Data)."
                )


def check_side(view_layer: bpy.types.ViewLayer | None, side: Side, *, writable: bool = True) -> None:
    """Make sure that all parts of a side can be read and, if they are to be `writable`, written to; see `check_object`.

    Raises
    ------
    ObjectError
        If one cannot, or two share one mesh.
    """
    seen: dict[bpy.types.ID, str] = {}
    for part in parts_of(side):
        check_object(view_layer, part, writable=writable)
        mesh = mesh_of(part)
        if mesh in seen:
            raise ObjectError(
                f'"{seen[mesh]}" and "{part.name}" share the same mesh data. Give one of them its own first '
                "(Object > Relations > Make Single User > Object & Data)."
            )
        seen[mesh] = part.name


def check_object(view_layer: bpy.types.ViewLayer | None, obj: bpy.types.Object, *, writable: bool = True) -> None:
    """Make sure that an object can be read and, if it is to be `writable`, written to.

    To begin with, it has to be shown in a view layer.  At the end of work, for which None stands, it may be hidden, or
    in another scene: who looks at something else meanwhile shall not lose the work.

    Raises
    ------
    ObjectError
        If it cannot.
    """
    _check_type(obj)
    if writable:
        check_writable(obj)
    if view_layer is not None:
        _check_shown(view_layer, obj)
    elif not obj.users_scene:
        raise ObjectError(f'"{obj.name}" is in no scene any more.')
    check_mode(obj)
    if not len(mesh_of(obj).polygons):
        raise ObjectError(f'"{obj.name}" has no faces. A surface is needed, not only vertices or edges.')
    scale = np.linalg.norm(np.array(obj.matrix_world)[:3, :3], axis=0)
    flat = [axis for axis, length in zip("XYZ", scale, strict=True) if not length > 0]
    if flat:
        raise ObjectError(f'"{obj.name}" has a scale of zero on {" and ".join(flat)}. Set its scale to 1 (Alt+S).')


def _check_shown(view_layer: bpy.types.ViewLayer, obj: bpy.types.Object) -> None:
    if obj not in list(view_layer.objects):  # by its name there may be another one, of another file
        raise ObjectError(
            f'"{obj.name}" is not in the view layer "{view_layer.name}". Link it to the scene, or enable its '
            "collection in the Outliner."
        )
    if obj.hide_viewport:
        raise ObjectError(
            f'"{obj.name}" is disabled in viewports. Enable it with the screen beside its name in the Outliner.'
        )
    if obj.hide_get(view_layer=view_layer):
        raise ObjectError(f'"{obj.name}" is hidden. Show it first (Object > Show/Hide, or the eye in the Outliner).')
    if not obj.visible_get(view_layer=view_layer):
        raise ObjectError(
            f'"{obj.name}" is not shown: its collection is hidden or disabled in viewports, or it is outside of Local '
            "View. Show its collection in the Outliner, or leave Local View (View > Local View)."
        )


def lacking_meshes(view_layer: bpy.types.ViewLayer) -> str:
    """Say that a view layer has not the two meshes that it takes to match; empty if it has."""
    if sum(obj.type == "MESH" for obj in view_layer.objects) >= 2:
        return ""
    if any(obj.type == "EMPTY" and obj.instance_collection is not None for obj in view_layer.objects):
        return translated(
            "Two mesh objects are needed in this view layer. Make library overrides of what instances show, or make it "
            "real"
        )
    return translated("Two mesh objects are needed in this view layer")


def _check_type(obj: bpy.types.Object) -> None:
    """Make sure that an object is a mesh."""
    if obj.type == "ARMATURE":
        raise ObjectError(
            f'The armature "{obj.name}" moves no mesh with faces that is shown in this view layer. Show its meshes, or '
            "choose another one."
        )
    if obj.type == "EMPTY" and obj.instance_collection is not None:
        raise ObjectError(
            f'"{obj.name}" is no mesh but shows the collection "{obj.instance_collection.name}". Make its objects '
            "editable (Object > Library Override > Make, or Object > Apply > Make Instances Real), and choose one of "
            "them."
        )
    if obj.type != "MESH":
        raise ObjectError(
            f'"{obj.name}" is not a mesh but of type {obj.type.title()}. Choose a mesh object, or convert it '
            "(Object > Convert > Mesh)."
        )


def check_mode(obj: bpy.types.Object) -> None:
    """Make sure that neither a mesh object nor another one with its mesh is being edited or painted.

    Raises
    ------
    ObjectError
        If one is.
    """
    if obj.mode != "OBJECT":
        raise ObjectError(f'"{obj.name}" is in {_title(obj.mode)} Mode. Switch to Object Mode first.')
    if mesh_of(obj).is_editmode:
        raise ObjectError(
            f'"{obj.name}" shares its mesh with an object in Edit Mode. Switch to Object Mode there first.'
        )


def is_own(side: Side) -> bool:
    """Tell whether all parts of a side are this file's own, neither linked nor overridden."""
    owners = [owner for part in parts_of(side) for owner in (part, part.data)]
    return all(owner is not None and owner.library is None and owner.override_library is None for owner in owners)


def check_writable(obj: bpy.types.Object) -> None:
    """Make sure that a mesh object is this file's own.

    Raises
    ------
    ObjectError
        If it or its mesh is linked from another file.
    """
    mesh = mesh_of(obj)
    library = obj.library or mesh.library
    if library is not None:
        raise ObjectError(
            f'"{obj.name}" is linked from "{library.name}" and cannot be written to. Make object and data local '
            "first (Object > Relations > Make Local). As the Source of Retarget, Wear and Motion it can stay as it is."
        )
    if obj.override_library is not None or mesh.override_library is not None:
        raise ObjectError(
            f'"{obj.name}" is a library override and cannot be written to. Make object and data local first '
            "(Object > Relations > Make Local). As the Source of Retarget, Wear and Motion it can stay as it is."
        )


def is_shared(obj: bpy.types.Object) -> bool:
    """Tell whether other objects have the same mesh."""
    mesh = mesh_of(obj)
    return mesh.users - int(mesh.use_fake_user) > 1


def check_own_mesh(obj: bpy.types.Object) -> None:
    """Make sure that no other object has the same mesh.

    Raises
    ------
    SharedMeshError
        If one has.
    """
    if is_shared(obj):
        raise SharedMeshError(
            f'"{obj.name}" shares its mesh with other objects, which would change with it. Give it its own mesh first '
            "(Object > Relations > Make Single User > Object & Data)."
        )


def _title(mode: str) -> str:
    return mode.replace("_", " ").title()
