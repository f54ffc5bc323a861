# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes, hair and accessories of the source, fitted to the target."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np
from scipy.sparse import csr_array, diags_array

from ...engine import (
    ClosestPoints,
    Skeleton,
    TriangleMesh,
    WeightedItem,
    WornItem,
    carry_weights,
    follow_keys_steps,
    handed_weights,
    kept_in_place,
    mend_weights_steps,
    pair_bones,
    row_sums,
    wear_steps,
    within,
    wrap_steps,
)
from ..common.access import mesh_of
from ..common.errors import NothingToCarryError, ObjectError
from ..common.phrases import counted, listed
from ..jobs.transfer import TransferReport
from ..scene.armatures import SourceRig, armature_of, find_armature, read_rig
from ..scene.binding import bind
from ..scene.character import parts_of, read_surface
from ..scene.deform_layer import check_weights_writable, read_weights, write_weights
from ..scene.garment_shape_io import write_shape
from ..scene.garments import (
    bound_items,
    check_item,
    dressed_at_rest,
    fitted_copy,
)
from ..scene.mesh_io import add_colors, position_digest, read_mesh, topology
from ..scene.pair import check_writable, named_object
from ..scene.shape_key_io import KeySettings, add_keys, check_keys_writable, key_positions, keys_of, shape_key_names
from .body_below import cover_body
from .followed_keys import BodyKeys, read_body_keys, write_followed
from .item_bones import ItemBones, read_item_bones
from .item_weights import ItemWeights, chosen_weights, in_columns, replaced
from .options.rig import RigSettings
from .options.weights import WeightSettings
from .rig import RigTransfer
from .weights import WeightTransfer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ...engine import BonePairing, FittedItem, Steps
    from ..jobs.transfer import Passage
    from ..scene.armature_copy import NewBone
    from ..scene.character import Side
    from .options.wear import WearSettings

__all__ = ["WearTransfer", "painted_groups"]

painted_groups = ("Rigid", "Tight", "Loose", "Leave")
"""Names of vertex groups of an item that steer how it is fitted."""

_FAR, _BESIDE = 0.25, 0.3
"""How far from the body, in the root of its area, the nearest vertex of an item may be, and half of them."""

_MOST_THROUGH = 0.003
"""If more of an item is below the skin still, that is told."""

_MENTIONED = 0.01
"""If less of an item was pushed, that is not mentioned."""

_UNSURE, _MOST_UNSURE = 0.35, 0.1
"""Confidence of the map from which on the place of an item is believed; and if more of it is not, that is told."""

_MOST_BARE = 0.1
"""If more of an item has no skin below it any more, that is told."""

_KEY = "Fit to "

_FIT_NAMES = "Distance to Skin", "Pushed", "Uncertain"
"""What the color attributes of a fitted item show."""


@dataclass(frozen=True, eq=False)
class _Item:
    """An item as it was read."""

    name: str
    uid: int
    state: tuple[str, str]
    worn: WornItem
    at_rest: bool
    weights: ItemWeights


