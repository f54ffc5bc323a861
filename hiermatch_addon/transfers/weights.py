# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of vertex groups, carried from one matched mesh to another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array

from ...engine import Columns, carry_weights_steps, put_in, row_sums
from ..common.access import mesh_of
from ..common.errors import ObjectError
from ..common.phrases import counted, listed
from ..common.side_names import flipped_name
from ..jobs.transfer import TransferReport
from ..scene import mesh_io
from ..scene.deform_layer import check_weights_writable, read_weights, write_weights
from ..storage.written_names import written_names
from .weight_groups import chosen_groups, deforming_bones, locked_groups

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

    from ...engine import Steps
    from ..jobs.transfer import Passage
    from .options.weights import WeightSettings

__all__ = ["WeightTransfer"]

_SUFFIX = "Rejected"

_TORN, _WHOLE = (0.7, 0.02, 0.02, 1.0), (1.0, 1.0, 1.0, 1.0)
"""Linear colors of vertices whose own weights were rejected, and of others."""

_WHOLE_SUM = 1e-3
"""How far from one the weights of a vertex may sum to that are shares of a whole."""


@dataclass(frozen=True, eq=False)
class _Task:
    """What was read: the names of g groups, and their weights on both objects."""

    names: list[str]
    columns: Columns
    telling: NDArray[np.bool_]
    source_weights: csr_array
    before: csr_array


