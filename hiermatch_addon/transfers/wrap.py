# SPDX-License-Identifier: GPL-3.0-or-later
"""One mesh laid onto another, as a shape key: its slider morphs one into the other."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, cast

import numpy as np

from ...engine import Progress, called_steps, in_between, kept_in_place, turned_normals, within, wrap_steps
from ..common.access import mesh_of, open_collections
from ..common.long_names import LONGEST_KEY, shortened
from ..jobs.transfer import Transfer, TransferReport
from ..scene.attribute_io import read_corner_normals, write_corner_normals
from ..scene.binding import hand_over
from ..scene.character import corner_ranges, parts_of, read_faces, vertex_ranges
from ..scene.mesh_io import rest_matrix, vertex_positions
from ..scene.pair import check_writable
from ..scene.shape_key_io import (
    KeySettings,
    add_keys,
    check_keys_writable,
    key_positions,
    key_value_path,
    keys_of,
    world_matrix,
)
from ..storage import writing

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import Steps
    from ..jobs.transfer import Passage
    from ..scene.character import Side
    from .options.wrap import WrapSettings

_LEAST_HELD = 0.9
"""If less of the vertices lies on the other mesh, that is told."""

_MOST_FOLDED = 0.002
"""If more of the area is folded, that is told."""


def wrap_key_name(other: str) -> str:
    """Return the name of the shape key that wraps a mesh to another of that name."""
    return shortened(f"Wrap to {other}", LONGEST_KEY - len(" 15/16"))  # with the number of an in-between


def is_wrap_key(name: str, other: str) -> bool:
    """Tell whether a shape key lays a mesh onto another of that name, or goes part of the way."""
    return re.fullmatch(re.escape(wrap_key_name(other)) + r"( \d+/\d+)?", name) is not None


class WrapTransfer(Transfer):
    """Lays source or target onto the other; see `Transfer`.

    Parameters
    ----------
    settings : WrapSettings
        Which, and what is made of it.
    """

    label = "Wrap"

    def __init__(self, settings: WrapSettings) -> None:
        self._settings = settings
        self._from_world: list[NDArray[np.float64]] = []
        self._shapes: NDArray[np.float64] = np.empty((0, 0, 3))  # the wrapped one, and the in-betweens
        self._normals: NDArray[np.float64] | None = None  # of corners, in the world, if custom
        self._corners: NDArray[np.int64] = np.empty(0, np.int64)  # the vertex of each
        self._notes: list[str] = []
        self._remarks: list[str] = []

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Make sure that the result can be written."""
        moved, other = self._roles(source, target)
        for part in parts_of(moved):
            if self._settings.result == "KEY":
                check_writable(part)
                check_keys_writable(part, self._names(other.name))
            self._from_world.append(np.linalg.inv(np.array(rest_matrix(part) or world_matrix(context, part))))
        parts = parts_of(moved)
        if self._settings.result == "OBJECT" and any(mesh_of(part).has_custom_normals for part in parts):
            turned = zip(parts, self._from_world, strict=True)
            self._normals = np.concatenate(
                [read_corner_normals(mesh_of(part), np.linalg.inv(matrix[:3, :3])) for part, matrix in turned]
            )
            self._corners = read_faces(moved).corner_vertices

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute the wrapped shape and those in between."""
        forward = self._settings.moved == "SOURCE"
        pair = passage.pair if forward else passage.pair.reverse
        registered = passage.rig.registered if forward and passage.rig is not None else None
        maps = (pair.source_to_target, pair.target_to_source)
        wrapped = yield from within(wrap_steps(pair.source, pair.target, *maps, registered), 0.0, 0.8)
        positions = wrapped.positions
        if self._settings.place == "OWN":
            positions = yield from within(called_steps(kept_in_place, pair.source, positions), 0.8, 0.8)
        if self._normals is not None:
            turning = called_steps(turned_normals, self._normals, self._corners, pair.source, positions)
            self._normals = yield from within(turning, 0.8, 0.8)
        yield Progress(0.8, "Finding shapes in between")
        count = self._settings.in_betweens
        shapes = positions[None]
        if count:
            parts = np.arange(1, count + 1) / (count + 1)
            between = yield from within(called_steps(in_between, pair.source, positions, parts), 0.8, 1.0)
            shapes = np.concatenate([shapes, between])
        self._shapes = shapes
        if wrapped.held.mean() < _LEAST_HELD:
            self._notes.append(
                f"{1 - wrapped.held.mean():.0%} of the vertices have no place on the other mesh and follow their "
                "surroundings."
            )
        if wrapped.folded > _MOST_FOLDED:
            self._notes.append(f"The wrapped surface is folded in places, {wrapped.folded:.1%} of it.")

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write the shape keys."""
        moved, other = self._roles(source, target)
        names, made = self._names(other.name), []
        plan = zip(parts_of(moved), vertex_ranges(moved), corner_ranges(moved), self._from_world, strict=True)
        for part, own, corners, matrix in plan:
            written = part
            shapes = self._shapes[:, own] @ matrix[:3, :3].T + matrix[:3, 3]
            if self._settings.result == "OBJECT":
                written = _duplicate(context, part, f"{part.name} to {other.name}")
                if self._settings.place == "OTHER":
                    hand_over(written, other)
                if self._normals is not None and mesh_of(part).has_custom_normals:
                    to_world = np.linalg.inv(matrix[:3, :3])
                    write_corner_normals(mesh_of(written), self._normals[corners], to_world, shapes[0])
            add_keys(written, self._key_settings(written, names), _offsets(written, shapes))
            _drive(cast("bpy.types.Key", keys_of(written)), names)
            made.append(written.name)
        if self._settings.result == "KEY" and any(mesh_of(part).has_custom_normals for part in parts_of(moved)):
            self._remarks.append(
                f'Custom normals of "{moved.name}" bend with the key only roughly along seams. With the result New '
                "Object they fit the wrapped surface."
            )
        key, first = names[0], made[0]
        done = [
            f'the shape key "{key}" on "{first}"' if len(made) == 1 else f'the shape key "{key}" on {len(made)} objects'
        ]
        if self._settings.result == "OBJECT":
            done.append("a new object" if len(made) == 1 else f"{len(made)} new objects")
        return TransferReport(", ".join(done), tuple(self._notes), tuple(self._remarks))

    def _roles(self, source: Side, target: Side) -> tuple[Side, Side]:
        """Tell which one is laid onto which."""
        return (source, target) if self._settings.moved == "SOURCE" else (target, source)

    def _names(self, other: str) -> list[str]:
        """Names of the key and of its in-betweens."""
        name, count = wrap_key_name(other), self._settings.in_betweens
        return [name, *(f"{name} {number}/{count + 1}" for number in range(1, count + 1))]

    def _key_settings(self, made: bpy.types.Object, names: list[str]) -> list[KeySettings]:
        """Show the new shape, unless it is already another's."""
        keys = keys_of(made)
        start = wrap_key_name("")
        others = [] if keys is None else [key for key in keys.key_blocks if key.name not in names]
        shown = not any(key.name.startswith(start) and key.value for key in others)
        return [KeySettings(name, value=float(shown and not number)) for number, name in enumerate(names)]


