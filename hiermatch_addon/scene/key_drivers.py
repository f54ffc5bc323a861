# SPDX-License-Identifier: GPL-3.0-or-later
"""Drivers of shape keys: copied to an object that has the same keys, or made to follow those of another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .character import parts_of
from .shape_key_io import key_value_path, keys_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    import bpy

    from .character import Side


def counterparts(
    source: Side,
    target: bpy.types.Object,
    source_armature: bpy.types.Object | None,
    target_armature: bpy.types.Object | None,
) -> dict[bpy.types.ID, bpy.types.ID]:
    """Return what takes the place of the source, its mesh, keys and armature where drivers point to them.

    Of a source of several parts, the target takes that of all of them.
    """
    pairs: list[tuple[Any, Any]] = []
    for part in parts_of(source):
        pairs += [(part, target), (part.data, target.data), (keys_of(part), keys_of(target))]
    if source_armature is not None and target_armature is not None:
        pairs += [(source_armature, target_armature), (source_armature.data, target_armature.data)]
    return {mine: theirs for mine, theirs in pairs if mine is not None and theirs is not None}


def copy_key_drivers(
    source: bpy.types.Key, target: bpy.types.Key, paths: Collection[str], places: Mapping[bpy.types.ID, bpy.types.ID]
) -> tuple[int, set[str]]:
    """Copy the drivers of some keys, with their expressions, variables and curves.

    Drivers that the target has in the same places are replaced.

    Parameters
    ----------
    source, target : bpy.types.Key
        The shape keys of both.
    paths : collection of str
        What the drivers are wanted of, see `key_paths`; both have it.
    places : mapping
        What takes the place of what, see `counterparts`.

    Returns
    -------
    count : int
        How many drivers were copied.
    kept : set of str
        Names of the things of the source's that they still point to: those without a counterpart that has what is
        read.
    """
    animation = source.animation_data
    if animation is None:
        return 0, set()
    count, kept = 0, set()
    for driver in [curve for curve in animation.drivers if curve.data_path in paths]:
        target.driver_remove(driver.data_path)
        data = target.animation_data or target.animation_data_create()
        copied: Any = data.drivers.from_existing(src_driver=driver)
        count += 1
        for variable in copied.driver.variables:
            for place in variable.targets:
                other = places.get(place.id)
                if other is not None and _can_be_read(variable.type, place, other):
                    place.id = other
                elif place.id is not None and place.id.id_type != "SCENE":
                    kept.add(place.id.name)
    return count, kept


def drive_key(keys: bpy.types.Key, name: str, leader: bpy.types.Key) -> None:
    """Let the value of a shape key be that of the key of the same name among those of another object."""
    path = key_value_path(name)
    keys.driver_remove(path)
    driver: Any = keys.driver_add(path)
    driver.driver.type = "AVERAGE"
    variable = driver.driver.variables.new()
    variable.name = "followed"
    place = variable.targets[0]
    place.id_type, place.id, place.data_path = "KEY", leader, path


def point_drivers(
    driven: bpy.types.Key | bpy.types.Object, places: Mapping[bpy.types.ID, Iterable[bpy.types.ID]]
) -> list[str]:
    """Let the drivers of shape keys, or of an object, that read from some things read from others.

    Parameters
    ----------
    driven : bpy.types.Key or bpy.types.Object
        What has them.
    places : mapping
        What may take the place of what: the first that has what is read, a bone or another property.

    Returns
    -------
    list of str
        Names of those that they still read from, because nothing else has it.
    """
    kept = set()
    for curve in driven.animation_data.drivers if driven.animation_data is not None else ():
        driver: Any = curve.driver
        for variable in driver.variables:
            for place in variable.targets:
                others = places.get(place.id)
                if others is None:
                    continue
                found = next((other for other in others if _can_be_read(variable.type, place, other)), None)
                if found is None:
                    kept.add(place.id.name)
                else:
                    place.id = found
    return sorted(kept)


def _can_be_read(kind: str, place: Any, other: Any) -> bool:  # noqa: ANN401 - a target of a driver's variable
    """Tell whether something has what a variable of such a kind reads."""
    if kind != "SINGLE_PROP":
        pose = getattr(other, "pose", None)  # a mesh, of which no bone can be read, may stand there as well
        return not place.bone_target or (pose is not None and place.bone_target in pose.bones)
    try:
        other.path_resolve(place.data_path)
    except ValueError:
        return False
    return True