class WeightTransfer:
    """Carries weights; see `Transfer`.

    Parameters
    ----------
    settings : WeightSettings
        Which groups, and how.
    """

    label = "Weights"
    uses_rig = True

    def __init__(self, settings: WeightSettings) -> None:
        self._settings = settings
        self._task: _Task | None = None
        self._result: csr_array = csr_array((0, 0))
        self._torn: NDArray[np.bool_] = np.zeros(0, bool)
        self._notes: list[str] = []

    def read(self, _context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> None:
        """Read the weights of both, and make sure that the target's can be written."""
        check_weights_writable(target)
        chosen = chosen_groups(source, self._settings.groups)
        taken = [name for name in chosen if name in written_names(target)]
        if taken:
            chosen = [name for name in chosen if name not in taken]
            self._notes.append(
                f'{listed(taken)} of "{source.name}" was left out: on "{target.name}" a match wrote what has that name.'
            )
        locked = locked_groups(target)
        stay = [name for name in chosen if name in locked]
        if stay:
            self._notes.append(f'Locked vertex groups of "{target.name}" were left alone: {listed(stay)}.')
        if len(stay) == len(chosen):
            raise ObjectError(
                f'All vertex groups to carry are locked on "{target.name}". Unlock some of them, or carry others.'
            )
        if self._settings.mark:
            self._check_mark(target)
        self._task = self._make_task(source, target, chosen, locked)

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute the weights of the target."""
        task, settings = self._read_task, self._settings
        carried = yield from carry_weights_steps(
            task.source_weights,
            passage.pair.source,
            passage.pair.target,
            passage.pair.target_to_source,
            telling=task.telling if task.telling.any() else None,
            fill=settings.fill,
        )
        self._torn = carried.torn
        self._result = put_in(
            task.before,
            carried.weights,
            task.columns,
            factor=settings.mix,
            add=settings.mode == "ADD",
            threshold=settings.clean,
            limit=settings.limit,
            normalise=settings.normalise,
        )

    def write(self, _context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> TransferReport:
        """Write the groups."""
        if self._settings.mark:
            self._check_mark(target)
        columns, names = self._read_task.columns, self._read_task.names
        written = ~columns.locked & (columns.new | (columns.shared & columns.yielding & self._settings.normalise))
        numbers = np.flatnonzero(written)
        write_weights(target, [names[number] for number in numbers], csr_array(self._result[:, numbers]))
        self._add_other_sides(source, target)
        if self._settings.mark:
            self._write_mark(target)
        filled = int(self._torn.sum())
        if filled:
            self._notes.append(
                f'Weights of {counted(filled, "vertex")} of "{target.name}" were filled in from the neighbors, far '
                f'from whose places on "{source.name}" the map had led.'
            )
        return TransferReport(counted(int((columns.new & ~columns.locked).sum()), "vertex group"), tuple(self._notes))

    @property
    def _read_task(self) -> _Task:
        if self._task is None:
            raise RuntimeError("Nothing was read yet.")
        return self._task

    def _make_task(
        self, source: bpy.types.Object, target: bpy.types.Object, chosen: list[str], locked: set[str]
    ) -> _Task:
        """Find out what is what among all groups that matter.

        Beside those to carry these are other groups of the target's bones: locked ones, which take their share of the
        whole, and if only some groups are carried, all others, which give way.
        """
        weights, own = read_weights(source), written_names(source)
        users = [group.index for group in source.vertex_groups if group.name not in own]
        bones = deforming_bones(source, target)
        if not bones and _is_whole(csr_array(weights[:, users])):
            # Without an armature to ask: groups that share out each vertex are those of bones.
            bones = {source.vertex_groups[number].name for number in users}
        some = self._settings.groups in ("SELECTED", "ACTIVE")
        besides = [
            group.name
            for group in target.vertex_groups
            if group.name in bones and group.name not in chosen and (some or group.name in locked)
        ]
        names = [*chosen, *besides]
        new = np.arange(len(names)) < len(chosen)
        shared = np.array([name in bones for name in names])
        columns = Columns(np.array([name in locked for name in names]), new, shared, yielding=some)
        return _Task(names, columns, shared & new, _columns(source, weights, names, new), _columns(target, None, names))

    def _add_other_sides(self, source: bpy.types.Object, target: bpy.types.Object) -> None:
        """Add the empty groups of the other side that the source has, for whoever mirrors the target."""
        for name in self._read_task.names:
            other = flipped_name(name)
            if other in source.vertex_groups and other not in target.vertex_groups:
                active = target.vertex_groups.active_index
                target.vertex_groups.new(name=other)
                target.vertex_groups.active_index = active or 0

    @property
    def _mark_name(self) -> str:
        return f"{self._settings.prefix} {_SUFFIX}"

    def _check_mark(self, target: bpy.types.Object) -> None:
        """Make sure that the color attribute can be written.

        Raises
        ------
        ObjectError
            If something else has its name.
        """
        attribute = mesh_of(target).attributes.get(self._mark_name)
        alike = attribute is None or (attribute.data_type, attribute.domain) == ("FLOAT_COLOR", "POINT")
        if not alike or self._mark_name in target.vertex_groups:
            raise ObjectError(
                f'"{target.name}" already has something else called "{self._mark_name}". Rename it, or turn Mark '
                "Rejected off."
            )

    def _write_mark(self, target: bpy.types.Object) -> None:
        """Write and show the color attribute."""
        attributes = mesh_of(target).attributes
        rendered, old = attributes.default_color_name, attributes.get(self._mark_name)
        if old is not None:
            attributes.remove(old)
        colors = np.where(self._torn[:, None], _TORN, _WHOLE).astype(np.float32)
        mesh_io.add_colors(mesh_of(target), self._mark_name, colors)
        attributes.active_color_name = self._mark_name
        attributes.default_color_name = rendered or self._mark_name


def _columns(
    obj: bpy.types.Object, weights: csr_array | None, names: Sequence[str], chosen: NDArray[np.bool_] | None = None
) -> csr_array:
    """Pick the weights (n, g) of named groups; those that the object lacks, or that are not chosen, are empty."""
    weights = read_weights(obj) if weights is None else weights
    places = np.array([obj.vertex_groups.find(name) for name in names])
    if chosen is not None:
        places[~chosen] = -1
    found = np.flatnonzero(places >= 0)
    picked = weights.tocsc()[:, places[found]].tocoo()
    rows, columns = picked.coords
    return csr_array((picked.data, (rows, found[columns])), shape=(weights.shape[0], len(names)))


def _is_whole(weights: csr_array) -> bool:
    """Tell whether the weights of each vertex that has any are shares of a whole."""
    sums = row_sums(weights)
    return bool((sums > 0).any() and (abs(sums[sums > 0] - 1) < _WHOLE_SUM).all())
