# SPDX-License-Identifier: GPL-3.0-or-later
"""Binding a mesh or a character to an armature as another is bound to its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy
from mathutils import Matrix

from ..common.phrases import listed
from .armatures import armature_modifier, armature_of, find_armature, moving_armatures
from .bone_constraints import displaced_bones
from .character import FITTED_TO, parts_of, take_place
from .mesh_io import rest_matrix

if TYPE_CHECKING:
    from collections.abc import Container, Iterable

    from .character import Side

_MARKER = "hiermatch_rig_of"
"""Custom property of an armature object that was made for a mesh: the name of the armature it was made after."""

_OWN = frozenset({"name", "type", "object", "vertex_group", "show_expanded", "is_active", "execution_time"})
"""What a modifier does not take over from another."""


def mark_made(armature: bpy.types.Object, source: bpy.types.Object) -> None:
    """Record that an armature object was made after another one."""
    cast("Any", armature)[_MARKER] = source.name


def is_made(armature: bpy.types.Object) -> bool:
    """Tell whether an armature object was made after another one."""
    return _MARKER in cast("Any", armature)


def made_rig(target: Side, source: bpy.types.Object) -> bpy.types.Object | None:
    """Find the armature that moves `target`, or is its parent, and was made after the armature `source`."""
    candidates: list[Any] = [*moving_armatures(target), *(part.parent for part in parts_of(target))]
    for armature in candidates:
        if armature is None or armature.type != "ARMATURE" or armature == source or _MARKER not in armature:
            continue
        # One made after an armature that was renamed or deleted since is meant as well.
        named = bpy.data.objects.get(armature[_MARKER])
        if named in (source, None) and armature.library is None and armature.data.library is None:
            return armature
    return None


def hang_in_place(armature: bpy.types.Object, target: Side, kept: Container[bpy.types.Object] | None = None) -> None:
    """Let a new armature hang on what all of a side hangs on, such as the empty above an imported character.

    So who moves that moves the armature with the side.  It stays where it is.

    Parameters
    ----------
    armature : bpy.types.Object
        The new armature, which hangs on nothing.
    target : bpy.types.Object or Character
        What it is to move.
    kept : container of bpy.types.Object or None
        Armatures that go on moving the target as well; in the place of all others comes the new one, see `unbind`.
        None for all.
    """
    parts = parts_of(target)
    above = [[one for one in _above(part) if one not in parts] for part in parts]
    for other in above[0]:
        if _is_replaced(other, armature, kept) or any(other not in others for others in above):
            continue
        if other.type == "ARMATURE":
            return
        stands = armature.matrix_world.copy()
        armature.parent, armature.parent_type = other, "OBJECT"
        armature.matrix_parent_inverse = other.matrix_world.inverted_safe()
        armature.matrix_world = stands
        return


def bind(
    target: Side, armature: bpy.types.Object, source: Side, kept: Container[bpy.types.Object] | None = None
) -> list[str]:
    """Let an armature move all of a side with modifiers set as the source's, and be the parent if the source's is.

    The target stays where it is.  Other modifiers stay, and so does another parent, but for empties that stand still
    and hold the armature as well.

    Parameters
    ----------
    target : bpy.types.Object or Character
        What is bound.
    armature : bpy.types.Object
        What is to move it.
    source : bpy.types.Object or Character
        What is bound as the target shall be.
    kept : container of bpy.types.Object or None
        Armatures that go on moving the target as well; all others are unbound, see `unbind`.  None for all.

    Returns
    -------
    list of str
        What is to be known, one sentence each.
    """
    model = next((part for part in parts_of(source) if armature_modifier(part)), parts_of(source)[0])
    parented = any(part.parent is not None and part.parent == find_armature(source) for part in parts_of(source))
    others: dict[str, list[str]] = {}
    parents: dict[str, list[str]] = {}
    for part in parts_of(target):
        own = [one for one in part.modifiers if one.type == "ARMATURE" and cast("Any", one).object == armature]
        if not own:
            _add_modifier(part, armature, armature_modifier(model))
        elif not any(one.show_viewport for one in own):  # switched off by hand since
            own[0].show_viewport = own[0].show_render = True
        for other in moving_armatures(part)[:2]:
            if other != armature and (kept is None or other in kept):
                others.setdefault(other.name, []).append(part.name)
        if not parented or part.parent in (armature, *parts_of(target)) or _is_replaced(part.parent, armature, kept):
            continue
        if part.parent is not None and not _is_held_by(armature, part):
            parents.setdefault(part.parent.name, []).append(part.name)
            continue
        _hang(part, armature)
    notes = []
    for rig, names in others.items():
        notes.append(
            f'{listed(names)} is moved by the armature "{rig}" as well. Remove that Armature modifier unless both '
            "are meant to move it."
        )
    for name, names in parents.items():
        notes.append(f'{listed(names)} keeps its parent "{name}".')
    return notes


def hand_over(part: bpy.types.Object, other: Side) -> None:
    """Let an armature of another side move a part in the place of its own, if it has all bones that move it.

    So what has been laid onto a character that got the part's rig moves as that one does.  It stays where it is.
    """
    modifier = armature_modifier(part)
    own: Any = part.parent if modifier is None else modifier.object
    if own is None or own.type != "ARMATURE":
        return
    bones = own.data.bones
    used = [part.parent_bone] if modifier is None else [name for name in part.vertex_groups.keys() if name in bones]  # noqa: SIM118
    for armature in moving_armatures(other):
        if armature == own or not used or not all(name in armature_of(armature).bones for name in used):
            continue
        for one in part.modifiers:
            if getattr(one, "object", None) == own:
                cast("Any", one).object = armature
        if part.parent == own:
            stands = part.matrix_world.copy()
            part.parent = armature
            part.matrix_world = stands
        return


def unbind(
    target: Side, armature: bpy.types.Object, kept: Container[bpy.types.Object] | None
) -> list[bpy.types.Object]:
    """Let no other armatures move a side than one and those to keep; None for all.

    Their modifiers are switched off, and what hangs on them, hangs on the new one, where it stands while they are at
    rest: that is how the vertices of a mesh belong to its armature.  What then moves nothing any more is hidden.  The
    new one takes the place of such, and of those that only move what was fitted to the side.

    Returns
    -------
    list of bpy.types.Object
        The armatures that moved it.
    """
    found: list[bpy.types.Object] = []
    for part in parts_of(target):
        for modifier in part.modifiers:
            other = getattr(modifier, "object", None) if modifier.type == "ARMATURE" else None
            if _is_replaced(other, armature, kept) and (modifier.show_viewport or modifier.show_render):
                modifier.show_viewport = modifier.show_render = False
                found.append(cast("bpy.types.Object", other))
        if _is_replaced(part.parent, armature, kept):
            found.append(cast("bpy.types.Object", part.parent))
            _hang(part, armature)
    unique = list(dict.fromkeys(found))
    for other in unique:
        moved = _moved_by(other)
        if all(FITTED_TO in cast("Any", one) for one in moved):  # what a body wears is no part of it
            take_place(other, armature)
        if not moved and other.visible_get():
            other.hide_set(state=True)
    return unique


def replaced_remarks(target: Side, armatures: Iterable[bpy.types.Object]) -> list[str]:
    """Return what to say of armatures that `unbind` has taken from a side, and of what they still move."""
    said = []
    for other in armatures:
        said.append(
            f'"{target.name}" is no longer moved by its own armature "{other.name}", whose Armature modifiers are '
            "switched off."
        )
        worn = worn_with(other)
        if worn:
            said.append(f'What it wears is still moved by "{other.name}": {listed(worn)}. Fit it again by Wear.')
    return said


def lost_poses(target: Side, armatures: Iterable[bpy.types.Object]) -> list[str]:
    """Return what to say of poses in which armatures had a side that `unbind` has taken from them."""
    return [
        f'"{other.name}" had "{target.name}" posed. That pose was left out: the rest pose of its own armature counts. '
        "To keep the pose instead, undo, apply that Armature modifier, and fit the rig again."
        for other in armatures
        if displaced_bones(other)
    ]


def worn_with(armature: bpy.types.Object) -> list[str]:
    """Return the names of what was fitted to a body, and is moved by an armature."""
    return [one.name for one in _moved_by(armature) if FITTED_TO in cast("Any", one)]


def _above(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """Return what an object hangs on as a whole, what that hangs on, and so on, up to what hangs on a part of one."""
    found: list[bpy.types.Object] = []
    while obj.parent is not None and (obj.parent_type == "OBJECT" or obj.parent.type == "ARMATURE"):
        obj = obj.parent
        found.append(obj)
    return found


def _is_held_by(armature: bpy.types.Object, part: bpy.types.Object) -> bool:
    """Tell whether a part hangs on what an armature hangs on, with nothing between but empties that stand still."""
    for other in _above(part):
        if other == armature.parent:
            return True
        if other.type != "EMPTY" or other.animation_data is not None or len(other.constraints):
            return False
    return False


def _hang(part: bpy.types.Object, armature: bpy.types.Object) -> None:
    """Hang a part on an armature as a whole, where it stands while what it hung on is at rest.

    Its own location, turn and scale stay, which could not say how it stands where it was sheared by what it hung on.
    """
    rest = rest_matrix(part)
    if rest is not None:
        place = rest @ part.matrix_basis.inverted_safe()
    elif part.parent is not None:
        place = part.parent.matrix_world @ part.matrix_parent_inverse
    else:
        place = Matrix.Identity(4)
    part.parent, part.parent_type = armature, "OBJECT"
    part.matrix_parent_inverse = armature.matrix_world.inverted_safe() @ place


def _moved_by(armature: bpy.types.Object) -> list[bpy.types.Object]:
    """Return all meshes that an armature moves, or that hang on it."""
    meshes = [obj for obj in bpy.data.objects if obj.type == "MESH"]
    return [obj for obj in meshes if armature in (obj.parent, *moving_armatures(obj))]


def _is_replaced(
    other: bpy.types.Object | None, armature: bpy.types.Object, kept: Container[bpy.types.Object] | None
) -> bool:
    """Tell whether something is an armature in whose place another one comes."""
    return (
        other is not None and other.type == "ARMATURE" and other != armature and kept is not None and other not in kept
    )


def _add_modifier(part: bpy.types.Object, armature: bpy.types.Object, model: Any) -> None:  # noqa: ANN401 - see below
    """Let an armature move a part as a modifier says; one whose own armature was deleted is used again."""
    modifiers: Any = part.modifiers
    left = next((one for one in modifiers if one.type == "ARMATURE" and one.object is None), None)
    if left is None:
        place = _place_among([one.type for one in modifiers])
        left = modifiers.new("Armature", "ARMATURE")
        modifiers.move(len(modifiers) - 1, place)
    _take_settings(left, model, part)
    left.object = armature


def _place_among(kinds: list[str]) -> int:
    """Say before which modifier an Armature modifier belongs: where one is, else first, but after what mirrors."""
    if "ARMATURE" in kinds:
        return kinds.index("ARMATURE")
    return max((number + 1 for number, kind in enumerate(kinds) if kind == "MIRROR"), default=0)


def _take_settings(modifier: Any, model: Any, target: bpy.types.Object) -> None:  # noqa: ANN401 - Armature modifiers
    """Set a modifier as another one, if there is one."""
    if model is None:
        return
    modifier.name = model.name
    for prop in model.bl_rna.properties:
        if not prop.is_readonly and prop.identifier not in _OWN:
            setattr(modifier, prop.identifier, getattr(model, prop.identifier))
    if model.vertex_group in target.vertex_groups:
        modifier.vertex_group = model.vertex_group
