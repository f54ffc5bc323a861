# SPDX-License-Identifier: GPL-3.0-or-later
"""UV layers, carried from one matched mesh to another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine import FacePlaces, Progress, called_steps, carry_uvs_steps, within
from ..common.access import mesh_of
from ..common.errors import NothingToCarryError, ObjectError
from ..common.phrases import counted, listed
from ..jobs.transfer import Transfer, TransferReport
from ..scene.attribute_io import (
    AttributeLayout,
    is_free,
    read_attribute,
    write_attribute,
    write_seams,
)
from ..scene.character import corner_ranges, edge_ranges, parts_of, read_faces
from .finite_values import without_broken

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import CarriedUVs, Polygons, Steps
    from ..jobs.transfer import Passage
    from ..scene.character import Side
    from .options.uvs import UVSettings

_MOST_LAYERS = 8
"""How many UV maps Blender allows a mesh."""


class UVTransfer(Transfer):
    """Carries UV layers; see `Transfer`.

    Parameters
    ----------
    settings : UVSettings
        Which layers, and whether seams are marked.
    """

    label = "UV Maps"

    def __init__(self, settings: UVSettings) -> None:
        self._settings = settings
        self._layers: dict[str, NDArray[Any]] = {}
        self._active, self._render = "", ""
        self._faces: tuple[Polygons, Polygons]
        self._carried: dict[str, CarriedUVs] = {}
        self._notes: list[str] = []

    def read(self, _context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read the source's layers and both meshes' faces, and make sure that the layers can be written."""
        meshes = [mesh_of(part) for part in parts_of(source)]
        for name in self._chosen(source):
            taken = [part for part in parts_of(target) if not is_free(part, _layout(name))]
            self._notes += [_taken(part, name) for part in taken]
            if not taken:
                self._layers[name] = np.concatenate([_read_layer(mesh, name) for mesh in meshes])
        self._notes += without_broken(self._layers, source)
        for part in parts_of(target):
            count = len({layer.name for layer in mesh_of(part).uv_layers} | self._layers.keys())
            if count > _MOST_LAYERS:
                raise ObjectError(
                    f'"{part.name}" would have {count} UV maps, but Blender allows {_MOST_LAYERS}. '
                    "Remove some of them first, or carry fewer over."
                )
        active = next((mesh.uv_layers.active for mesh in meshes if mesh.uv_layers.active), None)
        self._active = active.name if active else ""
        rendered = (layer.name for mesh in meshes for layer in mesh.uv_layers if layer.active_render)
        self._render = next(rendered, "")
        self._faces = read_faces(source), read_faces(target)

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute the UVs of the target's corners."""
        if not self._layers:
            return
        yield Progress(0.0, "Finding faces")
        pair = passage.pair
        faces = self._faces[0].cut_as(pair.source)
        places = yield from called_steps(FacePlaces, pair.source, self._faces[1], pair.target_to_source)
        areas = self._faces[1].face_areas(pair.target.vertices)
        for number, (name, uvs) in enumerate(self._layers.items()):
            start, end = ((number + part) / len(self._layers) for part in (0, 1))
            self._carried[name] = yield from within(carry_uvs_steps(uvs, faces, places, areas), start, end)

    def write(self, _context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write layers and seams."""
        # The vertex groups that were carried just before may have taken a name.
        for part in parts_of(target):
            for name in [name for name in self._carried if not is_free(part, _layout(name))]:
                del self._carried[name]
                self._notes.append(_taken(part, name))
        if not self._carried:
            return TransferReport("", tuple(self._notes))
        for part, corners, edges in zip(parts_of(target), corner_ranges(target), edge_ranges(target), strict=True):
            self._write_part(mesh_of(part), corners, edges)
        self._notes.extend(_astray(self._carried, source, target))
        return TransferReport(counted(len(self._carried), "UV map"), tuple(self._notes))

    def _write_part(self, mesh: bpy.types.Mesh, corners: slice, edges: slice) -> None:
        """Write layers and seams on one part of the target, by its share of all corners and edges."""
        for name, carried in self._carried.items():
            write_attribute(mesh, _layout(name), carried.uvs[corners])
        layers: Any = mesh.uv_layers
        if self._active in self._carried:
            layers.active_index = layers.find(self._active)
        if self._render in self._carried:
            layers[self._render].active_render = True
        if self._settings.seams:
            leading = self._active if self._active in self._carried else next(iter(self._carried))
            write_seams(mesh, self._carried[leading].seams[edges])
        mesh.update()

    def _chosen(self, source: Side) -> list[str]:
        """Names of the layers to carry, in the order of the source."""
        layers = [layer for part in parts_of(source) for layer in mesh_of(part).uv_layers]
        names = list(dict.fromkeys(layer.name for layer in layers))
        if not names:
            raise NothingToCarryError(
                f'"{source.name}" has no UV map to carry over. Unwrap it, or choose another Source.'
            )
        if self._settings.choice == "ACTIVE":
            active = [found for part in parts_of(source) if (found := mesh_of(part).uv_layers.active)]
            return [active[0].name if active else names[0]]
        if self._settings.choice == "NAMED":
            if not self._settings.names:
                raise ObjectError("No UV map is named. Enter the Names of some, separated by commas.")
            unknown = [name for name in self._settings.names if name not in names]
            if unknown:
                raise ObjectError(f'"{source.name}" has no UV map "{unknown[0]}". Check the Names.')
            return [name for name in names if name in self._settings.names]
        return names


def _read_layer(mesh: bpy.types.Mesh, name: str) -> NDArray[Any]:
    """Read a UV layer of one part, (l, 2): its active one if it has none of that name, else zeros."""
    layer = mesh.uv_layers.get(name) or mesh.uv_layers.active
    return np.zeros((len(mesh.loops), 2), np.float32) if layer is None else read_attribute(mesh, layer.name)


def _layout(name: str) -> AttributeLayout:
    """Say what a UV layer is among the attributes."""
    return AttributeLayout(name, "FLOAT2", "CORNER")


def _taken(target: bpy.types.Object, name: str) -> str:
    """Say that a layer was left out, because its name is taken on the target."""
    return (
        f'"{target.name}" already has a vertex group or another attribute called "{name}", so that UV map was left '
        "out. Rename one of them."
    )


def _astray(carried: dict[str, CarriedUVs], source: Side, target: Side) -> list[str]:
    """Sentences on the islands that are not well placed, one for all layers of each kind."""
    notes = []
    lost = {name: layer for name, layer in carried.items() if layer.lost}
    if lost:
        islands = sum(layer.island_count for layer in lost.values())
        notes.append(
            f"{sum(layer.lost for layer in lost.values())} of {islands} islands of {listed(list(lost))} lie where "
            f'"{target.name}" has no faces, such as the inside of a mouth that only "{source.name}" has.'
        )
    doubtful = {name: layer for name, layer in carried.items() if layer.untrusted}
    if doubtful:
        islands = sum(layer.island_count for layer in doubtful.values())
        notes.append(
            f"{sum(layer.untrusted for layer in doubtful.values())} of {islands} islands of {listed(list(doubtful))} "
            f'lie where the match has no confidence. Check them on "{target.name}".'
        )
    return notes
