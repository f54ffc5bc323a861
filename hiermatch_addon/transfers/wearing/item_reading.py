# SPDX-License-Identifier: GPL-3.0-or-later
"""Items that the source wears, as they are read and looked up again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from scipy.sparse import csr_array, diags_array, hstack

from ....engine import ClosestPoints, TriangleMesh, WornItem, row_sums
from ...common.errors import ObjectError
from ...scene.armatures import find_armature, held_by
from ...scene.character import ReadSide
from ...scene.deform_layer import read_weights
from ...scene.mesh_io import read_mesh
from ...scene.worn.garments import dressed_at_rest
from ...scene.worn.smoothing import moved_mesh, smoothing_offsets
from .item_weights import ItemWeights, in_columns

if TYPE_CHECKING:
    from collections.abc import Collection

    import bpy
    from numpy.typing import NDArray

    from ....engine import FittedItem
    from ...scene.armatures import SourceRig
    from ...scene.character import Side

painted_groups = ("Rigid", "Tight", "Loose", "Leave")
"""Names of vertex groups of an item that steer how it is fitted."""

_FAR, _BESIDE = 0.25, 0.3
"""How far from the body, in the root of its area, the nearest vertex of an item may be, and half of them."""


@dataclass(frozen=True, eq=False)
class ReadItem:
    """An item as it was read.

    Attributes
    ----------
    side : ReadSide
        Which object it is, and how it was.
    worn : WornItem
        What the engine has to know of it.
    at_rest : bool
        Whether it lies on the body at rest.
    weights : ItemWeights
        In all its groups.
    held : bool
        Whether it hangs on one bone as a whole.
    smoothing : (n, 3) array of float
        How far Subdivision moves its vertices to where they are seen, and where `worn` has them.
    """

    side: ReadSide
    worn: WornItem
    at_rest: bool
    weights: ItemWeights
    held: bool
    smoothing: NDArray[np.float64]

    @property
    def name(self) -> str:
        """What it was called."""
        return self.side.name


def read_item(
    context: bpy.types.Context, item: bpy.types.Object, source: Side, rig: SourceRig | None, clearance: float
) -> ReadItem:
    """Read an item with what steers it, and its weights for the bones of the rig that moves the body.

    Clearance is the least distance from the skin, in the target's units.
    """
    names = () if rig is None else rig.names
    stored: Any = cast("Any", item).hiermatch_wear
    held = _bone_of(item, source) in names
    smoothing = smoothing_offsets(context, item)
    mesh = moved_mesh(read_mesh(item, context.evaluated_depsgraph_get(), use_modifiers=False), smoothing)
    weights = read_weights(item)
    own = _own_weights(item, weights, source, names)
    in_bones = in_columns(own, names)
    total = row_sums(in_bones)
    # Without weights, or with those of accessory bones of its own, nothing is said of the body's bones.
    bones = None if (total <= 0).any() else csr_array(diags_array(1 / total) @ in_bones)
    rigid, tight, loose, left = (_painted(item, weights, name) for name in painted_groups)
    tightness = None if tight is None and loose is None else _or_none(tight, mesh) - _or_none(loose, mesh)
    worn = WornItem(
        mesh,
        bones,
        "RIGID" if held and stored.fit == "AUTO" else stored.fit,  # on its own body it cannot bend
        rigid=None if rigid is None else rigid > 0.5,
        find_rigid=stored.find_rigid,
        tightness=tightness,
        left=None if left is None else left > 0.5,
        margin=clearance,
    )
    return ReadItem(ReadSide.of(item), worn, dressed_at_rest(item, source), own, held, smoothing)


def as_cage(fitted: FittedItem, item: ReadItem) -> FittedItem:
    """Return what is to be written of a fitted item, such that its vertices are seen where they were fitted."""
    back = np.einsum("nij,nj->ni", fitted.rotations * fitted.scales[:, None, None], item.smoothing)
    return replace(fitted, positions=fitted.positions - back)


def _bone_of(item: bpy.types.Object, source: Side) -> str:
    """Return the bone of the source's armature that an item hangs on as a whole; empty if there is none."""
    armature = find_armature(source)
    return "" if armature is None else held_by(item, armature)


def _own_weights(item: bpy.types.Object, weights: csr_array, source: Side, bones: Collection[str]) -> ItemWeights:
    """Return the weights of an item in all its groups; one that hangs on a bone is moved by that bone of them alone."""
    names = tuple(group.name for group in item.vertex_groups)
    locked = frozenset(group.name for group in item.vertex_groups if group.lock_weight)
    bone = _bone_of(item, source)
    if bone not in bones:
        return ItemWeights(names, weights, locked)
    others = [number for number, name in enumerate(names) if name not in bones]
    whole = csr_array(np.ones((weights.shape[0], 1)))
    return ItemWeights((*(names[one] for one in others), bone), csr_array(hstack([weights[:, others], whole])), locked)


def _painted(item: bpy.types.Object, weights: csr_array, name: str) -> NDArray[np.float64] | None:
    """Return the weights of a painted group, (n,); none if there is none such."""
    group = item.vertex_groups.get(name)
    return None if group is None else weights[:, [group.index]].toarray().ravel()


def _or_none(values: NDArray[np.float64] | None, mesh: TriangleMesh) -> NDArray[np.float64]:
    return np.zeros(mesh.vertex_count) if values is None else values


def check_place(item: ReadItem, body: TriangleMesh, other: TriangleMesh, source: Side, target: Side) -> None:
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
