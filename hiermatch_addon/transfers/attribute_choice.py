# SPDX-License-Identifier: GPL-3.0-or-later
"""The attributes of a mesh that can be carried to another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..common.access import mesh_of
from ..common.errors import ObjectError
from ..scene.attribute_io import AttributeLayout, attribute_layouts, is_free, is_known, read_seams
from ..scene.character import parts_of
from ..storage.written_names import written_names

if TYPE_CHECKING:
    import bpy

    from ..scene.character import Side
    from .options.attributes import AttributeSettings

SEAMS = AttributeLayout("uv_seam", "BOOLEAN", "EDGE")
"""Seams as an attribute: what newer versions call them; older ones have them, but not under a name."""

_SHARP = frozenset({"sharp_edge", "sharp_face"})

_CREASES = frozenset({"crease_edge", "crease_vert", "bevel_weight_edge", "bevel_weight_vert"})

_OWN_WAY = frozenset({"position", "material_index", "custom_normal", "uv_seam"})
"""What is an attribute, but is carried in another way."""

_OURS = "HM "
"""What the names start with that matches write unless they are told otherwise."""


@dataclass(frozen=True)
class AttributeChoice:
    """What is to be carried.

    Attributes
    ----------
    layouts : tuple of AttributeLayout
        The attributes.
    notes : tuple of str
        Which were left out, and why.
    """

    layouts: tuple[AttributeLayout, ...]
    notes: tuple[str, ...]


def choose_attributes(source: Side, target: Side, settings: AttributeSettings) -> AttributeChoice:
    """Choose the attributes of the source that are wanted and can be written on the target.

    Raises
    ------
    ObjectError
        If an attribute is asked for by a name that the source does not have.
    """
    layouts: dict[str, AttributeLayout] = {}
    for part in parts_of(source):
        for name, layout in attribute_layouts(mesh_of(part)).items():
            layouts.setdefault(name, layout)
    ours = {name for part in (*parts_of(source), *parts_of(target)) for name in written_names(part)}
    unknown = [name for name in settings.names if name not in layouts]
    if unknown:
        raise ObjectError(f'"{source.name}" has no attribute "{unknown[0]}". Check the Names.')
    chosen, notes = [], []
    for name, layout in layouts.items():
        if name in ours or name.startswith(_OURS) or not _is_wanted(layout, settings):
            continue
        if not is_known(layout.kind):
            notes.append(f'The attribute "{name}" of "{source.name}" is of the type {layout.kind}, and was left out.')
        elif taken := [part for part in parts_of(target) if not is_free(part, layout)]:
            notes += [taken_note(part, name) for part in taken]
        else:
            chosen.append(layout)
    if settings.seams and any(read_seams(mesh_of(part)).any() for part in parts_of(source)):
        chosen.append(SEAMS)
    return AttributeChoice(tuple(chosen), tuple(notes))


def taken_note(target: bpy.types.Object, name: str) -> str:
    """Say that an attribute was left out, because its name is taken on the target."""
    return (
        f'"{target.name}" already has something else called "{name}", so that attribute was left out. Rename one of '
        "them."
    )


def _is_wanted(layout: AttributeLayout, settings: AttributeSettings) -> bool:
    """Tell whether attributes of a kind are to be carried at all."""
    name = layout.name
    if name in _OWN_WAY or (layout.kind, layout.domain) == ("FLOAT2", "CORNER"):  # the latter are UV maps
        return False
    if name in _SHARP:
        return settings.sharp
    if name in _CREASES:
        return settings.creases
    wanted = settings.colors if layout.kind in ("FLOAT_COLOR", "BYTE_COLOR") else settings.values
    return wanted and (not settings.names or name in settings.names)
