# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes, materials, marked edges and normals, carried from one matched mesh to another."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from ...engine import (
    Crossing,
    Progress,
    called_steps,
    carry_face_values,
    carry_normals,
    carry_values_steps,
    surface_frames,
    within,
)
from ..common.access import mesh_of
from ..common.errors import NothingToCarryError
from ..common.phrases import counted
from ..jobs.transfer import Transfer, TransferReport
from ..scene.attribute_io import (
    attribute_layouts,
    is_blended,
    is_free,
    missing_attribute,
    read_attribute,
    read_corner_normals,
    read_seams,
    write_attribute,
    write_corner_normals,
    write_seams,
)
from ..scene.character import (
    corner_ranges,
    edge_ranges,
    face_ranges,
    parts_of,
    read_faces,
    vertex_ranges,
)
from ..scene.material_slots import assign_materials, read_materials
from ..scene.shape_key_io import linear_part
from .attribute_choice import SEAMS, choose_attributes, taken_note

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    import bpy
    from numpy.typing import NDArray

    from ...engine import Domain, Polygons, Steps
    from ..jobs.transfer import Passage
    from ..scene.attribute_io import AttributeLayout
    from ..scene.character import Side
    from .options.attributes import AttributeSettings

_POINT_MARKS = frozenset({"crease_vert", "bevel_weight_vert"})
"""Attributes of points that mark single ones."""

_NORMAL_RADIUS = 0.03
"""Over what distance the turn of the surface is averaged for normals, in sqrt(area): that of a finger or a nose."""


