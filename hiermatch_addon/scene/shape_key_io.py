# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys from and to Blender's meshes: coordinates as arrays, and everything that can be set on a key."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import bpy
import numpy as np

from ..common.access import mesh_of
from ..common.errors import ObjectError
from .character import parts_of
from .pair import check_own_mesh

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .character import Side

_RANGE = 10.0
"""Blender's own bound of the range of a key's value."""

_MEMBERS = "value", "mute", "slider_min", "slider_max"
"""What of a key can be animated."""


@dataclass(frozen=True)
class KeySettings:
    """What is set on a shape key beside its coordinates.

    Attributes
    ----------
    name : str
        Its name.
    relative_to : str
        Name of the key of the same set that it is relative to, itself if it moves nothing; empty for the reference key.
    value, slider_min, slider_max : float
        How far it is turned on, and between which bounds.
    mute : bool
        Whether it is switched off.
    vertex_group : str
        Name of the group that limits it; may be empty.
    interpolation : str
        How it is interpolated when keys are absolute.
    frame : float
        At which time it is reached when keys are absolute.
    """

    name: str
    relative_to: str = ""
    value: float = 0.0
    slider_min: float = 0.0
    slider_max: float = 1.0
    mute: bool = False
    vertex_group: str = ""
    interpolation: str = "KEY_LINEAR"
    frame: float = 0.0

    @classmethod
    def of(cls, key: bpy.types.ShapeKey, names: Sequence[str]) -> KeySettings:
        """Read them from a key, which is one of a set of such names."""
        relative = key.relative_key
        return cls(
            name=key.name,
            relative_to=relative.name if relative.name in names else "",
            value=key.value,
            slider_min=key.slider_min,
            slider_max=key.slider_max,
            mute=key.mute,
            vertex_group=key.vertex_group,
            interpolation=key.interpolation,
            frame=key.frame,
        )

    def write(self, obj: bpy.types.Object, key: bpy.types.ShapeKey) -> None:
        """Set them on a key of an object; a group or key that the object lacks is left out."""
        blocks = cast("bpy.types.Key", mesh_of(obj).shape_keys).key_blocks
        # Bounds are clamped to one another: first out of the way.
        key.slider_min, key.slider_max = -_RANGE, _RANGE
        key.slider_max = self.slider_max
        key.slider_min = self.slider_min
        key.value, key.mute = self.value, self.mute
        key.interpolation = self.interpolation  # type: ignore[assignment]
        key.vertex_group = self.vertex_group if self.vertex_group in obj.vertex_groups else ""
        relative = blocks.get(self.relative_to) if self.relative_to else None
        key.relative_key = relative or cast("bpy.types.Key", mesh_of(obj).shape_keys).reference_key


def keys_of(obj: bpy.types.Object) -> bpy.types.Key | None:
    """Return the shape keys of a mesh object; None if it has none."""
    return mesh_of(obj).shape_keys


def shape_key_names(obj: bpy.types.Object) -> tuple[str, ...]:
    """Return the names of an object's shape keys, without the reference key."""
    keys = keys_of(obj)
    return () if keys is None else tuple(key.name for key in keys.key_blocks if key != keys.reference_key)


def locked_keys(obj: bpy.types.Object) -> set[str]:
    """Return the names of an object's shape keys that are locked against changes."""
    keys = keys_of(obj)
    return set() if keys is None else {key.name for key in keys.key_blocks if key.lock_shape}


def key_positions(key: bpy.types.ShapeKey) -> NDArray[np.float64]:
    """Read the positions (n, 3) of a key, in the object's space."""
    positions = np.empty(3 * len(key.data), np.float32)
    key.data.foreach_get("co", positions)
    return positions.reshape(-1, 3).astype(np.float64)


def all_key_names(side: Side) -> tuple[str, ...]:
    """Return the names of the shape keys of all parts of a side, each once, without reference keys."""
    return tuple(dict.fromkeys(name for part in parts_of(side) for name in shape_key_names(part)))


def key_holder(side: Side, name: str) -> bpy.types.Object:
    """Return the first part of a side that has a shape key of that name."""
    return next(part for part in parts_of(side) if name in shape_key_names(part))


