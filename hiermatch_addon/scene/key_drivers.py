# SPDX-License-Identifier: GPL-3.0-or-later
"""Drivers of shape keys, copied from one object to another that has the same keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .shape_key_io import keys_of

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    import bpy

__all__ = ["copy_key_drivers", "counterparts"]


def counterparts(
    source: bpy.types.Object,
    target: bpy.types.Object,
    source_armature: bpy.types.Object | None,
    target_armature: bpy.types.Object | None,
) -> dict[bpy.types.ID, bpy.types.ID]:
    """Return what takes the place of the source, its mesh, keys and armature where drivers point to them."""
    pairs: list[tuple[Any, Any]] = [(source, target), (source.data, target.data), (keys_of(source), keys_of(target))]
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
        Names of the things of the source's that they still point to: those without a counterpart.
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
                if place.id in places:
                    place.id = places[place.id]
                elif place.id is not None and place.id.id_type != "SCENE":
                    kept.add(place.id.name)
    return count, kept
