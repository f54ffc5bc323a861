# SPDX-License-Identifier: GPL-3.0-or-later
"""Binding a mesh to an armature as another mesh is bound to its own."""

from __future__ import annotations

from typing import Any, cast

import bpy

from .armatures import armature_modifier, find_armature, moving_armatures

__all__ = ["bind", "made_rig", "mark_made"]

_MARKER = "hiermatch_rig_of"
"""Custom property of an armature object that was made for a mesh: the name of the armature it was made after."""

_OWN = frozenset({"name", "type", "object", "vertex_group", "show_expanded", "is_active", "execution_time"})
"""What a modifier does not take over from another."""


def mark_made(armature: bpy.types.Object, source: bpy.types.Object) -> None:
    """Record that an armature object was made after another one."""
    cast("Any", armature)[_MARKER] = source.name


def made_rig(target: bpy.types.Object, source: bpy.types.Object) -> bpy.types.Object | None:
    """Find the armature that moves `target`, or is its parent, and was made after the armature `source`."""
    candidates: list[Any] = [*moving_armatures(target), target.parent]
    for armature in candidates:
        if armature is None or armature.type != "ARMATURE" or armature == source or _MARKER not in armature:
            continue
        # One made after an armature that was renamed or deleted since is meant as well.
        named = bpy.data.objects.get(armature[_MARKER])
        if named in (source, None) and armature.library is None and armature.data.library is None:
            return armature
    return None


def bind(target: bpy.types.Object, armature: bpy.types.Object, source: bpy.types.Object) -> list[str]:
    """Let an armature move a mesh with a modifier set as the source's, and be its parent if the source's is.

    The mesh stays where it is.  Other modifiers and another parent stay.

    Returns
    -------
    list of str
        What is to be known, one sentence each.
    """
    notes = []
    modifier: Any = next((one for one in target.modifiers if getattr(one, "object", None) == armature), None)
    if modifier is None:
        modifier = target.modifiers.new("Armature", "ARMATURE")
        _take_settings(modifier, armature_modifier(source), target)
        modifier.object = armature
        target.modifiers.move(len(target.modifiers) - 1, 0)
    others = [other.name for other in moving_armatures(target) if other != armature]
    if others:
        notes.append(
            f'"{target.name}" is moved by the armature "{others[0]}" as well. Remove that Armature modifier unless '
            "both are meant to move it."
        )
    if source.parent is None or source.parent != find_armature(source) or target.parent == armature:
        return notes
    if target.parent is not None:
        notes.append(f'"{target.name}" keeps its parent "{target.parent.name}".')
        return notes
    target.parent = armature
    target.matrix_parent_inverse = armature.matrix_world.inverted_safe()
    return notes


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
