# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys, carried from one matched mesh to another with everything that is set on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from ...engine import bone_frames, carry_offsets_steps, surface_frames
from ..common.errors import NothingToCarryError, ObjectError
from ..common.phrases import counted, listed
from ..jobs.transfer import TransferReport
from ..scene.armatures import find_armature
from ..scene.key_actions import share_key_action
from ..scene.key_drivers import copy_key_drivers, counterparts
from ..scene.shape_key_io import (
    KeySettings,
    add_keys,
    can_be_absolute,
    check_keys_writable,
    key_paths,
    keys_of,
    linear_part,
    locked_keys,
    read_offsets,
    shape_key_names,
)

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import Steps
    from ..jobs.transfer import Passage
    from .options.shape_keys import ShapeKeySettings

__all__ = ["ShapeKeyTransfer"]


class ShapeKeyTransfer:
    """Carries shape keys; see `Transfer`.

    Parameters
    ----------
    settings : ShapeKeySettings
        Which keys, and how.
    """

    label = "Shape Keys"
    uses_rig = True

    def __init__(self, settings: ShapeKeySettings) -> None:
        self._settings = settings
        self._keys: tuple[KeySettings, ...] = ()
        self._offsets: NDArray[np.float64] = np.empty((0, 0, 3))
        self._time: float | None = None  # of the target's keys, if they become absolute
        self._to_local: NDArray[np.float64] = np.eye(3)
        self._carried: NDArray[np.float32] = np.empty((0, 0, 3), np.float32)
        self._notes: list[str] = []

    def read(self, context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> None:
        """Read the source's keys, and make sure that they can be written on the target."""
        chosen = self._chosen(source)
        present = shape_key_names(target)
        if self._settings.existing == "SKIP":
            skipped = [name for name in chosen if name in present]
            chosen = [name for name in chosen if name not in present]
            if skipped:
                self._notes.append(f'"{target.name}" already has {listed(skipped)}, which was skipped.')
        locked = [name for name in chosen if name in locked_keys(target)]
        chosen = [name for name in chosen if name not in locked]
        if locked:
            self._notes.append(f'Locked shape keys of "{target.name}" were left alone: {listed(locked)}.')
        keys = cast("bpy.types.Key", keys_of(source))
        absolute = not keys.use_relative and can_be_absolute(target, chosen)
        check_keys_writable(target, chosen, absolute=absolute)
        self._keys = tuple(KeySettings.of(keys.key_blocks[name], chosen) for name in chosen)
        self._time = keys.eval_time if absolute else None
        if not keys.use_relative and not absolute:
            self._notes.append(
                f'The shape keys of "{source.name}" are absolute; on "{target.name}", which has others, they are '
                "relative."
            )
        # To world space, where the two surfaces are compared, and back into the target's.
        direct = chosen if keys.use_relative else shape_key_names(source)
        local = read_offsets(source, chosen, from_reference=direct)
        self._offsets = local @ linear_part(context, source).T
        self._to_local = np.linalg.inv(linear_part(context, target)).T

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute the offsets of the target's vertices."""
        pair, rig = passage.pair, passage.rig
        images = pair.source_to_target.positions if rig is None else rig.registered
        frames = surface_frames(pair.source, images)
        if rig is not None:
            frames = bone_frames(rig, frames)
        carried = yield from carry_offsets_steps(
            self._offsets,
            frames,
            pair.target,
            pair.target_to_source,
            scaling=self._settings.scaling,
            threshold=self._settings.threshold,
        )
        self._carried = (carried @ self._to_local).astype(np.float32)

    def write(self, _context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> TransferReport:
        """Write keys and drivers."""
        if not self._keys:
            return TransferReport("", tuple(self._notes))
        add_keys(target, self._keys, self._carried, time=self._time)
        missing = sorted({key.vertex_group for key in self._keys} - {"", *target.vertex_groups.keys()})
        if missing:
            self._notes.append(
                f'"{target.name}" has no vertex group {listed(missing)}, by which shape keys of "{source.name}" are '
                "limited. Carry the weights over first."
            )
        done = [counted(len(self._keys), "shape key"), *self._animate(source, target)]
        return TransferReport(", ".join(done), tuple(self._notes))

    def _chosen(self, source: bpy.types.Object) -> list[str]:
        """Names of the keys to carry, in the order of the source."""
        names = shape_key_names(source)
        if not names:
            raise NothingToCarryError(
                f'"{source.name}" has no shape keys beside the basis, so there are none to carry over.'
            )
        if self._settings.choice == "ACTIVE":
            active = source.active_shape_key
            if active is None or active.name not in names:
                raise ObjectError(
                    f'The active shape key of "{source.name}" is its basis. Select another one in its Shape Keys panel.'
                )
            return [active.name]
        if self._settings.choice == "NAMED":
            if not self._settings.names:
                raise ObjectError("No shape key is named. Enter the Names of some, separated by commas.")
            unknown = [name for name in self._settings.names if name not in names]
            if unknown:
                raise ObjectError(f'"{source.name}" has no shape key {listed(unknown)}. Check the Names.')
            return [name for name in names if name in self._settings.names]
        return list(names)

    def _animate(self, source: bpy.types.Object, target: bpy.types.Object) -> list[str]:
        """Copy the drivers of the keys that were written, and share their action; say what was done."""
        mine, theirs = cast("bpy.types.Key", keys_of(source)), cast("bpy.types.Key", keys_of(target))
        paths = key_paths([key.name for key in self._keys], absolute=self._time is not None)
        done = []
        if self._settings.drivers:
            places = counterparts(source, target, find_armature(source), find_armature(target))
            count, kept = copy_key_drivers(mine, theirs, paths, places)
            if count:
                done.append(counted(count, "driver"))
            if kept:
                points = listed(sorted(kept))
                self._notes.append(f'Drivers of the shape keys of "{target.name}" still point to {points}.')
        if self._settings.action:
            shared, note = share_key_action(source, target, paths)
            if shared:
                done.append(f'the action "{shared}"')
            if note:
                self._notes.append(note)
        return done