class AttributeTransfer(Transfer):
    """Carries attributes, materials, marked edges and normals; see `Transfer`.

    Parameters
    ----------
    settings : AttributeSettings
        Which of these.
    """

    label = "Attributes"

    def __init__(self, settings: AttributeSettings) -> None:
        self._settings = settings
        self._values: dict[AttributeLayout, NDArray[Any]] = {}
        self._faces: tuple[Polygons, Polygons]
        self._materials: NDArray[np.int64] | None = None
        self._normals: NDArray[np.float64] | None = None
        self._to_local: list[NDArray[np.float64]] = []
        self._colors = ("", "")
        self._notes: list[str] = []

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read what is chosen of the source and both meshes' faces, and make sure that it can be written."""
        meshes = [mesh_of(part) for part in parts_of(source)]
        choice = choose_attributes(source, target, self._settings)
        self._notes.extend(choice.notes)
        for layout in choice.layouts:
            self._values[layout] = np.concatenate([_read_part(mesh, layout) for mesh in meshes])
        if self._settings.materials:
            materials, numbers = _read_materials(source)
            self._materials = numbers if any(materials) else None  # faces keep theirs where nothing comes instead
        if self._settings.normals and any(mesh.has_custom_normals for mesh in meshes):
            self._normals = np.concatenate(
                [read_corner_normals(mesh_of(part), linear_part(context, part)) for part in parts_of(source)]
            )
            self._to_local = [linear_part(context, part) for part in parts_of(target)]
        if not self._values and self._materials is None and self._normals is None and not self._notes:
            raise NothingToCarryError(
                f'"{source.name}" has nothing of what is to be carried over: no such attributes, materials, marked '
                "edges or custom normals. Choose other options, or another Source."
            )
        active, rendered = (
            next(filter(None, (getattr(mesh.attributes, which) for mesh in meshes)), "")
            for which in ("active_color_name", "default_color_name")
        )
        self._colors = (active, rendered)
        self._faces = read_faces(source), read_faces(target)

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute the values on the target."""
        yield Progress(0.0, "Finding faces")
        pair = passage.pair
        faces = self._faces[0].cut_as(pair.source)
        crossing = Crossing(
            pair.source, pair.target, faces, self._faces[1], pair.source_to_target, pair.target_to_source
        )
        count = len(self._values) + 1
        for number, (layout, values) in enumerate(self._values.items()):
            steps = carry_values_steps(
                values,
                cast("Domain", layout.domain),
                crossing,
                blended=is_blended(layout.kind),
                marks=layout.name in _POINT_MARKS,
            )
            carried = yield from within(steps, number / count, (number + 1) / count)
            self._values[layout] = carried.values
            if carried.lost:
                lines = counted(carried.lost, "line")
                self._notes.append(f'{lines} of "{layout.name}" run where the target has no faces, and were left out.')
        yield Progress(1 - 1 / count, "Carrying materials and normals")
        if self._materials is not None:
            carrying = called_steps(carry_face_values, self._materials, faces, crossing.places)
            self._materials = yield from within(carrying, 1 - 1 / count, 1.0)
        if self._normals is not None:
            back = pair.target_to_source
            mirrored = back.mirrors(pair.target, pair.source)
            placing = called_steps(
                surface_frames, pair.target, back.positions, radius=_NORMAL_RADIUS, mirrored=mirrored
            )
            turns = (yield from within(placing, 1.0, 1.0)).rotations.transpose(0, 2, 1)
            carrying = called_steps(carry_normals, self._normals, faces, crossing.places, pair.target, turns)
            self._normals = yield from within(carrying, 1.0, 1.0)

    def write(self, _context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write everything."""
        done = []
        # The vertex groups that were carried just before may have taken a name.
        for part in parts_of(target):
            taken = [layout for layout in self._values if layout != SEAMS and not is_free(part, layout)]
            for layout in taken:
                del self._values[layout]
                self._notes.append(taken_note(part, layout.name))
        materials = _read_materials(source)[0] if self._materials is not None else []
        ranges = {
            "POINT": vertex_ranges(target),
            "EDGE": edge_ranges(target),
            "FACE": face_ranges(target),
            "CORNER": corner_ranges(target),
        }
        for number, part in enumerate(parts_of(target)):
            self._write_part(number, part, {domain: own[number] for domain, own in ranges.items()}, materials)
        if self._values:
            done.append(counted(len(self._values), "attribute"))
        if self._materials is not None:
            done.append(counted(len(np.unique(self._materials)), "material"))
        if self._normals is not None:
            done.append("custom normals")
        return TransferReport(", ".join(done), tuple(self._notes))

    def _write_part(
        self,
        number: int,
        part: bpy.types.Object,
        ranges: Mapping[str, slice],
        materials: list[bpy.types.Material | None],
    ) -> None:
        """Write everything on one part of the target, by its share of what has each domain's values."""
        mesh = mesh_of(part)
        for layout, values in self._values.items():
            own = values[ranges[layout.domain]]
            if layout == SEAMS:
                write_seams(mesh, own)
            else:
                write_attribute(mesh, layout, own)
        if self._values:
            self._show_colors(mesh)
        if self._materials is not None:
            assign_materials(part, materials, self._materials[ranges["FACE"]])
        if self._normals is not None:
            write_corner_normals(mesh, self._normals[ranges["CORNER"]], self._to_local[number])
        mesh.update()

    def _show_colors(self, mesh: bpy.types.Mesh) -> None:
        """Make the source's active color attributes active on a mesh as far as it had none."""
        written = {layout.name for layout in self._values if layout.kind in ("FLOAT_COLOR", "BYTE_COLOR")}
        active, render = self._colors
        attributes = mesh.attributes
        if active in written and not attributes.active_color_name:
            attributes.active_color_name = active
        if render in written and not attributes.default_color_name:
            attributes.default_color_name = render


def _read_part(mesh: bpy.types.Mesh, layout: AttributeLayout) -> NDArray[Any]:
    """Read an attribute of one part: white, nothing or no where it lacks it."""
    if layout == SEAMS:
        return read_seams(mesh)
    if attribute_layouts(mesh).get(layout.name) == layout:
        return read_attribute(mesh, layout.name)
    return missing_attribute(mesh, layout)


def _read_materials(side: Side) -> tuple[list[bpy.types.Material | None], NDArray[np.int64]]:
    """Read the materials of all parts, and for each face the number of its own among them, (f,)."""
    materials: list[bpy.types.Material | None] = []
    numbers = []
    for part in parts_of(side):
        own, slots = read_materials(part)
        if len(parts_of(side)) == 1:
            return own, slots
        places = []
        for material in own or [None]:
            if material not in materials:
                materials.append(material)
            places.append(materials.index(material))
        numbers.append(np.array(places, np.int64)[slots])
    return materials, np.concatenate(numbers)
