# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys, carried from one matched mesh to another with everything that is set on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from ...engine import (
    bone_frames,
    called_steps,
    carry_offsets_steps,
    closings_kept_steps,
    evened_frames,
    surface_frames,
    within,
)
from ..common.access import mesh_of
from ..common.errors import NothingToCarryError, ObjectError
from ..common.phrases import counted, listed
from ..jobs.transfer import Transfer, TransferReport
from ..scene.armatures import find_armature
from ..scene.character import parts_of, vertex_ranges
from ..scene.key_actions import share_key_action
from ..scene.key_drivers import copy_key_drivers, counterparts
from ..scene.shape_key_io import (
    KeySettings,
    add_keys,
    all_key_names,
    can_be_absolute,
    check_keys_writable,
    key_holder,
    key_paths,
    keys_of,
    linear_part,
    locked_keys,
    read_offsets,
    shape_key_names,
)
from .finite_values import without_broken
from .wrap import is_wrap_key

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import Steps
    from ..jobs.transfer import Passage
    from ..scene.character import Side
    from .options.shape_keys import ShapeKeySettings


class ShapeKeyTransfer(Transfer):
    """Carries shape keys; see `Transfer`.

    Parameters
    ----------
    settings : ShapeKeySettings
        Which keys, and how.
    """

    label = "Shape Keys"

    def __init__(self, settings: ShapeKeySettings) -> None:
        self._settings = settings
        self._keys: tuple[KeySettings, ...] = ()
        self._offsets: NDArray[np.float64] = np.empty((0, 0, 3))
        self._written: list[list[str]] = []  # for each part of the target
        self._times: list[float | None] = []  # of each part's keys, if they become absolute
        self._to_local: list[NDArray[np.float64]] = []
        self._carried: NDArray[np.float64] = np.empty((0, 0, 3))
        self._notes: list[str] = []

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read the source's keys, and make sure that they can be written on the target."""
        chosen = self._chosen(source, target)
        for part in parts_of(target):
            self._read_target(context, source, part, chosen)
        names = [name for name in chosen if any(name in written for written in self._written)]
        # To world space, where the two surfaces are compared, and back into the target's.
        offsets = np.concatenate([_read_part(context, part, names) for part in parts_of(source)], axis=1)
        found = dict(zip(names, offsets, strict=True))
        self._notes += without_broken(found, source)
        models = {name: cast("bpy.types.Key", keys_of(key_holder(source, name))) for name in found}
        self._keys = tuple(KeySettings.of(keys.key_blocks[name], names) for name, keys in models.items())
        self._offsets = np.array(list(found.values())).reshape(-1, *offsets.shape[1:])

    def _read_target(
        self, context: bpy.types.Context, source: Side, target: bpy.types.Object, chosen: list[str]
    ) -> None:
        """Find out which keys can be written on one part of the target."""
        present, first = shape_key_names(target), key_holder(source, chosen[0])
        if self._settings.existing == "SKIP":
            skipped = [name for name in chosen if name in present]
            chosen = [name for name in chosen if name not in present]
            if skipped:
                self._notes.append(f'"{target.name}" already has {listed(skipped)}, which was skipped.')
        locked = [name for name in chosen if name in locked_keys(target)]
        chosen = [name for name in chosen if name not in locked]
        if locked:
            self._notes.append(f'Locked shape keys of "{target.name}" were left alone: {listed(locked)}.')
        keys = cast("bpy.types.Key", keys_of(first))
        absolute = not keys.use_relative and can_be_absolute(target, chosen)
        check_keys_writable(target, chosen, absolute=absolute)
        self._written.append(chosen)
        self._times.append(keys.eval_time if absolute else None)
        if not keys.use_relative and not absolute:
            self._notes.append(
                f'The shape keys of "{first.name}" are absolute; on "{target.name}", which has others, they are '
                "relative."
            )
        self._to_local.append(np.linalg.inv(linear_part(context, target)).T)

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute the offsets of the target's vertices."""
        pair, rig = passage.pair, passage.rig
        images = pair.source_to_target.positions if rig is None else rig.registered
        mirrored = pair.source_to_target.mirrors(pair.source, pair.target)
        framing = called_steps(surface_frames, pair.source, images, mirrored=mirrored)
        frames = yield from within(framing, 0.0, 0.1)
        turned = (
            called_steps(evened_frames, pair.source, frames) if rig is None else called_steps(bone_frames, rig, frames)
        )
        frames = yield from within(turned, 0.1, 0.2)
        steps = carry_offsets_steps(
            self._offsets,
            frames,
            pair.target,
            pair.target_to_source,
            scaling=self._settings.scaling,
            threshold=self._settings.threshold,
        )
        carried = yield from within(steps, 0.2, 0.6)
        maps = pair.source_to_target, pair.target_to_source
        steps = closings_kept_steps(pair.source, self._offsets, maps, pair.target, carried)
        self._carried = yield from within(steps, 0.6, 1.0)

    def write(self, _context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write keys and drivers: of several parts, each gets the keys that move it."""
        if not self._keys:
            return TransferReport("", tuple(self._notes))
        parts, numbers = parts_of(target), {key.name: number for number, key in enumerate(self._keys)}
        done: list[str] = []
        missing: set[str] = set()
        plan = zip(parts, vertex_ranges(target), self._written, self._times, self._to_local, strict=True)
        for part, own, written, time, to_local in plan:
            carried, all_of_them = self._carried[:, own], len(parts) == 1 or time is not None
            moved = [
                key
                for number, key in enumerate(self._keys)
                if key.name in written and (all_of_them or carried[number].any() or key.name in shape_key_names(part))
            ]
            if not moved:
                continue
            offsets = carried[[numbers[key.name] for key in moved]].astype(np.float64) @ to_local
            add_keys(part, moved, offsets.astype(np.float32), time=time)
            missing |= {key.vertex_group for key in moved} - {"", *part.vertex_groups.keys()}
            done += self._animate(source, part, [key.name for key in moved], absolute=time is not None)
        if missing:
            self._notes.append(
                f'"{target.name}" has no vertex group {listed(sorted(missing))}, by which shape keys of '
                f'"{source.name}" are limited. Carry the weights over first.'
            )
        self._notes = list(dict.fromkeys(self._notes))
        done = [counted(len(self._keys), "shape key"), *dict.fromkeys(done)]
        return TransferReport(", ".join(done), tuple(self._notes))

    def _chosen(self, source: Side, target: Side) -> list[str]:
        """Names of the keys to carry, in the order of the source; what lays it onto the target stays there."""
        names = list(all_key_names(source))
        if self._settings.choice == "ALL":
            names = [name for name in names if not is_wrap_key(name, target.name)]
        if not names:
            raise NothingToCarryError(
                f'"{source.name}" has no shape keys beside the basis, so there are none to carry over.'
            )
        if self._settings.choice == "ACTIVE":
            active = next(filter(None, (part.active_shape_key for part in parts_of(source))), None)
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
        return names

    def _animate(self, source: Side, target: bpy.types.Object, names: list[str], *, absolute: bool) -> list[str]:
        """Copy the drivers of the keys that were written, and share their action; say what was done."""
        theirs = cast("bpy.types.Key", keys_of(target))
        done = []
        for part in parts_of(source):
            mine, held = keys_of(part), [name for name in names if name in shape_key_names(part)]
            if mine is None or not held:
                continue
            paths = key_paths(held, absolute=absolute)
            if self._settings.drivers:
                places = counterparts(part, target, find_armature(part), find_armature(target))
                count, kept = copy_key_drivers(mine, theirs, paths, places)
                if count:
                    done.append(counted(count, "driver"))
                if kept:
                    points = listed(sorted(kept))
                    self._notes.append(f'Drivers of the shape keys of "{target.name}" still point to {points}.')
            if self._settings.action:
                shared, note = share_key_action(part, target, paths)
                if shared:
                    done.append(f'the action "{shared}"')
                if note:
                    self._notes.append(note)
        return done


def _read_part(context: bpy.types.Context, obj: bpy.types.Object, names: list[str]) -> NDArray[np.float64]:
    """Read by how much keys move the vertices of one part in the world, (k, n, 3): not at all where it lacks them."""
    offsets = np.zeros((len(names), len(mesh_of(obj).vertices), 3))
    present = shape_key_names(obj)
    held = [number for number, name in enumerate(names) if name in present]
    if not held:
        return offsets
    relative = cast("bpy.types.Key", keys_of(obj)).use_relative
    local = read_offsets(obj, [names[n] for n in held], from_reference=names if relative else present)
    offsets[held] = local @ linear_part(context, obj).T
    return offsets