def read_offsets(obj: bpy.types.Object, names: Sequence[str], *, from_reference: Sequence[str]) -> NDArray[np.float64]:
    """Read by how much keys move the vertices, in the object's space.

    Parameters
    ----------
    obj : bpy.types.Object
        Where they are.
    names : sequence of str
        Which keys.
    from_reference : sequence of str
        Those for whose keys offsets are counted from the reference key, even if a key is relative to one of these.

    Returns
    -------
    (k, n, 3) array of float
        The offsets; from the key that it is relative to if that is not one of `from_reference`.
    """
    keys = cast("bpy.types.Key", keys_of(obj))
    reference = key_positions(keys.reference_key)
    offsets = np.empty((len(names), *reference.shape))
    for number, name in enumerate(names):
        key = keys.key_blocks[name]
        base = key.relative_key
        known = base == keys.reference_key or base.name in from_reference
        offsets[number] = key_positions(key) - (reference if known else key_positions(base))
    return offsets


def can_be_absolute(obj: bpy.types.Object, names: Sequence[str]) -> bool:
    """Tell whether absolute keys of such names can be written on an object: there are no others but its basis."""
    return set(shape_key_names(obj)) <= set(names)


def check_keys_writable(obj: bpy.types.Object, names: Sequence[str], *, absolute: bool = False) -> None:
    """Make sure that shape keys of such names can be written on an object, as absolute ones or relative ones.

    Raises
    ------
    ObjectError
        If they cannot.
    """
    mesh, keys = mesh_of(obj), keys_of(obj)
    check_own_mesh(obj)
    if keys is None:
        return
    if not keys.use_relative and not absolute:
        raise ObjectError(
            f'The shape keys of "{obj.name}" are absolute. Turn Relative on in its Shape Keys panel, or remove them.'
        )
    if keys.reference_key.name in names:
        raise ObjectError(
            f'"{keys.reference_key.name}" is the basis of the shape keys of "{obj.name}", but a shape key of the '
            "source has the same name. Rename one of them."
        )
    if any(len(key.data) != len(mesh.vertices) for key in keys.key_blocks):
        raise ObjectError(f'The shape keys of "{obj.name}" do not have the vertices of its mesh. Remove them first.')


def add_keys(
    obj: bpy.types.Object,
    settings: Sequence[KeySettings],
    offsets: NDArray[np.float64] | NDArray[np.float32],
    *,
    time: float | None = None,
) -> None:
    """Write shape keys: those of the same name are replaced, others added at the end, a basis if there is none.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object that `check_keys_writable` let pass.
    settings : sequence of KeySettings
        What is set on each key.
    offsets : (k, n, 3) array of float
        By how much it moves the vertices from the reference key, in the object's space.
    time : float, optional
        The keys are absolute, in the order of their frames, and this is the time.
    """
    mesh, active = mesh_of(obj), obj.active_shape_key_index
    if mesh.shape_keys is None:
        obj.shape_key_add(name="Basis", from_mix=False)
    keys = cast("bpy.types.Key", mesh.shape_keys)
    if time is not None:
        _begin_absolute(obj, keys)
    reference = key_positions(keys.reference_key)
    for one, moved in zip(settings, offsets, strict=True):
        if time is not None:
            keys.eval_time = one.frame
        key = keys.key_blocks.get(one.name) or obj.shape_key_add(name=one.name, from_mix=False)
        key.data.foreach_set("co", (reference + moved).astype(np.float32).ravel())
    for one in settings:  # when all are there, as they may be relative to each other
        one.write(obj, keys.key_blocks[one.name])
    if time is not None:
        keys.eval_time = time
    obj.active_shape_key_index = min(active or 0, len(keys.key_blocks) - 1)
    mesh.update()


def _begin_absolute(obj: bpy.types.Object, keys: bpy.types.Key) -> None:
    """Make keys absolute, and leave the basis only: Blender gives a key its frame when it is added, and never again."""
    for key in [key for key in keys.key_blocks if key != keys.reference_key]:
        obj.shape_key_remove(key)
    keys.use_relative = False


def key_paths(names: Sequence[str], *, absolute: bool) -> set[str]:
    """Return the paths from shape keys to all that can be animated of keys of those names."""
    paths = {key_value_path(name, member) for name in names for member in _MEMBERS}
    return paths | {"eval_time"} if absolute else paths


def key_value_path(name: str, member: str = "value") -> str:
    """Return the path from shape keys to something of the key of that name."""
    return f'key_blocks["{bpy.utils.escape_identifier(name)}"].{member}'


def world_matrix(context: bpy.types.Context, obj: bpy.types.Object) -> NDArray[np.float64]:
    """Return the matrix (4, 4) that takes an object's space to the world."""
    return np.array(obj.evaluated_get(context.evaluated_depsgraph_get()).matrix_world, dtype=np.float64)


def linear_part(context: bpy.types.Context, obj: bpy.types.Object) -> NDArray[np.float64]:
    """Return the part (3, 3) of it that offsets go through."""
    return world_matrix(context, obj)[:3, :3]
