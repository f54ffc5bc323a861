# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys of a body that its clothes follow: read from the body, and written on them with drivers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from ....engine import ClosestPoints
from ...common.access import mesh_of
from ...common.phrases import listed
from ...scene.character import parts_of
from ...scene.deform_layer import read_group
from ...scene.key_drivers import drive_key
from ...scene.shape_key_io import (
    KeySettings,
    add_keys,
    all_key_names,
    key_holder,
    keys_of,
    linear_part,
    read_offsets,
    shape_key_names,
)
from ...scene.worn.fitted_copies import COVERED

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ....engine import TriangleMesh
    from ...scene.character import Side


@dataclass(frozen=True, eq=False)
class BodyKeys:
    """Shape keys of a body.

    Attributes
    ----------
    settings : tuple of KeySettings
        What is set on each of them, k.
    offsets : (k, n, 3) array of float
        By how much each moves each vertex in the world when it is turned on alone.
    notes : tuple of str
        What is to be known of others.
    """

    settings: tuple[KeySettings, ...]
    offsets: NDArray[np.float64]
    notes: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """What the keys are called."""
        return tuple(one.name for one in self.settings)

    def only(self, chosen: NDArray[np.bool_]) -> BodyKeys:
        """Leave others than the chosen ones, (k,), out."""
        return BodyKeys(
            tuple(one for one, kept in zip(self.settings, chosen, strict=True) if kept), self.offsets[chosen]
        )

    def shown_on(self, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
        """Move the vertices of the body, (n, 3), by as much as the keys are on."""
        return vertices + np.tensordot([one.value for one in self.settings], self.offsets, axes=1)


def read_body_keys(context: bpy.types.Context, body: Side, *, shown: bool = False) -> BodyKeys:
    """Read the shape keys of all parts of a body that clothes can follow: not those that draw it in below them.

    If wanted, only those that are on, of what is `shown`.
    """
    absolute = [part.name for part in parts_of(body) if (keys := keys_of(part)) is not None and not keys.use_relative]
    names = [name for name in all_key_names(body) if name != COVERED and key_holder(body, name).name not in absolute]
    settings: list[KeySettings] = []
    offsets: list[NDArray[np.float64]] = []
    for name in names:
        keys = cast("bpy.types.Key", keys_of(key_holder(body, name)))
        read = KeySettings.of(keys.key_blocks[name], ())
        if shown and (read.mute or not read.value):
            continue
        settings.append(replace(read, vertex_group="", relative_to=""))
        moved = [_moved(context, part, name, without=absolute) for part in parts_of(body)]
        offsets.append(np.concatenate(moved))
    note = f"Absolute shape keys are not followed: those of {listed(absolute)}." if absolute else ""
    shape = (len(settings), sum(len(mesh_of(part).vertices) for part in parts_of(body)), 3)
    return BodyKeys(tuple(settings), np.array(offsets).reshape(shape), (note,) if note else ())


def lacking(keys: BodyKeys, *items: bpy.types.Object) -> BodyKeys:
    """Return those of a body's keys that none of some items follows.

    An item follows those of which it has its own, and all if it is bound to the surface of a body.
    """
    bound = any(modifier.type == "SURFACE_DEFORM" for item in items for modifier in item.modifiers)
    own = {name for item in items for name in shape_key_names(item)}
    return keys.only(np.array([not bound and name not in own for name in keys.names], bool))


def apart_from(keys: BodyKeys, body: TriangleMesh, item: bpy.types.Object, places: NDArray[np.float64]) -> BodyKeys:
    """Return those of a body's keys that move it below an item with vertices at such places, which lacks them."""
    below = np.unique(body.triangles[ClosestPoints(body).nearest(places).triangles])
    found = lacking(keys, item)
    return found.only(found.offsets[:, below].any(axis=(1, 2)))


def write_followed(copy: bpy.types.Object, body: Side, keys: BodyKeys, offsets: NDArray[np.float64]) -> list[str]:
    """Write those keys that move a fitted item, with drivers by which they follow the body's.

    Keys of its own of the same names stay as they are.

    Parameters
    ----------
    copy : bpy.types.Object
        The item.
    body : bpy.types.Object or Character
        The body.
    keys : BodyKeys
        Its keys.
    offsets : (k, n, 3) array of float
        By how much each moves each vertex of the item in the world.

    Returns
    -------
    list of str
        Names of the keys that were written.
    """
    own = keys_of(copy)
    taken = set() if own is None else set(own.key_blocks.keys())
    chosen = [number for number, one in enumerate(keys.settings) if offsets[number].any() and one.name not in taken]
    if not chosen:
        return []
    into = np.linalg.inv(np.array(copy.matrix_world, np.float64)[:3, :3]).T
    settings = [keys.settings[number] for number in chosen]
    add_keys(copy, settings, offsets[chosen] @ into)
    made = cast("bpy.types.Key", keys_of(copy))
    for one in settings:
        drive_key(made, one.name, cast("bpy.types.Key", keys_of(key_holder(body, one.name))))
    return [one.name for one in settings]


def _moved(context: bpy.types.Context, part: bpy.types.Object, name: str, *, without: list[str]) -> NDArray[np.float64]:
    """Read by how much a key moves the vertices of one part in the world, (n, 3)."""
    if name not in shape_key_names(part) or part.name in without:
        return np.zeros((len(mesh_of(part).vertices), 3))
    moved: NDArray[np.float64] = read_offsets(part, [name], from_reference=())[0] @ linear_part(context, part).T
    group = cast("bpy.types.Key", keys_of(part)).key_blocks[name].vertex_group
    if group and group in part.vertex_groups:
        moved = moved * np.nan_to_num(read_group(part, group))[:, None]
    return moved