class WearTransfer:
    """Fits clothes of the source to the target; see `Transfer`.

    Parameters
    ----------
    settings : WearSettings
        Which, and how.
    """

    label = "Clothes"
    uses_rig = True

    def __init__(self, settings: WearSettings) -> None:
        self._settings = settings
        self._items: list[_Item] = []
        self._first: list[WeightTransfer | RigTransfer] = []
        self._posed: NDArray[np.float64] | None = None
        self._bones: csr_array | None = None
        self._names: tuple[str, ...] = ()
        self._fitted: list[FittedItem] = []
        self._motion: NDArray[np.float64] = np.eye(4)
        self._growth = 1.0
        self._other: SourceRig | None = None
        self._old_bones: set[str] = set()
        self._weights: list[ItemWeights | None] = []
        self._mended: list[tuple[str, int]] = []
        self._item_bones: ItemBones | None = None
        self._new_bones: list[NewBone] = []
        self._handed = False
        self._keys: BodyKeys | None = None
        self._followed: list[NDArray[np.float64]] = []
        self._notes: list[str] = []
        self._ends: list[str] = []

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read all items, and make sure that they can be fitted."""
        settings = self._settings
        chosen = self._chosen(context, source, target)
        depsgraph = context.evaluated_depsgraph_get()
        self._ends = [item.name for item in chosen if item in parts_of(source)]
        for item in chosen:
            check_item(context, item, source, target, chosen)
            if settings.result == "KEY":
                check_keys_writable(item, [_KEY + target.name])
                check_writable(item)
        if settings.hide != "NONE":
            for part in parts_of(target):
                check_weights_writable(part)
                check_keys_writable(part, [])
        rig = read_rig(source)
        names = () if rig is None else rig.names
        self._bones = None if rig is None else rig.weights
        self._names = names
        if any(not dressed_at_rest(item, source) for item in chosen):
            self._posed = read_surface(source, depsgraph, use_modifiers=True).vertices
        self._other = read_rig(target)
        mover = find_armature(source)
        self._old_bones = (
            set() if mover is None else {bone.name for bone in armature_of(mover).bones if bone.use_deform}
        )
        body, other = (read_surface(side, depsgraph, use_modifiers=False) for side in (source, target))
        if settings.keys and settings.result == "OBJECT":
            self._keys = read_body_keys(context, target)
            self._notes.extend(self._keys.notes)
        for item in chosen:
            self._items.append(self._read_item(depsgraph, item, source, names))
            around = body.vertices if self._items[-1].at_rest or self._posed is None else self._posed
            _check_place(self._items[-1], TriangleMesh(around, body.triangles), other, source, target)
        if settings.result == "OBJECT":
            self._read_rigs(context, source, target, rig)

    def _read_rigs(self, context: bpy.types.Context, source: Side, target: Side, rig: SourceRig | None) -> None:
        """Read what becomes of the rig that moves the source: bones of the items go along, or all of it is fitted."""
        settings = self._settings
        if self._other is not None and settings.weights != "SKIN":
            self._item_bones, note = read_item_bones(source, target, rig, [item.weights for item in self._items])
            self._notes += [note] if note else []
        if find_armature(target) is None and rig is not None and settings.fit_rig:
            self._first = [WeightTransfer(WeightSettings()), RigTransfer(RigSettings())]
            for transfer in self._first:
                transfer.read(context, source, target)

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
        if not chosen:
            raise NothingToCarryError(
                f'No clothes of "{source.name}" were found: no other mesh is bound to its armature. Select the items '
                "together with both bodies, or name them."
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
        self._find_motion(pair.source, registered)
        self._fitted = [cast("Any", None)] * len(self._items)
        for at_rest in (True, False):
            numbers = [number for number, item in enumerate(self._items) if item.at_rest == at_rest]
            if not numbers:
                continue
            body = pair.source
            if not at_rest and self._posed is not None:
                body = TriangleMesh(self._posed, body.triangles)
            worn = [self._items[number].worn for number in numbers]
            made = wear_steps(body, pair.target, there, registered, worn, bones=self._bones)
            found = yield from within(made, start, 0.9)
            for number, fitted in zip(numbers, found, strict=True):
                self._fitted[number] = fitted
            start = 0.9
        self._weights = [None] * len(self._items)
        if self._settings.result == "OBJECT":
            yield from within(self._moving_steps(passage), 0.9, 1.0)

    def _moving_steps(self, passage: Passage) -> Steps[None]:
        """Find how all items are moved with the body: their weights and keys."""
        other = self._other
        if other is None and self._first and passage.rig is not None:
            weights = carry_weights(passage.rig.weights, passage.pair.target_to_source)
            skeleton = Skeleton(passage.rig.skeleton.parents, passage.rig.heads, passage.rig.tails)
            other = SourceRig("", passage.bone_names, skeleton, weights)
        if other is not None:
            yield from within(self._weight_steps(passage, other), 0.0, 0.4)
        if self._keys is not None and len(self._keys.settings):
            yield from within(self._key_steps(passage.pair.target, self._keys, other), 0.4, 1.0)

    def _key_steps(self, body: TriangleMesh, keys: BodyKeys, rig: SourceRig | None) -> Steps[None]:
        """Find how the items follow the body's keys."""
        worn = []
        for item, fitted, weights in zip(self._items, self._fitted, self._weights, strict=True):
            bones = None if rig is None or weights is None else in_columns(weights, rig.names)
            mesh = TriangleMesh(fitted.positions, item.worn.mesh.triangles)
            worn.append(replace(item.worn, mesh=mesh, bones=bones, pieces=fitted.pieces, margin=0.0))
        on_skin = None if rig is None else rig.weights
        self._followed = yield from follow_keys_steps(body, keys.offsets, worn, bones=on_skin)

    def _weight_steps(self, passage: Passage, rig: SourceRig) -> Steps[None]:
        """Find the weights of all items."""
        there = passage.pair.source_to_target
        spread = csr_array(
            (there.barycentric.ravel(), there.corners.ravel(), np.arange(0, 3 * len(there) + 1, 3)),
            shape=(len(there), there.image_vertex_count),
        )
        on_skin = csr_array(spread @ rig.weights)
        brought = () if self._item_bones is None else self._item_bones.names
        skins = [csr_array(fitted.places @ on_skin) for fitted in self._fitted]
        lost = [name for name in self._names if name in self._old_bones and name not in (*rig.names, *brought)]
        pairing = self._pairing(passage, rig, lost)
        self._handed = pairing is not None
        if self._item_bones is not None:
            placed = [
                (item.weights, item.worn.mesh.vertices, fitted)
                for item, fitted in zip(self._items, self._fitted, strict=True)
            ]
            self._new_bones = self._item_bones.placed(placed, skins, rig, pairing)
        every = tuple(dict.fromkeys([*rig.names, *brought]))
        found = []
        for item, fitted, carried in zip(self._items, self._fitted, skins, strict=True):
            if pairing is not None and passage.rig is not None and self._bones is not None:
                columns = in_columns(item.weights, self._names)
                own = csr_array(columns @ diags_array(np.isin(self._names, lost).astype(float)))
                below, bones = csr_array(fitted.places @ self._bones), (passage.rig.skeleton, rig.skeleton)
                carried = handed_weights(own, below, carried, fitted.positions, pairing=pairing, bones=bones)  # noqa: PLW2901
            spread_out = in_columns(ItemWeights(rig.names, carried), every)
            old = self._old_bones - set(brought)
            handed = pairing is not None
            found.append(chosen_weights(item.weights, every, spread_out, old, self._settings, handed=handed))
        if self._settings.poses:
            weighted = [
                WeightedItem(fitted.positions, item.worn.mesh.triangles, in_columns(weights, rig.names))
                for item, fitted, weights in zip(self._items, self._fitted, found, strict=True)
            ]
            mended = yield from mend_weights_steps(
                weighted, body=passage.pair.target, skin_weights=rig.weights, skeleton=rig.skeleton
            )
            for number, one in enumerate(mended):
                found[number] = replaced(found[number], rig.names, one.weights, one.changed)
                self._mended.append((self._items[number].name, int(one.changed.sum())))
        self._weights = list(found)

    def _pairing(self, passage: Passage, rig: SourceRig, lost: Sequence[str]) -> BonePairing | None:
        """Pair the bones of both rigs, if items have weights in bones (of names that are lost) that the other lacks."""
        if self._settings.weights != "AUTO" or passage.rig is None or passage.bone_names != self._names:
            return None
        if not any(in_columns(item.weights, lost).nnz for item in self._items):
            return None
        pairing = pair_bones(passage.rig, passage.pair.source, passage.pair.target, rig.skeleton, rig.weights)
        return pairing if len(pairing) else None

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write the fitted items."""
        items = [self._still_there(item) for item in self._items]
        reports = [transfer.write(context, source, target) for transfer in self._first]
        notes = [*self._notes, *(note for report in reports for note in report.notes)]
        remarks: list[str] = [remark for report in reports for remark in report.remarks]
        if self._new_bones:
            ItemBones.write(context, target, self._new_bones)
            count = counted(len(self._new_bones), "bone")
            remarks.append(f'{count} of the items were added to the rig of "{target.name}".')
        made: list[bpy.types.Object] = []
        for number, (item, obj, fitted) in enumerate(zip(self._items, items, self._fitted, strict=True)):
            if self._settings.result == "KEY":
                self._write_key(obj, target, fitted)
                made.append(obj)
            else:
                copy, said = self._write_copy(context, obj, (source, target), fitted, self._weights[number])
                made.append(copy)
                notes.extend(note for note in said if note not in notes)
                if self._keys is not None and self._followed:
                    followed = len(write_followed(copy, target, self._keys, self._followed[number]))
                    if followed:
                        remarks.append(f'"{copy.name}" follows {counted(followed, "shape key")} of "{target.name}".')
            if self._settings.colors:
                _write_colors(made[-1], fitted)
            remarks.append(_done(item.name, fitted))
            doubt = _doubt(item.name, fitted)
            if doubt:
                notes.append(doubt)
        remarks.extend(
            f'"{name}" counts as part of the body as well: "{source.name}" has no skin below it.' for name in self._ends
        )
        if any(weights is not None and weights.from_skin and weights.lost for weights in self._weights):
            remarks.append(
                f'The rig of "{target.name}" has other bones, so the weights were taken from its skin and from the '
                "bones that are paired with the items' own."
                if self._handed
                else f'The rig of "{target.name}" has other bones, so the weights were taken from its skin.'
            )
        remarks.extend(
            f'Weights of {counted(count, "vertex")} of "{name}" were mended for poses.'
            for name, count in self._mended
            if count
        )
        if self._settings.hide != "NONE":
            below = [
                (fitted.positions, item.worn.mesh.triangles)
                for item, fitted in zip(self._items, self._fitted, strict=True)
            ]
            cover_body(context, target, below, self._settings.hide)
        done = [report.done for report in reports if report.done]
        done.append(counted(len(made), "item"))
        return TransferReport(", ".join(done), tuple(notes), tuple(remarks))

    def _read_item(
        self,
        depsgraph: bpy.types.Depsgraph,
        item: bpy.types.Object,
        source: Side,
        names: tuple[str, ...],
    ) -> _Item:
        """Read an item with what steers it."""
        stored: Any = cast("Any", item).hiermatch_wear
        mesh = read_mesh(item, depsgraph, use_modifiers=False)
        weights = read_weights(item)
        numbers = {name: number for number, name in enumerate(names)}
        groups = [group for group in item.vertex_groups if group.name in numbers]
        bones = None
        if groups and self._bones is not None:
            columns = weights[:, [group.index for group in groups]].tocoo()
            places = np.array([numbers[group.name] for group in groups], np.int64)
            bones = csr_array((columns.data, (columns.row, places[columns.col])), shape=(mesh.vertex_count, len(names)))
            total = row_sums(bones)
            bones = csr_array(diags_array(1 / np.where(total > 0, total, 1)) @ bones)
            if (total <= 0).any():  # accessory bones of its own: they say nothing of the body's
                bones = None
        rigid, tight, loose, left = (_painted(item, weights, name) for name in painted_groups)
        tightness = None if tight is None and loose is None else _or_none(tight, mesh) - _or_none(loose, mesh)
        worn = WornItem(
            mesh,
            bones,
            stored.fit,
            rigid=None if rigid is None else rigid > 0.5,
            find_rigid=stored.find_rigid,
            tightness=tightness,
            left=None if left is None else left > 0.5,
            margin=self._settings.clearance,
        )
        state = topology(mesh_of(item)), position_digest(mesh_of(item))
        names_of = tuple(group.name for group in item.vertex_groups)
        locked = frozenset(group.name for group in item.vertex_groups if group.lock_weight)
        own = ItemWeights(names_of, weights, locked)
        return _Item(item.name, item.session_uid, state, worn, dressed_at_rest(item, source), own)

    def _still_there(self, item: _Item) -> bpy.types.Object:
        """Look an item up again.

        Raises
        ------
        ObjectError
            If it was deleted or edited since.
        """
        obj = next((one for one in bpy.data.objects if one.session_uid == item.uid), None)
        if obj is None:
            raise ObjectError(f'"{item.name}" was deleted meanwhile. Nothing was written.')
        if (topology(mesh_of(obj)), position_digest(mesh_of(obj))) != item.state:
            raise ObjectError(f'"{obj.name}" was edited meanwhile. Nothing was written.')
        return obj

    def _find_motion(self, source: TriangleMesh, images: NDArray[np.float64]) -> None:
        """Find how the body turns and moves on the whole."""
        turned_back = kept_in_place(source, images)
        weights = source.vertex_areas / source.area
        centre, back = weights @ images, weights @ turned_back
        x, y = turned_back - back, images - centre
        left, _, right = np.linalg.svd(y.T @ (weights[:, None] * x))
        left[:, 2] *= np.sign(np.linalg.det(left @ right))
        self._motion = np.eye(4)
        self._motion[:3, :3] = left @ right
        self._motion[:3, 3] = centre - self._motion[:3, :3] @ (weights @ source.vertices)

    def _write_key(self, obj: bpy.types.Object, target: Side, fitted: FittedItem) -> None:
        """Write a shape key that moves the item itself to the other body."""
        matrix = np.linalg.inv(np.array(obj.matrix_world, np.float64))
        local = fitted.positions @ matrix[:3, :3].T + matrix[:3, 3]
        keys = keys_of(obj)
        rest = (
            np.array([vertex.co for vertex in mesh_of(obj).vertices])
            if keys is None
            else key_positions(keys.reference_key)
        )
        name = _KEY + target.name
        others = [other for other in shape_key_names(obj) if other.startswith(_KEY) and other != name]
        add_keys(obj, [KeySettings(name, value=float(not others))], (local - rest)[None])

    def _write_copy(
        self,
        context: bpy.types.Context,
        item: bpy.types.Object,
        bodies: tuple[Side, Side],
        fitted: FittedItem,
        weights: ItemWeights | None,
    ) -> tuple[bpy.types.Object, list[str]]:
        """Write a fitted copy; return it, and what is to be known."""
        source, target = bodies
        notes: list[str] = []
        growth = float(np.median(fitted.scales))
        copy, kept = fitted_copy(context, item, source, target, motion=self._motion, growth=growth)
        if kept:
            notes.append(
                f'Drivers of the shape keys of "{copy.name}" still read from {listed(kept)}: "{target.name}" has not '
                "what they need. Carry its shape keys or bones over by Retarget, and fit it again."
            )
        write_shape(copy, item, fitted.positions, fitted.rotations * fitted.scales[:, None, None])
        armature = find_armature(target)
        if armature is None:
            notes.append(
                f'"{target.name}" has no armature, so what was fitted to it is not bound. Give it one by Retarget, '
                "and fit it again."
            )
        elif weights is not None:
            _write_weights(copy, weights)
            if weights.lost and not weights.from_skin:
                notes.append(
                    f'The armature "{armature.name}" has no bones {listed(weights.lost)} of "{item.name}". What they '
                    "moved is moved by the bones of the skin below."
                )
        mover = find_armature(source)
        for modifier in [modifier for modifier in copy.modifiers if modifier.type == "ARMATURE"]:
            changed: Any = modifier
            if armature is None and changed.object in (mover, None):
                copy.modifiers.remove(modifier)
            elif changed.object == mover:
                changed.object = armature
        if armature is not None:
            bind(copy, armature, item)
        return copy, notes


def _write_weights(copy: bpy.types.Object, weights: ItemWeights) -> None:
    """Write weights where they are not locked, and drop the groups of bones that are not there."""
    for name in weights.lost:
        copy.vertex_groups.remove(copy.vertex_groups[name])
    free = [number for number, name in enumerate(weights.names) if name not in weights.locked]
    write_weights(copy, [weights.names[number] for number in free], csr_array(weights.weights[:, free]))


def _painted(item: bpy.types.Object, weights: csr_array, name: str) -> NDArray[np.float64] | None:
    """Return the weights of a painted group, (n,); none if there is none such."""
    group = item.vertex_groups.get(name)
    return None if group is None else weights[:, [group.index]].toarray().ravel()


def _or_none(values: NDArray[np.float64] | None, mesh: TriangleMesh) -> NDArray[np.float64]:
    return np.zeros(mesh.vertex_count) if values is None else values


def _check_place(item: _Item, body: TriangleMesh, other: TriangleMesh, source: Side, target: Side) -> None:
    """Make sure that an item lies on the body.

    Raises
    ------
    ObjectError
        If it does not.
    """
    points = item.worn.mesh.vertices
    unit = float(np.sqrt(body.area))
    away = np.sqrt(ClosestPoints(body).nearest(points).squared_distances) / unit
    if away.min() <= _FAR and np.median(away) <= _BESIDE:
        return
    there = np.sqrt(ClosestPoints(other).nearest(points).squared_distances) / float(np.sqrt(other.area))
    if there.min() < _FAR and np.median(there) < _BESIDE:
        raise ObjectError(
            f'"{item.name}" lies on "{target.name}", not on "{source.name}". Swap Source and Target, or take it out '
            "of the items."
        )
    if away.min() <= _FAR:
        raise ObjectError(
            f'There is no body under most of "{item.name}": "{source.name}" has no surface there. Pick the whole body '
            "as the Source, or take the item out."
        )
    raise ObjectError(
        f'"{item.name}" is far from "{source.name}". Move it to where the body wears it, or pick that '
        "body as the Source."
    )


def _done(name: str, fitted: FittedItem) -> str:
    """Say in a sentence what was done with an item."""
    parts = []
    pieces = int(fitted.pieces.max(initial=-1)) + 1
    if pieces:
        parts.append(f"kept {counted(pieces, 'rigid part')} as they are")
    moved = float((fitted.pushed > 0).mean())
    if moved > _MENTIONED:
        parts.append(f"pushed {moved:.0%} of it out of what is below")
    return f'"{name}" was fitted: {", ".join(parts)}.' if parts else f'"{name}" was fitted.'


def _doubt(name: str, fitted: FittedItem) -> str:
    """Say what to check of an item; empty if there is nothing."""
    parts = []
    if fitted.through > _MOST_THROUGH:
        parts.append(f"what is below still shows through {fitted.through:.1%} of it")
    unsure = float((fitted.confidence < _UNSURE).mean())
    if unsure > _MOST_UNSURE:
        parts.append(f"the match is uncertain below {unsure:.0%} of it")
    bare = float(fitted.bare.mean())
    if bare > _MOST_BARE:
        parts.append(f"the body ends below {bare:.0%} of it")
    return f'"{name}" should be checked: {", ".join(parts)}.' if parts else ""


def _write_colors(obj: bpy.types.Object, fitted: FittedItem) -> None:
    """Write color attributes: distance to the skin, how far each vertex was pushed, and where it is uncertain."""
    unit = max(float(np.quantile(np.abs(fitted.clearance), 0.95)), 1e-12)
    pushed = fitted.pushed / max(float(fitted.pushed.max(initial=0.0)), 1e-12)
    shown = ((fitted.clearance / unit).clip(0, 1), pushed, 1 - fitted.confidence.clip(0, 1))
    inside = fitted.clearance < 0
    mesh = mesh_of(obj)
    for name, values in zip(_FIT_NAMES, shown, strict=True):
        colors = np.ones((len(values), 4), np.float32)
        # From white over orange to dark red; what is inside the skin is blue.
        colors[:, 0], colors[:, 1], colors[:, 2] = 1 - 0.5 * values**2, 1 - 0.9 * values, (1 - values) ** 2
        if name == _FIT_NAMES[0]:
            colors[inside] = (0.05, 0.1, 0.9, 1.0)
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
        add_colors(mesh, name, colors)
