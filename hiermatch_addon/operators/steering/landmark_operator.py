# SPDX-License-Identifier: GPL-3.0-or-later
"""Common base of the operators on the landmarks and matched points of two meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ...common.errors import ObjectError
from ...common.phrases import listed
from ...common.translated_text import translated
from ...properties.panel_state import pick, picked, state_of
from ...properties.steering_lists import sync_lists
from ...scene.character import Character, parts_of
from ...scene.pair import check_mode, check_writable, find_pair
from ...storage.landmarks import changed_for_others, read_marks
from ..pair_operator import PairOperator

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...scene.character import Side
    from ...storage.landmarks import Mark


def steerable_pair(context: bpy.types.Context, names: tuple[str, str] = ("", "")) -> tuple[Side, Side]:
    """Find the two sides that are meant: by name, else as picked in the panel, else as selected.

    Raises
    ------
    ObjectError
        If that leaves open which, or one of them is no mesh of this file's own, or is neither in Object Mode nor in
        Edit Mode itself.
    """
    state = state_of(context)
    source, target = find_pair(context, names, picked(state))
    meshes = [{part.data for part in parts_of(side)} for side in (source, target)]
    if source == target or meshes[0] & meshes[1]:
        raise ObjectError(
            f'Source and Target are both "{source.name}", or share the same mesh data. Choose two meshes of their own.'
        )
    for obj in (*parts_of(source), *parts_of(target)):
        if obj.type != "MESH":
            raise ObjectError(f'"{obj.name}" is not a mesh. Pick two mesh objects as Source and Target.')
        check_writable(obj)
        if obj.mode != "EDIT":
            check_mode(obj)
    return source, target


def pick_pair(context: bpy.types.Context, source: Side, target: Side) -> None:
    """Pick both sides in the panel where nothing is picked, so that it goes on showing what they have in common."""
    state = state_of(context)
    wanted = tuple(_handle(side) for side in (source, target))
    before = picked(state)
    if before[0] is None and before[1] in (None, wanted[1]):
        pick(state, "source", wanted[0])
    if before[1] is None and picked(state)[0] == wanted[0]:
        pick(state, "target", wanted[1])


def _handle(side: Side) -> bpy.types.ID | None:
    """Return what a side is picked by; None if it was selected part by part."""
    if not isinstance(side, Character):
        return side
    for kept in (bpy.data.objects, bpy.data.collections):
        found = cast("Any", kept).get(side.name)
        if found is not None:
            return cast("bpy.types.ID", found)
    return None


def told_of_others(pair: tuple[Side, Side], before: Sequence[dict[int, Mark]]) -> str:
    """Say which other meshes had landmarks in common with a pair that have changed since; empty if none had."""
    found = [changed_for_others(side, marks, pair) for side, marks in zip(pair, before, strict=True)]
    sides = [side.name for side, others in zip(pair, found, strict=True) if others]
    others = list(dict.fromkeys(name for names in found for name in names))
    return f"{listed(sides)} had that in common with {listed(others)} as well" if others else ""


class LandmarkOperator(PairOperator):
    """An operator on two meshes, in Object Mode or in Edit Mode; to be inherited from before `bpy.types.Operator`."""

    modes: tuple[str, ...] = ("OBJECT", "EDIT_MESH")

    def _sides(self, context: bpy.types.Context) -> tuple[Side, Side]:
        return steerable_pair(context, (self.source, self.target))

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Do it, and report, also what has changed for other meshes by that."""
        self._for_others = ""
        done = super().execute(context)
        if self._for_others:
            self.report({"INFO"}, translated(self._for_others))
        return done

    def _do(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        before = [read_marks(side) for side in (source, target)]
        done = self._edit(context, source, target)
        self._for_others = told_of_others((source, target), before)
        pick_pair(context, source, target)
        sync_lists(cast("bpy.types.Scene", context.scene))
        return done

    def _edit(self, context: bpy.types.Context, source: Side, target: Side) -> str:
        """Change the landmarks, and return what to report."""
        raise NotImplementedError
