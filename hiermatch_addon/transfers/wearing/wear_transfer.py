# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes, hair and accessories of the source, fitted to the target."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ....engine import ClosestPoints, TriangleMesh, nearest_similarity, wear_steps, within, wrap_steps
from ...common.access import view_layer_of
from ...common.errors import NothingToCarryError, ObjectError
from ...common.phrases import counted, listed
from ...jobs.transfer import Transfer, TransferReport
from ...scene.armatures import armature_of, find_armature, read_rig
from ...scene.character import Character, parts_of, read_surface, whole
from ...scene.deform_layer import check_weights_writable
from ...scene.mesh_io import TOPOLOGY_MODIFIERS, without_modifiers
from ...scene.pair import named_object
from ...scene.posing.before_after import show_after
from ...scene.shape_key_io import check_keys_writable
from ...scene.worn.fitted_copies import as_fitted
from ...scene.worn.garments import bound_items, check_item, left_behind
from ...scene.worn.smoothing import moved_mesh, smoothing_offsets
from ..options.rig import RigSettings
from ..options.weights import WeightSettings
from ..rig import RigTransfer
from ..weights import WeightTransfer
from .body_below import cover_body, worn_already
from .fit_colors import write_colors
from .fit_report import done, doubt
from .followed_keys import apart_from, lacking, read_body_keys, write_followed
from .item_bones import ItemBones, read_item_bones
from .item_motion import ItemMotion
from .item_reading import as_cage, check_place, read_item
from .item_writing import check_key, write_copy, write_key

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

    from ....engine import FittedItem, Steps
    from ...jobs.transfer import Passage
    from ...scene.armatures import SourceRig
    from ...scene.character import Side
    from ...storage.vertex_maps import MapPair
    from ..options.wear import WearSettings
    from .followed_keys import BodyKeys
    from .item_reading import ReadItem