def _offsets(made: bpy.types.Object, shapes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return what is to be added to the basis for shapes (k, n, 3): by in-betweens, what lacks on the straight way."""
    keys, mesh = keys_of(made), mesh_of(made)
    rest = vertex_positions(mesh).astype(np.float64) if keys is None else key_positions(keys.reference_key)
    offsets = shapes - rest
    fractions = np.arange(1, len(offsets)) / len(offsets)
    offsets[1:] -= fractions[:, None, None] * offsets[0]
    return offsets


def _duplicate(context: bpy.types.Context, obj: bpy.types.Object, name: str) -> bpy.types.Object:
    """Copy a mesh object, bound to its rig, but without its shape keys and what matches wrote.

    Other modifiers, constraints and animation are not taken over.
    """
    matrix = obj.matrix_world.copy()
    copy, mesh = obj.copy(), mesh_of(obj).copy()
    copy.name, mesh.name = name, name
    copy.data = mesh
    copy.animation_data_clear()
    for modifier in [modifier for modifier in copy.modifiers if modifier.type != "ARMATURE"]:
        copy.modifiers.remove(modifier)
    copy.constraints.clear()
    copy.matrix_world = matrix
    if mesh.shape_keys is not None:
        copy.shape_key_clear()
    for prefix in writing.prefixes(copy):
        writing.clear(copy, prefix)
    for collection in open_collections(context, obj.users_collection):
        collection.objects.link(copy)
    return copy


def _drive(keys: bpy.types.Key, names: list[str]) -> None:
    """Let the slider of the first key turn the others on and off again, one after the other."""
    for number, name in enumerate(names[1:], start=1):
        path = key_value_path(name)
        keys.driver_remove(path)
        driver = cast("bpy.types.Driver", keys.driver_add(path).driver)
        driver.type = "SCRIPTED"
        variable = driver.variables.new()
        variable.name, variable.type = "wrap", "SINGLE_PROP"
        place = variable.targets[0]
        place.id_type, place.id, place.data_path = "KEY", keys, key_value_path(names[0])
        driver.expression = f"max(0, 1 - abs(wrap * {len(names)} - {number}))"