class WearTransfer(Transfer):
    """Fits clothes of the source to the target; see `Transfer`.

    Parameters
    ----------
    settings : WearSettings
        Which, and how.
    """

    label = "Clothes"
    mirrors = False

    def __init__(self, settings: WearSettings) -> None:
        self._settings = settings
        self._items: list[ReadItem] = []
        self._first: list[WeightTransfer | RigTransfer] = []
        self._worn_on: list[tuple[str, ...] | None] = []
        self._bodies: dict[tuple[str, ...] | None, NDArray[np.float64]] = {}
        self._every: NDArray[np.int64] | None = None
        self._rig: SourceRig | None = None
        self._moving: ItemMotion | None = None
        self._keys: BodyKeys | None = None
        self._moved = (np.zeros((0, 3)), np.zeros((0, 3)))
        self._fitted: list[FittedItem] = []
        self._motion: NDArray[np.float64] = np.eye(4)  # how the body turns and moves on the whole
        self._notes: list[str] = []
        self._ends: list[str] = []

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read all items, and make sure that they can be fitted."""
        settings = self._settings
        chosen = self._chosen(context, source, target)
        self._ends = [item.name for item in chosen if item in parts_of(source)]
        for item in chosen:
            check_item(context, item, source, target, chosen, writable=settings.result == "KEY")
            if settings.result == "KEY":
                check_key(item, target)
        if settings.hide != "NONE":
            for part in parts_of(target):
                check_weights_writable(part)
                check_keys_writable(part, [])
        self._rig = read_rig(source)
        self._moved = smoothing_offsets(context, source), smoothing_offsets(context, target)
        depsgraph = context.evaluated_depsgraph_get()
        body, other = (
            moved_mesh(read_surface(side, depsgraph, use_modifiers=False), moved)
            for side, moved in zip((source, target), self._moved, strict=True)
        )
        if isinstance(source, Character) and source.left_out:
            self._every = read_surface(whole(source), depsgraph, use_modifiers=False).triangles
        if settings.keys and settings.result == "OBJECT":
            self._keys = read_body_keys(context, target)
            self._notes.extend(self._keys.notes)
        else:
            keys = lacking(read_body_keys(context, target, shown=True), *chosen)
            self._moved = self._moved[0], keys.shown_on(self._moved[1])
        shown = read_body_keys(context, source, shown=True)
        for obj in chosen:
            read = read_item(context, obj, source, self._rig, settings.clearance)
            keys = apart_from(shown, body, obj, read.worn.mesh.vertices)
            worn_on = keys.names if read.at_rest else None
            if worn_on not in self._bodies:
                self._bodies[worn_on] = keys.shown_on(body.vertices) if read.at_rest else _posed(context, source)
            check_place(read, TriangleMesh(self._bodies[worn_on], body.triangles), other, source, target)
            self._items.append(read)
            self._worn_on.append(worn_on)
        if settings.result == "OBJECT":
            self._read_rigs(context, source, target)

    def _read_rigs(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read what becomes of the rig that moves the source: bones of the items go along, or all of it is fitted."""
        settings, rig, other, item_bones = self._settings, self._rig, read_rig(target), None
        if other is not None and settings.weights != "SKIN":
            item_bones, note = read_item_bones(source, target, rig, [item.weights for item in self._items])
            self._notes += [note] if note else []
        if find_armature(target) is None and rig is not None and settings.fit_rig:
            self._first = [WeightTransfer(WeightSettings()), RigTransfer(RigSettings())]
            for transfer in self._first:
                transfer.read(context, source, target)
        mover = find_armature(source)
        old = set() if mover is None else {bone.name for bone in armature_of(mover).bones if bone.use_deform}
        self._moving = ItemMotion(
            settings, rig, other, fits_rig=bool(self._first), old_bones=old, item_bones=item_bones, keys=self._keys
        )

    def _chosen(self, context: bpy.types.Context, source: Side, target: Side) -> list[bpy.types.Object]:
        """Return the items: those that are named, or else all that the source's armature moves.

        Raises
        ------
        ObjectError
            If there is none, or none of a name.
        """
        chosen = [named_object(name) for name in dict.fromkeys(self._settings.items)]
        if not chosen:
            chosen = [obj for obj in bound_items(context, source) if obj not in parts_of(target)]
        if not chosen and len(parts_of(source)) > 1:
            raise NothingToCarryError(
                f'No clothes of "{source.name}" were found: all of its meshes count as its body. Select only those of '
                "them that are worn, with the other body, or name them."
            )
        if not chosen:
            raise NothingToCarryError(
                f'No clothes of "{source.name}" were found: no other mesh is bound to its armature. Pick both '
                "bodies as Source and Target, and select the items, or name them."
            )
        return chosen

    def steps(self, passage: Passage) -> Steps[None]:
        """Fit the items."""
        pair, rig = passage.pair, passage.rig
        for number, transfer in enumerate(self._first):
            yield from within(transfer.steps(passage), 0.1 * number, 0.1 * (number + 1), transfer.label)
        start = 0.1 * len(self._first)
        there = pair.source_to_target
        registered = None if rig is None else rig.registered
        if registered is None:
            maps = there, pair.target_to_source
            wrapped = yield from within(wrap_steps(pair.source, pair.target, *maps), start, start + 0.3)
            registered, start = wrapped.positions, start + 0.3
        pair, registered = _as_seen(pair, registered, *self._moved)
        passage = replace(passage, pair=pair)
        turn = nearest_similarity(pair.source.vertices, registered, pair.source.vertex_areas, scale=1.0)
        self._motion[:3, :3], self._motion[:3, 3] = turn
        self._fitted = [cast("Any", None)] * len(self._items)
        bones = None if self._rig is None else self._rig.weights
        share = (0.9 - start) / len(self._bodies)
        for keys, vertices in self._bodies.items():
            numbers = [number for number, worn_on in enumerate(self._worn_on) if worn_on == keys]
            body = pair.source if keys == () else TriangleMesh(vertices, pair.source.triangles)
            worn = [self._items[number].worn for number in numbers]
            every = None if self._every is None else TriangleMesh(body.vertices, self._every)
            made = wear_steps(body, pair.target, there, registered, worn, bones=bones, whole=every)
            found = yield from within(made, start, start + share)
            for number, fitted in zip(numbers, found, strict=True):
                self._fitted[number] = fitted
            start += share
        if self._moving is not None:
            yield from within(self._moving.steps(passage, self._items, self._fitted), 0.9, 1.0)
            self._fitted = self._moving.fitted

    def check(self) -> None:
        """Make sure that all items are as they were."""
        for item in self._items:
            item.side.unchanged()

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write the fitted items, on the target as it is now."""
        show_after(target)
        items = [cast("bpy.types.Object", item.side.unchanged()) for item in self._items]
        reports = [transfer.write(context, source, target) for transfer in self._first]
        notes = [*self._notes, *(note for report in reports for note in report.notes)]
        remarks = [remark for report in reports for remark in report.remarks]
        if self._moving is not None and self._moving.new_bones:
            ItemBones.write(context, target, self._moving.new_bones)
            count = counted(len(self._moving.new_bones), "bone")
            remarks.append(f'{count} of the items were added to the rig of "{target.name}".')
        copies: list[bpy.types.Object] = []
        names: dict[str, str] = {}
        for number, (item, obj, fitted) in enumerate(zip(self._items, items, self._fitted, strict=True)):
            if self._moving is None:
                made = obj
                write_key(obj, target, as_cage(fitted, item))
            else:
                weights = self._moving.weights[number]
                cage, bodies = as_cage(fitted, item), (source, target)
                made, said = write_copy(context, obj, bodies, cage, weights=weights, motion=self._motion)
                notes.extend(note for note in said if note not in notes)
                if self._keys is not None and self._moving.followed:
                    followed = len(write_followed(made, target, self._keys, self._moving.followed[number]))
                    if followed:
                        remarks.append(f'"{made.name}" follows {counted(followed, "shape key")} of "{target.name}".')
            if self._settings.colors:
                write_colors(made, fitted)
            if made is not obj:
                copies.append(made)
            names[item.name] = made.name
            remarks.append(done(made.name, fitted, is_body=item.name in self._ends))
            notes.extend(filter(None, [doubt(made.name, fitted)]))
        notes.extend(_settled(context, copies, target))
        remarks.extend(
            f'"{name}" counts as part of the body as well: "{source.name}" has no skin below it.' for name in self._ends
        )
        remarks.extend([] if self._moving is None else self._moving.remarks(target.name, names))
        if self._settings.hide != "NONE":
            meshes = zip(self._fitted, (item.worn.mesh for item in self._items), strict=True)
            worn = [(one.positions, mesh.triangles) for one, mesh in meshes]
            cover_body(context, target, [*worn, *worn_already(context, target, copies)], self._settings.hide)
        written = [report.done for report in reports if report.done]
        return TransferReport(", ".join([*written, counted(len(items), "item")]), tuple(notes), tuple(remarks))


def _settled(context: bpy.types.Context, copies: Sequence[bpy.types.Object], target: Side) -> list[str]:
    """Let copies that were all made know each other, and say what is to be known of them now."""
    notes = []
    for copy in copies:
        kept = left_behind(copy, target)
        if kept:
            notes.append(
                f'Modifiers of "{copy.name}" still use {listed(kept)}, as those of the original do. Put a copy of it '
                f'where "{target.name}" is, and pick that.'
            )
        as_fitted(copy, target)
    layer = view_layer_of(context)
    layer.update()  # or it would not know of what was made just now
    unseen = [copy.name for copy in copies if not copy.visible_get(view_layer=layer)]
    if unseen:
        notes.append(f"The collection of {listed(unseen)} is hidden or left out. Show it in the Outliner.")
    return notes


def _posed(context: bpy.types.Context, body: Side) -> NDArray[np.float64]:
    """Read where the vertices of a body are as it is posed, whatever modifiers add to them or hide of them."""
    depsgraph = context.evaluated_depsgraph_get()
    try:
        return read_surface(body, depsgraph, use_modifiers=True).vertices
    except ObjectError:
        with without_modifiers(context, parts_of(body), TOPOLOGY_MODIFIERS.__contains__):
            cage = read_surface(body, context.evaluated_depsgraph_get(), use_modifiers=True).vertices
        return cage + smoothing_offsets(context, body, posed=True)


def _as_seen(
    pair: MapPair, images: NDArray[np.float64], at_source: NDArray[np.float64], at_target: NDArray[np.float64]
) -> tuple[MapPair, NDArray[np.float64]]:
    """Move both bodies to where they are seen, by (n, 3) and (m, 3), and with the target its images (n, 3)."""
    target = pair.target
    if at_target.any():
        found = ClosestPoints(target).nearest(images)
        moved = at_target[target.triangles[found.triangles]]
        images = images + np.einsum("kc,kci->ki", found.barycentric, moved)
    return replace(pair, source=moved_mesh(pair.source, at_source), target=moved_mesh(target, at_target)), images
